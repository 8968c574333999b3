"""Straight slopes of every kind of ground, and shapes for characters, for the tests of characters."""

import math

import numpy as np

from physics import Capsule, Chain, Circle, PixelMask, Polygon, Segment, TileGrid

HALF = 300.0  # [px] of a slope to both sides of the origin, through which it goes
TURNED = Polygon.box(10, 14, angle=0.4)
SIXTEEN = Polygon([(9 * math.cos(k * math.tau / 16), 9 * math.sin(k * math.tau / 16)) for k in range(16)])
SHAPES = {
    "box": (Polygon.box(10, 20), Polygon.box(10, 20).points, 0.0),
    "circle": (Circle(8), ((0.0, 0.0),), 8.0),
    "capsule": (Capsule((0, -6), (0, 6), 6), ((0.0, -6.0), (0.0, 6.0)), 6.0),
    "turned": (TURNED, TURNED.points, 0.0),
    "rounded": (Polygon(Polygon.box(8, 14).points, 3.0), Polygon.box(8, 14).points, 3.0),
    "sixteen": (SIXTEEN, SIXTEEN.points, 0.0),
}
GROUNDS = ("polygon", "turned box", "segment", "chain", "capsule")


def add_ground(world, form, slope, **options):
    """Add a body with a straight slope through the origin that rises by `slope` per px to the right, and return it.

    form: kind of ground. options: further arguments of add_body; the default kind is static.
    """
    a, b = (-HALF, HALF * slope), (HALF, -HALF * slope)
    below = max(a[1], b[1]) + 50.0
    angle = math.atan(slope)
    down = (math.sin(angle), math.cos(angle))
    options.setdefault("kind", "static")
    if form == "polygon":
        return world.add_body(Polygon([a, b, (b[0], below), (a[0], below)]), **options)
    if form == "turned box":
        center = (20.0 * down[0], 20.0 * down[1])
        return world.add_body(Polygon.box(2.0 * HALF / down[1], 40, center, -angle), **options)
    if form == "segment":
        return world.add_body(Segment(a, b), **options)
    if form == "chain":
        return world.add_body(Chain([(x, -x * slope) for x in np.linspace(-HALF, HALF, 31)]), **options)
    if form == "capsule":
        ends = [(x + 9.0 * down[0], y + 9.0 * down[1]) for x, y in (a, b)]
        return world.add_body(Capsule(*ends, 9.0), **options)
    if form == "mask":
        return world.add_body(ramp_mask(slope), **options)
    return world.add_body(ramp_tiles(slope), position=(-16.0 * 16, -16.0 * 16), **options)


def ramp_mask(slope, width=240):
    """Return a mask whose solid pixels are below a slope through its middle. width: in pixels."""
    height = math.ceil(abs(slope) * width) + 40
    columns = np.arange(width) + 0.5 - width / 2
    surface = np.floor(height / 2 - columns * slope + 0.5)
    return PixelMask(np.arange(height)[:, None] >= surface[None, :], origin=(width / 2, height / 2))


def ramp_tiles(slope, count=32, size=16):
    """Return a TileGrid that is solid below a slope through its middle. slope: a power of two, at most 1."""
    slopes, solid = np.zeros((count, count, 2)), np.zeros((count, count), bool)
    for column in range(count):
        left, right = ((column + k - count / 2) * slope + count / 2 for k in (0, 1))
        row = math.floor(min(left, right) + 1e-9)
        if 0 <= row < count:
            slopes[count - 1 - row, column] = left - row, right - row
            solid[count - row :, column] = True
    return TileGrid(solid, size, slopes=slopes)
