"""The bomb: a sensor circle that grows around the place where it went off, and reports what it meets.

Bullets that it meets are gone, planes are damaged once, and the player is a ghost while it burns.
"""

from physics import Circle
from scenes.shooter.cast import BLASTING, steps

GROW, BURN = steps(0.45), steps(1.1)  # steps until it is as large as it gets, and until it is over
EVERY = 3  # steps between two sizes of its shape
FIRST, REACH = 20.0, 120.0  # [px] radius
SHELTER = steps(2.0)  # steps that the player is a ghost
DAMAGE, LEADER_DAMAGE = 18.0, 45.0  # plain shots


class Bomb:
    """`body` is None while there is none; `age` counts its steps; `struck` holds the planes that it has damaged."""

    def __init__(self, world):
        self.world = world
        self.body = None
        self.x = self.y = 0.0
        self.age = 0
        self.struck = set()

    @property
    def radius(self):
        """[px] now: fast at first, then slower."""
        left = 1.0 - min(self.age / GROW, 1.0)
        return FIRST + (REACH - FIRST) * (1.0 - left * left)

    def drop(self, x, y):
        """It goes off at a place [px]."""
        self.x, self.y, self.age = x, y, 0
        self.struck = set()
        self.body = self.world.add_body(
            Circle(self.radius), position=(x, y), kind="kinematic", sensor=True, filter=BLASTING
        )

    def step(self):
        """It grows. Returns the id of its body when it is over, to be removed, else None."""
        if self.body is None:
            return None
        self.age += 1
        if self.age <= GROW and self.age % EVERY == 0:
            self.body.set_shapes(Circle(self.radius))
        if self.age < BURN:
            return None
        body, self.body = self.body, None
        return body.id

    def strikes(self, identity):
        """True the first time that it meets a plane."""
        new = identity not in self.struck
        self.struck.add(identity)
        return new

    def state(self):
        """For the digest."""
        return (self.x, self.y, self.age, -1 if self.body is None else self.body.id, *sorted(self.struck))
