"""Shapes of one body that overlap are weighed once, where they do as the densest of them.

Convex shapes only: pixel masks and tile grids weigh by themselves, and lines nothing. The parts of each union are
those that overlap, one with another; what only touches keeps the sums that it has by itself, to the bit.
"""

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from physics.fitting.moments import moments
from physics.fitting.union import ROUNDING, boundary
from physics.shapes.bounds import Bounds
from physics.shapes.convex import Capsule, Circle, Polygon
from physics.shapes.mass import Mass, together
from physics.vec2 import Vec2

Weighed = tuple[tuple, float, float]  # corners, radius [px], density
CONVEX = (Circle, Capsule, Polygon)


def weighed_once(parts: Sequence[tuple]) -> Mass:
    """The mass of shapes with their densities: [(shape, density)]."""
    if len(parts) < 2:
        return together(shape.mass_of(density) for shape, density in parts)
    hulls = [_hull_of(shape, density) for shape, density in parts]
    groups = _groups([hull for hull in hulls if hull is not None])
    crowded = set().union(*groups) if groups else set()
    alone = [shape.mass_of(density) for (shape, density), hull in zip(parts, hulls, strict=True) if hull not in crowded]
    return together([*alone, *(_union_mass(tuple(sorted(group))) for group in groups)])


def _hull_of(shape, density) -> Weighed | None:
    solid = shape.shape if isinstance(shape, Bounds) else shape
    if not isinstance(solid, CONVEX):
        return None
    corners = (tuple(solid.center),) if isinstance(solid, Circle) else tuple(tuple(each) for each in solid.points)
    return corners, float(solid.radius), float(density)


def _groups(hulls):
    """Sets of hulls that hang together by overlaps; equal ones count as one that overlaps."""
    groups: list[set] = [{hull} for hull in dict.fromkeys(hulls) if hulls.count(hull) > 1]
    different = list(dict.fromkeys(hulls))
    for i, k in _near(different):
        a, b = different[i], different[k]
        if overlap(a, b):
            joined = {a, b}.union(*(each for each in groups if each & {a, b}))
            groups = [each for each in groups if not each & joined] + [joined]
    return groups


def _near(hulls):
    """Places of the pairs whose boxes share area."""
    if len(hulls) < 2:
        return []
    low = np.array([np.min(corners, axis=0) - radius for corners, radius, _ in hulls])
    high = np.array([np.max(corners, axis=0) + radius for corners, radius, _ in hulls])
    meet = ((low[:, None] < high[None, :]) & (low[None, :] < high[:, None])).all(axis=2)
    return np.argwhere(np.triu(meet, 1)).tolist()


def overlap(a: Weighed, b: Weighed) -> bool:
    """Whether two rounded hulls share area: no side's normal, and no line through two corners, tells them apart.

    Source: the separating axis theorem; between rounded corners the axis may be any line from one to the other.
    """
    first, second = np.array(a[0]), np.array(b[0])
    reach = a[1] + b[1]
    both = np.concatenate([first, second])
    near = ROUNDING * (float(np.ptp(both, axis=0).max()) + reach)
    sides = [corners - np.roll(corners, 1, axis=0) for corners in (first, second)]
    axes = [np.stack([each[:, 1], -each[:, 0]], axis=1) for each in sides]
    axes.append((second[None, :] - first[:, None]).reshape(-1, 2))
    every = np.concatenate([*axes, *(-each for each in axes)])
    lengths = np.hypot(*every.T)
    every = every[lengths > near] / lengths[lengths > near, None]
    gaps = (second @ every.T).min(axis=0) - (first @ every.T).max(axis=0)
    return not len(gaps) or float(gaps.max()) < reach - near


@lru_cache(maxsize=256)
def _union_mass(group: tuple[Weighed, ...]) -> Mass:
    """Of hulls that overlap: layer on layer, each the union of all that are at least so dense."""
    densities = sorted({density for _, _, density in group})
    layers = []
    for below, density in zip([0.0, *densities], densities, strict=False):
        found = moments(boundary([(np.array(c), r) for c, r, heavy in group if heavy >= density]))
        if not math.isnan(found.x):
            share = density - below
            layers.append(Mass(share * found.area, Vec2(found.x, found.y), share * found.inertia))
    return together(layers)
