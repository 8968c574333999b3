"""Simpler shapes that can replace a pixel mask, from a circle to the mask itself, and measurement of their accuracy."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple, get_args

import numpy as np

from physics import checks, hints
from physics.annotations import Points, TierName
from physics.outline.contour import outline
from physics.outline.decompose import convex_parts
from physics.outline.measure import edges, measured
from physics.outline.simple_shapes import convex_hull, fewer_sides, least_box, least_capsule, least_circle, mask_hull
from physics.settings import MAX_CORNERS
from physics.shapes.kinds import SHAPES, Bounds, names_of
from physics.shapes.library import Library
from physics.shapes.mask import PixelMask
from physics.shapes.shape import Shape
from physics.shapes.values import SHORTEST, STRAIGHT, Capsule, Circle, Polygon
from physics.tables.shape import BOUNDS, MASK, SHAPE

# ---- polygons --------------------------------------------------------------------------------------------------------
# Convex polygons around points, and convex decomposition of a concave polygon.


def hull(points: Points) -> Polygon:
    """Return the convex hull of points as a Polygon of at most 16 corners.

    points: (n, 2) [px].

    If the exact hull has more corners, the edges whose removal adds the least area are removed, and their neighbours
    are extended until they meet. The polygon contains all points, up to rounding errors. Raises ValueError for fewer
    than three points and for points on one line; TypeError if points is not an array of numbers.
    """
    points = checks.columns("points", points, of="hull")
    corners = distinct(convex_hull(points)) if len(points) > 2 else points[:0]
    if len(corners) < 3:
        raise ValueError(
            f"points must be at least 3 that are not on one line (got {checks.shown(points.tolist())}); "
            "a Capsule or Segment is what lies on a line"
        )
    return Polygon(distinct(fewer_sides(corners, MAX_CORNERS)))


def decompose(points: Points, holes: Sequence[Points] = (), tolerance: float = 0.0) -> tuple[Polygon, ...]:
    """Divide a simple polygon into convex polygons of 3 to 16 corners, and return them.

    points: corners (n, 2) [px], in either winding.
    holes: polygons (n, 2) [px] to cut out of the inside; they may touch the outline and each other at corners.
    tolerance: largest depth of bumps and notches that are ignored to save parts [px], >= 0.

    With tolerance 0 the parts cover exactly the polygon, and the cuts between them lead from corner to corner. For a
    polygon of at most 40 corners without holes, the number of parts is then the least possible with such cuts. Only
    parts of more than 16 corners are divided further. Raises ValueError for edges that cross or touch (the message
    names both), for zero area, and for a hole that is not inside; TypeError if points or holes are not numbers.
    """
    outer = checks.columns("points", points, of="decompose")
    if not isinstance(holes, (Sequence, np.ndarray)) or checks.listed(holes) is None:
        raise TypeError(f"holes must be a list of polygons (got {checks.shown(holes)})")
    inner = [checks.columns(f"holes[{k}]", hole) for k, hole in enumerate(holes)]
    tolerance = checks.number("tolerance", tolerance, low=0.0)
    parts = (distinct(corners) for corners, _ in convex_parts(outer, inner, tolerance))
    return tuple(Polygon(corners) for corners in parts if len(corners) > 2)


def distinct(corners: np.ndarray) -> np.ndarray:
    """Return the corners (n, 2) of a convex polygon without equal and collinear corners, which Polygon rejects."""
    size = float(np.ptp(corners, axis=0).max()) if len(corners) else 0.0
    k = 0
    while len(corners) > 2 and k < len(corners):
        before, after = corners[k] - corners[k - 1], corners[(k + 1) % len(corners)] - corners[k]
        lengths = np.hypot(*before) * np.hypot(*after)
        turn = before[0] * after[1] - before[1] * after[0]
        if np.hypot(*before) <= 2.0 * SHORTEST * size or turn <= 2.0 * STRAIGHT * lengths:
            corners = np.delete(corners, k, axis=0)
            k = max(k - 1, 0)  # the corner before turns more now
        else:
            k += 1
    return corners


# ---- approximate -----------------------------------------------------------------------------------------------------
# Simpler shapes for a sprite's mask, in tiers (levels of accuracy): a cheaper tier is less accurate.

TIERS: tuple[TierName, ...] = get_args(TierName)


def fit(mask: PixelMask, tier: TierName, tolerance: float = 1.0) -> tuple[Shape, ...]:
    """Return the shapes that replace a mask at one tier (level of accuracy).

    mask: a PixelMask.
    tier: one of the names below.
    tolerance: depth of ignored bumps and notches in the tier "parts" [px], > 0.

    The tiers, from coarse to exact:
        "circle": the smallest circle around all solid pixels
        "aabb": the AABB of the solid pixels at each pose
        "obb": the smallest oriented box
        "capsule": a small capsule around all solid pixels
        "hull": the convex hull, with 16 corners at most
        "parts": convex polygons that ignore bumps and notches of up to tolerance [px] in the smoothed outline
        "outline": mask.outline, in convex parts, rounded where the sprite is round
        "pixels": the mask tested as it is drawn (snap=True)
        "mask": the mask tested at its exact pose (snap=False)

    The shapes keep the mask's material, filter and sensor. For a mask without solid pixels, the result is () in all
    tiers except "pixels" and "mask". Raises TypeError for a mask that is not a PixelMask, ValueError for an unknown
    tier or a tolerance <= 0.
    """
    _check_mask(mask)
    checks.choice("tier", tier, TIERS)
    tolerance = checks.number("tolerance", tolerance, above=0.0)
    if tier in ("pixels", "mask"):
        return (_snapped(mask, tier == "pixels"),)
    if mask.area == 0:
        return ()
    key = (tier, tolerance if tier == "parts" else 0.0)
    if key not in mask.fitted:  # a mask is immutable, so the result is cached
        mask.fitted[key] = _fit(mask.bare, tier, tolerance)
    fitted = mask.fitted[key]
    return fitted if mask is mask.bare else tuple(each.with_values_of(mask) for each in fitted)


def _check_mask(mask):
    if not isinstance(mask, PixelMask):
        hint = hints.in_place_of_shape(mask) if hints.is_a(mask, "pygame", "Surface", "Mask", "Sprite") else ""
        raise TypeError(f"mask must be a PixelMask (got {checks.shown(mask)}){hint}")


def _fit(mask, tier, tolerance):
    if tier == "aabb":
        return (Bounds(mask),)
    if tier == "parts":
        pieces = outline(mask.solid, mask.smooth)
        parts = [corners for outer, holes in pieces for corners, _ in convex_parts(outer, holes, tolerance)]
        return tuple(Polygon(distinct(corners) - np.array(mask.origin)) for corners in parts)
    if tier == "outline":
        return mask.outline
    corners = mask_hull(mask)
    if tier == "hull":
        return (hull(corners),)
    if tier == "circle":
        x, y, radius = least_circle(corners)
        return (Circle(radius, (x, y)),)
    if tier == "capsule":
        a, b, radius = least_capsule(corners)
        return (Circle(radius, a) if a == b else Capsule(a, b, radius),)
    width, height, center, angle = least_box(corners)
    return (Polygon.box(width, height, center, angle),)


def _snapped(mask, snap):
    """Return the mask if its `snap` has the given value, else a copy with this value, cached in mask.fitted."""
    if mask.snap == snap:
        return mask
    if snap not in mask.fitted:
        mask.fitted[snap] = PixelMask(mask.solid, mask.origin, snap, mask.smooth)
    return mask.fitted[snap].with_values_of(mask)


# ---- accuracy --------------------------------------------------------------------------------------------------------
# Cost and error of shapes that replace a mask.


class Fit(NamedTuple):
    """Accuracy and cost of shapes that replace a mask, returned by `measure`.

    over: area of the shapes outside the mask's pixels [px²].
    missed: area of the pixels outside the shapes [px²].
    iou: intersection over union of the areas, 0 to 1.
    hausdorff: Hausdorff distance of the two boundaries [px], at most 1e-6 too small.
    area_error: difference of the areas, divided by the pixels' area.
    center_error: distance of the centres of area [px].
    inertia_error: difference of the moments of inertia, each about its own centre, divided by the pixels' moment.
    corners: number of corners: 1 per Circle, 2 per Capsule, 4 per Bounds; for a PixelMask the number of corners of its
        pixel edges.
    bytes: memory of the shapes in a world: their table rows, corners and pixels (at one angle).
    """

    over: float
    missed: float
    iou: float
    hausdorff: float
    area_error: float
    center_error: float
    inertia_error: float
    corners: int
    bytes: int


def measure(mask: PixelMask, shapes: Shape | Sequence[Shape]) -> Fit:
    """Measure how accurately shapes represent a mask. Return a Fit.

    mask: a PixelMask.
    shapes: a shape or shapes with an area, in the mask's body space. Overlapping shapes count as their union.

    Areas, centres and moments are exact up to rounding. A PixelMask counts as the union of its pixel squares, a Bounds
    as its box at the angle 0. Errors are never negative. If there are only solid pixels or only shapes, iou is 0, and
    hausdorff, center_error and errors divided by 0 are inf. If there are neither, iou is 1 and all errors are 0. Raises
    TypeError for a mask that is not a PixelMask and for shapes without an area.
    """
    _check_mask(mask)
    given = [*shapes] if isinstance(shapes, (tuple, list)) else [shapes]
    solids = tuple(each for each in SHAPES if each._has_mass)
    parts = [each for each in given if isinstance(each, solids)]
    if len(parts) < len(given):
        raise TypeError(f"shapes must be {names_of(solids)} (got {checks.shown(shapes)})")
    origin = np.array(mask.origin)
    found = measured(mask.solid, [(corners + origin, radius) for each in parts for corners, radius in each._hulls()])
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


def _corners(shape):
    if shape._kind == MASK:
        return len(edges(shape.solid))
    return 4 if shape._kind == BOUNDS else len(shape.points)
