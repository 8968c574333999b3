"""Fast bodies, their first impact on their path, and the pose at which they stop."""

import math

from physics.ccd.rotational import stands_deep, sweep_rotational
from physics.ccd.time_of_impact import MISS, has_closed_form, write_impact
from physics.collision.manifold import open_manifold
from physics.jit import kernel, subkernel
from physics.math2d import norm, rotate
from physics.tables.body import AUTO, DYNAMIC, KINEMATIC, OFF, RAY, STATIC, SWEPT, TOI
from physics.tables.shape import CHAIN, MASK, TILES
from physics.tables.step_state import TOI_CALLS

# ---- paths -----------------------------------------------------------------------------------------------------------
# Paths of the bodies through a step, and the bodies that are fast enough to pass through others.
#
# Source: Catto, Box2D v3, solver.c (half the smallest extent).


@kernel
def list_paths(rows, bodies, paths_out):
    """Write centre of mass and angle before and after the step: x0 y0 angle0 x1 y1 angle1 [px, rad]. O(rows).

    A body with a sweep without rotation keeps its angle before the step.
    """
    for k in range(len(rows)):
        i = rows[k]
        b = bodies[i]
        u, v = rotate(b.local_center_x, b.local_center_y, math.cos(b.previous_angle), math.sin(b.previous_angle))
        paths_out[i, 0] = b.previous_x + u
        paths_out[i, 1] = b.previous_y + v
        paths_out[i, 2] = b.previous_angle
        u, v = rotate(b.local_center_x, b.local_center_y, math.cos(b.angle), math.sin(b.angle))
        paths_out[i, 3] = b.x + u
        paths_out[i, 4] = b.y + v
        paths_out[i, 5] = b.previous_angle if b.continuous == RAY or b.continuous == SWEPT else b.angle


@subkernel
def asks_straight(body):
    """Return whether the continuous mode of a body is a sweep without rotation, moving or not."""
    return body.kind == DYNAMIC and (body.continuous == RAY or body.continuous == SWEPT)


@subkernel
def way_of(bodies, paths, row):
    """Return the greatest distance [px] that any point of a body moves."""
    moved = norm(paths[row, 3] - paths[row, 0], paths[row, 4] - paths[row, 1])
    return moved + bodies[row].extent * min(abs(paths[row, 5] - paths[row, 2]), 2.0)


@kernel
def find_fast(rows, bodies, paths, fast_out):
    """Flag the bodies to sweep. Return (the number of bodies to look at, the number swept without rotation). O(rows).

    Modes "toi", "ray" and "swept" are always swept while they move; "auto" if a point may move by more than half the
    body's size. Bodies that a kinematic body may pass through count as bodies to look at, without a flag: see outruns.
    fast_out (bodies) bool.
    """
    found = 0
    straight = 0
    carried = 0.0
    for k in range(len(rows)):
        if bodies[rows[k]].kind == KINEMATIC:
            carried = max(carried, way_of(bodies, paths, rows[k]))
    for k in range(len(rows)):
        i = rows[k]
        b = bodies[i]
        fast_out[i] = False
        if asks_straight(b):
            straight += 1
        if b.kind == STATIC or b.quarantined or not b.awake or b.continuous == OFF:
            continue
        moved = way_of(bodies, paths, i)
        if moved > 0.0 and (b.continuous != AUTO or moved > b.inradius):
            fast_out[i] = True
            found += 1
        elif b.kind == DYNAMIC and carried > 0.0 and moved + carried > b.inradius:
            found += 1
    return found, straight


@subkernel
def is_fast(bodies, paths, row, other):
    """Return whether a kinematic body (other) and a dynamic one have a relative motion above half its size."""
    b = bodies[row]
    if b.kind != DYNAMIC or bodies[other].kind != KINEMATIC or b.continuous == OFF or b.quarantined:
        return False
    dx = (paths[row, 3] - paths[row, 0]) - (paths[other, 3] - paths[other, 0])
    dy = (paths[row, 4] - paths[row, 1]) - (paths[other, 4] - paths[other, 1])
    far = norm(paths[row, 0] - paths[other, 0], paths[row, 1] - paths[other, 1]) + b.extent
    rotate = far * min(abs(paths[other, 5] - paths[other, 2]), 2.0)
    rotate += b.extent * min(abs(paths[row, 5] - paths[row, 2]), 2.0)
    return norm(dx, dy) + rotate > b.inradius


@kernel
def find_outgrown(rows, bodies, shapes, proxies, fast, rows_out):
    """List the shape rows of swept bodies that left their swept AABB. Return their number. O(rows)."""
    found = 0
    for k in range(len(rows)):
        row = rows[k]
        s = shapes[row]
        if s.proxy < 0:
            continue
        b = bodies[s.body_row]
        if not (fast[s.body_row] or asks_straight(b)):
            continue
        p = proxies[s.proxy]
        if s.min_x < p.lower_x or s.max_x > p.upper_x or s.min_y < p.lower_y or s.max_y > p.upper_y:
            rows_out[found] = row
            found += 1
    return found


@kernel
def foresee_paths(rows, bodies, dt, paths_out):
    """Write the paths (see list_paths) of the bodies in dt [s] without obstacles. O(rows)."""
    for k in range(len(rows)):
        i = rows[k]
        b = bodies[i]
        moves = 0.0 if b.kind == STATIC or b.quarantined else dt
        paths_out[i, 0] = b.center_x
        paths_out[i, 1] = b.center_y
        paths_out[i, 2] = b.angle
        paths_out[i, 3] = b.center_x + moves * b.vx
        paths_out[i, 4] = b.center_y + moves * b.vy
        turns = 0.0 if b.continuous == RAY or b.continuous == SWEPT else moves * b.angular_velocity
        paths_out[i, 5] = b.angle + turns


@subkernel
def cut_path(paths, row, start, end, cut_out):
    """Write the part of a body's path between two fractions of the step."""
    for k in range(3):
        whole = paths[row, 3 + k] - paths[row, k]
        cut_out[row, k] = paths[row, k] + start * whole
        cut_out[row, 3 + k] = paths[row, 3 + k] if end == 1.0 else paths[row, k] + end * whole


# ---- impacts ---------------------------------------------------------------------------------------------------------
# The sweep over one step of bodies that also rotate: the first impact of each fast body, and where it stops.
#
# Two bullets that meet stop each other. A body that stops earlier than expected may be in the way of another, so the
# moving pairs are swept again until no fraction changes. Sources: Catto, Box2D v3, solver.c (fast bodies, core circle);
# Mirtich, Timewarp Rigid Body Simulation, 2000 (conservative rounds).


@subkernel
def first_meeting(geometry, bodies, shapes, paths, mover, other, slack, one_way, cuts_out, workspace, work_inout):
    """Return the first impact of `mover` with `other` as (fraction or MISS, normal from other to mover, feature).

    Each body moves up to its fraction of the step, and then rests.
    """
    p = shapes[mover].body_row
    q = shapes[other].body_row
    far_p = bodies[p].fraction
    far_q = bodies[q].fraction
    both = min(far_p, far_q)
    if both > 0.0:
        cut_path(paths, p, 0.0, both, cuts_out)
        cut_path(paths, q, 0.0, both, cuts_out)
        fraction, nx, ny, feature = sweep_rotational(
            geometry, bodies, shapes, cuts_out, mover, other, slack, one_way, -1, workspace, work_inout
        )
        if fraction <= 1.0:
            return fraction * both, nx, ny, feature
    last = max(far_p, far_q)
    if last == both:
        return MISS, 0.0, -1.0, -1
    cut_path(paths, p, min(both, far_p), far_p, cuts_out)
    cut_path(paths, q, min(both, far_q), far_q, cuts_out)
    fraction, nx, ny, feature = sweep_rotational(
        geometry, bodies, shapes, cuts_out, mover, other, slack, one_way, -1, workspace, work_inout
    )
    if fraction <= 1.0:
        return both + fraction * (last - both), nx, ny, feature
    return MISS, 0.0, -1.0, -1


@subkernel
def stands_still(bodies, paths, row):
    """Return whether a body is static, or kinematic and did not move in this step."""
    return bodies[row].kind != DYNAMIC and (
        paths[row, 0] == paths[row, 3] and paths[row, 1] == paths[row, 4] and paths[row, 2] == paths[row, 5]
    )


@subkernel
def rest_where_it_is(bodies, row, paths_inout, fast_inout):
    """Write the path of a resting body for one that no pass of this step reads."""
    b = bodies[row]
    if b.active:
        return
    fast_inout[row] = False
    for k in range(0, 6, 3):
        paths_inout[row, k] = b.center_x
        paths_inout[row, k + 1] = b.center_y
        paths_inout[row, k + 2] = b.angle


@subkernel
def goes_on(bodies, paths, mover, other, fraction, nx, ny):
    """Return the distance [px] that two bodies still move after they meet at a fraction of the step.

    It is the motion into each other along the unit normal from other to mover, or of any point by rotation, whichever
    is greater.
    """
    left_m = max(0.0, bodies[mover].fraction - fraction)
    left_o = max(0.0, bodies[other].fraction - fraction)
    dx = left_m * (paths[mover, 3] - paths[mover, 0]) - left_o * (paths[other, 3] - paths[other, 0])
    dy = left_m * (paths[mover, 4] - paths[mover, 1]) - left_o * (paths[other, 4] - paths[other, 1])
    turns = (
        abs(paths[mover, 5] - paths[mover, 2]) * bodies[mover].extent
        + abs(paths[other, 5] - paths[other, 2]) * bodies[other].extent
    )
    return max(-(nx * dx + ny * dy), turns)


@kernel
def find_rotational_impacts(
    # read
    geometry,
    bodies,
    shapes,
    candidates,
    count,
    moving,
    stacking,
    rotation,
    slack,
    one_way,
    # write
    paths_inout,
    fast_inout,
    cuts_out,
    workspace,
    impacts_out,
    work_inout,
):
    """List (candidate, fraction, normal from A to B, stops, feature) of the pairs that a fast body meets on its path.

    paths_inout (bodies, 6) from list_paths. fast (bodies) bool. moving: 0 for pairs with resting bodies, 1 for the
    others. stacking: two dynamic bodies are left to the solver unless one is a bullet; without it, motion into the
    other by less than a quarter of the half extent does not stop a body, because the contact removes it at once.
    rotation: without it, pairs with a closed form were found by that. slack [px]: see sweep_part. impacts_out (n, 8).
    Return the number found. O(candidates).
    """
    found = 0
    for i in range(count):
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        rest_where_it_is(bodies, a.body_row, paths_inout, fast_inout)
        rest_where_it_is(bodies, b.body_row, paths_inout, fast_inout)
        fast = fast_inout[a.body_row] or fast_inout[b.body_row]
        fast = fast or is_fast(bodies, paths_inout, a.body_row, b.body_row)
        if not (fast or is_fast(bodies, paths_inout, b.body_row, a.body_row)):
            continue
        p = bodies[a.body_row]
        q = bodies[b.body_row]
        still = stands_still(bodies, paths_inout, a.body_row) or stands_still(bodies, paths_inout, b.body_row)
        if still == (moving == 1):
            continue
        if stacking and p.kind == DYNAMIC and q.kind == DYNAMIC and not (p.bullet or q.bullet):
            continue
        # The body that can be stopped is swept, otherwise the fast one: they move relative to each other.
        ground_a = a.kind == TILES or a.kind == CHAIN or a.kind == MASK
        first = fast_inout[a.body_row] if (p.kind == DYNAMIC) == (q.kind == DYNAMIC) else p.kind == DYNAMIC
        from_a = first and not ground_a
        mover = candidates[i, 0] if from_a else candidates[i, 1]
        other = candidates[i, 1] if from_a else candidates[i, 0]
        kind = shapes[mover].kind
        if kind == TILES or kind == CHAIN or kind == MASK or shapes[other].kind == MASK:
            continue
        mode = bodies[shapes[mover].body_row].continuous
        straight = mode == RAY or mode == SWEPT or (mode == AUTO and not (stacking or rotation))
        if straight and has_closed_form(shapes[mover], shapes[other], mode):
            # From deep inside, by the rule of the other shapes.
            if not stands_deep(geometry, bodies, shapes, paths_inout, mover, other, slack, workspace):
                continue
        work_inout[TOI_CALLS] += 1
        fraction, nx, ny, feature = first_meeting(
            geometry, bodies, shapes, paths_inout, mover, other, slack, one_way, cuts_out, workspace, work_inout
        )
        if fraction > 1.0:
            continue
        m = shapes[mover].body_row
        o = shapes[other].body_row
        room_left = 0.25 * bodies[m].min_half_extent
        stops = stacking or goes_on(bodies, paths_inout, m, o, fraction, nx, ny) > room_left
        if not stops and (shapes[other].kind == TILES or shapes[other].kind == CHAIN):
            # The part that it may pass need not be all of the ground: a ball that rolls down a wall has a floor.
            later, u, v, part = first_meeting(
                geometry,
                bodies,
                shapes,
                paths_inout,
                mover,
                other,
                slack + room_left,
                one_way,
                cuts_out,
                workspace,
                work_inout,
            )
            if later <= 1.0:
                fraction, nx, ny, feature, stops = later, u, v, part, True
        found = write_impact(i, fraction, nx, ny, feature, from_a, stops, found, impacts_out)
    return found


@kernel
def move_back(rows, paths, bodies_inout):
    """Move the stopped dynamic bodies back to where they stopped; their velocities stay. O(rows)."""
    for k in range(len(rows)):
        i = rows[k]
        b = bodies_inout[i]
        if b.fraction >= 1.0 or b.kind != DYNAMIC:
            continue
        f = b.fraction
        b.center_x = paths[i, 0] + f * (paths[i, 3] - paths[i, 0])
        b.center_y = paths[i, 1] + f * (paths[i, 4] - paths[i, 1])
        turn = f * (b.angle - b.previous_angle)
        if turn == 0.0:
            b.x = b.previous_x + (b.center_x - paths[i, 0])
            b.y = b.previous_y + (b.center_y - paths[i, 1])
            b.angle = b.previous_angle
        else:
            b.angle = b.previous_angle + turn
            u, v = rotate(b.local_center_x, b.local_center_y, math.cos(b.angle), math.sin(b.angle))
            b.x = b.center_x - u
            b.y = b.center_y - v


@subkernel
def is_ray(body, other):
    """Return whether a body meets another with the ray of its centre, not with its outline."""
    return body.continuous == RAY and body.kind != STATIC and other.continuous != SWEPT and other.continuous != TOI


@subkernel
def impact_point(body, shape, side, nx, ny, fraction, flew_on):
    """Return the point [px] where a shape met another, towards side times the normal.

    It is on the edge of its box, or at the centre of a ray. The box is that of the end of the step. flew_on: whether it
    is moved back from there, because no contact kept it.
    """
    reach = 0.0 if body.continuous == RAY and body.kind != STATIC else side
    x = 0.5 * (shape.min_x + shape.max_x) + reach * nx * 0.5 * (shape.max_x - shape.min_x)
    y = 0.5 * (shape.min_y + shape.max_y) + reach * ny * 0.5 * (shape.max_y - shape.min_y)
    if flew_on and body.fraction > fraction:
        after = 1.0 - fraction / body.fraction
        x -= after * (body.x - body.previous_x)
        y -= after * (body.y - body.previous_y)
    return x, y


@kernel
def write_impacts(bodies, shapes, candidates, impacts, count, dt, response, manifolds_out):
    """Write a manifold for every impact that is the first of a body on its path, or of a sensor. Return their number.

    impacts (n, 8): candidate, fraction, normal, stops, feature, point. A point of nan is replaced by the edge, along
    the normal, of the smaller box, or by the place where a ray hit. With response 1 the separation is that at the final
    poses: the motion of a side after the impact.
    """
    found = 0
    for i in range(count):
        pair = int(impacts[i, 0])
        a = shapes[candidates[pair, 0]]
        b = shapes[candidates[pair, 1]]
        p = bodies[a.body_row]
        q = bodies[b.body_row]
        first = min(p.fraction, q.fraction)
        if impacts[i, 1] > first:
            continue
        nx = impacts[i, 2]
        ny = impacts[i, 3]
        small_a = (a.max_x - a.min_x) + (a.max_y - a.min_y) <= (b.max_x - b.min_x) + (b.max_y - b.min_y)
        if is_ray(p, q) or is_ray(q, p):
            small_a = is_ray(p, q)
        s = a if small_a else b
        flew_on = response == 0 or a.sensor or b.sensor
        x, y = impact_point(p if small_a else q, s, 1.0 if small_a else -1.0, nx, ny, impacts[i, 1], flew_on)
        if not math.isnan(impacts[i, 6]):
            x = impacts[i, 6]
            y = impacts[i, 7]
        separation = 0.0
        if response == 1:
            after_x = (q.x - q.previous_x) - (p.x - p.previous_x) - impacts[i, 1] * dt * (q.vx - p.vx)
            after_y = (q.y - q.previous_y) - (p.y - p.previous_y) - impacts[i, 1] * dt * (q.vy - p.vy)
            # The motion after a grazing contact is no overlap.
            separation = min(0.0, nx * after_x + ny * after_y) if impacts[i, 4] == 1.0 else 0.0
        if found < len(manifolds_out):
            m = manifolds_out[found]
            open_manifold(shapes, candidates, pair, nx + 0.0, ny + 0.0, m)
            m.count = 1
            m.x_1 = x
            m.y_1 = y
            m.separation_1 = separation
            m.area_1 = 0.0
            m.feature_1 = int(impacts[i, 5])
            m.swept = True
        found += 1
    return found
