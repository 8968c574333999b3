"""The gun: shells fly from the ship's nose and explode on contact. An explosion pushes near bodies away."""

from math import hypot

from physics import Circle
from scenes.lander.feel import MUZZLE, PUSH, PUSH_REACH, SHELL, SHELL_LIFE, SHELL_MASS, SHELL_RADIUS, SHELL_SPEED


class Gun:
    """The ship's gun and its flying shells. shells: {body id of a shell: steps until it is removed}."""

    def __init__(self, world):
        self.world = world
        self.shells = {}

    def fire(self, ship):
        """Fire one shell from the nose of `ship`. The recoil acts on the ship."""
        x, y = ship.nose
        body = self.world.add_body(
            Circle(SHELL_RADIUS),
            position=(ship.x + MUZZLE * x, ship.y + MUZZLE * y),
            velocity=(ship.vx + SHELL_SPEED * x, ship.vy + SHELL_SPEED * y),
            mass=SHELL_MASS,
            filter=SHELL,
            gravity_scale=0.4,
            user="shell",
        )
        self.shells[body.id] = SHELL_LIFE
        ship.body.apply_impulse((-SHELL_MASS * SHELL_SPEED * x, -SHELL_MASS * SHELL_SPEED * y))

    def step(self):
        """Make one step of all shells. Return the ids of the shells whose lifetime is over."""
        self.shells = {identity: left - 1 for identity, left in self.shells.items()}
        return [identity for identity, left in self.shells.items() if left <= 0]

    def bursts(self, begun):
        """Return {id of a shell: contact point (x, y) [px]} for the shells that touched a body in this step.

        begun: the step's begin events.
        """
        found = {}
        columns = (begun[name].tolist() for name in ("body_a", "body_b", "point_x", "point_y"))
        for a, b, x, y in zip(*columns, strict=True):
            for identity in (a, b):
                if identity in self.shells:
                    found.setdefault(identity, (x, y))
        return found

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return (*self.shells, *self.shells.values())


def blown(body, x, y):
    """Return (vx, vy, speed) [px/s], the change of a body's velocity by an explosion at (x, y) [px].

    speed: magnitude of the change; all 0 if the body is out of range.
    """
    dx, dy = body.center.x - x, body.center.y - y
    far = hypot(dx, dy)
    speed = PUSH * max(1.0 - far / PUSH_REACH, 0.0)
    if speed == 0.0:
        return 0.0, 0.0, 0.0
    if far == 0.0:
        return 0.0, -speed, speed
    return speed * dx / far, speed * dy / far, speed
