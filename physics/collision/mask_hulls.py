"""A mask against a disc and a convex polygon: the union of its pixel squares, as drawn, against the exact shape.

Masks are open: a hit shares area, touching is none. The normal points from the mask to the other shape: from the
centroid of the pixels that overlap to the disc's centre, or out of the polygon's face that lets them out soonest.
"""

import math

from physics.collision.clipping import edge_normal
from physics.jit import subkernel
from physics.math2d import unit
from physics.raster.bits import is_set


@subkernel
def pixel_range(low, high, start, set_low, set_high):
    """First and last + 1 of the pixels whose squares meet the open interval low..high, within the solid bounds.

    Taken into the bounds before they are rounded: an end may be infinite, and only a finite one can be rounded.
    """
    first = math.floor(min(float(set_high), max(float(set_low), low - start)))
    last = math.floor(max(set_low - 1.0, min(set_high - 1.0, high - start))) + 1
    return first, last


@subkernel
def leave_square(x, y, nx, ny, radius):
    """How far a disc at the origin moves along a unit normal until it leaves the unit square at (x, y) [px] behind.

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
    """(area in whole pixels, normal from mask to disc, point, separation,
    first pixel number) of a mask and a disc [px].

    left, top: where the raster is drawn. The point is the centroid of the pixels that overlap. The separation is the
    move of the disc along the normal that clears them all. O(pixels under the disc's bounds).
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
    """Write the rectangle `front` and `back` [px] to both sides of the line from points[0] to points[1]."""
    nx, ny = unit(points[1, 1] - points[0, 1], points[0, 0] - points[1, 0], 0.0, -1.0)
    for k in range(4):
        end = 0 if k == 0 or k == 3 else 1
        away = front if k < 2 else -back
        corners_out[k, 0] = points[end, 0] + away * nx
        corners_out[k, 1] = points[end, 1] + away * ny


@subkernel
def square_in_polygon(corners, count, x, y):
    """Whether the pixel square at x, y and a convex polygon share area: no axis of either parts them."""
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
        # The square's corner that lies deepest behind the edge.
        px = x if nx > 0.0 else x + 1.0
        py = y if ny > 0.0 else y + 1.0
        if nx * (px - corners[k, 0]) + ny * (py - corners[k, 1]) >= 0.0:
            return False
    return x < max_x and x + 1.0 > min_x and y < max_y and y + 1.0 > min_y


@subkernel
def collide_mask_polygon(rasters, words, mask, left, top, corners, count, edges, depths_out):
    """As collide_mask_circle, for a convex polygon with world corners (n, 2) [px] clockwise on the screen.

    edges: bits of the edges that may be touched; depths_out (16,): scratch. The way out leads through the touchable
    edge behind which the overlapping pixels lie least deep.
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
    """(how many pairs of solid pixels on both sides of a border of the pixel grid an open interval of it runs between,
    sum of their middles along it, first pixel number).

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
    """As collide_mask_circle, for the line from points[0] to points[1] [px], solid from both sides.

    It is met where it runs through the inside of the solid: across a pixel, or along the border of two solid ones, out
    of which it leads on the side that is further from the middle of the mask. depths_out (16,): scratch.
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
