"""Coverage of the pixels of a picture by shapes: a pixel is covered if its centre lies in one of them."""

import numpy as np

from physics import Bounds, Capsule, Circle, PixelMask, Polygon


def covered(shapes, x, y):
    """Return a bool array: whether each centre (x, y) [px], in body space, lies in one of the shapes."""
    found = np.zeros(np.shape(x), bool)
    for shape in shapes:
        found |= _inside(shape, x, y)
    return found


def _inside(shape, x, y):
    if isinstance(shape, Circle):
        return np.hypot(x - shape.center[0], y - shape.center[1]) <= shape.radius
    if isinstance(shape, Capsule):
        return _to_segment(x, y, shape.a, shape.b) <= shape.radius
    if isinstance(shape, Bounds):
        box = shape.shape.bounds if isinstance(shape.shape, PixelMask) else None
        if box is None:
            return np.zeros(np.shape(x), bool)
        left, top, right, bottom = box
        return (x >= left) & (x <= right) & (y >= top) & (y <= bottom)
    if isinstance(shape, PixelMask):
        column, row = np.floor(x + shape.origin[0]).astype(int), np.floor(y + shape.origin[1]).astype(int)
        height, width = shape.solid.shape
        there = (column >= 0) & (column < width) & (row >= 0) & (row < height)
        return there & shape.solid[np.clip(row, 0, height - 1), np.clip(column, 0, width - 1)]
    if isinstance(shape, Polygon):
        return _in_polygon(shape, x, y)
    raise TypeError(f"shapes must be Circle, Capsule, Bounds, PixelMask or Polygon (got {shape!r})")


def _in_polygon(shape, x, y):
    points = np.asarray(shape.points, float)
    edges = list(zip(points, np.roll(points, -1, axis=0), strict=True))
    sides = [(b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) for a, b in edges]
    inside = np.all([side >= 0.0 for side in sides], axis=0) | np.all([side <= 0.0 for side in sides], axis=0)
    if shape.radius > 0.0:
        inside |= np.min([_to_segment(x, y, a, b) for a, b in edges], axis=0) <= shape.radius
    return inside


def _to_segment(x, y, a, b):
    """Return the distances of points from a segment."""
    along = np.array([b[0] - a[0], b[1] - a[1]], float)
    length = float(along @ along)
    share = ((x - a[0]) * along[0] + (y - a[1]) * along[1]) / length if length > 0.0 else np.zeros(np.shape(x))
    share = np.clip(share, 0.0, 1.0)
    return np.hypot(x - a[0] - share * along[0], y - a[1] - share * along[1])
