"""Convex hull of pixels or points, and the smallest box, capsule and circle around them."""

import math
from collections.abc import Iterable, Sequence
from typing import Protocol

import numpy as np

# ---- hull ------------------------------------------------------------------------------------------------------------
# Convex hulls of pixels and points, and enclosing polygons with fewer sides. Source: Andrew's monotone chain, 1979.


class Sprite(Protocol):
    """The part of PixelMask's interface that mask_hull uses."""

    solid: np.ndarray  # bool [row, col]
    origin: tuple[float, float]


def mask_hull(mask: Sprite) -> np.ndarray:
    """Return the convex hull (n, 2) [px] of a mask's solid pixels in body space, clockwise on the screen."""
    rows = np.flatnonzero(mask.solid.any(axis=1))
    left = mask.solid[rows].argmax(axis=1)
    right = mask.solid.shape[1] - mask.solid[rows, ::-1].argmax(axis=1)
    corners = np.concatenate([np.stack([x, rows + down], axis=1) for x in (left, right) for down in (0, 1)])
    return convex_hull(corners.astype(float)) - np.array(mask.origin)


def convex_hull(points: np.ndarray, flat: float = 0.0) -> np.ndarray:
    """Return the corners (n, 2) [px] of the convex hull of points (m, 2), clockwise on the screen (monotone chain).

    If all points are collinear there are fewer than three corners. flat [px2]: a corner is removed if twice the area of
    the triangle with its neighbours is at most `flat`.
    """
    ordered = sorted(set(map(tuple, points.tolist())))
    if len(ordered) < 3:
        return np.array(ordered, float).reshape(-1, 2)
    return np.array(_half(ordered, flat)[:-1] + _half(ordered[::-1], flat)[:-1], float)


def fewer_sides(corners: np.ndarray, most: int) -> np.ndarray:
    """Return a polygon (m, 2) [px] of at most `most` sides that contains a given convex polygon.

    corners (n, 2) [px]: the given polygon, clockwise on the screen. A side is removed by extending its two neighbours
    until they meet; the side whose removal adds the least area is removed first. A side is kept if its neighbours do
    not meet beyond it. So a triangle never changes, and the result may have more than `most` sides.
    """
    corners = np.array(corners, float)
    while len(corners) > max(most, 3):
        k, tip = _cheapest(corners)
        if tip is None:
            break
        # Side k from corner k to k + 1 shrinks to the corner where its neighbours meet.
        corners[k] = tip
        corners = np.delete(corners, (k + 1) % len(corners), axis=0)
    return corners


def _cheapest(corners):
    sides = np.roll(corners, -1, axis=0) - corners
    before, after = np.roll(sides, 1, axis=0), np.roll(sides, -1, axis=0)
    meet = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turn = before[:, 0] * sides[:, 1] - before[:, 1] * sides[:, 0]
    share = (sides[:, 0] * after[:, 1] - sides[:, 1] * after[:, 0]) / np.where(meet > 0.0, meet, 1.0)
    added = np.where(meet > 0.0, share * turn, math.inf)
    k = int(added.argmin())
    return (k, None) if math.isinf(added[k]) else (k, corners[k] + share[k] * before[k])


def _half(points, flat):
    chain = []
    for x, y in points:
        while (
            len(chain) > 1
            and (
                (chain[-1][0] - chain[-2][0]) * (y - chain[-2][1]) - (chain[-1][1] - chain[-2][1]) * (x - chain[-2][0])
            )
            <= flat
        ):
            chain.pop()
        chain.append((x, y))
    return chain


# ---- box -------------------------------------------------------------------------------------------------------------
# Smallest oriented box around a convex hull: one side lies on a hull edge. Source: Freeman and Shapira 1975.


def least_box(hull: np.ndarray) -> tuple[float, float, tuple[float, float], float]:
    """Return (width, height, center, angle) [px, rad] of the box of least area around a convex hull.

    If several boxes have the least area, the first in the order of the hull's edges is returned. hull (n, 2) [px]:
    corners of the hull.
    """
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


# ---- capsule ---------------------------------------------------------------------------------------------------------
# Capsule of small area around a convex hull: the best of all axis directions, by sampling and refinement.

DIRECTIONS = 90  # axes tried, over half a turn
SHORT = 1e-6  # [radii] a capsule with a shorter line becomes a circle
CLOSER = 40  # number of times that the step between directions is halved around the best one


def least_capsule(hull: np.ndarray) -> tuple[tuple[float, float], tuple[float, float], float]:
    """Return (a, b, radius) [px] of a capsule of small area around a convex hull; a equals b for a circle.

    a, b: ends of the capsule's axis. Many directions of the axis are tried, and the capsule with the least area is
    returned. The radius is half the hull's width across the axis. hull (n, 2) [px]: corners of the hull.
    """
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
    # Distance by which the line may end before each corner, so that the cap still contains the corner.
    reach = np.sqrt(np.maximum(radius * radius - (aside - middle) ** 2, 0.0))
    first, last = (along + reach).min(), (along - reach).max()
    if first + SHORT * radius >= last:  # all within a circle about any point between
        radius += max(last - first, 0.0) / 2.0
        first = last = (first + last) / 2.0
    a, b = axis * first + across * middle, axis * last + across * middle
    area = 2.0 * radius * (last - first) + math.pi * radius * radius
    return float(area), (float(a[0]), float(a[1])), (float(b[0]), float(b[1])), float(radius)


# ---- circle ----------------------------------------------------------------------------------------------------------
# Smallest enclosing circle of points. Source: Welzl 1991, in the incremental form.


def least_circle(points: Iterable[Sequence[float]] | np.ndarray) -> tuple[float, float, float]:
    """Return (x, y, radius) [px] of the smallest circle around points (n, 2), n >= 1."""
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
