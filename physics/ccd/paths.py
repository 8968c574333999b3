"""The paths of the bodies through a step, and who of them is fast: jumps over what it should meet.

Source: Catto, Box2D v3, solver.c (half the smallest extent).
"""

import math

from physics.jit import kernel, subkernel
from physics.math2d import length_of, turned
from physics.tables.body import AUTO, DYNAMIC, KINEMATIC, OFF, RAY, STATIC, SWEPT


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


@subkernel
def way_of(bodies, paths, row):
    """How far [px] any point of a body moves at most."""
    moved = length_of(paths[row, 3] - paths[row, 0], paths[row, 4] - paths[row, 1])
    return moved + bodies[row].extent * min(abs(paths[row, 5] - paths[row, 2]), 2.0)


@kernel
def find_fast(
    # read
    rows,
    bodies,
    paths,
    # write
    fast_out,
):
    """Flag the bodies that a sweep is asked for. Returns (how many there are to look at, the number of those that are
    swept without turning, moving or not). O(rows).

    "toi", "ray" and "swept" always, while they move; "auto" when a point may move by more than half the body's size.
    To be looked at as well, without a flag, is who may be jumped over by something kinematic: see outruns. fast_out
    (bodies) bool.
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
        if moved > 0.0 and (b.continuous != AUTO or moved > b.thin_half):
            fast_out[i] = True
            found += 1
        elif b.kind == DYNAMIC and carried > 0.0 and moved + carried > b.thin_half:
            found += 1
    return found, straight


@subkernel
def outruns(bodies, paths, row, other):
    """Whether a kinematic body (other) and a dynamic one move against each other by more than half its size."""
    b = bodies[row]
    if b.kind != DYNAMIC or bodies[other].kind != KINEMATIC or b.continuous == OFF or b.quarantined:
        return False
    dx = (paths[row, 3] - paths[row, 0]) - (paths[other, 3] - paths[other, 0])
    dy = (paths[row, 4] - paths[row, 1]) - (paths[other, 4] - paths[other, 1])
    far = length_of(paths[row, 0] - paths[other, 0], paths[row, 1] - paths[other, 1]) + b.extent
    turned = far * min(abs(paths[other, 5] - paths[other, 2]), 2.0)
    turned += b.extent * min(abs(paths[row, 5] - paths[row, 2]), 2.0)
    return length_of(dx, dy) + turned > b.thin_half


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
