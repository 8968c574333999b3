"""First time of impact of shapes that move without turning: circles and convex polygons, against each other.

Polygons: their Minkowski difference is convex, and its faces have the normals of both outlines, so the relative motion
enters it through the face that it crosses last (Cyrus and Beck 1978). Circles: quadratic per corner, linear per edge
(Ericson, Real-Time Collision Detection, 5.5). All in closed form, relative to B. What stands deeper in the other than
the slop before it moves is left to the sweep of rotational.py.
"""

import math

from physics.ccd.closed_form import MISS, sweep_circle_polygon, sweep_circles, sweep_polygons
from physics.collision.circles import collide_polygon_circle
from physics.collision.clipping import ALL_EDGES
from physics.jit import kernel, subkernel
from physics.math2d import length_of, turned
from physics.shapes.placement import corners_at, is_hull
from physics.tables.body import AUTO, DYNAMIC, OFF, RAY, STATIC, TOI
from physics.tables.counters import TOI_CALLS
from physics.tables.shape import BOUNDS, CIRCLE, POLYGON, TILES


@subkernel
def sweep_shape(geometry, shapes, row, x, y, angle, ray, dx, dy, target, target_count, slack, corners_inout):
    """A moving circle or polygon (or a ray from its middle) against an outline: (fraction or MISS, normal to it)."""
    s = shapes[row]
    if s.kind == CIRCLE:
        u, v = turned(s.local_x, s.local_y, math.cos(angle), math.sin(angle))
        radius = 0.0 if ray else s.radius
        fraction, nx, ny = sweep_circle_polygon(target, target_count, ALL_EDGES, x + u, y + v, dx, dy, radius)
        if fraction == 0.0 and s.radius > 0.0:
            hit, mx, my, _, _, separation, _ = collide_polygon_circle(
                target, target_count, ALL_EDGES, x + u, y + v, radius
            )
            if hit and separation < -slack:
                return MISS, nx, ny
        return fraction, nx, ny
    count = corners_at(geometry, shapes, row, x, y, angle, corners_inout)
    if ray:
        middle_x = 0.0
        middle_y = 0.0
        for k in range(count):
            middle_x += corners_inout[k, 0] / count
            middle_y += corners_inout[k, 1] / count
        return sweep_circle_polygon(target, target_count, ALL_EDGES, middle_x, middle_y, dx, dy, 0.0)
    return sweep_polygons(corners_inout, count, target, target_count, ALL_EDGES, dx, dy, slack)


@subkernel
def is_fast(body, dt, only_straight):
    """Whether a body's continuous mode asks for a sweep in this step; "auto" when it moves by more than half its size.

    only_straight: 1 where those that turn on their way are left to the sweep with turning.
    """
    if body.continuous == OFF or body.continuous == TOI or body.kind == STATIC or body.quarantined:
        return False
    if body.continuous == AUTO and only_straight == 1:
        return False
    if body.continuous == AUTO:
        return length_of(body.vx, body.vy) * dt > body.thin_half
    return True


@subkernel
def sweep_pair(geometry, bodies, shapes, row, other, ray, dt, slack, scratch):
    """Shape `row` against shape `other`, both moving through dt [s]: (fraction or MISS, normal from other to row)."""
    s = shapes[row]
    o = shapes[other]
    p = bodies[s.body_row]
    q = bodies[o.body_row]
    dx = dt * p.vx
    dy = dt * p.vy
    if q.kind != STATIC:
        dx -= dt * q.vx
        dy -= dt * q.vy
    if o.kind == CIRCLE:
        u, v = turned(o.local_x, o.local_y, math.cos(q.angle), math.sin(q.angle))
        if s.kind == CIRCLE:
            w, z = turned(s.local_x, s.local_y, math.cos(p.angle), math.sin(p.angle))
            radius = o.radius + (0.0 if ray else s.radius)
            x = p.x + w - q.x - u
            y = p.y + z - q.y - v
            fraction, nx, ny = sweep_circles(x, y, dx, dy, radius)
            if fraction == 0.0 and length_of(x, y) < radius - slack:
                return MISS, nx, ny
            return fraction, nx, ny
        count = corners_at(geometry, shapes, row, p.x, p.y, p.angle, scratch.a)
        if ray:
            x = 0.0
            y = 0.0
            for k in range(count):
                x += scratch.a[k, 0] / count
                y += scratch.a[k, 1] / count
            return sweep_circles(x - q.x - u, y - q.y - v, dx, dy, o.radius)
        # The circle flies the other way, against the polygon at rest.
        x = q.x + u
        y = q.y + v
        fraction, nx, ny = sweep_circle_polygon(scratch.a, count, ALL_EDGES, x, y, -dx, -dy, o.radius)
        if fraction == 0.0:
            hit, mx, my, _, _, separation, _ = collide_polygon_circle(scratch.a, count, ALL_EDGES, x, y, o.radius)
            if hit and separation < -slack:
                return MISS, -nx, -ny
        return fraction, -nx, -ny
    count = corners_at(geometry, shapes, other, q.x, q.y, q.angle, scratch.a)
    return sweep_shape(geometry, shapes, row, p.x, p.y, p.angle, ray, dx, dy, scratch.a, count, slack, scratch.b)


@subkernel
def is_straight(shape):
    """Whether the closed forms here know a shape; what is rounded, and ground, is left to the sweep with turning."""
    return shape.kind == CIRCLE or shape.kind == BOUNDS or (shape.kind == POLYGON and shape.radius == 0.0)


@subkernel
def has_closed_form(mover, other, mode):
    """Whether a fast shape is swept here: by its own outline, or as a ray from the middle of any hull."""
    if mode == RAY:
        return is_straight(other) and is_hull(mover.kind)
    return is_straight(other) and is_straight(mover)


@subkernel
def write_impact(pair, fraction, nx, ny, feature, from_a, stops, found, impacts_out):
    """Write an impact of a candidate pair when there is room. Returns the count, which goes on past the capacity.

    nx, ny: from what was met to the mover, which is A of the pair where from_a says so; feature: which tiles or link.
    """
    if found < impacts_out.shape[0]:
        impacts_out[found, 0] = float(pair)
        impacts_out[found, 1] = fraction
        impacts_out[found, 2] = -nx if from_a else nx
        impacts_out[found, 3] = -ny if from_a else ny
        impacts_out[found, 4] = 1.0 if stops else 0.0
        impacts_out[found, 5] = float(feature)
    return found + 1


@kernel
def find_impacts(
    # read
    geometry,
    bodies,
    shapes,
    candidates,
    count,
    dt,
    slack,
    only_straight,
    # write
    scratch,
    impacts_out,
    work_inout,
):
    """List (candidate, fraction, normal from A to B, stops, -1) of the pairs that a fast body meets within dt [s].

    Motion into the other by less than a quarter of the smaller half extent does not stop the body: the contact at
    the end of the step pushes it out, and nothing that slides along the ground is held by it. slack [px];
    only_straight: see is_fast; impacts_out (n, 8) float64, of which no
    point is written. Returns the number found. O(candidates).
    """
    found = 0
    for i in range(count):
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        p = bodies[a.body_row]
        q = bodies[b.body_row]
        a_fast = is_fast(p, dt, only_straight)
        b_fast = is_fast(q, dt, only_straight)
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
        work_inout[TOI_CALLS] += 1
        fraction, nx, ny = sweep_pair(
            geometry, bodies, shapes, mover, other, body.continuous == RAY, dt, slack, scratch
        )
        if fraction > 1.0:
            continue
        dx = body.vx
        dy = body.vy
        rest = q if from_a else p
        if rest.kind != STATIC:
            dx -= rest.vx
            dy -= rest.vy
        stops = -(nx * dx + ny * dy) * dt > 0.25 * body.smallest_half
        found = write_impact(i, fraction, nx, ny, -1, from_a, stops, found, impacts_out)
    return found


@kernel
def stop_at_impacts(
    # read
    shapes,
    candidates,
    impacts,
    count,
    # write
    bodies_inout,
):
    """Set each body's free fraction to its first impact with what is no sensor. bodies_inout BODY rows. O(impacts)."""
    for i in range(count):
        pair = int(impacts[i, 0])
        a = shapes[candidates[pair, 0]]
        b = shapes[candidates[pair, 1]]
        if a.sensor or b.sensor or impacts[i, 4] == 0.0:
            continue
        p = bodies_inout[a.body_row]
        q = bodies_inout[b.body_row]
        # What is moved by its script goes on; what is met by it is pushed.
        if p.kind == DYNAMIC:
            p.fraction = min(p.fraction, impacts[i, 1])
        if q.kind == DYNAMIC:
            q.fraction = min(q.fraction, impacts[i, 1])
