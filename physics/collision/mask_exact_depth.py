"""Contact of two masks of which one at least is not snapped: where, which way out, and how far.

As for masks as drawn (mask_depth.py): the normal is the direction in which moving B shrinks the shared area fastest, by
differences of one pixel; where it vanishes, the direction between the centres of the boxes decides, then the axis of
least overlap of the boxes. The way out along it is exact, not in pixels. Where it is longer than the boxes' least
overlap, the way out along that axis is taken.

A is the mask in whose raster all is told; see raster/exact.py.
"""

import math

from physics.jit import subkernel
from physics.math2d import length_of, turned, unit
from physics.raster.exact import slack_of, squares_way_out
from physics.raster.shared_squares import shared_squares

NOISE = 1e-9  # of the area: what differences of it may owe to rounding


@subkernel
def boxes_normal(a, b):
    """(unit direction between the centres of the AABBs of two SHAPE rows, whether they are apart)."""
    x = (b.min_x - a.min_x) + (b.max_x - a.max_x)
    y = (b.min_y - a.min_y) + (b.max_y - a.max_y)
    nx, ny = unit(x, y, 1.0, 0.0)
    return nx, ny, x != 0.0 or y != 0.0


@subkernel
def boxes_axis(a, b):
    """(normal, depth [px]) of the shortest move of B along an axis of the world that parts the AABBs of two SHAPE
    rows."""
    up = b.max_y - a.min_y
    down = a.max_y - b.min_y
    right = a.max_x - b.min_x
    left = b.max_x - a.min_x
    least = min(min(right, left), min(down, up))
    if least == up:
        return 0.0, -1.0, least
    if least == down:
        return 0.0, 1.0, least
    if least == right:
        return 1.0, 0.0, least
    return -1.0, 0.0, least


@subkernel
def area_normal(rasters, words, mask_a, mask_b, u, v, cosine, sine, area):
    """(unit normal in A's raster, whether there is one): which way B's area in A shrinks fastest."""
    before, _, _ = shared_squares(rasters, words, mask_a, mask_b, u - 1.0, v, cosine, sine)
    behind, _, _ = shared_squares(rasters, words, mask_a, mask_b, u + 1.0, v, cosine, sine)
    above, _, _ = shared_squares(rasters, words, mask_a, mask_b, u, v - 1.0, cosine, sine)
    below, _, _ = shared_squares(rasters, words, mask_a, mask_b, u, v + 1.0, cosine, sine)
    nx, ny = unit(before - behind, above - below, 1.0, 0.0)
    return nx, ny, length_of(before - behind, above - below) > NOISE * area


@subkernel
def exact_contact(rasters, words, mask_a, mask_b, u, v, cosine, sine, a, b, turn_cosine, turn_sine):
    """(area [px2], point in A's raster, normal from A to B in the world, separation [px]) of masks that share area.

    a, b: their SHAPE rows; turn: cosine and sine of A's angle. The point is the centroid of what is shared; separation
    is negative, the move along the normal that ends it.
    """
    area, x, y = shared_squares(rasters, words, mask_a, mask_b, u, v, cosine, sine)
    slack = slack_of(rasters[mask_a], rasters[mask_b])
    area = max(area, slack * slack)
    axis_x, axis_y, least = boxes_axis(a, b)
    nx, ny, is_sloped = area_normal(rasters, words, mask_a, mask_b, u, v, cosine, sine, area)
    nx, ny = turned(nx, ny, turn_cosine, turn_sine)
    if not is_sloped:
        nx, ny, is_sloped = boxes_normal(a, b)
    depth = math.inf
    if is_sloped:
        rx, ry = turned(nx, ny, turn_cosine, -turn_sine)
        depth = squares_way_out(rasters, words, mask_a, mask_b, u, v, cosine, sine, rx, ry, least)
    if depth > least:
        nx = axis_x
        ny = axis_y
        rx, ry = turned(nx, ny, turn_cosine, -turn_sine)
        depth = squares_way_out(rasters, words, mask_a, mask_b, u, v, cosine, sine, rx, ry, least)
    return area, x / area, y / area, nx, ny, -depth
