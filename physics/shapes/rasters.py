"""Masks at angles that came up: drawn once per angle bucket, before a kernel needs them."""

import numpy as np

from physics.shapes.library import Library
from physics.shapes.placement import missing_rasters


def add_missing_rasters(library: Library, rows: np.ndarray, bodies: np.ndarray, shapes: np.ndarray, dt: float) -> None:
    """Draw the masks of these shape rows at angles, of now or after dt [s], that have not come up before."""
    if not library.masks:
        return
    missing = np.zeros((2 * len(rows), 2), np.int64)
    found = missing_rasters(rows, bodies, shapes, library.raster_of, dt, missing)
    if found:
        for mask, bucket in np.unique(missing[:found], axis=0).tolist():
            library.add_raster(mask, bucket)
