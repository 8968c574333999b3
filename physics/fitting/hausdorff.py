"""Hausdorff distance of two boundaries of lines and arcs, by halving: exact to NEAR.

The farthest point of one boundary from the other is closed in on. How far the points of a stretch can be at most is
known from its middle (nobody is farther from the other boundary than by the way there) and from its ends: along a line
the distance from one and the same line is convex, so it is greatest at an end, and an arc is no farther than its chord
and its height above it. What cannot beat the best found so far is left out.
"""

import math
from collections.abc import Sequence

import numpy as np

from physics.fitting.union import Stretch

NEAR = 1e-6  # [px]
ROWS = 1 << 20  # distances that are kept at a time: bounds the memory


def hausdorff(a: Sequence[Stretch], b: Sequence[Stretch]) -> float:
    """The largest distance of a point of either boundary from the other one [px]; at most 1e-6 less than that.

    0 where both are none, inf where one is.
    """
    if not a or not b:
        return 0.0 if not a and not b else math.inf
    return max(_farthest(a, b, 0.0), _farthest(b, a, 0.0))


class _Figure:
    """A boundary as arrays: its lines, and its arcs."""

    def __init__(self, stretches):
        lines = [each for each in stretches if each.radius == 0.0]
        self.start = np.array([each.start for each in lines]).reshape(-1, 2)
        self.along = np.array([each.end for each in lines]).reshape(-1, 2) - self.start
        arcs = [each for each in stretches if each.radius > 0.0]
        self.center = np.array([each.center for each in arcs]).reshape(-1, 2)
        self.radius, self.first, self.turn = (
            np.array([getattr(each, name) for each in arcs]) for name in ("radius", "first", "turn")
        )
        self.ends = np.array([[each.start, each.end] for each in arcs]).reshape(-1, 2, 2)

    def from_lines(self, points):
        """(m, lines) distances [px]."""
        to = points[:, None] - self.start
        share = np.clip((to * self.along).sum(axis=2) / (self.along * self.along).sum(axis=1), 0.0, 1.0)
        return np.hypot(*(to - share[:, :, None] * self.along).transpose(2, 0, 1))

    def from_arcs(self, points):
        """(m,) distances from the nearest arc [px]; inf: there is none."""
        if not len(self.center):
            return np.full(len(points), math.inf)
        to = points[:, None] - self.center
        angle = (np.arctan2(to[:, :, 1], to[:, :, 0]) - self.first) % math.tau
        round_one = np.where(angle <= self.turn, np.abs(np.hypot(*to.transpose(2, 0, 1)) - self.radius), math.inf)
        corners = np.hypot(*(points[:, None, None] - self.ends).transpose(3, 0, 1, 2)).min(axis=2)
        return np.minimum(round_one, corners).min(axis=1)


def _farthest(a, b, best):
    other = _Figure(b)
    rows = max(1, ROWS // (len(b) + 1))
    todo = list(a)
    while todo:
        left = []
        for first in range(0, len(todo), rows):
            some = todo[first : first + rows]
            best, open_ones = _looked_at(some, other, best)
            left += open_ones
        todo = [
            half
            for bound, each in left
            if bound > best + NEAR
            for half in (each.between(0.0, 0.5), each.between(0.5, 1.0))
        ]
    return best


def _looked_at(some, other, best):
    """The greatest distance at ends and middles, and (bound, stretch) of those that may hold a greater one."""
    points = np.array([each.at(np.array([0.0, 0.5, 1.0])) for each in some])
    lines = other.from_lines(points.reshape(-1, 2)).reshape(len(some), 3, -1)
    nearest = np.minimum(lines.min(axis=2, initial=math.inf), other.from_arcs(points.reshape(-1, 2)).reshape(-1, 3))
    best = max(best, float(nearest.max()))
    length = np.array([each.length for each in some])
    height = np.array([each.radius * (1.0 - math.cos(each.turn / 2.0)) for each in some])
    by_ends = np.maximum(lines[:, 0], lines[:, 2]).min(axis=1, initial=math.inf) + height
    bound = np.minimum(nearest[:, 1] + length / 2.0, by_ends)
    return best, [(bound[k], some[k]) for k in np.flatnonzero(bound > best + NEAR).tolist()]
