"""Timing of several measured runs. Each is warmed up, then timed five times over 60 steps or more, in random order."""

from collections.abc import Callable, Sequence
from random import Random
from typing import NamedTuple

import numpy as np

from game.measure.moment import Moment
from game.measure.timing import RUNS, Cost
from game.measurement_requests import MeasuredRun, Recipe
from physics import Snapshot

WARM_STEPS = 2  # steps before the first run, which compile


class RunFigures(NamedTuple):
    """The figures of one measured run so far.

    cost: the Cost of a step [s], over the repetitions of the run; overlap: deepest overlap [px]; farthest: greatest
    distance that a body moved in one step [px]. overlap and farthest cover only the steps that MeasuredRun.judged
    selects. They are None if it selects none.
    """

    cost: Cost
    overlap: float | None = None
    farthest: float | None = None

    @property
    def sure(self) -> bool:
        """Whether the run was repeated at least RUNS times."""
        return self.cost.runs >= RUNS


def measure_runs(
    measured_runs: Sequence[MeasuredRun],
    report: Callable[[int, float, float | None, float | None], object],
    goes_on: Callable[[], bool],
) -> None:
    """Time the measured runs in RUNS rounds. Stop early when goes_on() is False.

    report(index of the run, seconds per step, overlap, farthest) is called after each run (see RunFigures). The first
    round uses the given order, and each later round a random order. overlap and farthest are measured before the first
    timed run.
    """
    made: dict[str, Snapshot] = {}  # by recipe: several runs start from the same world
    moments = [
        [Moment(_snapshot(each, made), measured_run.broadphase) for each in measured_run.snapshots]
        for measured_run in measured_runs
    ]
    order, chance = list(range(len(measured_runs))), Random(0)
    seen: dict[int, tuple[float | None, float | None]] = {}
    for turn in range(RUNS):
        for number in order:
            if not goes_on():
                return
            measured_run, own = measured_runs[number], moments[number]
            if turn == 0:
                own[0].time_run(own[0].here, WARM_STEPS, act=measured_run.act)
                seen[number] = _judge(own[0], measured_run.judged)
            spent = sum(
                moment.time_run(moment.here, measured_run.steps, measured_run.stage, measured_run.act) for moment in own
            ) / len(own)
            report(number, spent, *seen[number])
        chance.shuffle(order)


def _snapshot(given, made):
    if not isinstance(given, Recipe):
        return given
    return made.get(repr(given)) or made.setdefault(repr(given), given.make())


def _judge(moment, judged):
    """Return (deepest overlap, greatest distance that a body moved in one step) [px].

    Both are measured in a run from the snapshot `moment`. judged: the (first, last) step to include. If it is None, the
    result is (None, None).
    """
    if judged is None:
        return None, None
    first, last = judged
    way, rows = moment.way(moment.here, last), moment.snapshot.arrays["bodies"]
    start = np.stack([rows["center_x"], rows["center_y"]], axis=1)[np.argsort(rows["id"])]
    gaps = np.diff(np.concatenate([start[None], way.places]), axis=0)[first - 1 :, way.moves]
    return float(way.overlap[first - 1 :].max()), float(np.sqrt((gaps * gaps).sum(axis=2)).max(initial=0.0))
