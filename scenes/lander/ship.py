"""The ship: it turns, thrusts, burns fuel and is damaged by knocks. Its body has its picture's pixels."""

from math import cos, hypot, sin
from typing import Any

from game.drawing.sprites import load_atlas
from game.scene import STEP_SECONDS
from physics import Material
from scenes.lander.feel import (
    AWAY,
    CAN,
    CEILING,
    CEILING_PUSH,
    CHARGE,
    COOLDOWN,
    DAMAGE,
    FEWEST_SHELLS,
    FUEL,
    FUEL_RATE,
    HARMLESS,
    HULL,
    LIVES,
    SHELLS,
    SHIP,
    SHIP_MASS,
    STILL,
    THRUST,
    TURN_GAIN,
    TURN_LOSS,
    TURN_RATE,
    UPRIGHT,
    approach,
)

STAND = 16.0  # [px] from the ship's middle to its feet
SIDES = 14.0  # [px] kept from the world's left and right edge
HULL_MATERIAL = Material(friction=0.8, restitution=0.12)


class Ship:
    """The ship. `body` is None between two ships. `touching`: ids of bodies in contact. `away` counts the steps to the
    next ship.
    """

    def __init__(self, world, moon):
        self.world, self.moon = world, moon
        self.lives = LIVES
        self.body: Any = None
        self.pad = moon.pads[0]  # start of the next ship
        self.fuel, self.hull, self.shells = FUEL, HULL, SHELLS
        self.x = self.y = self.angle = self.vx = self.vy = 0.0
        self.touching = set()
        self.thrusting = False
        self.turning = self.cooldown = self.away = self.charge = 0
        self.arrive()

    @property
    def here(self):
        """True while there is a ship."""
        return self.body is not None

    @property
    def nose(self):
        """Direction of the nose, a unit vector."""
        return sin(self.angle), -cos(self.angle)

    @property
    def speed(self):
        """Speed [px/s]."""
        return hypot(self.vx, self.vy)

    @property
    def quiet(self):
        """True if it rests upright."""
        return (
            self.here
            and bool(self.touching)
            and abs(self.angle) < UPRIGHT
            and self.speed < STILL
            and not self.thrusting
        )

    def arrive(self):
        """Place a ship on the last reached pad."""
        self.fuel, self.hull, self.shells = FUEL, HULL, max(self.shells, FEWEST_SHELLS)
        self.body = self.world.add_body(
            load_atlas("lander").mask("ship"),
            position=(self.pad.x, self.pad.y - STAND),
            mass=SHIP_MASS,
            material=HULL_MATERIAL,
            filter=SHIP,
            user="ship",
        )
        self.touching = set()
        self.thrusting, self.turning, self.cooldown = False, 0, 0
        self.read()

    def read(self):
        """Read pose and motion from the world."""
        if self.body is not None:
            self.x, self.y = self.body.position
            self.vx, self.vy = self.body.velocity
            self.angle = wrapped(self.body.angle)

    def steer(self, inputs):
        """Turn and thrust by the keys."""
        body = self.body
        self.turning = inputs.held("right") - inputs.held("left")
        self.thrusting = inputs.held("up") and self.fuel > 0.0
        self.cooldown = max(self.cooldown - 1, 0)
        self.charge = (self.charge + 1) % CHARGE if self.shells < FEWEST_SHELLS else 0
        if self.shells < FEWEST_SHELLS and self.charge == CHARGE - 1:
            self.shells += 1
        spin = body.angular_velocity
        if self.turning:
            body.angular_velocity = approach(spin, self.turning * TURN_RATE, TURN_GAIN * STEP_SECONDS)
        elif spin and not self.touching:
            body.angular_velocity = approach(spin, 0.0, TURN_LOSS * STEP_SECONDS)
        if self.thrusting:
            self.fuel = max(self.fuel - FUEL_RATE * STEP_SECONDS, 0.0)
            x, y = self.nose
            body.apply_force((THRUST * SHIP_MASS * x, THRUST * SHIP_MASS * y))
        self._stay_in_the_world(body)

    def _stay_in_the_world(self, body):
        """Push the ship gently back from the altitude limit and from both sides of the moon."""
        if self.y < CEILING:
            body.apply_force((0.0, SHIP_MASS * CEILING_PUSH * (CEILING - self.y)))
        for edge, way in ((SIDES, 1), (self.moon.width - SIDES, -1)):
            if (self.x - edge) * way < 0.0 and self.vx * way < 20.0:
                body.apply_impulse((SHIP_MASS * (20.0 * way - self.vx), 0.0))

    def fires(self, inputs):
        """Return whether it fires a shell in this step."""
        if not inputs.held("fire") or self.cooldown or not self.shells:
            return False
        self.shells -= 1
        self.cooldown = COOLDOWN
        return True

    def knock(self, change):
        """Apply the damage of a change of velocity [px/s]. Return the loss of hull."""
        cost = min(max(change - HARMLESS, 0.0) * DAMAGE, self.hull)
        self.hull -= cost
        return cost

    def lose(self):
        """Lose the ship. Return the id of its body, which is to be removed."""
        identity = self.body.id
        self.body = None
        self.touching = set()
        self.thrusting, self.turning = False, 0
        self.lives -= 1
        self.away = AWAY
        return identity

    def wait(self):
        """Count a step without a ship. Return whether the next one has come."""
        self.away = max(self.away - 1, 0)
        if self.away or not self.lives:
            return False
        self.arrive()
        return True

    def refuel(self):
        """Take a can of fuel."""
        self.fuel = min(self.fuel + CAN, FUEL)

    def state(self):
        """Return the state for the replay digest, as a flat tuple."""
        return (
            self.lives,
            -1 if self.body is None else self.body.id,
            self.pad.name,
            self.fuel,
            self.hull,
            self.shells,
            self.x,
            self.y,
            self.angle,
            self.vx,
            self.vy,
            self.thrusting,
            self.turning,
            self.cooldown,
            self.charge,
            self.away,
            *sorted(self.touching),
        )


def wrapped(angle):
    """Return an angle within half a turn of 0 [rad]."""
    return (angle + 3.141592653589793) % 6.283185307179586 - 3.141592653589793
