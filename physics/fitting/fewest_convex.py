"""The fewest convex pieces of a small ring, cut between its corners.

Source: Keil 1985, in the form of Keil and Snoeyink 2002 ("narrowest pairs"), over all corners that see each other in
place of the reflex ones only.

For each line (i, k) inside, the part of the ring from i to k beyond it needs a number of cuts. The piece that lies
against the line begins with a side i -> a and ends with b -> k:

        b--- ...          Pieces grow in a fan from i: the last triangle is (i, j, k). The line (j, k) is a side of the
       / \\                ring or a cut, the line (i, j) is crossed when the piece beyond it is convex at j and i, and
      k---i --- a         else a cut. Of pieces with as few cuts the narrower are better: a late, b early.
"""

from typing import NamedTuple

import numpy as np

from physics.fitting.sight import Ring


class _End(NamedTuple):
    """A best piece against a line: first corner after i, last before k, and the piece it grew from (None: a cut)."""

    first: int
    last: int
    grown: "_End | None"


def fewest_convex(corners: np.ndarray, flat: float) -> list[list[int]]:
    """Rows of the corners of each piece, clockwise on the screen, of a ring (n, 2) [px].

    flat [px2]: doubled triangle areas that count as none. Pieces may have corners in a straight line. O(n^3).
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
        """Whether the way a -> b -> c turns clockwise on the screen or goes straight on."""
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
