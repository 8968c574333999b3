"""Contact of two masks: where, which way out, and how far.

The normal is the direction in which moving B shrinks the shared area fastest: the gradient of the area over the
offset, by central differences of one pixel (the recipe of pygame's Mask documentation). Where it vanishes, the
direction between the centres of the solid bounds decides, then the axis of least overlap. The way out is searched
pixel by pixel along the normal; where the bounds could be pulled apart along an axis in less, that axis is taken, so
the depth is never more than the least overlap of the bounds.
"""

import math

from physics.jit import subkernel
from physics.math2d import length_of, unit
from physics.raster.overlap import first_pixel, line_moments, line_shared, shared_area, shared_moments


@subkernel
def center_normal(a, b, dx, dy):
    """Unit direction between the centres of two solid bounds; (1, 0) where they coincide."""
    x = float(b.set_left + b.set_right - a.set_left - a.set_right + 2 * dx)
    y = float(b.set_top + b.set_bottom - a.set_top - a.set_bottom + 2 * dy)
    length = math.sqrt(x * x + y * y)  # of whole pixels: nothing under- or overflows
    if length == 0.0:
        return 1.0, 0.0
    return x / length, y / length


@subkernel
def least_axis(a, b, dx, dy):
    """(normal, depth [px]) of the shortest move of B along an axis that parts the solid bounds."""
    right = float(a.set_right - (b.set_left + dx))
    left = float(b.set_right + dx - a.set_left)
    down = float(a.set_bottom - (b.set_top + dy))
    up = float(b.set_bottom + dy - a.set_top)
    least = min(min(right, left), min(down, up))
    if least == up:
        return 0.0, -1.0, least
    if least == down:
        return 0.0, 1.0, least
    if least == right:
        return 1.0, 0.0, least
    return -1.0, 0.0, least


@subkernel
def way_out(rasters, words, mask_a, mask_b, dx, dy, rest_ax, rest_ay, rest_bx, rest_by, nx, ny, most):
    """The shortest whole number of pixels along the normal after which nothing is shared; > most when none does.

    rest_* [px] in 0..1: what snapping took from the positions, so that the move is rounded as it will be, whether B is
    moved along the normal or A against it.
    """
    a = rasters[mask_a]
    b = rasters[mask_b]
    lines = a.stride == 1 and b.stride == 1
    box_a = (a.set_left, a.set_top, a.set_right, a.set_bottom)
    box_b = (b.set_left, b.set_top, b.set_right, b.set_bottom)
    row_a = a.offset
    row_b = b.offset
    depth = 0.0
    found = True
    row = 0  # where a pixel was shared last: mostly one is there a pixel further too
    while found and depth <= most:
        depth += 1.0
        x = dx + math.floor(rest_bx + nx * depth)
        y = dy + math.floor(rest_by + ny * depth)
        if lines:
            row = line_shared(words, row_a, box_a, row_b, box_b, x, y, row)
            found = row >= 0
        else:
            found, _, _ = first_pixel(rasters, words, mask_a, mask_b, x, y)
        if found:
            continue
        other_x = dx - math.floor(rest_ax - nx * depth)
        other_y = dy - math.floor(rest_ay - ny * depth)
        if lines and (other_x != x or other_y != y):
            row = line_shared(words, row_a, box_a, row_b, box_b, other_x, other_y, row)
            found = row >= 0
        elif other_x != x or other_y != y:
            found, _, _ = first_pixel(rasters, words, mask_a, mask_b, other_x, other_y)
    return depth


@subkernel
def mask_contact(rasters, words, mask_a, mask_b, dx, dy, rest_ax, rest_ay, rest_bx, rest_by):
    """Contact of two masks that share pixels: (area, point x, point y in A's raster, normal from A to B, separation).

    rest_*: see way_out. The point is the centroid of the shared pixels [px]; separation is negative, the move that ends
    the overlap.
    """
    a = rasters[mask_a]
    b = rasters[mask_b]
    if a.stride == 1 and b.stride == 1:
        box_a = (a.set_left, a.set_top, a.set_right, a.set_bottom)
        box_b = (b.set_left, b.set_top, b.set_right, b.set_bottom)
        area, sum_x, sum_y, more_x = line_moments(words, a.offset, box_a, b.offset, box_b, dx, dy)
    else:
        area, sum_x, sum_y = shared_moments(rasters, words, mask_a, mask_b, dx, dy)
        more_x = shared_area(rasters, words, mask_a, mask_b, dx - 1, dy)
        more_x -= shared_area(rasters, words, mask_a, mask_b, dx + 1, dy)
    more_y = shared_area(rasters, words, mask_a, mask_b, dx, dy - 1)
    more_y -= shared_area(rasters, words, mask_a, mask_b, dx, dy + 1)
    slope_x = float(more_x)
    slope_y = float(more_y)
    axis_x, axis_y, least = least_axis(a, b, dx, dy)
    nx, ny = unit(slope_x, slope_y, 0.0, 0.0)
    if length_of(slope_x, slope_y) == 0.0:
        nx, ny = center_normal(a, b, dx, dy)
        if b.set_left + b.set_right + 2 * dx == a.set_left + a.set_right and (
            b.set_top + b.set_bottom + 2 * dy == a.set_top + a.set_bottom
        ):
            nx = axis_x
            ny = axis_y
    depth = way_out(rasters, words, mask_a, mask_b, dx, dy, rest_ax, rest_ay, rest_bx, rest_by, nx, ny, least)
    if depth > least:
        depth = least
        nx = axis_x
        ny = axis_y
    return area, sum_x / area + 0.5, sum_y / area + 0.5, nx, ny, -depth
