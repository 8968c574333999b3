"""Chart 15: claims of papers that no other chart tests.

They are about the number of corners of polygons, kinds of shapes, iterations of GJK, events for persisting contacts,
filters, and the narrow phase.
"""

from collections.abc import Sequence
from math import cos, pi, sin

import numpy as np

from game.measure.pair_batch import PairBatch
from game.measure.timing import timed_in_turns, timed_steps
from game.report.chart import Axis, Chart, Panel, panel_is, time, value
from game.report.charts import left_out
from game.report.claim import Claim, at_least, ratio_of, region
from game.report.job import Job, ReportScope, Row, spread
from game.report.piles import EFFECTS, pyramid, world_of
from physics import Bounds, Capsule, Circle, Polygon, distance

CORNERS = (3, 4, 5, 6, 8, 10, 12, 16)
RADIUS, POSES, REPEATS = 12.0, 2000, 3  # [px], pairs, tests of a batch in a run
SETTLE = 120
LEAST = 50  # poses that are hits, or misses: with fewer, a kind is not timed
GJK_CORNERS, GAPS, CALLS = (4, 8, 16), (0.1, 1.0, 10.0, 100.0), 200  # gaps in px
KINDS = {
    "disc": Circle(RADIUS),
    "upright box": Bounds(Polygon.box(2.0 * RADIUS, 2.0 * RADIUS)),
    "turned box": Polygon.box(2.0 * RADIUS, 2.0 * RADIUS),
    "capsule": Capsule((-0.5 * RADIUS, 0.0), (0.5 * RADIUS, 0.0), 0.5 * RADIUS),
}


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
    """Return a row for each number of corners and each gap: the mean number of iterations of one call of GJK.

    A call measures the distance of two regular polygons, which are CALLS times turned at random. gap: distance of the
    circles around them [px].
    """
    chance, rows = np.random.default_rng(11), []
    for corners in GJK_CORNERS:
        angles = 2.0 * pi * np.arange(corners) / corners
        shape = Polygon(RADIUS * np.stack([np.cos(angles), np.sin(angles)], axis=1))
        for gap in GAPS:
            away = 2.0 * RADIUS + gap
            turns = chance.uniform(0.0, 2.0 * pi, (CALLS, 3)).tolist()
            made = [
                distance(shape, (0.0, 0.0, a), shape, (away * cos(way), away * sin(way), b)).iterations
                for a, b, way in turns
            ]
            rows.append(
                {
                    "series": f"{gap:g} px apart",
                    "label": f"{corners} corners, {gap:g} px apart",
                    "panel": "iterations",
                    "corners": corners,
                    "gap": gap,
                    "iterations": [min(made), sum(made) / CALLS, max(made)],
                    "calls": CALLS,
                }
            )
    return rows


def measure_shapes() -> list[Row]:
    """Return two rows for each kind of shape: the time to test a pair of it that touches, and a pair that does not.

    The boxes of all pairs overlap, so there is no miss of upright boxes. A shape is as wide as the disc.
    """
    chance = np.random.default_rng(13)
    works, pieces = {}, {}
    for name, shape in KINDS.items():
        share, way = np.sqrt(chance.random(POSES)), chance.uniform(0.0, 2.0 * pi, POSES)
        turns = chance.uniform(0.0, 2.0 * pi, (2, POSES))
        offset = 3.0 * RADIUS * share[:, None] * np.stack([np.cos(way), np.sin(way)], axis=1)
        first, second = np.column_stack([np.zeros((POSES, 2)), turns[0]]), np.column_stack([offset, turns[1]])
        tried = PairBatch((shape,), first, (shape,), second)
        tried.test()
        met, near = tried.met(), np.isin(np.arange(POSES), tried.pair_of)
        for kind, chosen in (("hit", met), ("miss", near & ~met)):
            if chosen.sum() >= LEAST:
                which = np.resize(np.flatnonzero(chosen), POSES)
                batch = PairBatch((shape,), first[which], (shape,), second[which])
                works[kind, name] = lambda batch=batch: [batch.test() for _ in range(REPEATS)]
                pieces[kind, name] = REPEATS * len(batch)
    return [
        {
            "series": kind,
            "label": f"{name}, {kind}",
            "panel": "shapes",
            "shape": name,
            "place": list(KINDS).index(name) + 1,
            "cost": spread(cost),
        }
        for (kind, name), cost in timed_in_turns(works, pieces).items()
    ]


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
        for name, seconds in (("corners", 1.5), ("shapes", 1.0), ("iterations", 1.0), ("events", 2.0))
    ] + left_out.jobs()


def _claims(rows: Sequence[Row]) -> list[Claim]:
    found, by = [], {(row["panel"], row["series"], row.get("corners")): row for row in rows}
    for kind in ("hit", "miss"):
        few, many = by.get(("corners", kind, 4)), by.get(("corners", kind, 16))
        if few and many:
            text = f"separating axes take longer the more edges there are: 16 corners against 4, a {kind}"
            found.append(at_least(text, ratio_of(many["cost"], few["cost"]), 1.1, "Gottschalk, Lin, Manocha 1996"))
    gaps = dict.fromkeys(row["gap"] for row in rows if row["panel"] == "iterations" and "gap" in row)
    for gap in gaps:
        rounds = {f"{row['corners']} corners": row["iterations"] for row in rows if row.get("gap") == gap}
        counts = {name: (mean, mean, mean) for name, (_, mean, _) in rounds.items()}
        text = f"GJK needs few iterations: ten a call on average, however many corners, {gap:g} px apart"
        claim = region(text, counts, (0.0, 10.0), "few//more", "Gilbert, Johnson, Keerthi 1988")
        found.append(claim._replace(figure=claim.figure.replace(" x)", " a call)")))
    for kind in ("hit", "miss"):
        costs = {row["shape"]: row["cost"] for row in rows if row["panel"] == "shapes" and row["series"] == kind}
        ratios = {name: ratio_of(costs["disc"], cost) for name, cost in costs.items() if name != "disc"}
        if ratios:
            text = f"sphere against sphere is the fastest test, over kinds of shapes, a {kind}"
            found.append(region(text, ratios, (0.0, 0.9), "faster than//no faster than", "Ericson 2004"))
    without, reported = by.get(("persist", "without", None)), by.get(("persist", "with", None))
    if without and reported:
        text = "events of what goes on touching cost a tenth of a step, and more"
        found.append(at_least(text, ratio_of(reported["cost"], without["cost"]), 1.1, "manuals, where they are off"))
    return [*found, *left_out.claims(rows)]


CHART = Chart(
    15,
    "papers",
    "What papers claim",
    "Do shapes, iterations, events and filters cost what papers claim?",
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
            "GJK: least, mean and most of a call",
            Axis("corners", value("corners"), log=False),
            Axis("iterations of a call", value("iterations"), log=False),
            panel_is("iterations"),
            "series",
        ),
        Panel(
            ", ".join(f"{k} {name}" for k, name in enumerate(KINDS, 1)),
            Axis("kind of shape", value("place"), log=False),
            Axis("ns per pair", time("cost", "ns"), log=False),
            panel_is("shapes"),
            "series",
        ),
        *left_out.PANELS,
    ),
    _jobs,
    _claims,
)
