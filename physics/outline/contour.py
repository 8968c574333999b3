"""Outlines of pixels: contours along pixel edges, and outlines in which straight lines replace staircases."""

import math
from typing import NamedTuple

import numpy as np

from physics.outline.curves import JOINING, POINT, Path, lines_of_loop, room_for_lines
from physics.outline.paths import SHARP

# ---- contour ---------------------------------------------------------------------------------------------------------
# Crack contours: the closed loops between solid and clear pixels of a raster (crack following).
#
# A crack is the pixel edge, of length 1, between a solid and a clear pixel. A run is a straight row of cracks. The runs
# of the whole raster are found by array operations, linked at the corners where one run ends and the next starts, and
# returned as loops. Source: Rosenfeld and Kak 1982, section 11.1, here without a scan per crack.
#
# A pinch is a corner at which two solid pixels touch only diagonally. Four runs meet there, and a loop can continue in
# two ways:
#
#     joined: the loop passes from one to the other      apart: the loop stays with one pixel
#       # |                                                # |
#     ----+----   the two pixels are one piece           ----+----   each is a piece of its own
#         | #                                                | #


class Loop(NamedTuple):
    """A closed loop of pixel edges, given by the corners at which it turns: (x, y) in raster pixels."""

    corners: np.ndarray  # (n, 2) int64
    joined: np.ndarray  # (n,) bool: the corner is a pinch at which two diagonal pixels are joined


class Contour(NamedTuple):
    """One connected piece of solid pixels: the loop of pixel edges around it, and the loops around its holes."""

    outer: Loop  # clockwise on the screen
    holes: list[Loop]  # counter-clockwise on the screen


def contours(solid: np.ndarray, joined: int = 0) -> list[Contour]:
    """Return the connected pieces of solid[row, col] bool, ordered by their topmost, then leftmost corner.

    A loop lists only the corners at which it turns. A pinch is a corner at which solid pixels touch only diagonally.
    joined [px] determines whether the two pixels at a pinch are connected. With joined = 0 they never are: pieces are
    4-connected, no loop visits a corner twice, and loops touch only at pinches. With joined > 0 they are connected,
    unless a horizontal and a vertical run of at least `joined` px meet at the pinch. A run is a straight row of pixel
    edges. A loop may pass a connected pinch twice. The time is linear in pixels (vectorised) and corners.
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
    # The solid pixels left of a hole are bounded on the left by the outer loop of their piece or by another hole of it.
    holes.sort(key=lambda each: each[1][:, 0].min())
    for loop, points in holes:
        piece = piece_of[runs.left_of(points)]
        piece_of[loop] = piece
        pieces[piece].holes.append(Loop(points, runs.joined[loop]))
    for piece in pieces:
        piece.holes.sort(key=lambda hole: _first(hole.corners))
    return pieces


def doubled_area(points: np.ndarray) -> float:
    """Return twice the signed area [px2] of a closed polygon: positive if it is clockwise on the screen.

    points (n, 2) [px]: corners of the polygon.
    """
    x, y = points[:, 0], points[:, 1]
    return (x * np.roll(y, -1) - y * np.roll(x, -1)).sum()


def _first(points):
    return min(zip(points[:, 1].tolist(), points[:, 0].tolist(), strict=True))


class _Runs:
    """All runs (straight rows of pixel edges) of a raster, horizontal ones first. Corner k is the start of run k."""

    def __init__(self, solid, joined):
        height, width = solid.shape
        padded = np.zeros((height + 2, width + 2), np.int8)
        padded[1:-1, 1:-1] = solid
        # +1: solid below, the run goes right. -1: solid above, it goes left. One extra column keeps each run in its
        # row.
        lines, starts, ends, signs = _runs_of(padded[1:, 1:] - padded[:-1, 1:])
        first = np.where(signs > 0, starts, ends)
        last = np.where(signs > 0, ends, starts)
        self.horizontal = len(lines)
        # Along columns: +1: solid left, the run goes down. -1: solid right, it goes up.
        columns, tops, bottoms, falls = _runs_of((padded[1:, :-1] - padded[1:, 1:]).T)
        upper = np.where(falls > 0, tops, bottoms)
        lower = np.where(falls > 0, bottoms, tops)
        self.corners = np.concatenate([np.stack([first, lines], 1), np.stack([columns, upper], 1)])
        stops = np.concatenate([np.stack([last, lines], 1), np.stack([columns, lower], 1)])
        # For left_of: vertical runs are in order of column, then row.
        self.tall = height + 1
        self.order = columns * self.tall + tops
        self.cracks = padded[1:, :-1] != padded[1:, 1:]
        self._follow(stops, np.concatenate([signs, falls]), np.concatenate([ends - starts, bottoms - tops]), joined)

    def _follow(self, stops, signs, lengths, joined):
        """Set for each run the next run of its loop (self.next), and find the pinches whose pixels are not connected.

        At a pinch, solid pixels touch only diagonally, and two horizontal and two vertical runs meet. At any other
        corner one run of each kind meets. stops: corner at the end of each run; signs: direction of each run; lengths
        [px]: length of each run; joined [px]: see contours.
        """
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
        # Clockwise on the screen: right is followed by down, down by left. At a pinch that is apart, turn right.
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
        """Yield each loop as an array of the indices of its runs.

        If a loop visits a pinch twice and the pixels at the pinch are not connected, the loop is split there into two
        loops.
        """
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
        """Return the index of the nearest vertical run to the left of a hole.

        All pixels between this run and the hole are solid. points (n, 2): the hole's corners.
        """
        k = int(points[:, 0].argmin())
        # Of the two runs at a corner in the hole's leftmost column, one is vertical.
        x, y = points[k].tolist()
        before, after = points[k - 1].tolist(), points[(k + 1) % len(points)].tolist()
        row = min(y, before[1] if before[0] == x else after[1])
        column = int(np.flatnonzero(self.cracks[row, :x])[-1])
        return self.horizontal + int(np.searchsorted(self.order, column * self.tall + row, side="right")) - 1


def _runs_of(cracks):
    """Return the runs of equal values other than 0 in cracks[line, position] as arrays (line, start, end, sign).

    cracks: -1 or 1 where there is a pixel edge between a solid and a clear pixel, otherwise 0; `sign` is this value.
    """
    before = np.zeros((cracks.shape[0], cracks.shape[1] + 1), np.int8)
    before[:, 1:] = cracks
    after = np.zeros_like(before)
    after[:, :-1] = cracks
    change = before != after
    line, start = np.nonzero(change & (after != 0))
    _, end = np.nonzero(change & (before != 0))
    return line, start, end, after[line, start].astype(np.int64)


# ---- outline ---------------------------------------------------------------------------------------------------------
# Smooth outline of pixels: staircases become straight lines; the rest of the outline is unchanged.
#
# A line may replace a staircase, a stretch of a crack loop with at most one horizontal and one vertical direction, if
# for each corner c of the stretch
#
#     |cross(d, c - start)| <= reach * (|dx| + |dy|)        with reach = min(smooth, just under 0.5)
#
# All guarantees follow from this inequality. Of the two runs that meet at c, the line is at most `reach` from the
# nearer one, and c is at most sqrt(2) * reach <= smooth + 0.21 from the line. A pixel's centre lies (0.5, 0.5) from a
# corner, so with reach below 0.5 every solid centre stays inside and every clear centre outside. Lines never cross if
# they separate the same centres as the cracks that they replace: outlines are simple, and pieces touch only in pinches.
#
# For a fixed start the inequality bounds the direction to an interval, so lines are found in one pass (as in O'Rourke
# 1981, "An on-line algorithm for fitting straight lines between data ranges"). The fewest lines are found by dynamic
# programming.

LARGEST_REACH = 0.5 - 2.0**-20  # [px] less than the distance from a crack to a pixel's centre


class Outline(NamedTuple):
    """Outline of one connected piece of pixels: simple polygons in raster pixels.

    The polygons touch each other only at single points, if at all.
    """

    outer: np.ndarray  # (n, 2) float64: corners, clockwise on the screen
    holes: list[np.ndarray]  # each (n, 2) float64: corners, counter-clockwise on the screen


def outline(solid: np.ndarray, smooth: float = 0.5) -> list[Outline]:
    """Return the outline of each connected piece of solid[row, col] bool, smoothed into straight lines.

    smooth [px] >= 0: each point of an outline is within `smooth` of the pixels' edges. Each point of these edges is
    within smooth + 0.21 of the outline. With smooth = 0 the outline is the pixels' edges. Centres of solid pixels are
    inside, centres of clear pixels outside. The corner between two straight rows of pixel edges, both of 3 px or more,
    is kept. All corners of a rectangle are also kept.

    Diagonal pixels belong to one piece if smooth >= 0.25 and the corner between them is not a kept one. Corners of the
    outline are at ends and middles of pixel edges. The number of corners is near the least possible. Pieces are ordered
    by their topmost, then leftmost corner. O(corners * corners per line).
    """
    return [smoothed_piece(piece, smooth) for piece in pieces_of(solid, smooth)]


def pieces_of(solid: np.ndarray, smooth: float) -> list[Contour]:
    """Return the connected pieces of solid[row, col] bool. With smooth >= 0.25, diagonal pixels may be connected.

    Diagonal pixels are then connected unless two straight rows of pixel edges of 3 px or more meet between them. smooth
    [px]: largest distance of the outline from the pixels' edges.
    """
    return contours(solid, SHARP if smooth >= JOINING else 0)


def smoothed_piece(piece: Contour, smooth: float) -> Outline:
    """Return the smoothed outline of one connected piece of pixels.

    smooth [px]: largest distance of the outline from the pixels' edges.
    """
    reach = min(smooth, LARGEST_REACH)
    return Outline(smoothed(piece.outer, reach), [smoothed(hole, reach) for hole in piece.holes])


def smoothed(loop: Loop, reach: float, curves: bool = True) -> np.ndarray:
    """Return the corners (n, 2) float64 [px] of the straight lines that replace a loop of pixel edges.

    reach [px]: largest distance of the lines from the pixel edges; with 0 the corners of the loop are returned. curves:
    True if the lines follow round curves of the drawing (see curves.py), False for as few lines as possible.
    """
    if reach <= 0.0:
        return loop.corners.astype(float)
    runs = np.roll(loop.corners, -1, axis=0) - loop.corners
    lengths = np.abs(runs).sum(axis=1)
    cracks = int(lengths.sum())
    lines = room_for_lines(cracks)
    of_loop = lines.runs[: len(runs)]
    of_loop["x"], of_loop["y"] = loop.corners.T
    of_loop["direction"] = np.where(runs[:, 1] == 0, np.where(runs[:, 0] > 0, 0, 2), np.where(runs[:, 1] > 0, 1, 3))
    of_loop["length"], of_loop["at"], of_loop["joined"] = lengths, np.cumsum(lengths) - lengths, loop.joined
    found = np.zeros(2 * cracks, POINT)
    far = math.inf
    path = Path(len(runs), cracks, True, reach, -far, far, -far, far, curves and reach >= JOINING)
    count = lines_of_loop(path, lines, found)
    found = np.roll(found[:count], -int(np.argmin(found["at"][:count] % cracks)))
    points = np.stack([found["x"], found["y"]], axis=1)
    before, after = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
    return points[before[:, 0] * after[:, 1] != before[:, 1] * after[:, 0]]


def sharp(loop: Loop) -> np.ndarray:
    """Return, for each corner of a loop, whether smoothing keeps the corner: (n,) bool.

    Smoothing keeps corners between two straight rows of pixel edges of 3 px or more, and corners of rectangles.
    Smoothing never keeps a corner at which diagonal pixels are connected.
    """
    runs = np.roll(loop.corners, -1, axis=0) - loop.corners
    lengths, signs = np.abs(runs).sum(axis=1), np.sign(runs)
    before = np.roll(signs, 1, axis=0)
    turns = before[:, 0] * signs[:, 1] - before[:, 1] * signs[:, 0]
    cap = turns == np.roll(turns, -1)  # a run whose ends turn to the same side does not belong to a staircase
    return ((np.minimum(lengths, np.roll(lengths, 1)) >= SHARP) | (cap & np.roll(cap, 1))) & ~loop.joined
