"""Signed distance fields of simple shapes, and noise for the texture of surfaces.

A field is an array (h, w) with the distance [px] of each pixel's centre from the edge of a shape; it is negative
inside. The arguments x, y of the functions are the positions of the pixel centres (see grid). Only +, -, *, / and sqrt
are used, which round the same on every machine, so a picture is reproduced exactly.
"""

import numpy as np

BAYER = np.array([[0, 8, 2, 10], [12, 4, 14, 6], [3, 11, 1, 9], [15, 7, 13, 5]]) / 16  # ordered dither, 0 .. 15/16


def grid(width, height):
    """Return (x, y), the positions of all pixel centres [px], two arrays (height, width)."""
    y, x = np.mgrid[0:height, 0:width]
    return x + 0.5, y + 0.5


def length(x, y):
    """Return the Euclidean length of (x, y). It is the same on every machine, unlike hypot, which depends on the C
    library.
    """
    return np.sqrt(x * x + y * y)


def dither(height, width):
    """Return the Bayer matrix for ordered dithering, repeated to an array (height, width), with values centred on 0."""
    return np.tile(BAYER, (height // 4 + 1, width // 4 + 1))[:height, :width] - 15 / 32


def circle(x, y, center_x, center_y, radius):
    """Return the distance field of a disc with this radius around (center_x, center_y)."""
    return length(x - center_x, y - center_y) - radius


def ellipse(x, y, center_x, center_y, radius_x, radius_y):
    """Return the distance field of an ellipse with the radii radius_x and radius_y around (center_x, center_y).

    It is exact on the edge of the ellipse, and accurate enough for shading elsewhere.
    """
    return (length((x - center_x) / radius_x, (y - center_y) / radius_y) - 1) * min(radius_x, radius_y)


def capsule(x, y, start, end, start_radius, end_radius=None):
    """Return the distance field of a thick line from `start` (x, y) to `end` (x, y).

    Its radius changes from start_radius to end_radius along the line. end_radius: None for a constant radius.
    """
    end_radius = start_radius if end_radius is None else end_radius
    along_x, along_y = end[0] - start[0], end[1] - start[1]
    t = np.clip(((x - start[0]) * along_x + (y - start[1]) * along_y) / (along_x**2 + along_y**2), 0, 1)
    distance = length(x - start[0] - along_x * t, y - start[1] - along_y * t)
    return distance - (start_radius + (end_radius - start_radius) * t)


def box(x, y, left, top, right, bottom, corner=0.0):
    """Return the distance field of the box from (left, top) to (right, bottom). corner: radius of its corners."""
    dx = np.abs(x - (left + right) / 2) - (right - left) / 2 + corner
    dy = np.abs(y - (top + bottom) / 2) - (bottom - top) / 2 + corner
    return length(np.maximum(dx, 0), np.maximum(dy, 0)) + np.minimum(np.maximum(dx, dy), 0) - corner


def polygon(x, y, points):
    """Return the distance field of a simple polygon with the corners `points`, a list of (x, y).

    The crossing rule decides which pixels are inside.
    """
    nearest = np.full(x.shape, 1e9)
    inside = np.zeros(x.shape, bool)
    for i, (ax, ay) in enumerate(points):
        bx, by = points[i - 1]
        edge_x, edge_y = bx - ax, by - ay
        t = np.clip(((x - ax) * edge_x + (y - ay) * edge_y) / (edge_x**2 + edge_y**2), 0, 1)
        dx, dy = x - ax - edge_x * t, y - ay - edge_y * t
        nearest = np.minimum(nearest, dx * dx + dy * dy)
        if ay != by:
            inside ^= ((ay > y) != (by > y)) & (x < ax + (y - ay) * edge_x / edge_y)
    return np.where(inside, -1.0, 1.0) * np.sqrt(nearest)


def noise(width, height, cells_x, cells_y, seed):
    """Return smooth value noise 0..1, an array (height, width), seamless in x and y.

    cells_x, cells_y: number of random values along x and y, between which the noise is interpolated; seed: seed of the
    random numbers.
    """
    lattice = np.random.default_rng(seed).random((cells_y, cells_x))
    x, y = grid(width, height)
    x, y = x * cells_x / width, y * cells_y / height
    left, top = np.floor(x).astype(int), np.floor(y).astype(int)
    u, v = x - left, y - top
    u, v = u * u * (3 - 2 * u), v * v * (3 - 2 * v)
    left, top = left % cells_x, top % cells_y
    right, bottom = (left + 1) % cells_x, (top + 1) % cells_y
    upper = lattice[top, left] * (1 - u) + lattice[top, right] * u
    lower = lattice[bottom, left] * (1 - u) + lattice[bottom, right] * u
    return upper * (1 - v) + lower * v


def layered_noise(width, height, cells_x, cells_y, octaves, seed, gain=0.5):
    """Return a sum of several layers (octaves) of seamless noise, scaled to 0..1, an array (height, width).

    The first layer has cells_x x cells_y cells. Each further layer is twice as fine and `gain` times as strong as the
    layer before. seed: seed of the random numbers.
    """
    total, weight, strength = np.zeros((height, width)), 0.0, 1.0
    for octave in range(octaves):
        total += strength * noise(width, height, cells_x << octave, cells_y << octave, seed + octave)
        weight += strength
        strength *= gain
    return total / weight
