"""What a stand-in for a mask costs and gets wrong: measure."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from physics import checks
from physics.fitting.measure import edges, measured
from physics.shapes.blocks import solid_blocks
from physics.shapes.bounds import Bounds
from physics.shapes.convex import Capsule, Circle, Polygon
from physics.shapes.library import Library
from physics.shapes.mask import PixelMask
from physics.tables.shape import SHAPE

Solid = Circle | Capsule | Polygon | PixelMask | Bounds


class Fit(NamedTuple):
    """Shapes beside the mask that they stand for."""

    over: float
    missed: float
    iou: float
    hausdorff: float
    area_error: float
    center_error: float
    inertia_error: float
    corners: int
    bytes: int


def measure(mask: PixelMask, shapes: Solid | Sequence[Solid]) -> Fit:
    """How well shapes stand for a mask; all in its body space, overlapping shapes as their union.

    over: area of the shapes outside the mask's pixels [px²]; missed: area of the pixels outside the shapes [px²]; iou:
    the area that both share over that of both together; hausdorff: the largest distance of a point of the boundary of
    either from the other's boundary [px], at most 1e-6 too small; area_error: difference of the areas over the
    pixels'; center_error: distance of the centres of area [px]; inertia_error: difference of the moments of inertia,
    each about its own centre, over the pixels'; corners: 1 of a Circle, 2 of a Capsule, all of a Polygon, 4 of Bounds,
    of a PixelMask those of its pixels' edges; bytes: what a world keeps for the shapes: their rows of `shapes`, and
    corners and pixels (at one angle) in its library.

    Areas, centres and moments are exact but for rounding: a PixelMask counts as the union of its pixel squares, Bounds
    as the box that they are at the angle 0. Errors are never negative. Without shapes or without pixels iou is 0, and
    hausdorff, center_error and the errors relative to nothing are inf; without either iou is 1 and all errors 0.
    Raises TypeError for what is no PixelMask, or no shape with an area.
    """
    if not isinstance(mask, PixelMask):
        raise TypeError(f"mask must be a PixelMask (got {checks.shown(mask)})")
    given = [*shapes] if isinstance(shapes, (tuple, list)) else [shapes]
    parts = [each for each in given if isinstance(each, Solid)]
    if len(parts) < len(given):
        raise TypeError(f"shapes must be Circle, Capsule, Polygon, Bounds or PixelMask (got {checks.shown(shapes)})")
    origin = np.array(mask.origin)
    found = measured(mask.solid, [(corners + origin, radius) for each in parts for corners, radius in _hulls(each)])
    ours, theirs = found.hulls, found.pixels
    together = ours.area + found.missed
    nothing = ours.area == 0.0 and theirs.area == 0.0
    apart = math.hypot(ours.x - theirs.x, ours.y - theirs.y)
    library = Library()
    for shape in parts:
        library.add(shape)
    return Fit(
        found.over,
        found.missed,
        (theirs.area - found.missed) / together if together > 0.0 else 1.0,
        found.hausdorff,
        _relative(ours.area, theirs.area),
        0.0 if nothing else apart if math.isfinite(apart) else math.inf,
        _relative(ours.inertia, theirs.inertia),
        sum(_corners(each) for each in parts),
        library.size + len(parts) * SHAPE.itemsize,
    )


def _relative(value, truth):
    if truth == 0.0:
        return 0.0 if value == 0.0 else math.inf
    return abs(value - truth) / truth


def _hulls(shape):
    """(corners clockwise on the screen, radius) of the convex hulls that a shape is, in body space."""
    if isinstance(shape, Bounds):
        return _box_around(_hulls(shape.shape))
    if isinstance(shape, PixelMask):
        origin = np.array(shape.origin)
        return [(_box(*block) - origin, 0.0) for block in solid_blocks(shape.solid)]
    if isinstance(shape, Circle):
        return [(np.array([shape.center], float), shape.radius)]
    return [(np.array(shape.points, float), shape.radius)]


def _box_around(hulls):
    if not hulls:
        return []
    low = np.min([corners.min(axis=0) - radius for corners, radius in hulls], axis=0)
    high = np.max([corners.max(axis=0) + radius for corners, radius in hulls], axis=0)
    return [(_box(*low, *high), 0.0)]


def _box(left, top, right, bottom):
    return np.array([(left, top), (right, top), (right, bottom), (left, bottom)], float)


def _corners(shape):
    if isinstance(shape, PixelMask):
        return len(edges(shape.solid))
    if isinstance(shape, Bounds):
        return 4
    return 1 if isinstance(shape, Circle) else len(shape.points)
