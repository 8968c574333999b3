"""Convex decomposition of a mask's outline. Flags mark the inner sides, which are shared by two parts."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from physics.jit import kernel, subkernel
from physics.outline.contour import pieces_of, smoothed_piece
from physics.outline.kept import Parts, fitted
from physics.outline.rings import SIDE, close_ring, put_side, write_parts
from physics.outline.rounding import rounded_core
from physics.settings import MAX_CORNERS

# ---- few parts -------------------------------------------------------------------------------------------------------
# Convex decomposition into few parts by kernels, for outlines of masks that are computed while a game runs.
#
# decompose.convex_parts finds the fewest parts, in milliseconds. few_parts finds about as many parts in a hundredth of
# the time (see "few cuts" in rings.py).


def few_parts(rings: Sequence[np.ndarray]) -> list[tuple[np.ndarray, np.ndarray]]:
    """Decompose a polygon with holes into few convex parts, fast. Return [(corners (k, 2), inner (k,) bool)].

    Corners are clockwise on the screen [px]; inner: whether the side k -> k + 1 is shared with another part. rings: the
    outer ring (n, 2) [px], clockwise on the screen, then holes, counter-clockwise. The rings must be simple, and
    products of their coordinates must have no rounding error; neither is checked.
    """
    points = np.concatenate(rings)
    counts = np.array([len(ring) for ring in rings])
    room = 5 * len(points) + 4 * len(rings)  # each corner is cut once or twice, each hole is bridged
    sides = np.zeros(room, SIDE)
    corners, inner, found = np.empty((room, 2)), np.empty(room, bool), np.empty(room, np.int64)
    parts = cut_rings(points, counts, MAX_CORNERS, sides, corners, inner, found)
    if parts < 0:
        raise RuntimeError("the outline of a mask is no polygon: a defect of outline.contour")
    ends = np.cumsum(found[:parts])
    return [
        (corners[last - count : last].copy(), inner[last - count : last].copy())
        for last, count in zip(ends.tolist(), found[:parts].tolist(), strict=True)
    ]


@subkernel
def join_touching(n, sides_inout):
    """Join rings that touch at a common corner into one ring that passes this corner twice. O(n²).

    n: number of sides (SIDE rows). The joined ring gets the lower of the two SIDE.apart values, so it is a hole only if
    both rings are holes.
    """
    for a in range(n):
        p = sides_inout[a]
        for b in range(a + 1, n):
            q = sides_inout[b]
            if p.x == q.x and p.y == q.y and p.apart != q.apart and p.alive and q.alive:
                before = p.previous
                sides_inout[before].next = b
                sides_inout[q.previous].next = a
                p.previous, q.previous = q.previous, before
                apart = min(p.apart, q.apart)
                p.apart = apart
                k = p.next
                while k != a:
                    sides_inout[k].apart = apart
                    k = sides_inout[k].next


@kernel
def cut_rings(points, counts, most, sides_inout, corners_out, inner_out, counts_out):
    """Decompose a polygon with holes into convex parts. Return their number, or -1 if the rings are not a polygon.

    points (n, 2) [px]: corners ring after ring, the outer ring first; counts (rings,): number of corners of each ring;
    most: largest number of corners of a part; sides_inout: SIDE rows, scratch; corners_out (n, 2) [px]: corners part
    after part; inner_out (n,): whether the side after each corner is shared by two parts; counts_out (parts,): number
    of corners of each part.
    """
    n = 0
    start = 0
    for ring in range(len(counts)):
        first = n
        for k in range(start, start + counts[ring]):
            n = put_side(n, first, points[k, 0], points[k, 1], False, sides_inout)
        start += counts[ring]
        n = close_ring(n, first, sides_inout)
        for k in range(first, n):
            sides_inout[k].apart = ring
    if len(counts) > 1:
        join_touching(n, sides_inout)
    return write_parts(n, most, 0, sides_inout, corners_out, inner_out, counts_out)


# ---- mask parts ------------------------------------------------------------------------------------------------------
# The outline of a mask as rounded convex parts; a flag marks inner sides, which two parts share.


class Part(NamedTuple):
    """Convex part of an outline in raster pixels: a polygon, capsule or disc, rounded by a radius."""

    corners: np.ndarray  # (k, 2) float64: 1 to 16 corners, clockwise on the screen; 1: a disc, 2: a capsule
    inner: np.ndarray  # (k,) bool: side k -> k + 1 is shared with another part
    radius: float  # [px]


def mask_parts(solid: np.ndarray, smooth: float = 0.5) -> list[Part]:
    """Return the convex parts of the outline of solid[row, col] bool; [] without solid pixels.

    A round piece becomes one part with a radius (rounding.py). Any other piece is decomposed into parts of radius 0
    (few_parts), each starting with its topmost, then leftmost corner. A full rectangle is one part. smooth [px]:
    largest distance of the outline from the pixels' edges; the union of the parts is as near to the pixels' edges as
    the result of contour.outline.
    """
    parts = fitted("mask_parts", solid, smooth, lambda: _joined(_fit(solid, smooth)))
    ends = np.cumsum(parts.counts)[:-1]
    corners, inner = np.split(parts.corners, ends), np.split(parts.inner, ends)
    if not len(parts.counts):
        return []
    return [Part(*each) for each in zip(corners, inner, parts.radii.tolist(), strict=True)]


def _joined(parts):
    if not parts:
        return Parts(np.zeros((0, 2)), np.zeros(0, bool), np.zeros(0, np.int64), np.zeros(0))
    return Parts(
        np.concatenate([each.corners for each in parts]),
        np.concatenate([each.inner for each in parts]),
        np.array([len(each.corners) for each in parts], np.int64),
        np.array([each.radius for each in parts], float),
    )


def _fit(solid, smooth):
    found = []
    for piece in pieces_of(solid, smooth):
        outer, holes = smoothed_piece(piece, smooth)
        round_one = None if holes else rounded_core(piece.outer, smooth)
        if round_one is not None:
            core, radius = round_one
            found.append(Part(core, np.zeros(len(core), bool), radius))
        else:
            found += [Part(corners, inner, 0.0) for corners, inner in few_parts([outer, *holes])]
    return found
