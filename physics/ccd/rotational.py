"""The sweep of a body that moves and turns through a step, about its centre of mass: hulls against hulls, tiles, chains.

What touches at the start is in the hands of the solver, and a body that rests or slides must not be held by it. But it
must not pass through either: then a core circle, a quarter of the body's smallest half extent about its centre of mass,
is swept in its place (the rule of Box2D v3), and the hull itself counts again once it is a slop deeper. The same holds
where a tile or link is met from a side that its neighbour covers: there is no such side, but the core must not get through.
"""

import math
from typing import NamedTuple

import numpy as np

from physics.ccd.advance import (
    ANGLE,
    CENTER_X,
    CENTER_Y,
    MOVE_X,
    MOVE_Y,
    TOUCHING_BAND,
    TURN,
    AdvanceRoom,
    advance,
    approach_at,
    new_advance_room,
    reach_of,
    separate_at,
)
from physics.ccd.linear import MISS
from physics.collision.clipping import ALL_EDGES, edge_normal
from physics.collision.tiles import tile_at
from physics.jit import subkernel
from physics.math2d import length_of, turned
from physics.proximity.gjk import NX, NY
from physics.shapes.placement import hull_at, is_hull, rounding
from physics.tables.body import DYNAMIC
from physics.tables.counters import CAP_HITS, GJK_ITERATIONS, TOI_CALLS
from physics.tables.geometry import BLOCK_LINKS, EMPTY, ONE_WAY
from physics.tables.shape import BOUNDS, CHAIN, TILES

CORE = 0.25  # of a body's smallest half extent
GRAZE = 2.0**-20  # of the size: motion into ground by less is a slide along it
ON_FACE = 1.0 - 1e-12  # cosine: a normal that is a face's own


class TurningRoom(NamedTuple):
    """Room for one shape on its way."""

    advance: AdvanceRoom
    mover: np.ndarray  # (16, 2) its corners from its centre of mass [px], at angle 0


def new_turning_room() -> TurningRoom:
    return TurningRoom(new_advance_room(), np.zeros((16, 2)))


@subkernel
def write_motion(motions, body_row, motion_out):
    """Start and change of one body's motion. motions (bodies, 6): centre of mass [px] and angle, at start and end."""
    motion_out[CENTER_X] = motions[body_row, 0]
    motion_out[CENTER_Y] = motions[body_row, 1]
    motion_out[ANGLE] = motions[body_row, 2]
    motion_out[MOVE_X] = motions[body_row, 3] - motions[body_row, 0]
    motion_out[MOVE_Y] = motions[body_row, 4] - motions[body_row, 1]
    motion_out[TURN] = motions[body_row, 5] - motions[body_row, 2]


@subkernel
def write_local(geometry, bodies, shapes, row, motion_inout, corners_out):
    """Corners of a hull from its body's centre of mass [px] at angle 0. Returns their number.

    A BOUNDS does not turn: it keeps the box it has at the start.
    """
    b = bodies[shapes[row].body_row]
    if shapes[row].kind != BOUNDS:
        return hull_at(geometry, shapes, row, -b.local_center_x, -b.local_center_y, 0.0, corners_out)
    angle = motion_inout[ANGLE]
    u, v = turned(b.local_center_x, b.local_center_y, math.cos(angle), math.sin(angle))
    motion_inout[ANGLE] = 0.0
    motion_inout[TURN] = 0.0
    return hull_at(geometry, shapes, row, -u, -v, angle, corners_out)


@subkernel
def is_touchable(corners, count, edges, mx, my):
    """Whether a polygon can be touched with an outward normal: of a face, or between the two faces of a corner.

    edges: see tiles.tile_at: low bits the faces, from bit 16 those whose corners can be touched.
    """
    if edges == ALL_EDGES:
        return True
    best = 0
    most = -2.0
    for k in range(count):
        nx, ny = edge_normal(corners, count, k)
        along = mx * nx + my * ny
        if along > most:
            most = along
            best = k
    if most >= ON_FACE:
        return (edges >> best) & 1 == 1
    # On which side of the nearest face's normal it leans tells the corner.
    nx, ny = edge_normal(corners, count, best)
    after = best + 1 if best + 1 < count else 0
    before = best - 1 if best > 0 else count - 1
    other = after if nx * my - ny * mx > 0.0 else before
    return (edges >> (16 + best)) & 1 == 1 and (edges >> (16 + other)) & 1 == 1


@subkernel
def link_allows(link, mx, my):
    """Whether a link of a chain, in body space, can be touched with a normal: its own, or up to its neighbour's.

    An end without a neighbour can be touched up to a quarter turn.
    """
    tx = link.bx - link.ax
    ty = link.by - link.ay
    length = length_of(tx, ty)
    if length == 0.0:
        return False
    tx /= length
    ty /= length
    facing = mx * ty - my * tx
    if facing >= ON_FACE:
        return True
    if facing < 0.0:
        return False
    beyond = mx * tx + my * ty > 0.0
    if not (link.has_after if beyond else link.has_before):
        return True
    sx = link.after_x - link.bx if beyond else link.ax - link.before_x
    sy = link.after_y - link.by if beyond else link.ay - link.before_y
    # Convex where the chain turns away from its front, and then no further than the neighbour's normal (sy, -sx).
    if beyond:
        return tx * sy - ty * sx > 0.0 and mx * -sx - my * sy >= 0.0
    return sx * ty - sy * tx > 0.0 and sy * my + sx * mx >= 0.0


@subkernel
def sweep_at(count, radius, other_count, other_radius, core_radius, slack, room):
    """(fraction or MISS, whether the core circle met it) of the mover against what stands in room.advance.local_b.

    slack [px]: apart by no more at the start is in contact. core_radius [px]: 0 sweeps the hull in any case.
    """
    for k in range(count):
        room.advance.local_a[k, 0] = room.mover[k, 0]
        room.advance.local_a[k, 1] = room.mover[k, 1]
    start = separate_at(count, radius, other_count, other_radius, 0.0, room.advance)
    if core_radius == 0.0 or start > slack:
        return advance(count, radius, other_count, other_radius, room.advance), False
    # In contact: what rests or slides stays as deep as it is, what breaks through gets a slop deeper, or its core in.
    core = sweep_core(core_radius, other_count, other_radius, room)
    for k in range(count):
        room.advance.local_a[k, 0] = room.mover[k, 0]
        room.advance.local_a[k, 1] = room.mover[k, 1]
    deeper = advance(count, radius - slack - max(-start, 0.0), other_count, other_radius, room.advance)
    if core < deeper:
        return sweep_core(core_radius, other_count, other_radius, room), True
    return deeper, False


@subkernel
def sweep_core(core_radius, other_count, other_radius, room):
    """Fraction, or MISS, of the core circle against what stands in room.advance.local_b; MISS when its centre is in it.

    Where the circle touches already it shrinks to half the distance that is left: the centre never gets across.
    """
    room.advance.local_a[0, 0] = 0.0
    room.advance.local_a[0, 1] = 0.0
    left = separate_at(1, 0.0, other_count, other_radius, 0.0, room.advance)
    if left <= 0.0:
        return MISS
    return advance(1, min(core_radius, 0.5 * left), other_count, other_radius, room.advance)


@subkernel
def only_grazes(count, radius, other_count, fraction, slack, room):
    """Whether the mover, where it meets a piece of ground, would not go into it by more than slack [px]: it slides along."""
    reach = reach_of(room.advance.local_a, count)
    size = reach + radius
    approach = approach_at(count, other_count, fraction, TOUCHING_BAND * size, room.advance)
    approach += abs(room.advance.motion_a[TURN]) * reach
    return approach * (1.0 - fraction) <= max(slack, GRAZE * size)


@subkernel
def swept_box(reach, motion_a, motion_b):
    """Box (min_x, min_y, max_x, max_y) [px] that holds a body on its way, seen from the other's own moving point."""
    x = motion_a[CENTER_X] - motion_b[CENTER_X]
    y = motion_a[CENTER_Y] - motion_b[CENTER_Y]
    dx = motion_a[MOVE_X] - motion_b[MOVE_X]
    dy = motion_a[MOVE_Y] - motion_b[MOVE_Y]
    return (x + min(0.0, dx) - reach, y + min(0.0, dy) - reach, x + max(0.0, dx) + reach, y + max(0.0, dy) + reach)


@subkernel
def sweep_tiles(geometry, grid, local_x, local_y, count, radius, core_radius, slack, one_way, room):
    """(fraction or MISS, normal from the tiles, core) of the mover against the tiles in its swept box. O(cells in it).

    local_x, local_y [px]: the grid's centre of mass in its body space; a grid does not turn.
    """
    g = geometry.grids[grid]
    reach = reach_of(room.mover, count) + radius
    left, top, right, bottom = swept_box(reach, room.advance.motion_a, room.advance.motion_b)
    left += local_x
    right += local_x
    top += local_y
    bottom += local_y
    falls = room.advance.motion_a[MOVE_Y] > room.advance.motion_b[MOVE_Y]
    feet = -math.inf
    cosine = math.cos(room.advance.motion_a[ANGLE])
    sine = math.sin(room.advance.motion_a[ANGLE])
    for k in range(count):
        u, v = turned(room.mover[k, 0], room.mover[k, 1], cosine, sine)
        feet = max(feet, v + radius)
    feet += room.advance.motion_a[CENTER_Y] - room.advance.motion_b[CENTER_Y] + local_y
    best = MISS
    best_x = 0.0
    best_y = -1.0
    best_core = False
    for line in range(max(0, math.ceil(top / g.tile_size) - 1), min(g.rows - 1, math.floor(bottom / g.tile_size)) + 1):
        for column in range(
            max(0, math.ceil(left / g.tile_size) - 1), min(g.columns - 1, math.floor(right / g.tile_size)) + 1
        ):
            kind = geometry.cells[g.offset + line * g.columns + column].kind
            if kind == EMPTY or (kind == ONE_WAY and not (one_way and falls and feet <= line * g.tile_size + slack)):
                continue
            corners, edges = tile_at(geometry, grid, -local_x, -local_y, line, column, room.advance.local_b)
            if edges == ALL_EDGES:
                continue  # covered all round: nothing gets there first
            fraction, core = sweep_at(count, radius, corners, 0.0, core_radius, slack, room)
            if fraction <= 1.0 and not core and only_grazes(count, radius, corners, fraction, slack, room):
                continue
            # A normal from the tile to the mover; room.advance.local_b is not turned.
            if fraction <= 1.0 and not is_touchable(
                room.advance.local_b, corners, edges, -room.advance.gap.gap[NX], -room.advance.gap.gap[NY]
            ):
                fraction = MISS if core or core_radius == 0.0 else sweep_core(core_radius, corners, 0.0, room)
                core = True
                if fraction <= 1.0 and not is_touchable(
                    room.advance.local_b, corners, edges, -room.advance.gap.gap[NX], -room.advance.gap.gap[NY]
                ):
                    fraction = MISS
            if fraction < best:
                best = fraction
                best_x = -room.advance.gap.gap[NX]
                best_y = -room.advance.gap.gap[NY]
                best_core = core
    return best, best_x, best_y, best_core


@subkernel
def front_side(mover, count, motion, other, fraction, local_x, local_y, link):
    """How far the middle of the mover's corners is in front of a link [px] at a fraction of both motions."""
    middle_x = 0.0
    middle_y = 0.0
    for k in range(count):
        middle_x += mover[k, 0] / count
        middle_y += mover[k, 1] / count
    angle = motion[ANGLE] + fraction * motion[TURN]
    middle_x, middle_y = turned(middle_x, middle_y, math.cos(angle), math.sin(angle))
    angle = other[ANGLE] + fraction * other[TURN]
    cosine = math.cos(angle)
    sine = math.sin(angle)
    x = motion[CENTER_X] - other[CENTER_X] + fraction * (motion[MOVE_X] - other[MOVE_X]) + middle_x
    y = motion[CENTER_Y] - other[CENTER_Y] + fraction * (motion[MOVE_Y] - other[MOVE_Y]) + middle_y
    u, v = turned(x, y, cosine, -sine)
    tx = link.bx - link.ax
    ty = link.by - link.ay
    length = length_of(tx, ty)
    if length == 0.0:
        return 0.0
    return (ty * (u + local_x - link.ax) - tx * (v + local_y - link.ay)) / length


@subkernel
def sweep_link(geometry, k, local_x, local_y, count, radius, core_radius, half, slack, room):
    """(fraction or MISS, core) of the mover against one link of a chain, from its front.

    half [px]: the mover's smallest half extent; 0: of none. Motion into the link by no
    more than `slack` [px] slides along.
    """
    link = geometry.links[k]
    motion = room.advance.motion_a
    other = room.advance.motion_b
    if half > 0.0 and (
        front_side(room.mover, count, motion, other, 0.0, local_x, local_y, link)
        - front_side(room.mover, count, motion, other, 1.0, local_x, local_y, link)
        <= slack
    ):
        return MISS, False
    room.advance.local_b[0, 0] = link.ax - local_x
    room.advance.local_b[0, 1] = link.ay - local_y
    room.advance.local_b[1, 0] = link.bx - local_x
    room.advance.local_b[1, 1] = link.by - local_y
    fraction, core = sweep_at(count, radius, 2, 0.0, core_radius, slack, room)
    if fraction <= 1.0 and not core and only_grazes(count, radius, 2, fraction, slack, room):
        return MISS, core
    for attempt in range(2):
        if fraction > 1.0 or front_side(room.mover, count, motion, other, fraction, local_x, local_y, link) < 0.0:
            return MISS, core
        angle = other[ANGLE] + fraction * other[TURN]
        mx, my = turned(-room.advance.gap.gap[NX], -room.advance.gap.gap[NY], math.cos(angle), -math.sin(angle))
        if link_allows(link, mx, my):
            return fraction, core
        if core or core_radius == 0.0:
            return MISS, core
        fraction = sweep_core(core_radius, 2, 0.0, room)
        core = True
    return MISS, core


@subkernel
def sweep_chain(geometry, chain, local_x, local_y, count, radius, core_radius, half, slack, room):
    """(fraction or MISS, normal from the chain, core) of the mover against a chain's links; blocks out of reach are skipped."""
    span = geometry.chains[chain]
    reach = reach_of(room.mover, count) + radius
    other = room.advance.motion_b
    turns = other[ANGLE] != 0.0 or other[TURN] != 0.0
    left, top, right, bottom = swept_box(reach, room.advance.motion_a, other)
    best = MISS
    best_x = 0.0
    best_y = -1.0
    best_core = False
    for block in range(span.blocks):
        box = geometry.link_blocks[span.first_block + block]
        if not turns and (
            box.min_x - local_x > right
            or box.max_x - local_x < left
            or box.min_y - local_y > bottom
            or box.max_y - local_y < top
        ):
            continue
        first = span.offset + block * BLOCK_LINKS
        for k in range(first, min(first + BLOCK_LINKS, span.offset + span.count)):
            fraction, core = sweep_link(geometry, k, local_x, local_y, count, radius, core_radius, half, slack, room)
            if fraction < best:
                best = fraction
                best_x = -room.advance.gap.gap[NX]
                best_y = -room.advance.gap.gap[NY]
                best_core = core
    return best, best_x, best_y, best_core


@subkernel
def sweep_turning(geometry, bodies, shapes, motions, row, other, slack, one_way, room, work_inout):
    """Shape `row` against shape `other`, both on their way through a step: (fraction or MISS, normal from other to row, core).

    motions (bodies, 6) float64, by body row: centre of mass [px] and angle, at the start and at the end of the step.
    row: a hull; other: a hull, tiles or a chain, from its front; for anything else MISS. slack [px]: apart by no more at
    the start counts as in contact, and the core circle is swept instead: core tells. one_way: whether such tiles take part.
    """
    s = shapes[row]
    o = shapes[other]
    if not is_hull(s.kind) or not (is_hull(o.kind) or o.kind == TILES or o.kind == CHAIN):
        return MISS, 0.0, -1.0, False
    work_inout[TOI_CALLS] += 1
    b = bodies[o.body_row]
    half = bodies[s.body_row].smallest_half
    radius = rounding(shapes, row)
    write_motion(motions, s.body_row, room.advance.motion_a)
    write_motion(motions, o.body_row, room.advance.motion_b)
    count = write_local(geometry, bodies, shapes, row, room.advance.motion_a, room.mover)
    room.advance.totals[0] = 0.0
    room.advance.totals[1] = 0.0
    if o.kind == TILES:
        fraction, nx, ny, core = sweep_tiles(
            geometry, o.geometry, b.local_center_x, b.local_center_y, count, radius, CORE * half, slack, one_way, room
        )
    elif o.kind == CHAIN:
        fraction, nx, ny, core = sweep_chain(
            geometry, o.geometry, b.local_center_x, b.local_center_y, count, radius, CORE * half, half, slack, room
        )
    else:
        n = write_local(geometry, bodies, shapes, other, room.advance.motion_b, room.advance.local_b)
        fraction, core = sweep_at(count, radius, n, rounding(shapes, other), CORE * half, slack, room)
        if core and fraction > 1.0 and b.kind == DYNAMIC:
            # Deep in each other: at least their cores do not change places.
            room.advance.local_b[0, 0] = 0.0
            room.advance.local_b[0, 1] = 0.0
            fraction = sweep_core(CORE * half, 1, CORE * b.smallest_half, room)
        nx = -room.advance.gap.gap[NX]
        ny = -room.advance.gap.gap[NY]
    work_inout[GJK_ITERATIONS] += int(room.advance.totals[0])
    work_inout[CAP_HITS] += int(room.advance.totals[1])
    return fraction, nx, ny, core
