"""The walls of lab/mask_sweep, one pixel thick (straight, slanted, a ring), and the test for shots beyond them."""

from math import hypot

import numpy as np

from physics import PixelMask

SHAPES = ("straight", "aslant", "ring")
HALF = 31  # [px] a straight wall's half height
RADIUS = 27.0  # [px] of the ring's middle line


def wall_of(shape):
    """Return the PixelMask of a wall, with its origin at its centre. shape: one of SHAPES."""
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
    """Return whether a shot has passed the wall.

    shape: shape of the wall, one of SHAPES; x, y: position of the shot relative to the wall's centre [px].
    """
    if shape == "straight":
        return x > 0.5
    if shape == "aslant":
        return x > y + 1.0
    return x > 0.0 or hypot(x, y) < RADIUS - 1.5
