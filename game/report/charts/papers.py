"""Chart 15: claims of papers that no other chart tests.

They are about the number of corners of polygons, iterations of GJK, and events for persisting contacts.
"""

from collections.abc import Sequence
from math import pi

import numpy as np

from game.measure.pair_batch import PairBatch
from game.measure.timing import timed_in_turns, timed_steps
from game.report.chart import Axis, Chart, Panel, panel_is, time, value
from game.report.claim import Claim, at_least, at_most, ratio_of
from game.report.job import Job, ReportScope, Row, spread
from game.report.piles import EFFECTS, pyramid, world_of
from physics import Effects, Polygon, World

CORNERS = (3, 4, 5, 6, 8, 10, 12, 16)
RADIUS, POSES, REPEATS = 12.0, 2000, 3  # [px], pairs, tests of a batch in a run
SETTLE = 120


def measure_corners() -> list[Row]:
    """Return the time to test a pair of polygons: two rows for each number of corners.

    One row is for touching pairs ("hit"), the other for pairs whose boxes overlap but which do not touch ("miss").
    """
    chance = np.random.default_rng(10)
    works, pieces = {}, {}
    for corners in CORNERS:
        angles = 2.0 * pi * np.arange(corners) / corners
        shape = Polygon(RADIUS * np.stack([np.cos(angles), np.sin(angles)], axis=1))
        turns = chance.uniform(0.0, 2.0 * pi, (2, POSES))
        for kind, far in (("hit", 1.2), ("miss", 2.05)):
            way = chance.uniform(0.0, 2.0 * pi, POSES) if kind == "hit" else np.full(POSES, pi / 4.0)
            offset = far * RADIUS * np.stack([np.cos(way), np.sin(way)], axis=1)
            base = chance.uniform(-500.0, 500.0, (POSES, 2))
            batch = PairBatch(
                (shape,), np.column_stack([base, turns[0]]), (shape,), np.column_stack([base + offset, turns[1]])
            )
            works[kind, corners] = lambda batch=batch: [batch.test() for _ in range(REPEATS)]
            pieces[kind, corners] = REPEATS * len(batch.candidates)
    costs = timed_in_turns(works, pieces)
    return [
        {
            "series": kind,
            "label": f"{corners} corners, {kind}",
            "panel": "corners",
            "corners": corners,
            "cost": spread(cost),
        }
        for (kind, corners), cost in costs.items()
    ]


def measure_iterations() -> list[Row]:
    """Return a row for each number of corners: the mean number of GJK iterations per time-of-impact search.

    The searches are made for polygons that fly and rotate.
    """
    rows = []
    for corners in (4, 8, 16):
        angles = 2.0 * pi * np.arange(corners) / corners
        shape = Polygon(RADIUS * np.stack([np.cos(angles), np.sin(angles)], axis=1))
        world = World(Effects(response=True, rotation=True, continuous=True))
        count = 200
        chance = np.random.default_rng(11)
        x = 120.0 * np.arange(count)
        world.add_bodies(Polygon.box(60.0, 4.0), np.column_stack([x, np.zeros(count)]), kind="static")
        starts = np.column_stack([x, chance.uniform(-90.0, -20.0, count)])
        turned, speeds = chance.uniform(0.0, pi, count), np.full((count, 2), (0.0, 6000.0))
        world.add_bodies(shape, starts, speeds, turned, angular_velocity=20.0, continuous="toi")
        rounds = calls = 0
        for _ in range(2):
            world.step()
            rounds += world.profile.counters["gjk_iterations"]
            calls += world.profile.counters["toi_calls"]
        rows.append(
            {
                "series": "GJK",
                "label": f"{corners} corners",
                "panel": "iterations",
                "corners": corners,
                "iterations": rounds / calls if calls else None,
                "calls": calls,
            }
        )
    return rows


def measure_events() -> list[Row]:
    """Return two rows with the cost of a step of a pyramid: with the effect `persist`, and without it.

    This effect reports an event in every step for each contact that persists.
    """
    worlds = {}
    for name, effects in (("without", EFFECTS), ("with", EFFECTS.with_(persist=True))):
        world = world_of(pyramid(20), "soft_step", 4, effects)
        for _ in range(SETTLE):
            world.step()
        worlds[name] = world
    return [
        {
            "series": name,
            "label": f"{name} persist events",
            "panel": "persist",
            "contacts": len(worlds[name].contacts),
            "cost": spread(cost),
        }
        for name, cost in timed_steps({name: world.step for name, world in worlds.items()}).items()
    ]


def _jobs(scope: ReportScope) -> list[Job]:
    work = __name__
    return [
        Job(f"papers/{name}", f"{work}:measure_{name}", {}, seconds)
        for name, seconds in (("corners", 1.5), ("iterations", 1.0), ("events", 2.0))
    ]


def _claims(rows: Sequence[Row]) -> list[Claim]:
    found, by = [], {(row["panel"], row["series"], row.get("corners")): row for row in rows}
    for kind in ("hit", "miss"):
        few, many = by.get(("corners", kind, 4)), by.get(("corners", kind, 16))
        if few and many:
            text = f"separating axes take longer the more edges there are: 16 corners against 4, a {kind}"
            found.append(at_least(text, ratio_of(many["cost"], few["cost"]), 1.1, "Gottschalk, Lin, Manocha 1996"))
    rounds = [row["iterations"] for row in rows if row["panel"] == "iterations" and row["iterations"] is not None]
    if rounds:
        most = (min(rounds), max(rounds), max(rounds))
        text = "GJK needs few iterations, however many corners: ten in a whole time of impact"
        found.append(at_most(text, most, 10.0, "Gilbert, Johnson, Keerthi 1988", "iterations at most"))
    without, reported = by.get(("persist", "without", None)), by.get(("persist", "with", None))
    if without and reported:
        text = "events of what goes on touching cost a tenth of a step, and more"
        found.append(at_least(text, ratio_of(reported["cost"], without["cost"]), 1.1, "manuals, where they are off"))
    return found


CHART = Chart(
    15,
    "papers",
    "What papers claim",
    "Do edges, iterations and events cost what papers claim?",
    "counts and times, without errors",
    (
        Panel(
            "corners of two polygons",
            Axis("corners", value("corners"), log=False),
            Axis("ns per pair", time("cost", "ns"), log=False),
            panel_is("corners"),
            "series",
        ),
        Panel(
            "GJK in a time of impact",
            Axis("corners", value("corners"), log=False),
            Axis("iterations of one", value("iterations"), log=False),
            panel_is("iterations"),
            "series",
        ),
    ),
    _jobs,
    _claims,
)
