"""Masks at angles that came up: drawn once per angle bucket, before a kernel needs them.

What is not snapped is tested by its pixels as they were added, turned with its body: it is drawn for pictures only.
"""

import numpy as np

from physics.raster.rotate import bucket_of
from physics.settings import MASK_ANGLE_BUCKETS
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
    """Draw the snapped PIXELS among these SHAPE rows where their bodies are: somebody asks for them."""
    _draw(library, rows[(shapes["role"][rows] == PIXELS) & shapes["snap"][rows]], bodies, shapes)


def draw_pictures(library: Library, rows: np.ndarray, bodies: np.ndarray, shapes: np.ndarray) -> None:
    """As draw_masks, and also what is not snapped: somebody looks."""
    pictured = (shapes["role"][rows] == PIXELS) | ~shapes["snap"][rows]
    _draw(library, rows[(shapes["kind"][rows] == MASK) & pictured], bodies, shapes)


def _draw(library, rows, bodies, shapes):
    if len(rows):
        angles = bodies["angle"][shapes["body_row"][rows]]
        for mask, angle in zip(shapes["geometry"][rows].tolist(), angles.tolist(), strict=True):
            if library.raster_of[mask, bucket_of(angle, MASK_ANGLE_BUCKETS)] < 0:
                library.raster(mask, angle)
        place_masks(rows, library.tables, bodies, shapes)
