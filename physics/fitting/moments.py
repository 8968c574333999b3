"""Area, centre and inertia of what lies inside a boundary of lines and arcs: integrals round it (Green's theorem), by
Gauss's rule, exact but for rounding."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from physics.fitting.union import Stretch

NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)
NODES, WEIGHTS = (NODES + 1.0) / 2.0, WEIGHTS / 2.0  # over 0..1; of a quarter turn the error is far below rounding


class Moments(NamedTuple):
    """Of a figure of density 1."""

    area: float  # [px2]
    x: float  # centre of area [px]; nan of no area
    y: float
    inertia: float  # about that [px4]


def moments(around: Sequence[Stretch]) -> Moments:
    """Of the figure inside a boundary."""
    if not around:
        return Moments(0.0, math.nan, math.nan, 0.0)
    base = around[0].start  # integrals about a point nearby: no digits are lost far from the raster's corner
    place, step = nodes(around)
    x, y, dx, dy = *(place - base).transpose(2, 0, 1), *step.transpose(2, 0, 1)
    area = float((((x * dy - y * dx) / 2.0) @ WEIGHTS).sum())
    if area <= 0.0:
        return Moments(0.0, math.nan, math.nan, 0.0)
    center_x, center_y = (float((each @ WEIGHTS).sum()) / area for each in (x * x * dy / 2.0, -y * y * dx / 2.0))
    x, y = x - center_x, y - center_y
    inertia = float(((x * x * x * dy - y * y * y * dx) @ WEIGHTS).sum()) / 3.0
    return Moments(area, float(base[0]) + center_x, float(base[1]) + center_y, inertia)


def nodes(around: Sequence[Stretch]) -> tuple[np.ndarray, np.ndarray]:
    """Places (n, 16, 2) on each stretch where Gauss's rule looks, and how fast they move with the share of the way."""
    place = np.array([each.at(NODES) for each in around])
    step = np.empty_like(place)
    for k, each in enumerate(around):
        if each.radius == 0.0:
            step[k] = each.end - each.start
        else:
            out = place[k] - each.center
            step[k] = each.turn * np.stack([-out[:, 1], out[:, 0]], axis=1)
    return place, step
