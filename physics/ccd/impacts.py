"""Who is fast, whom it meets first, and where it stops: the sweep over one step of bodies that also turn.

Two bullets that meet stop each other. A body that stops earlier than was foreseen may stand in another's way, so the
moving pairs are looked at again until nothing changes. Sources: Catto, Box2D v3, solver.c (fast bodies, core circle);
Mirtich, Timewarp Rigid Body Simulation, 2000 (conservative rounds).
"""

import math

from physics.ccd.closed_form import MISS
from physics.ccd.linear import has_closed_form, write_impact
from physics.ccd.rotational_pairs import sweep_rotational
from physics.collision.manifold import open_manifold
from physics.jit import kernel, subkernel
from physics.math2d import length_of, turned
from physics.tables.body import AUTO, DYNAMIC, OFF, RAY, STATIC, SWEPT
from physics.tables.counters import TOI_CALLS
from physics.tables.shape import CHAIN, MASK, TILES


@kernel
def list_paths(
    # read
    rows,
    bodies,
    # write
    paths_out,
):
    """Write centre of mass and angle before and after the step: x0 y0 angle0 x1 y1 angle1 [px, rad]. O(rows).

    What asks for a sweep without turning is swept at the angle it has before.
    """
    for k in range(len(rows)):
        i = rows[k]
        b = bodies[i]
        u, v = turned(b.local_center_x, b.local_center_y, math.cos(b.previous_angle), math.sin(b.previous_angle))
        paths_out[i, 0] = b.previous_x + u
        paths_out[i, 1] = b.previous_y + v
        paths_out[i, 2] = b.previous_angle
        u, v = turned(b.local_center_x, b.local_center_y, math.cos(b.angle), math.sin(b.angle))
        paths_out[i, 3] = b.x + u
        paths_out[i, 4] = b.y + v
        paths_out[i, 5] = b.previous_angle if b.continuous == RAY or b.continuous == SWEPT else b.angle


@subkernel
def asks_straight(body):
    """Whether a body asks for a sweep without turning, whether it moves or not."""
    return body.kind == DYNAMIC and (body.continuous == RAY or body.continuous == SWEPT)


@kernel
def find_fast(
    # read
    rows,
    bodies,
    paths,
    # write
    fast_out,
):
    """Flag the bodies that a sweep is asked for. Returns (their number, the number of those that are swept without
    turning, moving or not). O(rows).

    "toi", "ray" and "swept" always, while they move; "auto" when a point may move by more than half the body's size.
    fast_out (bodies) bool.
    """
    found = 0
    straight = 0
    for k in range(len(rows)):
        i = rows[k]
        b = bodies[i]
        fast_out[i] = False
        if asks_straight(b):
            straight += 1
        if b.kind == STATIC or b.quarantined or not b.awake or b.continuous == OFF:
            continue
        moved = length_of(paths[i, 3] - paths[i, 0], paths[i, 4] - paths[i, 1])
        moved += b.extent * min(abs(paths[i, 5] - paths[i, 2]), 2.0)
        if moved > 0.0 and (b.continuous != AUTO or moved > b.smallest_half):
            fast_out[i] = True
            found += 1
    return found, straight


@kernel
def find_outgrown(
    # read
    rows,
    bodies,
    shapes,
    proxies,
    fast,
    # write
    rows_out,
):
    """List those of the shape rows that left their motion rectangle, of bodies that are swept. Returns their number.

    O(rows).
    """
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
def foresee_paths(
    # read
    rows,
    bodies,
    dt,
    # write
    paths_out,
):
    """Write the paths (see list_paths) that the bodies will take in dt [s] if nothing is in the way. O(rows)."""
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


@subkernel
def first_meeting(geometry, bodies, shapes, paths, mover, other, slack, one_way, cuts_out, workspace, work_inout):
    """Fraction of the step at which `mover` first meets `other`,
    each going as far as its body's fraction and resting then.

    Returns (fraction or MISS, normal from other to mover).
    """
    p = shapes[mover].body_row
    q = shapes[other].body_row
    far_p = bodies[p].fraction
    far_q = bodies[q].fraction
    both = min(far_p, far_q)
    if both > 0.0:
        cut_path(paths, p, 0.0, both, cuts_out)
        cut_path(paths, q, 0.0, both, cuts_out)
        fraction, nx, ny, core = sweep_rotational(
            geometry, bodies, shapes, cuts_out, mover, other, slack, one_way, workspace, work_inout
        )
        if fraction <= 1.0:
            return fraction * both, nx, ny
    last = max(far_p, far_q)
    if last == both:
        return MISS, 0.0, -1.0
    cut_path(paths, p, min(both, far_p), far_p, cuts_out)
    cut_path(paths, q, min(both, far_q), far_q, cuts_out)
    fraction, nx, ny, core = sweep_rotational(
        geometry, bodies, shapes, cuts_out, mover, other, slack, one_way, workspace, work_inout
    )
    if fraction <= 1.0:
        return both + fraction * (last - both), nx, ny
    return MISS, 0.0, -1.0


@subkernel
def stands_still(bodies, paths, row):
    """Whether a body is static, or kinematic and not moved in this step."""
    return bodies[row].kind != DYNAMIC and (
        paths[row, 0] == paths[row, 3] and paths[row, 1] == paths[row, 4] and paths[row, 2] == paths[row, 5]
    )


@subkernel
def rest_where_it_is(bodies, row, paths_inout, fast_inout):
    """Give a body that no pass of this step goes over the path of one that stands."""
    b = bodies[row]
    if b.active:
        return
    fast_inout[row] = False
    for k in range(0, 6, 3):
        paths_inout[row, k] = b.center_x
        paths_inout[row, k + 1] = b.center_y
        paths_inout[row, k + 2] = b.angle


@kernel
def find_rotational_impacts(
    # read
    geometry,
    bodies,
    shapes,
    candidates,
    count,
    moving,
    everyone,
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
    """List (candidate, fraction, normal from A to B, stops) of the pairs that a fast body meets on its path.

    paths_inout (bodies, 6) from list_paths; fast (bodies) bool; moving: 0 for the pairs with what stands still, 1 for
    the others; everyone: 0 where only bullets mind what moves, 1 where all do, 2 where besides nothing turns and what
    has a closed form was found by it; slack [px]: closer at the start is in contact already. Without a stacking solver
    motion into the other by less than a quarter of the half size stops nobody: the contact lets it out at once.
    impacts_out (n, 5). Returns the number found. O(candidates).
    """
    found = 0
    for i in range(count):
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        rest_where_it_is(bodies, a.body_row, paths_inout, fast_inout)
        rest_where_it_is(bodies, b.body_row, paths_inout, fast_inout)
        if not (fast_inout[a.body_row] or fast_inout[b.body_row]):
            continue
        p = bodies[a.body_row]
        q = bodies[b.body_row]
        still = stands_still(bodies, paths_inout, a.body_row) or stands_still(bodies, paths_inout, b.body_row)
        if still == (moving == 1) or not (still or everyone > 0 or p.bullet or q.bullet):
            continue
        from_a = fast_inout[a.body_row] and a.kind != TILES and a.kind != CHAIN and a.kind != MASK
        mover = candidates[i, 0] if from_a else candidates[i, 1]
        other = candidates[i, 1] if from_a else candidates[i, 0]
        kind = shapes[mover].kind
        if kind == TILES or kind == CHAIN or kind == MASK or shapes[other].kind == MASK:
            continue
        mode = bodies[shapes[mover].body_row].continuous
        straight = mode == RAY or mode == SWEPT or (mode == AUTO and everyone == 2)
        if straight and has_closed_form(shapes[mover], shapes[other], mode):
            continue
        work_inout[TOI_CALLS] += 1
        fraction, nx, ny = first_meeting(
            geometry, bodies, shapes, paths_inout, mover, other, slack, one_way, cuts_out, workspace, work_inout
        )
        if fraction > 1.0:
            continue
        m = shapes[mover].body_row
        o = shapes[other].body_row
        # What either has still to go when they meet.
        left_m = max(0.0, bodies[m].fraction - fraction)
        left_o = max(0.0, bodies[o].fraction - fraction)
        dx = left_m * (paths_inout[m, 3] - paths_inout[m, 0]) - left_o * (paths_inout[o, 3] - paths_inout[o, 0])
        dy = left_m * (paths_inout[m, 4] - paths_inout[m, 1]) - left_o * (paths_inout[o, 4] - paths_inout[o, 1])
        room_left = 0.25 * bodies[m].smallest_half
        turns = (
            abs(paths_inout[m, 5] - paths_inout[m, 2]) * bodies[m].extent
            + abs(paths_inout[o, 5] - paths_inout[o, 2]) * bodies[o].extent
        )
        stops = everyone == 0 or -(nx * dx + ny * dy) > room_left or turns > room_left
        found = write_impact(i, fraction, nx, ny, from_a, stops, found, impacts_out)
    return found


@kernel
def move_back(
    # read
    rows,
    paths,
    # write
    bodies_inout,
):
    """Put the dynamic bodies that were stopped where they stopped; their velocities stay. O(rows)."""
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
            u, v = turned(b.local_center_x, b.local_center_y, math.cos(b.angle), math.sin(b.angle))
            b.x = b.center_x - u
            b.y = b.center_y - v


@kernel
def write_impacts(
    # read
    bodies,
    shapes,
    candidates,
    impacts,
    count,
    dt,
    response,
    # write
    manifolds_out,
):
    """Write a manifold for every impact that is the first of a body on its way, or of a sensor. Returns their number.

    impacts (n, 5): candidate, fraction, normal, stops. The point is the edge, along the normal, of the smaller of the
    two boxes. With response 1 the separation is that at the final poses: what a side went on by after the impact.
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
        s = a if small_a else b
        side = 1.0 if small_a else -1.0
        x = 0.5 * (s.min_x + s.max_x) + side * nx * 0.5 * (s.max_x - s.min_x)
        y = 0.5 * (s.min_y + s.max_y) + side * ny * 0.5 * (s.max_y - s.min_y)
        separation = 0.0
        if response == 1:
            after_x = (q.x - q.previous_x) - (p.x - p.previous_x) - impacts[i, 1] * dt * (q.vx - p.vx)
            after_y = (q.y - q.previous_y) - (p.y - p.previous_y) - impacts[i, 1] * dt * (q.vy - p.vy)
            # What it slid on after a graze is no overlap.
            separation = min(0.0, nx * after_x + ny * after_y) if impacts[i, 4] == 1.0 else 0.0
        if found < len(manifolds_out):
            m = manifolds_out[found]
            open_manifold(shapes, candidates, pair, nx + 0.0, ny + 0.0, m)
            m.count = 1
            m.x_1 = x
            m.y_1 = y
            m.separation_1 = separation
            m.area_1 = 0.0
            m.feature_1 = -1
            m.swept = True
        found += 1
    return found
