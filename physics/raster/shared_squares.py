"""The area that two masks share as unions of squares, and its centroid: raster and names as in raster/exact.py.

A pixel of B whose neighbourhood in A is solid counts whole; of one near A's outline, the share in each run of solid
pixels under it is added. O(pixels of B within A's bounds).
"""

import math

from physics.jit import subkernel, word
from physics.raster.bits import bits_from, both, columns_up_to, count_bits, is_set, lowest_bit, without_lowest
from physics.raster.exact import box_in_raster, reach_of, run_near
from physics.raster.shares import line_share


@subkernel
def square_share(x, y, cosine, sine, width, height):
    """(area, moment of x, moment of y) of what a turned unit square around (x, y) has in the box
    0..width x 0..height."""
    area = 0.0
    moment_x = 0.0
    moment_y = 0.0
    ux = 0.5 * (cosine + sine)
    uy = 0.5 * (sine - cosine)
    for _ in range(4):
        # From one corner to the next, a quarter turn further round the centre.
        a, mx, my = line_share(x + ux, y + uy, x - uy, y + ux, width, height)
        area += a
        moment_x += mx
        moment_y += my
        ux, uy = -uy, ux
    return area, moment_x, moment_y


@subkernel
def share_under(words, a, x, y, cosine, sine):
    """(area, moment of x, moment of y) in A of the square of B with its centre at x, y."""
    column = math.floor(x) - 1
    row = math.floor(y) - 1
    area = 0.0
    moment_x = 0.0
    moment_y = 0.0
    solid = 0
    for j in range(max(0, row), min(a.height, row + 3)):
        solid += count_bits(both(bits_from(words, a.offset + j * a.stride, a.stride, column), columns_up_to(3)))
    if solid == 9:
        return 1.0, x, y
    for j in range(max(0, row), min(a.height, row + 3)):
        start = -1
        for i in range(max(0, column), min(a.width, column + 3) + 1):
            if i < min(a.width, column + 3) and is_set(words, a.offset + j * a.stride, i):
                if start < 0:
                    start = i
            elif start >= 0:
                part, mx, my = square_share(x - start, y - j, cosine, sine, float(i - start), 1.0)
                area += part
                moment_x += mx + start * part
                moment_y += my + j * part
                start = -1
    return area, moment_x, moment_y


@subkernel
def shared_squares(rasters, words, mask_a, mask_b, u, v, cosine, sine):
    """(area [px2], moment of x, moment of y) of what two masks share; the moments over the area are its centroid."""
    a = rasters[mask_a]
    b = rasters[mask_b]
    area = 0.0
    moment_x = 0.0
    moment_y = 0.0
    margin = reach_of(cosine, sine) - 0.5
    left, top, right, bottom = box_in_raster(a, b, u, v, cosine, sine)
    for row in range(top, bottom):
        x = u + 0.5 * cosine - (row + 0.5) * sine
        y = v + 0.5 * sine + (row + 0.5) * cosine
        start, end = run_near(a, left, right, x, y, cosine, sine, margin)
        while start < end:
            solid = both(bits_from(words, b.offset + row * b.stride, b.stride, start), columns_up_to(end - start))
            while solid != word(0):
                column = start + lowest_bit(solid)
                solid = without_lowest(solid)
                px = x + column * cosine
                py = y + column * sine
                if is_set(words, a.halo + (math.floor(py) + 1) * a.halo_stride, math.floor(px) + 1):
                    part, mx, my = share_under(words, a, px, py, cosine, sine)
                    area += part
                    moment_x += mx
                    moment_y += my
            start += 64
    return area, moment_x, moment_y
