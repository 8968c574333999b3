"""The SHAPE rows of a large mask's parts: those in some of its tiles, and those that are as they would be anew."""

import numpy as np

from physics.jit import kernel
from physics.tables.geometry import Geometry
from physics.tables.shape import PART


def rows_in_tiles(shapes: np.ndarray, owner: int, wanted: np.ndarray) -> np.ndarray:
    """(n,) int64 rows of the parts of a shape, by id, in the wanted tiles: (tiles,) bool. O(shapes)."""
    found = np.empty(len(shapes), np.int64)
    return found[: list_parts(shapes, owner, wanted, found)]


def find_equal(
    geometry: Geometry, shapes: np.ndarray, rows: np.ndarray, corners: np.ndarray, counts: np.ndarray
) -> np.ndarray:
    """(k,) int64: for each of some polygons, one after another, which of the rows (n,) has the same corners in the same
    order, as its place among them; -1 where none has.

    corners (m, 2) [px], counts (k,): corners of each. O(k n).
    """
    found = np.empty(len(counts), np.int64)
    find_polygons(geometry, shapes, rows, corners, counts, found)
    return found


@kernel
def list_parts(shapes, owner, wanted, rows_out):
    """Write the rows of the parts that rows_in_tiles tells. Returns how many."""
    count = 0
    for k in range(len(shapes)):
        s = shapes[k]
        if s.owner == owner and s.role == PART and wanted[s.tile]:
            rows_out[count] = k
            count += 1
    return count


@kernel
def find_polygons(geometry, shapes, rows, corners, counts, found_out):
    """Write for each polygon its place among the rows, as find_equal tells."""
    first = 0
    for k in range(len(counts)):
        found_out[k] = -1
        for i in range(len(rows)):
            span = geometry.polygons[shapes[rows[i]].geometry]
            same = span.count == counts[k]
            j = 0
            while same and j < counts[k]:
                corner = geometry.corners[span.offset + j]
                same = corner.x == corners[first + j, 0] and corner.y == corners[first + j, 1]
                j += 1
            if same:
                found_out[k] = i
                break
        first += counts[k]
