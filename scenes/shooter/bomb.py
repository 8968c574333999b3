"""The bomb: a sensor circle that grows around its start, and reports contacts.

Bullets in it are removed, planes are damaged once, and the player is a ghost while it burns.
"""

from physics import Circle
from scenes.shooter.cast import BLASTING, steps

GROW, BURN = steps(0.45), steps(1.1)  # steps of its growth, and of its whole life
EVERY = 3  # steps between two sizes of its shape
FIRST, REACH = 20.0, 120.0  # [px] radius
SHELTER = steps(2.0)  # steps for which the player is a ghost
DAMAGE, LEADER_DAMAGE = 18.0, 45.0  # plain shots


class Bomb:
    """The bomb. `body` is None while there is none; `age` counts its steps; `struck`: the planes that it has
    damaged.
    """

    def __init__(self, world):
        self.world = world
        self.body = None
        self.x = self.y = 0.0
        self.age = 0
        self.struck = set()

    @property
    def radius(self):
        """Present radius [px]: it grows fast at first, then more slowly."""
        left = 1.0 - min(self.age / GROW, 1.0)
        return FIRST + (REACH - FIRST) * (1.0 - left * left)

    def drop(self, x, y):
        """Set it off at a place [px]."""
        self.x, self.y, self.age = x, y, 0
        self.struck = set()
        self.body = self.world.add_body(
            Circle(self.radius), position=(x, y), kind="kinematic", sensor=True, filter=BLASTING
        )

    def step(self):
        """Let it grow. Return the id of its body when it ends, to be removed, else None."""
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
        """Return whether it meets this plane for the first time."""
        new = identity not in self.struck
        self.struck.add(identity)
        return new

    def state(self):
        """Return the state for the digest."""
        return (self.x, self.y, self.age, -1 if self.body is None else self.body.id, *sorted(self.struck))
