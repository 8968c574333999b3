"""What a step of each of several lanes costs: warmed, in turns that are shuffled, in five runs of 60 steps and more."""

from collections.abc import Callable, Sequence
from random import Random
from typing import NamedTuple

from game.measure.moment import Moment
from game.measure.timing import RUNS, Cost
from game.wishes import Lane, Recipe
from physics import Snapshot

WARM_STEPS = 2  # before the first run: they compile


class LaneFigures(NamedTuple):
    """cost: seconds a step, of the runs so far. overlap: the deepest while it was judged [px]; None: nobody asked."""

    cost: Cost
    overlap: float | None = None

    @property
    def sure(self) -> bool:
        """Whether it was run often enough."""
        return self.cost.runs >= RUNS


def measure_lanes(
    lanes: Sequence[Lane], tell: Callable[[int, float, float | None], object], goes_on: Callable[[], bool]
) -> None:
    """Measure run by run, as long as it goes on: tell(number, seconds a step, overlap [px] or None) after each run.

    The first turn goes in the order given. Overlaps are looked at before it, not while time is taken.
    """
    made: dict[str, Snapshot] = {}  # by recipe: several lanes begin with the same world
    moments = [[Moment(_snapshot(each, made), lane.broadphase) for each in lane.snapshots] for lane in lanes]
    order, chance = list(range(len(lanes))), Random(0)
    overlaps: dict[int, float | None] = {}
    for run in range(RUNS):
        for number in order:
            if not goes_on():
                return
            lane, own = lanes[number], moments[number]
            if run == 0:
                own[0].time_run(own[0].here, WARM_STEPS)
                overlaps[number] = _overlap(own[0], lane.judged)
            spent = sum(moment.time_run(moment.here, lane.steps, lane.stage) for moment in own) / len(own)
            tell(number, spent, overlaps[number])
        chance.shuffle(order)


def _snapshot(given, made):
    if not isinstance(given, Recipe):
        return given
    return made.get(repr(given)) or made.setdefault(repr(given), given.make())


def _overlap(moment, judged):
    """The deepest overlap of these steps, both counted [px]; None: nobody asked."""
    if judged is None:
        return None
    first, last = judged
    return float(moment.way(moment.here, last).overlap[first - 1 :].max())
