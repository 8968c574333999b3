"""Continuous collision of a hull that moves and rotates against hulls, tiles, chains and shapes made of parts."""

import math
from typing import NamedTuple

import numpy as np

from physics.ccd.time_of_impact import (
    ANGLE,
    CENTER_X,
    CENTER_Y,
    MISS,
    MOVE_X,
    MOVE_Y,
    TOLERANCE,
    TOUCHING_BAND,
    TURN,
    AdvanceWorkspace,
    advance,
    approach_at,
    new_advance_workspace,
    place_at,
    reach_of,
    separate_at,
)
from physics.collision.chains import lies_across
from physics.collision.hulls import ALL_EDGES, Hull, middle_of, part_feature, write_normals
from physics.collision.tiles import tile_at
from physics.distance.gjk import FIRST_A, FIRST_B, NX, NY, copy_part
from physics.jit import kernel, subkernel
from physics.math2d import norm, rotate
from physics.shapes.placement import hull_at, is_hull, rounding
from physics.tables.body import DYNAMIC, RAY
from physics.tables.geometry import BLOCK_LINKS, EMPTY, ONE_WAY, Geometry
from physics.tables.shape import BOUNDS, CHAIN, PART, TILES
from physics.tables.step_state import CAP_HITS, GJK_ITERATIONS, TOI_CALLS

# ---- rotational ------------------------------------------------------------------------------------------------------
# The sweep of a hull that moves and rotates about its centre of mass: one rule for all obstacles.
#
# A mover may overlap a shape by the depth that it has at the start, plus a slop. If it gets deeper, it is moved back to
# the last fraction at which it was no deeper than at the start. So resting and sliding bodies are not held, and a body
# that overlaps at the start cannot break through. Seams between flush pieces of ground are not hit, because the mover
# is no deeper in one piece than in the whole ground. A very deep mover is swept by its core circle (Box2D v3) instead,
# so that its centre of mass never crosses a surface. The core circle is around the centre of mass, and its radius is a
# quarter of the smallest half extent. One-sided ground is hit only while the mover is in front of it.
#
# A mover that turns about the point at which it touches sinks a little on its path, because the path is not the arc of
# this point. If it were moved back to the depth at the start, it would not move at all, and the next step would be the
# same. So a mover that would be held at the start moves on until it is deeper by the slop (see is_held).

BEFORE = 2.0**-20  # fraction of the path before an impact that counts as "just before" it
SLAB = 4.0  # thickness of the slab behind a line, in slacks; the mover's depth in it is at most half of it
BEFORE_LINE = 0.25  # distance at which a line stops in front of another line, in slacks
BACKWARDS = 6  # most iterations of Newton's method in back_to; two or three are usual
CORE_LEFT = 0.9  # radius of a core circle that would overlap at the start, as a share of its centre's distance
CORE = 0.25  # radius of a core circle, as a share of the body's smallest half extent


class RotationalWorkspace(NamedTuple):
    """Scratch arrays for the sweep of one moving shape."""

    advance: AdvanceWorkspace
    mover: np.ndarray  # (16, 2) corners of the moving hull from its centre of mass [px], at angle 0


class Mover(NamedTuple):
    """The moving hull of a sweep. Its corners are in workspace.mover."""

    count: int  # number of corners
    radius: float  # [px] rounding
    half: float  # [px] smallest half extent of its body, which determines the core circle; 0: no core circle
    slack: float  # [px] depth allowed in addition to the depth at the start; 0: only rounding errors
    sinks: bool  # whether a mover that turns, and would be held at the start, moves on to this depth


class Sweep(NamedTuple):
    """Input of the sweeps of a step: candidate pairs, the paths of their bodies, and scratch arrays."""

    geometry: Geometry
    bodies: np.ndarray  # BODY
    shapes: np.ndarray  # SHAPE
    candidates: np.ndarray  # (n, 2) int64 shape rows
    stacking: bool  # two dynamic bodies are left to the solver unless one is a bullet
    one_way: bool  # one-way shapes take part
    slack: float  # [px] see Mover
    sinks: bool  # see Mover
    paths: np.ndarray  # (bodies, 7) centre of mass [px] and angle, at the start and at the end of the step, and the
    # rotation [rad] in the step that a sweep without rotation leaves out
    fast: np.ndarray  # (bodies,) bool: bodies to sweep
    cuts: np.ndarray  # (bodies, 6) the parts of two paths that are swept next
    workspace: RotationalWorkspace
    work: np.ndarray  # counters


def new_rotational_workspace() -> RotationalWorkspace:
    return RotationalWorkspace(new_advance_workspace(), np.zeros((16, 2)))


@subkernel
def write_motion(motions, body_row, motion_out):
    """Convert a body's motion from (start, end) to (start, change).

    motions (bodies, 6 or more): centre of mass x, y [px] and angle [rad] at the start, then at the end; body_row: row
    of the body; motion_out (6,): centre and angle at the start, then their changes.
    """
    motion_out[CENTER_X] = motions[body_row, 0]
    motion_out[CENTER_Y] = motions[body_row, 1]
    motion_out[ANGLE] = motions[body_row, 2]
    motion_out[MOVE_X] = motions[body_row, 3] - motions[body_row, 0]
    motion_out[MOVE_Y] = motions[body_row, 4] - motions[body_row, 1]
    motion_out[TURN] = motions[body_row, 5] - motions[body_row, 2]


@subkernel
def write_local(geometry, bodies, shapes, row, motion_inout, corners_out):
    """Write the corners [px] of a hull relative to its body's centre of mass at angle 0. Return their number.

    A shape of kind BOUNDS never rotates: the corners at the start angle are written, and the rotation in motion_inout
    (6,) is set to 0. row: row number in SHAPE. corners_out (16, 2): the result.
    """
    b = bodies[shapes[row].body_row]
    if shapes[row].kind != BOUNDS:
        return hull_at(geometry, shapes, row, -b.local_center_x, -b.local_center_y, 0.0, corners_out)
    angle = motion_inout[ANGLE]
    u, v = rotate(b.local_center_x, b.local_center_y, math.cos(angle), math.sin(angle))
    motion_inout[ANGLE] = 0.0
    motion_inout[TURN] = 0.0
    return hull_at(geometry, shapes, row, -u, -v, angle, corners_out)


@subkernel
def place_mover(count, workspace):
    """Copy the mover's corners from workspace.mover to workspace.advance.local_a, and reset the state of GJK.

    count: number of corners. Return the distance [px] of the farthest corner from the centre of mass.
    """
    for k in range(count):
        workspace.advance.local_a[k, 0] = workspace.mover[k, 0]
        workspace.advance.local_a[k, 1] = workspace.mover[k, 1]
    workspace.advance.gap.gap[FIRST_A] = 0.0
    workspace.advance.gap.gap[FIRST_B] = 0.0
    return reach_of(workspace.mover, count)


@subkernel
def ahead_of(ax, ay, bx, by, u, v):
    """Return the signed distance of the point (u, v) from the line a to b, times |b - a|; positive in front.

    ax, ay, bx, by: coordinates of the ends a and b of a chain link.
    """
    return (by - ay) * (u - ax) - (bx - ax) * (v - ay)


@subkernel
def is_line(mover):
    """Return whether a mover is a line without area, which two corners without rounding are."""
    return mover.count == 2 and mover.radius == 0.0


@subkernel
def thicken_line(mover, other_count, other_radius, workspace):
    """Return the number of corners of an obstacle after a line has become a thin slab for the sweep of another line.

    Two parallel lines that pass each other are never deep in each other. The slab is behind the obstacle, as seen from
    the middle of the mover at the start. The obstacle is in workspace.advance.local_b, with other_count corners and the
    rounding radius other_radius [px]; other obstacles stay as they are. mover: see sweep_part.
    """
    if other_count != 2 or other_radius != 0.0 or not is_line(mover):
        return other_count
    motion, other, line = workspace.advance.motion_a, workspace.advance.motion_b, workspace.advance.local_b
    tx, ty = line[1, 0] - line[0, 0], line[1, 1] - line[0, 1]
    length = norm(tx, ty)
    if length == 0.0:
        return other_count
    middle_x, middle_y = middle_of(workspace.mover, mover.count)
    u, v = rotate(middle_x, middle_y, math.cos(motion[ANGLE]), math.sin(motion[ANGLE]))
    u += motion[CENTER_X] - other[CENTER_X]
    v += motion[CENTER_Y] - other[CENTER_Y]
    u, v = rotate(u, v, math.cos(other[ANGLE]), -math.sin(other[ANGLE]))
    if ahead_of(line[0, 0], line[0, 1], line[1, 0], line[1, 1], u, v) < 0.0:
        for axis in range(2):
            line[0, axis], line[1, axis] = line[1, axis], line[0, axis]
        tx, ty = -tx, -ty
    size = reach_of(workspace.mover, mover.count) + reach_of(line, 2)
    size += norm(other[MOVE_X] - motion[MOVE_X], other[MOVE_Y] - motion[MOVE_Y])
    thick = SLAB * max(mover.slack, TOUCHING_BAND * size) / length
    for k in range(2):
        line[3 - k, 0] = line[k, 0] - thick * ty
        line[3 - k, 1] = line[k, 1] + thick * tx
    return 4


@subkernel
def depth_at_start(mover, other_count, other_radius, workspace):
    """Return how deep [px] the mover overlaps the hull in workspace.advance.local_b at the start; 0 without overlap.

    other_count, other_radius: number of corners and rounding radius [px] of this hull.
    """
    place_mover(mover.count, workspace)
    n = thicken_line(mover, other_count, other_radius, workspace)
    return max(0.0, -separate_at(mover.count, mover.radius, n, other_radius, 0.0, workspace.advance))


@subkernel
def sweep_core(core_radius, other_count, other_radius, workspace):
    """Return the fraction of the motion at which the mover's core circle hits a hull, or MISS.

    core_radius [px]: radius of the core circle, a small circle around the centre of mass. The hull is in
    workspace.advance.local_b, with other_count corners and the rounding radius other_radius [px]. The result is MISS if
    the centre is inside the hull at the start.

    If the circle would overlap the hull at the start, its radius is reduced to CORE_LEFT of the centre's distance from
    the hull. The centre then never crosses the surface. With half of the distance, 3 of 768 test rooms lost a body
    whose centre reached the wall step by step.
    """
    workspace.advance.local_a[0, 0] = 0.0
    workspace.advance.local_a[0, 1] = 0.0
    workspace.advance.gap.gap[FIRST_A] = 0.0
    workspace.advance.gap.gap[FIRST_B] = 0.0
    left = separate_at(1, 0.0, other_count, other_radius, 0.0, workspace.advance)
    if left <= 0.0:
        return MISS
    return advance(1, min(core_radius, CORE_LEFT * left), other_count, other_radius, workspace.advance)


@subkernel
def back_to(mover, other_count, other_radius, depth, fraction, size, workspace):
    """Return the last fraction before `fraction` at which the mover was only `depth` [px] deep (Newton's method).

    At `fraction` the mover is deeper. The iteration starts at `fraction`, because a search from the start could find an
    earlier contact with another side of the obstacle. The obstacle is in workspace.advance.local_b, with other_count
    corners and the rounding radius other_radius [px]; size [px]: sum of the extents of both shapes.
    """
    count, radius = mover.count, mover.radius
    gap = workspace.advance.gap.gap
    nx, ny = gap[NX], gap[NY]
    most = fraction
    separation = separate_at(count, radius, other_count, other_radius, fraction, workspace.advance)
    for _ in range(BACKWARDS):
        approach = approach_at(count, other_count, fraction, TOUCHING_BAND * size, workspace.advance)
        if approach <= 0.0 or abs(separation + depth) <= TOLERANCE * size:
            break
        fraction = min(max(0.0, fraction + (separation + depth) / approach), most)
        separation = separate_at(count, radius, other_count, other_radius, fraction, workspace.advance)
    if nx * gap[NX] + ny * gap[NY] < 0.5:
        gap[NX] = nx  # another side is nearer at this fraction, but the mover did not enter through it
        gap[NY] = ny
    return fraction


@subkernel
def is_held(motion_a, motion_b, fraction, reach, slack):
    """Return whether a mover makes less than `slack` [px] of its motion until `fraction`, so that it is held in place.

    motion_a, motion_b (6,): motions of the mover and of the obstacle, see write_motion; reach [px]: greatest distance
    of the mover's points from its centre of mass.
    """
    path = norm(motion_b[MOVE_X] - motion_a[MOVE_X], motion_b[MOVE_Y] - motion_a[MOVE_Y])
    return fraction * (path + reach * (abs(motion_a[TURN]) + abs(motion_b[TURN]))) <= slack


@subkernel
def sweep_part(mover, other_count, other_radius, depth, workspace):
    """Sweep the mover against a convex piece of an obstacle.

    Return (fraction of the motion at the impact or MISS, whether the core circle was swept). The piece is in
    workspace.advance.local_b, with other_count corners and the rounding radius other_radius [px]. depth [px]: depth of
    the mover in the whole obstacle at the start; an overlap with the piece up to this depth is not an impact.
    """
    count, radius, half, slack, sinks = mover
    reach = place_mover(count, workspace)
    if count == 1 and radius == 0.0:  # the point of a ray has no depth: touching is an impact
        fraction = advance(1, 0.0, other_count, other_radius, workspace.advance)
        if fraction <= 1.0:  # at the touch there is no normal, so the normal just before is used
            separate_at(1, 0.0, other_count, other_radius, max(0.0, fraction - BEFORE), workspace.advance)
        return fraction, False
    motion = workspace.advance.motion_a
    other = workspace.advance.motion_b
    n = thicken_line(mover, other_count, other_radius, workspace)
    size = reach + radius + reach_of(workspace.advance.local_b, n) + other_radius
    path = norm(other[MOVE_X] - motion[MOVE_X], other[MOVE_Y] - motion[MOVE_Y])
    # A line that sinks into another line is on its other side: none of the slack is left to it.
    sink = TOUCHING_BAND * (size + path) if n != other_count else max(slack, TOUCHING_BAND * (size + path))
    if half > 0.0:
        sink = min(sink, 0.5 * half)
        if sink + depth > (1.0 - CORE) * half:
            return sweep_core(CORE * half, n, other_radius, workspace), True
    fraction = advance(count, radius - sink - depth, n, other_radius, workspace.advance)
    if fraction > 1.0:
        return MISS, False
    if n != other_count:
        depth -= BEFORE_LINE * slack  # where two lines touch, and beyond, no contact knows their sides
    back = back_to(mover, n, other_radius, depth, fraction, size, workspace)
    turns = motion[TURN] != 0.0 or other[TURN] != 0.0
    if sinks and turns and n == other_count and is_held(motion, other, back, reach + radius, slack):
        separate_at(count, radius, n, other_radius, fraction, workspace.advance)
        return fraction, False
    return back, False


@subkernel
def swept_box(reach, motion_a, motion_b):
    """Return the AABB (min_x, min_y, max_x, max_y) [px] of the path of A relative to the centre of mass of B.

    reach [px]: greatest distance of A's points from its centre of mass; motion_a, motion_b (6,): see write_motion.
    """
    x, y = motion_a[CENTER_X] - motion_b[CENTER_X], motion_a[CENTER_Y] - motion_b[CENTER_Y]
    dx, dy = motion_a[MOVE_X] - motion_b[MOVE_X], motion_a[MOVE_Y] - motion_b[MOVE_Y]
    return (x + min(0.0, dx) - reach, y + min(0.0, dy) - reach, x + max(0.0, dx) + reach, y + max(0.0, dy) + reach)


# ---- rotational ground -----------------------------------------------------------------------------------------------
# The sweep of a hull against tiles and chains, piece by piece, by the rule under "rotational".


@subkernel
def feet_of(mover, local_y, workspace):
    """Return the y [px] of the mover's lowest point at the start, relative to the origin of a tile grid.

    local_y [px]: y of the grid's centre of mass in its body space; workspace: see RotationalWorkspace.
    """
    motion = workspace.advance.motion_a
    cosine, sine = math.cos(motion[ANGLE]), math.sin(motion[ANGLE])
    feet = -math.inf
    for k in range(mover.count):
        u, v = rotate(workspace.mover[k, 0], workspace.mover[k, 1], cosine, sine)
        feet = max(feet, v + mover.radius)
    return feet + motion[CENTER_Y] - workspace.advance.motion_b[CENTER_Y] + local_y


@subkernel
def place_tile(geometry, grid, line, column, local, stood, workspace):
    """Write the corners of a tile to workspace.advance.local_b. Return their number, or 0 for no obstacle.

    Only the top line of a one-way tile is written, and only if the mover started above it. grid: row of geometry.grids;
    line, column: row and column of the cell; local: see sweep_tiles. stood [px]: y of the mover's lowest point at the
    start, minus its slack.
    """
    g = geometry.grids[grid]
    kind = geometry.cells[g.offset + line * g.columns + column].kind
    if kind == EMPTY or (kind == ONE_WAY and stood > line * g.tile_size):
        return 0
    corners, edges = tile_at(geometry, grid, -local[0], -local[1], line, column, workspace.advance.local_b)
    if kind == ONE_WAY:
        return 2
    return 0 if edges == ALL_EDGES else corners  # covered on all sides, so it is never hit first


@subkernel
def sweep_tiles(geometry, grid, local, mover, one_way, but, workspace):
    """Return the first impact of the mover with a tile grid as (fraction of the motion or MISS, nx, ny, feature).

    The normal points from the tiles to the mover. grid: row of geometry.grids; local: centre of mass (x, y) [px] of the
    grid in its body space (a grid does not rotate); one_way: whether one-way tiles stop motion from above; but: feature
    id to ignore, or -1. O(cells in the mover's swept AABB). workspace: see RotationalWorkspace.
    """
    local_x, local_y = local
    g = geometry.grids[grid]
    size = g.tile_size
    motion = workspace.advance.motion_a
    other = workspace.advance.motion_b
    reach = reach_of(workspace.mover, mover.count) + mover.radius
    left, top, right, bottom = swept_box(reach, motion, other)
    falls = one_way and motion[MOVE_Y] > other[MOVE_Y]
    stood = feet_of(mover, local_y, workspace) - mover.slack if falls else math.inf
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
            corners = place_tile(geometry, grid, line, column, local, stood, workspace)
            if corners > 0:
                depth = max(depth, depth_at_start(mover, corners, 0.0, workspace))
    best = MISS
    best_x, best_y = 0.0, -1.0
    feature = -1
    for line in range(first_row, last_row + 1):
        for column in range(first_column, last_column + 1):
            corners = place_tile(geometry, grid, line, column, local, stood, workspace)
            if corners == 0:
                continue
            first = geometry.cells[g.offset + line * g.columns + column].first
            part = part_feature(line * g.columns + first, 0)
            if part == but:
                continue
            fraction, _ = sweep_part(mover, corners, 0.0, depth, workspace)
            if fraction < best:
                best = fraction
                best_x, best_y = -workspace.advance.gap.gap[NX], -workspace.advance.gap.gap[NY]
                feature = part
    return best, best_x, best_y, feature


@subkernel
def place_link(link, local, workspace):
    """Write both ends of a chain link to workspace.advance.local_b, relative to its body's centre of mass.

    link: LINK row; local: the centre of mass (x, y) [px] in body space.
    """
    workspace.advance.local_b[0, 0] = link.ax - local[0]
    workspace.advance.local_b[0, 1] = link.ay - local[1]
    workspace.advance.local_b[1, 0] = link.bx - local[0]
    workspace.advance.local_b[1, 1] = link.by - local[1]


@subkernel
def is_before(link, local, middle, fraction, core, workspace):
    """Return whether the mover is in front of a link at a fraction of the motion.

    One point of the mover is tested: its centre of mass if `core` is True, else the point `middle`. `middle` is (x, y)
    [px] relative to the centre of mass at angle 0. The chain may bend towards its front at an end of the link. A point
    beyond this end must then also be in front of the neighbouring link. link: LINK row; local: see sweep_chain;
    workspace: see RotationalWorkspace.
    """
    motion = workspace.advance.motion_a
    other = workspace.advance.motion_b
    middle_x, middle_y = 0.0, 0.0
    if not core:
        angle = motion[ANGLE] + fraction * motion[TURN]
        middle_x, middle_y = rotate(middle[0], middle[1], math.cos(angle), math.sin(angle))
    angle = other[ANGLE] + fraction * other[TURN]
    x = motion[CENTER_X] - other[CENTER_X] + fraction * (motion[MOVE_X] - other[MOVE_X]) + middle_x
    y = motion[CENTER_Y] - other[CENTER_Y] + fraction * (motion[MOVE_Y] - other[MOVE_Y]) + middle_y
    u, v = rotate(x, y, math.cos(angle), -math.sin(angle))
    u += local[0]
    v += local[1]
    if ahead_of(link.ax, link.ay, link.bx, link.by, u, v) < 0.0:
        return False
    tx, ty = link.bx - link.ax, link.by - link.ay
    if link.has_after and tx * (u - link.bx) + ty * (v - link.by) > 0.0:
        if ahead_of(link.ax, link.ay, link.bx, link.by, link.after_x, link.after_y) > 0.0:
            return ahead_of(link.bx, link.by, link.after_x, link.after_y, u, v) >= 0.0
    if link.has_before and tx * (u - link.ax) + ty * (v - link.ay) < 0.0:
        if ahead_of(link.ax, link.ay, link.bx, link.by, link.before_x, link.before_y) > 0.0:
            return ahead_of(link.before_x, link.before_y, link.ax, link.ay, u, v) >= 0.0
    return True


@subkernel
def misses_block(block, local, box):
    """Return whether the AABB of a block of links is disjoint from `box` (left, top, right, bottom) [px].

    block: LINK_BLOCK row; local: centre of mass (x, y) [px] of the chain's body, to which `box` is relative.
    """
    left, top, right, bottom = box
    x, y = local
    return block.min_x - x > right or block.max_x - x < left or block.min_y - y > bottom or block.max_y - y < top


@subkernel
def depth_in_chain(geometry, chain, local, middle, mover, workspace):
    """Return the greatest depth [px] at which the mover overlaps links of a chain that face the mover, at the start.

    A link faces the mover if is_before is True. geometry, chain, local: see sweep_chain; middle: see is_before;
    workspace: see RotationalWorkspace.
    """
    span = geometry.chains[chain]
    motion = workspace.advance.motion_a
    other = workspace.advance.motion_b
    reach = reach_of(workspace.mover, mover.count) + mover.radius
    x, y = rotate(
        motion[CENTER_X] - other[CENTER_X],
        motion[CENTER_Y] - other[CENTER_Y],
        math.cos(other[ANGLE]),
        -math.sin(other[ANGLE]),
    )
    box = (x - reach, y - reach, x + reach, y + reach)
    depth = 0.0
    for block in range(span.blocks):
        if misses_block(geometry.link_blocks[span.first_block + block], local, box):
            continue
        first = span.offset + block * BLOCK_LINKS
        for k in range(first, min(first + BLOCK_LINKS, span.offset + span.count)):
            link = geometry.links[k]
            place_link(link, local, workspace)
            if is_before(link, local, middle, 0.0, False, workspace):
                depth = max(depth, depth_at_start(mover, 2, 0.0, workspace))
    return depth


@subkernel
def starts_across(geometry, chain, local, mover, workspace):
    """Return whether the mover overlaps a one-way surface at the start by more than its slack, so that it may pass.

    chain: row of geometry.chains; local: see sweep_chain; workspace: see RotationalWorkspace.
    """
    count, radius, slack = mover.count, mover.radius, mover.slack
    motion = workspace.advance.motion_a
    other = workspace.advance.motion_b
    u, v = rotate(local[0], local[1], math.cos(other[ANGLE]), math.sin(other[ANGLE]))
    place_at(workspace.mover, count, motion, 0.0, motion[CENTER_X], motion[CENTER_Y], workspace.advance.a)
    x, y = other[CENTER_X] - motion[CENTER_X] - u, other[CENTER_Y] - motion[CENTER_Y] - v
    write_normals(count, workspace.advance.a)
    hull = Hull(workspace.advance.a, count, radius, ALL_EDGES)
    return lies_across(geometry, chain, x, y, other[ANGLE], hull, slack, workspace.advance.b)


@subkernel
def sweep_chain(geometry, chain, local, mover, but, workspace):
    """Return the first impact of the mover with a chain's front as (fraction of the motion or MISS, nx, ny, feature).

    The normal points from the chain to the mover. chain: row of geometry.chains; local: centre of mass (x, y) [px] of
    the chain's body in body space; but: feature id to ignore, or -1. O(links near the path). workspace: see
    RotationalWorkspace.
    """
    middle = middle_of(workspace.mover, mover.count)
    return sweep_chain_seen_from(geometry, chain, local, middle, mover, but, workspace)


@subkernel
def sweep_chain_seen_from(geometry, chain, local, middle, mover, but, workspace):
    """Return the first impact with a chain of a mover that is one piece of a larger moving shape. See sweep_chain.

    middle: point (x, y) [px] of the whole shape, relative to its centre of mass at angle 0. A link is hit only if this
    point is in front of the link. Other arguments: see sweep_chain.
    """
    span = geometry.chains[chain]
    other = workspace.advance.motion_b
    reach = reach_of(workspace.mover, mover.count) + mover.radius
    turns = other[ANGLE] != 0.0 or other[TURN] != 0.0
    box = swept_box(reach, workspace.advance.motion_a, other)
    depth = depth_in_chain(geometry, chain, local, middle, mover, workspace)
    best = MISS
    best_x, best_y = 0.0, -1.0
    feature = -1
    for block in range(span.blocks):
        if not turns and misses_block(geometry.link_blocks[span.first_block + block], local, box):
            continue
        first = span.offset + block * BLOCK_LINKS
        for k in range(first, min(first + BLOCK_LINKS, span.offset + span.count)):
            part = part_feature(k - span.offset, 0)
            if part == but:
                continue
            link = geometry.links[k]
            place_link(link, local, workspace)
            fraction, core = sweep_part(mover, 2, 0.0, depth, workspace)
            # The point of a ray is on the link at the impact, so its start determines the side. A parallel line is
            # on the link too, so the side just before the impact is used.
            when = 0.0 if mover.count == 1 and mover.radius == 0.0 else fraction
            if is_line(mover):
                when = max(0.0, fraction - BEFORE)
            if fraction < best and is_before(link, local, middle, when, core, workspace):
                best = fraction
                best_x, best_y = -workspace.advance.gap.gap[NX], -workspace.advance.gap.gap[NY]
                feature = part
    return best, best_x, best_y, feature


# ---- rotational pairs ------------------------------------------------------------------------------------------------
# Rotational continuous collision of one shape with any other shape, along the paths of their bodies.


@subkernel
def shrink_to_middle(count, mover_inout):
    """Replace the `count` corners in mover_inout by one point, their mean, which is swept as a ray. Return 1."""
    mover_inout[0, 0], mover_inout[0, 1] = middle_of(mover_inout, count)
    return 1


@subkernel
def sweep_hull(mover, core_b, n, radius_b, workspace):
    """Return the first impact (fraction of the motion, nx, ny) of the mover with another hull.

    The fraction is MISS without an impact. The other hull is in workspace.advance.local_b, with n corners and the
    rounding radius radius_b [px]. The normal points from the other hull to the mover. core_b [px]: radius of the other
    hull's core circle; 0: none.
    """
    depth = depth_at_start(mover, n, radius_b, workspace)
    fraction, core = sweep_part(mover, n, radius_b, depth, workspace)
    if core and fraction > 1.0 and core_b > 0.0:
        # For a deep overlap sweep core circle against core circle, so that the bodies do not pass each other.
        workspace.advance.local_b[0, 0] = 0.0
        workspace.advance.local_b[0, 1] = 0.0
        fraction = sweep_core(CORE * mover.half, 1, core_b, workspace)
    return fraction, -workspace.advance.gap.gap[NX], -workspace.advance.gap.gap[NY]


@subkernel
def stands_deep(row, other, sweep_inout):
    """Return whether two hulls overlap by more than sweep_inout.slack at the start of the step.

    row, other: row numbers in SHAPE.
    """
    geometry, bodies, shapes = sweep_inout.geometry, sweep_inout.bodies, sweep_inout.shapes
    workspace = sweep_inout.workspace
    r = workspace.advance
    write_motion(sweep_inout.paths, shapes[row].body_row, r.motion_a)
    write_motion(sweep_inout.paths, shapes[other].body_row, r.motion_b)
    count = write_local(geometry, bodies, shapes, row, r.motion_a, workspace.mover)
    n = write_local(geometry, bodies, shapes, other, r.motion_b, r.local_b)
    mover = Mover(count, rounding(shapes, row), 0.0, 0.0, False)
    return depth_at_start(mover, n, rounding(shapes, other), workspace) > sweep_inout.slack


@subkernel
def sweep_rotational(row, other, slack, but, sweep_inout):
    """Return the first impact (fraction, nx, ny, feature) of two shapes that move and rotate along sweep_inout.cuts.

    The fraction is that of these paths, or MISS; the normal points from `other` to `row`; feature: id of the tile or
    link, -1 for a hull. row, other: row numbers in SHAPE. The shape `row` must be a hull, and `other` a hull, tile grid
    or chain; otherwise the result is MISS. slack [px]: see Mover; but: feature id of a tile or link to ignore, or -1.
    """
    geometry, bodies, shapes = sweep_inout.geometry, sweep_inout.bodies, sweep_inout.shapes
    workspace = sweep_inout.workspace
    r = workspace.advance
    one_way = sweep_inout.one_way
    s, o = shapes[row], shapes[other]
    if not is_hull(s.kind) or not (is_hull(o.kind) or o.kind == TILES or o.kind == CHAIN):
        return MISS, 0.0, -1.0, -1
    sweep_inout.work[TOI_CALLS] += 1
    a, b = bodies[s.body_row], bodies[o.body_row]
    local = (b.local_center_x, b.local_center_y)
    write_motion(sweep_inout.cuts, s.body_row, r.motion_a)
    write_motion(sweep_inout.cuts, o.body_row, r.motion_b)
    mover = Mover(
        write_local(geometry, bodies, shapes, row, r.motion_a, workspace.mover),
        rounding(shapes, row),
        a.min_half_extent,
        slack,
        sweep_inout.sinks,
    )
    if a.continuous == RAY:
        mover = Mover(shrink_to_middle(mover.count, workspace.mover), 0.0, 0.0, slack, False)
    r.totals[0] = 0.0
    r.totals[1] = 0.0
    if o.kind == TILES:
        fraction, nx, ny, feature = sweep_tiles(geometry, o.geometry, local, mover, one_way, but, workspace)
    elif o.kind == CHAIN:
        if o.role == PART and (not one_way or starts_across(geometry, o.geometry, local, mover, workspace)):
            return MISS, 0.0, -1.0, -1
        fraction, nx, ny, feature = sweep_chain(geometry, o.geometry, local, mover, but, workspace)
    else:
        feature = -1
        n = write_local(geometry, bodies, shapes, other, r.motion_b, r.local_b)
        core_b = CORE * b.min_half_extent if b.kind == DYNAMIC else 0.0
        fraction, nx, ny = sweep_hull(mover, core_b, n, rounding(shapes, other), workspace)
    sweep_inout.work[GJK_ITERATIONS] += int(r.totals[0])
    sweep_inout.work[CAP_HITS] += int(r.totals[1])
    return fraction, nx, ny, feature


# ---- parts -----------------------------------------------------------------------------------------------------------
# First impact of two moving shapes made of parts.


@subkernel
def begin_sweep(workspace, impact_out):
    """Reset impact_out (3,) to MISS, and the counters of `workspace` to 0.

    Return the length [px] of the relative motion.
    """
    r = workspace.advance
    r.totals[0] = 0.0
    r.totals[1] = 0.0
    impact_out[0] = MISS
    impact_out[1] = 1.0
    impact_out[2] = 0.0
    return norm(r.motion_b[MOVE_X] - r.motion_a[MOVE_X], r.motion_b[MOVE_Y] - r.motion_a[MOVE_Y])


@subkernel
def keep_first(fraction, nx, ny, impact_out):
    """Write an impact (fraction, nx, ny) to impact_out (3,) if it is earlier than the impact stored there."""
    if fraction < impact_out[0]:
        impact_out[0] = fraction
        impact_out[1] = nx
        impact_out[2] = ny


@subkernel
def gap_at_start(a_count, a_radius, b_count, b_radius, workspace):
    """Return a lower bound [px] of the gap at the start between the hulls in workspace.advance.local_a and local_b.

    a_count, a_radius, b_count, b_radius: numbers of corners and rounding radii [px] of the two hulls.
    """
    r = workspace.advance
    place_at(r.local_a, a_count, r.motion_a, 0.0, r.motion_a[CENTER_X], r.motion_a[CENTER_Y], r.a)
    place_at(r.local_b, b_count, r.motion_b, 0.0, r.motion_a[CENTER_X], r.motion_a[CENTER_Y], r.b)
    spread = 0.0
    for k in range(1, a_count):
        spread = max(spread, norm(r.a[k, 0] - r.a[0, 0], r.a[k, 1] - r.a[0, 1]))
    wide = 0.0
    for k in range(1, b_count):
        wide = max(wide, norm(r.b[k, 0] - r.b[0, 0], r.b[k, 1] - r.b[0, 1]))
    return norm(r.b[0, 0] - r.a[0, 0], r.b[0, 1] - r.a[0, 1]) - spread - wide - a_radius - b_radius


@kernel
def advance_parts(a, b, workspace, impact_out):
    """Write the first impact of any part of A with any part of B to impact_out (3,). O(parts of A · parts of B).

    impact_out: fraction of the motion or MISS, nx and ny from A to B. a, b: Parts in body space; workspace:
    RotationalWorkspace with both motions, which also receives the counters. Pairs of parts are skipped if they cannot
    meet before the first impact found so far.
    """
    r = workspace.advance
    path = begin_sweep(workspace, impact_out)
    for i in range(len(a.counts)):
        copy_part(a.corners, i, a.counts[i], r.local_a)
        reach_a = reach_of(r.local_a, a.counts[i])
        for j in range(len(b.counts)):
            copy_part(b.corners, j, b.counts[j], r.local_b)
            apart = gap_at_start(a.counts[i], a.radii[i], b.counts[j], b.radii[j], workspace)
            travel = path + abs(r.motion_a[TURN]) * reach_a + abs(r.motion_b[TURN]) * reach_of(r.local_b, b.counts[j])
            if apart <= travel * min(1.0, impact_out[0]):
                fraction = advance(a.counts[i], a.radii[i], b.counts[j], b.radii[j], r)
                keep_first(fraction, r.gap.gap[NX], r.gap.gap[NY], impact_out)


@kernel
def sweep_unions(a, b, workspace, impact_out):
    """Write the first impact of two shapes whose parts may be flush, such as masks, to impact_out (3,).

    A motion that leads no deeper than the overlap at the start is not an impact (see "rotational" above). Seams between
    parts and grazing contacts are therefore not impacts. Arguments: see advance_parts. O(parts of A · parts of B).
    """
    r = workspace.advance
    path = begin_sweep(workspace, impact_out)
    depth = 0.0
    for i in range(len(a.counts)):
        mover = Mover(a.counts[i], a.radii[i], 0.0, 0.0, False)
        copy_part(a.corners, i, mover.count, r.local_a)
        copy_part(a.corners, i, mover.count, workspace.mover)
        for j in range(len(b.counts)):
            copy_part(b.corners, j, b.counts[j], r.local_b)
            if gap_at_start(mover.count, mover.radius, b.counts[j], b.radii[j], workspace) <= 0.0:
                depth = max(depth, depth_at_start(mover, b.counts[j], b.radii[j], workspace))
    for i in range(len(a.counts)):
        mover = Mover(a.counts[i], a.radii[i], 0.0, 0.0, False)
        copy_part(a.corners, i, mover.count, workspace.mover)
        for j in range(len(b.counts)):
            reach_a = place_mover(mover.count, workspace)
            copy_part(b.corners, j, b.counts[j], r.local_b)
            apart = gap_at_start(mover.count, mover.radius, b.counts[j], b.radii[j], workspace)
            travel = path + abs(r.motion_a[TURN]) * reach_a + abs(r.motion_b[TURN]) * reach_of(r.local_b, b.counts[j])
            if apart <= travel * min(1.0, impact_out[0]):
                fraction, _ = sweep_part(mover, b.counts[j], b.radii[j], depth, workspace)
                keep_first(fraction, r.gap.gap[NX], r.gap.gap[NY], impact_out)


@kernel
def advance_on_ground(geometry, ground, is_chain, a, workspace, impact_out):
    """Write the first impact of a shape made of parts with a tile grid or chain to impact_out (3,), see advance_parts.

    ground: row of geometry.grids, or of geometry.chains if is_chain is 1; a: Parts of the shape. Tiles are hit only on
    sides that no other tile covers. A chain is hit only from its front. workspace: see RotationalWorkspace.
    """
    begin_sweep(workspace, impact_out)
    for i in range(len(a.counts)):
        mover = Mover(a.counts[i], a.radii[i], 0.0, 0.0, False)
        copy_part(a.corners, i, mover.count, workspace.mover)
        if is_chain == 1:
            fraction, nx, ny, _ = sweep_chain(geometry, ground, (0.0, 0.0), mover, -1, workspace)
        else:
            fraction, nx, ny, _ = sweep_tiles(geometry, ground, (0.0, 0.0), mover, True, -1, workspace)
        keep_first(fraction, -nx, -ny, impact_out)
