"""Turns a mask to one of the angle buckets, always from its source, never from a turned one.

Every pixel of the turned mask is measured by how much of it the turned source covers, and the best covered ones are
kept until there are as many as the source has: the area is exact at every angle, thin lines neither thicken nor
fall apart as they do when pixel centres alone are sampled (hard_cases D5 to D7). Each kept pixel remembers the source
pixel that it shows, so that a sprite can be drawn from exactly the pixels that collide.
"""

import math
from dataclasses import dataclass

import numpy as np

SAMPLES = 8       # per side of a pixel: coverage in steps of 1/64


@dataclass(frozen=True)
class Turned:
    """A mask at one angle: solid[row, col], the origin from its top left corner, and each pixel's source."""
    solid: np.ndarray
    origin: tuple[float, float]
    source_x: np.ndarray        # (rows, columns) int, -1 where clear
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


def _quarter_turns(solid, origin, source_x, source_y, turns):
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

    coverage = np.zeros((height, width), np.int64)
    source_x, source_y = np.full((height, width), -1), np.full((height, width), -1)
    pixel_y, pixel_x = np.mgrid[0:height, 0:width]
    offsets = [((i + 0.5) / SAMPLES, (j + 0.5) / SAMPLES) for j in range(SAMPLES) for i in range(SAMPLES)]
    offsets.sort(key=lambda at: ((at[0] - 0.5) ** 2 + (at[1] - 0.5) ** 2, at))   # the centre decides the colour
    for offset_x, offset_y in offsets:
        x, y = pixel_x + (offset_x - origin_x), pixel_y + (offset_y - origin_y)
        at_x = np.floor(cosine * x + sine * y + origin[0]).astype(np.int64)
        at_y = np.floor(cosine * y - sine * x + origin[1]).astype(np.int64)
        inside = (at_x >= 0) & (at_y >= 0) & (at_x < solid.shape[1]) & (at_y < solid.shape[0])
        covered = inside & solid[np.where(inside, at_y, 0), np.where(inside, at_x, 0)]
        first = covered & (source_x < 0)
        source_x[first], source_y[first] = at_x[first], at_y[first]
        coverage += covered
    order = np.argsort(-coverage.ravel(), kind="stable")[:int(solid.sum())]
    order = order[coverage.ravel()[order] > 0]
    kept = np.zeros(height * width, bool)
    kept[order] = True
    kept = kept.reshape(height, width)
    return Turned(kept, (float(origin_x), float(origin_y)), np.where(kept, source_x, -1), np.where(kept, source_y, -1))
