"""Chart 4: what a pile costs a step, and how well it stands, by solver and substeps.

The truth is rest: boxes that were set upon one another stay where they are, so every pixel that the highest sinks, and
every pixel that two share, is an error. Small Steps (Macklin et al. 2019) is where the question comes from.
"""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from typing import TypeVar

from game.measure.moment import failures_of
from game.measure.timing import Cost, seconds_a_step
from game.report.chart import Axis, Chart, Panel, panel_is, time, value
from game.report.claim import Claim, ordering, pair
from game.report.job import Job, Plan, Row, spread
from game.report.piles import BOX, PILES, overlap, world_of

WAYS = [
    ("projection", 1),
    *(("sequential_impulse", count) for count in (1, 2, 4, 8, 16)),
    *(("soft_step", count) for count in (1, 2, 4, 8, 16, 32, "auto")),
]
SETTLE, STEPS, RUNS = 120, 60, 5  # 300 steps in all
VISIBLE = 1.0  # [px]
Name = TypeVar("Name")
FALLEN = 0.5 * BOX  # [px] the highest came down by more


def measure(pile: str, quick: bool) -> list[Row]:
    """A row per way: two seconds of standing, then the cost of what stands, or lies."""
    made = PILES[pile]()
    ways = [way for way in WAYS if not quick or way[1] not in (2, 16)]
    steps, rows = {}, {}
    for solver, substeps in ways:
        world = world_of(made, solver, substeps)
        failures, deepest, fell = Counter(), 0.0, None
        for step in range(SETTLE):
            world.step()
            failures += failures_of(world)
            deepest = max(deepest, overlap(world))
            if fell is None and _sunk(world, made) > FALLEN:
                fell = (step + 1) * world.dt
        label = f"{solver}, {substeps}" if solver != "projection" else solver
        steps[label] = world.step
        rows[label] = {
            "series": solver,
            "label": label,
            "panel": pile,
            "substeps": substeps,
            "overlap": overlap(world),
            "deepest": deepest,
            "sunk": max(0.0, _sunk(world, made)),
            "stands_s": fell,
            "failures": dict(failures),
        }
    for label, cost in times_of(steps).items():
        rows[label]["cost"] = spread(cost)
    return list(rows.values())


def times_of(steps: Mapping[Name, Callable[[], object]]) -> dict[Name, Cost]:
    """Seconds a step of worlds by their step, which advance in turns of STEPS."""
    spent: dict[Name, list[float]] = {label: [] for label in steps}
    for _ in range(RUNS):
        for label, step in steps.items():
            spent[label].append(seconds_a_step(step, STEPS))
    return {label: Cost.of(each, STEPS) for label, each in spent.items()}


def _sunk(world, pile):
    """By how much the highest centre is below where it was set [px]."""
    return pile.height + float(world.bodies["center_y"][1:].min())


def _jobs(plan: Plan) -> list[Job]:
    chosen = ("stack of 10", "crooked 20", "pyramid of 20 rows", "100:1") if plan.quick else PILES
    return [
        Job(
            f"solvers/{pile}".replace(" ", "-").replace(":", "-to-"),
            "game.report.charts.solvers:measure",
            {"pile": pile, "quick": plan.quick},
            6.0 if "pyramid" in pile else 1.5,
        )
        for pile in chosen
    ]


def _claims(rows: Sequence[Row]) -> list[Claim]:
    found = []
    for pile in dict.fromkeys(row["panel"] for row in rows):
        good = {
            row["label"]: pair(row["cost"])
            for row in rows
            if row["panel"] == pile and row["stands_s"] is None and max(row["sunk"], row["overlap"]) <= VISIBLE
        }
        if len(good) > 1:
            found.append(ordering(f"{pile}, standing within a pixel", good))
    return found


CHART = Chart(
    4,
    "solvers",
    "Solvers and substeps",
    "What does it cost a step that a pile stands, and how deep do its boxes sink into each other?",
    "rest: whoever was set upon another stays there; every pixel of sinking or of overlap is an error",
    tuple(
        Panel(
            f"{pile}: {word}",
            Axis("us a step", time("cost")),
            Axis(f"{word} [px]", value(key), mark=VISIBLE),
            panel_is(pile),
        )
        for pile in PILES
        for word, key in (("overlap after 2 s", "overlap"), ("the highest has sunk by", "sunk"))
    ),
    _jobs,
    _claims,
)
