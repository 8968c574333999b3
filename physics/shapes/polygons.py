"""Convex polygons around points, and in place of a concave outline."""

from collections.abc import Sequence

import numpy as np

from physics import checks
from physics.checks import Points
from physics.fitting.convex_parts import convex_parts
from physics.fitting.hull import convex_hull, fewer_sides
from physics.settings import MAX_CORNERS
from physics.shapes.convex import SHORTEST, STRAIGHT, Polygon


def hull(points: Points) -> Polygon:
    """The convex hull of points (n, 2) [px]. Of more than 16 corners those go, sides extended outward, that add least
    area: the polygon holds all points (up to rounding). Raises ValueError for fewer than three points and for
    points on a line, TypeError."""
    points = checks.columns("points", points)
    corners = distinct(convex_hull(points)) if len(points) > 2 else points[:0]
    if len(corners) < 3:
        raise ValueError(
            f"points must be at least 3 that are not on one line (got {checks.shown(points.tolist())}); "
            "a Capsule or Segment is what lies on a line"
        )
    return Polygon(distinct(fewer_sides(corners, MAX_CORNERS)))


def decompose(points: Points, holes: Sequence[Points] = (), tolerance: float = 0.0) -> tuple[Polygon, ...]:
    """A simple polygon of any size, points (n, 2) [px] in either winding, in few convex ones of 3 to 16 corners.

    holes: polygons inside that are left out; they may touch in corners. tolerance [px]: bumps and notches up to
    that deep are left out, which saves parts; 0: exactly the polygon, cut between its corners. Without holes and
    with at most 40 corners no cuts between corners give fewer parts, as long as 16 corners do for each. Raises
    ValueError for edges that cross or meet (naming both), for no area, for a hole that is not inside; TypeError.
    """
    outer = checks.columns("points", points)
    if isinstance(holes, (str, bytes)) or not isinstance(holes, (Sequence, np.ndarray)):
        raise TypeError(f"holes must be a list of polygons (got {checks.shown(holes)})")
    inner = [checks.columns(f"holes[{k}]", hole) for k, hole in enumerate(holes)]
    tolerance = checks.number("tolerance", tolerance, low=0.0)
    parts = (distinct(corners) for corners, _ in convex_parts(outer, inner, tolerance))
    return tuple(Polygon(corners) for corners in parts if len(corners) > 2)


def distinct(corners: np.ndarray) -> np.ndarray:
    """Convex corners (n, 2) without those that a Polygon does not take: equal ones, and straight ones."""
    size = float(np.ptp(corners, axis=0).max()) if len(corners) else 0.0
    k = 0
    while len(corners) > 2 and k < len(corners):
        before, after = corners[k] - corners[k - 1], corners[(k + 1) % len(corners)] - corners[k]
        lengths = np.hypot(*before) * np.hypot(*after)
        turn = before[0] * after[1] - before[1] * after[0]
        if np.hypot(*before) <= 2.0 * SHORTEST * size or turn <= 2.0 * STRAIGHT * lengths:
            corners = np.delete(corners, k, axis=0)
            k = max(k - 1, 0)  # its neighbour before turns more now
        else:
            k += 1
    return corners
