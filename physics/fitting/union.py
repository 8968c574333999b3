"""The boundary of the union of rounded convex hulls: lines and arcs, exactly, however the hulls overlap.

Each hull's own boundary is cut wherever something of another hull's may begin or end on it; then of every stretch its
middle tells whether it is on the boundary of all: not inside another hull, not along one that lies on the other side,
and of stretches that lie on each other, the first hull's only.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

ROUNDING = 1e-9  # of the hulls' size: nearer than this to a boundary is on it

Hull = tuple[np.ndarray, float]  # corners (k, 2) clockwise on the screen, 1: a disc, 2: a capsule; and radius [px]


class Stretch(NamedTuple):
    """A line, or an arc that is walked clockwise on the screen, the inside to the right."""

    start: np.ndarray  # (2,) [px]
    end: np.ndarray  # (2,)
    center: np.ndarray  # (2,) of an arc
    radius: float  # 0: a line
    first: float  # [rad] angle at which the arc starts
    turn: float  # [rad] > 0

    def at(self, shares: np.ndarray) -> np.ndarray:
        """Points (m, 2) at shares (m,) of the way."""
        if self.radius == 0.0:
            return self.start + shares[:, None] * (self.end - self.start)
        angles = self.first + shares * self.turn
        return self.center + self.radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)

    def between(self, a: float, b: float) -> "Stretch":
        """From one share of the way to another."""
        start, end = self.at(np.array([a, b]))
        return Stretch(start, end, self.center, self.radius, self.first + a * self.turn, (b - a) * self.turn)

    @property
    def length(self) -> float:
        return self.radius * self.turn if self.radius > 0.0 else math.hypot(*(self.end - self.start))


def boundary(hulls: Sequence[Hull]) -> list[Stretch]:
    """The stretches of the boundary of a union of hulls, the inside to the right of each; [] of no hulls.

    Where hulls share a side it is none of it. O(sides squared) at worst; only those with common bounds are compared.
    """
    if not hulls:
        return []
    low = np.array([corners.min(axis=0) - radius for corners, radius in hulls])
    high = np.array([corners.max(axis=0) + radius for corners, radius in hulls])
    near = ROUNDING * float((high.max(axis=0) - low.min(axis=0)).max())
    around = [_around(corners, radius) for corners, radius in hulls]
    found = []
    for k in range(len(hulls)):
        meet = ((low <= high[k] + near) & (high >= low[k] - near)).all(axis=1)
        others = [i for i in np.flatnonzero(meet).tolist() if i != k]
        sides = [side for i in others for side in around[i]]
        for side in around[k]:
            shares = _cuts(side, sides, near)
            for a, b in zip(shares[:-1], shares[1:], strict=True):
                stretch = side.between(a, b)
                if stretch.length > near and not any(_covered(stretch, hulls[i], i < k, near) for i in others):
                    found.append(stretch)
    return found


def line(start: np.ndarray, end: np.ndarray) -> Stretch:
    """A straight stretch between two points."""
    return Stretch(np.asarray(start, float), np.asarray(end, float), np.zeros(2), 0.0, 0.0, 0.0)


def _around(corners, radius):
    """A hull's own boundary: its sides moved outward, and arcs of a quarter turn at most about its corners."""
    if len(corners) == 1:
        bounds = [(k * math.pi / 2.0, math.pi / 2.0) for k in range(4)]
        return [_arc(corners[0], radius, first, turn) for first, turn in bounds]
    sides = np.roll(corners, -1, axis=0) - corners
    normals = np.stack([sides[:, 1], -sides[:, 0]], axis=1) / np.hypot(*sides.T)[:, None]
    found = []
    for k, normal in enumerate(normals):
        start, end = corners[k] + radius * normal, corners[(k + 1) % len(corners)] + radius * normal
        found.append(line(start, end))
        if radius > 0.0:
            after = normals[(k + 1) % len(corners)]
            first, last = math.atan2(normal[1], normal[0]), math.atan2(after[1], after[0])
            turn = (last - first) % math.tau
            count = max(1, math.ceil(turn / (math.pi / 2.0) - 1e-9))
            for i in range(count):
                found.append(_arc(corners[(k + 1) % len(corners)], radius, first + i * turn / count, turn / count))
    return [each for each in found if each.length > 0.0]


def _arc(center, radius, first, turn):
    ends = np.array([first, first + turn])
    start, end = center + radius * np.stack([np.cos(ends), np.sin(ends)], axis=1)
    return Stretch(start, end, np.asarray(center, float), radius, first, turn)


def _cuts(side, others, near):
    """Shares of the way, from 0 to 1, between which nothing of the others begins, ends or crosses."""
    shares = [0.0, 1.0]
    for other in others:
        points = [other.start, other.end]
        if side.radius == 0.0:
            points += _line_meets(side, other)
        else:
            points += _arc_meets(side, other)
        shares += [_share(side, point, near) for point in points]
    kept = sorted(each for each in shares if 0.0 <= each <= 1.0)
    return [a for k, a in enumerate(kept) if k == 0 or a > kept[k - 1]]


def _share(side, point, near):
    """How far along the way a point of it is; less than 0: it is not on it."""
    if side.radius == 0.0:
        along = side.end - side.start
        share = float((point - side.start) @ along / (along @ along))
        off = abs(along[0] * (point - side.start)[1] - along[1] * (point - side.start)[0]) / math.hypot(*along)
    else:
        x, y = (point - side.center).tolist()
        share = (math.atan2(y, x) - side.first) % math.tau / side.turn
        off = abs(math.hypot(x, y) - side.radius)
    return share if off <= near else -1.0


def _line_meets(side, other):
    """Points where the line of a straight side meets another stretch's line or circle."""
    along = side.end - side.start
    if other.radius > 0.0:
        return _on_circle(side.start, along, other.center, other.radius)
    way = other.end - other.start
    cross = along[0] * way[1] - along[1] * way[0]
    if cross == 0.0:
        return []
    to = other.start - side.start
    return [side.start + (to[0] * way[1] - to[1] * way[0]) / cross * along]


def _arc_meets(side, other):
    """Points where the circle of an arc meets another stretch's line or circle."""
    if other.radius == 0.0:
        return _on_circle(other.start, other.end - other.start, side.center, side.radius)
    apart = other.center - side.center
    distance = math.hypot(*apart)
    if distance == 0.0:
        return []
    # The line through both meeting points stands square on the line of the centres.
    ahead = (distance * distance + side.radius * side.radius - other.radius * other.radius) / (2.0 * distance)
    foot = side.center + ahead / distance * apart
    return _on_circle(foot, np.array([-apart[1], apart[0]]), side.center, side.radius)


def _on_circle(start, along, center, radius):
    """Where an endless line meets a circle; the nearest point twice where it only touches, or does not reach."""
    length = math.hypot(*along)
    along = along / length
    ahead = float((center - start) @ along)
    foot = start + ahead * along
    half = math.sqrt(max(radius * radius - float((center - foot) @ (center - foot)), 0.0))
    return [foot - half * along, foot + half * along]


def _covered(stretch, hull, earlier, near):
    """Whether a hull takes a stretch off the boundary: that lies in it, against it, or on an earlier one's."""
    point = stretch.at(np.array([0.5]))[0]
    gap, normal = gap_and_normal(hull, point)
    if abs(gap) > near:
        return gap < 0.0
    if stretch.radius > 0.0:
        outward = (point - stretch.center) / stretch.radius
    else:
        along = stretch.end - stretch.start
        outward = np.array([along[1], -along[0]]) / math.hypot(*along)
    return bool(outward @ normal < 0.0) or earlier


def gap_and_normal(hull: Hull, point: np.ndarray) -> tuple[float, np.ndarray]:
    """How far a point lies outside of a hull (negative: how deep inside) [px], and its outward normal there."""
    corners, radius = hull
    if len(corners) == 1:
        away = point - corners[0]
        distance = math.hypot(*away)
        return distance - radius, away / distance if distance > 0.0 else np.array([1.0, 0.0])
    sides = np.roll(corners, -1, axis=0) - corners
    normals = np.stack([sides[:, 1], -sides[:, 0]], axis=1) / np.hypot(*sides.T)[:, None]
    to = point - corners
    over = (to * normals).sum(axis=1)
    if len(corners) > 2 and over.max() <= 0.0:
        return float(over.max()) - radius, normals[over.argmax()]
    share = np.clip((to * sides).sum(axis=1) / (sides * sides).sum(axis=1), 0.0, 1.0)
    away = to - share[:, None] * sides
    distance = np.hypot(*away.T)
    k = int(distance.argmin())
    # So near to a sharp side that rounding would say where it points.
    flat = distance[k] <= ROUNDING * float(np.abs(sides).max())
    return float(distance[k]) - radius, normals[k] if flat else away[k] / distance[k]
