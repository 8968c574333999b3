"""A polygon in few convex parts, at once: for the outlines of masks, which are made while a game runs.

fitting.convex_parts finds the fewest parts in milliseconds; this takes a hundredth of the time by kernels, for about as
many (fitting.few_cuts).
"""

from collections.abc import Sequence

import numpy as np

from physics.fitting.few_cuts import bridge, cut_large, cut_reflex, merge
from physics.fitting.rings import SIDE, close_ring, put_side
from physics.fitting.tile_parts import put_parts
from physics.jit import kernel, subkernel
from physics.settings import MAX_CORNERS


def few_parts(rings: Sequence[np.ndarray]) -> list[tuple[np.ndarray, np.ndarray]]:
    """Parts as fitting.convex_parts.partition has them: (corners (k, 2) clockwise on the screen, inner (k,)).

    rings: known to be simple, of coordinates whose products are exact; the outer one (n, 2) [px] clockwise on the
    screen, holes the other way.
    """
    points = np.concatenate(rings)
    counts = np.array([len(ring) for ring in rings])
    room = 5 * len(points) + 4 * len(rings)  # each corner is cut off once or twice, each hole bridged
    sides = np.zeros(room, SIDE)
    corners, inner, found = np.empty((room, 2)), np.empty(room, bool), np.empty(room, np.int64)
    parts = cut_rings(points, counts, MAX_CORNERS, sides, corners, inner, found)
    if parts < 0:
        raise RuntimeError("the outline of a mask is no polygon: a defect of fitting.outline")
    ends = np.cumsum(found[:parts])
    return [
        (corners[last - count : last].copy(), inner[last - count : last].copy())
        for last, count in zip(ends.tolist(), found[:parts].tolist(), strict=True)
    ]


@subkernel
def join_touching(n, sides_inout):
    """Make one of rings that touch in a corner: there each goes on along the other one, so that the corner between
    them is the inside's. O(sides squared)."""
    for a in range(n):
        p = sides_inout[a]
        for b in range(a + 1, n):
            q = sides_inout[b]
            if p.x == q.x and p.y == q.y and p.apart != q.apart and p.alive and q.alive:
                before = p.previous
                sides_inout[before].next = b
                sides_inout[q.previous].next = a
                p.previous = q.previous
                q.previous = before
                apart = min(p.apart, q.apart)
                p.apart = apart
                k = p.next
                while k != a:
                    sides_inout[k].apart = apart
                    k = sides_inout[k].next


@kernel
def cut_rings(points, counts, most, sides_inout, corners_out, inner_out, counts_out):
    """The convex parts of rings: points (n, 2) [px], counts (rings,), most corners of a part; sides_inout: SIDE, room
    to work in; corners (n, 2), inner (n,), counts (parts,). Returns how many; -1: they are of no polygon."""
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
    n = bridge(n, sides_inout)
    if n < 0:
        return -1
    n = cut_reflex(n, sides_inout)
    if n < 0:
        return -1
    n = cut_large(n, most, sides_inout)
    merge(n, most, sides_inout)
    return put_parts(n, 0, sides_inout, corners_out, inner_out, counts_out)
