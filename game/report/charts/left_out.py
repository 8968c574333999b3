"""Chart 15, work that a step may leave out: pairs that a filter rejects, and the narrow phase.

A filter rejects pairs before they are tested. It is compared with a program that lets all pairs be tested and drops the
same pairs from the result. A world without a narrow phase reports pairs of boxes. It is compared with the world that
tests the shapes, in time and in false hits.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence

import numpy as np

from game.measure.rates import Rate
from game.measure.timing import timed_steps
from game.report.chart import Axis, Panel, panel_is, time, value
from game.report.claim import FAILS, HOLDS, Claim, ratio_of, region
from game.report.job import Job, Row, counted, spread
from game.report.sprites import mask_of
from physics import Capsule, Circle, Effects, Filter, Polygon, World

BODIES, SPACING, SPEED = 1000, 22.0, 12.0  # [px], [px/s]: few leave the others during a measurement
RADIUS = 12.0  # [px]: some three pairs of boxes for each body
SHARES = (0.0, 0.3, 0.7, 1.0)  # of the bodies that collide with none
STEPS = 20  # of a run
SAVES = 0.9  # greatest ratio of times that is a saving
SHAPES = ("upright boxes", "discs", "octagons", "thin capsules", "planes' pixels")
FILTERED, SKIPPED = "filtered before the narrow phase", "narrow phase left out"


def _octagon() -> Polygon:
    angles = 2.0 * np.pi * np.arange(8) / 8
    return Polygon(RADIUS * np.stack([np.cos(angles), np.sin(angles)], axis=1))


def _world(effects, shapes, filters=(Filter.ALL, Filter.ALL), apart=0.0):
    """Return a world of BODIES moving bodies, and the number of those that collide with none.

    shapes: shapes of every body. filters: Filters of the bodies that collide with none, and of the others. apart: share
    0..1 of bodies that collide with none; they have the first rows.
    """
    chance = np.random.default_rng(12)
    world, count = World(effects), round(apart * BODIES)
    places = chance.uniform(0.0, SPACING * BODIES**0.5, (BODIES, 2))
    turns, angle = chance.uniform(0.0, 2.0 * np.pi, (2, BODIES))
    speeds = SPEED * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    for rows, given in ((slice(0, count), filters[0]), (slice(count, BODIES), filters[1])):
        if len(places[rows]):
            world.add_bodies(shapes, places[rows], speeds[rows], turns[rows], kind="kinematic", filter=given)
    return world, count


def measure_filters() -> list[Row]:
    """Return two rows for each share of bodies that collide with none: time of a step and its hits, filtered or not.

    Both ways step the same bodies. Raises RuntimeError if they find other hits, because the times would mean nothing.
    """
    rows = []
    for share in SHARES:
        before, _ = _world(Effects.detection(), _octagon(), (Filter(1, 2), Filter(2, 2)), share)
        after, count = _world(Effects.detection(), _octagon(), apart=share)
        found: dict[str, np.ndarray] = {}

        def reject(world=before, found=found):
            world.step()
            found["before"] = world.touching()

        def drop(world=after, count=count, found=found):
            world.step()
            pairs = world.touching()
            found["after"] = pairs[(pairs >= world.bodies["id"][0] + count).all(axis=1)]

        costs = timed_steps({"before": reject, "after": drop}, STEPS)
        if not np.array_equal(found["before"], found["after"]):
            raise RuntimeError(f"{100 * share:g} % collide with none: a filter changes the hits of the others")
        rows += [
            {
                "series": f"filtered {name} the narrow phase",
                "label": f"{100 * share:g} % collide with none, filtered {name}",
                "panel": FILTERED,
                "share": share,
                "hits": len(found[name]),
                "cost": spread(cost),
            }
            for name, cost in costs.items()
        ]
    return rows


def _shapes(name: str) -> tuple:
    made: Mapping[str, Callable[[], object]] = {
        "upright boxes": lambda: Polygon.box(2.0 * RADIUS, 2.0 * RADIUS),
        "discs": lambda: Circle(RADIUS),
        "octagons": _octagon,
        "thin capsules": lambda: Capsule((-RADIUS, 0.0), (RADIUS, 0.0), 1.0),
        "planes' pixels": lambda: mask_of("planes", "player"),
    }
    return (made[name](),)


def measure_skipped() -> list[Row]:
    """Return two rows for each kind of shape: time of a step with the narrow phase and without it, and false hits."""
    rows = []
    for shape in SHAPES:
        (made,) = _shapes(shape)
        worlds = {"with": _world(Effects.detection(), made)[0], "without": _world(Effects(narrowphase=False), made)[0]}
        if shape == "upright boxes":
            for world in worlds.values():
                world.bodies["angle"] = 0.0
                world.touch(world.bodies["id"])
        pairs = {}
        for name, world in worlds.items():
            world.step()
            pairs[name] = set(map(tuple, world.touching().tolist()))
        wrong = Rate(len(pairs["without"] - pairs["with"]), len(pairs["without"]))
        rows += [
            {
                "series": f"{name} a narrow phase",
                "label": f"{shape}, {name} a narrow phase",
                "panel": SKIPPED,
                "shape": shape,
                "place": SHAPES.index(shape) + 1,
                "wrong": counted(wrong if name == "without" else Rate(0, wrong.total)),
                "cost": spread(cost),
            }
            for name, cost in timed_steps({name: world.step for name, world in worlds.items()}, STEPS).items()
        ]
    return rows


def jobs() -> list[Job]:
    """Return the two jobs."""
    return [Job(f"papers/{name}", f"{__name__}:measure_{name}", {}, 3.0) for name in ("filters", "skipped")]


def claims(rows: Sequence[Row]) -> Iterator[Claim]:
    """Yield the claims about filters and about a step without a narrow phase. rows: rows of the chart."""
    filtered = {(row["share"], "before" in row["series"]): row["cost"] for row in rows if row["panel"] == FILTERED}
    ratios = {
        f"{100 * s:g} %": ratio_of(filtered[s, True], filtered[s, False]) for s in SHARES if (s, True) in filtered
    }
    if ratios:
        text = "a filter before the narrow phase saves a tenth of a step, over the share that collides with none"
        yield region(text, ratios, (0.0, SAVES), "saves//saves none", "Ericson 2004, Real-Time Collision Detection")
    skipped = {(row["shape"], "without" in row["series"]): row for row in rows if row["panel"] == SKIPPED}
    shapes = [shape for shape in SHAPES if (shape, True) in skipped]
    if not shapes:
        return
    ratios = {shape: ratio_of(skipped[shape, True]["cost"], skipped[shape, False]["cost"]) for shape in shapes}
    text = "a step without its narrow phase saves a tenth, over kinds of shapes"
    yield region(text, ratios, (0.0, SAVES), "saves//saves none", "games that test rectangles")
    for shape in shapes:
        rate = Rate(*skipped[shape, True]["wrong"])
        low, high = rate.interval
        figure = f"{100 * rate.share:.1f} % of the hits of their boxes are false ({100 * low:.1f} to {100 * high:.1f})"
        verdict = HOLDS if rate.count == 0 else FAILS
        yield Claim(f"{shape}: the narrow phase may be left out, no hit is false", figure, verdict)


PANELS = (
    Panel(
        FILTERED,
        Axis("share that collides with none [%]", value("share", 100.0), log=False),
        Axis("us a step", time("cost"), log=False),
        panel_is(FILTERED),
        "series",
    ),
    Panel(
        f"{SKIPPED}: 1 {SHAPES[0]}, 2 {SHAPES[1]}, 3 {SHAPES[2]}, 4 {SHAPES[3]}, 5 {SHAPES[4]}",
        Axis("kind of shape", value("place"), log=False),
        Axis("us a step", time("cost"), log=False),
        panel_is(SKIPPED),
        "series",
    ),
)
