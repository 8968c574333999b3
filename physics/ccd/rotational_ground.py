"""Rotational continuous collision with tiles and chains: only what can be touched from outside stops a body."""

import math

from physics.ccd.advance import ANGLE, CENTER_X, CENTER_Y, MOVE_X, MOVE_Y, TURN, reach_of
from physics.ccd.closed_form import MISS
from physics.ccd.rotational import ON_FACE, only_grazes, sweep_at, sweep_core, swept_box
from physics.collision.clipping import ALL_EDGES, edge_normal
from physics.collision.tiles import tile_at
from physics.jit import subkernel
from physics.math2d import length_of, turned
from physics.proximity.gjk import NX, NY
from physics.tables.geometry import BLOCK_LINKS, EMPTY, ONE_WAY


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
def sweep_tiles(geometry, grid, local_x, local_y, count, radius, core_radius, slack, one_way, workspace):
    """(fraction or MISS, normal from the tiles, core) of the mover against the tiles in its swept box. O(cells in it).

    local_x, local_y [px]: the grid's centre of mass in its body space; a grid does not turn.
    """
    g = geometry.grids[grid]
    reach = reach_of(workspace.mover, count) + radius
    left, top, right, bottom = swept_box(reach, workspace.advance.motion_a, workspace.advance.motion_b)
    left += local_x
    right += local_x
    top += local_y
    bottom += local_y
    falls = workspace.advance.motion_a[MOVE_Y] > workspace.advance.motion_b[MOVE_Y]
    feet = -math.inf
    cosine = math.cos(workspace.advance.motion_a[ANGLE])
    sine = math.sin(workspace.advance.motion_a[ANGLE])
    for k in range(count):
        u, v = turned(workspace.mover[k, 0], workspace.mover[k, 1], cosine, sine)
        feet = max(feet, v + radius)
    feet += workspace.advance.motion_a[CENTER_Y] - workspace.advance.motion_b[CENTER_Y] + local_y
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
            corners, edges = tile_at(geometry, grid, -local_x, -local_y, line, column, workspace.advance.local_b)
            if edges == ALL_EDGES:
                continue  # covered all round: nothing gets there first
            fraction, core = sweep_at(count, radius, corners, 0.0, core_radius, slack, workspace)
            if fraction <= 1.0 and not core and only_grazes(count, radius, corners, fraction, slack, workspace):
                continue
            # A normal from the tile to the mover; workspace.advance.local_b is not turned.
            if fraction <= 1.0 and not is_touchable(
                workspace.advance.local_b,
                corners,
                edges,
                -workspace.advance.gap.gap[NX],
                -workspace.advance.gap.gap[NY],
            ):
                fraction = MISS if core or core_radius == 0.0 else sweep_core(core_radius, corners, 0.0, workspace)
                core = True
                if fraction <= 1.0 and not is_touchable(
                    workspace.advance.local_b,
                    corners,
                    edges,
                    -workspace.advance.gap.gap[NX],
                    -workspace.advance.gap.gap[NY],
                ):
                    fraction = MISS
            if fraction < best:
                best = fraction
                best_x = -workspace.advance.gap.gap[NX]
                best_y = -workspace.advance.gap.gap[NY]
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
def sweep_link(geometry, k, local_x, local_y, count, radius, core_radius, half, slack, workspace):
    """(fraction or MISS, core) of the mover against one link of a chain, from its front.

    half [px]: the mover's smallest half extent; 0: of none. Motion into the link by no
    more than `slack` [px] slides along.
    """
    link = geometry.links[k]
    motion = workspace.advance.motion_a
    other = workspace.advance.motion_b
    if half > 0.0 and (
        front_side(workspace.mover, count, motion, other, 0.0, local_x, local_y, link)
        - front_side(workspace.mover, count, motion, other, 1.0, local_x, local_y, link)
        <= slack
    ):
        return MISS, False
    workspace.advance.local_b[0, 0] = link.ax - local_x
    workspace.advance.local_b[0, 1] = link.ay - local_y
    workspace.advance.local_b[1, 0] = link.bx - local_x
    workspace.advance.local_b[1, 1] = link.by - local_y
    fraction, core = sweep_at(count, radius, 2, 0.0, core_radius, slack, workspace)
    if fraction <= 1.0 and not core and only_grazes(count, radius, 2, fraction, slack, workspace):
        return MISS, core
    for _ in range(2):
        if fraction > 1.0 or front_side(workspace.mover, count, motion, other, fraction, local_x, local_y, link) < 0.0:
            return MISS, core
        angle = other[ANGLE] + fraction * other[TURN]
        mx, my = turned(
            -workspace.advance.gap.gap[NX], -workspace.advance.gap.gap[NY], math.cos(angle), -math.sin(angle)
        )
        if link_allows(link, mx, my):
            return fraction, core
        if core or core_radius == 0.0:
            return MISS, core
        fraction = sweep_core(core_radius, 2, 0.0, workspace)
        core = True
    return MISS, core


@subkernel
def sweep_chain(geometry, chain, local_x, local_y, count, radius, core_radius, half, slack, workspace):
    """(fraction or MISS, normal from the chain, core) of the mover against the links of a chain within reach."""
    span = geometry.chains[chain]
    reach = reach_of(workspace.mover, count) + radius
    other = workspace.advance.motion_b
    turns = other[ANGLE] != 0.0 or other[TURN] != 0.0
    left, top, right, bottom = swept_box(reach, workspace.advance.motion_a, other)
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
            fraction, core = sweep_link(
                geometry, k, local_x, local_y, count, radius, core_radius, half, slack, workspace
            )
            if fraction < best:
                best = fraction
                best_x = -workspace.advance.gap.gap[NX]
                best_y = -workspace.advance.gap.gap[NY]
                best_core = core
    return best, best_x, best_y, best_core
