"""The area that a mask's pixel squares share with a rounded hull, and its centroid, in closed form.

The hull's outline is its edges, moved out by the radius, and an arc round each corner; each run of solid pixels in a
row is a box in which both have their share: see raster/shares.py.
"""

import math

from physics.collision.clipping import edge_normal
from physics.jit import subkernel
from physics.raster.bits import is_set
from physics.raster.shares import arc_share, line_share


@subkernel
def arc_at(corners, count, k):
    """(start, end) [rad] of the arc round corner k of a rounded hull: between its two edges' normals."""
    if count == 1:
        return 0.0, math.tau
    ax, ay = edge_normal(corners, count, k - 1 if k > 0 else count - 1)
    bx, by = edge_normal(corners, count, k)
    start = math.atan2(ay, ax)
    if count == 2:
        return start, start + math.pi
    return start, start + max(0.0, math.atan2(ax * by - ay * bx, ax * bx + ay * by))


@subkernel
def hull_share(corners, count, radius, x, y, width, height):
    """(area, moment of x, moment of y) of a rounded hull in a box with its top left corner at x, y [px],
    about which the moments are. corners (n, 2) [px], clockwise on the screen; one is a disc's centre. O(count)."""
    area = 0.0
    moment_x = 0.0
    moment_y = 0.0
    for k in range(count):
        if count > 1:
            n = k + 1 if k + 1 < count else 0
            nx, ny = edge_normal(corners, count, k)
            part, mx, my = line_share(
                corners[k, 0] + radius * nx - x,
                corners[k, 1] + radius * ny - y,
                corners[n, 0] + radius * nx - x,
                corners[n, 1] + radius * ny - y,
                width,
                height,
            )
            area += part
            moment_x += mx
            moment_y += my
        if radius > 0.0:
            start, end = arc_at(corners, count, k)
            part, mx, my = arc_share(corners[k, 0] - x, corners[k, 1] - y, radius, start, end, width, height)
            area += part
            moment_x += mx
            moment_y += my
    return area, moment_x, moment_y


@subkernel
def shared_with_hull(rasters, words, mask, corners, count, radius):
    """(area [px2], moment of x, moment of y) of what a mask shares with a rounded hull that is seen in its raster.

    O(runs of solid pixels under the hull's bounds · count).
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
    left = max(r.set_left, math.floor(min_x))
    right = min(r.set_right, math.ceil(max_x))
    area = 0.0
    moment_x = 0.0
    moment_y = 0.0
    for row in range(max(r.set_top, math.floor(min_y)), min(r.set_bottom, math.ceil(max_y))):
        start = -1
        for column in range(left, right + 1):
            if column < right and is_set(words, r.offset + row * r.stride, column):
                if start < 0:
                    start = column
            elif start >= 0:
                part, mx, my = hull_share(corners, count, radius, float(start), float(row), float(column - start), 1.0)
                area += part
                moment_x += mx + start * part
                moment_y += my + row * part
                start = -1
    return area, moment_x, moment_y
