"""The cost of each effect: copies of a world are stepped with and without the effect, outside the game's frame.

A declared effect is removed together with all effects that need it. An undeclared effect is added together with the
effects that it needs, at neutral settings such as friction 0 (NEUTRAL in game/measure/ledger.py). So the cost of an
undeclared effect is the time it takes if it is declared but not used.
"""

from collections.abc import Callable
from random import Random
from typing import NamedTuple

from game.measure.ledger import EFFECTS, NEUTRAL
from game.measure.moment import STEPS, Moment
from game.measure.timing import RUNS, Cost, seconds_a_step
from physics import Effects, World


class Side(NamedTuple):
    """The effects of one of the two worlds that are compared.

    idle: the effects whose settings are made neutral, so that these effects do nothing.
    """

    effects: Effects
    idle: tuple[str, ...] = ()


class EffectCost(NamedTuple):
    """The cost of one effect.

    cost: time of a step with the effect [s]; without: time of a step without it [s]. Both are None until they are
    measured.

    kernels: number of kernels that are compiled only because of this effect. A kernel counts once for each set of
    argument types. None if not counted yet, or if nothing is compiled.
    """

    effect: str
    declared: bool
    cost: Cost | None = None
    without: Cost | None = None
    kernels: int | None = None

    @property
    def price(self) -> float | None:
        """Time that the effect adds to a step [s]; negative if the effect saves time; None if not measured yet.

        The price is the difference of the least times with and without the effect, because other load only ever adds
        time.
        """
        return None if self.cost is None or self.without is None else self.cost.least - self.without.least

    @property
    def noise(self) -> float:
        """Noise of the price [s].

        For the steps with the effect, and for those without it, the noise is the median minus the least time. The
        result is the sum of both.
        """
        return sum(each.median - each.least for each in (self.cost, self.without) if each is not None)


def sides_of(effects: Effects) -> dict[str, tuple[Side, Side]]:
    """Return {effect: (Side with the effect, Side without it)} for every effect that exists.

    effects: effects that the compared world declares. Both sides are derived from them.
    """
    found = {}
    for name in EFFECTS:
        if getattr(effects, name):
            found[name] = Side(effects), Side(effects.without(name))
        else:
            needed, idle = effects.and_needed(name), (name,) if name in NEUTRAL else ()
            found[name] = Side(needed.with_(**{name: True}), idle), Side(needed, idle)
    return found


def world_under(moment: Moment, side: Side) -> World:
    """Return a world in the state of the snapshot `moment`, but with the effects of `side`.

    All bodies of the world are awake.
    """
    world = moment.world(moment.here)
    world.set_effects(side.effects)
    for name in side.idle:
        NEUTRAL[name](world)
    return world


def can_be(moment: Moment, side: Side) -> bool:
    """Return whether a world in the state of the snapshot `moment` is valid with the effects of `side`."""
    try:
        world_under(moment, side)
    except ValueError:
        return False
    return True


def time_side(moment: Moment, side: Side, steps: int = STEPS) -> float:
    """Return the mean time of a step [s] over `steps` steps from the snapshot `moment`, with the effects of `side`.

    The first run also compiles kernels, so the caller must not count it.
    """
    return seconds_a_step(world_under(moment, side).step, steps)


def measure_effects(
    moment: Moment, report: Callable[[str, Cost, Cost], object], goes_on: Callable[[], bool], seed: int = 0
) -> None:
    """Time a step from the snapshot `moment` with and without every effect, in several rounds of random order.

    report(effect, cost with the effect, cost without it) is called for each effect after each round. An effect is left
    out if the world is invalid without it (characters need response). The function returns early when goes_on() is
    False. seed: seed of the random order.
    """
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
                report(name, *(Cost.of(spent[side], STEPS) for side in pair))
