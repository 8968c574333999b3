"""Tiles under a character. A box meets them on the pixel grid; another outline meets each run of tiles as a polygon.

On the pixel grid touching never blocks, and one shared pixel does. What counts most of the tiles decides.
"""

import math

from physics.character.ground import BLOCKED, EVEN, FREE, ON_SLOPE, STEEP, judge, pixels_along
from physics.character.meet import manifold_depth, place_outline
from physics.collision.clipping import ALL_EDGES
from physics.collision.hulls import collide_hull_circle, collide_hulls, faces_of
from physics.collision.tiles import edges_facing, run_at, tile_at
from physics.jit import subkernel
from physics.tables.body import KINEMATIC
from physics.tables.geometry import EMPTY, ONE_WAY, SLOPE


@subkernel
def on_pixels(kind, coordinate):
    """Where a grid [px] stands for characters: one that moves, on the whole pixel nearest to it."""
    return float(math.floor(coordinate + 0.5)) if kind == KINEMATIC else coordinate


@subkernel
def is_falling(c, way_x, way_y):
    """1 when a character that came this way is held by what is open from below."""
    return 1 if way_x == 0 and way_y > 0 and not c.drop else 0


@subkernel
def slope_tile_verdict(c, slope, depth):
    """What a slope tile is to a box that reaches `depth` [px] below its surface."""
    if depth > pixels_along(slope):
        return BLOCKED  # its side, or from inside
    return ON_SLOPE if abs(slope) <= c.climb + EVEN else STEEP


@subkernel
def in_tiles(walk, me, row, left, top, way_x, way_y):
    """(FREE, STEEP, ON_SLOPE or BLOCKED, slope) of a box of pixels in a tile grid: see solids.in_shape."""
    c = walk.characters[me]
    b = walk.bodies[walk.shapes[row].body_row]
    g = walk.geometry.grids[walk.shapes[row].geometry]
    grid_x = on_pixels(b.kind, b.x)
    grid_y = on_pixels(b.kind, b.y)
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
    """(depth [px], normal from the character) of scratch.mine in the tile in scratch.theirs, through its free edges."""
    mine = scratch.mine
    if count == 1:
        hit, nx, ny, x, y, separation, feature = collide_hull_circle(
            scratch.theirs, corners, edges, 0.0, mine[0, 0], mine[0, 1], radius
        )
        return -separation if hit and separation < 0.0 else 0.0, -nx, -ny
    if edges == ALL_EDGES:
        facing = edges
    elif is_slope:
        facing = faces_of(mine, count, scratch.theirs, corners, edges)
    else:
        facing = edges_facing(mine, count, edges)
    points = collide_hulls(
        scratch.theirs, corners, 0.0, edges, mine, count, radius, facing, 0.0, 0.0, deepest, scratch.points
    )
    depth, nx, ny, x, y = manifold_depth(points, scratch.points)
    return depth, -nx, -ny


@subkernel
def in_tile_outlines(walk, me, row, left, top, way_x, way_y):
    """As in_tiles, for a character that is no box, by the outlines of the runs of tiles and of the slopes."""
    c = walk.characters[me]
    s = walk.shapes[row]
    b = walk.bodies[s.body_row]
    g = walk.geometry.grids[s.geometry]
    cells = walk.geometry.cells
    scratch = walk.scratch
    grid_x = on_pixels(b.kind, b.x)
    grid_y = on_pixels(b.kind, b.y)
    first_column = max(0, math.floor((left - grid_x) / g.tile_size))
    last_column = min(g.columns - 1, math.ceil((left + c.width - grid_x) / g.tile_size) - 1)
    first_row = max(0, math.floor((top - grid_y) / g.tile_size))
    last_row = min(g.rows - 1, math.ceil((top + c.height - grid_y) / g.tile_size) - 1)
    count, radius = place_outline(walk, me, left, top)
    result = FREE
    slope = 0.0
    for attempt in range(2):
        # What lies deep inside may be left to a neighbour by each of them: once more, by every edge.
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
                    corners, edges = run_at(
                        walk.geometry.grids,
                        cells,
                        s.geometry,
                        grid_x,
                        grid_y,
                        line,
                        column,
                        first_column,
                        last_column,
                        scratch.theirs,
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
