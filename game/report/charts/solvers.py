"""Chart 4: cost of a step of a pile, and the pile's accuracy, for each solver and number of substeps.

The reference is rest: stacked boxes should not move. So any rise or fall of the highest box, and any overlap, is an
error. Macklin et al., Small Steps (2019), compare solvers in this way.
"""

from collections import Counter
from collections.abc import Sequence

from game.measure.moment import failures_of
from game.measure.timing import timed_steps
from game.report.chart import Axis, Chart, Panel, panel_is, time, value
from game.report.charts import solver_parts
from game.report.claim import Claim, ordering, pair
from game.report.job import Job, ReportScope, Row, spread
from game.report.piles import PILES, world_of
from game.report.standing import VISIBLE, Watch

WAYS = [
    ("projection", 1),
    *(("sequential_impulse", count) for count in (1, 2, 4, 8, 16)),
    *(("soft_step", count) for count in (1, 2, 4, 8, 16, 32, "auto")),
]


def measure(pile: str, quick: bool) -> list[Row]:
    """Return a row for each setting: the pile's accuracy over two seconds, and after that the cost of a step.

    The cost is measured even if the pile has fallen. pile: key of PILES; quick: True measures fewer settings.
    """
    made = PILES[pile]()
    ways = [way for way in WAYS if not quick or way[1] not in (2, 16)]
    steps, rows = {}, {}
    for solver, substeps in ways:
        world = world_of(made, solver, substeps)
        watch, failures = Watch(world, made), Counter()
        for _ in range(watch.settle):
            world.step()
            failures += failures_of(world)
            watch.look()
        label = f"{solver}, {substeps}" if solver != "projection" else solver
        steps[label] = world.step
        rows[label] = {
            "series": solver,
            "label": label,
            "panel": pile,
            "substeps": substeps,
            "ignored_effects": list(world.ignored_effects),
            **watch.found(),
            "failures": dict(failures),
        }
    for label, cost in timed_steps(steps).items():
        rows[label]["cost"] = spread(cost)
    return list(rows.values())


def _jobs(scope: ReportScope) -> list[Job]:
    chosen = ("stack of 10", "crooked 20", "pyramid of 20 rows", "100:1") if scope.quick else PILES
    return [
        Job(
            f"solvers/{pile}".replace(" ", "-").replace(":", "-to-"),
            f"{__name__}:measure",
            {"pile": pile, "quick": scope.quick},
            6.0 if "pyramid" in pile else 1.5,
        )
        for pile in chosen
    ] + solver_parts.jobs(scope)


def _claims(rows: Sequence[Row]) -> list[Claim]:
    found = []
    for pile in PILES:
        good = {
            row["label"]: pair(row["cost"])
            for row in rows
            if row["panel"] == pile and row["stands_s"] is None and row["error"] <= VISIBLE
        }
        if len(good) > 1:
            found.append(ordering(f"{pile}, standing within a pixel", good))
    return [*found, *solver_parts.claims(rows)]


def _panels_of(pile: str) -> list[Panel]:
    errors = (
        Axis("overlap [px]", value("overlap"), mark=VISIBLE),
        Axis("the highest is off by [px]", value("off"), mark=VISIBLE),
        Axis("energy won at most [% of that of its height]", value("won", 100.0)),
    )
    return [
        *(
            Panel(f"{pile}: {each.label.split(' [')[0]}", Axis("us a step", time("cost")), each, panel_is(pile))
            for each in errors
        ),
        *solver_parts.panels(pile),
    ]


CHART = Chart(
    4,
    "solvers",
    "Solvers and substeps",
    "How long is a step of a standing pile, and how deep do its boxes overlap?",
    "rest: a stacked box stays in place, so each pixel off, up or down, or of overlap, is an error",
    tuple(panel for pile in PILES for panel in _panels_of(pile)),
    _jobs,
    _claims,
)
