"""Masks at angles that came up: drawn once per angle bucket, before a kernel needs them.

The columns raster, left and top of a SHAPE row with the role PIXELS hold for one test: the narrow phase has such rows
drawn by `draw_masks` before its passes read them, and so does every other reader. What is not snapped is tested by its
pixels as they were added, turned with its body: it is drawn for pictures only.
"""

import math

import numpy as np

from physics.settings import MASK_ANGLE_BUCKETS, POSITION_LIMIT
from physics.shapes.library import Library
from physics.shapes.placement import missing_rasters, place_masks
from physics.tables.shape import MASK, PIXELS


def add_missing_rasters(library: Library, rows: np.ndarray, bodies: np.ndarray, shapes: np.ndarray, dt: float) -> None:
    """Draw the snapped masks of these shape rows at angles, of now or after dt [s], that have not come up before."""
    if not library.masks:
        return
    missing = np.zeros((2 * len(rows), 2), np.int64)
    found = missing_rasters(rows, bodies, shapes, library.tables.rasters, library.raster_of, dt, missing)
    if found:
        for mask, bucket in np.unique(missing[:found], axis=0).tolist():
            library.add_raster(mask, bucket)


def draw_masks(library: Library, rows: np.ndarray, bodies: np.ndarray, shapes: np.ndarray) -> None:
    """Draw the snapped PIXELS among these SHAPE rows at the present poses of their bodies, and write their columns
    raster, left and top. A body without a pose that a double resolves is passed over."""
    _draw(library, rows[(shapes["role"][rows] == PIXELS) & shapes["snap"][rows]], bodies, shapes)


def draw_pictures(library: Library, rows: np.ndarray, bodies: np.ndarray, shapes: np.ndarray) -> None:
    """As draw_masks, and also what is not snapped: somebody looks."""
    pictured = (shapes["role"][rows] == PIXELS) | ~shapes["snap"][rows]
    _draw(library, rows[(shapes["kind"][rows] == MASK) & pictured], bodies, shapes)


def _draw(library, rows, bodies, shapes):
    if not len(rows):
        return
    x, y, angles = (bodies[name][shapes["body_row"][rows]] for name in ("x", "y", "angle"))
    there = (np.abs(x) < POSITION_LIMIT) & (np.abs(y) < POSITION_LIMIT) & (np.abs(angles) < POSITION_LIMIT)
    rows, angles = rows[there], angles[there]
    # As placement.bucket_at.
    buckets = np.floor(angles * MASK_ANGLE_BUCKETS / math.tau + 0.5).astype(np.int64) & (MASK_ANGLE_BUCKETS - 1)
    masks = shapes["geometry"][rows]
    missing = library.raster_of[masks, buckets] < 0
    if missing.any():
        for mask, bucket in np.unique(np.stack([masks, buckets], axis=1)[missing], axis=0).tolist():
            library.add_raster(mask, bucket)
    place_masks(rows, library.tables, bodies, shapes)
