"""Exact outlines of shapes at a pose, as shapely geometry: an independent reference for overlap, depth and distance."""

import math
from itertools import pairwise

from shapely.affinity import affine_transform
from shapely.geometry import MultiPoint, Point, Polygon, box
from shapely.ops import unary_union


def placed(points, pose):
    """Return points rotated clockwise on the screen by pose[2] and moved to (pose[0], pose[1])."""
    x, y, angle = pose
    c, s = math.cos(angle), math.sin(angle)
    return [(x + c * u - s * v, y + s * u + c * v) for u, v in points]


def polygon(points, pose):
    """Return a convex polygon at a pose as a shapely Polygon."""
    return Polygon(placed(points, pose))


def rectangle(width, height, pose):
    """Return a box with these full sizes, centred on a pose."""
    w, h = width / 2.0, height / 2.0
    return polygon([(-w, -h), (w, -h), (w, h), (-w, h)], pose)


def rounded_union(parts, pose):
    """Return the union of parts (corners, radius) at a pose: points, lines and convex polygons grown by a radius, to
    1e-6 of it.
    """
    cores = [(MultiPoint(placed(corners, pose)).convex_hull, radius) for corners, radius in parts]
    return unary_union([core.buffer(radius, quad_segs=512) if radius > 0.0 else core for core, radius in cores])


def moved(geometry, pose):
    """Return a geometry in body space, rotated clockwise on the screen by pose[2] and moved."""
    c, s = math.cos(pose[2]), math.sin(pose[2])
    return affine_transform(geometry, [c, -s, s, c, pose[0], pose[1]])


def bounds_of(geometry):
    """Return the AABB of a geometry as a polygon."""
    return box(*geometry.bounds)


def pixels(solid, left, top):
    """Return the union of the squares of solid[row][col], whose top left corner is at (left, top)."""
    return unary_union(
        [
            box(left + i, top + j, left + i + 1, top + j + 1)
            for j, row in enumerate(solid)
            for i, pixel in enumerate(row)
            if pixel
        ]
    )


def tiles(solid, slopes, size, x, y):
    """Return the union of solid tiles and slopes (left and right heights as fractions), with the top left corner at (x,
    y).
    """
    parts = []
    for j, row in enumerate(solid):
        for i, full in enumerate(row):
            left, right = (1.0, 1.0) if full else slopes[j][i]
            if left > 0.0 or right > 0.0:
                a, b, bottom = x + i * size, x + (i + 1) * size, y + (j + 1) * size
                parts.append(
                    MultiPoint(
                        [(a, bottom), (b, bottom), (a, bottom - left * size), (b, bottom - right * size)]
                    ).convex_hull
                )
    return unary_union(parts)


def disc_gap(geometry, x, y, radius):
    """Return the signed gap of a disc and a convex geometry: the distance outside, minus the depth of the centre
    inside.
    """
    point = Point(x, y)
    inside = geometry.contains(point)
    return (-geometry.exterior.distance(point) if inside else geometry.distance(point)) - radius


def convex_depth(a, b):
    """Return the depth of two overlapping convex polygons: the least move along a face normal that separates them."""
    least = math.inf
    for first, second in ((a, b), (b, a)):
        corners = list(first.exterior.coords)
        turn = 1.0 if first.exterior.is_ccw else -1.0
        for (x0, y0), (x1, y1) in pairwise(corners):
            length = math.hypot(x1 - x0, y1 - y0)
            nx, ny = turn * (y1 - y0) / length, -turn * (x1 - x0) / length
            least = min(least, -min(nx * (x - x0) + ny * (y - y0) for x, y in second.exterior.coords))
    return least
