"""Snapped masks: mask against mask by AND of their words, and mask against discs, hulls and bounds."""

import math
from typing import Any

from physics.collision.hulls import edge_gap, edge_normal, nearest_on_edge, pixel_feature
from physics.collision.manifold import MASKS, Point, add_manifold, make_pass
from physics.jit import inlined, subkernel
from physics.jit.plain import word
from physics.math2d import length_of, unit
from physics.raster.bits import (
    first_pixel,
    is_set,
    line_moments,
    line_shared,
    lowest_bit,
    shared_area,
    shared_moments,
    shared_rectangle,
    shared_row,
)
from physics.tables.step_state import MASK_TESTS

# ---- mask depth ------------------------------------------------------------------------------------------------------
# Contact of two masks: point, normal and depth.
#
# The normal is the direction in which moving B shrinks the shared area fastest. It is the gradient of the area over the
# offset, by central differences of one pixel (the recipe of pygame's Mask documentation). Where the gradient vanishes,
# the direction between the centres of the solid bounds is used, then their axis of least overlap. The depth is searched
# pixel by pixel along the normal. If the bounds separate sooner along an axis, that axis is taken: the depth is
# never more than the least overlap of the bounds.


@subkernel
def center_normal(a, b, dx, dy):
    """Return the unit direction between the centres of two solid bounds, (1, 0) if they coincide."""
    x = float(b.set_left + b.set_right - a.set_left - a.set_right + 2 * dx)
    y = float(b.set_top + b.set_bottom - a.set_top - a.set_bottom + 2 * dy)
    length = math.sqrt(x * x + y * y)  # of integers: no underflow or overflow
    if length == 0.0:
        return 1.0, 0.0
    return x / length, y / length


@subkernel
def least_axis(a, b, dx, dy):
    """Return (normal, depth [px]) of the shortest move of B along an axis that separates the solid bounds."""
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
    """Return the least whole number of pixels along the normal that ends the overlap; > most if none up to it does.

    rest_* [px] in 0..1: the parts of the positions removed by snapping. They round the tested move as the real one will
    be, whether B moves along the normal or A against it.
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
    row = 0  # row of the last shared pixel: a pixel further there usually is one too
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
    """Return (area, point x, point y in A's raster, normal from A to B, separation) of two masks that share pixels.

    rest_*: see way_out. The point is the centroid of the shared pixels [px]. The separation is negative: minus the move
    that ends the overlap.
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


# ---- mask hulls ------------------------------------------------------------------------------------------------------
# A mask against a disc and a convex polygon: the union of its pixel squares, as drawn, against the exact shape.
#
# Masks are open sets: a hit shares area, and touching is not a hit. The normal points from the mask to the other shape.
# Against a disc it runs from the centroid of the overlapping pixels to the centre. Against a polygon it is opposite to
# the face of least depth.


@subkernel
def pixel_range(low, high, start, set_low, set_high):
    """Return the first and last + 1 of the pixels whose squares meet the open interval low..high, within the bounds.

    The ends are clamped to the bounds before rounding, because an end may be infinite.
    """
    first = math.floor(min(float(set_high), max(float(set_low), low - start)))
    last = math.floor(max(set_low - 1.0, min(set_high - 1.0, high - start))) + 1
    return first, last


@subkernel
def leave_square(x, y, nx, ny, radius):
    """Return the distance [px] a disc at the origin moves along a unit normal to clear the unit square at (x, y).

    The disc's centre leaves the square grown by the radius through a rounded corner or a straight side.
    """
    depth = 0.0
    for corner in range(4):
        px = x + (corner & 1)
        py = y + (corner >> 1)
        across = nx * py - ny * px
        if across * across < radius * radius:
            depth = max(depth, nx * px + ny * py + math.sqrt(radius * radius - across * across))
    if nx != 0.0:
        move = (x + 1.0 + radius) / nx if nx > 0.0 else (x - radius) / nx
        if y <= move * ny <= y + 1.0:
            depth = max(depth, move)
    if ny != 0.0:
        move = (y + 1.0 + radius) / ny if ny > 0.0 else (y - radius) / ny
        if x <= move * nx <= x + 1.0:
            depth = max(depth, move)
    return depth


@subkernel
def collide_mask_circle(rasters, words, mask, left, top, x, y, radius):
    """Return (area in whole pixels, normal from mask to disc, point, separation, first pixel number) of a mask and a
    disc.

    left, top: raster position [px]. The point is the centroid of the overlapping pixels. The separation is minus the
    move of the disc along the normal that clears all pixels. O(pixels under the disc's bounds).
    """
    r = rasters[mask]
    first_x, last_x = pixel_range(x - radius, x + radius, left, r.set_left, r.set_right)
    first_y, last_y = pixel_range(y - radius, y + radius, top, r.set_top, r.set_bottom)
    area = 0
    sum_x = 0.0
    sum_y = 0.0
    first = -1
    for j in range(first_y, last_y):
        gap_y = max(max(top + j - y, y - (top + j + 1)), 0.0)
        for i in range(first_x, last_x):
            gap_x = max(max(left + i - x, x - (left + i + 1)), 0.0)
            if gap_x * gap_x + gap_y * gap_y < radius * radius and is_set(words, r.offset + j * r.stride, i):
                area += 1
                sum_x += left + i + 0.5
                sum_y += top + j + 0.5
                if first < 0:
                    first = j * r.width + i
    if area == 0:
        return 0, 0.0, -1.0, x, y, 0.0, 0
    point_x = sum_x / area
    point_y = sum_y / area
    nx, ny = unit(x - point_x, y - point_y, 0.0, -1.0)
    depth = 0.0
    for j in range(first_y, last_y):
        gap_y = max(max(top + j - y, y - (top + j + 1)), 0.0)
        for i in range(first_x, last_x):
            gap_x = max(max(left + i - x, x - (left + i + 1)), 0.0)
            if gap_x * gap_x + gap_y * gap_y < radius * radius and is_set(words, r.offset + j * r.stride, i):
                depth = max(depth, leave_square(left + i - x, top + j - y, nx, ny, radius))
    return area, nx, ny, point_x, point_y, -depth, first


@subkernel
def thick_line(points, front, back, corners_out):
    """Write the rectangle that extends `front` and `back` [px] to the sides of the line from points[0] to points[1]."""
    nx, ny = unit(points[1, 1] - points[0, 1], points[0, 0] - points[1, 0], 0.0, -1.0)
    for k in range(4):
        end = 0 if k == 0 or k == 3 else 1
        away = front if k < 2 else -back
        corners_out[k, 0] = points[end, 0] + away * nx
        corners_out[k, 1] = points[end, 1] + away * ny


@subkernel
def square_in_polygon(corners, count, x, y):
    """Return whether the pixel square at x, y and a convex polygon share area (separating axis test)."""
    min_x = math.inf
    max_x = -math.inf
    min_y = math.inf
    max_y = -math.inf
    for k in range(count):
        min_x = min(min_x, corners[k, 0])
        max_x = max(max_x, corners[k, 0])
        min_y = min(min_y, corners[k, 1])
        max_y = max(max_y, corners[k, 1])
        nx, ny = edge_normal(corners, count, k)
        # The corner of the square that lies deepest behind the edge.
        px = x if nx > 0.0 else x + 1.0
        py = y if ny > 0.0 else y + 1.0
        if nx * (px - corners[k, 0]) + ny * (py - corners[k, 1]) >= 0.0:
            return False
    return x < max_x and x + 1.0 > min_x and y < max_y and y + 1.0 > min_y


@subkernel
def collide_mask_polygon(rasters, words, mask, left, top, corners, count, edges, depths_out):
    """Return the result of collide_mask_circle for a convex polygon, world corners (n, 2) [px] clockwise on the screen.

    edges: bits of the edges that may be touched; depths_out (16,): scratch. The normal is that of the touchable edge
    with the least depth of the overlapping pixels.
    """
    r = rasters[mask]
    min_x = math.inf
    max_x = -math.inf
    min_y = math.inf
    max_y = -math.inf
    for k in range(count):
        min_x = min(min_x, corners[k, 0])
        max_x = max(max_x, corners[k, 0])
        min_y = min(min_y, corners[k, 1])
        max_y = max(max_y, corners[k, 1])
        depths_out[k] = 0.0
    first_x, last_x = pixel_range(min_x, max_x, left, r.set_left, r.set_right)
    first_y, last_y = pixel_range(min_y, max_y, top, r.set_top, r.set_bottom)
    area = 0
    sum_x = 0.0
    sum_y = 0.0
    first = -1
    for j in range(first_y, last_y):
        for i in range(first_x, last_x):
            x = float(left + i)
            y = float(top + j)
            if not is_set(words, r.offset + j * r.stride, i) or not square_in_polygon(corners, count, x, y):
                continue
            area += 1
            sum_x += x + 0.5
            sum_y += y + 0.5
            if first < 0:
                first = j * r.width + i
            for k in range(count):
                nx, ny = edge_normal(corners, count, k)
                px = x if nx > 0.0 else x + 1.0
                py = y if ny > 0.0 else y + 1.0
                depths_out[k] = max(depths_out[k], -(nx * (px - corners[k, 0]) + ny * (py - corners[k, 1])))
    if area == 0:
        return 0, 0.0, -1.0, 0.0, 0.0, 0.0, 0
    best = -1
    for k in range(count):
        if (edges >> k) & 1 and (best < 0 or depths_out[k] < depths_out[best]):
            best = k
    if best < 0:
        for k in range(count):
            if best < 0 or depths_out[k] < depths_out[best]:
                best = k
    nx, ny = edge_normal(corners, count, best)
    return area, -nx, -ny, sum_x / area, sum_y / area, -depths_out[best], first


@subkernel
def border_pixels(rasters, words, mask, line, low, high, level):
    """Return (pairs of solid pixels on both sides of a grid border along an open interval, sum of their middles along
    it, first pixel number).

    line: the border's column or row in the raster; low, high [px]: the interval in the raster; level: it is a row.
    """
    r = rasters[mask]
    size = r.height if level else r.width
    across = r.width if level else r.height
    found = 0
    middle = 0.0
    first = -1
    if line <= 0 or line >= size:
        return found, middle, first
    for k in range(max(0, math.floor(low)), min(across, math.ceil(high))):
        row = line if level else k
        column = k if level else line
        before_row = line - 1 if level else k
        before_column = k if level else line - 1
        if is_set(words, r.offset + row * r.stride, column) and is_set(
            words, r.offset + before_row * r.stride, before_column
        ):
            found += 1
            middle += k + 0.5
            if first < 0:
                first = row * r.width + column
    return found, middle, first


@subkernel
def collide_mask_line(rasters, words, mask, left, top, points, depths_out):
    """Return the result of collide_mask_circle for the line from points[0] to points[1] [px], solid from both sides.

    The line is hit where it crosses a solid pixel, or runs along the border of two solid pixels. At a border the normal
    points to the side further from the middle of the mask. depths_out (16,): scratch.
    """
    area, nx, ny, x, y, separation, first = collide_mask_polygon(
        rasters, words, mask, left, top, points, 2, 3, depths_out
    )
    level = points[0, 1] == points[1, 1] and points[0, 1] == math.floor(points[0, 1])
    upright = points[0, 0] == points[1, 0] and points[0, 0] == math.floor(points[0, 0])
    if area > 0 or level == upright:
        return area, nx, ny, x, y, separation, first
    r = rasters[mask]
    along = 0 if level else 1
    start = left if level else top
    border = points[0, 1] - top if level else points[0, 0] - left
    low = min(points[0, along], points[1, along]) - start
    high = max(points[0, along], points[1, along]) - start
    found, middle, first = border_pixels(rasters, words, mask, math.floor(border), low, high, level)
    if found == 0:
        return 0, 0.0, -1.0, 0.0, 0.0, 0.0, 0
    inside = 0.5 * (r.set_top + r.set_bottom) if level else 0.5 * (r.set_left + r.set_right)
    side = 1.0 if border >= inside else -1.0
    if level:
        return 2 * found, 0.0, side, start + middle / found, points[0, 1], -1.0, first
    return 2 * found, side, 0.0, points[0, 0], start + middle / found, -1.0, first


# ---- mask rounded ----------------------------------------------------------------------------------------------------
# A mask, as the union of its pixel squares as drawn, against an exact rounded hull (capsule, rounded polygon).
# See "mask hulls" above for discs and sharp polygons.


@subkernel
def square_gap(corners, count, x, y):
    """Return the distance [px] between a core and the pixel square at x, y; 0 where they share area."""
    if square_in_polygon(corners, count, x, y):
        return 0.0
    gap = math.inf
    for k in range(count):
        n = k + 1 if k + 1 < count else 0
        for corner in range(4):
            gap = min(
                gap,
                edge_gap(
                    corners[k, 0], corners[k, 1], corners[n, 0], corners[n, 1], x + (corner & 1), y + (corner >> 1)
                ),
            )
        beside = max(max(x - corners[k, 0], corners[k, 0] - x - 1.0), 0.0)
        above = max(max(y - corners[k, 1], corners[k, 1] - y - 1.0), 0.0)
        gap = min(gap, length_of(beside, above))
    return gap


@subkernel
def way_to_core(corners, count, x, y):
    """Return the unit direction from (x, y) to the nearest point of a core's outline, (0, -1) on it."""
    best = math.inf
    dx = 0.0
    dy = 0.0
    for k in range(count):
        n = k + 1 if k + 1 < count else 0
        t = nearest_on_edge(corners[k, 0], corners[k, 1], corners[n, 0], corners[n, 1], x, y)
        px = corners[k, 0] + t * (corners[n, 0] - corners[k, 0]) - x
        py = corners[k, 1] + t * (corners[n, 1] - corners[k, 1]) - y
        if length_of(px, py) < best:
            best = length_of(px, py)
            dx = px
            dy = py
    return unit(dx, dy, 0.0, -1.0)


@subkernel
def depth_along(rasters, words, mask, left, top, corners, count, radius, first_x, last_x, first_y, last_y, nx, ny):
    """Return the move [px] of a rounded hull along a unit direction after which a line separates it from its pixels."""
    r = rasters[mask]
    least = math.inf
    for k in range(count):
        least = min(least, nx * corners[k, 0] + ny * corners[k, 1])
    most = -math.inf
    for j in range(first_y, last_y):
        for i in range(first_x, last_x):
            x = float(left + i)
            y = float(top + j)
            if is_set(words, r.offset + j * r.stride, i) and square_gap(corners, count, x, y) < radius:
                most = max(most, nx * (x + 1.0 if nx > 0.0 else x) + ny * (y + 1.0 if ny > 0.0 else y))
    return most - least + radius


@subkernel
def collide_mask_rounded(rasters, words, mask, left, top, corners, count, radius):
    """Return (area in whole pixels, normal from mask to hull, point, separation, first pixel number) of a mask and a
    rounded hull.

    corners (n, 2) [px] world, clockwise on the screen; left, top: raster position [px]. The point is the centroid of
    the overlapping pixels. The normal is against a face's, or from the centroid to the core, whichever has the least
    depth. The separation is minus the move along it that clears the pixels. O(pixels under the hull's bounds · count).
    """
    r = rasters[mask]
    min_x = math.inf
    max_x = -math.inf
    min_y = math.inf
    max_y = -math.inf
    for k in range(count):
        min_x = min(min_x, corners[k, 0] - radius)
        max_x = max(max_x, corners[k, 0] + radius)
        min_y = min(min_y, corners[k, 1] - radius)
        max_y = max(max_y, corners[k, 1] + radius)
    first_x, last_x = pixel_range(min_x, max_x, left, r.set_left, r.set_right)
    first_y, last_y = pixel_range(min_y, max_y, top, r.set_top, r.set_bottom)
    area = 0
    sum_x = 0.0
    sum_y = 0.0
    first = -1
    for j in range(first_y, last_y):
        for i in range(first_x, last_x):
            if (
                is_set(words, r.offset + j * r.stride, i)
                and square_gap(corners, count, float(left + i), float(top + j)) < radius
            ):
                area += 1
                sum_x += left + i + 0.5
                sum_y += top + j + 0.5
                if first < 0:
                    first = j * r.width + i
    if area == 0:
        return 0, 0.0, -1.0, 0.0, 0.0, 0.0, 0
    point_x = sum_x / area
    point_y = sum_y / area
    best_x = 0.0
    best_y = -1.0
    depth = math.inf
    for k in range(count + 1):
        if k < count:
            mx, my = edge_normal(corners, count, k)
            nx = -mx
            ny = -my
        else:
            nx, ny = way_to_core(corners, count, point_x, point_y)
        out = depth_along(
            rasters, words, mask, left, top, corners, count, radius, first_x, last_x, first_y, last_y, nx, ny
        )
        if out < depth:
            depth = out
            best_x = nx
            best_y = ny
    return area, best_x, best_y, point_x, point_y, -depth, first


@subkernel
def collide_mask_hull(rasters, words, mask, left, top, corners, count, radius, edges, depths_out):
    """Return (area in whole pixels, normal from the mask, point, separation, first pixel number) of a mask and a hull.

    corners (n, 2) [px], grown by radius [px], in the space in which the raster is at left, top: one corner is a disc,
    two are a line or a capsule. edges: bits of the edges that may be touched; depths_out (16,): scratch.
    """
    if count == 1:
        return collide_mask_circle(rasters, words, mask, left, top, corners[0, 0], corners[0, 1], radius)
    if radius > 0.0:
        return collide_mask_rounded(rasters, words, mask, left, top, corners, count, radius)
    if count == 2:
        return collide_mask_line(rasters, words, mask, left, top, corners, depths_out)
    return collide_mask_polygon(rasters, words, mask, left, top, corners, count, edges, depths_out)


# ---- mask pairs ------------------------------------------------------------------------------------------------------
# Pairs with snapped masks: mask against mask by AND.


@inlined
def bounds_overlap(batch, pair):
    """Return whether the solid bounds of two masks overlap as drawn."""
    a = batch.shapes[batch.candidates[pair, 0]]
    b = batch.shapes[batch.candidates[pair, 1]]
    rasters = batch.geometry.rasters
    left, top, right, bottom = shared_rectangle(rasters[a.raster], rasters[b.raster], b.left - a.left, b.top - a.top)
    return (left < right) & (top < bottom)


def make_mask_pass(full: bool) -> Any:
    """Return the pass over pairs of snapped masks: with area, centroid, normal and depth, or the first shared pixel.

    In the second form the normal is the direction between the centres and the separation is -1.
    """

    @inlined
    def collide_mask_pair(batch, pair, workspace, manifolds_out, found, work_inout):
        """Append the contact of two masks as drawn, by AND of words. Return the new count."""
        shapes = batch.shapes
        candidates = batch.candidates
        rasters = batch.geometry.rasters
        words = batch.geometry.words
        a = shapes[candidates[pair, 0]]
        b = shapes[candidates[pair, 1]]
        dx = b.left - a.left
        dy = b.top - a.top
        r = rasters[a.raster]
        s = rasters[b.raster]
        left, top, right, bottom = shared_rectangle(r, s, dx, dy)
        work_inout[MASK_TESTS] += 1
        if r.stride == 1 and s.stride == 1:
            # Sprites up to 64 px wide: one word per row, so both shifts are the same in every row.
            row, shared = shared_row(words, r.offset + top, left, s.offset + top - dy, left - dx, bottom - top)
            if shared == word(0):
                return found
            x = left + lowest_bit(shared)
            y = top + row
        else:
            hit, x, y = first_pixel(rasters, words, a.raster, b.raster, dx, dy)
            if not hit:
                return found
        area = 0.0
        px = x + 0.5
        py = y + 0.5
        separation = -1.0
        if full:
            p = batch.bodies[a.body_row]
            q = batch.bodies[b.body_row]
            pixels, px, py, nx, ny, separation = mask_contact(
                rasters,
                words,
                a.raster,
                b.raster,
                dx,
                dy,
                p.x - r.origin_x + 0.5 - a.left,
                p.y - r.origin_y + 0.5 - a.top,
                q.x - s.origin_x + 0.5 - b.left,
                q.y - s.origin_y + 0.5 - b.top,
            )
            area = float(pixels)
        else:
            nx, ny = center_normal(r, s, dx, dy)
        point = Point(nx, ny, a.left + px, a.top + py, separation, area, pixel_feature(y, x, r.width))
        return add_manifold(shapes, candidates, pair, point, manifolds_out, found)

    return make_pass(MASKS, collide_mask_pair, bounds_overlap)


collide_mask_pairs_full = make_mask_pass(full=True)
collide_mask_pairs_hit = make_mask_pass(full=False)
