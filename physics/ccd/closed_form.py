"""First times of impact in closed form, of two shapes that move along a line without turning: discs, polygons, rays."""

import math

from physics.collision.circles import collide_polygon_circle
from physics.collision.clipping import ALL_EDGES, edge_normal
from physics.jit import subkernel
from physics.math2d import length_of, unit

MISS = 2.0  # a fraction beyond the step


@subkernel
def sweep_circles(x, y, dx, dy, radius):
    """A point at (x, y) from the centre of a disc [px], moved by (dx, dy): (fraction or MISS, normal to it).

    radius: the sum of both discs'. Touching at the start: 0 when it approaches.
    """
    nx, ny = unit(x, y, 1.0, 0.0)
    approach = x * dx + y * dy
    if length_of(x, y) <= radius:
        return (0.0 if approach < 0.0 else MISS), nx, ny
    if approach >= 0.0:
        return MISS, nx, ny
    a = dx * dx + dy * dy
    c = x * x + y * y - radius * radius
    discriminant = approach * approach - a * c
    if discriminant < 0.0:
        return MISS, nx, ny
    # The smaller root, in the form that does not cancel.
    fraction = c / (-approach + math.sqrt(discriminant))
    if fraction > 1.0:
        return MISS, nx, ny
    nx, ny = unit(x + fraction * dx, y + fraction * dy, nx, ny)
    return fraction, nx, ny


@subkernel
def cast_on_polygon(corners, count, edges, x, y, dx, dy):
    """A ray from outside against a closed convex polygon [px]: (fraction or MISS, normal).

    By cutting the ray with every half plane, so that nothing slips through between two edges (Cyrus and Beck 1978).
    edges: bits of the edges that may be touched.
    """
    enter = -1.0
    leave = 1.0
    entering = 0
    for k in range(count):
        nx, ny = edge_normal(corners, count, k)
        gap = nx * (x - corners[k, 0]) + ny * (y - corners[k, 1])
        speed = nx * dx + ny * dy
        if speed < 0.0:
            if gap / -speed > enter:
                enter = gap / -speed
                entering = k
        elif speed > 0.0:
            leave = min(leave, gap / -speed)
        elif gap > 0.0:
            return MISS, 0.0, -1.0
    if enter < 0.0 or enter > leave or not (edges >> entering) & 1:
        return MISS, 0.0, -1.0
    nx, ny = edge_normal(corners, count, entering)
    return enter, nx, ny


@subkernel
def sweep_circle_polygon(corners, count, edges, x, y, dx, dy, radius):
    """A disc moved by (dx, dy) against a polygon at rest [px]: (fraction or MISS, normal from the polygon to the disc).

    edges: bits of the edges that may be touched. A radius of 0 casts a ray.
    """
    hit, nx, ny, _, _, separation, _ = collide_polygon_circle(corners, count, edges, x, y, radius)
    if hit and separation <= 0.0:
        return (0.0 if nx * dx + ny * dy < 0.0 else MISS), nx, ny
    if radius == 0.0:
        return cast_on_polygon(corners, count, edges, x, y, dx, dy)
    best = MISS
    best_x = 0.0
    best_y = -1.0
    for k in range(count):
        following = k + 1 if k + 1 < count else 0
        nx, ny = edge_normal(corners, count, k)
        speed = nx * dx + ny * dy
        if (edges >> k) & 1 and speed < 0.0:
            gap = nx * (x - corners[k, 0]) + ny * (y - corners[k, 1]) - radius
            fraction = gap / -speed
            if 0.0 <= fraction < best and fraction <= 1.0:
                at_x = x + fraction * dx
                at_y = y + fraction * dy
                ex = corners[following, 0] - corners[k, 0]
                ey = corners[following, 1] - corners[k, 1]
                along = ex * (at_x - corners[k, 0]) + ey * (at_y - corners[k, 1])
                if 0.0 <= along <= ex * ex + ey * ey:
                    best = fraction
                    best_x = nx
                    best_y = ny
        if radius > 0.0 and (edges >> (16 + k)) & 1:
            fraction, nx, ny = sweep_circles(x - corners[k, 0], y - corners[k, 1], dx, dy, radius)
            if fraction < best:
                best = fraction
                best_x = nx
                best_y = ny
    return best, best_x, best_y


@subkernel
def half_planes(a, a_count, b, b_count, edges, side, dx, dy, slack, enter, leave, entering, nx, ny):
    """Cut the time of overlap by the faces of one outline.

    side 1: the faces of B, which A's corners cross; -1: those of A, crossed by B's corners. A face that is crossed by
    less than `slack` [px] does not count. Returns (enter, leave, entering face or -1 - face of A, normal from B to A).
    """
    for k in range(b_count):
        mx, my = edge_normal(b, b_count, k)
        gap = math.inf
        for i in range(a_count):
            gap = min(gap, mx * (a[i, 0] - b[k, 0]) + my * (a[i, 1] - b[k, 1]))
        speed = side * (mx * dx + my * dy)
        if gap + slack > 0.0:
            if speed >= 0.0:
                return MISS, leave, entering, nx, ny
            fraction = (gap + slack) / -speed
            if fraction > enter:
                enter = fraction
                entering = k if side > 0.0 else -1 - k
                nx = side * mx
                ny = side * my
        elif speed > 0.0:
            leave = min(leave, -(gap + slack) / speed)
    return enter, leave, entering, nx, ny


@subkernel
def sweep_polygons(a, a_count, b, b_count, b_edges, dx, dy, slack):
    """Polygon A moved by (dx, dy) against B at rest [px]: (fraction or MISS, normal from B to A).

    b_edges: bits of B's edges that may be touched; slack [px]: shallower overlaps do not count. Already overlapping
    by more: MISS, the contact solver lets it out.
    """
    enter, leave, entering, nx, ny = half_planes(
        a, a_count, b, b_count, b_edges, 1.0, dx, dy, slack, -1.0, 1.0, 0, 0.0, -1.0
    )
    if enter <= 1.0:
        enter, leave, entering, nx, ny = half_planes(
            b, b_count, a, a_count, ALL_EDGES, -1.0, dx, dy, slack, enter, leave, entering, nx, ny
        )
    if enter < 0.0 or enter > leave or enter > 1.0:
        return MISS, nx, ny
    if entering >= 0 and not (b_edges >> entering) & 1:
        return MISS, nx, ny
    # From "slack deep" back to touching.
    approach = -(nx * dx + ny * dy)
    if approach <= 0.0:
        return MISS, nx, ny
    return max(0.0, enter - slack / approach), nx, ny
