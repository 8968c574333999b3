"""Ray casts at single shapes of every kind: circles, hulls, lines, chains, tiles and pixels.

A ray cast returns (fraction, nx, ny): the fraction of the ray's vector before the hit, and the unit normal of the
surface that was hit. The fraction MISS, a number greater than 1, means no hit.
"""

import math

from physics.ccd.time_of_impact import MISS, cast_on_polygon, sweep_circle_polygon, sweep_circles
from physics.collision.hulls import ALL_EDGES, Hull, collide_hull_circle, distance_to_edge, edge_normal
from physics.collision.tiles import tile_at
from physics.jit import subkernel
from physics.math2d import cosine_and_sine, rotate, unit
from physics.raster.bits import is_set
from physics.shapes.placement import corners_at, into_raster, raster_at, raster_of_shape, rounding, snapped
from physics.tables.geometry import BLOCK_LINKS, EMPTY, ONE_WAY, SLOPE, SOLID
from physics.tables.shape import CHAIN, CIRCLE, MASK, TILES

# ---- ray lines -------------------------------------------------------------------------------------------------------
# A ray against lines and rounded hulls: segments from both sides, links of a chain from the front, capsules.


@subkernel
def cast_on_line(ax, ay, bx, by, x, y, dx, dy):
    """Return the fraction at which a ray hits the line segment from (ax, ay) to (bx, by), ends included, or MISS.

    x, y, dx, dy: start and vector of the ray [px]. The test compares the sides of the ray on which the two ends are, so
    no ray passes between two segments with a common end. A ray along the segment hits the nearer end. A ray that starts
    on the segment hits at fraction 0.
    """
    side_a, side_b = dx * (ay - y) - dy * (ax - x), dx * (by - y) - dy * (bx - x)
    if (side_a > 0.0 and side_b > 0.0) or (side_a < 0.0 and side_b < 0.0):
        return MISS
    across = side_b - side_a
    if across != 0.0:
        fraction = ((ax - x) * (by - ay) - (ay - y) * (bx - ax)) / across
        return fraction if 0.0 <= fraction <= 1.0 else MISS
    square = dx * dx + dy * dy
    if square == 0.0:
        return MISS
    to_a, to_b = (dx * (ax - x) + dy * (ay - y)) / square, (dx * (bx - x) + dy * (by - y)) / square
    near = min(to_a, to_b)
    far = max(to_a, to_b)
    if far < 0.0 or near > 1.0:
        return MISS
    return max(0.0, near)


@subkernel
def cast_on_segment(corners, x, y, dx, dy):
    """Cast a ray at a two-sided segment. Return (fraction or MISS, nx, ny).

    The normal points towards the start of the ray. corners: the first two rows are the ends of the segment [px]; x, y,
    dx, dy: start and vector of the ray [px].
    """
    back_x, back_y = unit(-dx, -dy, 0.0, -1.0)
    if distance_to_edge(corners[0, 0], corners[0, 1], corners[1, 0], corners[1, 1], x, y) == 0.0:
        return 0.0, back_x, back_y
    fraction = cast_on_line(corners[0, 0], corners[0, 1], corners[1, 0], corners[1, 1], x, y, dx, dy)
    nx, ny = edge_normal(corners, 2, 0)
    facing = nx * dx + ny * dy
    if facing == 0.0:
        return fraction, back_x, back_y
    return fraction, nx if facing < 0.0 else -nx, ny if facing < 0.0 else -ny


@subkernel
def cast_on_disc(x, y, dx, dy, radius):
    """Cast a ray at a disc around (0, 0). Return (fraction or MISS, nx, ny).

    A ray that starts inside the disc hits at fraction 0, with a normal opposite to the ray. x, y, dx, dy: start and
    vector of the ray [px]; radius: radius of the disc [px].
    """
    if x * x + y * y <= radius * radius:
        back_x, back_y = unit(-dx, -dy, 0.0, -1.0)
        return 0.0, back_x, back_y
    return sweep_circles(x, y, dx, dy, radius)


@subkernel
def cast_on_hull(corners, count, radius, x, y, dx, dy):
    """Cast a ray at a rounded hull with at least two corners. Return (fraction or MISS, nx, ny).

    A ray that starts inside the hull hits at fraction 0, with a normal opposite to the ray. A ray of zero length tests
    whether its start is inside. corners: corners [px], of which the first `count` are in use; radius: rounding radius
    [px]; x, y, dx, dy: start and vector of the ray [px].
    """
    if radius == 0.0 and count == 2:
        return cast_on_segment(corners, x, y, dx, dy)
    back_x, back_y = unit(-dx, -dy, 0.0, -1.0)
    _, _, _, _, _, separation, _ = collide_hull_circle(Hull(corners, count, radius, ALL_EDGES), x, y, 0.0)
    if separation <= 0.0:
        return 0.0, back_x, back_y
    if dx == 0.0 and dy == 0.0:
        return MISS, 0.0, -1.0
    if radius == 0.0:
        return cast_on_polygon(corners, count, ALL_EDGES, x, y, dx, dy)
    best = MISS
    best_x, best_y = back_x, back_y
    for k in range(count):
        n = k + 1 if k + 1 < count else 0
        nx, ny = edge_normal(corners, count, k)
        if nx * dx + ny * dy < 0.0:
            fraction = cast_on_line(
                corners[k, 0] + radius * nx,
                corners[k, 1] + radius * ny,
                corners[n, 0] + radius * nx,
                corners[n, 1] + radius * ny,
                x,
                y,
                dx,
                dy,
            )
            if fraction < best:
                best = fraction
                best_x, best_y = nx, ny
        fraction, nx, ny = sweep_circles(x - corners[k, 0], y - corners[k, 1], dx, dy, radius)
        if fraction < best:
            best = fraction
            best_x, best_y = nx, ny
    return best, best_x, best_y


@subkernel
def crosses_box(x, y, dx, dy, min_x, min_y, max_x, max_y):
    """Return whether a ray may cross a box, which is enlarged by a margin for rounding errors.

    x, y, dx, dy: start and vector of the ray [px]; min_x, min_y, max_x, max_y: the box [px].
    """
    rim = 1e-9 * (max_x - min_x + max_y - min_y + abs(dx) + abs(dy)) + 1e-15 * (abs(x) + abs(y))
    enter = 0.0
    leave = 1.0
    for axis in range(2):
        position = x if axis == 0 else y
        step = dx if axis == 0 else dy
        low = (min_x if axis == 0 else min_y) - rim
        high = (max_x if axis == 0 else max_y) + rim
        if step == 0.0:
            if position < low or position > high:
                return False
        else:
            enter = max(enter, min((low - position) / step, (high - position) / step))
            leave = min(leave, max((low - position) / step, (high - position) / step))
    return enter <= leave


@subkernel
def cast_on_chain(geometry, chain, body, ray):
    """Cast a ray at the fronts of a chain's links. Return (fraction or MISS, nx, ny). O(blocks + links near the ray).

    A ray of zero length tests whether its start is on a link. chain: row number in geometry.chains; body: BODY row;
    ray: start and vector (x, y, dx, dy) [px].
    """
    cosine, sine = math.cos(body.angle), math.sin(body.angle)
    x, y = rotate(ray[0] - body.x, ray[1] - body.y, cosine, -sine)
    dx, dy = rotate(ray[2], ray[3], cosine, -sine)
    span = geometry.chains[chain]
    point = dx == 0.0 and dy == 0.0
    best = MISS
    best_x, best_y = 0.0, -1.0
    for block in range(span.blocks):
        box = geometry.link_blocks[span.first_block + block]
        if not crosses_box(x, y, dx, dy, box.min_x, box.min_y, box.max_x, box.max_y):
            continue
        for k in range(block * BLOCK_LINKS, min(span.count, (block + 1) * BLOCK_LINKS)):
            link = geometry.links[span.offset + k]
            if point:
                if distance_to_edge(link.ax, link.ay, link.bx, link.by, x, y) == 0.0:
                    return 0.0, 0.0, -1.0
                continue
            nx, ny = unit(link.by - link.ay, link.ax - link.bx, 0.0, -1.0)
            if nx * dx + ny * dy >= 0.0:
                continue
            fraction = cast_on_line(link.ax, link.ay, link.bx, link.by, x, y, dx, dy)
            if fraction < best:
                best = fraction
                best_x, best_y = nx, ny
    best_x, best_y = rotate(best_x, best_y, cosine, sine)
    return best, best_x, best_y


# ---- rays ------------------------------------------------------------------------------------------------------------
# A ray against every shape: closed forms for circles, other hulls and lines, cell by cell for tiles.
#
# Source of the cell walk: Amanatides and Woo, A Fast Voxel Traversal Algorithm, 1987.


@subkernel
def enter_box(x, y, dx, dy, width, height):
    """Return the two fractions at which a ray enters and leaves the box from (0, 0) to (width, height) [px].

    If the ray misses the box, the first fraction is greater than the second. x, y, dx, dy: start and vector of the ray
    [px].
    """
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
    """Return the fraction at which a ray leaves a cell along one axis; infinity if its vector is 0 on this axis.

    position, step: coordinates of the ray's start and vector on this axis [px]; cell: index of the cell; size: size of
    a cell [px].
    """
    if step > 0.0:
        return ((cell + 1) * size - position) / step
    if step < 0.0:
        return (cell * size - position) / step
    return math.inf


@subkernel
def start_cell(position, step, size, count):
    """Return the index, along one axis, of the cell in which a ray starts.

    If the start is on a border between two cells, it is the cell into which the ray moves. position, step: coordinates
    of the ray's start and vector on this axis [px]; size: size of a cell [px]; count: number of cells.
    """
    at = position / size
    cell = math.floor(at)
    if step < 0.0 and cell == at:
        cell -= 1
    return max(0, min(count - 1, cell))


@subkernel
def cast_on_cell(geometry, grid, row, column, ray, corners_inout):
    """Cast a ray at one cell of a tile grid. Return (fraction or MISS, nx, ny).

    A one-way cell is hit only from above. grid: row number in geometry.grids; row, column: the cell; ray: start and
    vector (x, y, dx, dy) [px] relative to the grid's origin; corners_inout: (16, 2) scratch.
    """
    x, y, dx, dy = ray
    g = geometry.grids[grid]
    if row < 0 or row >= g.rows or column < 0 or column >= g.columns:
        return MISS, 0.0, -1.0
    kind = geometry.cells[g.offset + row * g.columns + column].kind
    if kind == EMPTY or (kind == ONE_WAY and not (dy > 0.0 and y <= row * g.tile_size)):
        return MISS, 0.0, -1.0
    count, edges = tile_at(geometry, grid, 0.0, 0.0, row, column, corners_inout)
    return sweep_circle_polygon(corners_inout, count, ALL_EDGES, x, y, dx, dy, 0.0)


@subkernel
def cast_on_tiles(geometry, grid, ray, corners_inout):
    """Cast a ray at the tiles of a grid. Return (fraction or MISS, nx, ny). O(cells on the ray).

    The neighbours of each cell are also tested, because a ray along a border hits the tiles on both sides, and a ray
    through a corner hits all four tiles. grid: row number in geometry.grids; ray: start and vector (x, y, dx, dy) [px]
    relative to the grid's origin; corners_inout: (16, 2) scratch.
    """
    x, y, dx, dy = ray
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
    best_x, best_y = 0.0, -1.0
    while 0 <= column < g.columns and 0 <= row < g.rows:
        # This cell and its neighbours, because a border belongs to both sides.
        for j in range(-1, 2):
            for i in range(-1, 2):
                fraction, nx, ny = cast_on_cell(geometry, grid, row + j, column + i, ray, corners_inout)
                if fraction < best:
                    best = fraction
                    best_x, best_y = nx, ny
        across = next_border(x, dx, column, size)
        down = next_border(y, dy, row, size)
        # The search ends when no cell before the hit is left.
        if best <= min(across, down) or min(across, down) > leave:
            break
        if across < down:
            column += step_x
        else:
            row += step_y
    return best, best_x, best_y


@subkernel
def is_solid_at(rasters, words, mask, x, y):
    """Return whether a point of a raster is in a solid pixel. Pixel (i, j) covers [i, i + 1) x [j, j + 1).

    rasters, words: tables of the geometry; mask: RASTER row number; x, y: the point [px], measured from the top left
    corner of the raster.
    """
    r = rasters[mask]
    if not (0.0 <= x < r.width and 0.0 <= y < r.height):
        return False
    return is_set(words, r.offset + math.floor(y) * r.stride, math.floor(x))


@subkernel
def is_in_mask(geometry, shape, body, x, y):
    """Return whether the world point (x, y) [px] is in a solid pixel of a mask.

    A mask with snap=True is tested as drawn, any other mask at its exact pose. shape: SHAPE row of the mask; body: its
    BODY row.
    """
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
    """Return whether the point (x, y) is in a convex polygon or on its boundary.

    corners: the corners, clockwise on the screen, of which the first `count` are in use.
    """
    for k in range(count):
        n = k + 1 if k + 1 < count else 0
        ex = corners[n, 0] - corners[k, 0]
        ey = corners[n, 1] - corners[k, 1]
        if ey * (x - corners[k, 0]) - ex * (y - corners[k, 1]) > 0.0:
            return False
    return True


@subkernel
def point_in_tiles(geometry, grid, x, y, corners_inout):
    """Return whether a point is in a solid tile or slope of a grid, boundary included.

    grid: row number in geometry.grids; x, y: the point relative to the grid's origin [px]; corners_inout: (16, 2)
    scratch.
    """
    g = geometry.grids[grid]
    column, row = math.floor(x / g.tile_size), math.floor(y / g.tile_size)
    # A point on a border is also in the tile before the border.
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
def cast_on_shape(geometry, bodies, shapes, row, ray, corners_inout):
    """Cast a ray at a shape. Return (fraction or MISS, nx, ny).

    A ray of zero length tests whether its start is inside. For a mask only the start of the ray is tested, against the
    pixels; batches.cast_on_outline casts longer rays at masks. row: SHAPE row number; ray: start and vector (x, y, dx,
    dy) [px]; corners_inout: (16, 2) scratch.
    """
    x, y, dx, dy = ray
    s = shapes[row]
    b = bodies[s.body_row]
    point = dx == 0.0 and dy == 0.0
    back_x, back_y = unit(-dx, -dy, 0.0, -1.0)
    if s.kind == CIRCLE:
        u, v = rotate(s.local_x, s.local_y, math.cos(b.angle), math.sin(b.angle))
        return cast_on_disc(x - b.x - u, y - b.y - v, dx, dy, s.radius)
    if s.kind == TILES:
        if point_in_tiles(geometry, s.geometry, x - b.x, y - b.y, corners_inout):
            return 0.0, back_x, back_y
        if point:
            return MISS, 0.0, -1.0
        return cast_on_tiles(geometry, s.geometry, (x - b.x, y - b.y, dx, dy), corners_inout)
    if s.kind == MASK:
        return 0.0 if is_in_mask(geometry, s, b, x, y) else MISS, 0.0, -1.0
    if s.kind == CHAIN:
        return cast_on_chain(geometry, s.geometry, b, ray)
    count = corners_at(geometry, shapes, row, b.x, b.y, b.angle, corners_inout)
    radius = rounding(shapes, row)
    if count == 2 or radius > 0.0:
        return cast_on_hull(corners_inout, count, radius, x, y, dx, dy)
    if inside_polygon(corners_inout, count, x, y):
        return 0.0, back_x, back_y
    if point:
        return MISS, 0.0, -1.0
    return sweep_circle_polygon(corners_inout, count, ALL_EDGES, x, y, dx, dy, 0.0)
