"""`Watch`, which steps a world and checks its invariants after every step, and functions that measure a world."""

import math

import numpy as np

from game.invariants.bodies import Bodies
from game.invariants.conserved import DRIFT, Account
from game.invariants.invariant import Broken
from game.invariants.watch import Watch as Onlooker
from tests.stability.settings import by_default

DYNAMIC = 2


def deepest(world):
    """Return the overlap of the deepest contact [px]; contacts of sensors do not count."""
    contacts = world.contacts
    solid = contacts["separation"]
    return max(0.0, -float(solid.min())) if len(solid) else 0.0


def movers(world):
    """Return the rows of the dynamic bodies in the table world.bodies."""
    return world.bodies[world.bodies["kind"] == DYNAMIC]


def kinetic(world):
    """Return the kinetic energy of the dynamic bodies."""
    return Bodies(world).kinetic


def rms_speed(world):
    """Return the root mean square speed of the dynamic bodies [px/s]."""
    rows = movers(world)
    return math.sqrt(float((rows["vx"] ** 2 + rows["vy"] ** 2).mean())) if len(rows) else 0.0


def pulling(world):
    """Return the contacts whose normal impulse is not at least 0: such a contact pulls its bodies together."""
    return world.contacts[~(world.contacts["normal_impulse"] >= 0.0)]


class Watch:
    """A world with a check of the invariants of game/invariants after each step.

    passive: True if no energy may be added from now on (invariant U5), whatever the tables of the world suggest.
    isolated: True if no external force acts, so that the momentum stays constant (U3). depth: largest overlap allowed
    after a step [px]. capped: True allows the substep cap to be reached (U11). Under the default settings this is
    always allowed. without: names of the invariants that this world breaks on purpose.
    """

    def __init__(self, world, passive=False, isolated=False, depth=math.inf, capped=False, without=()):
        self.world, self.depth = world, depth
        self.onlooker = Onlooker()
        self.without = {*without, "U11"} if capped or by_default() else set(without)
        self.steps = 0
        start = Bodies(world)
        self.account = Account(start) if passive else None
        self.start = start if isolated else None
        self.deepest = self.fastest = 0.0

    def step(self, steps=1, dt=None, each=None):
        """Step the world `steps` times by dt [s] (None: the world's own) and check it after every step. Returns self.

        each: function without arguments, called after the check of every step.
        """
        for _ in range(steps):
            self.onlooker.before(self.world)
            self.world.step(dt)
            self.onlooker.after(self.world)
            self.steps += 1
            self.check()
            if each is not None:
                each()
        return self

    def check(self):
        """Assert the invariants for the step just made."""
        world, where = self.world, f"step {self.steps}"
        for name, answer in self.onlooker.collect()[0].items():
            assert name in self.without or not isinstance(answer, Broken), f"{where}: {answer}"
        assert len(pulling(world)) == 0, f"{where}: a contact pulls"
        self.deepest = max(self.deepest, deepest(world))
        assert self.deepest <= self.depth, f"{where}: overlap {self.deepest:g} of {self.depth:g}"
        now = self.onlooker.last
        if now.dynamic.any():
            self.fastest = max(self.fastest, float(now.speed[now.dynamic].max()))
        if self.account is not None:
            gain, allowed = self.account.gain(world, now)
            assert gain <= allowed, f"{where}: energy {gain:g} above the start, {allowed:g} allowed"
        if self.start is not None:
            drift = np.abs(np.subtract(now.momentum, self.start.momentum)).max()
            assert drift <= DRIFT * self.start.momentum_scale + 1e-300, f"{where}: momentum drifts by {drift:g}"
