"""The sweep of a hull against tiles and chains: piece by piece, all by the rule of rotational.py."""

import math

from physics.ccd.advance import ANGLE, CENTER_X, CENTER_Y, MOVE_X, MOVE_Y, TURN, place_at, reach_of
from physics.ccd.closed_form import MISS
from physics.ccd.rotational import depth_at_start, sweep_part, swept_box
from physics.collision.clipping import ALL_EDGES
from physics.collision.features import part_feature
from physics.collision.surfaces import lies_across
from physics.collision.tiles import tile_at
from physics.jit import subkernel
from physics.math2d import turned
from physics.proximity.gjk import NX, NY
from physics.tables.geometry import BLOCK_LINKS, EMPTY, ONE_WAY


@subkernel
def feet_of(count, radius, local_y, workspace):
    """How far down [px] the mover reaches before it moves, seen from the origin of a grid."""
    motion = workspace.advance.motion_a
    cosine = math.cos(motion[ANGLE])
    sine = math.sin(motion[ANGLE])
    feet = -math.inf
    for k in range(count):
        u, v = turned(workspace.mover[k, 0], workspace.mover[k, 1], cosine, sine)
        feet = max(feet, v + radius)
    return feet + motion[CENTER_Y] - workspace.advance.motion_b[CENTER_Y] + local_y


@subkernel
def place_tile(geometry, grid, line, column, local_x, local_y, stood, workspace):
    """Write what of a tile stops the mover to workspace.advance.local_b. Returns its number of corners, 0: nothing.

    Of a tile that is open from below it is its top, for a mover whose feet are no lower than `stood` [px].
    """
    g = geometry.grids[grid]
    kind = geometry.cells[g.offset + line * g.columns + column].kind
    if kind == EMPTY or (kind == ONE_WAY and stood > line * g.tile_size):
        return 0
    corners, edges = tile_at(geometry, grid, -local_x, -local_y, line, column, workspace.advance.local_b)
    if kind == ONE_WAY:
        return 2
    return 0 if edges == ALL_EDGES else corners  # covered all round: nothing gets there first


@subkernel
def sweep_tiles(geometry, grid, local_x, local_y, count, radius, half, slack, one_way, but, workspace):
    """(fraction or MISS, normal from the tiles, feature) of the mover against the tiles in its swept box.

    O(cells in it). local_x, local_y [px]: the grid's centre of mass in its body space; a grid does not turn. half,
    slack: see sweep_part; one_way: whether tiles open from below take part; they stop what falls from above them; but:
    the feature that does not count, or -1.
    """
    g = geometry.grids[grid]
    size = g.tile_size
    motion = workspace.advance.motion_a
    other = workspace.advance.motion_b
    reach = reach_of(workspace.mover, count) + radius
    left, top, right, bottom = swept_box(reach, motion, other)
    falls = one_way and motion[MOVE_Y] > other[MOVE_Y]
    stood = feet_of(count, radius, local_y, workspace) - slack if falls else math.inf
    first_row = max(0, math.ceil((top + local_y) / size) - 1)
    last_row = min(g.rows - 1, math.floor((bottom + local_y) / size))
    first_column = max(0, math.ceil((left + local_x) / size) - 1)
    last_column = min(g.columns - 1, math.floor((right + local_x) / size))
    x = motion[CENTER_X] - other[CENTER_X] + local_x
    y = motion[CENTER_Y] - other[CENTER_Y] + local_y
    high_row = min(last_row, math.floor((y + reach) / size))
    low = max(first_column, math.floor((x - reach) / size))
    high = min(last_column, math.floor((x + reach) / size))
    depth = 0.0
    for line in range(max(first_row, math.floor((y - reach) / size)), high_row + 1):
        for column in range(low, high + 1):
            corners = place_tile(geometry, grid, line, column, local_x, local_y, stood, workspace)
            if corners > 0:
                depth = max(depth, depth_at_start(count, radius, corners, 0.0, workspace))
    best = MISS
    best_x = 0.0
    best_y = -1.0
    feature = -1
    for line in range(first_row, last_row + 1):
        for column in range(first_column, last_column + 1):
            corners = place_tile(geometry, grid, line, column, local_x, local_y, stood, workspace)
            if corners == 0:
                continue
            first = geometry.cells[g.offset + line * g.columns + column].first
            part = part_feature(line * g.columns + first, 0)
            if part == but:
                continue
            fraction, core = sweep_part(count, radius, corners, 0.0, half, depth, slack, workspace)
            if fraction < best:
                best = fraction
                best_x = -workspace.advance.gap.gap[NX]
                best_y = -workspace.advance.gap.gap[NY]
                feature = part
    return best, best_x, best_y, feature


@subkernel
def place_link(link, local_x, local_y, workspace):
    """Write the ends of a link to workspace.advance.local_b."""
    workspace.advance.local_b[0, 0] = link.ax - local_x
    workspace.advance.local_b[0, 1] = link.ay - local_y
    workspace.advance.local_b[1, 0] = link.bx - local_x
    workspace.advance.local_b[1, 1] = link.by - local_y


@subkernel
def ahead_of(ax, ay, bx, by, u, v):
    """How far a point is in front of the line from a to b, times its length."""
    return (by - ay) * (u - ax) - (bx - ax) * (v - ay)


@subkernel
def middle_of(count, corners):
    """The middle of so many corners [px]."""
    x = 0.0
    y = 0.0
    for k in range(count):
        x += corners[k, 0] / count
        y += corners[k, 1] / count
    return x, y


@subkernel
def is_before(link, local_x, local_y, middle, fraction, core, workspace):
    """Whether the mover's middle [px from its centre of mass], or its centre of mass, is in front of a link at a
    fraction of both motions. Beyond an end where the chain turns to its front, in front of the neighbour there as well.
    """
    motion = workspace.advance.motion_a
    other = workspace.advance.motion_b
    middle_x = 0.0
    middle_y = 0.0
    if not core:
        angle = motion[ANGLE] + fraction * motion[TURN]
        middle_x, middle_y = turned(middle[0], middle[1], math.cos(angle), math.sin(angle))
    angle = other[ANGLE] + fraction * other[TURN]
    x = motion[CENTER_X] - other[CENTER_X] + fraction * (motion[MOVE_X] - other[MOVE_X]) + middle_x
    y = motion[CENTER_Y] - other[CENTER_Y] + fraction * (motion[MOVE_Y] - other[MOVE_Y]) + middle_y
    u, v = turned(x, y, math.cos(angle), -math.sin(angle))
    u += local_x
    v += local_y
    if ahead_of(link.ax, link.ay, link.bx, link.by, u, v) < 0.0:
        return False
    tx = link.bx - link.ax
    ty = link.by - link.ay
    if link.has_after and tx * (u - link.bx) + ty * (v - link.by) > 0.0:
        if ahead_of(link.ax, link.ay, link.bx, link.by, link.after_x, link.after_y) > 0.0:
            return ahead_of(link.bx, link.by, link.after_x, link.after_y, u, v) >= 0.0
    if link.has_before and tx * (u - link.ax) + ty * (v - link.ay) < 0.0:
        if ahead_of(link.ax, link.ay, link.bx, link.by, link.before_x, link.before_y) > 0.0:
            return ahead_of(link.before_x, link.before_y, link.ax, link.ay, u, v) >= 0.0
    return True


@subkernel
def misses_block(box, local_x, local_y, left, top, right, bottom):
    """Whether the links of a block lie beside a box [px], seen from the chain's own moving point."""
    return (
        box.min_x - local_x > right
        or box.max_x - local_x < left
        or box.min_y - local_y > bottom
        or box.max_y - local_y < top
    )


@subkernel
def depth_in_chain(geometry, chain, local_x, local_y, middle, count, radius, workspace):
    """How deep [px] the mover stands in the links that its middle is in front of, before it moves."""
    span = geometry.chains[chain]
    motion = workspace.advance.motion_a
    other = workspace.advance.motion_b
    reach = reach_of(workspace.mover, count) + radius
    x, y = turned(
        motion[CENTER_X] - other[CENTER_X],
        motion[CENTER_Y] - other[CENTER_Y],
        math.cos(other[ANGLE]),
        -math.sin(other[ANGLE]),
    )
    depth = 0.0
    for block in range(span.blocks):
        box = geometry.link_blocks[span.first_block + block]
        if misses_block(box, local_x, local_y, x - reach, y - reach, x + reach, y + reach):
            continue
        first = span.offset + block * BLOCK_LINKS
        for k in range(first, min(first + BLOCK_LINKS, span.offset + span.count)):
            link = geometry.links[k]
            place_link(link, local_x, local_y, workspace)
            if is_before(link, local_x, local_y, middle, 0.0, False, workspace):
                depth = max(depth, depth_at_start(count, radius, 2, 0.0, workspace))
    return depth


@subkernel
def starts_across(geometry, chain, local_x, local_y, count, radius, slack, workspace):
    """Whether the mover lies deeper than slack [px] across a surface before it moves, so that it passes."""
    motion = workspace.advance.motion_a
    other = workspace.advance.motion_b
    u, v = turned(local_x, local_y, math.cos(other[ANGLE]), math.sin(other[ANGLE]))
    place_at(workspace.mover, count, motion, 0.0, motion[CENTER_X], motion[CENTER_Y], workspace.advance.a)
    return lies_across(
        geometry,
        chain,
        other[CENTER_X] - motion[CENTER_X] - u,
        other[CENTER_Y] - motion[CENTER_Y] - v,
        other[ANGLE],
        workspace.advance.a,
        count,
        radius,
        slack,
        workspace.advance.b,
    )


@subkernel
def sweep_chain(geometry, chain, local_x, local_y, count, radius, half, slack, but, workspace):
    """(fraction or MISS, normal from the chain, feature) of the mover against the links of a chain within reach, from
    their front. half, slack: see sweep_part; but: the feature that does not count, or -1. O(links near the way)."""
    middle = middle_of(count, workspace.mover)
    return sweep_chain_seen_from(geometry, chain, local_x, local_y, middle, count, radius, half, slack, but, workspace)


@subkernel
def sweep_chain_seen_from(geometry, chain, local_x, local_y, middle, count, radius, half, slack, but, workspace):
    """As sweep_chain, of a mover that is a piece of something: the middle of the whole, (x, y) [px] from its centre of
    mass at angle 0, decides which links it is in front of."""
    span = geometry.chains[chain]
    other = workspace.advance.motion_b
    reach = reach_of(workspace.mover, count) + radius
    turns = other[ANGLE] != 0.0 or other[TURN] != 0.0
    left, top, right, bottom = swept_box(reach, workspace.advance.motion_a, other)
    depth = depth_in_chain(geometry, chain, local_x, local_y, middle, count, radius, workspace)
    best = MISS
    best_x = 0.0
    best_y = -1.0
    feature = -1
    for block in range(span.blocks):
        box = geometry.link_blocks[span.first_block + block]
        if not turns and misses_block(box, local_x, local_y, left, top, right, bottom):
            continue
        first = span.offset + block * BLOCK_LINKS
        for k in range(first, min(first + BLOCK_LINKS, span.offset + span.count)):
            part = part_feature(k - span.offset, 0)
            if part == but:
                continue
            link = geometry.links[k]
            place_link(link, local_x, local_y, workspace)
            fraction, core = sweep_part(count, radius, 2, 0.0, half, depth, slack, workspace)
            # The point of a ray is on the link when it meets it: what counts is where it comes from.
            when = 0.0 if count == 1 and radius == 0.0 else fraction
            if fraction < best and is_before(link, local_x, local_y, middle, when, core, workspace):
                best = fraction
                best_x = -workspace.advance.gap.gap[NX]
                best_y = -workspace.advance.gap.gap[NY]
                feature = part
    return best, best_x, best_y, feature
