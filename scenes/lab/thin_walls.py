"""Walls one pixel thin, for lab/mask_sweep: straight, aslant, a ring; and what it means to have come through."""

from math import hypot

import numpy as np

from physics import PixelMask

SHAPES = ("straight", "aslant", "ring")
HALF = 31  # [px] a straight wall's half height
RADIUS = 27.0  # [px] of the ring's middle line


def wall_of(shape):
    """The wall's mask, its origin in its middle."""
    size = 2 * HALF + 1
    if shape == "straight":
        return PixelMask.from_array(np.ones((size, 1), bool))
    if shape == "aslant":  # of pixels that meet at their corners alone: as thin as a wall can be
        return PixelMask.from_array(np.eye(size, dtype=bool))
    y, x = np.mgrid[0:size, 0:size] - HALF
    far = np.hypot(x, y)
    inside = far < RADIUS
    inner = inside[1:-1, :-2] & inside[1:-1, 2:] & inside[:-2, 1:-1] & inside[2:, 1:-1]
    ring = inside.copy()
    ring[1:-1, 1:-1] &= ~inner
    return PixelMask.from_array(ring)


def is_beyond(shape, x, y):
    """Whether a shot's middle, seen from the wall's, is where only who came through can be."""
    if shape == "straight":
        return x > 0.5
    if shape == "aslant":
        return x > y + 1.0
    return x > 0.0 or hypot(x, y) < RADIUS - 1.5
