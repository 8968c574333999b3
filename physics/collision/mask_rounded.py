"""A mask, as the union of its pixel squares as drawn, against an exact rounded hull (capsule, rounded polygon).

Masks are open: a hit shares area, touching is none. See masks/shapes.py for discs and sharp polygons.
"""

import math

from physics.collision.clipping import edge_normal
from physics.collision.hulls import edge_gap, nearest_on_edge
from physics.collision.mask_hulls import pixel_range, square_in_polygon
from physics.jit import subkernel
from physics.math2d import length_of, unit
from physics.raster.bits import is_set


@subkernel
def square_gap(corners, count, x, y):
    """Distance [px] between a core and the pixel square at x, y; 0 where they share area."""
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
    """Unit direction from (x, y) to the nearest point of a core's outline; (0, -1) on it."""
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
    """How far [px] a rounded hull moves along a unit direction until a line parts it from the pixels in it."""
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
    """(area in whole pixels, normal from mask to hull, point, separation,
    first pixel number) of a mask and a rounded hull.

    corners (n, 2) [px] world, clockwise on the screen; left, top: where the raster is drawn. The point is the centroid
    of the pixels that overlap. The way out leads through the face, or away from the centroid where the rounding is met,
    whichever is shorter; the separation is the move along it that clears them. O(pixels under the hull's bounds ·
    count).
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
