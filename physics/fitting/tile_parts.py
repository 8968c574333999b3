"""The outline of one tile of a larger mask in convex parts: where it is carved only touched tiles are made anew.

A tile's parts cover what is solid in it; where its border has solid on the other side too the parts' sides are inner.
The parts of neighbouring tiles have the same points on their common border (fitting.crossings) and together are an
outline as in fitting.outline, within the same distances of the pixels' edges.
"""

from functools import cache
from typing import NamedTuple

import numpy as np

from physics.fitting.cracks import Window
from physics.fitting.crossings import SEEN
from physics.fitting.few_cuts import bridge, cut_large, cut_reflex, merge
from physics.fitting.kept import Parts, fitted
from physics.fitting.outline import JOINING, LARGEST_REACH, SHARP
from physics.fitting.rings import SIDE, turn_at
from physics.fitting.tile_paths import find_paths, room_for_paths
from physics.fitting.tile_regions import put_regions
from physics.jit import kernel, subkernel
from physics.settings import MAX_CORNERS

HALO = SEEN + SHARP + 1  # [px] of its neighbours' pixels that a tile's outline depends on


class TileParts(NamedTuple):
    """Convex polygons, one after another."""

    corners: np.ndarray  # (n, 2) float64 [px], clockwise on the screen; each from its topmost, then leftmost corner on
    inner: np.ndarray  # (n,) bool: the side that starts there is shared with another part, of this tile or the next
    counts: np.ndarray  # (k,) int64: corners of each polygon


NONE = TileParts(np.zeros((0, 2)), np.zeros(0, bool), np.zeros(0, np.int64))


def tile_parts(window: np.ndarray, smooth: float, at: tuple[int, int] = (0, 0)) -> TileParts:
    """Convex parts of at most 16 corners of a tile, whose top left corner is at a place [px], all without radius.

    window[row, col] bool: the tile's pixels, a square, and HALO pixels more on each side: its neighbours', clear beyond
    the mask. smooth [px] as in fitting.outline, whose contract the parts of all tiles keep together. An empty tile has
    no parts, one with solid all around too is one square of inner sides. Raises ValueError for a window of another
    form, or whose halo of tiles is not narrower than the tile.
    """
    height, width = window.shape
    size = width - 2 * HALO
    if height != width or size <= HALO:
        raise ValueError(f"window must be square, its tile larger than {HALO} (got {width} x {height})")
    near = window[HALO - 1 : HALO + size + 1, HALO - 1 : HALO + size + 1]
    solid = np.count_nonzero(near)
    if solid == 0 or not np.count_nonzero(near[1:-1, 1:-1]):
        if not _is_cornered(near):
            return NONE
    if solid == near.size:
        square = np.array([(0, 0), (size, 0), (size, size), (0, size)], float)
        return TileParts(square + at, np.ones(4, bool), np.array([4]))
    found = fitted("tile_parts", window, smooth, lambda: _fit(window, size, smooth))
    return TileParts(found.corners + at, found.inner.copy(), found.counts.copy())


def _fit(window, size, smooth):
    pixels = np.ascontiguousarray(window, dtype=np.uint8)
    paths, sides, corners, inner, counts = _room(size)
    found = convex_tile(
        Window(pixels, HALO, HALO + size, min(smooth, LARGEST_REACH), smooth >= JOINING),
        MAX_CORNERS,
        paths,
        sides,
        corners,
        inner,
        counts,
    )
    if found < 0:
        raise RuntimeError("the outline of a tile is no polygon: a defect of fitting.tile_paths")
    n = sum(counts[:found].tolist())
    return Parts(corners[:n].copy(), inner[:n].copy(), counts[:found].copy(), np.zeros(found))


def _is_cornered(near):
    """Whether the outline fills a bit of a clear tile: at a corner of it with solid all round."""
    return (
        (near[:2, :2].sum() == 3)
        or (near[:2, -2:].sum() == 3)
        or (near[-2:, :2].sum() == 3)
        or (near[-2:, -2:].sum() == 3)
    )


@cache
def _room(size):
    """Room for one tile at a time: 12 MB for 64 px."""
    paths = room_for_paths(size, HALO)
    most = 3 * len(paths.points)
    return (paths, np.zeros(most, SIDE), np.zeros((most, 2)), np.zeros(most, bool), np.zeros(most, np.int64))


@subkernel
def put_parts(count, low, sides_inout, corners_out, inner_out, counts_out):
    """Write the rings of sides (SIDE) as parts, in pixels of a tile that begins at row and column low.
    Returns how many."""
    sides = sides_inout
    n = 0
    parts = 0
    for k in range(count):
        sides[k].seen = False
    for start in range(count):
        if not sides[start].alive or sides[start].seen:
            continue
        first = start
        k = start
        while not sides[k].seen:
            sides[k].seen = True
            if (sides[k].y, sides[k].x) < (sides[first].y, sides[first].x):
                first = k
            k = sides[k].next
        begin = n
        k = first
        while True:
            side = sides[k]
            if side.inner != sides[side.previous].inner or turn_at(sides, side.previous, k, side.next) != 0.0:
                corners_out[n, 0] = side.x - low
                corners_out[n, 1] = side.y - low
                inner_out[n] = side.inner
                n += 1
            k = side.next
            if k == first:
                break
        counts_out[parts] = n - begin
        parts += 1
    return parts


@kernel
def convex_tile(window, most, workspace, sides_inout, corners_out, inner_out, counts_out):
    """The convex parts of a tile: corners (n, 2) [px], inner (n,), counts (parts,). Returns how many; -1: what was
    found is no polygon.

    window: Window; most: corners of a part; workspace: Paths; sides_inout: SIDE, room to work in.
    """
    if not find_paths(window, workspace):
        return -1
    n = bridge(put_regions(window, workspace, sides_inout), sides_inout)
    if n < 0:
        return -1
    n = cut_reflex(n, sides_inout)
    if n < 0:
        return -1
    n = cut_large(n, most, sides_inout)
    merge(n, most, sides_inout)
    return put_parts(n, window.low, sides_inout, corners_out, inner_out, counts_out)
