"""What a polygon with holes must be before it is cut: simple, its holes inside, no two edges that meet."""

from collections.abc import Sequence

import numpy as np

from physics.fitting.contour import doubled_area

FLAT = 1e-14  # of the polygon's size squared: a doubled triangle area that is nothing but rounding
ROWS = 256  # edges that are compared with all others at a time: bounds the memory


def simple_rings(outer: np.ndarray, holes: Sequence[np.ndarray]) -> list[np.ndarray]:
    """The outer ring (n, 2), clockwise on the screen, and the holes, the other way, without repeated corners in a row
    and without corners in a straight line.

    Rings may come in either winding. Holes may touch the outer ring and each other in common corners. Raises
    ValueError for fewer than three corners or no area, for edges that meet (naming both), and for a hole that is not
    inside.
    """
    rings = [np.asarray(each, float) for each in (outer, *holes)]
    for number, ring in enumerate(rings):
        if len(ring) < 3:
            raise ValueError(f"{_name(number)} must have at least 3 corners (got {len(ring)})")
    edges = _Edges(rings)
    edges.refuse_crossings()
    for number in range(1, len(rings)):
        inside = crossings(edges.middles(number), rings[0]) % 2 == 1
        for other in range(1, len(rings)):
            if other != number:
                inside &= crossings(edges.middles(number), rings[other]) % 2 == 0
        if not inside.all():
            raise ValueError(
                f"{_name(number)} must lie inside points and outside of other holes (got {rings[number].tolist()})"
            )
    found = []
    for number, ring in enumerate(rings):
        kept = without_straight(ring, FLAT * edges.size**2)
        area = doubled_area(kept - kept[0]) if len(kept) > 2 else 0.0
        if abs(area) <= FLAT * edges.size**2:
            raise ValueError(f"{_name(number)} must have an area (got {ring.tolist()})")
        found.append(kept if (area > 0) == (number == 0) else kept[::-1])
    return found


def without_straight(ring: np.ndarray, flat: float) -> np.ndarray:
    """A ring (n, 2) without repeated corners in a row and without corners in a straight line [flat: px2, doubled]."""
    while len(ring) > 2:
        before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
        straight = np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]) <= flat
        if not straight.any():
            break
        # Of neighbours only every second goes at a time: of two that repeat each other one stays.
        straight[1:] &= ~straight[:-1]
        straight[-1] &= ~straight[0]
        ring = ring[~straight]
    return ring


def crossings(points: np.ndarray, ring: np.ndarray) -> np.ndarray:
    """How often a ray to the right from each point (m, 2) crosses a ring (n, 2): odd inside."""
    following = np.roll(ring, -1, axis=0)
    x, y = points[:, :1], points[:, 1:]
    spans = (ring[:, 1] > y) != (following[:, 1] > y)
    rise = following[:, 1] - ring[:, 1]
    at = ring[:, 0] + (y - ring[:, 1]) * (following[:, 0] - ring[:, 0]) / np.where(rise == 0.0, 1.0, rise)
    return (spans & (at > x)).sum(axis=1)


def _name(number):
    return "points" if number == 0 else f"holes[{number - 1}]"


class _Edges:
    """All edges of some rings, those without length left out."""

    def __init__(self, rings):
        self.size = max(float(np.ptp(np.concatenate(rings), axis=0).max()), 1e-300)
        self.ring = np.concatenate([np.full(len(each), k) for k, each in enumerate(rings)])
        self.number = np.concatenate([np.arange(len(each)) for each in rings])
        self.start = np.concatenate(rings)
        self.end = np.concatenate([np.roll(each, -1, axis=0) for each in rings])
        long = (self.start != self.end).any(axis=1)
        self.ring, self.number, self.start, self.end = (
            each[long] for each in (self.ring, self.number, self.start, self.end)
        )
        self.before = np.empty(len(self.ring), np.int64)  # the edge that ends where this one begins
        for ring in range(len(rings)):
            rows = np.flatnonzero(self.ring == ring)
            self.before[rows] = np.roll(rows, 1)

    def middles(self, ring):
        return ((self.start + self.end) / 2.0)[self.ring == ring]

    def refuse_crossings(self):
        least, most = np.minimum(self.start, self.end), np.maximum(self.start, self.end)
        for first in range(0, len(self.ring), ROWS):
            rows = slice(first, first + ROWS)
            near = (least[rows, None] <= most).all(axis=2) & (most[rows, None] >= least).all(axis=2)
            a, b = np.nonzero(near)
            a += first
            a, b = a[a < b], b[a < b]
            meet = self._meet(a, b)
            if meet.any():
                k = int(np.flatnonzero(meet)[0])
                first_edge, second_edge = (f"{self.number[i]} of {_name(self.ring[i])}" for i in (a[k], b[k]))
                raise ValueError(
                    f"points must be a simple polygon (edge {first_edge}, {self._shown(a[k])}, meets "
                    f"edge {second_edge}, {self._shown(b[k])})"
                )

    def _shown(self, edge):
        return f"{tuple(self.start[edge].tolist())} to {tuple(self.end[edge].tolist())}"

    def _meet(self, a, b):
        """Whether edges a and b have a point in common that they may not: rows of edges, a < b."""
        flat = FLAT * self.size**2
        p, q, r, s = self.start[a], self.end[a], self.start[b], self.end[b]
        sides = [_cross(q - p, r - p), _cross(q - p, s - p), _cross(s - r, p - r), _cross(s - r, q - r)]
        sides = [np.where(np.abs(each) <= flat, 0.0, np.sign(each)) for each in sides]
        crossed = (sides[0] * sides[1] < 0) & (sides[2] * sides[3] < 0)
        # An end on the other edge: between its ends, or at one of them.
        ends = ((r, p, q, sides[0]), (s, p, q, sides[1]), (p, r, s, sides[2]), (q, r, s, sides[3]))
        for point, start, end, side in ends:
            along = ((point - start) * (end - start)).sum(axis=1)
            length = ((end - start) ** 2).sum(axis=1)
            between = (side == 0) & (along > 0) & (along < length) & (point != start).any(1) & (point != end).any(1)
            crossed |= between
        same_ring = self.ring[a] == self.ring[b]
        shared = (p == r).all(1) | (p == s).all(1) | (q == r).all(1) | (q == s).all(1)
        neighbours = (self.before[b] == a) | (self.before[a] == b)
        folded = ((p == r).all(1) & (q == s).all(1)) | ((p == s).all(1) & (q == r).all(1))
        return crossed | (same_ring & shared & ~neighbours) | folded


def _cross(a, b):
    return a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
