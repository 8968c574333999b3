"""Rings with fewer corners: bumps and notches that are shallower than a tolerance go, shallowest first."""

import heapq
import math
from collections.abc import Sequence

import numpy as np


def shaved(rings: Sequence[np.ndarray], tolerance: float) -> list[np.ndarray]:
    """Simple rings (n, 2) [px] again, of corners of the given ones; each corner left out is within tolerance [px] of
    the side that stands for it. A ring keeps three corners, and no side comes to cross or touch another.
    Source: Visvalingam and Whyatt 1993, by distance in place of area."""
    work = _Work(rings, tolerance)
    return work.shave()


class _Work:
    def __init__(self, rings, tolerance):
        self.points = np.concatenate(rings)
        self.tolerance = tolerance
        count = len(self.points)
        self.after, self.before = np.empty(count, np.int64), np.empty(count, np.int64)
        self.left = {}
        self.ring = np.empty(count, np.int64)
        first = 0
        for number, ring in enumerate(rings):
            rows = np.arange(first, first + len(ring))
            self.after[rows], self.before[rows] = np.roll(rows, -1), np.roll(rows, 1)
            self.ring[rows], self.left[number] = number, len(ring)
            first += len(ring)
        self.kept = np.ones(count, bool)
        self.gone = {k: [] for k in range(count)}  # corners left out between k and the next

    def shave(self):
        waiting = [(self._depth(k), k) for k in range(len(self.points))]
        heapq.heapify(waiting)
        while waiting and waiting[0][0] <= self.tolerance:
            depth, k = heapq.heappop(waiting)
            if not self.kept[k] or depth != self._depth(k) or self.left[self.ring[k]] <= 3 or not self._free(k):
                continue
            a, b = int(self.before[k]), int(self.after[k])
            self.gone[a] += [k, *self.gone.pop(k)]
            self.after[a], self.before[b], self.kept[k] = b, a, False
            self.left[self.ring[k]] -= 1
            for each in (a, b):
                heapq.heappush(waiting, (self._depth(each), each))
        found = []
        for ring in range(len(self.left)):
            rows = np.flatnonzero(self.kept & (self.ring == ring))
            found.append(self.points[rows])
        return found

    def _depth(self, k):
        """How far what would be left out lies from the side that would replace it [px]."""
        a, b = int(self.before[k]), int(self.after[k])
        (ax, ay), (bx, by) = self.points[a].tolist(), self.points[b].tolist()
        dx, dy = bx - ax, by - ay
        length = dx * dx + dy * dy
        worst = 0.0
        for each in (k, *self.gone[a], *self.gone[k]):
            x, y = self.points[each].tolist()
            share = min(max(((x - ax) * dx + (y - ay) * dy) / length, 0.0), 1.0) if length > 0.0 else 0.0
            worst = max(worst, math.hypot(x - ax - share * dx, y - ay - share * dy))
        return worst

    def _free(self, k):
        """Whether the triangle that goes or comes holds no other corner, its sides included."""
        a, b = self.points[self.before[k]], self.points[self.after[k]]
        c = self.points[k]
        x, y = self.points[self.kept].T

        def side(p, q):
            return (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])

        sides = side(a, c), side(c, b), side(b, a)
        held = np.all([each >= 0 for each in sides], axis=0) | np.all([each <= 0 for each in sides], axis=0)
        return int(held.sum()) == 3
