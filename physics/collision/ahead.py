"""Pairs that meet within the step: found where they will touch, not where the step begins.

What nears by more than the margin in a step would be seen first when it overlaps, and be pushed along where it came
from. So B is moved against A, in a straight line, to where they touch or are nearest, and the manifold found there; its
gap is what they have to go along that normal. A margin that is fixed is Box2D's b2_speculativeDistance (Catto); the
search is conservative advancement (Mirtich, Impulse-based Dynamic Simulation, 1996).
"""

import math

from physics.collision.approach import nearing
from physics.collision.clipping import ALL_EDGES, best_edge, edge_normal
from physics.collision.hulls import collide_hull_circle
from physics.jit import subkernel
from physics.math2d import length_of
from physics.tables.body import STATIC

ADVANCES = 16  # of one pair; what is still on its way then is found when it is nearer
NEVER = -1.0


@subkernel
def is_swept(body, way):
    """Whether a body, BODY row, moves by more than half its size on a way [px]: that is left to the sweeps, or passes
    where there are none."""
    return body.kind != STATIC and way > body.thin_half


@subkernel
def reach_of(a, b, speed, margin, ahead):
    """How far apart [px] two bodies, BODY rows, that near each other at a speed [px/s] may be and still be told to
    meet: the margin, or as far as that takes them in `ahead` [s], or would if one of them were stopped."""
    way = ahead * max(speed, length_of(a.vx, a.vy), length_of(b.vx, b.vy))
    return margin if is_swept(a, way) or is_swept(b, way) else max(margin, way)


@subkernel
def reach_turning(a, b, speed, margin, ahead):
    """The same, as far as their corners get by turning: half the size of the smaller at most."""
    way = ahead * speed
    if is_swept(a, way) or is_swept(b, way):
        return margin
    turn = ahead * (abs(a.angular_velocity) * a.extent + abs(b.angular_velocity) * b.extent)
    return max(margin, min(turn, 0.5 * min(a.extent, b.extent)))


@subkernel
def time_of_discs(dx, dy, radii, vx, vy):
    """When [s] two discs touch whose centres lie dx, dy apart [px], the second moving at vx, vy [px/s]; NEVER."""
    along = dx * vx + dy * vy
    square = vx * vx + vy * vy
    rest = dx * dx + dy * dy - radii * radii
    root = along * along - square * rest
    if along >= 0.0 or root < 0.0 or square == 0.0:
        return NEVER
    # The root that does not cancel.
    return rest / (-along + math.sqrt(root))


@subkernel
def time_of_nearest(dx, dy, vx, vy):
    """When [s] two centres that lie dx, dy apart [px] are nearest, the second moving at vx, vy [px/s]."""
    square = vx * vx + vy * vy
    return -(dx * vx + dy * vy) / square if square > 0.0 else 0.0


@subkernel
def move_corners(count, x, y, corners_inout):
    """Move corners by x, y [px]."""
    for k in range(count):
        corners_inout[k, 0] += x
        corners_inout[k, 1] += y


@subkernel
def time_of_hulls(a, a_count, b_count, radii, vx, vy, target, most, b_inout):
    """When [s] two hulls are within the target [px] of each other, B moving at vx, vy [px/s]; NEVER within `most` [s].

    a, b_inout: world corners, grown by the radii together; B's are left where they are then. O(corners²) a round.
    """
    time = 0.0
    for _ in range(ADVANCES):
        a_edge, _, of_a = best_edge(a, a_count, ALL_EDGES, b_inout, b_count)
        b_edge, _, of_b = best_edge(b_inout, b_count, ALL_EDGES, a, a_count)
        gap = max(of_a, of_b) - radii
        if gap <= target:
            return time
        if of_a >= of_b:
            nx, ny = edge_normal(a, a_count, a_edge)
        else:
            nx, ny = edge_normal(b_inout, b_count, b_edge)
            nx = -nx
            ny = -ny
        speed = -(vx * nx + vy * ny)
        if speed <= 0.0:
            return time  # nearest: what turns them aside must not drive them into each other
        if gap - target > speed * (most - time):
            return NEVER
        # To the middle of what is left to the target, which no rounding can miss.
        span = (gap - 0.5 * target) / speed
        move_corners(b_count, span * vx, span * vy, b_inout)
        time += span
    return NEVER


@subkernel
def bring_together(margin, ahead, p, q, a, a_count, b_count, radii, b_inout):
    """Move B's corners to where two hulls touch in this step, where they meet faster than the margin allows for.

    p, q: BODY rows of A and B; a, b_inout: world corners, grown by the radii together [px]. Returns (when [s], or
    NEVER; B's velocity seen from A [px/s]; how far apart [px] their points may be then: who turns nears too).
    """
    if ahead == 0.0:
        return 0.0, 0.0, 0.0, margin
    vx, vy, speed = nearing(p, q)
    far = reach_of(p, q, speed, margin, ahead)
    reach = max(far, reach_turning(p, q, speed, margin, ahead))
    if far <= margin or ahead * speed <= margin:
        return 0.0, 0.0, 0.0, reach
    return time_of_hulls(a, a_count, b_count, radii, vx, vy, margin, ahead, b_inout), vx, vy, reach


@subkernel
def time_of_disc(corners, count, rounding, x, y, radius, vx, vy, target, most):
    """When [s] a disc at x, y [px] that moves at vx, vy [px/s] is within the target [px] of a hull, world corners grown
    by the rounding [px]; NEVER within `most` [s]. O(corners) a round."""
    time = 0.0
    for _ in range(ADVANCES):
        hit, nx, ny, _, _, gap, _ = collide_hull_circle(
            corners, count, ALL_EDGES, rounding, x + time * vx, y + time * vy, radius
        )
        if not hit or gap <= target:
            return time
        speed = -(vx * nx + vy * ny)
        if speed <= 0.0:
            return time
        if gap - target > speed * (most - time):
            return NEVER
        time += (gap - 0.5 * target) / speed
    return NEVER


@subkernel
def way_back(time, vx, vy, nx, ny):
    """What B, found where it had moved for a time [s] at vx, vy [px/s], has to go along the normal until then, and
    slides along the tangent (-ny, nx) [px]."""
    return -time * (vx * nx + vy * ny), time * (vy * nx - vx * ny)


@subkernel
def set_back(time, vx, vy, points_inout):
    """Tell a manifold in flight, found where B had moved for a time [s] at vx, vy [px/s], for where B is. Returns how
    far [px] B slides along the face until then."""
    nx = points_inout[1]
    ny = points_inout[2]
    way, lead = way_back(time, vx, vy, nx, ny)
    for k in range(int(points_inout[0])):
        at = 3 + 4 * k
        # Midway between the two surfaces, as they are now.
        points_inout[at] += 0.5 * way * nx
        points_inout[at + 1] += 0.5 * way * ny
        points_inout[at + 2] += way
    return lead
