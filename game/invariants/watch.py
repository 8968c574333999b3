"""Checks of all invariants before and after every step of one world."""

from collections.abc import Callable
from time import perf_counter

import numpy as np

from game.invariants.bodies import Bodies
from game.invariants.buffers import Caps
from game.invariants.conserved import Energy, Momentum, Spin
from game.invariants.invariant import Answer, Broken, Invariant
from game.invariants.numbers import Finite, Unit
from game.invariants.order import Order
from game.invariants.pairs import Agree, Swap, Turn
from game.invariants.settled import Settled
from game.invariants.step import Step
from physics import World


def all_invariants(concave: bool = True) -> tuple[Invariant, ...]:
    """Return new instances of the invariants U1 to U11.

    concave: whether pairs of masks, tiles and chains are also checked, at ten times the cost.
    """
    return (
        Finite(),
        Unit(),
        Momentum(),
        Spin(),
        Energy(),
        Settled(),
        Swap(concave),
        Turn(concave),
        Order(),
        Agree(concave),
        Caps(),
    )


class Watch:
    """Checks of all invariants of one world. Call before() and after() around each step.

    found: {id of the invariant: result} since the last collect(). The result is the first break or, without a break,
    the latest result. seconds: time that the checks have taken since the last collect().
    """

    def __init__(self, concave: bool = True) -> None:
        self.invariants = all_invariants(concave)
        self.found: dict[str, Answer] = {}
        self.seconds = 0.0
        self.last: Bodies | None = None
        self.shapes = np.zeros(0, np.int64)
        self.edited, self.changed, self.forced, self.time = True, np.zeros(0, bool), np.zeros(0, bool), 0.0

    def before(self, world: World) -> None:
        """Record the changes that the game has made since the last step. Call this right before a step."""
        started = perf_counter()
        rows, now = world.bodies, Bodies(world)
        same = self.last is not None and now.same_as(self.last)
        self.changed = np.zeros(len(now), bool) if same else now.differs_from(self.last)
        self.edited = not same or not np.array_equal(world.shapes["id"], self.shapes)
        self.forced = (rows["force_x"] != 0.0) | (rows["force_y"] != 0.0) | (rows["torque"] != 0.0)
        self.last, self.time = now, world.time
        self.seconds += perf_counter() - started

    def after(self, world: World) -> None:
        """Check the invariants for the finished step. Call this right after the step."""
        started = perf_counter()
        if self.last is None:
            raise ValueError("before() must be called before the step")
        step = Step(world, self.last, world.time - self.time, self.edited, self.changed, self.forced)
        for invariant in self.invariants:
            answer = invariant.look(step)
            if not isinstance(self.found.get(invariant.id), Broken):
                self.found[invariant.id] = answer
        self.last, self.shapes = step.now, world.shapes["id"].copy()
        self.seconds += perf_counter() - started

    def collect(self) -> tuple[dict[str, Answer], float]:
        """Return ({id of the invariant: result}, time of the checks [s]), both since the last call."""
        found, self.found = self.found, {}
        seconds, self.seconds = self.seconds, 0.0
        return found, seconds


class WatchedWorld(World):
    """World whose invariants can be checked. watch: the checks around its steps; None if they are off, at no cost.

    stepped_by(world, dt): function that replaces World.step; None for World.step itself.
    """

    watch: Watch | None = None
    stepped_by: Callable[["WatchedWorld", float | None], None] | None = None

    def step(self, dt: float | None = None) -> None:
        """Step the world. If `watch` is set, also check the world's invariants. dt: as in World.step()."""
        if self.stepped_by is not None:
            return self.stepped_by(self, dt)
        watch = self.watch
        if watch is None:
            return super().step(dt)
        watch.before(self)
        super().step(dt)
        watch.after(self)
