"""What a step of each of several lanes costs: warmed, in turns that are shuffled, in five runs of 60 steps and more."""

from collections.abc import Callable, Sequence
from random import Random
from typing import NamedTuple

import numpy as np

from game.measure.moment import Moment
from game.measure.timing import RUNS, Cost
from game.wishes import Lane, Recipe
from physics import Snapshot

WARM_STEPS = 2  # before the first run: they compile


class LaneFigures(NamedTuple):
    """cost: seconds a step, of the runs so far. overlap: the deepest while it was judged, farthest: that a body came in
    a step of that time [px]; None: nobody asked."""

    cost: Cost
    overlap: float | None = None
    farthest: float | None = None

    @property
    def sure(self) -> bool:
        """Whether it was run often enough."""
        return self.cost.runs >= RUNS


def measure_lanes(
    lanes: Sequence[Lane], tell: Callable[[int, float, float | None, float | None], object], goes_on: Callable[[], bool]
) -> None:
    """Measure run by run, as long as it goes on: tell(number, seconds a step, overlap, farthest) after each run.

    The first turn goes in the order given. Overlaps and ways are looked at before it, not while time is taken.
    """
    made: dict[str, Snapshot] = {}  # by recipe: several lanes begin with the same world
    moments = [[Moment(_snapshot(each, made), lane.broadphase) for each in lane.snapshots] for lane in lanes]
    order, chance = list(range(len(lanes))), Random(0)
    seen: dict[int, tuple[float | None, float | None]] = {}
    for run in range(RUNS):
        for number in order:
            if not goes_on():
                return
            lane, own = lanes[number], moments[number]
            if run == 0:
                own[0].time_run(own[0].here, WARM_STEPS, act=lane.act)
                seen[number] = _judge(own[0], lane.judged)
            spent = sum(moment.time_run(moment.here, lane.steps, lane.stage, lane.act) for moment in own) / len(own)
            tell(number, spent, *seen[number])
        chance.shuffle(order)


def _snapshot(given, made):
    if not isinstance(given, Recipe):
        return given
    return made.get(repr(given)) or made.setdefault(repr(given), given.make())


def _judge(moment, judged):
    """The deepest overlap of these steps, both counted, and the farthest that a body came in one [px]; None, None:
    nobody asked."""
    if judged is None:
        return None, None
    first, last = judged
    way, rows = moment.way(moment.here, last), moment.snapshot.arrays["bodies"]
    start = np.stack([rows["center_x"], rows["center_y"]], axis=1)[np.argsort(rows["id"])]
    gaps = np.diff(np.concatenate([start[None], way.places]), axis=0)[first - 1 :, way.moves]
    return float(way.overlap[first - 1 :].max()), float(np.sqrt((gaps * gaps).sum(axis=2)).max(initial=0.0))
