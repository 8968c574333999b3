"""Walls of one pixel for lab/mask_sweep: straight, slanted, a ring; and the test for shots beyond them."""

from math import hypot

import numpy as np

from physics import PixelMask

SHAPES = ("straight", "aslant", "ring")
HALF = 31  # [px] a straight wall's half height
RADIUS = 27.0  # [px] of the ring's middle line


def wall_of(shape):
    """Return the pixel mask of a wall, with its origin in the middle."""
    size = 2 * HALF + 1
    if shape == "straight":
        return PixelMask.from_array(np.ones((size, 1), bool))
    if shape == "aslant":  # pixels that touch at their corners alone: the thinnest possible wall
        return PixelMask.from_array(np.eye(size, dtype=bool))
    y, x = np.mgrid[0:size, 0:size] - HALF
    far = np.hypot(x, y)
    inside = far < RADIUS
    inner = inside[1:-1, :-2] & inside[1:-1, 2:] & inside[:-2, 1:-1] & inside[2:, 1:-1]
    ring = inside.copy()
    ring[1:-1, 1:-1] &= ~inner
    return PixelMask.from_array(ring)


def is_beyond(shape, x, y):
    """Return whether a shot at (x, y), relative to the wall's middle, must have passed through the wall."""
    if shape == "straight":
        return x > 0.5
    if shape == "aslant":
        return x > y + 1.0
    return x > 0.0 or hypot(x, y) < RADIUS - 1.5
