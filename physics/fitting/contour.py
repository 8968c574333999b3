"""Crack contours: the closed loops between solid and clear pixels of a raster.

A crack is the side of length 1 between a solid and a clear pixel; a run is a straight row of them. Runs are found for
the whole raster at once, chained by the corner where one ends and the next starts, and told in loops. Source: Rosenfeld
and Kak 1982, section 11.1 (crack following), here without a scan per step.

Where two solid pixels touch only diagonally (a pinch) four runs meet and there are two ways to go on:

    joined: the loop passes on both sides      apart: it stays with the pixel
      # |                                        # |
    ----+----   the two pixels are one piece   ----+----   each is a piece of its own
        | #                                        | #
"""

from typing import NamedTuple

import numpy as np


class Loop(NamedTuple):
    """Corners where a crack loop turns, in raster pixels, x first."""

    corners: np.ndarray  # (n, 2) int64
    joined: np.ndarray  # (n,) bool: the corner is a joined pinch


class Contour(NamedTuple):
    """One connected piece of solid pixels: its edge and the edges of its holes."""

    outer: Loop  # clockwise on the screen
    holes: list[Loop]  # counter-clockwise on the screen


def contours(solid: np.ndarray, joined: int = 0) -> list[Contour]:
    """The pieces of solid[row, col] bool, ordered by their topmost (then leftmost) corner.

    Corners are only where the direction changes. joined [px]: 0: pinches are apart: pieces are 4-connected, no loop
    visits a corner twice, and loops meet at most in pinches. Otherwise a pinch is joined unless two of its runs, one
    of either direction, are both that long: the pieces are 8-connected through it and a loop may pass it twice.
    Linear in pixels (vectorised) and corners.
    """
    runs = _Runs(np.ascontiguousarray(solid, dtype=bool), joined)
    outers, holes = [], []
    for loop in runs.loops():
        points = runs.corners[loop]
        (outers if doubled_area(points) > 0 else holes).append((loop, points))
    pieces, piece_of = [], np.full(len(runs.corners), -1)
    outers.sort(key=lambda each: _first(each[1]))
    for loop, points in outers:
        piece_of[loop] = len(pieces)
        pieces.append(Contour(Loop(points, runs.joined[loop]), []))
    # What bounds the solid left of a hole belongs to the hole's piece: the outer loop, or a hole further left.
    holes.sort(key=lambda each: each[1][:, 0].min())
    for loop, points in holes:
        piece = piece_of[runs.left_of(points)]
        piece_of[loop] = piece
        pieces[piece].holes.append(Loop(points, runs.joined[loop]))
    for piece in pieces:
        piece.holes.sort(key=lambda hole: _first(hole.corners))
    return pieces


def doubled_area(points: np.ndarray) -> float:
    """Twice the signed area of a loop (n, 2): positive when it is clockwise on the screen."""
    x, y = points[:, 0], points[:, 1]
    return (x * np.roll(y, -1) - y * np.roll(x, -1)).sum()


def _first(points):
    return min(zip(points[:, 1].tolist(), points[:, 0].tolist(), strict=True))


class _Runs:
    """All runs of a raster: the horizontal ones first, then the vertical; corner k is where run k starts."""

    def __init__(self, solid, joined):
        height, width = solid.shape
        padded = np.zeros((height + 2, width + 2), np.int8)
        padded[1:-1, 1:-1] = solid
        # +1: solid below, goes right. -1: solid above, goes left. One column more, so that no run leaves its row.
        lines, starts, ends, signs = _runs_of(padded[1:, 1:] - padded[:-1, 1:])
        first = np.where(signs > 0, starts, ends)
        last = np.where(signs > 0, ends, starts)
        self.horizontal = len(lines)
        # Along columns: +1: solid left, goes down. -1: solid right, goes up.
        columns, tops, bottoms, falls = _runs_of((padded[1:, :-1] - padded[1:, 1:]).T)
        upper = np.where(falls > 0, tops, bottoms)
        lower = np.where(falls > 0, bottoms, tops)
        self.corners = np.concatenate([np.stack([first, lines], 1), np.stack([columns, upper], 1)])
        stops = np.concatenate([np.stack([last, lines], 1), np.stack([columns, lower], 1)])
        # left_of: vertical runs are in order of column, then row.
        self.tall = height + 1
        self.order = columns * self.tall + tops
        self.cracks = padded[1:, :-1] != padded[1:, 1:]
        self._follow(stops, np.concatenate([signs, falls]), np.concatenate([ends - starts, bottoms - tops]), joined)

    def _follow(self, stops, signs, lengths, joined):
        """Which run goes on where each ends. Each corner has one horizontal and one vertical run, a pinch two."""
        count = self.horizontal
        wide = max(int(self.corners[:, 0].max(initial=0)), 0) + 1
        start, stop = self.corners[:, 1] * wide + self.corners[:, 0], stops[:, 1] * wide + stops[:, 0]
        self.next = np.empty(len(start), np.int64)
        pinches, tallies = np.unique(start[:count], return_counts=True)
        upright, upright_tallies = np.unique(start[count:], return_counts=True)
        pinches = np.union1d(pinches[tallies > 1], upright[upright_tallies > 1])
        longest = np.zeros((2, len(pinches)), np.int64)
        for axis, rows in enumerate((slice(0, count), slice(count, None))):
            for ends in (start[rows], stop[rows]):
                at = np.searchsorted(pinches, ends)
                there = at < len(pinches)
                there[there] = pinches[at[there]] == ends[there]
                np.maximum.at(longest[axis], at[there], lengths[rows][there])
        apart = pinches if joined == 0 else pinches[longest.min(axis=0) >= joined]
        self.apart = np.isin(start, apart)
        self.joined = np.isin(start, pinches) & ~self.apart
        # Clockwise on the screen: right goes on down, down left; apart at a pinch, so turned to the right.
        for rows, others, turn in ((slice(0, count), slice(count, None), 1), (slice(count, None), slice(0, count), -1)):
            keys = start[others] * 2 + (signs[others] > 0)
            order = np.argsort(keys, kind="stable")
            keys = keys[order]
            right = signs[rows] * turn > 0
            wanted = stop[rows] * 2 + np.where(np.isin(stop[rows], apart), right, ~right)
            at = np.searchsorted(keys, wanted)
            found = keys[np.minimum(at, len(keys) - 1)] == wanted if len(keys) else np.zeros(0, bool)
            at = np.where(found, at, np.searchsorted(keys, wanted ^ 1))
            self.next[rows] = (order[at] if len(keys) else at) + (others.start or 0)

    def loops(self):
        """Rows of runs, loop by loop; cut where a loop visits a pinch that is apart twice."""
        following, apart, unseen = self.next.tolist(), self.apart.tolist(), bytearray(b"\1") * len(self.next)
        places = self.corners
        for begin in range(self.horizontal):
            run, loop, seen = begin, [], {}
            while unseen[run]:
                unseen[run] = 0
                if apart[run]:
                    place = tuple(places[run].tolist())
                    if place in seen:
                        cut = seen[place]
                        yield np.array(loop[cut:])
                        seen = {each: at for each, at in seen.items() if at < cut}
                        del loop[cut:]
                    seen[place] = len(loop)
                loop.append(run)
                run = following[run]
            if loop:
                yield np.array(loop)

    def left_of(self, points):
        """The run on the other side of the solid pixels left of a hole."""
        k = int(points[:, 0].argmin())
        # At the hole's leftmost column one of the two runs at that corner is vertical.
        x, y = points[k].tolist()
        before, after = points[k - 1].tolist(), points[(k + 1) % len(points)].tolist()
        row = min(y, before[1] if before[0] == x else after[1])
        column = int(np.flatnonzero(self.cracks[row, :x])[-1])
        return self.horizontal + int(np.searchsorted(self.order, column * self.tall + row, side="right")) - 1


def _runs_of(cracks):
    """(line, start, end, sign) of each straight row of equal cracks (-1, 1) in cracks[line, place]."""
    before = np.zeros((cracks.shape[0], cracks.shape[1] + 1), np.int8)
    before[:, 1:] = cracks
    after = np.zeros_like(before)
    after[:, :-1] = cracks
    change = before != after
    line, start = np.nonzero(change & (after != 0))
    _, end = np.nonzero(change & (before != 0))
    return line, start, end, after[line, start].astype(np.int64)
