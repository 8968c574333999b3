"""The ship: it turns, thrusts, burns fuel and is damaged by impacts. Its shape is the pixel mask of its picture."""

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
SIDES = 14.0  # [px] least distance from the left and right edge of the moon
HULL_MATERIAL = Material(friction=0.8, restitution=0.12)


class Ship:
    """The player's ship.

    body: its body, or None between the loss of a ship and the next ship; away: steps until the next ship; touching:
    ids of the bodies in contact with the ship.
    """

    def __init__(self, world, moon):
        self.world, self.moon = world, moon
        self.lives = LIVES
        self.body: Any = None
        self.pad = moon.pads[0]  # the pad on which the next ship starts
        self.fuel, self.hull, self.shells = FUEL, HULL, SHELLS
        self.x = self.y = self.angle = self.vx = self.vy = 0.0
        self.touching = set()
        self.thrusting = False
        self.turning = self.cooldown = self.away = self.charge = 0
        self.arrive()

    @property
    def here(self):
        """True while there is a ship; False between the loss of a ship and the next ship."""
        return self.body is not None

    @property
    def nose(self):
        """Direction in which the ship's nose points, a unit vector (x, y)."""
        return sin(self.angle), -cos(self.angle)

    @property
    def speed(self):
        """Speed of the ship [px/s]."""
        return hypot(self.vx, self.vy)

    @property
    def quiet(self):
        """True if the ship stands upright and at rest, with its engine off."""
        return (
            self.here
            and bool(self.touching)
            and abs(self.angle) < UPRIGHT
            and self.speed < STILL
            and not self.thrusting
        )

    def arrive(self):
        """Add a new ship on the pad that was reached last, with full fuel and hull."""
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
        """Copy position, velocity and angle from the ship's body."""
        if self.body is not None:
            self.x, self.y = self.body.position
            self.vx, self.vy = self.body.velocity
            self.angle = wrapped(self.body.angle)

    def steer(self, inputs):
        """Turn and thrust for the next step according to the input, and keep the ship inside the moon's limits."""
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
        """Push the ship gently back from the altitude limit and from both sides of the moon. body: the ship's body."""
        if self.y < CEILING:
            body.apply_force((0.0, SHIP_MASS * CEILING_PUSH * (CEILING - self.y)))
        for edge, way in ((SIDES, 1), (self.moon.width - SIDES, -1)):
            if (self.x - edge) * way < 0.0 and self.vx * way < 20.0:
                body.apply_impulse((SHIP_MASS * (20.0 * way - self.vx), 0.0))

    def fires(self, inputs):
        """Return whether the ship fires a shell in this step. If it does, take the shell from the stock."""
        if not inputs.held("fire") or self.cooldown or not self.shells:
            return False
        self.shells -= 1
        self.cooldown = COOLDOWN
        return True

    def knock(self, change):
        """Damage the hull by an impact, and return the loss of hull. change: change of the ship's velocity [px/s]."""
        cost = min(max(change - HARMLESS, 0.0) * DAMAGE, self.hull)
        self.hull -= cost
        return cost

    def lose(self):
        """Remove the ship from the game, with one life. Return the id of its body, which the caller must remove."""
        identity = self.body.id
        self.body = None
        self.touching = set()
        self.thrusting, self.turning = False, 0
        self.lives -= 1
        self.away = AWAY
        return identity

    def wait(self):
        """Wait one step for the next ship, and add it when it is due. Return whether the next ship has appeared."""
        self.away = max(self.away - 1, 0)
        if self.away or not self.lives:
            return False
        self.arrive()
        return True

    def refuel(self):
        """Add the fuel of one can."""
        self.fuel = min(self.fuel + CAN, FUEL)

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
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
    """Return the equivalent angle [rad] in the range -pi .. pi."""
    return (angle + 3.141592653589793) % 6.283185307179586 - 3.141592653589793
