"""Chart 16: error of joints under load, and cost of a step, for both joint solvers and pymunk.

Each case of a scene is run from its start with each setting. The run is timed while its error is measured.
"""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from random import Random
from statistics import median
from typing import NamedTuple

import numpy as np

from game.measure.timing import Cost, clock, undisturbed
from game.report.chart import Axis, Chart, Panel, panel_is, time, value
from game.report.claim import TIE, Claim, at_least, at_most, ordering, pair, ratio_of
from game.report.job import Job, ReportScope, Row, spread
from game.report.linkages import METER, Gaps, Linkage, arm, bridge, chain, poses_in, world_of
from game.report.pymunk_linkages import BIASES, Space
from game.report.pymunk_piles import library
from game.report.standing import VISIBLE
from physics.annotations import Substeps

STEPS = 240
CASES = 5  # angles or speeds at the start, evenly from the first to the last
TORN = METER  # [px] gap from which a joint counts as torn
LEAST = 1e-9  # [px] smaller errors are rounding errors, whose ratio has no meaning
ITERATIVE, DIRECT, USUAL = "iterative", "direct", 4
PEER = "pymunk"
OFF, GAP = "tip off by [px]", "widest gap of a joint [px]"
SCENES: dict[str, tuple[Callable[[float], Linkage], str]] = {
    "ball of 1000 rods on a chain": (partial(chain, 1000.0), GAP),
    "ball of 100 rods on a chain": (partial(chain, 100.0), GAP),
    "ball of 10 rods on a chain": (partial(chain, 10.0), GAP),
    "ball of 100 rods on a bridge": (partial(bridge, 100.0), GAP),
    "arm of eight welds": (arm, OFF),
}
QUICK = ("ball of 100 rods on a chain", "arm of eight welds")


class Setting(NamedTuple):
    """One way to solve joints. solver: ITERATIVE, DIRECT or PEER (pymunk).

    substeps: number of substeps; iterations, bias: settings of pymunk. bias is a key of BIASES.
    """

    solver: str
    substeps: Substeps
    iterations: int = 0
    bias: str = ""  # key of BIASES

    @property
    def series(self) -> str:
        """Name of the curve in the chart that the setting belongs to."""
        return self.solver if self.solver != PEER else f"{PEER}, {substeps_text(self.substeps)}"

    @property
    def label(self) -> str:
        """Name of the setting, as shown in the chart."""
        times = f" x {self.iterations} iterations{self.bias}" if self.solver == PEER else ""
        return f"{self.solver}, {substeps_text(self.substeps)}{times}"

    def started(self, linkage: Linkage) -> tuple[Callable[[], object], Callable[[], np.ndarray]]:
        """Start a new simulation of the linkage, and return two functions (step, poses).

        step() makes one step, and poses() returns the poses of the bodies.
        """
        if self.solver == PEER:
            space = Space(linkage, self.iterations, int(self.substeps), BIASES[self.bias])
            return space.step, space.poses
        world = world_of(linkage, DIRECT if self.solver == DIRECT else ITERATIVE, self.substeps)
        return world.step, lambda: poses_in(world)


def substeps_text(count: Substeps) -> str:
    """Return a number of substeps as text, also for "auto"."""
    return "1 substep" if count == 1 else f"{count} substeps"


def settings_of(quick: bool) -> list[Setting]:
    """Return the settings to measure. quick: True returns fewer settings."""
    counts: tuple[Substeps, ...] = (1, 4, 16) if quick else (1, 2, 4, 8, 16, "auto")
    steps, iterations = ((1, 4), (5, 20)) if quick else ((1, 2, 4, 8), (5, 10, 20, 40, 80))
    return [
        *(Setting(solver, count) for solver in (ITERATIVE, DIRECT) for count in counts),
        *(Setting(PEER, n, m, bias) for n in steps for m in iterations for bias in BIASES),
    ]


def run_case(setting: Setting, linkage: Linkage, steps: int = STEPS) -> tuple[float, float]:
    """Run a linkage from its start with one setting. Return (greatest error [px], mean time of a step [s])."""
    step, poses = setting.started(linkage)
    gaps, worst, spent = Gaps(linkage, poses()), 0.0, 0.0
    for _ in range(steps):
        started = clock()
        step()
        spent += clock() - started
        worst = max(worst, gaps.widest(poses()))
    return worst, spent / steps


def measure(scene: str, quick: bool) -> list[Row]:
    """Return a row for each setting: its error over all cases of a scene, and the cost of a step.

    scene: key of SCENES; quick: True measures fewer settings and cases. For pymunk, each setting is measured with every
    `error_bias`, and the row with the smallest error is returned. Without pymunk, a row without figures says so.
    """
    make, _ = SCENES[scene]
    settings, missing = settings_of(quick), ""
    try:
        library()
    except ModuleNotFoundError as error:
        settings, missing = [each for each in settings if each.solver != PEER], str(error)
    errors: dict[Setting, list[float]] = {each: [] for each in settings}
    spent: dict[Setting, list[float]] = {each: [] for each in settings}
    chance, order = Random(0), list(settings)
    for setting in settings:
        run_case(setting, make(0.0), 2)  # compiles and loads what it calls
    with undisturbed():
        for share in (0.0, 1.0) if quick else np.linspace(0.0, 1.0, CASES).tolist():
            chance.shuffle(order)
            for setting in order:
                error, seconds = run_case(setting, make(share))
                errors[setting].append(error)
                spent[setting].append(seconds)
    found = [row_of(scene, each, errors[each], spent[each]) for each in settings]
    return [*best_biases(found), *([{"series": PEER, "label": missing, "panel": scene}] if missing else [])]


def row_of(scene: str, setting: Setting, errors: list[float], spent: list[float]) -> Row:
    """Return the row of a setting. errors: error [px] of each case; spent: mean time of a step [s] in each case."""
    return {
        "series": setting.series,
        "label": setting.label,
        "panel": scene,
        "solver": setting.solver,
        "substeps": setting.substeps,
        "iterations": setting.iterations,
        "error": [min(errors), median(errors), max(errors)],
        "cases": errors,
        "failures": {"cases with a joint torn": sum(error > TORN for error in errors)},
        "cost": spread(Cost.of(spent, STEPS)),
    }


def best_biases(rows: Sequence[Row]) -> list[Row]:
    """Return the rows, with only the best bias of each setting.

    Of the rows that differ only in their bias, the one with the smallest median error is returned.
    """
    best: dict[tuple, Row] = {}
    for row in rows:
        key = row["solver"], row["substeps"], row["iterations"]
        if key not in best or row["error"][1] < best[key]["error"][1]:
            best[key] = row
    return list(best.values())


def _jobs(scope: ReportScope) -> list[Job]:
    return [
        Job(
            f"joints/{scene}".replace(" ", "-"),
            f"{__name__}:measure",
            {"scene": scene, "quick": scope.quick},
            1.5 if scope.quick else 12.0,
        )
        for scene in (QUICK if scope.quick else SCENES)
    ]


def times_wider(wide: Row, narrow: Row) -> tuple[float, float, float]:
    """Return (least, median, greatest) of the ratios of two rows' errors, wide / narrow.

    There is one ratio for each case of the scene.
    """
    ratios = [max(a, LEAST) / max(b, LEAST) for a, b in zip(wide["cases"], narrow["cases"], strict=True)]
    return min(ratios), median(ratios), max(ratios)


def claims_of(scene: str, rows: Sequence[Row]) -> Iterator[Claim]:
    """Yield the claims about one scene. rows: the rows of this scene."""
    measured = [row for row in rows if "cases" in row]
    yield from (Claim(f"{scene}: beside {row['series']}", row["label"], TIE) for row in rows if "cases" not in row)
    known = {(row["solver"], row["substeps"]): row for row in measured if row["solver"] != PEER}
    good = {row["label"]: pair(row["cost"]) for row in measured if row["error"][2] <= VISIBLE}
    if len(good) > 1:
        yield ordering(f"{scene}, within a pixel in every case", good)
    loose, tight = known[ITERATIVE, USUAL], known[DIRECT, USUAL]
    both = substeps_text(USUAL)
    yield at_least(
        f"{scene}, {both}: iterative errs at least ten times as much as direct", times_wider(loose, tight), 10.0
    )
    yield at_most(
        f"{scene}, {both}: direct costs at most half as much again", ratio_of(tight["cost"], loose["cost"]), 1.5
    )
    peers = [row for row in measured if row["solver"] == PEER]
    if peers:
        best = min(peers, key=lambda row: row["error"][1])
        text = f"{scene}: {best['label']}, the closest of pymunk, errs at least ten times as much as direct, {both}"
        yield at_least(text, times_wider(best, tight), 10.0)


def _claims(rows: Sequence[Row]) -> list[Claim]:
    found = []
    for scene in SCENES:
        mine = [row for row in rows if row["panel"] == scene]
        found += claims_of(scene, mine) if mine else []
    return found


CHART = Chart(
    16,
    "joints",
    "Joints under load",
    "How far do loaded joints come apart, and what does it cost to hold them?",
    "the anchors of a joint are one point, and the tip of a rigid arm turns with its base; bars: five angles or speeds",
    tuple(
        Panel(
            scene,
            Axis("us a step", time("cost")),
            Axis(word, value("error"), mark=VISIBLE, decades=12),
            panel_is(scene),
            "series",
        )
        for scene, (_, word) in SCENES.items()
    ),
    _jobs,
    _claims,
)
