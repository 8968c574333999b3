"""Convex hull of a mask's pixel corners. Source: Andrew's monotone chain, 1979."""

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
    points = sorted(set(map(tuple, corners.tolist())))
    return np.array(_half(points)[:-1] + _half(points[::-1])[:-1], float) - np.array(mask.origin)


def _half(points):
    chain = []
    for x, y in points:
        while (
            len(chain) > 1
            and (
                (chain[-1][0] - chain[-2][0]) * (y - chain[-2][1]) - (chain[-1][1] - chain[-2][1]) * (x - chain[-2][0])
            )
            <= 0
        ):
            chain.pop()
        chain.append((x, y))
    return chain
