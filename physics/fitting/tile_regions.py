"""What is solid in one tile as rings of sides: its pieces of the outline, and the tile's border between them.

A piece that ends on the border goes on along it, clockwise on the screen, to where the next one starts. There is solid
on the other side too, so these sides are inner.
"""

import math

from physics.fitting.cracks import is_solid
from physics.fitting.rings import close_ring, put_side
from physics.jit import subkernel


@subkernel
def tile_corner(window, number):
    """(x, y) of a tile's corner: 0 is top left, then clockwise."""
    number &= 3
    return (
        float(window.high if number == 1 or number == 2 else window.low),
        float(window.high if number >= 2 else window.low),
    )


@subkernel
def put_piece(n, first, piece, points, sides_inout):
    """Append the sides of a piece to a ring; its last point's side is inner. Returns how many sides there are."""
    for k in range(piece.count):
        point = points[piece.first + k]
        n = put_side(n, first, point.x, point.y, not piece.closed and k == piece.count - 1, sides_inout)
    return n


@subkernel
def next_piece(pieces, count, at, around):
    """The piece from border to border that starts next, clockwise from a place on the border; and how far on [px]."""
    best = -1
    nearest = math.inf
    for k in range(count):
        piece = pieces[k]
        if not piece.closed:
            ahead = piece.start - at
            if ahead < 0.0:
                ahead += around
            if ahead < nearest:
                nearest = ahead
                best = k
    return best, nearest


@subkernel
def put_border(window, n, first, start, length, sides_inout):
    """Append the corners of the tile that lie strictly within a length of its border from a place on."""
    size = float(window.high - window.low)
    number = math.floor(start / size) + 1
    while number * size < start + length:
        x, y = tile_corner(window, number)
        n = put_side(n, first, x, y, True, sides_inout)
        number += 1
    return n


@subkernel
def put_open(window, n, number, workspace, sides_inout):
    """Append the ring of a piece from border to border. Returns how many sides there are."""
    around = 4.0 * (window.high - window.low)
    pieces = workspace.pieces
    first = n
    while not pieces[number].used:
        piece = pieces[number]
        piece.used = True
        n = put_piece(n, first, piece, workspace.points, sides_inout)
        number, ahead = next_piece(pieces, workspace.counts[0], piece.end, around)
        n = put_border(window, n, first, piece.end, ahead, sides_inout)
    return close_ring(n, first, sides_inout)


@subkernel
def is_hole(piece, points):
    """Whether a closed piece goes the other way round: counter-clockwise on the screen."""
    doubled = 0.0
    before = points[piece.first + piece.count - 1]
    for k in range(piece.first, piece.first + piece.count):
        point = points[k]
        doubled += before.x * point.y - before.y * point.x
        before = point
    return doubled < 0.0


@subkernel
def put_regions(window, workspace, sides_out):
    """Write the rings of all that is solid in a tile (SIDE), its holes apart. Returns how many sides there are.

    workspace: Paths, as find_paths left them.
    """
    n = 0
    holes = 0
    crossed = False
    for k in range(workspace.counts[0]):
        piece = workspace.pieces[k]
        if not piece.closed:
            crossed = True
            if not piece.used:
                n = put_open(window, n, k, workspace, sides_out)
            continue
        first = n
        n = close_ring(put_piece(n, n, piece, workspace.points, sides_out), first, sides_out)
        if n > first and is_hole(piece, workspace.points):
            holes += 1
            for side in range(first, n):
                sides_out[side].apart = holes
    low = window.low
    if not crossed and is_solid(window.pixels, low, low, 0) and is_solid(window.pixels, low, low, 3):
        first = n
        for number in range(4):
            x, y = tile_corner(window, number)
            n = put_side(n, first, x, y, True, sides_out)
        n = close_ring(n, first, sides_out)
    return n
