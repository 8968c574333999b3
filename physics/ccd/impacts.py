"""First impact of each fast body on its path in a step, and the pose at which the impact stops the body.

An impact of a sweep is a fraction of the motion (0 to 1), or the constant MISS, and a unit normal. Functions return an
impact as (fraction, nx, ny).
"""

import math

from physics.ccd.rotational import is_held, stands_deep, sweep_rotational
from physics.ccd.time_of_impact import MISS, sweep_circle_polygon, sweep_circles, sweep_polygons
from physics.collision.hulls import ALL_EDGES, Hull, collide_polygon_circle, middle_of
from physics.collision.manifold import open_manifold
from physics.jit import kernel, subkernel
from physics.math2d import norm, rotate, unit
from physics.shapes.placement import corners_at, is_hull
from physics.tables.body import AUTO, DYNAMIC, KINEMATIC, OFF, RAY, STATIC, SWEPT, TOI
from physics.tables.shape import BOUNDS, CHAIN, CIRCLE, MASK, POLYGON, TILES
from physics.tables.step_state import TOI_CALLS


@subkernel
def is_fast(bodies, paths, row, other):
    """Return whether a dynamic and a kinematic body move so far relative to each other that they may miss a contact.

    The result is True if a point of the dynamic body may move, relative to the kinematic body, by more than the dynamic
    body's inradius. row, other: row numbers in BODY of the dynamic and the kinematic body; paths: see Sweep.
    """
    b = bodies[row]
    if b.kind != DYNAMIC or bodies[other].kind != KINEMATIC or b.continuous == OFF or b.quarantined:
        return False
    dx = (paths[row, 3] - paths[row, 0]) - (paths[other, 3] - paths[other, 0])
    dy = (paths[row, 4] - paths[row, 1]) - (paths[other, 4] - paths[other, 1])
    far = norm(paths[row, 0] - paths[other, 0], paths[row, 1] - paths[other, 1]) + b.extent
    rotate = far * min(abs(paths[other, 5] - paths[other, 2]), 2.0)
    rotate += b.extent * min(abs(paths[row, 5] - paths[row, 2]), 2.0)
    return norm(dx, dy) + rotate > b.inradius


@subkernel
def cut_path(paths, row, start, end, cut_out):
    """Write to cut_out[row] the part of a body's path between the fractions `start` and `end` of the step.

    row: row number of the body; paths, cut_out: see Sweep.
    """
    for k in range(3):
        whole = paths[row, 3 + k] - paths[row, k]
        cut_out[row, k] = paths[row, k] + start * whole
        cut_out[row, 3 + k] = paths[row, 3 + k] if end == 1.0 else paths[row, k] + end * whole


@subkernel
def rest_where_it_is(bodies, row, paths_inout, fast_inout):
    """Write a path without motion for a body that is not active, and clear its fast flag.

    row: row number in BODY; paths_inout: see Sweep.paths; fast_inout: see Sweep.fast.
    """
    b = bodies[row]
    if b.active:
        return
    fast_inout[row] = False
    for k in range(0, 6, 3):
        paths_inout[row, k] = b.center_x
        paths_inout[row, k + 1] = b.center_y
        paths_inout[row, k + 2] = b.angle
    paths_inout[row, 6] = 0.0


# ---- straight --------------------------------------------------------------------------------------------------------
# First impacts of bodies that move without rotation: circles, convex polygons and rays, in closed form, relative to the
# other shape. Pairs that overlap by more than the slop at the start are left to the sweep of rotational.py.


@subkernel
def is_straight(shape):
    """Return whether a SHAPE row can be swept in closed form: a circle, a box or a polygon without rounding."""
    return shape.kind == CIRCLE or shape.kind == BOUNDS or (shape.kind == POLYGON and shape.radius == 0.0)


@subkernel
def has_closed_form(mover, other, mode):
    """Return whether the sweep of a fast shape against another shape has a closed form.

    mover, other: SHAPE rows; mode: continuous mode of the mover's body. In mode RAY only the centre of the mover is
    swept, so the mover may be any hull.
    """
    if mode == RAY:
        return is_straight(other) and is_hull(mover.kind)
    return is_straight(other) and is_straight(mover)


@subkernel
def sweep_disc(x, y, radius, move, outline, slack):
    """Return the first impact (fraction of the move, nx, ny) of a moving disc with a Hull at rest.

    x, y, radius [px]: centre and radius of the disc; move: (dx, dy) [px]; outline: the Hull. The normal points from the
    Hull to the disc. The fraction is MISS without an impact, and if the overlap at the start is deeper than slack [px].
    """
    corners, count, _, edges = outline
    fraction, nx, ny = sweep_circle_polygon(corners, count, edges, x, y, move[0], move[1], radius)
    if fraction == 0.0:
        hit, _, _, _, _, separation, _ = collide_polygon_circle(corners, count, edges, x, y, radius)
        if hit and separation < -slack:
            return MISS, nx, ny
    return fraction, nx, ny


@subkernel
def sweep_pair(row, other, dt, sweep, scratch):
    """Return the first impact (fraction of dt, nx, ny) of two shapes within dt [s].

    The fraction is MISS without an impact. The normal points from `other` to `row`. row, other: row numbers in SHAPE;
    both bodies move at their velocities without rotation. scratch: a Workspace; sweep: see Sweep.
    """
    geometry, bodies, shapes, slack = sweep.geometry, sweep.bodies, sweep.shapes, sweep.slack
    s, o = shapes[row], shapes[other]
    p, q = bodies[s.body_row], bodies[o.body_row]
    ray = p.continuous == RAY
    dx, dy = dt * p.vx, dt * p.vy
    if q.kind != STATIC:
        dx -= dt * q.vx
        dy -= dt * q.vy
    # A disc is given by its centre and radius, a ray by the middle of the mover, a polygon by its corners.
    radius = 0.0
    count = 0
    if s.kind == CIRCLE:
        u, v = rotate(s.local_x, s.local_y, math.cos(p.angle), math.sin(p.angle))
        x, y = p.x + u, p.y + v
        if not ray:
            radius = s.radius
    else:
        count = corners_at(geometry, shapes, row, p.x, p.y, p.angle, scratch.b)
        x, y = middle_of(scratch.b, count)
    if o.kind == CIRCLE:
        u, v = rotate(o.local_x, o.local_y, math.cos(q.angle), math.sin(q.angle))
        if s.kind == CIRCLE or ray:
            x, y = x - q.x - u, y - q.y - v
            radius += o.radius
            fraction, nx, ny = sweep_circles(x, y, dx, dy, radius)
            is_deep = s.kind == CIRCLE and fraction == 0.0 and norm(x, y) < radius - slack
            return MISS if is_deep else fraction, nx, ny
        # The circle moves in the opposite direction, against the polygon at rest.
        outline = Hull(scratch.b, count, 0.0, ALL_EDGES)
        fraction, nx, ny = sweep_disc(q.x + u, q.y + v, o.radius, (-dx, -dy), outline, slack)
        return fraction, -nx, -ny
    outline = Hull(scratch.a, corners_at(geometry, shapes, other, q.x, q.y, q.angle, scratch.a), 0.0, ALL_EDGES)
    if s.kind == CIRCLE:
        return sweep_disc(x, y, radius, (dx, dy), outline, slack)
    if ray:
        return sweep_circle_polygon(scratch.a, outline.count, ALL_EDGES, x, y, dx, dy, 0.0)
    return sweep_polygons(scratch.b, count, scratch.a, outline.count, (dx, dy), slack)


@subkernel
def asks_sweep(body, dt, only_straight):
    """Return whether a body needs a sweep without rotation in this step of dt [s].

    A body in mode "ray" or "swept" always needs the sweep. A body in mode "auto" needs it if only_straight is False and
    the body moves by more than its inradius. body: BODY row.
    """
    if body.continuous == OFF or body.continuous == TOI or body.kind == STATIC or body.quarantined:
        return False
    if body.continuous == AUTO:
        return not only_straight and norm(body.vx, body.vy) * dt > body.inradius
    return True


@subkernel
def is_turned(body, paths, row):
    """Return whether a body in mode "swept" is swept with its rotation in this step, see turn_held.

    body: BODY row; row: its row number; paths: see Sweep.
    """
    return body.continuous == SWEPT and body.kind == DYNAMIC and paths[row, 5] != paths[row, 2]


@subkernel
def write_impact(pair, impact, from_a, stops, found, impacts_out):
    """Append an impact to impacts_out unless the array is full. Return the new number of impacts.

    An impact that does not fit is counted too. pair: index of the candidate pair; impact: (fraction of the step, nx and
    ny from the obstacle to the mover, feature id of the tile or link, or -1); from_a: whether the mover is A; stops:
    whether the impact stops the mover; found: number of impacts before the call.
    """
    if found < impacts_out.shape[0]:
        fraction, nx, ny, feature = impact
        impacts_out[found, 0] = float(pair)
        impacts_out[found, 1] = fraction
        impacts_out[found, 2] = -nx if from_a else nx
        impacts_out[found, 3] = -ny if from_a else ny
        impacts_out[found, 4] = 1.0 if stops else 0.0
        impacts_out[found, 5] = float(feature)
    return found + 1


@kernel
def find_impacts(dt, only_straight, sweep_inout, scratch, impacts_out):
    """Find the impacts of fast bodies within dt [s] by sweeps in closed form. Return their number. O(candidates).

    A body is not stopped if its motion into the obstacle within dt is at most a quarter of its smallest half extent.
    The contact solver then resolves the overlap. So a body that slides on the ground is not stopped.

    impacts_out (n, 8) float64, columns: index of the candidate pair, fraction of the step, nx and ny from A to B, 1.0
    if the body stops, -1. The last two columns are not written. only_straight: True to leave out bodies in mode "auto",
    which are swept with rotation. scratch: a Workspace. sweep_inout: see Sweep.
    """
    bodies, shapes, candidates = sweep_inout.bodies, sweep_inout.shapes, sweep_inout.candidates
    found = 0
    for i in range(len(candidates)):
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        p, q = bodies[a.body_row], bodies[b.body_row]
        a_fast = asks_sweep(p, dt, only_straight) and not is_turned(p, sweep_inout.paths, a.body_row)
        b_fast = asks_sweep(q, dt, only_straight) and not is_turned(q, sweep_inout.paths, b.body_row)
        if not (a_fast or b_fast):
            continue
        from_a = a_fast and a.kind != TILES
        if from_a and b_fast and b.kind != TILES and p.continuous == RAY and q.continuous != RAY:
            from_a = False
        mover = candidates[i, 0] if from_a else candidates[i, 1]
        other = candidates[i, 1] if from_a else candidates[i, 0]
        body = p if from_a else q
        if shapes[mover].kind == TILES or not has_closed_form(shapes[mover], shapes[other], body.continuous):
            continue
        sweep_inout.work[TOI_CALLS] += 1
        fraction, nx, ny = sweep_pair(mover, other, dt, sweep_inout, scratch)
        if fraction > 1.0:
            continue
        dx, dy = body.vx, body.vy
        rest = q if from_a else p
        if rest.kind != STATIC:
            dx -= rest.vx
            dy -= rest.vy
        stops = -(nx * dx + ny * dy) * dt > 0.25 * body.min_half_extent
        found = write_impact(i, (fraction, nx, ny, -1), from_a, stops, found, impacts_out)
    return found


@kernel
def stop_at_impacts(shapes, candidates, impacts, bodies_inout):
    """Lower BODY.fraction of each dynamic body to the fraction of its first impact that stops it. O(impacts).

    Impacts with sensors are ignored. impacts (n, 8): see find_impacts; candidates (n, 2): row numbers in SHAPE.
    """
    for i in range(len(impacts)):
        pair = int(impacts[i, 0])
        a = shapes[candidates[pair, 0]]
        b = shapes[candidates[pair, 1]]
        if a.sensor or b.sensor or impacts[i, 4] == 0.0:
            continue
        p, q = bodies_inout[a.body_row], bodies_inout[b.body_row]
        # A kinematic body moves on and pushes the body that it meets.
        if p.kind == DYNAMIC:
            p.fraction = min(p.fraction, impacts[i, 1])
        if q.kind == DYNAMIC:
            q.fraction = min(q.fraction, impacts[i, 1])


# ---- impacts ---------------------------------------------------------------------------------------------------------
# The sweep over one step of bodies that also rotate: the first impact of each fast body, and the pose at which it
# stops.
#
# Two bullets that meet stop each other. A body that stops earlier than expected may block another body, so pairs of
# moving bodies are swept again until no body stops earlier. Sources: Catto, Box2D v3, solver.c (fast bodies, core
# circle); Mirtich, Timewarp Rigid Body Simulation, 2000 (conservative rounds).


@subkernel
def first_meeting(mover, other, slack, sweep_inout):
    """Return the first impact (fraction of the step, nx, ny, feature) of two shapes; the fraction is MISS for none.

    mover, other: row numbers in SHAPE; the normal points from `other` to `mover`; feature: id of the tile or link, or
    -1. Each body moves along its path up to its BODY.fraction of the step, and then rests. slack [px]: see Mover;
    sweep_inout: see Sweep.
    """
    bodies, paths, cuts = sweep_inout.bodies, sweep_inout.paths, sweep_inout.cuts
    p, q = sweep_inout.shapes[mover].body_row, sweep_inout.shapes[other].body_row
    far_p, far_q = bodies[p].fraction, bodies[q].fraction
    both = min(far_p, far_q)
    if both > 0.0:
        cut_path(paths, p, 0.0, both, cuts)
        cut_path(paths, q, 0.0, both, cuts)
        fraction, nx, ny, feature = sweep_rotational(mover, other, slack, -1, sweep_inout)
        if fraction <= 1.0:
            return fraction * both, nx, ny, feature
    last = max(far_p, far_q)
    if last == both:
        return MISS, 0.0, -1.0, -1
    cut_path(paths, p, min(both, far_p), far_p, cuts)
    cut_path(paths, q, min(both, far_q), far_q, cuts)
    fraction, nx, ny, feature = sweep_rotational(mover, other, slack, -1, sweep_inout)
    if fraction <= 1.0:
        return both + fraction * (last - both), nx, ny, feature
    return MISS, 0.0, -1.0, -1


@subkernel
def stands_still(bodies, paths, row):
    """Return whether a body is not dynamic and does not move in this step. row: BODY row number; paths: see Sweep."""
    return bodies[row].kind != DYNAMIC and (
        paths[row, 0] == paths[row, 3] and paths[row, 1] == paths[row, 4] and paths[row, 2] == paths[row, 5]
    )


@subkernel
def goes_on(bodies, paths, mover, other, fraction, nx, ny):
    """Return how far [px] two bodies would still move into each other after an impact at a fraction of the step.

    The result is the greater of two distances: their relative motion after the impact against the normal (nx, ny), and
    the motion of their outermost points by rotation in the whole step. The normal points from `other` to `mover`.
    mover, other: row numbers in BODY; paths: see Sweep.
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


@subkernel
def is_swept(moving, a, b, sweep_inout):
    """Return whether a pair of shapes is to be swept, because one body is fast relative to the other.

    a, b: SHAPE rows. moving: 0 selects pairs with a static or kinematic body that does not move in this step; 1 selects
    all other pairs. With a stacking solver, two dynamic bodies are swept only if at least one is a bullet. sweep_inout:
    see Sweep.
    """
    bodies, paths, fast = sweep_inout.bodies, sweep_inout.paths, sweep_inout.fast
    rest_where_it_is(bodies, a.body_row, paths, fast)
    rest_where_it_is(bodies, b.body_row, paths, fast)
    is_one_fast = fast[a.body_row] or fast[b.body_row] or is_fast(bodies, paths, a.body_row, b.body_row)
    if not (is_one_fast or is_fast(bodies, paths, b.body_row, a.body_row)):
        return False
    still = stands_still(bodies, paths, a.body_row) or stands_still(bodies, paths, b.body_row)
    if still == (moving == 1):
        return False
    p, q = bodies[a.body_row], bodies[b.body_row]
    return not (sweep_inout.stacking and p.kind == DYNAMIC and q.kind == DYNAMIC and not (p.bullet or q.bullet))


@subkernel
def is_first_mover(a, b, bodies, fast):
    """Return whether the sweep of two SHAPE rows a, b treats a as the moving shape, and b as the obstacle.

    If only one of the two bodies is dynamic, it is the mover, because it can be stopped. Otherwise the body of a is the
    mover if it is fast. fast: see Sweep.fast.
    """
    is_dynamic = bodies[a.body_row].kind == DYNAMIC
    return fast[a.body_row] if is_dynamic == (bodies[b.body_row].kind == DYNAMIC) else is_dynamic


@subkernel
def mover_of(row_a, row_b, sweep_inout):
    """Return two SHAPE row numbers as (moving shape, obstacle) of a sweep; the first is -1 if the pair is not swept.

    A shape that is not a hull cannot be the moving shape. Masks are swept by their pixels, see mask_sweep.py.
    """
    a, b = sweep_inout.shapes[row_a], sweep_inout.shapes[row_b]
    is_ground = a.kind == TILES or a.kind == CHAIN or a.kind == MASK
    from_a = not is_ground and is_first_mover(a, b, sweep_inout.bodies, sweep_inout.fast)
    kind = a.kind if from_a else b.kind
    other_kind = b.kind if from_a else a.kind
    if kind == TILES or kind == CHAIN or kind == MASK or other_kind == MASK:
        return -1, -1
    return (row_a, row_b) if from_a else (row_b, row_a)


@kernel
def turn_held(near, sweep_inout):
    """Add to the paths of bodies in mode "swept" the rotation that was left out, if they are in contact. O(candidates).

    Without its rotation, a body that turns about the point at which it touches moves into the obstacle, and would be
    held in each step. A body is in contact if its motion without rotation has an impact after at most `near` [px].
    sweep_inout: see Sweep.
    """
    shapes, candidates, paths, cuts = sweep_inout.shapes, sweep_inout.candidates, sweep_inout.paths, sweep_inout.cuts
    motion_a, motion_b = sweep_inout.workspace.advance.motion_a, sweep_inout.workspace.advance.motion_b
    for i in range(len(candidates)):
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        if a.sensor or b.sensor or (paths[a.body_row, 6] == 0.0 and paths[b.body_row, 6] == 0.0):
            continue
        if not (is_swept(0, a, b, sweep_inout) or is_swept(1, a, b, sweep_inout)):
            continue
        mover, other = mover_of(candidates[i, 0], candidates[i, 1], sweep_inout)
        if mover < 0:
            continue
        for side in range(2):
            row = shapes[mover if side == 0 else other].body_row
            cut_path(paths, row, 0.0, 1.0, cuts)
            if paths[row, 6] != 0.0:
                cuts[row, 5] = cuts[row, 2]
        fraction, _, _, _ = sweep_rotational(mover, other, sweep_inout.slack, -1, sweep_inout)
        if fraction > 1.0 or not is_held(motion_a, motion_b, fraction, 0.0, near):
            continue
        for side in range(2):
            row = shapes[mover if side == 0 else other].body_row
            paths[row, 5] = paths[row, 5] if paths[row, 6] == 0.0 else paths[row, 2] + paths[row, 6]


@kernel
def find_rotational_impacts(moving, rotation, sweep_inout, impacts_out):
    """Find the impacts of fast bodies along their paths, with rotation. Return their number. O(candidates).

    Without a stacking solver, a body is not stopped if its motion into the obstacle is at most a quarter of its
    smallest half extent. The contact then resolves the overlap in the same step.

    impacts_out (n, 8), columns: index of the candidate pair, fraction of the step, nx and ny from A to B, 1.0 if the
    body stops, feature. moving: see is_swept. rotation: whether bodies rotate; if False, pairs with a closed form are
    left to find_impacts. sweep_inout: see Sweep.
    """
    bodies, shapes, candidates = sweep_inout.bodies, sweep_inout.shapes, sweep_inout.candidates
    stacking, slack = sweep_inout.stacking, sweep_inout.slack
    found = 0
    for i in range(len(candidates)):
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        if not is_swept(moving, a, b, sweep_inout):
            continue
        mover, other = mover_of(candidates[i, 0], candidates[i, 1], sweep_inout)
        if mover < 0:
            continue
        from_a = mover == candidates[i, 0]
        m = shapes[mover].body_row
        o = shapes[other].body_row
        mode = bodies[m].continuous
        straight = mode == RAY or mode == SWEPT or (mode == AUTO and not (stacking or rotation))
        straight = straight and not is_turned(bodies[m], sweep_inout.paths, m)
        if straight and has_closed_form(shapes[mover], shapes[other], mode):
            # The closed form leaves pairs that overlap by more than the slack to this sweep.
            if not stands_deep(mover, other, sweep_inout):
                continue
        sweep_inout.work[TOI_CALLS] += 1
        fraction, nx, ny, feature = first_meeting(mover, other, slack, sweep_inout)
        if fraction > 1.0:
            continue
        room_left = 0.25 * bodies[m].min_half_extent
        stops = stacking or goes_on(bodies, sweep_inout.paths, m, o, fraction, nx, ny) > room_left
        if not stops and (shapes[other].kind == TILES or shapes[other].kind == CHAIN):
            # Another part of the same ground may stop the body, as when a ball that rolls down a wall meets the floor.
            later, u, v, part = first_meeting(mover, other, slack + room_left, sweep_inout)
            if later <= 1.0:
                fraction, nx, ny, feature, stops = later, u, v, part, True
        found = write_impact(i, (fraction, nx, ny, feature), from_a, stops, found, impacts_out)
    return found


FREELY = 1e-3  # greatest deviation of a path from free fall, as a share of the distance that gravity adds in a step


@subkernel
def lose_fall(lost, path_x, path_y, gravity_x, gravity_y, dt, body_inout):
    """Correct the velocity of a body that is stopped within a step, so that the body gains no energy from gravity.

    The velocity includes the gravity of the whole step, but the body does not move along the last part of its path. A
    body in free fall gets the velocity of the time at which it stopped. Any other body loses as much kinetic energy as
    it would have gained by falling along that last part. lost: last part as a share of the path; path_x, path_y [px]:
    the whole path; gravity_x, gravity_y [px/s2]; dt [s]. body_inout: BODY row.
    """
    b = body_inout
    pull = norm(gravity_x, gravity_y) * abs(b.gravity_scale)
    nx, ny = unit(b.gravity_scale * gravity_x, b.gravity_scale * gravity_y, 0.0, 0.0)
    fall = path_x * nx + path_y * ny
    along = b.vx * nx + b.vy * ny
    if abs((along - 0.5 * pull * dt) * dt - fall) <= FREELY * pull * dt * dt:
        b.vx -= lost * pull * dt * nx
        b.vy -= lost * pull * dt * ny
    elif fall > 0.0:
        square = b.vx * b.vx + b.vy * b.vy
        left = square - 2.0 * pull * lost * fall
        scale = math.sqrt(left / square) if left > 0.0 and square > 0.0 else 0.0
        b.vx *= scale
        b.vy *= scale


@kernel
def move_back(rows, paths, gravity_x, gravity_y, dt, slack, bodies_inout):
    """Move the stopped dynamic bodies back to the pose of their first impact. O(rows).

    The rest of their motion in this step is lost. A body in mode "ray" whose centre is held at a surface, so that it
    moves by at most `slack` [px], still rotates: only its centre is swept, and as it rotates, its contacts push it out.
    rows: row numbers in BODY; paths: see Sweep; gravity_x, gravity_y [px/s2] and dt [s], the length of the step: see
    lose_fall.
    """
    for k in range(len(rows)):
        i = rows[k]
        b = bodies_inout[i]
        if b.fraction >= 1.0 or b.kind != DYNAMIC:
            continue
        f = b.fraction
        path_x = paths[i, 3] - paths[i, 0]
        path_y = paths[i, 4] - paths[i, 1]
        lose_fall(1.0 - f, path_x, path_y, gravity_x, gravity_y, dt, b)
        b.center_x = paths[i, 0] + f * path_x
        b.center_y = paths[i, 1] + f * path_y
        turn = b.angle - b.previous_angle
        if b.continuous != RAY or f * norm(path_x, path_y) > slack:
            turn *= f
        if turn == 0.0:
            b.x = b.previous_x + (b.center_x - paths[i, 0])
            b.y = b.previous_y + (b.center_y - paths[i, 1])
            b.angle = b.previous_angle
        else:
            b.angle = b.previous_angle + turn
            u, v = rotate(b.local_center_x, b.local_center_y, math.cos(b.angle), math.sin(b.angle))
            b.x, b.y = b.center_x - u, b.center_y - v


@kernel
def stop_held(shapes, candidates, impacts, paths, slack, bodies_inout):
    """Remove the approach speed of dynamic bodies that an obstacle holds where they were before the step. O(impacts).

    Such a body was in contact before the step, and its contacts let it approach: its core circle, or its centre in mode
    "ray", is at a surface. A body that arrived at its impact in this step keeps its velocity, which its contact gets in
    the next step. impacts (n, 8): see find_impacts; candidates (n, 2): pairs of row numbers in SHAPE; paths: see Sweep;
    slack [px]: greatest motion of a held body until the impact. Obstacles are static and kinematic bodies.
    """
    for i in range(len(impacts)):
        pair = int(impacts[i, 0])
        a = shapes[candidates[pair, 0]]
        b = shapes[candidates[pair, 1]]
        from_a = bodies_inout[a.body_row].kind == DYNAMIC
        row, other = (a.body_row, b.body_row) if from_a else (b.body_row, a.body_row)
        body, rest = bodies_inout[row], bodies_inout[other]
        if a.sensor or b.sensor or impacts[i, 4] == 0.0 or body.kind != DYNAMIC or rest.kind == DYNAMIC:
            continue
        way = norm(paths[row, 3] - paths[row, 0], paths[row, 4] - paths[row, 1])
        way += body.extent * abs(paths[row, 5] - paths[row, 2] + paths[row, 6])
        if impacts[i, 1] > body.fraction or body.fraction * way > slack:
            continue
        # The normal points from A to B.
        nx, ny = (-impacts[i, 2], -impacts[i, 3]) if from_a else (impacts[i, 2], impacts[i, 3])
        vx, vy = body.vx, body.vy
        if rest.kind != STATIC:
            vx -= rest.vx - rest.angular_velocity * (body.center_y - rest.center_y)
            vy -= rest.vy + rest.angular_velocity * (body.center_x - rest.center_x)
        # The body is slowed down, never pushed: contacts do that, and a character has the velocity of what carries it.
        approach = min(-(vx * nx + vy * ny), -(body.vx * nx + body.vy * ny))
        if approach > 0.0:
            body.vx += approach * nx
            body.vy += approach * ny


@subkernel
def is_ray(body, other):
    """Return whether the sweep of a body against another body uses a ray from its centre instead of its outline.

    A ray is used for a body in mode "ray" that is not static, unless the other body is in mode "swept" or "toi". body,
    other: BODY rows.
    """
    return body.continuous == RAY and body.kind != STATIC and other.continuous != SWEPT and other.continuous != TOI


@subkernel
def impact_point(body, shape, side, nx, ny, fraction, flew_on):
    """Return an estimate (x, y) [px] of the point at which a shape hit another shape.

    It is the point of the shape's AABB farthest along side · (nx, ny), or the centre of the AABB for a ray. body,
    shape: BODY and SHAPE rows at the end of the step; fraction: fraction of the step at the impact. flew_on: True if
    the body moved on after the impact; the point is then moved back by the motion since the impact.
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
def write_impacts(bodies, shapes, candidates, impacts, dt, response, manifolds_out):
    """Write a CONTACT row for each impact that both bodies reached before they stopped. Return the number of rows.

    impacts (n, 8): candidate, fraction, normal from A to B, stops, feature, point x and y [px]. If the point is nan,
    impact_point estimates it: for the shape that is swept as a ray, otherwise for the shape with the smaller AABB.

    response: 1 in a world with contact response. Then the separation [px] of a row is that of the final poses, computed
    from the motion after the impact. 0: the separation is 0. candidates (n, 2): pairs of row numbers in SHAPE; dt [s]:
    step length; manifolds_out: CONTACT rows.
    """
    found = 0
    for i in range(len(impacts)):
        pair = int(impacts[i, 0])
        a = shapes[candidates[pair, 0]]
        b = shapes[candidates[pair, 1]]
        p, q = bodies[a.body_row], bodies[b.body_row]
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
            # The motion after a grazing contact does not count as overlap.
            separation = min(0.0, nx * after_x + ny * after_y) if impacts[i, 4] == 1.0 else 0.0
        if found < len(manifolds_out):
            m = manifolds_out[found]
            open_manifold(shapes, candidates, pair, nx + 0.0, ny + 0.0, m)
            m.count = 1
            m.x_1, m.y_1 = x, y
            m.separation_1 = separation
            m.area_1 = 0.0
            m.feature_1 = int(impacts[i, 5])
            m.swept = True
        found += 1
    return found
