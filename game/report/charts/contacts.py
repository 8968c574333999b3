"""Chart 2: cost and accuracy of a contact for each tier of collision shape. The errors are those of normal and depth.

The reference is analytic: a disc against a disc or an upright square. The tiers are fitted to pixel masks of these
shapes. The outline of the pixels cannot be the reference, because its normals have only four directions.
"""

from collections.abc import Callable, Sequence
from math import pi

import numpy as np

from game.measure.pair_batch import PairBatch
from game.measure.timing import timed_in_turns
from game.report.chart import Axis, Chart, Panel, panel_is, time, value
from game.report.claim import Claim, ordering, pair
from game.report.job import Job, ReportScope, Row, spread
from physics import TIERS, Circle, PixelMask, Polygon, fit

RADIUS = 12.0  # [px] of the disc, half the width of the square
POSES, POSES_QUICK = 4000, 1200
DEEPEST = 0.2  # of the diameter: deeper overlaps have no unique direction of separation
REPEATS = 10  # tests of a batch in a run: 40,000 pairs, 200,000 in all


def disc_mask() -> PixelMask:
    """Return the PixelMask of all pixels whose centres are inside the disc."""
    side = int(2 * RADIUS)
    at = np.arange(side) + 0.5 - RADIUS
    return PixelMask(at[:, None] ** 2 + at[None, :] ** 2 <= RADIUS**2, origin=(RADIUS, RADIUS))


def square_mask() -> PixelMask:
    """Return the PixelMask of the square. All its pixels are solid."""
    side = int(2 * RADIUS)
    return PixelMask(np.ones((side, side), bool), origin=(RADIUS, RADIUS))


def of_disc(offset: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the exact normals and depths of contacts between a disc at the origin and discs of the same size.

    offset: (n, 2) positions of the other discs [px]. Shapes of the result: normals (n, 2), depths (n,) [px].
    """
    length = np.hypot(*offset.T)
    return offset / length[:, None], 2.0 * RADIUS - length


def of_square(offset: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the exact normals and depths of contacts between an upright square at the origin and discs.

    offset: (n, 2) positions of the discs [px], outside the square. Shapes of the result: normals (n, 2), depths (n,)
    [px].
    """
    nearest = np.clip(offset, -RADIUS, RADIUS)
    away = offset - nearest
    length = np.hypot(*away.T)
    return away / length[:, None], RADIUS - length


BODIES = {
    "disc against disc": (disc_mask, Circle(RADIUS), of_disc, True),
    "square against disc": (square_mask, Polygon.box(2 * RADIUS, 2 * RADIUS), of_square, False),
}


def offsets(truth: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]], count: int) -> np.ndarray:
    """Return (count, 2) random offsets [px] at which two shapes touch, distributed uniformly over the area.

    truth: of_disc or of_square, which determines the shapes. The shapes overlap by less than the share DEEPEST of a
    disc's diameter.
    """
    chance, found = np.random.default_rng(4), np.zeros((0, 2))
    while len(found) < count:
        tried = chance.uniform(-2.0 * RADIUS, 2.0 * RADIUS, (4 * count, 2))
        tried = tried[np.abs(tried).max(axis=1) > RADIUS]  # the disc's centre is beside the square
        depth = truth(tried)[1]
        found = np.concatenate([found, tried[(depth > 0.0) & (depth < DEEPEST * 2.0 * RADIUS)]])
    return found[:count]


def measure(body: str, count: int) -> list[Row]:
    """Return a row for each tier (kind of collision shape) of both bodies, and a row for the exact shapes.

    body: key of BODIES; count: number of poses.
    """
    make, shape, truth, turned = BODIES[body]
    first, second = make(), disc_mask()
    offset = offsets(truth, count)
    chance = np.random.default_rng(5)
    base, turns = chance.uniform(-500.0, 500.0, (count, 2)), chance.uniform(0.0, 2.0 * pi, (2, count))
    poses = [
        np.column_stack([base, turns[0] if turned else np.zeros(count)]),
        np.column_stack([base + offset, turns[1]]),
    ]
    shapes = {tier: (fit(first, tier), fit(second, tier)) for tier in TIERS} | {
        "closed form": ((shape,), (Circle(RADIUS),))
    }
    batches = {name: PairBatch(a, poses[0], b, poses[1]) for name, (a, b) in shapes.items()}
    rows = [_row(body, name, batch, *truth(offset)) for name, batch in batches.items()]
    works = {name: lambda batch=batch: [batch.test() for _ in range(REPEATS)] for name, batch in batches.items()}
    costs = timed_in_turns(works, {name: REPEATS * len(batch) for name, batch in batches.items()})
    return [row | {"cost": spread(costs[row["series"]])} for row in rows]


def _row(body, name, batch, normals, depths):
    """Return a row of the chart: the errors of the contacts that the narrow phase finds for a batch of pairs.

    If a pair has several manifolds, the deepest is used. body: panel of the row; name: series of the row. normals,
    depths: exact normal and depth [px] of the contact of each pair.
    """
    batch.test()
    pairs = batch.pair_of[batch.found["candidate"]]
    order = np.lexsort((batch.found["separation_1"], pairs))
    first = order[np.unique(pairs[order], return_index=True)[1]]
    reported, which = batch.found[first], pairs[first]
    normal = np.stack([reported["normal_x"], reported["normal_y"]], axis=1)  # from the first shape to the second
    cosine = np.clip((normal * normals[which]).sum(axis=1), -1.0, 1.0)
    degrees = np.degrees(np.arccos(cosine))
    deep = np.maximum(
        -np.minimum(reported["separation_1"], np.where(reported["count"] > 1, reported["separation_2"], np.inf)), 0.0
    )
    wrong = np.abs(deep - depths[which])
    return {
        "series": name,
        "label": name,
        "panel": body,
        "found": [len(first), len(depths)],
        "normal_error": [float(each) for each in np.percentile(degrees, (5, 50, 95))],
        "wrong_side": [int((degrees > 90.0).sum()), len(degrees)],
        "depth_error": [float(each) for each in np.percentile(wrong, (5, 50, 95))],
    }


def _jobs(scope: ReportScope) -> list[Job]:
    count = POSES_QUICK if scope.quick else POSES
    return [
        Job(f"contacts/{body}".replace(" ", "-"), f"{__name__}:measure", {"body": body, "count": count}, 2.0)
        for body in BODIES
    ]


def _claims(rows: Sequence[Row]) -> list[Claim]:
    return [
        ordering(f"a contact, {body}", {r["series"]: pair(r["cost"]) for r in rows if r["panel"] == body}, 1e9, "ns")
        for body in dict.fromkeys(row["panel"] for row in rows)
    ]


CHART = Chart(
    2,
    "contacts",
    "Contacts: normals and depths over their time",
    "In which direction, and how far, does a tier push a touching body?",
    "closed forms of discs and squares; the bars reach from the 5th to the 95th percentile of the poses",
    tuple(
        Panel(
            f"{word}, {body}",
            Axis("ns per contact", time("cost", "ns")),
            Axis(f"{word} off by [{unit}]", value(key), mark=1.0),
            panel_is(body),
        )
        for body in BODIES
        for word, key, unit in (("normal", "normal_error", "degrees"), ("depth", "depth_error", "px"))
    ),
    _jobs,
    _claims,
)
