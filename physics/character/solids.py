"""What stands in the way of a character: tiles, static and kinematic shapes, characters that can be pushed, bodies.

A character that is a box meets boxes that are not turned, and tiles, on the pixel grid, as they are drawn: touching
never blocks, one shared pixel does. Everything else is met as it is: what stands still blocks what would be deeper in
it than the slop. What is pushed, or moves and is no box, is loose: it may have come into the character by itself, so
it blocks only a way that leads deeper, and nothing that moves ever traps it.
"""

import math

from physics.character.chains import in_chain
from physics.character.ground import BLOCKED, FREE, allowed_depth, judge
from physics.character.meet import meet, meet_hull, place_outline
from physics.character.tiles import in_tile_outlines, in_tiles, on_pixels
from physics.character.workspace import character_of
from physics.collision.clipping import ALL_EDGES, LEFT
from physics.jit import subkernel
from physics.shapes.placement import aabb_at, corners_at
from physics.tables.body import DYNAMIC, KINEMATIC, STATIC
from physics.tables.shape import BOUNDS, CHAIN, PIXELS, POLYGON, TILES


@subkernel
def is_upright_box(corners, count):
    """Whether an outline is a box along the axes."""
    if count != 4:
        return False
    along_x = corners[0, 1] == corners[1, 1] and corners[2, 1] == corners[3, 1]
    along_y = corners[0, 0] == corners[1, 0] and corners[2, 0] == corners[3, 0]
    across_x = corners[1, 0] == corners[2, 0] and corners[3, 0] == corners[0, 0]
    across_y = corners[1, 1] == corners[2, 1] and corners[3, 1] == corners[0, 1]
    return (along_x and across_x) or (along_y and across_y)


@subkernel
def round_half_up(value):
    """The whole pixel nearest to a coordinate."""
    return math.floor(value + 0.5)


@subkernel
def is_box(walk, row):
    """Whether a shape stands in the world as a box along the axes."""
    s = walk.shapes[row]
    if s.kind == BOUNDS:
        return True
    if s.kind != POLYGON or s.radius != 0.0 or s.inner != 0:
        return False  # a part of an outline has its place beside its neighbours, not on the pixel grid
    b = walk.bodies[s.body_row]
    count = corners_at(walk.geometry, walk.shapes, row, b.x, b.y, b.angle, walk.scratch.theirs)
    return is_upright_box(walk.scratch.theirs, count)


@subkernel
def is_loose(walk, row):
    """Whether a shape is pushed, or moves in another way than by the whole pixels of its box."""
    s = walk.shapes[row]
    b = walk.bodies[s.body_row]
    if b.kind != KINEMATIC:
        return b.kind == DYNAMIC
    if b.angular_velocity != 0.0:
        return True
    return s.kind != TILES and not (b.angle == 0.0 and is_box(walk, row))


@subkernel
def aabb_of(walk, row):
    """AABB [px] of a shape where its body is now."""
    b = walk.bodies[walk.shapes[row].body_row]
    return aabb_at(walk.geometry, walk.shapes, row, b.x, b.y, b.angle)


@subkernel
def in_character(walk, me, other, left, top):
    """Whether the character, its box at a pixel, would be in another one."""
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
    """Whether a character that is a box shares a pixel with an upright box, as it is drawn."""
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
    """(FREE, STEEP, ON_SLOPE or BLOCKED, slope) of a character in a hull or a disc."""
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
    """(FREE, STEEP, ON_SLOPE or BLOCKED, slope) of a character against one shape.

    left, top: pixel of its box; way_x, way_y: pixels it moved to get there; give [px]: how deep it may be in what is
    loose, beyond its feet.
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
    """List the shape rows near a character that may block it within so many pixels of its box: their number, then they.

    without: body row that does not count (the platform that moves it), or -1. The row of a loose shape is listed as
    -1 - row. O(rows near).
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
        # One pixel around: boxes are rounded to the grid.
        if min_x - 1.0 < right and max_x + 1.0 > left and min_y - 1.0 < bottom and max_y + 1.0 > top:
            found += 1
            rows_out[found] = -1 - row if other < 0 and is_loose(walk, row) else row
    rows_out[0] = found


@subkernel
def blocked_at(walk, me, rows, left, top, way_x, way_y, give):
    """(what a place is to a character: FREE, STEEP, ON_SLOPE or BLOCKED; the shape row that is, or -1; its slope).

    rows: as gather lists them; the rest as in in_shape. What counts most decides. Where parts of a mask that stands
    still leave the place to their neighbours, and none of them tells it, it is deep inside.
    """
    result = FREE
    by = -1
    slope = 0.0
    owner = -1
    left_by = -1  # a part of this owner that has left it to its neighbours, while none has told it
    told = False
    for k in range(1, rows[0] + 1):
        row = rows[k] if rows[k] >= 0 else -1 - rows[k]
        s = walk.shapes[row]
        if s.owner != owner:
            if left_by >= 0:
                return BLOCKED, left_by, 0.0
            owner = s.owner
            told = False
        walk.scratch.points[0] = 0.0
        what, rise = in_shape(walk, me, row, left, top, way_x, way_y, give)
        if what == BLOCKED:
            return BLOCKED, row, 0.0
        if what != FREE and what >= result:
            result = what
            by = row
            slope = rise
        told = told or walk.scratch.points[0] > 0.0
        if s.inner != 0 and walk.scratch.points[0] == LEFT and walk.bodies[s.body_row].kind == STATIC:
            left_by = row
        if told:
            left_by = -1
    if left_by >= 0:
        return BLOCKED, left_by, 0.0
    return result, by, slope
