"""Least circle that holds a set of points. Source: Welzl 1991, in the incremental form."""

import math
from collections.abc import Iterable, Sequence

import numpy as np


def least_circle(points: Iterable[Sequence[float]] | np.ndarray) -> tuple[float, float, float]:
    """(x, y, radius) [px] of the least circle around points (n, 2), n >= 1."""
    points = [(float(x), float(y)) for x, y in points]
    x, y, radius = (*points[0], 0.0)
    for i, p in enumerate(points):
        if _outside(p, x, y, radius):
            x, y, radius = (*p, 0.0)
            for j, q in enumerate(points[:i]):
                if _outside(q, x, y, radius):
                    x, y, radius = _through_two(p, q)
                    for r in points[:j]:
                        if _outside(r, x, y, radius):
                            x, y, radius = _through_three(p, q, r)
    return x, y, radius


def _outside(p, x, y, radius):
    return math.dist(p, (x, y)) > radius * (1.0 + 1e-12)


def _through_two(p, q):
    x, y = (p[0] + q[0]) / 2.0, (p[1] + q[1]) / 2.0
    return x, y, math.dist(p, (x, y))


def _through_three(p, q, r):
    bx, by, cx, cy = q[0] - p[0], q[1] - p[1], r[0] - p[0], r[1] - p[1]
    cross = 2.0 * (bx * cy - by * cx)
    if cross == 0.0:
        return max((_through_two(*pair) for pair in ((p, q), (p, r), (q, r))), key=lambda each: each[2])
    x = (cy * (bx * bx + by * by) - by * (cx * cx + cy * cy)) / cross
    y = (bx * (cx * cx + cy * cy) - cx * (bx * bx + by * by)) / cross
    return p[0] + x, p[1] + y, math.hypot(x, y)
