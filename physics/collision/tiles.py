"""A slope, or a run of like tiles in a row, as a convex polygon, and which of its edges can be touched.

An edge that a neighbouring tile covers belongs to the inside of the ground: nothing may be pushed out through it, or
things would catch on the seams between tiles.
"""

from physics.collision.clipping import ALL_EDGES, edge_normal
from physics.jit import subkernel
from physics.tables.geometry import ONE_WAY, SLOPE, SOLID


@subkernel
def covered(grids, cells, grid, row, column, from_row, from_column):
    """Whether the cell at (row, column) covers the whole edge that it shares with that at (from_row, from_column)."""
    g = grids[grid]
    if row < 0 or row >= g.rows or column < 0 or column >= g.columns:
        return False
    cell = cells[g.offset + row * g.columns + column]
    if cell.kind == SOLID:
        return True
    if cell.kind != SLOPE:
        return False
    if row < from_row:
        return True  # a slope stands on its whole bottom
    mine = cells[g.offset + from_row * g.columns + from_column]
    if column < from_column:
        return cell.right >= (mine.left if mine.kind == SLOPE else 1.0)
    if column > from_column:
        return cell.left >= (mine.right if mine.kind == SLOPE else 1.0)
    return cell.left >= 1.0 and cell.right >= 1.0


@subkernel
def turns_away(grids, cells, grid, row, column, side):
    """Whether the ground bends down where a tile meets its neighbour at side -1 or 1: a corner sticks out."""
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
def between(edges, count):
    """The bits of the corners of which both edges are set."""
    return edges & ((edges << 1) | (edges >> (count - 1)))


@subkernel
def run_at(grids, cells, grid, x, y, row, column, low, high, corners_out):
    """World corners [px] of the run of solid or one-way cells that a cell belongs to,
    and the bits of its touchable edges.

    As tile_at, as one rectangle, so that nothing is felt between its cells. low..high: columns under what may touch it;
    its top and bottom can be touched where a cell among these is not covered. Returns (corners, edges).
    """
    g = grids[grid]
    cell = cells[g.offset + row * g.columns + column]
    corners_out[0, 0] = x + cell.first * g.tile_size
    corners_out[0, 1] = y + row * g.tile_size
    corners_out[1, 0] = x + (cell.last + 1) * g.tile_size
    corners_out[1, 1] = y + row * g.tile_size
    corners_out[2, 0] = x + (cell.last + 1) * g.tile_size
    corners_out[2, 1] = y + (row + 1) * g.tile_size
    corners_out[3, 0] = x + cell.first * g.tile_size
    corners_out[3, 1] = y + (row + 1) * g.tile_size
    if cell.kind == ONE_WAY:
        return 4, 1
    edges = 0
    corners = 0
    for k in range(min(max(low, cell.first), cell.last), max(min(high, cell.last), cell.first) + 1):
        if not covered(grids, cells, grid, row - 1, k, row, k):
            edges |= 1
        if not covered(grids, cells, grid, row + 1, k, row, k):
            edges |= 4
    if not covered(grids, cells, grid, row, cell.last + 1, row, cell.last):
        edges |= 2
    elif turns_away(grids, cells, grid, row, cell.last, 1):
        corners |= 2
    if not covered(grids, cells, grid, row, cell.first - 1, row, cell.first):
        edges |= 8
    elif turns_away(grids, cells, grid, row, cell.first, -1):
        corners |= 8
    if edges == 0:
        return 4, ALL_EDGES
    return 4, edges | (between(edges | corners, 4) << 16)


@subkernel
def tile_at(geometry, grid, x, y, row, column, corners_out):
    """World corners [px] of a tile, clockwise on the screen from its top left, and the bits of its touchable edges
    (and, 16 bits higher, of its corners: that of a covered side too where the ground bends down).

    grid: row of GRID; x, y [px]: where the grid's origin is; corners_out (16, 2). A solid tile has four corners, a
    slope three or four. A tile whose edges are all covered may be touched everywhere: what is inside has to get out.
    Returns (corners, edges).
    """
    grids = geometry.grids
    cells = geometry.cells
    g = grids[grid]
    cell = cells[g.offset + row * g.columns + column]
    left = x + column * g.tile_size
    right = x + (column + 1) * g.tile_size
    top = y + row * g.tile_size
    bottom = y + (row + 1) * g.tile_size
    if cell.kind == ONE_WAY:
        corners_out[0, 0] = left
        corners_out[0, 1] = top
        corners_out[1, 0] = right
        corners_out[1, 1] = top
        corners_out[2, 0] = right
        corners_out[2, 1] = bottom
        corners_out[3, 0] = left
        corners_out[3, 1] = bottom
        return 4, 1
    heights_left = 1.0
    heights_right = 1.0
    if cell.kind == SLOPE:
        heights_left = cell.left
        heights_right = cell.right
    n = 0
    edges = 0
    corners = 0
    # Each corner starts an edge: surface, right side, bottom, left side.
    if heights_left > 0.0:
        corners_out[n, 0] = left
        corners_out[n, 1] = bottom - heights_left * g.tile_size
        if heights_left < 1.0 or heights_right < 1.0 or not covered(grids, cells, grid, row - 1, column, row, column):
            edges |= 1 << n
        n += 1
    if heights_right > 0.0:
        corners_out[n, 0] = right
        corners_out[n, 1] = bottom - heights_right * g.tile_size
        # Without a left side this is the second corner: the surface runs from the bottom left corner, written last.
        if not covered(grids, cells, grid, row, column + 1, row, column):
            edges |= 1 << n
        elif turns_away(grids, cells, grid, row, column, 1):
            corners |= 1 << n
        n += 1
    corners_out[n, 0] = right
    corners_out[n, 1] = bottom
    if not covered(grids, cells, grid, row + 1, column, row, column):
        edges |= 1 << n
    n += 1
    corners_out[n, 0] = left
    corners_out[n, 1] = bottom
    if heights_left > 0.0:
        if not covered(grids, cells, grid, row, column - 1, row, column):
            edges |= 1 << n
        elif turns_away(grids, cells, grid, row, column, -1):
            corners |= 1 << n
    else:
        edges |= 1 << n  # the edge back to the first corner is the surface
    n += 1
    if edges == 0:
        return n, ALL_EDGES
    return n, edges | (between(edges | corners, n) << 16)


@subkernel
def edges_facing(corners, count, tile_edges):
    """The edges of another polygon that may push it out of a tile: those that face no covered side of it.

    tile_edges: bits as tile_at gives them for a tile of four corners (surface, right, bottom, left).
    """
    if (tile_edges & 15) == 15:
        return ALL_EDGES
    edges = 0xFFFF0000  # its corners can touch whatever sticks out of the tile
    for k in range(count):
        nx, ny = edge_normal(corners, count, k)
        # The edge's normal points into the tile; the tile is left on the opposite side.
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
