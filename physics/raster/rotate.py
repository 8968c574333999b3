"""Turns a mask to one of the angle buckets, always from its source, never from a turned one.

A pixel whose centre falls on a solid source pixel is solid: that keeps thin lines in one piece. Then pixels are added
where the source covers most of them, or taken away where it covers least and nothing falls apart, until there are as
many as the source has: the area is right at every angle (hard_cases D5 to D7). Each kept pixel remembers the source
pixel that it shows, so that a sprite can be drawn from exactly the pixels that collide.
"""

import math
from dataclasses import dataclass

import numpy as np

SAMPLES = 5  # per side of a pixel, so that one is its centre: coverage in steps of 1/25


@dataclass(frozen=True)
class Turned:
    """A mask at one angle: solid[row, col], the origin from its top left corner, and each pixel's source."""

    solid: np.ndarray
    origin: tuple[float, float]
    source_x: np.ndarray  # (rows, columns) int, -1 where clear
    source_y: np.ndarray


def bucket_of(angle: float, buckets: int) -> int:
    """The bucket whose angle is nearest."""
    return int(math.floor(angle * buckets / math.tau + 0.5)) % buckets


def turn(solid: np.ndarray, origin: tuple[float, float], bucket: int, buckets: int) -> Turned:
    """The mask turned by bucket/buckets of a full turn, clockwise on the screen, about its origin."""
    rows, columns = np.indices(solid.shape) if solid.size else (np.zeros(solid.shape, int),) * 2
    source_x, source_y = np.where(solid, columns, -1), np.where(solid, rows, -1)
    if solid.size == 0 or not solid.any():
        return Turned(solid, origin, source_x, source_y)
    if 4 * bucket % buckets == 0:
        return _quarter_turns(solid, origin, source_x, source_y, 4 * bucket // buckets)
    return _any_turn(solid, origin, math.tau * bucket / buckets)


def _quarter_turns(solid, origin, source_x, source_y, turns: int):
    height, width = solid.shape
    x, y = origin
    origins = ((x, y), (height - y, x), (width - x, height - y), (y, width - x))
    turned = [np.ascontiguousarray(np.rot90(each, -turns)) for each in (solid, source_x, source_y)]
    return Turned(turned[0], origins[turns], turned[1], turned[2])


def _any_turn(solid, origin, angle):
    cosine, sine = math.cos(angle), math.sin(angle)
    ys, xs = np.nonzero(solid)
    left, top, right, bottom = xs.min(), ys.min(), xs.max() + 1, ys.max() + 1
    corner_x = np.array([left, right, right, left]) - origin[0]
    corner_y = np.array([top, top, bottom, bottom]) - origin[1]
    out_x, out_y = cosine * corner_x - sine * corner_y, sine * corner_x + cosine * corner_y
    origin_x, origin_y = -math.floor(out_x.min()), -math.floor(out_y.min())
    width, height = math.ceil(out_x.max()) + origin_x, math.ceil(out_y.max()) + origin_y

    rows, columns = solid.shape
    padded = np.zeros((rows + 2, columns + 2), bool)  # a clear border catches what falls beside the source
    padded[1:-1, 1:-1] = solid
    coverage = np.zeros(height * width, np.int64)
    centered = np.zeros(height * width, bool)
    source = np.full(height * width, -1)
    pixel_y, pixel_x = np.mgrid[0.0:height, 0.0:width]
    base_x = (cosine * (pixel_x - origin_x) + sine * (pixel_y - origin_y) + (origin[0] + 1.0)).ravel()
    base_y = (cosine * (pixel_y - origin_y) - sine * (pixel_x - origin_x) + (origin[1] + 1.0)).ravel()
    offsets = [((i + 0.5) / SAMPLES, (j + 0.5) / SAMPLES) for j in range(SAMPLES) for i in range(SAMPLES)]
    offsets.sort(key=lambda at: ((at[0] - 0.5) ** 2 + (at[1] - 0.5) ** 2, at))  # the centre decides the colour
    for number, (x, y) in enumerate(offsets):
        at_x = np.clip(base_x + (cosine * x + sine * y), 0.0, columns + 1.0).astype(np.intp)
        at_y = np.clip(base_y + (cosine * y - sine * x), 0.0, rows + 1.0).astype(np.intp)
        at = at_y * (columns + 2) + at_x
        covered = padded.ravel()[at]
        source = np.where(covered & (source < 0), at, source)
        coverage += covered
        if number == 0:
            centered = covered
    coverage, centered = coverage.reshape(height, width), centered.reshape(height, width)
    source_y, source_x = (each.reshape(height, width) - 1 for each in np.divmod(source, columns + 2))
    kept = _as_many(centered, coverage, int(solid.sum()))
    return Turned(kept, (float(origin_x), float(origin_y)), np.where(kept, source_x, -1), np.where(kept, source_y, -1))


def _as_many(centered, coverage, wanted):
    """The centred pixels, up to the wanted number by adding the best covered or dropping the worst covered."""
    kept = centered.copy()
    missing = wanted - int(kept.sum())
    if missing > 0:
        order = np.argsort(-np.where(kept, 0, coverage).ravel(), kind="stable")[:missing]
        kept.ravel()[order[coverage.ravel()[order] > 0]] = True
        return kept
    padded = np.pad(kept, 1)
    for at in np.argsort(np.where(kept, coverage, SAMPLES * SAMPLES + 1).ravel(), kind="stable").tolist():
        if missing == 0 or not kept.ravel()[at]:
            break
        row, column = divmod(at, kept.shape[1])
        if _is_simple(padded[row : row + 3, column : column + 3]):
            padded[row + 1, column + 1] = False
            missing += 1
    return padded[1:-1, 1:-1]


def _is_simple(around):
    """Whether the middle of 3 x 3 pixels can go without parting the others: its solid neighbours hang together."""
    ring = [bool(around[y, x]) for y, x in ((0, 0), (0, 1), (0, 2), (1, 2), (2, 2), (2, 1), (2, 0), (1, 0))]
    if not any(ring) or all(ring[1::2]):
        return False  # alone, or inside
    # Corners between two solid sides belong to them; count how often the ring changes from clear to solid.
    joined = [solid or (k % 2 == 0 and ring[k - 1] and ring[(k + 1) % 8]) for k, solid in enumerate(ring)]
    return sum(not joined[k - 1] and joined[k] for k in range(8)) == 1
