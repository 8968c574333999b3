"""Least turned box around a convex hull: one side lies on an edge of the hull. Source: Freeman and Shapira 1975."""

import math

import numpy as np


def least_box(hull: np.ndarray) -> tuple[float, float, tuple[float, float], float]:
    """(width, height, center, angle) of the box of least area around hull corners (n, 2) [px];
    of equal ones the first."""
    best, found = math.inf, (0.0, 0.0, (0.0, 0.0), 0.0)
    for edge in np.roll(hull, -1, axis=0) - hull:
        angle = math.atan2(edge[1], edge[0])
        along = np.array([math.cos(angle), math.sin(angle)])
        across = np.array([-along[1], along[0]])
        u, v = hull @ along, hull @ across
        area = np.ptp(u) * np.ptp(v)
        if area < best * (1.0 - 1e-9):
            middle = along * (u.min() + u.max()) / 2.0 + across * (v.min() + v.max()) / 2.0
            best = area
            found = (float(np.ptp(u)), float(np.ptp(v)), (float(middle[0]), float(middle[1])), angle)
    return found
