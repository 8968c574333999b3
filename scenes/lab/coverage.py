"""Coverage of pixels by shapes: a pixel is covered if its centre is inside one of the shapes."""

import numpy as np

from physics import Bounds, PixelMask
from physics.shapes.values import Convex
from scenes.lab.pieces import hull, signed_distance


def covered(shapes, x, y):
    """Return whether each point is inside at least one of the shapes, a bool array of the shape of `x`.

    x, y: arrays of coordinates in body space [px].
    """
    found = np.zeros(np.shape(x), bool)
    for shape in shapes:
        found |= _inside(shape, x, y)
    return found


def _inside(shape, x, y):
    if isinstance(shape, Convex):
        return signed_distance(*hull(shape), x, y) <= 0.0
    if isinstance(shape, PixelMask):
        column, row = np.floor(x + shape.origin[0]).astype(int), np.floor(y + shape.origin[1]).astype(int)
        height, width = shape.solid.shape
        there = (column >= 0) & (column < width) & (row >= 0) & (row < height)
        return there & shape.solid[np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)]
    if not isinstance(shape, Bounds):
        raise TypeError(
            f"shapes must be Circle, Capsule, Polygon, any convex shape, Bounds or PixelMask (got {shape!r})"
        )
    left, top, right, bottom = shape.bounds or (0.0, 0.0, -1.0, -1.0)
    return (x >= left) & (x <= right) & (y >= top) & (y <= bottom)
