"""Masses of plane figures: exact sums over parts, each about its own centre: a far one loses no digits."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from physics.checks import Points
from physics.vec2 import Vec2


@dataclass(frozen=True)
class Mass:
    """Mass, centre of mass in body space [px], and inertia about that centre."""

    mass: float
    center: Vec2
    inertia: float


NOTHING = Mass(0.0, Vec2(0.0, 0.0), 0.0)


def together(parts: Iterable[Mass]) -> Mass:
    """The mass of several parts: inertia about the common centre of mass, by the theorem of parallel axes."""
    parts = [part for part in parts if part.mass > 0.0]
    if not parts:
        return NOTHING
    # About the first part's centre, not the origin: what is far from the origin keeps its digits.
    base_x, base_y = parts[0].center
    mass = math.fsum(part.mass for part in parts)
    x = math.fsum(part.mass * (part.center[0] - base_x) for part in parts) / mass
    y = math.fsum(part.mass * (part.center[1] - base_y) for part in parts) / mass
    inertia = math.fsum(
        part.inertia + part.mass * ((part.center[0] - base_x - x) ** 2 + (part.center[1] - base_y - y) ** 2)
        for part in parts
    )
    return Mass(mass, Vec2(base_x + x, base_y + y), inertia)


def polygon_mass(points: Points, density: float) -> Mass:
    """Of a polygon, points (n, 2) clockwise on the screen: shoelace integrals about the first corner."""
    base = np.array(points[0])
    a = np.array(points) - base
    b = np.roll(a, -1, axis=0)
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    area = cross.sum() / 2.0
    center = ((a + b) * cross[:, None]).sum(axis=0) / (6.0 * area)
    a, b = a - center, b - center
    cross = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    second = (cross * ((a * a).sum(1) + (a * b).sum(1) + (b * b).sum(1))).sum() / 12.0
    return Mass(float(density * area), Vec2(*(base + center).tolist()), float(density * second))


def rounded_mass(points: Points, radius: float, density: float) -> Mass:
    """Of a polygon grown by a radius: the polygon, a rectangle along every edge, a sector of a disc at every corner."""
    parts = [polygon_mass(points, density)]
    count = len(points)
    edges = [
        (points[(k + 1) % count][0] - points[k][0], points[(k + 1) % count][1] - points[k][1]) for k in range(count)
    ]
    for k, (dx, dy) in enumerate(edges):
        length = math.hypot(dx, dy)
        out_x, out_y = dy / length, -dx / length
        mass = density * length * radius
        parts.append(
            Mass(
                mass,
                Vec2(points[k][0] + 0.5 * dx + 0.5 * radius * out_x, points[k][1] + 0.5 * dy + 0.5 * radius * out_y),
                mass * (length * length + radius * radius) / 12.0,
            )
        )
        before_x, before_y = edges[k - 1]
        turn = math.atan2(before_x * dy - before_y * dx, before_x * dx + before_y * dy)
        # The sector opens about the bisector of the two outward normals.
        other = math.hypot(before_x, before_y)
        bisector_x, bisector_y = out_x + before_y / other, out_y - before_x / other
        size = math.hypot(bisector_x, bisector_y)
        away = 4.0 * radius * math.sin(0.5 * turn) / (3.0 * turn)
        mass = density * 0.5 * turn * radius * radius
        parts.append(
            Mass(
                mass,
                Vec2(points[k][0] + away * bisector_x / size, points[k][1] + away * bisector_y / size),
                mass * (0.5 * radius * radius - away * away),
            )
        )
    return together(parts)
