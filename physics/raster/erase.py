"""Pixels of a tile that lie inside a tool: their centres are in a convex shape, or in another mask's squares."""

import math

from physics.jit import kernel, subkernel, word
from physics.raster.bits import either, first_run, is_set, minus, run_bits
from physics.raster.pieces import TILE


@subkernel
def is_in_hull(corners, radius, x, y):
    """Whether a point [px] is in a convex hull grown by a radius, its surface included.

    corners (n, 2) [px], n >= 1, clockwise on the screen.
    """
    inside = len(corners) > 2
    least = math.inf
    for k in range(len(corners)):
        ax = corners[k, 0]
        ay = corners[k, 1]
        following = k + 1 if k + 1 < len(corners) else 0
        dx = corners[following, 0] - ax
        dy = corners[following, 1] - ay
        px = x - ax
        py = y - ay
        inside = inside and dx * py - dy * px >= 0.0
        size = dx * dx + dy * dy
        along = min(1.0, max(0.0, (px * dx + py * dy) / size)) if size > 0.0 else 0.0
        px -= along * dx
        py -= along * dy
        least = min(least, px * px + py * py)
    return inside or least <= radius * radius


@kernel
def find_in_hull(
    # read
    words,
    left,
    top,
    corners,
    radius,
    # write
    found_out,
):
    """Write the pixels of a tile whose centres are in a convex hull grown by a radius. Returns how many.

    words, found_out (64,) uint64; left, top [px] of the tile in the hull's coordinates; corners (n, 2) [px], n >= 1,
    clockwise on the screen. O(pixels within the hull's box · n).
    """
    min_x = math.inf
    max_x = -math.inf
    min_y = math.inf
    max_y = -math.inf
    for k in range(len(corners)):
        min_x = min(min_x, corners[k, 0])
        max_x = max(max_x, corners[k, 0])
        min_y = min(min_y, corners[k, 1])
        max_y = max(max_y, corners[k, 1])
    begin = max(0, math.floor(min(min_x - radius - left, float(TILE))))
    end = min(TILE, math.ceil(max(max_x + radius - left, 0.0)))
    upper = max(0, math.floor(min(min_y - radius - top, float(TILE))))
    lower = min(TILE, math.ceil(max(max_y + radius - top, 0.0)))
    count = 0
    for row in range(TILE):
        found_out[row] = word(0)
    for row in range(upper, lower):
        for column in range(begin, end):
            if is_set(words, row, column) and is_in_hull(corners, radius, left + column + 0.5, top + row + 0.5):
                found_out[row] = either(found_out[row], run_bits(column, column + 1))
                count += 1
    return count


@subkernel
def is_in_pixels(solid, x, y):
    """Whether a point [px] is in a solid pixel of solid[row, column], its sides included."""
    column = math.floor(x)
    row = math.floor(y)
    for j in range(row - 1 if y == row else row, row + 1):
        for i in range(column - 1 if x == column else column, column + 1):
            if 0 <= j < solid.shape[0] and 0 <= i < solid.shape[1] and solid[j, i]:
                return True
    return False


@kernel
def find_in_pixels(
    # read
    words,
    solid,
    x,
    y,
    cosine,
    sine,
    # write
    found_out,
):
    """Write the pixels of a tile whose centres are in the squares of another mask. Returns how many.

    words, found_out (64,) uint64; solid[row, column] bool of the other; x, y [px]: the tile's corner in its raster;
    cosine, sine: of the tile's angle there. O(pixels of the tile).
    """
    count = 0
    for row in range(TILE):
        found_out[row] = word(0)
        rest = words[row]
        while rest != word(0):
            start, end = first_run(rest)
            rest = minus(rest, run_bits(start, end))
            for column in range(start, end):
                u = x + cosine * (column + 0.5) - sine * (row + 0.5)
                v = y + sine * (column + 0.5) + cosine * (row + 0.5)
                if is_in_pixels(solid, u, v):
                    found_out[row] = either(found_out[row], run_bits(column, column + 1))
                    count += 1
    return count
