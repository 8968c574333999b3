"""Exact tests, without rounding, of whether two convex outlines are separate, touch or overlap."""

from fractions import Fraction

import numpy as np


def sign_of_gap(a, b):
    """Return 1 if two outlines are separate, 0 if they touch, -1 if they overlap, computed in
    exact rational numbers.
    """
    a, b = ([(Fraction(x), Fraction(y)) for x, y in corners] for corners in (a, b))
    widest = None
    for one, other in ((a, b), (b, a)):
        for (x, y), (u, v) in zip(one, one[1:] + one[:1], strict=True):
            nx, ny = v - y, x - u
            if sum((p - x) * nx + (q - y) * ny for p, q in one) > 0:
                nx, ny = -nx, -ny  # outward, whichever way it is listed
            gap = min((p - x) * nx + (q - y) * ny for p, q in other)
            sign = (gap > 0) - (gap < 0)
            widest = sign if widest is None else max(widest, sign)
    return widest


def gaps_on_a_lattice(a, b):
    """Return (n,) gaps of n pairs of outlines: for each pair, the widest gap along the normal of any face.

    a, b: (n, m, 2) int64 corners, clockwise on the screen. Every intermediate number is an integer below 2^62, so the
    sign is exact. The gap is a float in units of the lattice.
    """
    widest = np.full(len(a), -np.inf)
    for one, other in ((a, b), (b, a)):
        edges = np.roll(one, -1, axis=1) - one
        to = other[:, None] - one[:, :, None]
        ahead = edges[:, :, None, 1] * to[..., 0] - edges[:, :, None, 0] * to[..., 1]
        widest = np.maximum(widest, (ahead.min(axis=2) / np.hypot(edges[..., 0], edges[..., 1])).max(axis=1))
    return widest
