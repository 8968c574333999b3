"""Tests of a character against the solids that block it: tiles, chains, other shapes, and other characters."""

import math
from typing import NamedTuple

import numpy as np

from physics.collision.chains import (
    box_in_body,
    collide_link_circle,
    collide_link_hull,
    lies_across,
    link_at,
    misses_box,
)
from physics.collision.hull_pairs import collide_circles
from physics.collision.hulls import (
    ALL_EDGES,
    COVERED,
    COVERED_OVERLAP,
    Hull,
    collide_hull_circle,
    collide_hulls,
    pushing_edges,
    write_normals,
)
from physics.collision.manifold import POINTS
from physics.collision.tiles import pushing_edges_on_tile, run_at, tile_at
from physics.dynamics.integrate import is_finite_character
from physics.jit import kernel, subkernel
from physics.math2d import rotate
from physics.shapes.placement import aabb_at, box_corners, corners_at, hull_at, is_upright_box, round_half_up, rounding
from physics.tables.body import DYNAMIC, KINEMATIC, STATIC
from physics.tables.geometry import BLOCK_LINKS, EMPTY, ONE_WAY, SLOPE, Geometry
from physics.tables.shape import BOUNDS, CHAIN, CIRCLE, PART, PIXELS, POLYGON, TILES
from physics.tables.step_state import WorldTables
from physics.tables.table import row_of

# ---- ground ----------------------------------------------------------------------------------------------------------
# The kind of a position for a character: free, on ground that it walks on or slides down, or blocked by a wall.
# One rule holds for all ground: the normal there is compared with the steepest ground that the character walks on.

FREE, STEEP, ON_SLOPE, BLOCKED = 0, 1, 2, 3  # of several results for a position, the greatest is used
GIVE = 2.0  # [px] depth to which characters may sink into loose bodies (see is_loose), which the solver then moves
FEET = 0.5  # [px] greatest distance of the feet from a moving surface: they are on the nearest whole pixel
LEADS_DEEPER = 0.02  # cosine between motion and normal above which the motion leads into a dynamic body
SHEER = 1e-9  # cosine between a normal and the downward direction; below it the surface is a wall, not ground
EVEN = 1e-9  # rounding error of a slope
STEEPEST_CLIMB = (
    16.0  # [px] rise per px (86 degrees): characters never walk on steeper ground, which bounds the tests of a pixel
)


@subkernel
def pixels_along(slope):
    """Return the greatest number of whole pixels by which ground with a slope [px per px] rises or falls over 1 px."""
    return math.floor(abs(slope) + 1.0 + 1e-6)


@subkernel
def is_walkable(c, nx, ny):
    """Return whether a character (CHARACTER row c) can walk on a surface. (nx, ny): unit normal into the surface."""
    return ny > SHEER and abs(nx) <= c.climb * ny + EVEN


@subkernel
def verdict(c, nx, ny):
    """Classify a surface for a character (CHARACTER row c). Return (verdict, slope).

    verdict: ON_SLOPE (ground on which it can walk), STEEP (too steep to walk on) or BLOCKED (a wall); slope: rise of
    the surface per px to the right, 0 for a wall. nx, ny: unit normal into the surface.
    """
    if ny <= SHEER:
        return BLOCKED, 0.0
    slope = nx / ny + 0.0
    return ON_SLOPE if is_walkable(c, nx, ny) else STEEP, slope


@subkernel
def allowed_depth(c, loose, nx, ny, give, slop):
    """Return the depth [px] by which a character (CHARACTER row c) may overlap a surface without being blocked.

    loose: see is_loose; (nx, ny): unit normal into the surface; give: depth added for a loose shape [px]; slop [px].
    """
    if not loose:
        return slop
    return give + (FEET if is_walkable(c, nx, ny) else 0.1 * slop)


@subkernel
def deepest_of(b, slop, dt):
    """Return the greatest depth [px] by which a character that was free can overlap an outline of body b (BODY row).

    It is one pixel plus two slops [px]. For a body that is not static, GIVE and the motion in dt [s] are added. If the
    overlap with an edge of a part is deeper, a neighbouring part has the nearer surface, see hulls.collide_hulls.
    """
    if b.kind == STATIC:
        return 1.0 + 2.0 * slop
    return 1.0 + 2.0 * slop + GIVE + (abs(b.vx) + abs(b.vy) + abs(b.angular_velocity) * b.extent) * dt


@subkernel
def judge(c, kind, beyond, nx, ny, way_x, way_y):
    """Return (verdict, slope) for a character (CHARACTER row c) that overlaps a surface. See in_shape.

    A moving body may itself have caused the overlap, so it blocks only motion that leads deeper. kind: kind of the
    surface's body; beyond: overlap minus allowed_depth [px]; nx, ny: unit normal into the surface; way_x, way_y: pixels
    by which the character has just moved.
    """
    if beyond <= 0.0:
        return FREE, 0.0
    if kind != STATIC and nx * way_x + ny * way_y <= (LEADS_DEEPER if kind == DYNAMIC else EVEN):
        return FREE, 0.0
    return verdict(c, nx, ny)


# ---- meet ------------------------------------------------------------------------------------------------------------
# The depth and normal of a character in one shape: its outline against hulls, discs and links.


@subkernel
def place_outline(walk, me, left, top):
    """Write the corners [px] and normals of a character's outline, with its box at pixel (left, top), to scratch.mine.

    Return (number of corners, rounding radius [px]). walk: see Walk; me: row number of the character.
    """
    c = walk.characters[me]
    radius = 0.0
    if c.is_box:
        count = box_corners(left, top, left + c.width, top + c.height, walk.scratch.mine)
    else:
        x, y = left + c.offset_x, top + c.offset_y
        count = hull_at(walk.geometry, walk.shapes, c.shape_row, x, y, 0.0, walk.scratch.mine)
        radius = rounding(walk.shapes, c.shape_row)
    write_normals(count, walk.scratch.mine)
    return count, radius


@subkernel
def manifold_depth(points, manifold):
    """Return (greatest depth [px], unit normal nx, ny, midpoint x, y [px]) of a manifold; all 0 for no points.

    points: number of points of the manifold; manifold: (11,), see hulls.clip_edges.
    """
    if points == 0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    depth = -manifold[5]
    x, y = manifold[3], manifold[4]
    if points == 2:
        depth = max(depth, -manifold[9])
        x, y = 0.5 * (x + manifold[7]), 0.5 * (y + manifold[8])
    return max(depth, 0.0), manifold[1], manifold[2], x, y


@subkernel
def meet_disc(scratch, count, radius, x, y, other):
    """Return the overlap (depth, nx, ny, px, py) of a character's outline with a disc. For these values see meet.

    x, y, other: centre and radius of the disc [px]; count, radius: result of place_outline, which writes the outline.
    """
    mine = scratch.mine
    if count == 1:
        nx, ny, px, py, separation = collide_circles(mine[0, 0], mine[0, 1], radius, x, y, other)
        return max(-separation, 0.0), nx, ny, px, py
    hit, nx, ny, px, py, separation, feature = collide_hull_circle(Hull(mine, count, radius, ALL_EDGES), x, y, other)
    return -separation if hit and separation < 0.0 else 0.0, nx, ny, px, py


@subkernel
def meet_hull(scratch, count, radius, corners, rounded, edges, deepest):
    """Return the overlap (depth, nx, ny, x, y) of a character's outline with the hull in scratch.theirs. See meet.

    scratch.points[0] is set to COVERED_OVERLAP if a neighbouring part reports the contact. count, radius: result of
    place_outline, which writes the outline; corners, rounded: number of corners and rounding radius [px] of the hull;
    edges: see hulls.Hull; deepest: see hulls.collide_hulls.
    """
    mine = scratch.mine
    theirs = Hull(scratch.theirs, corners, rounded, edges)
    scratch.points[0] = 0.0
    if count == 1:
        hit, nx, ny, x, y, separation, feature = collide_hull_circle(theirs, mine[0, 0], mine[0, 1], radius)
        depth = -separation if hit and separation < 0.0 else 0.0
        if feature == COVERED or (edges != ALL_EDGES and depth > deepest):
            scratch.points[0] = COVERED_OVERLAP
            return 0.0, -nx, -ny, x, y
        scratch.points[0] = 1.0 if depth > 0.0 else 0.0
        return depth, -nx, -ny, x, y
    own = pushing_edges(Hull(mine, count, radius, ALL_EDGES), theirs, False)
    write_normals(corners, scratch.theirs)
    points = collide_hulls(Hull(mine, count, radius, own), theirs, 0.0, 0.0, deepest, scratch.points)
    return manifold_depth(points, scratch.points)


@subkernel
def meet_link(links, link, scratch, count, radius):
    """Return the overlap (depth, nx, ny, x, y) of a character's outline with a chain link. For these values see meet.

    The depth is 0 if the character is behind the link. links: LINK table; link: row number; scratch: Scratch with the
    ends of the link in scratch.theirs; count, radius: result of place_outline, which writes the outline.
    """
    if count == 1:
        hit, nx, ny, x, y, separation, feature = collide_link_circle(
            links[link], scratch.theirs, scratch.mine[0, 0], scratch.mine[0, 1], radius
        )
        return -separation if hit and separation < 0.0 else 0.0, -nx, -ny, x, y
    write_normals(2, scratch.theirs)
    hull = Hull(scratch.mine, count, radius, ALL_EDGES)
    points = collide_link_hull(links[link], scratch.theirs, hull, 0.0, 0.0, False, scratch.points)
    depth, nx, ny, x, y = manifold_depth(points, scratch.points)
    return depth, -nx, -ny, x, y


@subkernel
def meet(walk, row, count, radius):
    """Return the overlap of a character's outline with a hull or a disc: (depth [px], nx, ny, x, y).

    nx, ny: unit normal from the character into the shape; x, y: contact point [px]. The depth is 0 without an overlap.
    It is also 0 if a neighbouring part of the shape has the nearer surface; then scratch.points[0] is set to
    COVERED_OVERLAP. walk: see Walk; row: SHAPE row number; count, radius: result of place_outline.
    """
    s = walk.shapes[row]
    b = walk.bodies[s.body_row]
    if s.kind == CIRCLE:
        u, v = rotate(s.local_x, s.local_y, math.cos(b.angle), math.sin(b.angle))
        walk.scratch.points[0] = 0.0
        return meet_disc(walk.scratch, count, radius, b.x + u, b.y + v, s.radius)
    corners = corners_at(walk.geometry, walk.shapes, row, b.x, b.y, b.angle, walk.scratch.theirs)
    deepest = math.inf if s.inner == 0 else deepest_of(b, walk.settings.slop, walk.settings.dt)
    return meet_hull(walk.scratch, count, radius, corners, rounding(walk.shapes, row), ALL_EDGES ^ s.inner, deepest)


# ---- chains ----------------------------------------------------------------------------------------------------------
# Characters against chains, link by link.


@subkernel
def deepest_on(walk, body):
    """Return the greatest overlap [px] that a character can have with a chain link if it comes from the link's front.

    A character with a deeper overlap comes from the back. walk: see Walk; body: BODY row of the chain.
    """
    most = 1.0 + 2.0 * walk.settings.slop
    if body.kind == KINEMATIC:
        most += 1.0 + (abs(body.vx) + abs(body.vy) + abs(body.angular_velocity) * body.extent) * walk.settings.dt
    return most


@subkernel
def link_depth(walk, row, link, drops, count, radius):
    """Return the overlap of a character with a chain link: (depth [px], nx, ny), with the unit normal into the link.

    The depth is 0 if the link lets the character pass: if the overlap is deeper than deepest_on, because the character
    then comes from the back; and, if `drops` is True, for a level link or a one-way surface. walk: see Walk; row: SHAPE
    row number; link: LINK row number; count, radius: result of place_outline.
    """
    b = walk.bodies[walk.shapes[row].body_row]
    scratch = walk.scratch
    link_at(walk.geometry.links, link, b.x, b.y, math.cos(b.angle), math.sin(b.angle), scratch.theirs)
    run = scratch.theirs[1, 0] - scratch.theirs[0, 0]
    rise = scratch.theirs[1, 1] - scratch.theirs[0, 1]
    if drops and (walk.shapes[row].role == PART or (run > 0.0 and abs(rise) <= 1e-9 * run)):
        return 0.0, 0.0, 0.0
    depth, nx, ny, x, y = meet_link(walk.geometry.links, link, scratch, count, radius)
    return depth if depth <= deepest_on(walk, b) else 0.0, nx, ny


@subkernel
def is_across(walk, me, row, left, top):
    """Return whether a character, with its box at pixel (left, top), overlaps a one-way surface so far that it passes.

    The result is False for a chain (SHAPE row number `row`) that is not the surface of a one-way mask.
    """
    s = walk.shapes[row]
    if s.role != PART:
        return False
    b = walk.bodies[s.body_row]
    count, radius = place_outline(walk, me, left, top)
    # The character was free before it moved into a static shape: a deeper overlap has another cause, such as a drop.
    most = walk.settings.slop
    if b.kind == KINEMATIC:
        most = deepest_on(walk, b)
        # A link that moves down does not approach the characters on it, and does not lift characters that it passes.
        most -= max(0.0, b.vy * math.cos(b.angle) - b.vx * math.sin(b.angle)) * walk.settings.dt
    hull = Hull(walk.scratch.mine, count, radius, ALL_EDGES)
    return lies_across(walk.geometry, s.geometry, b.x, b.y, b.angle, hull, most, walk.scratch.theirs)


@subkernel
def in_chain(walk, me, row, left, top, way_x, way_y, give):
    """Return (verdict, slope) for a character at a chain. Arguments and result are described in in_shape."""
    c = walk.characters[me]
    s = walk.shapes[row]
    b = walk.bodies[s.body_row]
    if is_across(walk, me, row, c.left, c.top):
        return FREE, 0.0
    links = walk.geometry.links
    span = walk.geometry.chains[s.geometry]
    low_x, low_y, high_x, high_y = box_in_body(
        float(left),
        float(top),
        float(left + c.width),
        float(top + c.height),
        b.x,
        b.y,
        math.cos(b.angle),
        math.sin(b.angle),
    )
    count, radius = place_outline(walk, me, left, top)
    result = FREE
    slope = 0.0
    for block in range(span.blocks):
        box = walk.geometry.link_blocks[span.first_block + block]
        if misses_box(box.min_x, box.min_y, box.max_x, box.max_y, low_x, low_y, high_x, high_y):
            continue
        for k in range(span.offset + block * BLOCK_LINKS, span.offset + min(span.count, (block + 1) * BLOCK_LINKS)):
            link = links[k]
            if misses_box(link.ax, link.ay, link.bx, link.by, low_x, low_y, high_x, high_y):
                continue
            depth, nx, ny = link_depth(walk, row, k, c.drop, count, radius)
            allowed = allowed_depth(c, b.kind == KINEMATIC, nx, ny, give, walk.settings.slop)
            # Characters pass a link from its back, so it blocks only motion that leads deeper, like a moving shape.
            what, rise = judge(c, KINEMATIC, depth - allowed, nx, ny, way_x, way_y)
            if what == BLOCKED:
                return BLOCKED, 0.0
            if what != FREE and what >= result:
                result = what
                slope = rise
    return result, slope


@subkernel
def deepest_link(walk, me, row, left, top):
    """Return the deepest overlap (depth [px], nx, ny) of a character with any link of a chain. See link_depth."""
    c = walk.characters[me]
    span = walk.geometry.chains[walk.shapes[row].geometry]
    if is_across(walk, me, row, left, top):
        return 0.0, 0.0, 0.0
    count, radius = place_outline(walk, me, left, top)
    deepest = 0.0
    best_x, best_y = 0.0, 0.0
    for k in range(span.offset, span.offset + span.count):
        depth, nx, ny = link_depth(walk, row, k, c.drop, count, radius)
        if depth > deepest:
            deepest = depth
            best_x, best_y = nx, ny
    return deepest, best_x, best_y


# ---- tiles -----------------------------------------------------------------------------------------------------------
# Characters against tiles. A box is tested on the pixel grid; another outline is tested against each run of tiles as a
# polygon. On the pixel grid touching never blocks, but one shared pixel does. The greatest result of all tiles is used.


@subkernel
def on_pixels(kind, coordinate):
    """Return a body's coordinate [px] for tests on the pixel grid: rounded if `kind`, the body's kind, is KINEMATIC."""
    return float(math.floor(coordinate + 0.5)) if kind == KINEMATIC else coordinate


@subkernel
def is_falling(c, way_x, way_y):
    """Return 1 if a move (way_x, way_y) is straight down and without drop, so that one-way tiles stop it; else 0."""
    return 1 if way_x == 0 and way_y > 0 and not c.drop else 0


@subkernel
def slope_tile_verdict(c, slope, depth):
    """Return ON_SLOPE, STEEP or BLOCKED for a character whose feet are `depth` [px] below a slope tile's surface."""
    if depth > pixels_along(slope):
        return BLOCKED  # at its side, or inside
    return ON_SLOPE if abs(slope) <= c.climb + EVEN else STEEP


@subkernel
def in_tiles(walk, me, row, left, top, way_x, way_y):
    """Return (verdict, slope) for a box-shaped character at a tile grid. Arguments and result: see in_shape."""
    c = walk.characters[me]
    b = walk.bodies[walk.shapes[row].body_row]
    g = walk.geometry.grids[walk.shapes[row].geometry]
    grid_x, grid_y = on_pixels(b.kind, b.x), on_pixels(b.kind, b.y)
    size = g.tile_size
    falling = is_falling(c, way_x, way_y)
    first_column = max(0, math.floor((left - grid_x) / size))
    last_column = min(g.columns - 1, math.ceil((left + c.width - grid_x) / size) - 1)
    first_row = max(0, math.floor((top - grid_y) / size))
    last_row = min(g.rows - 1, math.ceil((top + c.height - grid_y) / size) - 1)
    result = FREE
    slope = 0.0
    for line in range(first_row, last_row + 1):
        for column in range(first_column, last_column + 1):
            cell = walk.geometry.cells[g.offset + line * g.columns + column]
            if cell.kind == EMPTY:
                continue
            if cell.kind == ONE_WAY:
                if falling == 1 and top + c.height - 1 <= grid_y + line * size:
                    return BLOCKED, 0.0
            elif cell.kind == SLOPE:
                tile_x = grid_x + column * size
                start = max(0.0, (left - tile_x) / size)
                end = min(1.0, (left + c.width - tile_x) / size)
                rise = max(cell.left + start * (cell.right - cell.left), cell.left + end * (cell.right - cell.left))
                depth = top + c.height - (grid_y + (line + 1) * size - rise * size)
                if depth > 0.0:
                    what = slope_tile_verdict(c, cell.right - cell.left, depth)
                    if what == BLOCKED:
                        return BLOCKED, 0.0
                    if what >= result:
                        result = what
                        slope = cell.right - cell.left
            else:
                return BLOCKED, 0.0
    return result, slope


@subkernel
def meet_tile(scratch, count, radius, corners, edges, deepest, is_slope):
    """Return the overlap (depth [px], nx, ny) of a character's outline with the tile in scratch.theirs.

    nx, ny: unit normal from the character into the tile; count, radius: result of place_outline; corners: number of
    corners of the tile; edges: see hulls.Hull; deepest: see hulls.collide_hulls; is_slope: whether the tile is a slope.
    """
    mine = scratch.mine
    tile = Hull(scratch.theirs, corners, 0.0, edges)
    if count == 1:
        hit, nx, ny, x, y, separation, feature = collide_hull_circle(tile, mine[0, 0], mine[0, 1], radius)
        return -separation if hit and separation < 0.0 else 0.0, -nx, -ny
    facing = ALL_EDGES
    if is_slope:
        facing = pushing_edges(Hull(mine, count, radius, ALL_EDGES), tile, False)
    elif edges != ALL_EDGES:
        facing = pushing_edges_on_tile(mine, count, edges)
    write_normals(corners, scratch.theirs)
    points = collide_hulls(tile, Hull(mine, count, radius, facing), 0.0, 0.0, deepest, scratch.points)
    depth, nx, ny, x, y = manifold_depth(points, scratch.points)
    return depth, -nx, -ny


@subkernel
def in_tile_outlines(walk, me, row, left, top, way_x, way_y):
    """Return (verdict, slope) for a character that is not a box at a tile grid. Arguments and result: see in_shape.

    The character is tested against the outlines of slope tiles and of runs of other tiles.
    """
    c = walk.characters[me]
    s = walk.shapes[row]
    b = walk.bodies[s.body_row]
    g = walk.geometry.grids[s.geometry]
    cells = walk.geometry.cells
    scratch = walk.scratch
    grid_x, grid_y = on_pixels(b.kind, b.x), on_pixels(b.kind, b.y)
    first_column = max(0, math.floor((left - grid_x) / g.tile_size))
    last_column = min(g.columns - 1, math.ceil((left + c.width - grid_x) / g.tile_size) - 1)
    first_row = max(0, math.floor((top - grid_y) / g.tile_size))
    last_row = min(g.rows - 1, math.ceil((top + c.height - grid_y) / g.tile_size) - 1)
    count, radius = place_outline(walk, me, left, top)
    result = FREE
    slope = 0.0
    for attempt in range(2):
        # If each tile left a deep overlap to its neighbour, test once more with all hull edges.
        deepest = 0.5 * g.tile_size if attempt == 0 else math.inf
        met = False
        for line in range(first_row, last_row + 1):
            next_column = first_column
            while next_column <= last_column:
                column = next_column
                cell = cells[g.offset + line * g.columns + column]
                next_column = cell.last + 1
                if cell.kind == EMPTY:
                    continue
                if cell.kind == ONE_WAY and (
                    is_falling(c, way_x, way_y) == 0 or top + c.height - 1 > grid_y + line * g.tile_size
                ):
                    continue
                if cell.kind == SLOPE:
                    next_column = column + 1
                    corners, edges = tile_at(walk.geometry, s.geometry, grid_x, grid_y, line, column, scratch.theirs)
                else:
                    under = (first_column, last_column)
                    corners, edges = run_at(
                        walk.geometry, s.geometry, grid_x, grid_y, line, column, under, scratch.theirs
                    )
                depth, nx, ny = meet_tile(
                    scratch, count, radius, corners, edges if attempt == 0 else ALL_EDGES, deepest, cell.kind == SLOPE
                )
                met = met or depth > 0.0
                what, rise = judge(c, b.kind, depth - walk.settings.slop, nx, ny, way_x, way_y)
                if what == BLOCKED:
                    return BLOCKED, 0.0
                if what != FREE and what >= result:
                    result = what
                    slope = rise
        if met:
            break
    return result, slope


# ---- workspace -------------------------------------------------------------------------------------------------------
# Walk: all arrays and values that the kernels of a character read and write, in one named context.


class Scratch(NamedTuple):
    """Scratch arrays for the test of a character against one shape."""

    mine: np.ndarray  # (16, 4) corners of the character [px], with normals where a test needs them: hulls.write_normals
    theirs: np.ndarray  # (16, 4) corners of the other shape
    points: np.ndarray  # (POINTS,) a manifold, see collision/hulls.py


class Settings(NamedTuple):
    """The effects and tolerances of a world on which the motion of characters depends."""

    stacking: int  # 1: dynamic bodies stop, carry and squeeze characters
    rotation: int  # 1: dynamic bodies rotate
    conveyor: int  # 1: surface speeds act
    dt: float  # [s] length of a move, or of the step
    slop: float  # [px]


class Walk(NamedTuple):
    """The tables, settings and scratch arrays that the kernels of characters read and write."""

    geometry: Geometry
    bodies: np.ndarray  # BODY, written: forces, and poses of characters
    shapes: np.ndarray  # SHAPE
    characters: np.ndarray  # CHARACTER, written
    near: np.ndarray  # nearby shape rows, character after character, ascending for each
    spans: np.ndarray  # (characters, 2) first index in near, and number of rows, of each character
    found: np.ndarray  # solids near a character, see solids.gather
    found_beside: np.ndarray  # the same for a character that another character moves
    scratch: Scratch
    settings: Settings


def new_scratch() -> Scratch:
    """Return the scratch arrays for the characters of one world."""
    return Scratch(np.zeros((16, 4)), np.zeros((16, 4)), np.zeros(POINTS))


def walk_for(tables: WorldTables, characters: np.ndarray, near: np.ndarray, spans: np.ndarray, dt: float) -> Walk:
    """Return the Walk for a motion of characters within dt [s]. tables: a World or a StepState.

    characters: CHARACTER table; near, spans: see Walk.
    """
    effects = tables.effects
    room = len(near) + 1
    rows = tables.workspace.rows_for(2 * room)
    return Walk(
        tables.library.tables,
        tables.bodies,
        tables.shapes,
        characters,
        near,
        spans,
        rows[:room],
        rows[room : 2 * room],
        tables.workspace.walk,
        Settings(int(effects.stacking), int(effects.rotation), int(effects.conveyor), dt, tables.tolerances.slop),
    )


@subkernel
def character_of(characters, body):
    """Return the CHARACTER row number of the character with the body id `body`, or -1. O(log characters)."""
    low, high = 0, len(characters)
    while low < high:
        middle = (low + high) // 2
        if characters[middle].body < body:
            low = middle + 1
        else:
            high = middle
    return low if low < len(characters) and characters[low].body == body else -1


@kernel
def can_walk(me, characters):
    """Return whether a character can move, which means that its numbers are finite and in range. me: its row number."""
    return is_finite_character(characters[me])


@kernel
def find_own_rows(bodies, shapes, characters_inout):
    """Write the row numbers of each character's body and shape to its CHARACTER row. O(characters · log shapes)."""
    for me in range(len(characters_inout)):
        c = characters_inout[me]
        c.body_row = row_of(bodies, c.body)
        c.shape_row = row_of(shapes, c.shape)


@subkernel
def place_body(c, body_inout):
    """Move the body of a character (CHARACTER row c) to the character's pixel box. body_inout: BODY row."""
    body_inout.x, body_inout.y = c.left + c.offset_x, c.top + c.offset_y
    body_inout.center_x = body_inout.x + body_inout.local_center_x
    body_inout.center_y = body_inout.y + body_inout.local_center_y


@subkernel
def settle(me, walk_inout):
    """Move the body of a character to the character's pixel box. me: row number of the character; walk_inout: Walk."""
    c = walk_inout.characters[me]
    place_body(c, walk_inout.bodies[c.body_row])


# ---- solids ----------------------------------------------------------------------------------------------------------
# Solids that block a character: tiles, static and kinematic shapes, pushable characters, bodies. A character that is a
# box is tested against upright boxes and tiles on the pixel grid, as they are drawn: touching never blocks, but one
# shared pixel does. Tests against other shapes are exact: a static shape blocks an overlap deeper than the slop. A
# dynamic shape, or a moving shape that is not a box, is loose: it may have moved into the character, so it blocks only
# motion that leads deeper. So a moving shape never traps a character.


@subkernel
def is_box(walk, row):
    """Return whether a shape (SHAPE row number) is an axis-aligned box at its present pose. walk: see Walk."""
    s = walk.shapes[row]
    if s.kind == BOUNDS:
        return True
    if s.kind != POLYGON or s.radius != 0.0 or s.inner != 0:
        return False  # parts of an outline meet at their seams, not on the pixel grid
    b = walk.bodies[s.body_row]
    count = corners_at(walk.geometry, walk.shapes, row, b.x, b.y, b.angle, walk.scratch.theirs)
    return is_upright_box(walk.scratch.theirs, count)


@subkernel
def is_loose(walk, row):
    """Return whether a shape (SHAPE row number) is loose: dynamic, or kinematic and not tested on the pixel grid.

    Kinematic tile grids and axis-aligned kinematic boxes are tested on the pixel grid unless they rotate. walk: Walk.
    """
    s = walk.shapes[row]
    b = walk.bodies[s.body_row]
    if b.kind != KINEMATIC:
        return b.kind == DYNAMIC
    if b.angular_velocity != 0.0:
        return True
    return s.kind != TILES and not (b.angle == 0.0 and is_box(walk, row))


@subkernel
def aabb_of(walk, row):
    """Return the AABB (min_x, min_y, max_x, max_y) [px] of a shape (SHAPE row number) at its present pose."""
    b = walk.bodies[walk.shapes[row].body_row]
    return aabb_at(walk.geometry, walk.shapes, row, b.x, b.y, b.angle)


@subkernel
def in_character(walk, me, other, left, top):
    """Return whether character `me`, with its box at pixel (left, top), overlaps character `other` (row numbers)."""
    c = walk.characters[me]
    o = walk.characters[other]
    hit = left < o.left + o.width and o.left < left + c.width and top < o.top + o.height and o.top < top + c.height
    if not hit or (c.is_box and o.is_box):
        return hit
    count, radius = place_outline(walk, me, left, top)
    depth, nx, ny, x, y = meet(walk, o.shape_row, count, radius)
    return depth > walk.settings.slop


@subkernel
def in_upright_box(walk, me, row, left, top):
    """Return whether a character's box at pixel (left, top) shares a pixel with the axis-aligned box in SHAPE `row`."""
    c = walk.characters[me]
    min_x, min_y, max_x, max_y = aabb_of(walk, row)
    return (
        left < round_half_up(max_x)
        and round_half_up(min_x) < left + c.width
        and top < round_half_up(max_y)
        and round_half_up(min_y) < top + c.height
    )


@subkernel
def in_hull(walk, me, row, left, top, way_x, way_y, give):
    """Return (verdict, slope) for a character at a hull or disc. Arguments and result are described in in_shape."""
    c = walk.characters[me]
    b = walk.bodies[walk.shapes[row].body_row]
    count, radius = place_outline(walk, me, left, top)
    loose = is_loose(walk, row)
    if b.kind == KINEMATIC and not loose:
        corners = corners_at(walk.geometry, walk.shapes, row, b.x, b.y, b.angle, walk.scratch.theirs)
        for k in range(corners):
            for axis in range(2):
                walk.scratch.theirs[k, axis] = on_pixels(b.kind, walk.scratch.theirs[k, axis])
        depth, nx, ny, x, y = meet_hull(walk.scratch, count, radius, corners, 0.0, ALL_EDGES, math.inf)
    else:
        depth, nx, ny, x, y = meet(walk, row, count, radius)
    return judge(c, b.kind, depth - allowed_depth(c, loose, nx, ny, give, walk.settings.slop), nx, ny, way_x, way_y)


@subkernel
def in_shape(walk, me, row, left, top, way_x, way_y, give):
    """Test a character at a position against one shape. Return (verdict, slope).

    verdict: FREE (no overlap), STEEP (overlap with ground too steep to walk on), ON_SLOPE (overlap with walkable
    ground) or BLOCKED; slope: rise of the shape's surface per px to the right. walk: see Walk; me: row number of the
    character; row: SHAPE row number; left, top: pixel of the character's box; way_x, way_y: pixels that the character
    moved to this position; give: depth allowed in a loose shape [px].
    """
    c = walk.characters[me]
    s = walk.shapes[row]
    b = walk.bodies[s.body_row]
    if s.kind == TILES:
        if c.is_box:
            return in_tiles(walk, me, row, left, top, way_x, way_y)
        return in_tile_outlines(walk, me, row, left, top, way_x, way_y)
    if b.kind == KINEMATIC:
        other = character_of(walk.characters, s.body)
        if other >= 0:
            return BLOCKED if in_character(walk, me, other, left, top) else FREE, 0.0
    if s.kind == CHAIN:
        return in_chain(walk, me, row, left, top, way_x, way_y, give)
    upright = b.kind == STATIC or (b.kind == KINEMATIC and b.angle == 0.0 and b.angular_velocity == 0.0)
    if c.is_box and upright and is_box(walk, row):
        return BLOCKED if in_upright_box(walk, me, row, left, top) else FREE, 0.0
    return in_hull(walk, me, row, left, top, way_x, way_y, give)


@subkernel
def gather(walk, me, without, reach_x, reach_up, reach_down, rows_out):
    """List the shapes that may block a character, within reach_x, reach_up, reach_down [px] of its box. O(nearby rows).

    rows_out: the number of shapes, then their SHAPE row numbers; a loose shape is listed as -1 - row. walk: see Walk;
    me: row number of the character; without: row number of a body to skip (which moves the character), or -1.
    """
    c = walk.characters[me]
    own = walk.shapes[c.shape_row]
    left = c.left - reach_x
    right = c.left + c.width + reach_x
    top = c.top - reach_up
    bottom = c.top + c.height + reach_down
    first = walk.spans[me, 0]
    found = 0
    for k in range(first, first + walk.spans[me, 1]):
        row = walk.near[k]
        s = walk.shapes[row]
        b = walk.bodies[s.body_row]
        if (
            s.sensor
            or s.role == PIXELS
            or s.body_row == c.body_row
            or s.body_row == without
            or (b.kind == DYNAMIC and walk.settings.stacking == 0)
            or b.quarantined
            or (s.membership & own.mask) == 0
            or (s.mask & own.membership) == 0
        ):
            continue
        other = character_of(walk.characters, s.body) if b.kind == KINEMATIC else -1
        if other >= 0 and not walk.characters[other].pushable:
            continue
        min_x, min_y, max_x, max_y = aabb_of(walk, row)
        # One pixel is added on each side, because boxes are rounded to the grid.
        if min_x - 1.0 < right and max_x + 1.0 > left and min_y - 1.0 < bottom and max_y + 1.0 > top:
            found += 1
            rows_out[found] = -1 - row if other < 0 and is_loose(walk, row) else row
    rows_out[0] = found


@subkernel
def blocked_at(walk, me, rows, left, top, way_x, way_y, give):
    """Test a character at a position against all nearby shapes. Return (verdict, SHAPE row number or -1, slope).

    The result is that of the shape with the greatest verdict, in the order FREE < STEEP < ON_SLOPE < BLOCKED. A
    position deep in a static mask, where each part leaves the contact to a neighbouring part, is BLOCKED. rows: see
    gather; other arguments, verdict and slope: see in_shape.
    """
    result = FREE
    by = -1
    slope = 0.0
    owner = -1
    left_by = -1  # a part of this mask that left the contact to its neighbours, if none of them has reported it
    meets = False
    for k in range(1, rows[0] + 1):
        row = rows[k] if rows[k] >= 0 else -1 - rows[k]
        s = walk.shapes[row]
        if s.parent != owner:
            if left_by >= 0:
                return BLOCKED, left_by, 0.0
            owner = s.parent
            meets = False
        walk.scratch.points[0] = 0.0
        what, rise = in_shape(walk, me, row, left, top, way_x, way_y, give)
        if what == BLOCKED:
            return BLOCKED, row, 0.0
        if what != FREE and what >= result:
            result = what
            by = row
            slope = rise
        meets = meets or walk.scratch.points[0] > 0.0
        if s.inner != 0 and walk.scratch.points[0] == COVERED_OVERLAP and walk.bodies[s.body_row].kind == STATIC:
            left_by = row
        if meets:
            left_by = -1
    if left_by >= 0:
        return BLOCKED, left_by, 0.0
    return result, by, slope
