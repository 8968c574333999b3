"""Collision of masks drawn on whole pixels (snap=True) with hulls, and with each other by AND of their bit words."""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from physics.collision.hulls import Hull, distance_to_edge, edge_normal, extent_along, nearest_on_edge, pixel_feature
from physics.collision.manifold import MASKS, add_manifold, make_pass
from physics.jit import inlined, subkernel
from physics.jit.plain import word
from physics.math2d import norm, unit
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
# The normal is the direction in which moving B shrinks the shared area fastest: the gradient of the area over the
# offset, by central differences of one pixel (the recipe of pygame's Mask documentation). If the gradient is 0, the
# normal is the direction between the centres of the solid bounds. If the centres also coincide, it is the axis of least
# overlap of the bounds. The depth is searched pixel by pixel along the normal. If the bounds separate after a shorter
# move along an axis, this axis is used, so the depth is never more than the least overlap of the bounds.


@subkernel
def center_normal(a, b, dx, dy):
    """Return the unit vector from the centre of A's solid pixels to that of B's solid pixels; (1, 0) if they coincide.

    The centres are those of the bounding boxes of the solid pixels. a, b: RASTER rows; dx, dy [px]: offset of B's top
    left corner from A's top left corner.
    """
    x = float(b.set_left + b.set_right - a.set_left - a.set_right + 2 * dx)
    y = float(b.set_top + b.set_bottom - a.set_top - a.set_bottom + 2 * dy)
    length = math.sqrt(x * x + y * y)  # of integers: no underflow or overflow
    if length == 0.0:
        return 1.0, 0.0
    return x / length, y / length


@subkernel
def least_overlap(right, left, down, up):
    """Return the shortest move of B along an axis that separates two overlapping boxes, as (nx, ny, length [px]).

    nx, ny: unit vector of the move. right, left, down, up [px]: length of the move needed in each direction.
    """
    least = min(min(right, left), min(down, up))
    if least == up:
        return 0.0, -1.0, least
    if least == down:
        return 0.0, 1.0, least
    if least == right:
        return 1.0, 0.0, least
    return -1.0, 0.0, least


class RasterPair(NamedTuple):
    """Two rasters, and the offset of the second from the first in whole pixels."""

    rasters: np.ndarray  # RASTER
    words: np.ndarray  # uint64
    a: int  # rows of RASTER: A and …
    b: int  # … B
    dx: int  # [px] offset of B's top left corner from A's
    dy: int


class Remainders(NamedTuple):
    """Fractions [px] in 0..1 that snapping, floor(position + 0.5), has cut off from the positions of masks A and B.

    With these fractions, a trial move is rounded to the same pixels as the real move would be.
    """

    ax: float
    ay: float
    bx: float
    by: float


@subkernel
def separation_along(pair, remainders, nx, ny, most):
    """Return the least whole number of pixels to move along the normal (nx, ny) that ends the overlap of two rasters.

    The overlap must end if B moves along the normal, and also if A moves against the normal. A result above `most` [px]
    means that no move up to `most` is enough. pair: RasterPair; remainders: Remainders of its masks.
    """
    rasters = pair.rasters
    words = pair.words
    a, b = rasters[pair.a], rasters[pair.b]
    lines = a.stride == 1 and b.stride == 1
    box_a = (a.set_left, a.set_top, a.set_right, a.set_bottom)
    box_b = (b.set_left, b.set_top, b.set_right, b.set_bottom)
    row_a, row_b = a.offset, b.offset
    depth = 0.0
    found = True
    row = 0  # row of the last shared pixel; one pixel farther, the same row usually shares a pixel again
    while found and depth <= most:
        depth += 1.0
        x = pair.dx + math.floor(remainders.bx + nx * depth)
        y = pair.dy + math.floor(remainders.by + ny * depth)
        if lines:
            row = line_shared(words, row_a, box_a, row_b, box_b, x, y, row)
            found = row >= 0
        else:
            found, _, _ = first_pixel(rasters, words, pair.a, pair.b, x, y)
        if found:
            continue
        other_x = pair.dx - math.floor(remainders.ax - nx * depth)
        other_y = pair.dy - math.floor(remainders.ay - ny * depth)
        if lines and (other_x != x or other_y != y):
            row = line_shared(words, row_a, box_a, row_b, box_b, other_x, other_y, row)
            found = row >= 0
        elif other_x != x or other_y != y:
            found, _, _ = first_pixel(rasters, words, pair.a, pair.b, other_x, other_y)
    return depth


@subkernel
def mask_contact(pair, remainders):
    """Return (area, x, y, nx, ny, separation) of a RasterPair that shares pixels.

    area: number of shared pixels; x, y [px]: centroid of these pixels in A's raster; nx, ny: unit normal from A to B;
    separation [px]: minus the length of the move along the normal that ends the overlap. remainders: Remainders of the
    masks.
    """
    rasters = pair.rasters
    words = pair.words
    dx, dy = pair.dx, pair.dy
    a, b = rasters[pair.a], rasters[pair.b]
    if a.stride == 1 and b.stride == 1:
        box_a = (a.set_left, a.set_top, a.set_right, a.set_bottom)
        box_b = (b.set_left, b.set_top, b.set_right, b.set_bottom)
        area, sum_x, sum_y, more_x = line_moments(words, a.offset, box_a, b.offset, box_b, dx, dy)
    else:
        area, sum_x, sum_y = shared_moments(rasters, words, pair.a, pair.b, dx, dy)
        more_x = shared_area(rasters, words, pair.a, pair.b, dx - 1, dy)
        more_x -= shared_area(rasters, words, pair.a, pair.b, dx + 1, dy)
    more_y = shared_area(rasters, words, pair.a, pair.b, dx, dy - 1)
    more_y -= shared_area(rasters, words, pair.a, pair.b, dx, dy + 1)
    slope_x, slope_y = float(more_x), float(more_y)
    axis_x, axis_y, least = least_overlap(
        float(a.set_right - (b.set_left + dx)),
        float(b.set_right + dx - a.set_left),
        float(a.set_bottom - (b.set_top + dy)),
        float(b.set_bottom + dy - a.set_top),
    )
    nx, ny = unit(slope_x, slope_y, 0.0, 0.0)
    if norm(slope_x, slope_y) == 0.0:
        nx, ny = center_normal(a, b, dx, dy)
        if b.set_left + b.set_right + 2 * dx == a.set_left + a.set_right and (
            b.set_top + b.set_bottom + 2 * dy == a.set_top + a.set_bottom
        ):
            nx, ny = axis_x, axis_y
    depth = separation_along(pair, remainders, nx, ny, least)
    if depth > least:
        depth = least
        nx, ny = axis_x, axis_y
    return area, sum_x / area + 0.5, sum_y / area + 0.5, nx, ny, -depth


# ---- mask hulls ------------------------------------------------------------------------------------------------------
# Collision of a mask with a disc or convex polygon. The mask is the union of its pixel squares as drawn.
#
# Masks are open sets: a hit shares area, and touching is not a hit. The normal points from the mask to the other shape.
# Against a disc it points from the centroid of the overlapping pixels to the disc's centre. Against a polygon it is
# opposite to the normal of the face of least depth.


@subkernel
def pixel_range(low, high, start, set_low, set_high):
    """Return (first, last + 1): the indices of the pixels on one axis that overlap the open interval low..high.

    low, high [px]: ends of the interval, may be infinite; start [px]: position of pixel 0. The result is limited to the
    range set_low..set_high of the solid pixels.
    """
    first = math.floor(min(float(set_high), max(float(set_low), low - start)))
    last = math.floor(max(set_low - 1.0, min(set_high - 1.0, high - start))) + 1
    return first, last


class PlacedRaster(NamedTuple):
    """A mask's raster, and the position of its top left corner in the coordinate system of the other shape."""

    rasters: np.ndarray  # RASTER
    words: np.ndarray  # uint64
    row: int  # row of RASTER
    left: int  # [px] position
    top: int


@subkernel
def hull_bounds(hull):
    """Return the AABB (min_x, min_y, max_x, max_y) [px] of a Hull."""
    min_x, max_x = math.inf, -math.inf
    min_y, max_y = math.inf, -math.inf
    for k in range(hull.count):
        min_x = min(min_x, hull.corners[k, 0] - hull.radius)
        max_x = max(max_x, hull.corners[k, 0] + hull.radius)
        min_y = min(min_y, hull.corners[k, 1] - hull.radius)
        max_y = max(max_y, hull.corners[k, 1] + hull.radius)
    return min_x, min_y, max_x, max_y


@subkernel
def pixels_under(raster, hull):
    """Return (first column, last column + 1, first row, last row + 1) of the pixels of a PlacedRaster in a Hull's AABB.

    The ranges are limited to the bounding box of the solid pixels.
    """
    r = raster.rasters[raster.row]
    min_x, min_y, max_x, max_y = hull_bounds(hull)
    first_x, last_x = pixel_range(min_x, max_x, raster.left, r.set_left, r.set_right)
    first_y, last_y = pixel_range(min_y, max_y, raster.top, r.set_top, r.set_bottom)
    return first_x, last_x, first_y, last_y


def make_pixel_sum(touches: Callable) -> Any:
    """Return a kernel that counts the solid pixels of a mask that overlap a hull, and computes their centroid.

    touches(hull, x, y, depths_out): an inlined test that returns whether the hull overlaps the pixel with top left
    corner (x, y).
    """

    @subkernel
    def sum_pixels(raster, hull, depths_out):
        """Return (number of overlapping pixels, centroid x and y [px], pixel_feature of the first pixel).

        All values are 0 without overlap. raster: PlacedRaster; depths_out (16,): scratch for `touches`.
        """
        r = raster.rasters[raster.row]
        first_x, last_x, first_y, last_y = pixels_under(raster, hull)
        area = 0
        sum_x, sum_y = 0.0, 0.0
        first = 0
        for j in range(first_y, last_y):
            y = float(raster.top + j)
            for i in range(first_x, last_x):
                x = float(raster.left + i)
                if is_set(raster.words, r.offset + j * r.stride, i) and touches(hull, x, y, depths_out):
                    if area == 0:
                        first = pixel_feature(j, i, r.width)
                    area += 1
                    sum_x += x + 0.5
                    sum_y += y + 0.5
        if area == 0:
            return 0, 0.0, 0.0, 0
        return area, sum_x / area, sum_y / area, first

    return sum_pixels


@inlined
def square_in_disc(hull, x, y, depths_out):
    """Return whether the unit square with top left corner (x, y) shares area with a disc (a Hull of one corner).

    depths_out is not used; make_pixel_sum requires the argument.
    """
    beside = max(max(x - hull.corners[0, 0], hull.corners[0, 0] - (x + 1.0)), 0.0)
    above = max(max(y - hull.corners[0, 1], hull.corners[0, 1] - (y + 1.0)), 0.0)
    return beside * beside + above * above < hull.radius * hull.radius


@subkernel
def square_exit_distance(x, y, nx, ny, radius):
    """Return the distance [px] that a disc at the origin must move along (nx, ny) to leave a unit square.

    x, y: top left corner of the square; nx, ny: unit vector; radius [px]: radius of the disc. The result is the
    distance at which the disc's centre leaves the square grown by the radius (with rounded corners).
    """
    depth = 0.0
    for corner in range(4):
        px, py = x + (corner & 1), y + (corner >> 1)
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


sum_pixels_in_disc = make_pixel_sum(square_in_disc)


@subkernel
def collide_mask_circle(raster, hull, depths_out):
    """Collide a PlacedRaster with a disc (Hull of one corner). Return (area, nx, ny, x, y, separation, feature).

    area: number of overlapping pixels, 0 for no contact; nx, ny: unit normal from mask to disc; x, y [px]: centroid of
    the overlapping pixels; separation [px]: minus the length of the disc's move along the normal that clears all
    pixels; feature: pixel_feature of the first overlapping pixel. O(pixels in the disc's AABB). depths_out (16,):
    scratch.
    """
    r = raster.rasters[raster.row]
    cx = hull.corners[0, 0]
    cy = hull.corners[0, 1]
    area, point_x, point_y, first = sum_pixels_in_disc(raster, hull, depths_out)
    if area == 0:
        return 0, 0.0, -1.0, cx, cy, 0.0, 0
    nx, ny = unit(cx - point_x, cy - point_y, 0.0, -1.0)
    depth = 0.0
    first_x, last_x, first_y, last_y = pixels_under(raster, hull)
    for j in range(first_y, last_y):
        y = float(raster.top + j)
        for i in range(first_x, last_x):
            x = float(raster.left + i)
            if is_set(raster.words, r.offset + j * r.stride, i) and square_in_disc(hull, x, y, depths_out):
                depth = max(depth, square_exit_distance(x - cx, y - cy, nx, ny, hull.radius))
    return area, nx, ny, point_x, point_y, -depth, first


@subkernel
def offset_line(points, front, back, corners_out):
    """Write the 4 corners of a rectangle: the line from points[0] to points[1], widened to both sides.

    front, back [px]: width in front of the line (towards its normal (dy, -dx)) and behind the line.
    """
    nx, ny = unit(points[1, 1] - points[0, 1], points[0, 0] - points[1, 0], 0.0, -1.0)
    for k in range(4):
        end = 0 if k == 0 or k == 3 else 1
        away = front if k < 2 else -back
        corners_out[k, 0] = points[end, 0] + away * nx
        corners_out[k, 1] = points[end, 1] + away * ny


@subkernel
def square_in_polygon(corners, count, x, y):
    """Return whether the unit square with top left corner (x, y) shares area with a convex polygon (SAT)."""
    min_x, max_x = math.inf, -math.inf
    min_y, max_y = math.inf, -math.inf
    for k in range(count):
        min_x = min(min_x, corners[k, 0])
        max_x = max(max_x, corners[k, 0])
        min_y = min(min_y, corners[k, 1])
        max_y = max(max_y, corners[k, 1])
        nx, ny = edge_normal(corners, count, k)
        # (px, py) is the corner of the square that lies deepest behind the edge.
        px = x if nx > 0.0 else x + 1.0
        py = y if ny > 0.0 else y + 1.0
        if nx * (px - corners[k, 0]) + ny * (py - corners[k, 1]) >= 0.0:
            return False
    return x < max_x and x + 1.0 > min_x and y < max_y and y + 1.0 > min_y


@inlined
def square_depths(hull, x, y, depths_out):
    """Return whether the unit square with top left corner (x, y) shares area with a convex polygon.

    If so, depths_out is raised to the square's depths where these are greater. hull: the polygon; depths_out (16,): for
    each edge of the polygon, the greatest depth [px] behind the edge of all squares tested so far.
    """
    corners = hull.corners
    if not square_in_polygon(corners, hull.count, x, y):
        return False
    for k in range(hull.count):
        nx, ny = edge_normal(corners, hull.count, k)
        px = x if nx > 0.0 else x + 1.0
        py = y if ny > 0.0 else y + 1.0
        depths_out[k] = max(depths_out[k], -(nx * (px - corners[k, 0]) + ny * (py - corners[k, 1])))
    return True


sum_pixels_in_polygon = make_pixel_sum(square_depths)


@subkernel
def collide_mask_polygon(raster, hull, depths_out):
    """Collide a PlacedRaster with a polygon (Hull without rounding). Return (area, nx, ny, x, y, separation, feature).

    The reference is the edge of the polygon behind which the overlapping pixels are least deep. Only edges that no
    neighbouring part covers are considered, if there are any. The normal is opposite to the normal of the reference
    edge, and the separation is minus this depth [px]. Other values as in collide_mask_circle. depths_out (16,):
    scratch.
    """
    count = hull.count
    for k in range(count):
        depths_out[k] = 0.0
    area, x, y, first = sum_pixels_in_polygon(raster, hull, depths_out)
    if area == 0:
        return 0, 0.0, -1.0, 0.0, 0.0, 0.0, 0
    best = -1
    for k in range(count):
        if (hull.edges >> k) & 1 and (best < 0 or depths_out[k] < depths_out[best]):
            best = k
    if best < 0:
        for k in range(count):
            if best < 0 or depths_out[k] < depths_out[best]:
                best = k
    nx, ny = edge_normal(hull.corners, count, best)
    return area, -nx, -ny, x, y, -depths_out[best], first


@subkernel
def border_pixels(raster, line, low, high, level):
    """Find the positions where a border between two rows or columns of pixels has solid pixels on both sides.

    Return (number of positions, sum of the positions [px] along the border, pixel_feature of the first or -1). raster:
    PlacedRaster; line: index of the row or column after the border; level: True for a border between rows, False for
    one between columns; low, high [px]: open interval along the border to search, relative to the raster's top left
    corner.
    """
    words = raster.words
    r = raster.rasters[raster.row]
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
def collide_mask_line(raster, hull, depths_out):
    """Collide a PlacedRaster with a line segment (Hull of two corners).

    Return (area, nx, ny, x, y, separation, feature). The line is solid from both sides. The line touches the mask if it
    crosses a solid pixel, or if it is exactly on the border between two solid pixels. On such a border the normal
    points away from the middle of the mask, and the separation is -1. Other values as in collide_mask_polygon.
    depths_out (16,): scratch.
    """
    points = hull.corners
    left, top = raster.left, raster.top
    area, nx, ny, x, y, separation, first = collide_mask_polygon(raster, Hull(points, 2, 0.0, 3), depths_out)
    level = points[0, 1] == points[1, 1] and points[0, 1] == math.floor(points[0, 1])
    upright = points[0, 0] == points[1, 0] and points[0, 0] == math.floor(points[0, 0])
    if area > 0 or level == upright:
        return area, nx, ny, x, y, separation, first
    r = raster.rasters[raster.row]
    along = 0 if level else 1
    start = left if level else top
    border = points[0, 1] - top if level else points[0, 0] - left
    low = min(points[0, along], points[1, along]) - start
    high = max(points[0, along], points[1, along]) - start
    found, middle, first = border_pixels(raster, math.floor(border), low, high, level)
    if found == 0:
        return 0, 0.0, -1.0, 0.0, 0.0, 0.0, 0
    inside = 0.5 * (r.set_top + r.set_bottom) if level else 0.5 * (r.set_left + r.set_right)
    side = 1.0 if border >= inside else -1.0
    if level:
        return 2 * found, 0.0, side, start + middle / found, points[0, 1], -1.0, first
    return 2 * found, side, 0.0, points[0, 0], start + middle / found, -1.0, first


# ---- mask rounded ----------------------------------------------------------------------------------------------------
# Collision of a mask with a rounded hull (capsule, rounded polygon). For discs and sharp polygons see "mask hulls"
# above. The core of a rounded hull is the polygon of its corners, without the rounding.


@subkernel
def square_distance(corners, count, x, y):
    """Return the distance [px] of a convex polygon from the unit square with top left corner (x, y); 0 if they overlap.

    corners, count: corners [px] of the polygon and their number. For a rounded hull, pass the corners without the
    rounding.
    """
    if square_in_polygon(corners, count, x, y):
        return 0.0
    gap = math.inf
    for k in range(count):
        n = k + 1 if k + 1 < count else 0
        ax = corners[k, 0]
        ay = corners[k, 1]
        for corner in range(4):
            px, py = x + (corner & 1), y + (corner >> 1)
            gap = min(gap, distance_to_edge(ax, ay, corners[n, 0], corners[n, 1], px, py))
        beside = max(max(x - ax, ax - x - 1.0), 0.0)
        above = max(max(y - ay, ay - y - 1.0), 0.0)
        gap = min(gap, norm(beside, above))
    return gap


@inlined
def square_in_rounded(hull, x, y, depths_out):
    """Return whether the unit square with top left corner (x, y) shares area with a rounded hull.

    depths_out is not used; make_pixel_sum requires the argument.
    """
    return square_distance(hull.corners, hull.count, x, y) < hull.radius


@subkernel
def direction_to_core(corners, count, x, y):
    """Return the unit direction from (x, y) to the nearest point of a polygon's outline; (0, -1) for a point on it.

    The polygon is the core of a rounded hull, which is the hull without its rounding.
    """
    best = math.inf
    dx, dy = 0.0, 0.0
    for k in range(count):
        n = k + 1 if k + 1 < count else 0
        t = nearest_on_edge(corners[k, 0], corners[k, 1], corners[n, 0], corners[n, 1], x, y)
        px = corners[k, 0] + t * (corners[n, 0] - corners[k, 0]) - x
        py = corners[k, 1] + t * (corners[n, 1] - corners[k, 1]) - y
        if norm(px, py) < best:
            best = norm(px, py)
            dx, dy = px, py
    return unit(dx, dy, 0.0, -1.0)


@subkernel
def depth_along(raster, hull, nx, ny):
    """Return the distance [px] that a rounded hull must move along the unit vector (nx, ny) to leave a mask.

    After this move, a line perpendicular to (nx, ny) separates the hull from all pixels that it overlaps now. raster:
    PlacedRaster of the mask.
    """
    r = raster.rasters[raster.row]
    least, _ = extent_along(hull.corners, hull.count, nx, ny)
    most = -math.inf
    first_x, last_x, first_y, last_y = pixels_under(raster, hull)
    for j in range(first_y, last_y):
        for i in range(first_x, last_x):
            x, y = float(raster.left + i), float(raster.top + j)
            if (
                is_set(raster.words, r.offset + j * r.stride, i)
                and square_distance(hull.corners, hull.count, x, y) < hull.radius
            ):
                most = max(most, nx * (x + 1.0 if nx > 0.0 else x) + ny * (y + 1.0 if ny > 0.0 else y))
    return most - least + hull.radius


sum_pixels_in_rounded = make_pixel_sum(square_in_rounded)


@subkernel
def collide_mask_rounded(raster, hull, depths_out):
    """Collide a PlacedRaster with a rounded Hull of two or more corners.

    Return (area, nx, ny, x, y, separation, feature). Candidates for the normal are the inverted face normals of the
    Hull, and one more direction. It leads from the centroid of the overlapping pixels to the Hull's core (the Hull
    without its rounding). The candidate with the shortest move that clears the pixels is used. The separation is minus
    the length of this move [px]. Other values as in collide_mask_circle. O(pixels in the hull's AABB · corners).
    depths_out (16,): scratch.
    """
    corners = hull.corners
    count = hull.count
    area, point_x, point_y, first = sum_pixels_in_rounded(raster, hull, depths_out)
    if area == 0:
        return 0, 0.0, -1.0, 0.0, 0.0, 0.0, 0
    best_x, best_y = 0.0, -1.0
    depth = math.inf
    for k in range(count + 1):
        if k < count:
            mx, my = edge_normal(corners, count, k)
            nx, ny = -mx, -my
        else:
            nx, ny = direction_to_core(corners, count, point_x, point_y)
        out = depth_along(raster, hull, nx, ny)
        if out < depth:
            depth = out
            best_x, best_y = nx, ny
    return area, best_x, best_y, point_x, point_y, -depth, first


@subkernel
def collide_mask_hull(raster, hull, depths_out):
    """Collide a PlacedRaster with any Hull. Return (area, nx, ny, x, y, separation, feature).

    The values are those of collide_mask_circle. depths_out (16,): scratch.
    """
    if hull.count == 1:
        return collide_mask_circle(raster, hull, depths_out)
    if hull.radius > 0.0:
        return collide_mask_rounded(raster, hull, depths_out)
    if hull.count == 2:
        return collide_mask_line(raster, hull, depths_out)
    return collide_mask_polygon(raster, hull, depths_out)


# ---- mask pairs ------------------------------------------------------------------------------------------------------
# The pass over pairs of snapped masks, by AND of their bit words.


@inlined
def bounds_overlap(batch, pair):
    """Return whether the bounding boxes of the solid pixels of two masks drawn on whole pixels (snap=True) overlap.

    pair: index of the candidate; batch: input of the pass, a manifold.Batch.
    """
    a = batch.shapes[batch.candidates[pair, 0]]
    b = batch.shapes[batch.candidates[pair, 1]]
    rasters = batch.geometry.rasters
    left, top, right, bottom = shared_rectangle(rasters[a.raster], rasters[b.raster], b.left - a.left, b.top - a.top)
    return (left < right) & (top < bottom)


def make_mask_pass(full: bool) -> Any:
    """Return the kernel that collides all pairs of masks drawn on whole pixels (snap=True).

    full: True to compute area, centroid, normal and depth; False to find only the first shared pixel. If False, the
    normal is the direction between the centres of the masks, and the separation is -1.
    """

    @inlined
    def collide_mask_pair(batch, pair, workspace, manifolds_out, found, work_inout):
        """Append the contact of candidate number `pair`, two masks drawn on whole pixels, by AND of their bit words.

        Return the new number of contacts. Arguments: see manifold.make_pass.
        """
        shapes = batch.shapes
        candidates, rasters, words = batch.candidates, batch.geometry.rasters, batch.geometry.words
        a = shapes[candidates[pair, 0]]
        b = shapes[candidates[pair, 1]]
        dx, dy = b.left - a.left, b.top - a.top
        r = rasters[a.raster]
        s = rasters[b.raster]
        left, top, right, bottom = shared_rectangle(r, s, dx, dy)
        work_inout[MASK_TESTS] += 1
        if r.stride == 1 and s.stride == 1:
            # Sprites up to 64 px wide: one word per row, so both shifts are the same in every row.
            row, shared = shared_row(words, r.offset + top, left, s.offset + top - dy, left - dx, bottom - top)
            if shared == word(0):
                return found
            x, y = left + lowest_bit(shared), top + row
        else:
            hit, x, y = first_pixel(rasters, words, a.raster, b.raster, dx, dy)
            if not hit:
                return found
        area = 0.0
        px, py = x + 0.5, y + 0.5
        separation = -1.0
        if full:
            p, q = batch.bodies[a.body_row], batch.bodies[b.body_row]
            remainders = Remainders(
                p.x - r.origin_x + 0.5 - a.left,
                p.y - r.origin_y + 0.5 - a.top,
                q.x - s.origin_x + 0.5 - b.left,
                q.y - s.origin_y + 0.5 - b.top,
            )
            pixels, px, py, nx, ny, separation = mask_contact(
                RasterPair(rasters, words, a.raster, b.raster, dx, dy), remainders
            )
            area = float(pixels)
        else:
            nx, ny = center_normal(r, s, dx, dy)
        point = (nx, ny, a.left + px, a.top + py, separation, area, pixel_feature(y, x, r.width))
        return add_manifold(shapes, candidates, pair, point, manifolds_out, found)

    return make_pass(MASKS, collide_mask_pair, bounds_overlap)


collide_mask_pairs_full = make_mask_pass(full=True)
collide_mask_pairs_hit = make_mask_pass(full=False)
