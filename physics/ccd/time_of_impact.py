"""Time of impact of two moving shapes: closed forms without rotation, conservative advancement with rotation."""

import math
from typing import NamedTuple

import numpy as np

from physics.collision.hulls import collide_polygon_circle, edge_normal
from physics.distance.gjk import (
    AX,
    AY,
    CAPPED,
    FIRST_A,
    FIRST_B,
    NX,
    NY,
    ROUNDS,
    GapWorkspace,
    new_gap_workspace,
    shape_separation,
)
from physics.jit import subkernel
from physics.math2d import norm, rotate, unit

# ---- closed form -----------------------------------------------------------------------------------------------------
# First time of impact in closed form, of two shapes that move along a line without rotation: discs, polygons, rays.
#
# Polygons: their Minkowski difference is convex, and its faces have the normals of both outlines. So the relative
# motion enters the difference through the face that it crosses last (Cyrus and Beck 1978). Circles: a quadratic
# equation per corner, a linear equation per hull edge (Ericson, Real-Time Collision Detection, 5.5).

MISS = 2.0  # in place of a fraction 0..1 of the motion: no impact


@subkernel
def sweep_circles(x, y, dx, dy, radius):
    """Return the first impact (fraction of the motion, nx, ny) of two discs. The fraction is MISS without an impact.

    The normal points from the first disc to the second. x, y [px]: centre of the second disc relative to the first; dx,
    dy [px]: motion of the second disc relative to the first; radius [px]: sum of both radii. If the discs touch or
    overlap at the start, the fraction is 0 if they approach, else MISS.
    """
    nx, ny = unit(x, y, 1.0, 0.0)
    approach = x * dx + y * dy
    if norm(x, y) <= radius:
        return (0.0 if approach < 0.0 else MISS), nx, ny
    if approach >= 0.0:
        return MISS, nx, ny
    a = dx * dx + dy * dy
    c = x * x + y * y - radius * radius
    discriminant = approach * approach - a * c
    if discriminant < 0.0:
        return MISS, nx, ny
    # The smaller root, in a form without cancellation.
    fraction = c / (-approach + math.sqrt(discriminant))
    if fraction > 1.0:
        return MISS, nx, ny
    nx, ny = unit(x + fraction * dx, y + fraction * dy, nx, ny)
    return fraction, nx, ny


@subkernel
def cast_on_polygon(corners, count, edges, x, y, dx, dy):
    """Return where a ray enters a convex polygon: (fraction of the ray or MISS, nx, ny). The ray must start outside.

    x, y [px]: start of the ray; dx, dy [px]: vector from the start to the end of the ray; count: number of corners;
    edges: bit k is set if edge k may be hit. The ray is clipped by the half plane of each edge, so it cannot pass
    between two edges (Cyrus and Beck 1978).
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
    """Return the first impact of a moving disc with a polygon at rest as (fraction of the motion or MISS, nx, ny).

    The normal points from polygon to disc. corners, count: corners of the polygon [px], and their number; edges: bits
    of the edges (low 16) and corners (next 16) that may be hit. x, y, radius [px]: centre and radius of the disc;
    radius 0 means a ray; dx, dy [px]: motion of the disc.
    """
    hit, nx, ny, _, _, separation, _ = collide_polygon_circle(corners, count, edges, x, y, radius)
    if hit and separation <= 0.0:
        return (0.0 if nx * dx + ny * dy < 0.0 else MISS), nx, ny
    if radius == 0.0:
        return cast_on_polygon(corners, count, edges, x, y, dx, dy)
    best = MISS
    best_x, best_y = 0.0, -1.0
    for k in range(count):
        following = k + 1 if k + 1 < count else 0
        nx, ny = edge_normal(corners, count, k)
        speed = nx * dx + ny * dy
        if (edges >> k) & 1 and speed < 0.0:
            gap = nx * (x - corners[k, 0]) + ny * (y - corners[k, 1]) - radius
            fraction = gap / -speed
            if 0.0 <= fraction < best and fraction <= 1.0:
                at_x, at_y = x + fraction * dx, y + fraction * dy
                ex = corners[following, 0] - corners[k, 0]
                ey = corners[following, 1] - corners[k, 1]
                along = ex * (at_x - corners[k, 0]) + ey * (at_y - corners[k, 1])
                if 0.0 <= along <= ex * ex + ey * ey:
                    best = fraction
                    best_x, best_y = nx, ny
        if radius > 0.0 and (edges >> (16 + k)) & 1:
            fraction, nx, ny = sweep_circles(x - corners[k, 0], y - corners[k, 1], dx, dy, radius)
            if fraction < best:
                best = fraction
                best_x, best_y = nx, ny
    return best, best_x, best_y


@subkernel
def half_planes(a, a_count, b, b_count, side, move, slack, clip):
    """Return the time interval in which two moving polygons may overlap, clipped by the faces of the polygon in b.

    a, b (16, 2) [px]: corners, a_count and b_count in use; side: 1.0 if `a` holds polygon A and `b` holds B, -1.0 if
    `a` holds B and `b` holds A. move: motion (x, y) [px] of polygon A. slack [px]: distance by which faces are moved
    inwards.

    clip: the interval before the call. It has the form of the result: (fraction at which the overlap begins or MISS,
    fraction at which it ends, face entered last, nx, ny). The face is k for face k of B, and -1 - k for face k of A.
    The normal points from B to A.
    """
    enter, leave, entering, nx, ny = clip
    for k in range(b_count):
        mx, my = edge_normal(b, b_count, k)
        gap = math.inf
        for i in range(a_count):
            gap = min(gap, mx * (a[i, 0] - b[k, 0]) + my * (a[i, 1] - b[k, 1]))
        speed = side * (mx * move[0] + my * move[1])
        if gap + slack > 0.0:
            if speed >= 0.0:
                return MISS, leave, entering, nx, ny
            fraction = (gap + slack) / -speed
            if fraction > enter:
                enter = fraction
                entering = k if side > 0.0 else -1 - k
                nx, ny = side * mx, side * my
        elif speed > 0.0:
            leave = min(leave, -(gap + slack) / speed)
    return enter, leave, entering, nx, ny


@subkernel
def sweep_polygons(a, a_count, b, b_count, move, slack):
    """Return the first impact (fraction of the motion, nx, ny) of a moving polygon A with a polygon B at rest.

    The fraction is MISS without an impact; the normal points from B to A. move: motion (x, y) [px] of A; slack [px]: an
    overlap up to this depth is not an impact. If the overlap at the start is deeper, the fraction is MISS, because the
    contact solver resolves the overlap.
    """
    clip = half_planes(a, a_count, b, b_count, 1.0, move, slack, (-1.0, 1.0, 0, 0.0, -1.0))
    if clip[0] <= 1.0:
        clip = half_planes(b, b_count, a, a_count, -1.0, move, slack, clip)
    enter, leave, _, nx, ny = clip
    if enter < 0.0 or enter > leave or enter > 1.0:
        return MISS, nx, ny
    # Move back from the fraction at which the overlap is `slack` to the fraction of first touch.
    approach = -(nx * move[0] + ny * move[1])
    if approach <= 0.0:
        return MISS, nx, ny
    return max(0.0, enter - slack / approach), nx, ny


# ---- advance ---------------------------------------------------------------------------------------------------------
# First time of impact of two rounded hulls that move and rotate, by conservative advancement of second order.
#
# At a fraction t of the motion the nearest points give a normal n. Along this fixed n every corner moves with its
# velocity and an acceleration of at most (angular velocity)² · arm. So each pair of corners is apart until the root of
# a quadratic. The motion is free up to the smallest root, where a new normal is computed. Each such stop is before the
# impact, and near the impact the gap shrinks quadratically, as in Newton's method: few rounds are needed, and no impact
# is missed at any angular velocity. Source: Mirtich, Impulse-based Dynamic Simulation, 1996; Catto, Continuous
# Collision, GDC 2013.

ADVANCE_CAP = 256  # greatest number of iterations; head-on impacts take under ten, grazing impacts about forty
LEAVING_CAP = (
    1024  # most iterations while a pair touches and does not approach; each advances by at least 1 / LEAVING_CAP
)
TOLERANCE = 2.0**-43  # separation that counts as touching, as a share of the size of shapes and motion
TOUCHING_BAND = 2.0**-30  # corners this near to the touching corner along the normal also touch; as a share of the size
RESTING = 2.0**-42  # approach speed that counts as rounding error, as a share of the greatest speed
CENTER_X, CENTER_Y, ANGLE, MOVE_X, MOVE_Y, TURN = range(6)


class AdvanceWorkspace(NamedTuple):
    """Input and scratch arrays of `advance` for one pair of moving hulls."""

    local_a: np.ndarray  # (16, 2) corners from the centre of rotation of each side [px], at angle 0
    local_b: np.ndarray
    a: np.ndarray  # (16, 4) corners at the present fraction, from A's centre of rotation at the start [px], and normals
    b: np.ndarray
    motion_a: np.ndarray  # (6,) centre of rotation and angle at the start, and their changes until the end
    motion_b: np.ndarray
    totals: np.ndarray  # (2,) number of GJK and EPA iterations, number of times that an iteration limit was hit
    gap: GapWorkspace


def new_advance_workspace() -> AdvanceWorkspace:
    return AdvanceWorkspace(
        np.zeros((16, 2)),
        np.zeros((16, 2)),
        np.zeros((16, 4)),
        np.zeros((16, 4)),
        np.zeros(6),
        np.zeros(6),
        np.zeros(2),
        new_gap_workspace(),
    )


@subkernel
def place_at(local, count, motion, fraction, x, y, corners_out):
    """Write a hull's corners [px] at a fraction of its motion, relative to the world point (x, y), to corners_out.

    local (16, 2) [px]: corners relative to the centre of rotation at angle 0; motion (6,): see AdvanceWorkspace; count:
    number of corners.
    """
    angle = motion[ANGLE] + fraction * motion[TURN]
    cosine, sine = math.cos(angle), math.sin(angle)
    center_x = (motion[CENTER_X] - x) + fraction * motion[MOVE_X]
    center_y = (motion[CENTER_Y] - y) + fraction * motion[MOVE_Y]
    for k in range(count):
        u, v = rotate(local[k, 0], local[k, 1], cosine, sine)
        corners_out[k, 0] = center_x + u
        corners_out[k, 1] = center_y + v


@subkernel
def separate_at(a_count, a_radius, b_count, b_radius, fraction, workspace):
    """Return the separation [px] of the two hulls of a workspace at a fraction of their motions.

    a_count, a_radius, b_count, b_radius: numbers of corners and rounding radii [px]. The normal is written to
    workspace.gap.gap, the corners at this fraction to workspace.a and workspace.b.
    """
    x, y = workspace.motion_a[CENTER_X], workspace.motion_a[CENTER_Y]
    place_at(workspace.local_a, a_count, workspace.motion_a, fraction, x, y, workspace.a)
    place_at(workspace.local_b, b_count, workspace.motion_b, fraction, x, y, workspace.b)
    # Reset the state of the last pair, so that it does not affect this pair, not even in the last bit.
    i = min(int(workspace.gap.gap[FIRST_A]), a_count - 1) if fraction > 0.0 else 0
    j = min(int(workspace.gap.gap[FIRST_B]), b_count - 1) if fraction > 0.0 else 0
    separation = shape_separation(workspace.a, a_count, a_radius, workspace.b, b_count, b_radius, (i, j), workspace.gap)
    workspace.totals[0] += workspace.gap.state[ROUNDS]
    workspace.totals[1] += workspace.gap.state[CAPPED]
    return separation


@subkernel
def reach_of(local, count):
    """Return the distance [px] of the farthest of a hull's `count` corners `local` from its centre of rotation."""
    reach = 0.0
    for k in range(count):
        reach = max(reach, norm(local[k, 0], local[k, 1]))
    return reach


@subkernel
def along(corners, motion, fraction, k, x, y, nx, ny):
    """Return (position [px], velocity, bound of the acceleration) of corner k of a hull along the unit vector (nx, ny).

    Velocity and acceleration are per whole motion. corners (16, 2) [px]: corners at this fraction of `motion`, relative
    to the world point (x, y); motion (6,): see AdvanceWorkspace.
    """
    arm_x = corners[k, 0] - ((motion[CENTER_X] - x) + fraction * motion[MOVE_X])
    arm_y = corners[k, 1] - ((motion[CENTER_Y] - y) + fraction * motion[MOVE_Y])
    turn = motion[TURN]
    speed = nx * (motion[MOVE_X] - turn * arm_y) + ny * (motion[MOVE_Y] + turn * arm_x)
    return nx * corners[k, 0] + ny * corners[k, 1], speed, turn * turn * norm(arm_x, arm_y)


@subkernel
def free_until(gap, speed, bend):
    """Return the first t >= 0 with gap + speed · t - bend / 2 · t² = 0, infinite if there is none.

    t is a lower bound of the time until two corners meet. gap >= 0 [px]: distance of the corners; speed: rate at which
    the gap grows; bend: bound of the acceleration, >= 0.
    """
    if bend > 0.0:
        root = math.sqrt(speed * speed + 2.0 * bend * gap)
        if speed < 0.0:
            return 2.0 * gap / (root - speed)
        return (root + speed) / bend
    if speed < 0.0:
        return gap / -speed
    return math.inf


@subkernel
def free_motion(a_count, b_count, radii, fraction, separation, workspace):
    """Return by how much the fraction of the motion can increase before the hulls may meet (a lower bound).

    The bound is the time until any two corners can meet along the present normal. a_count, b_count: numbers of corners;
    radii [px]: sum of both radii; separation [px]: separation of the hulls at `fraction`, and least distance that is
    assumed for a pair of corners. O(corners of A · corners of B). workspace: see AdvanceWorkspace.
    """
    nx, ny = workspace.gap.gap[NX], workspace.gap.gap[NY]
    x, y = workspace.motion_a[CENTER_X], workspace.motion_a[CENTER_Y]
    until = math.inf
    for i in range(a_count):
        at_a, speed_a, bend_a = along(workspace.a, workspace.motion_a, fraction, i, x, y, nx, ny)
        for j in range(b_count):
            at_b, speed_b, bend_b = along(workspace.b, workspace.motion_b, fraction, j, x, y, nx, ny)
            # No pair is nearer than the separation, even with rounding errors.
            gap = max(separation, at_b - at_a - radii)
            until = min(until, free_until(max(0.0, gap), speed_b - speed_a, bend_a + bend_b))
    if separation > 0.0:
        # For hulls that are far apart and rotate fast: no corner leaves the circle around its centre of rotation.
        center = nx * (
            (workspace.motion_b[CENTER_X] - x)
            + fraction * workspace.motion_b[MOVE_X]
            - fraction * workspace.motion_a[MOVE_X]
        ) + ny * (
            (workspace.motion_b[CENTER_Y] - y)
            + fraction * workspace.motion_b[MOVE_Y]
            - fraction * workspace.motion_a[MOVE_Y]
        )
        gap = center - reach_of(workspace.local_a, a_count) - reach_of(workspace.local_b, b_count) - radii
        if gap > 0.0:
            speed = nx * (workspace.motion_b[MOVE_X] - workspace.motion_a[MOVE_X]) + ny * (
                workspace.motion_b[MOVE_Y] - workspace.motion_a[MOVE_Y]
            )
            until = max(until, free_until(gap, speed, 0.0))
    return until


@subkernel
def speed_of(motion, seen_from, fraction, x, y, nx, ny):
    """Return the velocity [px per motion] of a body's point (x, y) along the unit vector (nx, ny).

    motion: motion of the body; fraction: fraction of this motion. x, y [px]: the point. The origin of its coordinates
    is the centre of rotation of the motion `seen_from` at the start.
    """
    arm_x = x - ((motion[CENTER_X] - seen_from[CENTER_X]) + fraction * motion[MOVE_X])
    arm_y = y - ((motion[CENTER_Y] - seen_from[CENTER_Y]) + fraction * motion[MOVE_Y])
    return nx * (motion[MOVE_X] - motion[TURN] * arm_y) + ny * (motion[MOVE_Y] + motion[TURN] * arm_x)


@subkernel
def touching_span(corners, count, nx, ny, side, band):
    """Return the interval (low, high) [px] along the tangent (-ny, nx) that a hull's touching face or corner covers.

    The touching corners are those farthest in the direction side · (nx, ny), up to a difference of `band` [px]. count:
    number of corners.
    """
    furthest = -math.inf
    for k in range(count):
        furthest = max(furthest, side * (nx * corners[k, 0] + ny * corners[k, 1]))
    low, high = math.inf, -math.inf
    for k in range(count):
        if side * (nx * corners[k, 0] + ny * corners[k, 1]) >= furthest - band:
            along = nx * corners[k, 1] - ny * corners[k, 0]
            low, high = min(low, along), max(high, along)
    return low, high


@subkernel
def approach_at(a_count, b_count, fraction, band, workspace):
    """Return the greatest approach speed [px per motion] along the normal of two touching hulls.

    If two faces touch, within `band` [px], the speed is greatest at an end of their common part, so only the ends are
    tested. a_count, b_count: numbers of corners. workspace: after separate_at, with the normal and corners at
    `fraction`.
    """
    nx, ny = workspace.gap.gap[NX], workspace.gap.gap[NY]
    a_low, a_high = touching_span(workspace.a, a_count, nx, ny, 1.0, band)
    b_low, b_high = touching_span(workspace.b, b_count, nx, ny, -1.0, band)
    low, high = max(a_low, b_low), min(a_high, b_high)
    if low > high:
        low = 0.5 * (low + high)
        high = low
    across = nx * workspace.gap.gap[AX] + ny * workspace.gap.gap[AY]
    most = -math.inf
    for end in range(2):
        at = low if end == 0 else high
        x, y = across * nx - at * ny, across * ny + at * nx
        most = max(
            most,
            speed_of(workspace.motion_a, workspace.motion_a, fraction, x, y, nx, ny)
            - speed_of(workspace.motion_b, workspace.motion_a, fraction, x, y, nx, ny),
        )
    return most


@subkernel
def advance(a_count, a_radius, b_count, b_radius, workspace):
    """Return the first fraction of the motion at which two moving hulls meet, or MISS.

    workspace: the caller writes local_a, local_b, motion_a and motion_b. On return, gap.gap holds normal and points at
    the impact, and the counters in `totals` are increased. a_count, b_count: numbers of corners; a_radius, b_radius
    [px]: roundings. If the hulls touch or overlap at the start, the result is 0 if they approach; otherwise the search
    continues until they approach. If ADVANCE_CAP iterations are not enough, the result is a fraction before the impact.
    """
    turn_a, turn_b = abs(workspace.motion_a[TURN]), abs(workspace.motion_b[TURN])
    reach_a, reach_b = reach_of(workspace.local_a, a_count), reach_of(workspace.local_b, b_count)
    path = norm(
        workspace.motion_b[MOVE_X] - workspace.motion_a[MOVE_X], workspace.motion_b[MOVE_Y] - workspace.motion_a[MOVE_Y]
    )
    size = reach_a + reach_b + a_radius + b_radius
    speed = path + turn_a * reach_a + turn_b * reach_b
    tolerance = TOLERANCE * (size + path)
    radii = a_radius + b_radius
    workspace.gap.gap[FIRST_A] = 0.0
    workspace.gap.gap[FIRST_B] = 0.0
    fraction = 0.0
    stops = 0
    leaving = 0
    was_apart = False
    while stops < ADVANCE_CAP and leaving <= LEAVING_CAP:
        separation = separate_at(a_count, a_radius, b_count, b_radius, fraction, workspace)
        if separation <= tolerance:
            if was_apart:
                return fraction
            if approach_at(a_count, b_count, fraction, TOUCHING_BAND * size, workspace) > RESTING * speed:
                return fraction
            if turn_a * reach_a + turn_b * reach_b == 0.0:
                return MISS  # convex hulls without rotation do not meet again
            leaving += 1
            fraction += max(free_motion(a_count, b_count, radii, fraction, separation, workspace), 1.0 / LEAVING_CAP)
            if fraction >= 1.0:
                return MISS
            continue
        was_apart = True
        stops += 1
        if fraction == 1.0:
            return MISS
        # A motion that ends within rounding errors of a contact may touch at its end.
        fraction += free_motion(a_count, b_count, radii, fraction, separation, workspace)
        if fraction > 1.0 + TOUCHING_BAND:
            return MISS
        fraction = min(fraction, 1.0)
    workspace.totals[1] += 1.0
    return fraction
