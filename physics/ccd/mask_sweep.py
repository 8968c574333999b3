"""Sweep of masks by their pixels, for worlds without contact response and for sensors: the time of the first overlap.

A mask is the union of its solid pixel squares at the exact pose, even if it is drawn on whole pixels (snap=True). The
pixels are grouped into rectangles. Only a motion that leads deeper than the overlap at the start has an impact. The
same rule holds in rotational.py, but here there is no slop. Grazing contacts and seams between two rectangles are
therefore not impacts.
"""

import math
from typing import NamedTuple

import numpy as np

from physics.ccd.impacts import cut_path, is_first_mover, is_swept, write_impact
from physics.ccd.rotational import (
    Mover,
    depth_at_start,
    gap_at_start,
    place_mover,
    shrink_to_middle,
    sweep_chain_seen_from,
    sweep_part,
    sweep_tiles,
    write_local,
    write_motion,
)
from physics.ccd.time_of_impact import ANGLE, CENTER_X, CENTER_Y, MISS, MOVE_X, MOVE_Y, TURN, reach_of
from physics.distance.gjk import AX, AY, NX, NY
from physics.jit import kernel, subkernel
from physics.math2d import norm, rotate
from physics.shapes.library import Library
from physics.shapes.placement import exact_aabb, rounding
from physics.tables.body import RAY
from physics.tables.shape import CHAIN, MASK, TILES
from physics.tables.step_state import CAP_HITS, GJK_ITERATIONS, TOI_CALLS


class Squares(NamedTuple):
    """The solid pixels of the masks of a library, grouped into rectangles. A mask's rectangles are computed once."""

    spans: np.ndarray  # (masks, 2) first row in boxes, number of rows; -1: not computed yet
    boxes: np.ndarray  # (n, 4) left, top, right, bottom [px] in body space


NO_SQUARES = Squares(np.zeros((0, 2), np.int64), np.zeros((0, 4)))


def squares_of(library: Library, masks: np.ndarray, known: Squares) -> Squares:
    """Return Squares that contain the rectangles of the masks `masks`, which are row numbers in the library.

    The result is `known`, or an extended copy of `known` if rectangles are missing in it.
    """
    missing = [row for row in masks.tolist() if row >= len(known.spans) or known.spans[row, 0] < 0]
    if not missing:
        return known
    spans = np.full((len(library.masks), 2), -1, np.int64)
    spans[: len(known.spans)] = known.spans
    boxes, count = [known.boxes], len(known.boxes)
    for row in missing:
        mask = library.masks[row]
        blocks = np.array(mask.blocks(0), np.float64).reshape(-1, 4) - (*mask.origin, *mask.origin)
        spans[row] = count, len(blocks)
        boxes.append(blocks)
        count += len(blocks)
    return Squares(spans, np.concatenate(boxes))


@subkernel
def write_square(boxes, k, body, corners_out):
    """Write the corners [px] of rectangle k of a mask, relative to the body's centre of mass at angle 0.

    boxes: see Squares; body: BODY row. Return the number of corners, 4. corners_out (16, 2): the result.
    """
    for corner in range(4):
        corners_out[corner, 0] = boxes[k, 2 if corner == 1 or corner == 2 else 0] - body.local_center_x
        corners_out[corner, 1] = boxes[k, 3 if corner > 1 else 1] - body.local_center_y
    return 4


@subkernel
def pieces_of(shape, body, spans, as_ray):
    """Return (first rectangle, number of pieces, whether the pieces are rectangles) of a shape.

    A mask has one piece for each of its rectangles in Squares.boxes. A hull, or a body swept as a ray, is a single
    piece. shape, body: SHAPE and BODY rows; spans: Squares.spans; as_ray: whether a body in mode "ray" is swept as a
    ray.
    """
    if shape.kind != MASK or (as_ray and body.continuous == RAY):
        return 0, 1, False
    return spans[shape.geometry, 0], spans[shape.geometry, 1], True


@subkernel
def write_single(geometry, bodies, shapes, row, workspace):
    """Write the corners of a hull, or the point of a ray, to workspace.mover. Return the Mover.

    row: row number in SHAPE.
    """
    if shapes[row].kind == MASK:
        workspace.mover[0, 0] = 0.0
        workspace.mover[0, 1] = 0.0
        return Mover(1, 0.0, 0.0, 0.0, False)
    count = write_local(geometry, bodies, shapes, row, workspace.advance.motion_a, workspace.mover)
    if bodies[shapes[row].body_row].continuous == RAY:
        return Mover(shrink_to_middle(count, workspace.mover), 0.0, 0.0, 0.0, False)
    return Mover(count, rounding(shapes, row), 0.0, 0.0, False)


@subkernel
def misses_square(boxes, k, body, x, y, dx, dy, reach):
    """Return whether a shape that moves from (x, y) by (dx, dy) cannot meet rectangle k of a mask.

    boxes: Squares.boxes; body: BODY row of the mask, which must not rotate. Coordinates [px] are relative to the mask's
    centre of mass. reach [px]: greatest distance of the shape's points from (x, y).
    """
    left = boxes[k, 0] - body.local_center_x - reach
    top = boxes[k, 1] - body.local_center_y - reach
    right = boxes[k, 2] - body.local_center_x + reach
    bottom = boxes[k, 3] - body.local_center_y + reach
    return max(x, x + dx) < left or min(x, x + dx) > right or max(y, y + dy) < top or min(y, y + dy) > bottom


@subkernel
def sweep_on_pieces(mover, depth, body, squares, span, hull, workspace, best_out):
    """Sweep one piece of the moving shape against all pieces of the other shape, or measure their overlap.

    depth [px]: overlap at the start; an impact must lead to a deeper overlap. If `depth` is negative, nothing is swept,
    and the deepest overlap [px] at the start is returned. Otherwise 0 is returned.

    mover: the moving piece, with its corners in workspace.mover. body: BODY row of the other shape; span: result of
    pieces_of for the other shape; hull: the only piece of the other shape if it is not a mask, with the corners in
    workspace.advance.local_b. squares: see Squares; best_out (5,): first impact so far, see sweep_squares. O(nearby
    pieces).
    """
    r = workspace.advance
    first, pieces, are_squares = span
    count, radius = mover.count, mover.radius
    n, radius_b = hull.count, hull.radius
    reach = reach_of(workspace.mover, count) + radius
    turns = r.motion_b[TURN] != 0.0
    cosine, sine = math.cos(r.motion_b[ANGLE]), math.sin(r.motion_b[ANGLE])
    x, y = rotate(
        r.motion_a[CENTER_X] - r.motion_b[CENTER_X], r.motion_a[CENTER_Y] - r.motion_b[CENTER_Y], cosine, -sine
    )
    move_x = r.motion_a[MOVE_X] - r.motion_b[MOVE_X]
    move_y = r.motion_a[MOVE_Y] - r.motion_b[MOVE_Y]
    dx, dy = rotate(move_x, move_y, cosine, -sine)
    deepest = 0.0
    for k in range(first, first + pieces):
        if are_squares:
            if not turns and misses_square(squares.boxes, k, body, x, y, dx, dy, reach):
                continue
            n = write_square(squares.boxes, k, body, r.local_b)
        place_mover(count, workspace)
        apart = gap_at_start(count, radius, n, radius_b, workspace)
        if depth < 0.0:
            if apart <= 0.0:
                deepest = max(deepest, depth_at_start(mover, n, radius_b, workspace))
            continue
        travel = norm(move_x, move_y) + abs(r.motion_a[TURN]) * reach + abs(r.motion_b[TURN]) * reach_of(r.local_b, n)
        if apart > travel * min(1.0, best_out[0]):
            continue
        fraction, _ = sweep_part(mover, n, radius_b, depth, workspace)
        if fraction < best_out[0]:
            best_out[0] = fraction
            best_out[1] = -r.gap.gap[NX]
            best_out[2] = -r.gap.gap[NY]
            best_out[3] = r.motion_a[CENTER_X] + r.gap.gap[AX]
            best_out[4] = r.motion_a[CENTER_Y] + r.gap.gap[AY]
    return deepest


@subkernel
def middle_of_mask(geometry, shape, body, angle):
    """Return the centre (x, y) [px] of a mask's AABB at an angle [rad], in body space relative to the centre of mass.

    shape, body: SHAPE and BODY rows. The centre determines the side of a chain link on which the mask is.
    """
    raster = geometry.raster_of[shape.geometry, 0]
    left, top, right, bottom = exact_aabb(geometry.rasters, geometry.corners, raster, 0.0, 0.0, angle)
    u, v = rotate(0.5 * (left + right), 0.5 * (top + bottom), math.cos(angle), -math.sin(angle))
    return u - body.local_center_x, v - body.local_center_y


@subkernel
def sweep_on_ground(geometry, other, body, middle, mover, one_way, workspace, best_out):
    """Sweep one piece of the moving shape against tiles or a chain.

    other, body: SHAPE and BODY rows of the tiles or chain; mover: the piece, with its corners in workspace.mover;
    middle: centre of the whole moving shape, see middle_of_mask; one_way: whether one-way tiles stop motion from above.
    best_out (5,): first impact so far, see sweep_squares.
    """
    local = (body.local_center_x, body.local_center_y)
    if other.kind == TILES:
        fraction, nx, ny, _ = sweep_tiles(geometry, other.geometry, local, mover, one_way, -1, workspace)
    else:
        fraction, nx, ny, _ = sweep_chain_seen_from(geometry, other.geometry, local, middle, mover, -1, workspace)
    if fraction < best_out[0]:
        best_out[0] = fraction
        best_out[1] = nx
        best_out[2] = ny
        best_out[3] = math.nan
        best_out[4] = math.nan


@subkernel
def sweep_squares(row, other, squares, sweep_inout, best_out):
    """Sweep two moving shapes, at least one of them a mask, along the paths in sweep_inout.cuts.

    row, other: row numbers in SHAPE; squares: Squares of the masks. Write the first impact to best_out (5,): fraction
    of the paths or MISS, nx and ny from `other` to `row`, and the point x and y [px], nan if unknown. O(pieces · nearby
    pieces).
    """
    geometry, bodies, shapes = sweep_inout.geometry, sweep_inout.bodies, sweep_inout.shapes
    workspace = sweep_inout.workspace
    r = workspace.advance
    s, o = shapes[row], shapes[other]
    p, q = bodies[s.body_row], bodies[o.body_row]
    sweep_inout.work[TOI_CALLS] += 1
    write_motion(sweep_inout.cuts, s.body_row, r.motion_a)
    write_motion(sweep_inout.cuts, o.body_row, r.motion_b)
    r.totals[0] = 0.0
    r.totals[1] = 0.0
    best_out[0] = MISS
    best_out[1] = 0.0
    best_out[2] = -1.0
    first, pieces, are_squares = pieces_of(s, p, squares.spans, True)
    mover = Mover(4, 0.0, 0.0, 0.0, False)
    if not are_squares:
        mover = write_single(geometry, bodies, shapes, row, workspace)
    on_ground = o.kind == TILES or o.kind == CHAIN
    span = pieces_of(o, q, squares.spans, False)
    hull = Mover(4, 0.0, 0.0, 0.0, False)
    if not on_ground and o.kind != MASK:
        hull = Mover(
            write_local(geometry, bodies, shapes, other, r.motion_b, r.local_b),
            rounding(shapes, other),
            0.0,
            0.0,
            False,
        )
    middle = middle_of_mask(geometry, s, p, r.motion_a[ANGLE]) if are_squares else (0.0, 0.0)
    depth = 0.0
    for asked in range(2):
        for k in range(first, first + pieces):
            if are_squares:
                write_square(squares.boxes, k, p, workspace.mover)
            if not on_ground:
                allowed = depth if asked == 1 else -1.0
                depth = max(depth, sweep_on_pieces(mover, allowed, q, squares, span, hull, workspace, best_out))
            elif asked == 1:
                sweep_on_ground(geometry, o, q, middle, mover, sweep_inout.one_way, workspace, best_out)
    sweep_inout.work[GJK_ITERATIONS] += int(r.totals[0])
    sweep_inout.work[CAP_HITS] += int(r.totals[1])


@subkernel
def first_shared(row, other, squares, sweep_inout, best_out):
    """Write the first overlap in the step of two shapes, at least one of them a mask, to best_out (5,).

    best_out: as in sweep_squares, but the fraction is that of the step. Each body moves along its path up to its
    BODY.fraction of the step, and then rests. row, other: row numbers in SHAPE. sweep_inout: see Sweep; squares: see
    Squares.
    """
    bodies, paths, cuts = sweep_inout.bodies, sweep_inout.paths, sweep_inout.cuts
    p, q = sweep_inout.shapes[row].body_row, sweep_inout.shapes[other].body_row
    both = min(bodies[p].fraction, bodies[q].fraction)
    last = max(bodies[p].fraction, bodies[q].fraction)
    start = 0.0
    end = both
    best_out[0] = MISS
    for _ in range(2):
        if end > start:
            cut_path(paths, p, min(start, bodies[p].fraction), min(end, bodies[p].fraction), cuts)
            cut_path(paths, q, min(start, bodies[q].fraction), min(end, bodies[q].fraction), cuts)
            sweep_squares(row, other, squares, sweep_inout, best_out)
            if best_out[0] <= 1.0:
                best_out[0] = start + best_out[0] * (end - start)
                return
        start = both
        end = last


@kernel
def find_shared_areas(moving, squares, sweep_inout, best_out, impacts_out):
    """Find the pairs with a mask that begin to overlap during their motion. Return their number. O(candidates).

    impacts_out (n, 8), columns: index of the candidate pair, fraction of the step, nx and ny from A to B, 0 (no body is
    stopped), -1, point x and y. moving: see impacts.is_swept; squares: Squares of all masks among the candidates;
    best_out (5,): scratch. sweep_inout: see Sweep.
    """
    shapes, candidates = sweep_inout.shapes, sweep_inout.candidates
    found = 0
    for i in range(len(candidates)):
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        if (a.kind != MASK and b.kind != MASK) or not is_swept(moving, a, b, sweep_inout):
            continue
        from_a = b.kind == TILES or b.kind == CHAIN
        if not from_a and a.kind != TILES and a.kind != CHAIN:
            from_a = is_first_mover(a, b, sweep_inout.bodies, sweep_inout.fast)
        mover = candidates[i, 0] if from_a else candidates[i, 1]
        other = candidates[i, 1] if from_a else candidates[i, 0]
        first_shared(mover, other, squares, sweep_inout, best_out)
        if best_out[0] <= 1.0:
            if found < impacts_out.shape[0]:
                impacts_out[found, 6] = best_out[3]
                impacts_out[found, 7] = best_out[4]
            impact = (best_out[0], best_out[1], best_out[2], -1)
            found = write_impact(i, impact, from_a, False, found, impacts_out)
    return found
