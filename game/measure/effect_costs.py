"""What each effect costs at a moment of a world: the same state stepped with it and without it, off the frame.

A declared effect is taken out with all that needs it. One that is not declared is put in with what it needs, and finds
nothing to do (game/measure/ledger.py): what is told is the price of having it there.
"""

from collections.abc import Callable
from random import Random
from typing import NamedTuple

from game.measure.ledger import EFFECTS, NEUTRAL
from game.measure.moment import STEPS, Moment
from game.measure.timing import RUNS, Cost, seconds_a_step
from physics import Effects, World


class Side(NamedTuple):
    """What a world of the moment is put under; idle: the effect that is left nothing to do, "": none."""

    effects: Effects
    idle: str = ""


class EffectCost(NamedTuple):
    """One effect. cost, without: [s] a step with it and without it, as far as measured; kernels: how many pairs of a
    kernel and the types it is called with are compiled for it alone; None: not counted yet, or nothing is compiled."""

    effect: str
    declared: bool
    cost: Cost | None = None
    without: Cost | None = None
    kernels: int | None = None

    @property
    def price(self) -> float | None:
        """[s] a step that it takes; below 0: it saves them. None: not measured yet. Of both sides the least, as other
        load only ever adds."""
        return None if self.cost is None or self.without is None else self.cost.least - self.without.least

    @property
    def noise(self) -> float:
        """[s] by which the runs of both sides lie above the least."""
        return sum(each.median - each.least for each in (self.cost, self.without) if each is not None)


def sides_of(effects: Effects) -> dict[str, tuple[Side, Side]]:
    """{effect: (with it, without it)} for a world under effects."""
    found = {}
    for name in EFFECTS:
        if getattr(effects, name):
            found[name] = Side(effects), Side(effects.without(name))
        else:
            needed, idle = effects.and_needed(name), name if name in NEUTRAL else ""
            found[name] = Side(needed.with_(**{name: True}), idle), Side(needed, idle)
    return found


def world_under(moment: Moment, side: Side) -> World:
    """A world of the moment, all awake."""
    world = moment.world(moment.here)
    world.set_effects(side.effects)
    if side.idle:
        NEUTRAL[side.idle](world)
    return world


def can_be(moment: Moment, side: Side) -> bool:
    """Whether what is in the world can live under these effects."""
    try:
        world_under(moment, side)
    except ValueError:
        return False
    return True


def time_side(moment: Moment, side: Side, steps: int = STEPS) -> float:
    """Seconds a step of one run from the moment on. The first run of a side also compiles: leave it out."""
    return seconds_a_step(world_under(moment, side).step, steps)


def measure_effects(
    moment: Moment, tell: Callable[[str, Cost, Cost], object], goes_on: Callable[[], bool], seed: int = 0
) -> None:
    """Time every effect, in shuffled turns; tell(effect, with it, without it) after each round. Of one that the world
    cannot be without (Characters need response) nothing is told. Ends early once goes_on() is False."""
    sides = {
        name: pair for name, pair in sides_of(moment.effects).items() if all(can_be(moment, each) for each in pair)
    }
    todo = list(dict.fromkeys(side for pair in sides.values() for side in pair))
    spent: dict[Side, list[float]] = {side: [] for side in todo}
    chance = Random(seed)
    for turn in range(RUNS + 1):
        chance.shuffle(todo)
        for side in todo:
            if not goes_on():
                return
            seconds = time_side(moment, side, STEPS if turn else 2)
            if turn:
                spent[side].append(seconds)
        if turn:
            for name, pair in sides.items():
                tell(name, *(Cost.of(spent[side], STEPS) for side in pair))
