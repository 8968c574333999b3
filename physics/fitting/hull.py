"""Convex hulls of pixels and points, and hulls of fewer sides around them. Source: Andrew's monotone chain, 1979."""

import math
from typing import Protocol

import numpy as np


class Sprite(Protocol):
    """What a hull is taken of: shapes.mask.PixelMask has it."""

    solid: np.ndarray  # bool [row, col]
    origin: tuple[float, float]


def mask_hull(mask: Sprite) -> np.ndarray:
    """Hull corners (n, 2) [px] of the union of pixel squares in body space, clockwise on the screen."""
    rows = np.flatnonzero(mask.solid.any(axis=1))
    left = mask.solid[rows].argmax(axis=1)
    right = mask.solid.shape[1] - mask.solid[rows, ::-1].argmax(axis=1)
    corners = np.concatenate([np.stack([x, rows + down], axis=1) for x in (left, right) for down in (0, 1)])
    return convex_hull(corners.astype(float)) - np.array(mask.origin)


def convex_hull(points: np.ndarray, flat: float = 0.0) -> np.ndarray:
    """Hull corners (n, 2) [px] of points (m, 2), clockwise on the screen; fewer than three when all lie on a line.

    flat [px2]: a corner goes when the triangle with its neighbours has at most that area, doubled.
    """
    ordered = sorted(set(map(tuple, points.tolist())))
    if len(ordered) < 3:
        return np.array(ordered, float).reshape(-1, 2)
    return np.array(_half(ordered, flat)[:-1] + _half(ordered[::-1], flat)[:-1], float)


def fewer_sides(corners: np.ndarray, most: int) -> np.ndarray:
    """A convex polygon of at most `most` sides around one, (n, 2) [px] clockwise on the screen.

    Sides go one by one, by extending their neighbours until these meet: that side first whose going adds least area.
    It never does for a side whose neighbours do not meet beyond it; so a triangle is always left as it is.
    """
    corners = np.array(corners, float)
    while len(corners) > max(most, 3):
        k, tip = _cheapest(corners)
        if tip is None:
            break
        # Side k from corner k to k + 1 shrinks to one corner where its neighbours meet.
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
