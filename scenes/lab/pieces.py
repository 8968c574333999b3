"""Shaded pictures of convex shapes in the game's style, computed from the collision shape itself.

A picture has a dark outline, a light rim and a dithered inside. The shading has no direction, so that rotation of the
body does not rotate the light.
"""

from functools import lru_cache
from math import ceil, cos, sin
from typing import NamedTuple

import numpy as np
import pygame

from game.drawing.colors import INK
from game.drawing.rotated import RotatedPicture

OUTLINE, RIM = 1.0, 2.6  # [px] inwards from the edge
# rim, inside, dithered inside, mark
RAMPS = {
    "wood": ((246, 196, 120), (196, 128, 74), (168, 102, 66), (122, 70, 54)),
    "steel": ((222, 232, 240), (142, 160, 184), (118, 134, 164), (80, 92, 124)),
    "teal": ((150, 236, 212), (52, 168, 156), (40, 138, 138), (26, 98, 110)),
    "coral": ((255, 190, 160), (232, 108, 92), (200, 82, 84), (146, 52, 72)),
    "violet": ((220, 186, 250), (142, 104, 202), (116, 82, 176), (82, 56, 134)),
    "gold": ((255, 240, 170), (238, 184, 76), (212, 146, 60), (158, 98, 50)),
}


@lru_cache(maxsize=128)
def turning(shape, ramp):
    """Return a RotatedPicture of a shape, which can be drawn at any angle about the shape's origin. Results are cached.

    ramp: name of the picture's colours in RAMPS.
    """
    return RotatedPicture(piece(shape, ramp))


def piece(shape, ramp, marked=True):
    """Return a Surface with the picture of a shape. The shape's origin is at the centre of the Surface.

    ramp: name of the picture's colours in RAMPS; marked: whether a mark makes rotation visible.
    """
    points, radius = hull(shape)
    reach = ceil(float(np.hypot(points[:, 0], points[:, 1]).max()) + radius) + 1
    side = np.arange(2 * reach) + 0.5 - reach
    x, y = np.meshgrid(side, side, indexing="ij")
    depth = -signed_distance(points, radius, x, y)
    rim, inside, dither, mark = RAMPS[ramp]
    colors = np.zeros((2 * reach, 2 * reach, 3), np.uint8)
    colors[:] = inside
    columns, rows = np.indices(x.shape)
    colors[((columns + rows) % 2 == 0) & (depth > RIM + 1.0)] = dither
    colors[depth < RIM] = rim
    if marked and depth.max() > 4.5:
        spot = points.mean(axis=0)
        near = np.maximum(np.abs(x - spot[0]), np.abs(y - spot[1])) < 1.01
        colors[near | ((np.abs(y - spot[1]) < 0.6) & (x > spot[0]) & (depth > RIM + 1.0))] = mark
    colors[depth < OUTLINE] = INK
    image = pygame.Surface((2 * reach, 2 * reach), pygame.SRCALPHA, 32)
    pygame.surfarray.blit_array(image, colors)
    alpha = pygame.surfarray.pixels_alpha(image)
    alpha[:] = np.where(depth > 0.0, 255, 0)
    del alpha  # unlocks the surface
    return image


class Scaled(NamedTuple):
    """A convex shape for drawing: its corners clockwise on the screen [px], and the rounding radius [px]."""

    points: tuple
    radius: float


def hull(shape):
    """Return (corners, radius) of a convex shape: an array (k, 2), clockwise on the screen, and the rounding radius."""
    return np.array(shape.points, float), float(shape.radius)


@lru_cache(maxsize=256)
def scaled(shape, zoom):
    """Return a Scaled: the corners and the rounding radius of a convex shape, multiplied by `zoom`."""
    return Scaled(tuple((x * zoom, y * zoom) for x, y in shape.points), shape.radius * zoom)


def placed(shape, zoom, pose):
    """Return the corners of a convex shape or chain on a surface, a list of (x, y).

    zoom: surface px per world px; pose: (x, y, angle) of the shape on the surface.
    """
    x, y, angle = pose
    c, s = cos(angle) * zoom, sin(angle) * zoom
    return [(x + c * px - s * py, y + s * px + c * py) for px, py in shape.points]


def signed_distance(points, radius, x, y):
    """Return the distance of points (x, y) from the edge of a rounded hull [px], negative inside; an array.

    points: corners (k, 2) of the hull; radius: its rounding radius; x, y: numbers or arrays of one shape.
    """
    x, y = np.asarray(x, float), np.asarray(y, float)
    nearest = np.full(x.shape, np.inf)
    inside = np.full(x.shape, len(points) > 2)
    for (ax, ay), (bx, by) in zip(points, np.roll(points, -1, axis=0), strict=True):
        dx, dy = bx - ax, by - ay
        length = dx * dx + dy * dy
        share = np.clip(((x - ax) * dx + (y - ay) * dy) / length, 0.0, 1.0) if length > 0.0 else 0.0
        nearest = np.minimum(nearest, np.hypot(x - ax - share * dx, y - ay - share * dy))
        inside &= dx * (y - ay) - dy * (x - ax) >= 0.0
    return np.where(inside, -nearest, nearest) - radius
