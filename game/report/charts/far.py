"""Chart 9: how far from the origin a pile still is the pile that it is at the origin."""

import numpy as np

from game.report.chart import Axis, Chart, Panel, panel_is, time, value
from game.report.charts.solvers import times_of
from game.report.job import Job, Plan, Row, spread
from game.report.piles import overlap, stack, world_of

DISTANCES = (0.0, 1e3, 1e5, 1e6, 1e7, 1e8, 1e9)  # [px], both ways
SOLVERS = ("sequential_impulse", "soft_step")
STEPS, BOXES = 120, 10


def measure(solver: str) -> list[Row]:
    """A row per distance: how far boxes are from where they are in the same run at the origin, and their overlap."""
    steps, rows, near = {}, {}, None
    for away in DISTANCES:
        world = world_of(stack(BOXES), solver, 4, away=away)
        for _ in range(STEPS):
            world.step()
        places = np.stack([world.bodies["x"], world.bodies["y"]], axis=1) - away
        near = places if near is None else near
        steps[away] = world.step
        rows[away] = {
            "series": solver,
            "label": f"{solver}, {away:g} px away",
            "panel": "far",
            "away": away,
            "ulp": float(np.spacing(away)),
            "apart": float(np.hypot(*(places - near).T).max()),
            "overlap": overlap(world),
        }
    costs = times_of(steps)
    return [row | {"cost": spread(costs[away])} for away, row in rows.items()]


def _jobs(plan: Plan) -> list[Job]:
    return [Job(f"far/{solver}", "game.report.charts.far:measure", {"solver": solver}, 1.5) for solver in SOLVERS]


_away = Axis("from the origin [px]", value("away"))
CHART = Chart(
    9,
    "far",
    "Far from the origin",
    "How far out do a pile's boxes lie where they lie at the origin?",
    f"the same {BOXES} boxes at the origin, two seconds later; a dash is what a player can see",
    (
        Panel(
            "boxes",
            _away,
            Axis("apart from those at the origin [px]", value("apart"), mark=1.0),
            panel_is("far"),
            "series",
        ),
        Panel("overlap", _away, Axis("overlap [px]", value("overlap"), mark=1.0), panel_is("far"), "series"),
        Panel(
            "time", Axis("us a step", time("cost")), Axis("apart [px]", value("apart"), mark=1.0), panel_is("far"), ""
        ),
    ),
    _jobs,
)
