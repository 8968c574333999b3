"""Circles against circles and convex polygons, in closed form."""

import math

from physics.collision.clipping import edge_normal, meets_corner
from physics.collision.features import CIRCLE_CORNER
from physics.jit import subkernel
from physics.math2d import length_of, unit

COVERED = -1  # in place of a feature: the centre is inside, and no edge may be touched


@subkernel
def collide_circles(ax, ay, a_radius, bx, by, b_radius):
    """Two discs [px]: (normal from A to B, point midway, separation). Equal centres push along +x. O(1)."""
    dx = bx - ax
    dy = by - ay
    nx, ny = unit(dx, dy, 1.0, 0.0)
    distance = length_of(dx, dy)
    separation = distance - (a_radius + b_radius)
    along = 0.5 * (a_radius + (distance - b_radius))
    return nx, ny, ax + along * nx, ay + along * ny, separation


@subkernel
def collide_polygon_circle(corners, count, edges, x, y, radius):
    """A convex polygon against a disc [px]: (found, normal to the disc, point midway, separation, feature).

    edges: bits of the edges and corners that may be touched. What may not is covered by a neighbour, so nothing is
    found where it is the nearest: the neighbour finds it. With the centre inside, the
    nearest touchable edge decides; without any, which the feature COVERED says, a neighbour. A centre on the outline
    takes the edge's normal. O(count).
    """
    best = -1
    inner = -1
    best_separation = -math.inf
    inner_separation = -math.inf
    for k in range(count):
        nx, ny = edge_normal(corners, count, k)
        separation = nx * (x - corners[k, 0]) + ny * (y - corners[k, 1])
        if separation > best_separation:
            best_separation = separation
            best = k
        if (edges >> k) & 1 and separation > inner_separation:
            inner_separation = separation
            inner = k
    if best_separation <= 0.0:
        best = inner
        best_separation = inner_separation
        if best < 0:
            return False, 0.0, -1.0, x, y, 0.0, COVERED
    nx, ny = edge_normal(corners, count, best)
    if best_separation > 0.0:
        following = best + 1 if best + 1 < count else 0
        ex = corners[following, 0] - corners[best, 0]
        ey = corners[following, 1] - corners[best, 1]
        from_start = ex * (x - corners[best, 0]) + ey * (y - corners[best, 1])
        from_end = ex * (x - corners[following, 0]) + ey * (y - corners[following, 1])
        # Right over a corner the face decides: of two tiles that share a covered corner one has to tell.
        if from_start < 0.0 or from_end > 0.0:
            corner = best if from_start < 0.0 else following
            dx = x - corners[corner, 0]
            dy = y - corners[corner, 1]
            distance = length_of(dx, dy)
            nx, ny = unit(dx, dy, nx, ny)
            if not meets_corner(corners, count, edges, corner, nx, ny):
                return False, 0.0, -1.0, x, y, 0.0, 0
            separation = distance - radius
            along = 0.5 * separation
            return (
                True,
                nx,
                ny,
                corners[corner, 0] + along * nx,
                corners[corner, 1] + along * ny,
                separation,
                CIRCLE_CORNER + corner,
            )
        if not (edges >> best) & 1:
            return False, 0.0, -1.0, x, y, 0.0, 0
    separation = best_separation - radius
    along = best_separation - 0.5 * separation
    return True, nx, ny, x - along * nx, y - along * ny, separation, best
