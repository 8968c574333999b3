"""Capsule of little area around a convex hull: the best of all axis directions, by sampling and closing in."""

import math

import numpy as np

DIRECTIONS = 90  # axes that are tried, over half a turn
SHORT = 1e-6  # of its radius: a capsule whose line is shorter is told as a circle
CLOSER = 40  # halvings of the step around the best


def least_capsule(hull: np.ndarray) -> tuple[tuple[float, float], tuple[float, float], float]:
    """(a, b, radius) of a capsule that holds hull corners (n, 2) [px], its radius half of the hull's width across its
    axis; of such the one of least area; a equals b where that is a circle."""
    step = math.pi / DIRECTIONS
    best = min(range(DIRECTIONS), key=lambda k: _capsule(hull, k * step)[0])
    angle, area = best * step, _capsule(hull, best * step)[0]
    for _ in range(CLOSER):
        for other in (angle - step, angle + step):
            found = _capsule(hull, other)[0]
            if found < area:
                angle, area = other, found
        step /= 2.0
    return _capsule(hull, angle)[1:]


def _capsule(hull, angle):
    axis = np.array([math.cos(angle), math.sin(angle)])
    across = np.array([-axis[1], axis[0]])
    along, aside = hull @ axis, hull @ across
    middle, radius = (aside.min() + aside.max()) / 2.0, np.ptp(aside) / 2.0
    # Each corner lets the line end so far before it that the round end still holds it.
    reach = np.sqrt(np.maximum(radius * radius - (aside - middle) ** 2, 0.0))
    first, last = (along + reach).min(), (along - reach).max()
    if first + SHORT * radius >= last:  # all in a circle about any point between
        radius += max(last - first, 0.0) / 2.0
        first = last = (first + last) / 2.0
    a, b = axis * first + across * middle, axis * last + across * middle
    area = 2.0 * radius * (last - first) + math.pi * radius * radius
    return float(area), (float(a[0]), float(a[1])), (float(b[0]), float(b[1])), float(radius)
