"""Convex decomposition of a polygon with holes by cuts between its corners."""

import heapq
import math
from collections import defaultdict
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from physics.outline.contour import doubled_area
from physics.settings import MAX_CORNERS

# ---- sight -----------------------------------------------------------------------------------------------------------
# Visibility of corners: a ring (closed polygon) can be cut between two corners if the line between them lies inside.
#
# Rings are clockwise on the screen, with the inside to the right. A bridge joins a hole to its surrounding ring. The
# ring then passes each end of the bridge twice, once on either side of the bridge, so each end is two corners (copies).
# The inside lies in other directions at each copy.


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the cross products (...) of vectors a and b (..., 2): positive if b is clockwise from a on the screen."""
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


class Walls:
    """Sides of polygons that obstruct lines between corners.

    Side k leads from corners[k] to following[k], both (n, 2) [px]. flat [px2]: a triangle counts as degenerate if twice
    its area is at most `flat`.
    """

    def __init__(self, corners: np.ndarray, following: np.ndarray, flat: float) -> None:
        self.corners, self.following, self.flat = corners, following, flat
        self.after = following - corners

    def near(self, low: np.ndarray, high: np.ndarray) -> "Walls":
        """Return Walls with only the sides whose bounding boxes overlap a box. low, high (2,) [px]: its corners."""
        meet = (np.minimum(self.corners, self.following) <= high) & (np.maximum(self.corners, self.following) >= low)
        meet = meet.all(axis=1)
        return Walls(self.corners[meet], self.following[meet], self.flat)

    def free(self, a: np.ndarray, b: np.ndarray) -> np.ndarray:
        """Return (m,) bool: whether the line from a[i] to b[i] crosses no side and passes through no corner.

        a, b (m, 2) [px]: ends of the lines.
        """
        crossed, passed = self.obstacles(a, b)
        return ~crossed & ~passed.any(axis=1)

    def obstacles(self, a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return (crossed (m,), passed (m, n)), both bool, for the lines from a[i] to b[i].

        crossed: whether the line crosses a side; passed: whether the line passes through each of the n corners, not
        counting its ends. a, b (m, 2) [px].
        """
        along = (b - a)[:, None]
        to = self.corners - a[:, None]
        side, side_after = cross(along, to), cross(along, self.following - a[:, None])
        of_a, of_b = cross(to, self.after), cross(self.corners - b[:, None], self.after)
        for each in (side, side_after, of_a, of_b):
            each[np.abs(each) <= self.flat] = 0.0
        crossed = np.any((side * side_after < 0) & (of_a * of_b < 0), axis=1)
        ahead, length = (along * to).sum(axis=2), (along * along).sum(axis=2)
        apart = (self.corners != a[:, None]).any(axis=2) & (self.corners != b[:, None]).any(axis=2)
        return crossed, (side == 0) & (ahead > 0) & (ahead < length) & apart


class Ring(Walls):
    """Sides of a closed ring of corners (n, 2) [px], clockwise on the screen, with tests of inward directions."""

    def __init__(self, corners: np.ndarray, flat: float) -> None:
        super().__init__(corners, np.roll(corners, -1, axis=0), flat)
        self.back = np.roll(corners, 1, axis=0) - corners
        turn = cross(self.after, self.back)
        self.reflex = turn < -flat
        self.convex = turn > flat

    def faces(self, k: np.ndarray, toward: np.ndarray, closed: bool) -> np.ndarray:
        """Return (m,) bool: whether the direction toward[i] leads from corner k[i] into the ring.

        k (m,): indices of corners; toward (m, 2): directions; closed: True if a direction along a side also counts as
        leading into the ring.
        """
        low = self.flat if not closed else -self.flat
        from_after, to_back = cross(self.after[k], toward), cross(toward, self.back[k])
        within = np.where(self.reflex[k], (from_after > low) | (to_back > low), (from_after > low) & (to_back > low))
        return np.where(~self.reflex[k] & ~self.convex[k], from_after > low, within)

    def pairs(self) -> tuple[np.ndarray, np.ndarray]:
        """Return (cuts, lines), two (n, n) bool matrices: the pairs of corners that a cut, or a line, can join.

        A cut is strictly inside the ring. A line may also run along sides and pass through corners. Only entries [i, j]
        with i < j are set. O(n^3), vectorised.
        """
        count = len(self.corners)
        i, j = np.triu_indices(count, 2)
        toward = self.corners[j] - self.corners[i]
        apart = (toward != 0).any(axis=1)
        seen = apart & self.faces(i, toward, True) & self.faces(j, -toward, True)
        i, j, toward = i[seen], j[seen], toward[seen]
        crossed, passed = self.obstacles(self.corners[i], self.corners[j])
        cuts, lines = np.zeros((count, count), bool), np.zeros((count, count), bool)
        clear = ~crossed & ~passed.any(axis=1)
        strict = clear & self.faces(i, toward, False) & self.faces(j, -toward, False)
        cuts[i[strict], j[strict]] = True
        lines[i[clear], j[clear]] = True
        for row in np.flatnonzero(~crossed & passed.any(axis=1)):
            at = np.flatnonzero(passed[row])
            way = np.broadcast_to(toward[row], (len(at), 2))
            through = self.faces(at, way, True) & self.faces(at, -way, True)
            # If a corner has two copies (ends of a bridge), at least one of them must let the line through.
            places = {tuple(each) for each in self.corners[at].tolist()}
            lines[i[row], j[row]] = places == {tuple(each) for each in self.corners[at[through]].tolist()}
        return cuts, lines


# ---- bridges ---------------------------------------------------------------------------------------------------------
# A bridge is a line from a hole to the outer loop that a ring follows in both directions. Bridges turn a polygon with
# holes into rings without holes.

TRIED_LINES = 16  # number of lines tested in one array operation, shortest first


def bridged(points: np.ndarray, loops: Sequence[np.ndarray], flat: float) -> list[np.ndarray]:
    """Return a polygon with holes as rings without holes: arrays of indices of points, clockwise on the screen.

    A bridge is a line inside the polygon. It joins a group of touching holes to the outer loop or to a hole already
    joined. The shortest such line is used. The bridge becomes two sides of opposite directions. points (n, 2) [px], all
    distinct; loops: arrays of indices of points: first the outer loop, clockwise on the screen, then holes,
    counter-clockwise. Loops may touch at common points. flat [px2]: a triangle is degenerate if twice its area is at
    most this.
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
        self.corners = defaultdict(list)  # index of a point -> (loop, place in it)
        for number, loop in enumerate(loops):
            for place, point in enumerate(loop.tolist()):
                self.corners[point].append((number, place))
        self.group = list(range(len(loops)))
        for at in self.corners.values():
            for number, _ in at[1:]:
                self._join(at[0][0], number)
        self.lines = []  # bridges: pairs of point indices

    def _join(self, a, b):
        a, b = sorted((self.group[a], self.group[b]))
        self.group = [a if each == b else each for each in self.group]

    def apart(self):
        return any(self.group)

    def bridge(self):
        """Join one group of touching holes to the outer loop or a joined hole by the shortest unobstructed line.

        The group with the leftmost hole is joined, because no other hole obstructs lines to its left.
        """
        apart = [k for k, group in enumerate(self.group) if group]
        first = self.group[min(apart, key=lambda k: self.walls[k].corners[:, 0].min())]
        these = np.unique(np.concatenate([self.loops[k] for k in apart if self.group[k] == first]))
        others = np.unique(
            np.concatenate([loop for loop, group in zip(self.loops, self.group, strict=True) if not group])
        )
        distance = ((self.points[these][:, None] - self.points[others]) ** 2).sum(axis=2).ravel()
        order = np.argsort(distance, kind="stable")
        for start in range(0, len(order), TRIED_LINES):
            a, b = np.divmod(order[start : start + TRIED_LINES], len(others))
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
        """Return the end point (index) of the side that follows side a -> b in its ring; the inside is on the right.

        a, b: indices of points; ways: indices of the points to which sides lead from b.
        """
        if len(ways) == 1:
            return ways[0]
        x, y = (self.points[a] - self.points[b]).tolist()

        def turned(c):
            u, v = (self.points[c] - self.points[b]).tolist()
            return math.atan2(y * u - x * v, x * u + y * v) % math.tau or math.tau  # straight back comes last

        return min(ways, key=turned)


# ---- simple polygon --------------------------------------------------------------------------------------------------
# Validation of a polygon with holes: it must be simple, with holes inside, and no two polygon edges may meet.

FLAT = 1e-14  # share of the polygon's size²: twice the area of a triangle up to this is a rounding error
ROWS = 256  # polygon edges compared with all others in one array operation: bounds the memory


def simple_rings(outer: np.ndarray, holes: Sequence[np.ndarray]) -> list[np.ndarray]:
    """Check a polygon with holes. Return [outer ring, holes...], (n, 2) each, without repeated and collinear corners.

    In the result the outer ring is clockwise on the screen, the holes are counter-clockwise; the arguments may have
    either winding. Holes may touch the outer ring and each other at common corners. Raises ValueError for a ring of
    fewer than three corners or without area, and for a hole that is not inside. Also raises ValueError for edges that
    meet; the message names both.
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
    """Return a ring (n, 2) [px] without its repeated and collinear corners.

    flat [px2]: a corner is collinear if twice the area of the triangle with its neighbours is at most `flat`.
    """
    while len(ring) > 2:
        before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
        straight = np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]) <= flat
        if not straight.any():
            break
        # Of adjacent corners only every second one is removed per pass, so that one of two equal corners stays.
        straight[1:] &= ~straight[:-1]
        straight[-1] &= ~straight[0]
        ring = ring[~straight]
    return ring


def crossings(points: np.ndarray, ring: np.ndarray) -> np.ndarray:
    """Return how often a ray to the right from each point crosses a ring: (m,). Odd: the point is inside.

    points (m, 2), ring (n, 2) [px].
    """
    following = np.roll(ring, -1, axis=0)
    x, y = points[:, :1], points[:, 1:]
    spans = (ring[:, 1] > y) != (following[:, 1] > y)
    rise = following[:, 1] - ring[:, 1]
    at = ring[:, 0] + (y - ring[:, 1]) * (following[:, 0] - ring[:, 0]) / np.where(rise == 0.0, 1.0, rise)
    return (spans & (at > x)).sum(axis=1)


def _name(number):
    return "points" if number == 0 else f"holes[{number - 1}]"


class _Edges:
    """All edges of the rings of a polygon, except edges of length 0."""

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
        self.before = np.empty(len(self.ring), np.int64)  # the edge that ends at this edge's start
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
        """Return (m,) bool: whether edges a[i] and b[i] meet, except at a permitted common corner.

        a, b (m,): indices of edges, a[i] < b[i].
        """
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


# ---- fewest convex ---------------------------------------------------------------------------------------------------
# Minimum convex decomposition of a small ring by cuts between its corners.
#
# Source: Keil 1985, in the form of Keil and Snoeyink 2002 ("narrowest pairs"), over all pairs of corners that see each
# other instead of only the pairs with a reflex corner.
#
# For each line (i, k) inside, the minimum number of cuts is computed for the part of the ring that the line cuts off,
# from i to k. The piece adjacent to the line begins with a side i -> a and ends with a side b -> k:
#
#         b--- ...          Pieces grow in a fan from i: the last triangle is (i, j, k). The line (j, k) is a side of
#        / \                the ring or a cut. The line (i, j) is crossed if the piece beyond (i, j) stays convex at j
#       k---i --- a         and i, else it is a cut. On ties the narrower piece is better: a late, b early.


class _End(NamedTuple):
    """A convex piece beside line (i, k) that may be part of the best decomposition.

    first: first corner of the piece after i; last: last corner of the piece before k; grown: the smaller piece that
    this one extends, or None if the line (i, last) is a cut or a side.
    """

    first: int
    last: int
    grown: "_End | None"


def fewest_convex(corners: np.ndarray, flat: float) -> list[list[int]]:
    """Divide a ring into the fewest convex pieces by cuts between its corners. Return the corner indices of each piece.

    Each piece is clockwise on the screen and may have collinear corners. corners (n, 2) [px]: the ring; flat [px2]: a
    triangle is degenerate if twice its area is at most this. O(n^3).
    """
    return _Search(Ring(corners, flat)).pieces()


class _Search:
    def __init__(self, ring):
        self.count = len(ring.corners)
        cuts, lines = ring.pairs()
        near = np.arange(self.count - 1)
        cuts[near, near + 1] = lines[near, near + 1] = True
        lines[0, self.count - 1] = True
        self.cuts, self.lines = cuts.tolist(), lines.tolist()
        after = [np.flatnonzero(row).tolist() for row in lines]
        self.x, self.y = ring.corners.T.tolist()
        self.flat = ring.flat
        self.cost, self.ends = {}, {}
        for i in range(self.count - 1):
            self.cost[i, i + 1], self.ends[i, i + 1] = 0, []
        for gap in range(2, self.count):
            for i in range(self.count - gap):
                if self.lines[i][i + gap]:
                    self._best(i, i + gap, [j for j in after[i] if j < i + gap])

    def _turn(self, a, b, c):
        """Return whether the path a, b, c of corners (indices) is straight or turns clockwise on the screen at b."""
        x, y = self.x, self.y
        return (x[b] - x[a]) * (y[c] - y[b]) - (y[b] - y[a]) * (x[c] - x[b]) >= -self.flat

    def _best(self, i, k, between):
        least, ends = self.count, []
        for j in between:
            if not self.cuts[j][k] or (i, j) not in self.cost or (j, k) not in self.cost or not self._turn(i, j, k):
                continue
            cost = self.cost[i, j] + self.cost[j, k] + (k - j > 1)
            if cost > least:
                continue
            # The narrowest piece beyond (i, j) that this triangle may join.
            joined = None
            for end in self.ends[i, j]:
                if self._turn(end.last, j, k) and self._turn(k, i, end.first):
                    if joined is None or end.first > joined.first:
                        joined = end
            if joined is not None:
                end = _End(joined.first, j, joined)
            elif self.cuts[i][j]:
                cost += j - i > 1
                end = _End(j, j, None)
            else:
                continue
            if cost < least:
                least, ends = cost, [end]
            elif cost == least and not any(other.first >= end.first and other.last <= end.last for other in ends):
                ends = [other for other in ends if other.first > end.first or other.last < end.last]
                ends.append(end)
        if ends:
            self.cost[i, k], self.ends[i, k] = least, ends

    def pieces(self):
        found, todo = [], [(0, self.count - 1)]
        while todo:
            i, k = todo.pop()
            chain, end = [k], self.ends[i, k][0]
            while end is not None:
                if chain[-1] - end.last > 1:
                    todo.append((end.last, chain[-1]))
                chain.append(end.last)
                if end.grown is None and end.last - i > 1:
                    todo.append((i, end.last))
                end = end.grown
            found.append([i, *reversed(chain)])
        return found


# ---- shave -----------------------------------------------------------------------------------------------------------
# Simplification of rings: bumps and notches up to a tolerance are removed, shallowest first.


def shaved(rings: Sequence[np.ndarray], tolerance: float) -> list[np.ndarray]:
    """Return rings (n, 2) [px] without shallow bumps and notches (Visvalingam and Whyatt 1993, by distance).

    Each removed corner is within tolerance [px] of the side that replaces it. A ring keeps at least three corners. No
    removal makes sides cross or touch. rings: simple rings, the outer ring first, then holes.
    """
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
        self.gone = {k: [] for k in range(count)}  # corners removed between corner k and the next kept one

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
        """Return the error [px] of removing corner k: the largest distance of a removed corner from the new side.

        The removed corners are k and those removed earlier between the ends of the new side.
        """
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
        """Return whether corner k can be removed: the triangle of k and its two neighbours contains no other corner.

        Corners on the triangle's sides count as contained.
        """
        a, b = self.points[self.before[k]], self.points[self.after[k]]
        c = self.points[k]
        x, y = self.points[self.kept].T

        def side(p, q):
            return (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])

        sides = side(a, c), side(c, b), side(b, a)
        held = np.all([each >= 0 for each in sides], axis=0) | np.all([each <= 0 for each in sides], axis=0)
        return int(held.sum()) == 3


# ---- convex parts ----------------------------------------------------------------------------------------------------
# Convex decomposition of a polygon with holes by cuts between its corners.
#
# Holes are bridged. Rings of more than LARGEST corners are split by short cuts into two halves, repeatedly. Each ring
# is cut into the fewest convex pieces (fewest_convex). Then adjacent pieces with a convex union are merged across
# bridges and splits (Hertel and Mehlhorn 1983). Without holes and with few corners the number of parts is the least
# possible for cuts between corners; otherwise it is near the least.

LARGEST = 40  # most corners of a ring that is cut optimally, in cubic time: 20 ms for 40
TRIED_CUTS = 256  # number of splitting cuts tested in one array operation, shortest first
STARTS = 128  # most reflex corners at which a splitting cut may begin, except in the last attempt: bounds the memory

ConvexPart = tuple[np.ndarray, np.ndarray]  # corners (k, 2) clockwise on the screen [px]; inner (k,) bool: shared side


def convex_parts(outer: np.ndarray, holes: Sequence[np.ndarray] = (), tolerance: float = 0.0) -> list[ConvexPart]:
    """Divide a simple polygon with holes into convex parts of at most 16 corners. Return [(corners, inner)].

    corners (k, 2): clockwise on the screen, starting with the topmost, then leftmost corner; inner (k,) bool: whether
    the side k -> k + 1 is shared with another part. All corners are corners of the polygon. A collinear corner is kept
    only between an inner side and a side of the boundary.

    outer (n, 2), holes [(m, 2)] [px]: in either winding. Holes may touch the outer ring and each other only at common
    corners. tolerance [px] >= 0: bumps and notches are removed first, as long as each removed corner is within
    tolerance of the side that replaces it and no sides cross; with 0 the parts cover exactly the polygon. Raises
    ValueError for edges that meet or cross; the message names both. Also raises ValueError for rings without area or of
    fewer than three corners, and for holes that are not inside.
    """
    rings = simple_rings(outer, holes)
    return partition(shaved(rings, tolerance) if tolerance > 0.0 else rings)


def partition(rings: Sequence[np.ndarray]) -> list[ConvexPart]:
    """Return the convex parts of simple rings, in the format of convex_parts. The rings are not checked.

    The outer ring is first and clockwise on the screen, holes follow and are counter-clockwise.
    """
    together = np.concatenate(rings)
    base = together.min(axis=0)
    flat = FLAT * float(np.ptp(together, axis=0).max()) ** 2
    # Equal corners have one index, so that a cut is the same pair of indices on its two sides.
    points, numbers = np.unique(together - base, axis=0, return_inverse=True)
    ends = np.cumsum([len(ring) for ring in rings])
    loops = np.split(numbers.ravel(), ends[:-1])
    pieces = []
    for small in _halved(points, bridged(points, loops, flat), flat):
        pieces += [small[piece] for piece in fewest_convex(points[small], flat)]
    pieces = _joined(points, [piece.tolist() for piece in pieces], flat)
    pieces = [part for piece in pieces for part in _at_most(piece, MAX_CORNERS)]
    sides = {side for piece in pieces for side in _sides(piece)}
    found = []
    for piece in pieces:
        inner = np.array([side[::-1] in sides for side in _sides(piece)])
        corners, inner = _tidy(points[piece] + base, inner, flat)
        if len(corners) > 2:  # cuts along a line leave pieces without area
            found.append((corners, inner))
    return found


def _sides(piece):
    return list(zip(piece, piece[1:] + piece[:1], strict=True))


def _tidy(corners, inner, flat):
    """Return a part's (corners, inner) without collinear corners, starting with its topmost, then leftmost corner.

    A collinear corner between an inner and an outer side is kept. corners (k, 2) [px]; inner (k,) bool: see
    convex_parts; flat [px2]: a triangle is degenerate if twice its area is at most this.
    """
    before, after = corners - np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0) - corners
    keep = (np.abs(cross(before, after)) > flat) | (inner != np.roll(inner, 1))
    corners, inner = corners[keep], inner[keep]
    if not len(corners):
        return corners, inner
    first = np.lexsort((corners[:, 0], corners[:, 1]))[0]
    return np.roll(corners, -first, axis=0), np.roll(inner, -first)


def _halved(points, rings, flat):
    """Split rings by cuts until each is convex or has at most LARGEST corners. Return the resulting rings.

    points (n, 2) [px]; rings: arrays of indices of points; flat [px2]: a triangle is degenerate if twice its area is at
    most this.
    """
    todo, found = list(rings), []
    while todo:
        ring = todo.pop()
        sides = Ring(points[ring], flat)
        if len(ring) <= LARGEST or not sides.reflex.any():
            found.append(ring)
            continue
        i, j = _halving(sides)
        todo.append(ring[i : j + 1])
        todo.append(np.concatenate([ring[j:], ring[: i + 1]]))
    return found


def _halving(sides):
    """Return two corners (indices) between which a short cut splits a ring into parts of similar size.

    The cut starts at a reflex corner. sides: the Ring.
    """
    count = len(sides.corners)
    starts = np.flatnonzero(sides.reflex)
    for share in (4, 8, 16, 64, count):
        some = starts if share == count else starts[:: len(starts) // STARTS + 1]
        gap = (np.arange(count) - some[:, None]) % count
        least = max(2, count // share)
        far = (gap >= least) & (gap <= count - least)
        distance = ((sides.corners[some][:, None] - sides.corners) ** 2).sum(axis=2)
        rows, j = np.nonzero(far & (distance > 0.0))
        order = np.argsort(distance[rows, j], kind="stable")
        for first in range(0, len(order), TRIED_CUTS):
            a, b = some[rows[order[first : first + TRIED_CUTS]]], j[order[first : first + TRIED_CUTS]]
            toward = sides.corners[b] - sides.corners[a]
            sees = np.flatnonzero(sides.faces(a, toward, False) & sides.faces(b, -toward, False))
            for k in sees.tolist():
                if sides.free(sides.corners[a[k : k + 1]], sides.corners[b[k : k + 1]])[0]:
                    return min(a[k], b[k]), max(a[k], b[k])
            if first >= 8 * TRIED_CUTS and share != count:
                break
    raise ValueError("points must be a simple polygon (no two corners of a part of it see each other)")


def _joined(points, pieces, flat):
    """Merge convex pieces across common sides if their union is convex with at most 16 corners. Return the pieces.

    The longest common side is tried first. points (n, 2) [px]; pieces: lists of indices of points; flat [px2]: a
    triangle is degenerate if twice its area is at most this.
    """
    owner = {side: number for number, piece in enumerate(pieces) for side in _sides(piece)}
    common = [side for side in owner if side[0] < side[1] and side[::-1] in owner]
    common.sort(key=lambda side: (-float(((points[side[0]] - points[side[1]]) ** 2).sum()), side))
    x, y = points.T.tolist()

    def turn(a, b, c):
        return (x[b] - x[a]) * (y[c] - y[b]) - (y[b] - y[a]) * (x[c] - x[b]) >= -flat

    for u, v in common:
        first, second = owner[u, v], owner[v, u]
        if first == second:
            continue
        a, b = pieces[first], pieces[second]
        k, m = a.index(v), b.index(u)
        a, b = a[k:] + a[:k], b[m:] + b[:m]  # a: v ... u, b: u ... v
        whole = a + b[1:-1]
        if len(whole) <= MAX_CORNERS and turn(a[-2], u, b[1]) and turn(b[-2], v, a[1]):
            pieces[first], pieces[second] = whole, []
            for side in _sides(whole):
                owner[side] = first
    return [piece for piece in pieces if piece]


def _at_most(piece, most):
    """Halve a convex piece until each resulting piece has at most `most` corners. Return the resulting pieces.

    piece: list of the indices of its corners.
    """
    if len(piece) <= most:
        return [piece]
    half = len(piece) // 2
    return _at_most(piece[: half + 1], most) + _at_most(piece[half:] + piece[:1], most)
