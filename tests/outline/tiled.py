"""Functions for masks in tiles: windows, parts as shapely figures, and a check of their properties."""

import numpy as np
import shapely
from shapely import Polygon

from physics.outline.tiled import HALO, tile_parts
from tests.outline.rasters import connected, lies_on_the_right_side, pixels

SIZE = 64
TINY = 1e-7


def windows(solid, size=SIZE):
    """Yield (row, column, window) of each tile; the window is the tile's pixels with a border of HALO pixels."""
    rows, columns = (-(-side // size) for side in solid.shape)
    wide = np.zeros((rows * size + 2 * HALO, columns * size + 2 * HALO), bool)
    wide[HALO : HALO + solid.shape[0], HALO : HALO + solid.shape[1]] = solid
    for row in range(rows):
        for column in range(columns):
            top, left = row * size, column * size
            yield row, column, wide[top : top + size + 2 * HALO, left : left + size + 2 * HALO]


def parts_of(solid, smooth=0.5, size=SIZE):
    """Return (row, column, corners, inner) of all parts of all tiles, in pixels of the mask.

    inner: whether each side is inside the outline.
    """
    found = []
    for row, column, window in windows(solid, size):
        parts = tile_parts(window, smooth)
        ends = np.cumsum(parts.counts)[:-1]
        for corners, inner in zip(np.split(parts.corners, ends), np.split(parts.inner, ends), strict=True):
            if len(corners):
                found.append((row, column, corners + (column * size, row * size), inner))
    return found


def whole(parts):
    """Return the union of the parts, without slivers at common sides."""
    together = shapely.union_all([Polygon(corners) for _, _, corners, _ in parts])
    return together.buffer(TINY).buffer(-TINY)


def is_near(line, other, distance):
    """Return whether each point of a line, sampled every 0.05 px, is within a distance of another geometry."""
    points = shapely.points(shapely.get_coordinates(shapely.segmentize(line, 0.05)))
    shapely.prepare(other)
    return bool(shapely.dwithin(other, points, distance).all())


def check(solid, smooth=0.5, size=SIZE):
    """Return the parts of a mask's tiles, after a check of their properties.

    Each part must be convex and lie in its tile. Parts must not overlap. Inner sides lie inside the outline and the
    others on it, and the union must fulfil the guarantees of outlines.
    """
    parts = parts_of(solid, smooth, size)
    if not parts:
        assert not solid.any()
        return parts
    figures = [Polygon(corners) for _, _, corners, _ in parts]
    outline = whole(parts)
    assert abs(sum(each.area for each in figures) - shapely.union_all(figures).area) <= 1e-6, "parts overlap"
    sides, felt = [], []
    for row, column, corners, inner in parts:
        assert 3 <= len(corners) <= 16 and len(inner) == len(corners)
        low, high = np.array([column, row]) * size, np.array([column + 1, row + 1]) * size
        assert (corners >= low).all() and (corners <= high).all(), "parts stay in their tile"
        along = np.roll(corners, -1, axis=0) - corners
        onward = np.roll(along, -1, axis=0)
        turns = along[:, 0] * onward[:, 1] - along[:, 1] * onward[:, 0]
        assert (turns >= 0.0).all() and turns.max() > 0.0, "convex and clockwise on the screen"
        sides.append(corners + 0.3137 * along)
        felt.append(~inner)
    edge = outline.boundary
    shapely.prepare(edge)
    on_edge = shapely.dwithin(edge, shapely.points(np.concatenate(sides)), 1e-5)
    assert np.array_equal(on_edge, np.concatenate(felt)), "sides with solid beyond them are inner, no others"
    assert lies_on_the_right_side(outline, solid)
    cracks = pixels(solid).boundary
    assert is_near(edge, cracks, smooth + 1e-4) and is_near(cracks, edge, smooth + 0.21)
    pieces = len(getattr(outline, "geoms", [outline]))
    assert connected(solid, True) <= pieces <= connected(solid, False)
    return parts
