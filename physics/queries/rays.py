"""A ray against every shape: closed forms for circles, other hulls and lines, cell by cell for tiles.

Source of the cell walk: Amanatides and Woo, A Fast Voxel Traversal Algorithm, 1987.
"""

import math

from physics.ccd.closed_form import MISS, sweep_circle_polygon
from physics.collision.clipping import ALL_EDGES
from physics.collision.tiles import tile_at
from physics.jit import subkernel
from physics.math2d import cosine_and_sine, turned, unit
from physics.queries.ray_lines import cast_on_chain, cast_on_disc, cast_on_hull
from physics.raster.bits import is_set
from physics.shapes.mask_pose import into_raster, raster_of_shape
from physics.shapes.placement import corners_at, raster_at, rounding, snapped
from physics.tables.geometry import BLOCK_LINKS, EMPTY, ONE_WAY, SLOPE, SOLID
from physics.tables.shape import CHAIN, CIRCLE, MASK, TILES


@subkernel
def enter_box(x, y, dx, dy, width, height):
    """Where a ray enters and leaves the box 0..width, 0..height: (enter, leave), enter > leave when it misses."""
    enter = 0.0
    leave = 1.0
    for axis in range(2):
        position = x if axis == 0 else y
        step = dx if axis == 0 else dy
        size = width if axis == 0 else height
        if step == 0.0:
            if position < 0.0 or position > size:
                return 1.0, 0.0
        else:
            near = (0.0 - position) / step
            far = (size - position) / step
            enter = max(enter, min(near, far))
            leave = min(leave, max(near, far))
    return enter, leave


@subkernel
def next_border(position, step, cell, size):
    """Fraction at which a ray leaves a cell along one axis; infinite when it runs along the other."""
    if step > 0.0:
        return ((cell + 1) * size - position) / step
    if step < 0.0:
        return (cell * size - position) / step
    return math.inf


@subkernel
def start_cell(position, step, size, count):
    """The cell a ray starts in, or enters first; on a border it is the one that it moves into."""
    at = position / size
    cell = math.floor(at)
    if step < 0.0 and cell == at:
        cell -= 1
    return max(0, min(count - 1, cell))


@subkernel
def cast_on_cell(geometry, grid, row, column, x, y, dx, dy, corners_inout):
    """A ray, seen from the grid's origin [px], against a cell: (fraction or MISS, normal). One-way from above."""
    g = geometry.grids[grid]
    if row < 0 or row >= g.rows or column < 0 or column >= g.columns:
        return MISS, 0.0, -1.0
    kind = geometry.cells[g.offset + row * g.columns + column].kind
    if kind == EMPTY or (kind == ONE_WAY and not (dy > 0.0 and y <= row * g.tile_size)):
        return MISS, 0.0, -1.0
    count, edges = tile_at(geometry, grid, 0.0, 0.0, row, column, corners_inout)
    return sweep_circle_polygon(corners_inout, count, ALL_EDGES, x, y, dx, dy, 0.0)


@subkernel
def cast_on_tiles(geometry, grid, x, y, dx, dy, corners_inout):
    """A ray, seen from the grid's origin [px], against its tiles, which are closed: (fraction or MISS, normal).

    A ray along a border meets the tiles on both sides, one through a corner all four: the cells around each crossing
    are asked too. O(cells on the way).
    """
    g = geometry.grids[grid]
    size = g.tile_size
    enter, leave = enter_box(x, y, dx, dy, g.columns * size, g.rows * size)
    if enter > leave:
        return MISS, 0.0, -1.0
    column = start_cell(x + enter * dx, dx, size, g.columns)
    row = start_cell(y + enter * dy, dy, size, g.rows)
    step_x = 1 if dx > 0.0 else -1
    step_y = 1 if dy > 0.0 else -1
    best = MISS
    best_x = 0.0
    best_y = -1.0
    while 0 <= column < g.columns and 0 <= row < g.rows:
        # This cell and its neighbours: a border belongs to both sides.
        for j in range(-1, 2):
            for i in range(-1, 2):
                fraction, nx, ny = cast_on_cell(geometry, grid, row + j, column + i, x, y, dx, dy, corners_inout)
                if fraction < best:
                    best = fraction
                    best_x = nx
                    best_y = ny
        across = next_border(x, dx, column, size)
        down = next_border(y, dy, row, size)
        # What was found further on may still be beaten by a cell between.
        if best <= min(across, down) or min(across, down) > leave:
            break
        if across < down:
            column += step_x
        else:
            row += step_y
    return best, best_x, best_y


@subkernel
def is_solid_at(rasters, words, mask, x, y):
    """Whether a point, seen from the raster's corner [px], lies in a solid pixel: [i, i + 1) x [j, j + 1)."""
    r = rasters[mask]
    if not (0.0 <= x < r.width and 0.0 <= y < r.height):
        return False
    return is_set(words, r.offset + math.floor(y) * r.stride, math.floor(x))


@subkernel
def is_in_mask(geometry, shape, body, x, y):
    """Whether a point [px] lies in a solid pixel of a mask, as drawn where it is snapped."""
    if not shape.snap:
        mask = raster_of_shape(geometry, shape)
        cosine, sine = cosine_and_sine(body.angle, body.angle)
        u, v = into_raster(geometry.rasters[mask], body, cosine, sine, x, y)
        return is_solid_at(geometry.rasters, geometry.words, mask, u, v)
    mask = raster_at(geometry, shape.geometry, body.angle)
    r = geometry.rasters[mask]
    return is_solid_at(
        geometry.rasters, geometry.words, mask, x - snapped(body.x, r.origin_x), y - snapped(body.y, r.origin_y)
    )


@subkernel
def inside_polygon(corners, count, x, y):
    """Whether a point lies in a closed convex polygon, clockwise on the screen."""
    for k in range(count):
        n = k + 1 if k + 1 < count else 0
        ex = corners[n, 0] - corners[k, 0]
        ey = corners[n, 1] - corners[k, 1]
        if ey * (x - corners[k, 0]) - ex * (y - corners[k, 1]) > 0.0:
            return False
    return True


@subkernel
def point_in_tiles(geometry, grid, x, y, corners_inout):
    """Whether a point, seen from the grid's origin [px], lies in a closed solid tile or slope."""
    g = geometry.grids[grid]
    column = math.floor(x / g.tile_size)
    row = math.floor(y / g.tile_size)
    # On a border the tile before it holds the point too.
    first_column = column - 1 if column * g.tile_size == x else column
    first_row = row - 1 if row * g.tile_size == y else row
    for j in range(max(0, first_row), min(g.rows - 1, row) + 1):
        for i in range(max(0, first_column), min(g.columns - 1, column) + 1):
            kind = geometry.cells[g.offset + j * g.columns + i].kind
            if kind == SOLID:
                return True
            if kind == SLOPE:
                count, edges = tile_at(geometry, grid, 0.0, 0.0, j, i, corners_inout)
                if inside_polygon(corners_inout, count, x, y):
                    return True
    return False


@subkernel
def cast_on_shape(geometry, bodies, shapes, row, x, y, dx, dy, corners_inout):
    """A ray from (x, y) by (dx, dy) [px] against a shape: (fraction or MISS, normal). No length: of the point.

    A mask is asked for points alone: rays are cast at its outline.
    """
    s = shapes[row]
    b = bodies[s.body_row]
    point = dx == 0.0 and dy == 0.0
    back_x, back_y = unit(-dx, -dy, 0.0, -1.0)
    if s.kind == CIRCLE:
        u, v = turned(s.local_x, s.local_y, math.cos(b.angle), math.sin(b.angle))
        return cast_on_disc(x - b.x - u, y - b.y - v, dx, dy, s.radius)
    if s.kind == TILES:
        if point_in_tiles(geometry, s.geometry, x - b.x, y - b.y, corners_inout):
            return 0.0, back_x, back_y
        if point:
            return MISS, 0.0, -1.0
        return cast_on_tiles(geometry, s.geometry, x - b.x, y - b.y, dx, dy, corners_inout)
    if s.kind == MASK:
        return 0.0 if is_in_mask(geometry, s, b, x, y) else MISS, 0.0, -1.0
    if s.kind == CHAIN:
        return cast_on_chain(
            geometry.chains,
            geometry.links,
            geometry.link_blocks,
            s.geometry,
            x - b.x,
            y - b.y,
            math.cos(b.angle),
            math.sin(b.angle),
            dx,
            dy,
            BLOCK_LINKS,
        )
    count = corners_at(geometry, shapes, row, b.x, b.y, b.angle, corners_inout)
    radius = rounding(shapes, row)
    if count == 2 or radius > 0.0:
        return cast_on_hull(corners_inout, count, radius, x, y, dx, dy)
    if inside_polygon(corners_inout, count, x, y):
        return 0.0, back_x, back_y
    if point:
        return MISS, 0.0, -1.0
    return sweep_circle_polygon(corners_inout, count, ALL_EDGES, x, y, dx, dy, 0.0)
