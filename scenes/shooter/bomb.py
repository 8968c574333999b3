"""The bomb: a circular sensor that grows around the point at which it was dropped.

Bullets that it touches are removed, and each plane that it touches is damaged once. The player cannot be hit for a
while.
"""

from physics import Circle
from scenes.shooter.cast import BLASTING, steps

GROW, BURN = steps(0.45), steps(1.1)  # steps for which the bomb grows, and for which it exists
EVERY = 3  # steps between two changes of its shape's size
FIRST, REACH = 20.0, 120.0  # [px] radius
SHELTER = steps(2.0)  # steps for which the player cannot be hit after dropping it
DAMAGE, LEADER_DAMAGE = 18.0, 45.0  # damage in plain shots


class Bomb:
    """The player's bomb.

    body: its sensor, or None while no bomb burns; age: age of the bomb [steps]; struck: ids of the planes that this
    bomb has already damaged.
    """

    def __init__(self, world):
        self.world = world
        self.body = None
        self.x = self.y = 0.0
        self.age = 0
        self.struck = set()

    @property
    def radius(self):
        """Current radius of the blast [px]. It grows fast at first, then more slowly."""
        left = 1.0 - min(self.age / GROW, 1.0)
        return FIRST + (REACH - FIRST) * (1.0 - left * left)

    def drop(self, x, y):
        """Start the bomb's explosion at (x, y) [px]."""
        self.x, self.y, self.age = x, y, 0
        self.struck = set()
        self.body = self.world.add_body(
            Circle(self.radius), position=(x, y), kind="kinematic", sensor=True, filter=BLASTING
        )

    def step(self):
        """Make one step of the bomb, which may grow.

        If it has burnt out, return the id of its body, which the caller must remove; otherwise return None.
        """
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
        """Record that the bomb touches the plane with the body id `identity`. Return whether this is the first time."""
        new = identity not in self.struck
        self.struck.add(identity)
        return new

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return (self.x, self.y, self.age, -1 if self.body is None else self.body.id, *sorted(self.struck))
