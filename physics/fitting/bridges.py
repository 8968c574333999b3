"""Holes joined to the outer loop: bridges there and back, and the rings around what is left."""

import math
from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from physics.fitting.sight import Ring, Walls

TRIED = 16  # lines that are tested at once, shortest first


def bridged(points: np.ndarray, loops: Sequence[np.ndarray], flat: float) -> list[np.ndarray]:
    """Rings without holes (numbers of points, clockwise on the screen) of an outer loop and its holes.

    points (n, 2) [px], no two alike; loops: numbers of points, the outer one clockwise on the screen, holes the other
    way; they may touch in common points. Each hole, or group of holes that touch, is joined to what is left of it by
    the shortest line inside, which becomes a side of the rings twice, there and back. flat [px2]: doubled areas that
    count as none.
    """
    if len(loops) == 1:
        return [loops[0]]
    work = _Bridges(points, loops, flat)
    while work.apart():
        work.bridge()
    return work.rings()


class _Bridges:
    def __init__(self, points, loops, flat):
        self.points = points
        self.loops = loops
        self.walls = [Ring(points[loop], flat) for loop in loops]
        self.sides = [np.concatenate([wall.corners for wall in self.walls])]
        self.sides.append(np.concatenate([wall.following for wall in self.walls]))
        self.corners = defaultdict(list)  # number of a point -> (loop, place in it)
        for number, loop in enumerate(loops):
            for place, point in enumerate(loop.tolist()):
                self.corners[point].append((number, place))
        self.group = list(range(len(loops)))
        for at in self.corners.values():
            for number, _ in at[1:]:
                self._join(at[0][0], number)
        self.lines = []  # bridges: pairs of numbers of points

    def _join(self, a, b):
        a, b = sorted((self.group[a], self.group[b]))
        self.group = [a if each == b else each for each in self.group]

    def apart(self):
        return any(self.group)

    def bridge(self):
        """Joins the leftmost group of holes to the outer loop's: nothing can stand between them."""
        apart = [k for k, group in enumerate(self.group) if group]
        first = self.group[min(apart, key=lambda k: self.walls[k].corners[:, 0].min())]
        these = np.unique(np.concatenate([self.loops[k] for k in apart if self.group[k] == first]))
        others = np.unique(
            np.concatenate([loop for loop, group in zip(self.loops, self.group, strict=True) if not group])
        )
        distance = ((self.points[these][:, None] - self.points[others]) ** 2).sum(axis=2).ravel()
        order = np.argsort(distance, kind="stable")
        for start in range(0, len(order), TRIED):
            a, b = np.divmod(order[start : start + TRIED], len(others))
            a, b = these[a], others[b]
            for k in np.flatnonzero(self._free(a, b)).tolist():
                if self._faces(int(a[k]), int(b[k])) and self._faces(int(b[k]), int(a[k])):
                    self.lines.append((int(a[k]), int(b[k])))
                    self._join(0, self.corners[int(a[k])][0][0])
                    return
        raise ValueError("holes must lie inside points (one sees no corner of the others)")

    def _free(self, a, b):
        lines = np.array(self.lines, np.int64).reshape(-1, 2)
        corners = np.concatenate([self.sides[0], self.points[lines[:, 0]]])
        following = np.concatenate([self.sides[1], self.points[lines[:, 1]]])
        a, b = self.points[a], self.points[b]
        around = np.concatenate([a, b])
        return Walls(corners, following, self.walls[0].flat).near(around.min(axis=0), around.max(axis=0)).free(a, b)

    def _faces(self, a, b):
        toward = (self.points[b] - self.points[a])[None]
        return all(self.walls[loop].faces(np.array([place]), toward, False)[0] for loop, place in self.corners[a])

    def rings(self):
        sides = [side for loop in self.loops for side in zip(loop.tolist(), np.roll(loop, -1).tolist(), strict=True)]
        sides += [side for line in self.lines for side in (line, line[::-1])]
        leaving = defaultdict(list)
        for a, b in sides:
            leaving[a].append(b)
        unseen, found = dict.fromkeys(sides), []
        while unseen:
            side, ring = next(iter(unseen)), []
            while side in unseen:
                del unseen[side]
                ring.append(side[0])
                side = (side[1], self._onward(*side, leaving[side[1]]))
            found.append(np.array(ring))
        return found

    def _onward(self, a, b, ways):
        """Of the sides that leave b the next around the inside, for who comes from a."""
        if len(ways) == 1:
            return ways[0]
        x, y = (self.points[a] - self.points[b]).tolist()

        def turned(c):
            u, v = (self.points[c] - self.points[b]).tolist()
            return math.atan2(y * u - x * v, x * u + y * v) % math.tau or math.tau  # straight back comes last

        return min(ways, key=turned)
