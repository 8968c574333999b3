"""Comparison of an engine with a row: all its scenes are simulated, and the worst figure is compared with the limit.

A test of one row is

    assert judge(table()["crooked_20"], Played(partial(Hitbox, substeps=8))).met
"""

import math
from dataclasses import dataclass

from tests.stability.study.recording import record


class Played:
    """Cache of the runs of one engine: each scene is simulated once, although several rows use it. make: scene ->
    engine.
    """

    def __init__(self, make):
        self.make, self.runs = make, {}

    def run(self, scene):
        if scene not in self.runs:
            self.runs[scene] = record(self.make(scene), scene)
        return self.runs[scene]

    def forget(self, scenes):
        """Remove the cached runs of all scenes except these, because the poses of long runs need much memory."""
        self.runs = {scene: run for scene, run in self.runs.items() if scene in scenes}


@dataclass(frozen=True)
class Verdict:
    """Worst figure of a row, and how many of its seeds stood or fell."""

    figure: float  # nan: something falls that ought to stand, or the run does not show it
    met: bool
    fell: float | None  # [s] the first fall of one that ought to stand
    stood: int
    seeds: int


def worst(values):
    """Return the value with the greatest absolute value; NaN if any value is NaN or there are no values."""
    values = list(values)
    if not values or any(math.isnan(each) for each in values):
        return math.nan
    return max(values, key=abs)


def scenes_of(row, seeds=None):
    """Return the scenes of the first `seeds` seeds of a row; None: of all seeds."""
    return [row.scene(seed) for seed in range(row.seeds if seeds is None else min(row.seeds, seeds))]


def judge(row, played, seeds=None):
    """Return the Verdict on a row from its first `seeds` seeds (None: all). played: the `Played` of the engine."""
    runs = [played.run(scene) for scene in scenes_of(row, seeds)]
    fell = [run.fell for run in runs if row.stands and run.fell is not None]
    figure = math.nan if fell else worst(float(row.measure(run)) for run in runs)
    return Verdict(figure, not fell and row.met(figure), min(fell, default=None), len(runs) - len(fell), len(runs))
