"""Masks at angles that came up: drawn once per angle bucket, before a kernel needs them."""

import numpy as np

from physics.shapes.placement import missing_rasters


def add_missing_rasters(world, dt):
    """Draw the masks at the angles that they have, or will have after dt, and did not have before."""
    if not world.library.masks:
        return
    missing = np.zeros((2 * len(world.shapes), 2), np.int64)
    found = missing_rasters(world.bodies, world.shapes, world.library.raster_of, dt, missing)
    for mask, bucket in np.unique(missing[:found], axis=0).tolist():
        world.library.add_raster(mask, bucket)
