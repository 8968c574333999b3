"""Collision of tile grids with other shapes. Adjacent equal tiles in a row are tested as one rectangle, a run."""

import math
from typing import Any

from physics.collision.hull_pairs import (
    NEVER,
    Meeting,
    add_circle_on_piece,
    add_points_on_piece,
    advance_to_piece,
    is_grazing,
    time_to_piece,
    travel_of,
)
from physics.collision.hulls import (
    ALL_EDGES,
    Hull,
    collide_hull_circle,
    collide_hulls,
    edge_normal,
    part_feature,
    part_of,
    write_normals,
)
from physics.collision.manifold import GRID_ANY, add_point, hull_of, make_pass, sides_by_kind
from physics.collision.masks_exact import collide_mask_part, tested_aabb
from physics.jit import inlined, subkernel
from physics.shapes.placement import box_corners
from physics.tables.geometry import EMPTY, ONE_WAY, SLOPE, SOLID
from physics.tables.shape import MASK, TILES
from physics.tables.step_state import MASK_TESTS

# ---- tiles -----------------------------------------------------------------------------------------------------------
# A slope, or a run of equal tiles in a row, as a convex polygon, and its touchable edges.
#
# A hull edge of a tile that a neighbouring tile covers is inside the ground. No contact may push through such an edge,
# else bodies would catch on the seams between tiles (ghost collisions).


@subkernel
def is_covered(grids, cells, grid, row, column, from_row, from_column):
    """Return whether the cell (row, column) covers the edge shared with the adjacent cell (from_row, from_column).

    grids, cells: GRID and CELL tables of the geometry; grid: row number in `grids`.
    """
    g = grids[grid]
    if row < 0 or row >= g.rows or column < 0 or column >= g.columns:
        return False
    cell = cells[g.offset + row * g.columns + column]
    if cell.kind == SOLID:
        return True
    if cell.kind != SLOPE:
        return False
    if row < from_row:
        return True  # a slope covers its whole bottom edge
    mine = cells[g.offset + from_row * g.columns + from_column]
    if column < from_column:
        return cell.right >= (mine.left if mine.kind == SLOPE else 1.0)
    if column > from_column:
        return cell.left >= (mine.right if mine.kind == SLOPE else 1.0)
    return cell.left >= 1.0 and cell.right >= 1.0


@subkernel
def bends_down(grids, cells, grid, row, column, side):
    """Return whether the ground bends down from a tile to the tile beside it, which exposes the corner between them.

    grids, cells: GRID and CELL tables of the geometry; grid: row number in `grids`; row, column: the tile; side: -1 for
    the left neighbour, 1 for the right neighbour.
    """
    g = grids[grid]
    other = column + side
    if other < 0 or other >= g.columns:
        return False
    mine = cells[g.offset + row * g.columns + column]
    next_cell = cells[g.offset + row * g.columns + other]
    if next_cell.kind != SLOPE:
        return False
    own_rise = mine.right - mine.left if mine.kind == SLOPE else 0.0
    return side * (next_cell.right - next_cell.left) < side * own_rise


@subkernel
def corners_between(edges, count):
    """Return the bits of the corners whose two adjacent edges are both set in `edges`. count: number of edges."""
    return edges & ((edges << 1) | (edges >> (count - 1)))


@inlined
def run_at(geometry, grid, x, y, row, column, under, corners_out):
    """Write the world corners [px] of the run of solid or one-way cells that contains the cell (row, column).

    A run is adjacent equal cells in a row, treated as one rectangle. Return (number of corners, bits of the touchable
    edges and corners), see tile_at. The top edge is touchable if a cell of the run, within the columns `under`, has no
    covering neighbour above it; likewise the bottom edge with neighbours below. grid: row number in GRID; x, y [px]:
    the grid's origin; under: (first, last) column under the other shape; corners_out (16, 2): the corners.
    """
    grids, cells = geometry.grids, geometry.cells
    low, high = under
    g = grids[grid]
    cell = cells[g.offset + row * g.columns + column]
    left = x + cell.first * g.tile_size
    right = x + (cell.last + 1) * g.tile_size
    box_corners(left, y + row * g.tile_size, right, y + (row + 1) * g.tile_size, corners_out)
    if cell.kind == ONE_WAY:
        return 4, 1
    edges = 0
    corners = 0
    for k in range(min(max(low, cell.first), cell.last), max(min(high, cell.last), cell.first) + 1):
        if not is_covered(grids, cells, grid, row - 1, k, row, k):
            edges |= 1
        if not is_covered(grids, cells, grid, row + 1, k, row, k):
            edges |= 4
    if not is_covered(grids, cells, grid, row, cell.last + 1, row, cell.last):
        edges |= 2
    elif bends_down(grids, cells, grid, row, cell.last, 1):
        corners |= 2
    if not is_covered(grids, cells, grid, row, cell.first - 1, row, cell.first):
        edges |= 8
    elif bends_down(grids, cells, grid, row, cell.first, -1):
        corners |= 8
    if edges == 0:
        return 4, ALL_EDGES
    return 4, edges | (corners_between(edges | corners, 4) << 16)


@subkernel
def tile_at(geometry, grid, x, y, row, column, corners_out):
    """Write the world corners [px] of a tile, clockwise on the screen from the top left.

    A slope has three or four corners. Return (number of corners, bits): the low 16 bits are the touchable edges (not
    covered by a neighbour), the next 16 bits the touchable corners. A corner at a covered edge is touchable where the
    ground bends down. If all edges are covered, all are touchable, so that a body inside the tile is pushed out. grid:
    row number in GRID; x, y [px]: the grid's origin; row, column: the tile; corners_out (16, 2): the result.
    """
    grids, cells = geometry.grids, geometry.cells
    g = grids[grid]
    cell = cells[g.offset + row * g.columns + column]
    left = x + column * g.tile_size
    right = x + (column + 1) * g.tile_size
    top = y + row * g.tile_size
    bottom = y + (row + 1) * g.tile_size
    if cell.kind == ONE_WAY:
        return box_corners(left, top, right, bottom, corners_out), 1
    heights_left = 1.0
    heights_right = 1.0
    if cell.kind == SLOPE:
        heights_left = cell.left
        heights_right = cell.right
    n = 0
    edges = 0
    corners = 0
    # Each corner is the start of an edge: surface, right side, bottom, left side.
    if heights_left > 0.0:
        corners_out[n, 0] = left
        corners_out[n, 1] = bottom - heights_left * g.tile_size
        if (
            heights_left < 1.0
            or heights_right < 1.0
            or not is_covered(grids, cells, grid, row - 1, column, row, column)
        ):
            edges |= 1 << n
        n += 1
    if heights_right > 0.0:
        corners_out[n, 0] = right
        corners_out[n, 1] = bottom - heights_right * g.tile_size
        # Without a left side, the surface leads from the bottom left corner, which is written last, to this corner.
        if not is_covered(grids, cells, grid, row, column + 1, row, column):
            edges |= 1 << n
        elif bends_down(grids, cells, grid, row, column, 1):
            corners |= 1 << n
        n += 1
    corners_out[n, 0] = right
    corners_out[n, 1] = bottom
    if not is_covered(grids, cells, grid, row + 1, column, row, column):
        edges |= 1 << n
    n += 1
    corners_out[n, 0] = left
    corners_out[n, 1] = bottom
    if heights_left > 0.0:
        if not is_covered(grids, cells, grid, row, column - 1, row, column):
            edges |= 1 << n
        elif bends_down(grids, cells, grid, row, column, -1):
            corners |= 1 << n
    else:
        edges |= 1 << n  # the edge back to the first corner is the surface
    n += 1
    if edges == 0:
        return n, ALL_EDGES
    return n, edges | (corners_between(edges | corners, n) << 16)


@subkernel
def pushing_edges_on_tile(corners, count, tile_edges):
    """Return bits of the edges of a polygon whose normals may push the polygon out of a tile.

    An edge is omitted if it would push the polygon through a covered side of the tile. corners, count: the polygon;
    tile_edges: bits returned by tile_at for a tile of four corners (top, right, bottom, left).
    """
    if (tile_edges & 15) == 15:
        return ALL_EDGES
    edges = 0xFFFF0000  # all corners may touch
    for k in range(count):
        nx, ny = edge_normal(corners, count, k)
        # The edge's normal points into the tile; the polygon leaves the tile on the opposite side.
        free = True
        if nx < 0.0 and not (tile_edges >> 1) & 1:
            free = False
        if nx > 0.0 and not (tile_edges >> 3) & 1:
            free = False
        if ny > 0.0 and not tile_edges & 1:
            free = False
        if ny < 0.0 and not (tile_edges >> 2) & 1:
            free = False
        if free:
            edges |= 1 << k
    return edges


# ---- tile pairs ------------------------------------------------------------------------------------------------------
# The pass over the candidate pairs with a tile grid.


@subkernel
def touched_run(workspace, pair, run):
    """Return whether a candidate pair touched a run of tiles in the last step.

    pair: index of the candidate; run: index of the run's first cell; workspace: manifold.Workspace with the contacts of
    the last step.
    """
    if pair >= len(workspace.memory):
        return False
    first = workspace.memory[pair, 0]
    for k in range(first, first + workspace.memory[pair, 1]):
        if k >= len(workspace.previous):
            return False
        m = workspace.previous[k]
        if part_of(m.feature_1) == run or (m.count == 2 and part_of(m.feature_2) == run):
            return True
    return False


def make_grid_pass(one_way: bool) -> Any:
    """Return the kernel that collides tile grids with all other shapes.

    one_way: True if the world has one-way tiles.
    """

    @inlined
    def collide_grid_pair(batch, pair, workspace, manifolds_out, found, work_inout):
        """Append the contacts of candidate number `pair`, a tile grid and another shape.

        Return the new number of contacts. Arguments: see manifold.make_pass.
        """
        geometry = batch.geometry
        bodies = batch.bodies
        shapes, candidates, margin, cells = batch.shapes, batch.candidates, batch.margin, geometry.cells
        tile = workspace.a
        sign, row, other = sides_by_kind(batch, pair, TILES)
        s, o = shapes[row], shapes[other]
        p, q = bodies[s.body_row], bodies[o.body_row]
        g = geometry.grids[s.geometry]
        min_x, min_y, max_x, max_y = tested_aabb(geometry, o)
        travel = travel_of(batch, p, q)
        moves = travel.time > 0.0 and o.kind != MASK  # the velocity of a body without a prediction may be infinite
        dx = travel.time * travel.vx if moves else 0.0
        dy = travel.time * travel.vy if moves else 0.0
        was_above = max_y - (q.y - q.previous_y) + (p.y - p.previous_y)
        min_x, max_x = min_x + min(dx, 0.0), max_x + max(dx, 0.0)
        min_y, max_y = min_y + min(dy, 0.0), max_y + max(dy, 0.0)
        first_column = max(0, math.ceil((min_x - margin - p.x) / g.tile_size) - 1)
        last_column = min(g.columns - 1, math.floor((max_x + margin - p.x) / g.tile_size))
        first_row = max(0, math.ceil((min_y - margin - p.y) / g.tile_size) - 1)
        last_row = min(g.rows - 1, math.floor((max_y + margin - p.y) / g.tile_size))
        hull = Hull(workspace.b, 0, 0.0, ALL_EDGES)
        if o.kind == MASK:
            work_inout[MASK_TESTS] += 1
        else:
            hull = hull_of(geometry, bodies, shapes, other, workspace.b)
        # Columns that the shape overlaps during its motion, without columns that it only touches.
        under = (math.floor((min_x - p.x) / g.tile_size), math.ceil((max_x - p.x) / g.tile_size) - 1)
        start = found
        seen = 0
        for attempt in range(2):
            # Second pass, if each tile left a deep overlap to a neighbour: all edges are touchable.
            if attempt == 1 and (seen == 0 or found > start):
                break
            deepest = 0.5 * g.tile_size if attempt == 0 else math.inf
            for tile_row in range(first_row, last_row + 1):
                next_column = first_column
                while next_column <= last_column:
                    tile_column = next_column
                    cell = cells[g.offset + tile_row * g.columns + tile_column]
                    kind = cell.kind
                    next_column = cell.last + 1
                    if kind == EMPTY or (kind == ONE_WAY and not one_way):
                        continue
                    run = tile_row * g.columns + cell.first
                    # Only a shape that came from above a one-way tile, or was in contact with it, may touch it.
                    if kind == ONE_WAY and (
                        attempt == 1
                        or (was_above > p.y + tile_row * g.tile_size + margin and not touched_run(workspace, pair, run))
                    ):
                        continue
                    if kind == SLOPE:
                        corners, edges = tile_at(geometry, s.geometry, p.x, p.y, tile_row, tile_column, tile)
                    else:
                        corners, edges = run_at(geometry, s.geometry, p.x, p.y, tile_row, tile_column, under, tile)
                    seen += 1
                    if attempt == 1:
                        edges = ALL_EDGES
                    piece = Hull(tile, corners, 0.0, edges)
                    feature = part_feature(run, 0)
                    if o.kind == MASK:
                        area, nx, ny, x, y, separation, _ = collide_mask_part(
                            geometry, q, o, piece, workspace.b, workspace.depths
                        )
                        if area > 0.0:
                            point = (-sign * nx, -sign * ny, x, y, separation, area, feature)
                            found = add_point(shapes, candidates, pair, point, manifolds_out, found)
                    elif hull.count == 1:
                        radius = hull.radius
                        time = time_to_piece(travel, margin, piece, hull.corners[0, 0], hull.corners[0, 1], radius)
                        if time == NEVER:
                            continue
                        cx = hull.corners[0, 0] + time * travel.vx
                        cy = hull.corners[0, 1] + time * travel.vy
                        contact, disc = collide_hull_circle(piece, cx, cy, radius), (cx, cy, radius)
                        meeting = Meeting(piece, travel, time, sign, feature)
                        found = add_circle_on_piece(
                            batch, pair, meeting, disc, contact, workspace, manifolds_out, found
                        )
                    else:
                        time = 0.0
                        met = hull
                        write_normals(corners, tile)
                        if travel.time > 0.0 and attempt == 0:
                            time = advance_to_piece(travel, margin, piece, hull, workspace.c)
                            met = Hull(workspace.c, hull.count, hull.radius, ALL_EDGES)
                        if time == NEVER:
                            continue
                        facing = ALL_EDGES
                        if corners == 4:
                            facing = pushing_edges_on_tile(met.corners, met.count, edges)
                        collide_hulls(
                            piece,
                            Hull(met.corners, met.count, met.radius, facing),
                            travel.reach if attempt == 0 else margin,
                            batch.bias,
                            deepest,
                            workspace.points,
                        )
                        # Two faces whose ends pass each other, as in collide_polygon_pair.
                        if (
                            batch.graze > 0.0
                            and kind != ONE_WAY
                            and workspace.points[0] > 0.0
                            and is_grazing(piece, met, batch, p, q, workspace.points)
                        ):
                            continue
                        meeting = Meeting(piece, travel, time, sign, feature)
                        found = add_points_on_piece(batch, pair, meeting, workspace, manifolds_out, found)
        return found

    return make_pass(GRID_ANY, collide_grid_pair)


collide_grid_pairs_one_way = make_grid_pass(one_way=True)
collide_grid_pairs_closed = make_grid_pass(one_way=False)
