"""A ray, a shape that moves without turning, or a point, against listed shapes that stand still."""

import math

from physics.ccd.advance import ANGLE, CENTER_X, CENTER_Y, MOVE_X, MOVE_Y, TOUCHING_BAND, TURN, advance, reach_of
from physics.ccd.closed_form import MISS
from physics.ccd.rotational import place_mover
from physics.ccd.rotational_ground import starts_across, sweep_chain, sweep_tiles
from physics.jit import kernel
from physics.proximity.gjk import BX, BY, NX, NY, ROUNDS
from physics.proximity.separation import separate
from physics.proximity.witness import copy_part
from physics.queries.ray_lines import cast_on_disc, cast_on_hull
from physics.queries.rays import cast_on_shape
from physics.shapes.placement import hull_at, is_hull, rounding
from physics.tables.counters import CAP_HITS, GJK_ITERATIONS, NARROW_TESTS, TOI_CALLS
from physics.tables.shape import CHAIN, PART, TILES


@kernel
def cast_ray_at_rows(
    # read
    geometry,
    bodies,
    shapes,
    rows,
    x,
    y,
    dx,
    dy,
    # write
    corners_inout,
    hits_out,
    work_inout,
):
    """Write (row, fraction, normal) of every listed shape that a ray from (x, y) by (dx, dy) [px] meets.

    Returns their number. rows: SHAPE rows; corners_inout (16, 2): scratch; hits_out (rows, 4).
    """
    found = 0
    for k in range(len(rows)):
        work_inout[NARROW_TESTS] += 1
        fraction, nx, ny = cast_on_shape(geometry, bodies, shapes, rows[k], x, y, dx, dy, corners_inout)
        if fraction <= 1.0:
            hits_out[found, 0] = float(rows[k])
            hits_out[found, 1] = fraction
            hits_out[found, 2] = nx
            hits_out[found, 3] = ny
            found += 1
    return found


@kernel
def cast_ray_at_parts(
    # read
    parts,
    dx,
    dy,
    # write
    corners_inout,
    hit_out,
    work_inout,
):
    """Write (fraction, normal) to hit_out[1:], where a ray from the origin by (dx, dy) [px] first meets a part.

    parts: Parts; corners_inout (16, 2): scratch; hit_out (4,). Returns whether it meets any. O(parts).
    """
    hit_out[1] = MISS
    for k in range(len(parts.counts)):
        count = parts.counts[k]
        copy_part(parts.corners, k, count, corners_inout)
        work_inout[NARROW_TESTS] += 1
        if count == 1:
            fraction, nx, ny = cast_on_disc(-corners_inout[0, 0], -corners_inout[0, 1], dx, dy, parts.radii[k])
        else:
            fraction, nx, ny = cast_on_hull(corners_inout, count, parts.radii[k], 0.0, 0.0, dx, dy)
        if fraction < hit_out[1]:
            hit_out[1] = fraction
            hit_out[2] = nx
            hit_out[3] = ny
    return hit_out[1] <= 1.0


@kernel
def cast_hull_at_rows(
    # read
    geometry,
    bodies,
    shapes,
    rows,
    corners,
    count,
    radius,
    x,
    y,
    dx,
    dy,
    # write
    workspace,
    hits_out,
    work_inout,
):
    """Write (row, fraction, normal to the hull) of every listed shape that a rounded hull meets on its way.

    Returns their number. rows: SHAPE rows, no masks among them; corners (16, 2) [px] from (x, y), `count` of
    them, moved by (dx, dy); workspace: RotationalWorkspace; hits_out (rows, 4). Touching at the start counts when it
    approaches: 0.
    """
    r = workspace.advance
    found = 0
    for k in range(len(rows)):
        s = shapes[rows[k]]
        b = bodies[s.body_row]
        work_inout[TOI_CALLS] += 1
        r.motion_a[CENTER_X] = x
        r.motion_a[CENTER_Y] = y
        r.motion_a[ANGLE] = 0.0
        r.motion_a[MOVE_X] = dx
        r.motion_a[MOVE_Y] = dy
        r.motion_a[TURN] = 0.0
        r.motion_b[CENTER_X] = b.x
        r.motion_b[CENTER_Y] = b.y
        r.motion_b[ANGLE] = b.angle if s.kind == CHAIN else 0.0
        r.motion_b[MOVE_X] = 0.0
        r.motion_b[MOVE_Y] = 0.0
        r.motion_b[TURN] = 0.0
        r.totals[0] = 0.0
        r.totals[1] = 0.0
        for i in range(count):
            workspace.mover[i, 0] = corners[i, 0]
            workspace.mover[i, 1] = corners[i, 1]
        if s.kind == TILES:
            fraction, nx, ny, _ = sweep_tiles(
                geometry, s.geometry, 0.0, 0.0, count, radius, 0.0, 0.0, True, -1, workspace
            )
        elif s.kind == CHAIN:
            near = TOUCHING_BAND * (reach_of(workspace.mover, count) + radius)
            if s.role == PART and starts_across(geometry, s.geometry, 0.0, 0.0, count, radius, near, workspace):
                continue
            fraction, nx, ny, _ = sweep_chain(geometry, s.geometry, 0.0, 0.0, count, radius, 0.0, 0.0, -1, workspace)
        else:
            n = hull_at(geometry, shapes, rows[k], 0.0, 0.0, b.angle, r.local_b)
            place_mover(count, workspace)
            fraction = advance(count, radius, n, rounding(shapes, rows[k]), workspace.advance)
            nx = -r.gap.gap[NX]
            ny = -r.gap.gap[NY]
        work_inout[GJK_ITERATIONS] += int(r.totals[0])
        work_inout[CAP_HITS] += int(r.totals[1])
        if fraction < MISS:
            hits_out[found, 0] = float(rows[k])
            hits_out[found, 1] = fraction
            hits_out[found, 2] = nx
            hits_out[found, 3] = ny
            found += 1
    return found


@kernel
def nearest_hull(
    # read
    geometry,
    bodies,
    shapes,
    rows,
    x,
    y,
    # write
    point_inout,
    corners_inout,
    workspace,
    nearest_out,
    work_inout,
):
    """Write (distance, x, y) [px] of the point of the listed hulls nearest to (x, y). Returns its row, -1 without any.

    rows: SHAPE rows in order, of which tiles, masks and chains are left out; 0 and the point itself when it is inside;
    point_inout, corners_inout (16, 2): scratch; workspace: GapWorkspace.
    """
    best = -1
    nearest_out[0] = math.inf
    for k in range(len(rows)):
        s = shapes[rows[k]]
        if not is_hull(s.kind):
            continue
        b = bodies[s.body_row]
        # Seen from the point, so that no digits are lost far from the origin.
        point_inout[0, 0] = 0.0
        point_inout[0, 1] = 0.0
        n = hull_at(geometry, shapes, rows[k], b.x - x, b.y - y, b.angle, corners_inout)
        distance = max(0.0, separate(point_inout, 1, 0.0, corners_inout, n, rounding(shapes, rows[k]), 0, 0, workspace))
        work_inout[NARROW_TESTS] += 1
        work_inout[GJK_ITERATIONS] += int(workspace.state[ROUNDS])
        if distance < nearest_out[0]:
            best = rows[k]
            nearest_out[0] = distance
            nearest_out[1] = x + (workspace.gap[BX] if distance > 0.0 else 0.0)
            nearest_out[2] = y + (workspace.gap[BY] if distance > 0.0 else 0.0)
    return best
