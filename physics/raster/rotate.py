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
OFFSETS = sorted(
    (((i + 0.5) / SAMPLES, (j + 0.5) / SAMPLES) for j in range(SAMPLES) for i in range(SAMPLES)),
    key=lambda at: ((at[0] - 0.5) ** 2 + (at[1] - 0.5) ** 2, at),
)
BAND = 1 << 14  # [px] turned at once: what that takes for a while stays in the cache and leaves no gaps in the heap


@dataclass(frozen=True)
class Turned:
    """A mask at one angle: solid[row, col], the origin from its top left corner, and each pixel's source."""

    solid: np.ndarray
    origin: tuple[float, float]
    source_x: np.ndarray  # (rows, columns) int16, -1 where clear
    source_y: np.ndarray


def bucket_of(angle: float, buckets: int) -> int:
    """The bucket whose angle is nearest."""
    return int(math.floor(angle * buckets / math.tau + 0.5)) % buckets


def turn(solid: np.ndarray, origin: tuple[float, float], bucket: int, buckets: int) -> Turned:
    """The mask turned by bucket/buckets of a full turn, clockwise on the screen, about its origin."""
    rows, columns = np.ogrid[: solid.shape[0], : solid.shape[1]]
    source_x, source_y = (np.where(solid, each, -1).astype(np.int16) for each in (columns, rows))
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
    columns, rows = (np.flatnonzero(solid.any(axis=axis)) for axis in (0, 1))
    left, top, right, bottom = columns[0], rows[0], columns[-1] + 1, rows[-1] + 1
    corner_x = np.array([left, right, right, left]) - origin[0]
    corner_y = np.array([top, top, bottom, bottom]) - origin[1]
    out_x, out_y = cosine * corner_x - sine * corner_y, sine * corner_x + cosine * corner_y
    origin_x, origin_y = -math.floor(out_x.min()), -math.floor(out_y.min())
    width, height = math.ceil(out_x.max()) + origin_x, math.ceil(out_y.max()) + origin_y

    padded = np.pad(solid, 1)  # a clear border catches what falls beside the source
    mixed = _mixed(padded)
    centered, coverage = np.empty((height, width), bool), np.empty((height, width), np.uint8)
    sources = np.empty((2, height, width), np.int16)
    along = np.arange(float(width)) - origin_x
    deep = max(1, BAND // width)
    for top in range(0, height, deep):
        band = slice(top, top + deep)
        down = np.arange(float(height))[band, None] - origin_y
        base_x = (cosine * along + sine * down + (origin[0] + 1.0)).ravel()
        base_y = (cosine * down - sine * along + (origin[1] + 1.0)).ravel()
        middle, covered, source = _sampled(padded, mixed, base_x, base_y, cosine, sine)
        centered[band], coverage[band] = middle.reshape(-1, width), covered.reshape(-1, width)
        sources[:, band] = np.stack(np.divmod(source, padded.shape[1])).reshape(2, -1, width) - 1
    kept = _as_many(centered, coverage, int(solid.sum()))
    source_y, source_x = np.where(kept, sources, np.int16(-1))
    return Turned(kept, (float(origin_x), float(origin_y)), source_x, source_y)


def _sampled(padded, mixed, base_x, base_y, cosine, sine):
    """(whether the centre is solid, how many samples are, the first solid one's pixel of the padded source or -1).

    base_x, base_y: the first corner of each pixel in the padded source [px]; mixed: as _mixed tells.
    """
    rows, columns = padded.shape

    def at(base_x, base_y, offset):
        x, y = offset
        at_x = np.clip(base_x + (cosine * x + sine * y), 0.0, columns - 1.0).astype(np.intp)
        at_y = np.clip(base_y + (cosine * y - sine * x), 0.0, rows - 1.0).astype(np.intp)
        return at_y * columns + at_x

    middle, *others = OFFSETS
    source = at(base_x, base_y, middle)
    centered = padded.ravel()[source]
    # Samples lie less than a pixel from the centre: where all pixels around its source are alike, it tells for them.
    some = np.flatnonzero(mixed.ravel()[source])
    coverage = centered * np.uint8(len(OFFSETS))
    source = np.where(centered, source, -1)  # the centre decides the colour
    covered, found, base_x, base_y = centered[some].astype(np.uint8), source[some], base_x[some], base_y[some]
    for offset in others:
        sample = at(base_x, base_y, offset)
        hit = padded.ravel()[sample]
        found = np.where(hit & (found < 0), sample, found)
        covered += hit
    coverage[some], source[some] = covered, found
    return centered, coverage, source


def _mixed(padded):
    """Where the 3 x 3 pixels around one are not all solid and not all clear; beyond the edge all is clear."""
    wide = np.pad(padded, 1).view(np.uint8)
    row = wide[:, :-2] + wide[:, 1:-1] + wide[:, 2:]
    count = row[:-2] + row[1:-1] + row[2:]
    return (count > 0) & (count < 9)


def _as_many(centered, coverage, wanted):
    """The centred pixels, up to the wanted number by adding the best covered or dropping the worst covered."""
    kept = centered.copy()
    missing = wanted - int(kept.sum())
    if missing > 0:
        kept.ravel()[_in_order(~kept & (coverage > 0), -coverage.astype(np.int8))[:missing]] = True
        return kept
    padded = np.pad(kept, 1)
    whole = coverage == len(OFFSETS)
    for some in (kept & ~whole, kept & whole):
        for at in _in_order(some, coverage).tolist():
            if missing == 0:
                return padded[1:-1, 1:-1]
            row, column = divmod(at, kept.shape[1])
            if _is_simple(padded[row : row + 3, column : column + 3]):
                padded[row + 1, column + 1] = False
                missing += 1
    return padded[1:-1, 1:-1]


def _in_order(some, key):
    """Where something is true, by a key for each pixel; alike ones by row and column."""
    at = np.flatnonzero(some)
    return at[np.argsort(key.ravel()[at], kind="stable")]


def _is_simple(around):
    """Whether the middle of 3 x 3 pixels can go without parting the others: its solid neighbours hang together."""
    ring = [bool(around[y, x]) for y, x in ((0, 0), (0, 1), (0, 2), (1, 2), (2, 2), (2, 1), (2, 0), (1, 0))]
    if not any(ring) or all(ring[1::2]):
        return False  # alone, or inside
    # Corners between two solid sides belong to them; count how often the ring changes from clear to solid.
    joined = [solid or (k % 2 == 0 and ring[k - 1] and ring[(k + 1) % 8]) for k, solid in enumerate(ring)]
    return sum(not joined[k - 1] and joined[k] for k in range(8)) == 1
