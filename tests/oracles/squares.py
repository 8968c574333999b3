"""Unions of pixel squares at exact poses, as shapely geometry, and poses at which two of them nearly touch."""

import math

import numpy as np
from shapely import affinity
from shapely.geometry import Polygon

from tests.oracles.outlines import pixels

TOUCHED = 1e-3  # [px] near enough
ROUNDS = 40


def union_of(solid, origin):
    """Return the union of the squares of solid[row][col] in body space."""
    return pixels(solid, -origin[0], -origin[1])


def at(union, pose):
    """Return a union at a pose (x, y, angle); the rotation is clockwise on the screen."""
    x, y, angle = pose
    c, s = math.cos(angle), math.sin(angle)
    return affinity.affine_transform(union, [c, -s, s, c, x, y])


def touching(a, b, angle, direction):
    """Return the pose (x, y, angle) at which b first touches a, when it is moved from outside towards the middle of a.

    angle: rotation of b [rad]. direction: direction from a in which b starts [rad]. If b passes a without a touch, the
    pose lies beyond the middle of a.
    """
    turned = at(b, (0.0, 0.0, angle))
    c, s = math.cos(direction), math.sin(direction)
    away = sum(math.hypot(*np.ptp(np.array(each.bounds).reshape(2, 2), axis=0)) for each in (a, b))
    for _ in range(ROUNDS):
        gap = a.distance(affinity.translate(turned, away * c, away * s))
        if gap < TOUCHED or away < 0.0:
            break
        away -= gap
    return away * c, away * s, angle


def random_pose(rng, a, b, near):
    """Return a random pose (x, y, angle) of b around a. near: within 2 px of the pose at which it touches a.

    One pose in four has a multiple of a quarter turn; half of these lie on multiples of half a pixel.
    """
    angle, direction = rng.uniform(-7.0, 7.0), rng.uniform(-math.pi, math.pi)
    straight = rng.random()
    if straight < 0.25:
        angle = int(rng.integers(-4, 5)) * math.pi / 2
    if near:
        x, y, _ = touching(a, b, angle, direction)
        x, y = x + rng.uniform(-1.4, 1.4), y + rng.uniform(-1.4, 1.4)
    else:
        reach = 0.4 * sum(each.bounds[2] - each.bounds[0] + each.bounds[3] - each.bounds[1] for each in (a, b))
        away = rng.uniform(0.0, reach)
        x, y = away * math.cos(direction), away * math.sin(direction)
    if straight < 0.125:
        x, y = math.floor(2.0 * x) / 2.0, math.floor(2.0 * y) / 2.0
    return x, y, angle


def convex(points, pose):
    """Return a convex polygon at a pose."""
    return at(Polygon(points), pose)
