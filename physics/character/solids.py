"""What stands in the way of a character: tiles, static and kinematic shapes, characters that can be pushed, bodies.

A character's box has whole pixels, so touching never blocks and overlapping by one pixel does. Boxes that are not
turned are rounded to whole pixels as they are drawn; everything else blocks where it overlaps by more than the slop.
In a world that stacks, bodies that are pushed or turn are loose: they may have come into the character by themselves,
so they block only a way that leads deeper, and nothing ever traps it.
"""

import math

from physics.collision.chains import collide_link_hull, link_at
from physics.collision.circles import collide_polygon_circle
from physics.collision.clipping import ALL_EDGES
from physics.collision.hulls import collide_hulls
from physics.collision.mask_hulls import collide_mask_polygon
from physics.jit import subkernel
from physics.math2d import turned
from physics.shapes.placement import aabb_at, corners_at, raster_at, rounding, snapped
from physics.tables.body import DYNAMIC, KINEMATIC
from physics.tables.geometry import EMPTY, ONE_WAY, SLOPE
from physics.tables.shape import CAPSULE, CHAIN, CIRCLE, MASK, SEGMENT, TILES

FREE, BLOCKED, ON_SLOPE = 0, 1, 2
FEET = 0.5  # [px] feet stand on the whole pixel nearest to a loose surface
LEADS_DEEPER = 0.02  # cosine between a way and a normal from which the way leads into what it meets


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
def in_chain(geometry, chain, x, y, angle, min_x, min_y, max_x, max_y, falling, slop, scratch):
    """FREE, BLOCKED or ON_SLOPE for a box of pixels, its corners in scratch.b, against a chain whose body is at a pose.

    A box moves by pixels and starts free, so what is deeper than one pixel behind a link came from its back, and passes;
    so does what rises through a level link. A link that climbs by no more than it runs can be walked up.
    """
    links = geometry.links
    span = geometry.chains[chain]
    cosine = math.cos(angle)
    sine = math.sin(angle)
    result = FREE
    for k in range(span.offset, span.offset + span.count):
        link_at(links, k, x, y, cosine, sine, scratch.a)
        ax = scratch.a[0, 0]
        ay = scratch.a[0, 1]
        run = scratch.a[1, 0] - ax
        rise = scratch.a[1, 1] - ay
        if (
            max(ax, ax + run) < min_x
            or min(ax, ax + run) > max_x
            or max(ay, ay + rise) < min_y
            or min(ay, ay + rise) > max_y
        ):
            continue
        carries = run > 0.0 and abs(rise) <= run
        if carries and abs(rise) <= 1e-9 * run and falling == 0:
            continue
        points = collide_link_hull(links[k], scratch.a, scratch.b, 4, 0.0, 0.0, 0.0, False, scratch.points)
        for point in range(points):
            if -1.0 - 2.0 * slop <= scratch.points[5 + 4 * point] < -slop:
                if not carries or abs(rise) <= 1e-9 * run:
                    return BLOCKED
                result = ON_SLOPE
    return result


@subkernel
def box_corners(left, top, width, height, corners_out):
    """The corners of a box of pixels."""
    corners_out[0, 0] = left
    corners_out[0, 1] = top
    corners_out[1, 0] = left + width
    corners_out[1, 1] = top
    corners_out[2, 0] = left + width
    corners_out[2, 1] = top + height
    corners_out[3, 0] = left
    corners_out[3, 1] = top + height


@subkernel
def is_loose(bodies, shapes, row):
    """Whether a shape, in a world that stacks, is tested as what it is and not on the pixel grid: it is pushed, or turns."""
    s = shapes[row]
    b = bodies[s.body_row]
    if b.kind == DYNAMIC:
        return True
    if b.kind != KINEMATIC or s.kind == TILES or s.kind == CHAIN:
        return False
    return (
        b.angle != 0.0
        or b.angular_velocity != 0.0
        or s.kind == CIRCLE
        or s.kind == CAPSULE
        or s.kind == SEGMENT
        or s.kind == MASK
    )


@subkernel
def meet(geometry, bodies, shapes, row, left, top, width, height, scratch):
    """(depth [px], normal from the box, the middle of what touches) of a box of pixels and a loose shape; depth 0: apart."""
    s = shapes[row]
    b = bodies[s.body_row]
    box_corners(left, top, width, height, scratch.b)
    if s.kind == CIRCLE:
        u, v = turned(s.local_x, s.local_y, math.cos(b.angle), math.sin(b.angle))
        hit, nx, ny, x, y, separation, feature = collide_polygon_circle(
            scratch.b, 4, ALL_EDGES, b.x + u, b.y + v, s.radius
        )
        return -separation if hit and separation < 0.0 else 0.0, nx, ny, x, y
    if s.kind == MASK:
        mask = raster_at(geometry, s.geometry, b.angle)
        r = geometry.rasters[mask]
        area, nx, ny, x, y, separation, first = collide_mask_polygon(
            geometry.rasters,
            geometry.words,
            mask,
            snapped(b.x, r.origin_x),
            snapped(b.y, r.origin_y),
            scratch.b,
            4,
            ALL_EDGES,
            scratch.depths,
        )
        return -separation if area > 0 else 0.0, -nx, -ny, x, y
    count = corners_at(geometry, shapes, row, b.x, b.y, b.angle, scratch.a)
    points = collide_hulls(
        scratch.b,
        4,
        0.0,
        ALL_EDGES,
        scratch.a,
        count,
        rounding(shapes, row),
        ALL_EDGES,
        0.0,
        0.0,
        math.inf,
        scratch.points,
    )
    if points == 0:
        return 0.0, 0.0, 0.0, 0.0, 0.0
    depth = -scratch.points[5]
    x = scratch.points[3]
    y = scratch.points[4]
    if points == 2:
        depth = max(depth, -scratch.points[9])
        x = 0.5 * (x + scratch.points[7])
        y = 0.5 * (y + scratch.points[8])
    return max(depth, 0.0), scratch.points[1], scratch.points[2], x, y


@subkernel
def in_loose(geometry, bodies, shapes, row, left, top, width, height, way_x, way_y, give, slop, scratch):
    """FREE, BLOCKED or ON_SLOPE for a box of pixels that moved by (way_x, way_y) pixels to where it meets a loose shape.

    give [px]: how much deeper it may be. What lies under it and is no steeper than 45 degrees can be walked up.
    """
    depth, nx, ny, x, y = meet(geometry, bodies, shapes, row, left, top, width, height, scratch)
    under = ny > abs(nx)
    allowed = give + (FEET if under else 0.1 * slop)
    if depth <= allowed or nx * way_x + ny * way_y <= LEADS_DEEPER:
        return FREE
    return ON_SLOPE if under else BLOCKED


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
        hit = left < c.left + c.width and c.left < left + width and top < c.top + c.height and c.top < top + height
        return BLOCKED if hit else FREE
    box_corners(left, top, width, height, scratch.b)
    if s.kind == CIRCLE:
        u, v = turned(s.local_x, s.local_y, math.cos(b.angle), math.sin(b.angle))
        hit, nx, ny, x, y, separation, feature = collide_polygon_circle(
            scratch.b, 4, ALL_EDGES, b.x + u, b.y + v, s.radius
        )
        return BLOCKED if hit and separation < -slop else FREE
    if s.kind == MASK:
        mask = raster_at(geometry, s.geometry, b.angle)
        r = geometry.rasters[mask]
        area, nx, ny, x, y, separation, first = collide_mask_polygon(
            geometry.rasters,
            geometry.words,
            mask,
            snapped(b.x, r.origin_x),
            snapped(b.y, r.origin_y),
            scratch.b,
            4,
            ALL_EDGES,
            scratch.depths,
        )
        return BLOCKED if area > 0 else FREE
    if s.kind == CHAIN:
        return in_chain(
            geometry, s.geometry, b.x, b.y, b.angle, left, top, left + width, top + height, falling, slop, scratch
        )
    count = corners_at(geometry, shapes, row, b.x, b.y, b.angle, scratch.a)
    radius = rounding(shapes, row)
    if radius == 0.0 and is_upright_box(scratch.a, count):
        min_x, min_y, max_x, max_y = aabb_at(geometry, shapes, row, b.x, b.y, b.angle)
        hit = (
            left < round_half_up(max_x)
            and round_half_up(min_x) < left + width
            and top < round_half_up(max_y)
            and round_half_up(min_y) < top + height
        )
        return BLOCKED if hit else FREE
    points = collide_hulls(
        scratch.a, count, radius, ALL_EDGES, scratch.b, 4, 0.0, ALL_EDGES, 0.0, 0.0, math.inf, scratch.points
    )
    for k in range(points):
        if scratch.points[5 + 4 * k] < -slop:
            return BLOCKED
    return FREE


@subkernel
def gather_solids(geometry, bodies, shapes, characters, me, without, piles, left, top, right, bottom, rows_out):
    """List the shape rows that may block a character within a rectangle [px]. Returns their number. O(shapes).

    me: row of the character; without: body row that does not count (the platform that moves it), or -1; piles: 1 in a
    world that stacks: dynamic bodies count. The row of a loose shape is listed as -1 - row.
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
        if (
            s.sensor
            or s.body_row == own
            or s.body_row == without
            or (b.kind == DYNAMIC and piles == 0)
            or b.quarantined
            or (s.membership & mask) == 0
            or (s.mask & membership) == 0
        ):
            continue
        other = character_of(characters, s.body_row)
        if other >= 0 and not characters[other].pushable:
            continue
        min_x, min_y, max_x, max_y = aabb_at(geometry, shapes, row, b.x, b.y, b.angle)
        # One pixel around: boxes are rounded to the grid.
        if min_x - 1.0 < right and max_x + 1.0 > left and min_y - 1.0 < bottom and max_y + 1.0 > top:
            rows_out[found] = -1 - row if piles == 1 and is_loose(bodies, shapes, row) else row
            found += 1
    return found


@subkernel
def blocked_at(
    geometry,
    bodies,
    shapes,
    characters,
    rows,
    count,
    left,
    top,
    width,
    height,
    way_x,
    way_y,
    falling,
    give,
    slop,
    scratch,
):
    """(what is in the way of a box of pixels: FREE, BLOCKED or ON_SLOPE; the shape row that is, or -1). A wall wins.

    rows from gather_solids; way_x, way_y: pixels it moved to get here; falling: 1 when one-way tiles hold it; give [px]:
    how deep it may be in what is loose.
    """
    result = FREE
    by = -1
    for k in range(count):
        row = rows[k] if rows[k] >= 0 else -1 - rows[k]
        if rows[k] < 0:
            what = in_loose(geometry, bodies, shapes, row, left, top, width, height, way_x, way_y, give, slop, scratch)
        else:
            what = in_shape(geometry, bodies, shapes, characters, row, left, top, width, height, falling, slop, scratch)
        if what == BLOCKED:
            return BLOCKED, row
        if what == ON_SLOPE:
            result = ON_SLOPE
            by = row
    return result, by
