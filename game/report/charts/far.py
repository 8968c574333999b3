"""Chart 9: the distance from the origin up to which a pile behaves as it does at the origin."""

from collections import Counter
from collections.abc import Sequence

import numpy as np

from game.measure.moment import failures_of
from game.measure.timing import timed_steps
from game.report.chart import Axis, Chart, Curve, Panel, panel_is, time, value
from game.report.claim import FAILS, HOLDS, Claim
from game.report.job import Job, ReportScope, Row, spread
from game.report.piles import overlap, stack, world_of
from physics import World
from physics.annotations import SolverName

METER = 32.0  # [px]
DISTANCES = (0.0, 1e3, 1e4, 1e5, 5000.0 * METER, 1e6, 1e7, 1e8, 1e9)  # [px] in x and in y
SOLVERS = ("sequential_impulse", "soft_step")
STEPS, BOXES = 120, 10
SIZE = 30.3  # [px] of a box: round numbers would be exact on the grid of a coarse float
VISIBLE = 1.0  # [px]
ROUNDED = ("x", "y", "angle")


def round_poses(world: World) -> None:
    """Round the poses of all bodies to float32, as if they were stored in that type. All other values stay float64."""
    for name in ROUNDED:
        world.bodies[name] = world.bodies[name].astype(np.float32)
    world.touch(world.bodies["id"])


def measure(solver: SolverName) -> list[Row]:
    """Return two rows for each distance from the origin: poses stored in float64, and poses rounded to float32.

    A row contains the overlap, and the greatest distance of a box from its position in the run at the origin. Poses are
    rounded after every step. Only the float64 rows have a time, because no solver works in float32.
    """
    steps, rows, near = {}, {}, None
    for single in (False, True):
        for away in DISTANCES:
            world, failures = world_of(stack(BOXES, SIZE), solver, 4, away=away), Counter()
            for _ in range(STEPS):
                world.step()
                failures += failures_of(world)
                if single:
                    round_poses(world)
            places = np.stack([world.bodies["x"], world.bodies["y"]], axis=1) - away
            near = places if near is None else near
            if not single:
                steps[single, away] = world.step
            series = f"{solver}, poses in float32" if single else solver
            rows[single, away] = {
                "series": series,
                "label": f"{series}, {away:g} px away",
                "panel": "far",
                "solver": solver,
                "away": away,
                "single": single,
                "ulp": float(np.spacing(np.float32(away) if single else away)),
                "apart": float(np.hypot(*(places - near).T).max()),
                "overlap": overlap(world),
                "failures": dict(failures),
            }
    costs = timed_steps(steps)
    return [row | ({"cost": spread(costs[key])} if key in costs else {}) for key, row in rows.items()]


def _jobs(scope: ReportScope) -> list[Job]:
    return [Job(f"far/{solver}", f"{__name__}:measure", {"solver": solver}, 2.5) for solver in SOLVERS]


def _claims(rows: Sequence[Row]) -> list[Claim]:
    found = []
    for solver in SOLVERS:
        for single, limit, source in ((False, max(DISTANCES), ""), (True, 5000.0 * METER, "Jolt: about 5 km")):
            mine = [row for row in rows if (row["solver"], row["single"]) == (solver, single) and row["away"] <= limit]
            if mine:
                worst = max(mine, key=lambda row: row["apart"])
                kind = "float32, solved in float64" if single else "float64"
                text = f"{solver}, poses in {kind}: within a pixel as far as {limit / METER / 1000.0:,.0f} km"
                figure = f"{worst['apart']:.3g} px at most, {worst['away'] / METER / 1000.0:,.0f} km away"
                found.append(Claim(text, figure, HOLDS if worst["apart"] <= VISIBLE else FAILS, source))
    return found


ULPS = (
    Curve("1 ulp of float32", lambda away: float(np.spacing(np.float32(away)))),
    Curve("1 ulp of float64", lambda away: float(np.spacing(away))),
)
_away = Axis("from the origin [px]", value("away"), decades=7)
CHART = Chart(
    9,
    "far",
    "Far from the origin",
    "Up to what distance does a pile behave as it does at the origin?",
    f"the same {BOXES} boxes at the origin, two seconds later; dots are the resolution of float32 and float64",
    (
        Panel(
            "boxes",
            _away,
            Axis("apart from those at the origin [px]", value("apart"), mark=1.0, decades=16),
            panel_is("far"),
            "series",
            curves=ULPS,
        ),
        Panel("overlap", _away, Axis("overlap [px]", value("overlap"), mark=1.0), panel_is("far"), "series"),
        Panel(
            "time", Axis("us a step", time("cost")), Axis("apart [px]", value("apart"), mark=1.0), panel_is("far"), ""
        ),
    ),
    _jobs,
    _claims,
)
