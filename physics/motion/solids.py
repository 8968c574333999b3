"""What stands in the way of a character: tiles, static and kinematic shapes, characters that can be pushed.

A character's box has whole pixels, so touching never blocks and overlapping by one pixel does. Boxes that are not
turned are rounded to whole pixels as they are drawn; everything else blocks where it overlaps by more than the slop.
"""

import math

from physics.jit import subkernel
from physics.masks.shapes import collide_mask_polygon
from physics.narrowphase.circles import collide_polygon_circle
from physics.narrowphase.placement import aabb_at, corners_at, raster_at, snapped
from physics.narrowphase.sat import ALL_EDGES, collide_polygons
from physics.math2d import turned
from physics.tables import CIRCLE, DYNAMIC, EMPTY, MASK, ONE_WAY, SLOPE, TILES

FREE, BLOCKED, ON_SLOPE = 0, 1, 2


@subkernel
def character_of(characters, body_row):
    """The row of the character whose body stands in that row, or -1."""
    for k in range(len(characters)):
        if characters[k].body_row == body_row:
            return k
    return -1


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
def in_tiles(geometry, grid, grid_x, grid_y, left, top, width, height, falling):
    """FREE, BLOCKED or ON_SLOPE for a box of pixels in a tile grid. falling: 1 when it moved here from one pixel above."""
    g = geometry.grids[grid]
    size = g.tile_size
    first_column = max(0, math.floor((left - grid_x) / size))
    last_column = min(g.columns - 1, math.ceil((left + width - grid_x) / size) - 1)
    first_row = max(0, math.floor((top - grid_y) / size))
    last_row = min(g.rows - 1, math.ceil((top + height - grid_y) / size) - 1)
    result = FREE
    for row in range(first_row, last_row + 1):
        for column in range(first_column, last_column + 1):
            cell = geometry.cells[g.offset + row * g.columns + column]
            if cell.kind == EMPTY:
                continue
            if cell.kind == ONE_WAY:
                if falling == 1 and top + height - 1 <= grid_y + row * size:
                    return BLOCKED
            elif cell.kind == SLOPE:
                tile_x = grid_x + column * size
                start = max(0.0, (left - tile_x) / size)
                end = min(1.0, (left + width - tile_x) / size)
                rise = max(cell.left + start * (cell.right - cell.left), cell.left + end * (cell.right - cell.left))
                if top + height > grid_y + (row + 1) * size - rise * size:
                    result = ON_SLOPE
            else:
                return BLOCKED
    return result


@subkernel
def in_shape(geometry, bodies, shapes, characters, row, left, top, width, height, falling, slop, scratch):
    """FREE, BLOCKED or ON_SLOPE for a box of pixels against one shape."""
    s = shapes[row]
    b = bodies[s.body_row]
    if s.kind == TILES:
        return in_tiles(geometry, s.geometry, b.x, b.y, left, top, width, height, falling)
    other = character_of(characters, s.body_row)
    if other >= 0:
        c = characters[other]
        hit = (left < c.left + c.width and c.left < left + width and top < c.top + c.height and c.top < top + height)
        return BLOCKED if hit else FREE
    scratch.b[0, 0] = left
    scratch.b[0, 1] = top
    scratch.b[1, 0] = left + width
    scratch.b[1, 1] = top
    scratch.b[2, 0] = left + width
    scratch.b[2, 1] = top + height
    scratch.b[3, 0] = left
    scratch.b[3, 1] = top + height
    if s.kind == CIRCLE:
        u, v = turned(s.local_x, s.local_y, math.cos(b.angle), math.sin(b.angle))
        hit, nx, ny, x, y, separation, feature = collide_polygon_circle(scratch.b, 4, ALL_EDGES, b.x + u, b.y + v, s.radius)
        return BLOCKED if hit and separation < -slop else FREE
    if s.kind == MASK:
        mask = raster_at(geometry, s.geometry, b.angle)
        r = geometry.rasters[mask]
        area, nx, ny, x, y, separation, first = collide_mask_polygon(
            geometry.rasters, geometry.words, mask, snapped(b.x, r.origin_x), snapped(b.y, r.origin_y), scratch.b, 4,
            ALL_EDGES, scratch.depths)
        return BLOCKED if area > 0 else FREE
    count = corners_at(geometry, shapes, row, b.x, b.y, b.angle, scratch.a)
    if is_upright_box(scratch.a, count):
        min_x, min_y, max_x, max_y = aabb_at(geometry, shapes, row, b.x, b.y, b.angle)
        hit = (left < round_half_up(max_x) and round_half_up(min_x) < left + width
               and top < round_half_up(max_y) and round_half_up(min_y) < top + height)
        return BLOCKED if hit else FREE
    points = collide_polygons(scratch.a, count, ALL_EDGES, scratch.b, 4, ALL_EDGES, 0.0, 0.0, math.inf, scratch.manifold)
    for k in range(points):
        if scratch.manifold[5 + 4 * k] < -slop:
            return BLOCKED
    return FREE


@subkernel
def gather_solids(geometry, bodies, shapes, characters, me, without, left, top, right, bottom, rows_out):
    """List the shape rows that may block a character within a rectangle [px]. Returns their number. O(shapes).

    me: row of the character; without: body row that does not count (the platform that moves it), or -1.
    """
    own = characters[me].body_row
    mine = own
    membership = 0
    mask = 0
    for row in range(len(shapes)):
        if shapes[row].body_row == mine:
            membership = shapes[row].membership
            mask = shapes[row].mask
            break
    found = 0
    for row in range(len(shapes)):
        s = shapes[row]
        b = bodies[s.body_row]
        if (s.sensor or s.body_row == own or s.body_row == without or b.kind == DYNAMIC or b.quarantined
                or (s.membership & mask) == 0 or (s.mask & membership) == 0):
            continue
        other = character_of(characters, s.body_row)
        if other >= 0 and not characters[other].pushable:
            continue
        min_x, min_y, max_x, max_y = aabb_at(geometry, shapes, row, b.x, b.y, b.angle)
        # One pixel around: boxes are rounded to the grid.
        if min_x - 1.0 < right and max_x + 1.0 > left and min_y - 1.0 < bottom and max_y + 1.0 > top:
            rows_out[found] = row
            found += 1
    return found


@subkernel
def blocked_at(geometry, bodies, shapes, characters, rows, count, left, top, width, height, falling, slop, scratch):
    """(what is in the way of a box of pixels: FREE, BLOCKED or ON_SLOPE; the shape row that is, or -1). A wall wins."""
    result = FREE
    by = -1
    for k in range(count):
        what = in_shape(geometry, bodies, shapes, characters, rows[k], left, top, width, height, falling, slop, scratch)
        if what == BLOCKED:
            return BLOCKED, rows[k]
        if what == ON_SLOPE:
            result = ON_SLOPE
            by = rows[k]
    return result, by
