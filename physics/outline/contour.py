"""From pixels to outlines: crack contours, straight runs, and the smooth outline of a raster."""

import math
from typing import NamedTuple

import numpy as np

from physics.jit import kernel, subkernel

# ---- contour ---------------------------------------------------------------------------------------------------------
# Crack contours: the closed loops between solid and clear pixels of a raster (crack following).
#
# A crack is the side of length 1 between a solid and a clear pixel. A run is a straight row of cracks. Runs are found
# for the whole raster at once, linked at the corners where one ends and the next starts, and returned as loops. Source:
# Rosenfeld and Kak 1982, section 11.1, here without a scan per step.
#
# At a pinch two solid pixels touch only diagonally. Four runs meet there, and there are two ways to continue:
#
#     joined: the loop passes on both sides      apart: it stays with the pixel
#       # |                                        # |
#     ----+----   the two pixels are one piece   ----+----   each is a piece of its own
#         | #                                        | #


class Loop(NamedTuple):
    """Corners where a crack loop turns, in raster pixels, x first."""

    corners: np.ndarray  # (n, 2) int64
    joined: np.ndarray  # (n,) bool: the corner is a joined pinch


class Contour(NamedTuple):
    """One connected piece of solid pixels: its edge and the edges of its holes."""

    outer: Loop  # clockwise on the screen
    holes: list[Loop]  # counter-clockwise on the screen


def contours(solid: np.ndarray, joined: int = 0) -> list[Contour]:
    """Return the pieces of solid[row, col] bool, ordered by their topmost (then leftmost) corner.

    Corners are only where the direction changes. joined [px] 0: pinches are apart. Then pieces are 4-connected, no loop
    visits a corner twice, and loops touch at most in pinches. Otherwise a pinch is joined unless two of its runs, one
    of either direction, have at least this length. Then the pieces are 8-connected through it and a loop may pass it
    twice. Linear in pixels (vectorised) and corners.
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
    # The solid left of a hole is bounded on its left by the piece's outer loop, or by a hole further left.
    holes.sort(key=lambda each: each[1][:, 0].min())
    for loop, points in holes:
        piece = piece_of[runs.left_of(points)]
        piece_of[loop] = piece
        pieces[piece].holes.append(Loop(points, runs.joined[loop]))
    for piece in pieces:
        piece.holes.sort(key=lambda hole: _first(hole.corners))
    return pieces


def doubled_area(points: np.ndarray) -> float:
    """Return twice the signed area of a loop (n, 2): positive for a loop that is clockwise on the screen."""
    x, y = points[:, 0], points[:, 1]
    return (x * np.roll(y, -1) - y * np.roll(x, -1)).sum()


def _first(points):
    return min(zip(points[:, 1].tolist(), points[:, 0].tolist(), strict=True))


class _Runs:
    """All runs of a raster: the horizontal ones first, then the vertical; corner k is the start of run k."""

    def __init__(self, solid, joined):
        height, width = solid.shape
        padded = np.zeros((height + 2, width + 2), np.int8)
        padded[1:-1, 1:-1] = solid
        # +1: solid below, goes right. -1: solid above, goes left. One extra column, so that no run leaves its row.
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
        """Link each run to the run that follows. Each corner has one horizontal and one vertical run, a pinch two."""
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
        """Yield the rows of runs, loop by loop. A loop that visits an apart pinch twice is split there."""
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
        """Return the run on the other side of the solid pixels left of a hole."""
        k = int(points[:, 0].argmin())
        # At the hole's leftmost column one of the two runs at that corner is vertical.
        x, y = points[k].tolist()
        before, after = points[k - 1].tolist(), points[(k + 1) % len(points)].tolist()
        row = min(y, before[1] if before[0] == x else after[1])
        column = int(np.flatnonzero(self.cracks[row, :x])[-1])
        return self.horizontal + int(np.searchsorted(self.order, column * self.tall + row, side="right")) - 1


def _runs_of(cracks):
    """Return (line, start, end, sign) of each straight row of equal cracks (-1, 1) in cracks[line, place]."""
    before = np.zeros((cracks.shape[0], cracks.shape[1] + 1), np.int8)
    before[:, 1:] = cracks
    after = np.zeros_like(before)
    after[:, :-1] = cracks
    change = before != after
    line, start = np.nonzero(change & (after != 0))
    _, end = np.nonzero(change & (before != 0))
    return line, start, end, after[line, start].astype(np.int64)


# ---- cracks ----------------------------------------------------------------------------------------------------------
# Crack following from any place, forwards and backwards.
#
# A corner (x, y) of the pixel grid has four pixels around it, its quadrants, numbered clockwise on the screen from the
# lower right one. A crack leaves it to the right, down, left or up, in the same order. Paths have the solid on their
# right: for a crack that leaves in direction d, quadrant d is solid and quadrant d - 1 is clear.
#
#         2 | 3        3
#        ---+---     2 + 0
#         1 | 0        1
#      quadrants   directions
#
# Source: Rosenfeld and Kak 1982, section 11.1.

SHARP = 3  # [px] a corner between two runs of at least this length is fixed

RUN = np.dtype(
    [  # a straight row of cracks
        ("x", np.int64),  # its start
        ("y", np.int64),
        ("direction", np.int64),
        ("length", np.int64),  # [cracks]
        ("at", np.int64),  # number of cracks of the path before it
        ("joined", np.bool_),  # starts at a joined pinch, which the path passes twice
    ],
    align=True,
)


class Window(NamedTuple):
    """The pixels of a tile and of its surroundings."""

    pixels: np.ndarray  # [row, col] uint8, not 0: solid
    low: int  # first row and column of the tile, and …
    high: int  # … the end of them, exclusive
    reach: float  # [px] largest distance of lines from cracks
    joins: bool  # whether a path may pass between diagonal pixels


@subkernel
def right_of(direction):
    """Return the x component of a direction: -1, 0 or 1."""
    return (1 if direction == 0 else 0) - (1 if direction == 2 else 0)


@subkernel
def down_of(direction):
    """Return the y component of a direction: -1, 0 or 1."""
    return (1 if direction == 1 else 0) - (1 if direction == 3 else 0)


@subkernel
def is_solid(pixels, x, y, quadrant):
    """Return whether the pixel in a quadrant of a corner is solid."""
    q = quadrant & 3
    return pixels[y - (1 if q >= 2 else 0), x - (1 if q == 1 or q == 2 else 0)] != 0


@subkernel
def is_own(window, x, y, quadrant):
    """Return whether the pixel in a quadrant of a corner belongs to the tile."""
    q = quadrant & 3
    column = x - (1 if q == 1 or q == 2 else 0)
    row = y - (1 if q >= 2 else 0)
    return window.low <= column < window.high and window.low <= row < window.high


@subkernel
def length_from(pixels, x, y, direction):
    """Return the number of cracks in a straight row from a corner, up to SHARP; the first one must exist."""
    right = is_solid(pixels, x, y, direction)
    count = 1
    while count < SHARP:
        x += right_of(direction)
        y += down_of(direction)
        if is_solid(pixels, x, y, direction) != right or is_solid(pixels, x, y, direction + 3) == right:
            break
        count += 1
    return count


@subkernel
def is_joined(window, x, y):
    """Return whether paths pass between the two solid pixels of a pinch.

    They do not where a corner between long runs is fixed. They do not on a border of tiles either, where the two tiles
    would see different paths.
    """
    if not window.joins or x == window.low or x == window.high or y == window.low or y == window.high:
        return False
    level = max(length_from(window.pixels, x, y, 0), length_from(window.pixels, x, y, 2))
    upright = max(length_from(window.pixels, x, y, 1), length_from(window.pixels, x, y, 3))
    return min(level, upright) < SHARP


@subkernel
def onward(window, x, y, direction):
    """Return the direction in which a path leaves a corner at which it arrives in a direction."""
    if not is_solid(window.pixels, x, y, direction):
        if is_solid(window.pixels, x, y, direction + 3) and is_joined(window, x, y):
            return (direction + 3) & 3
        return (direction + 1) & 3
    return (direction + 3) & 3 if is_solid(window.pixels, x, y, direction + 3) else direction


@subkernel
def backward(window, x, y, direction):
    """Return the direction in which a path arrives at a corner that it leaves in a direction."""
    if not is_solid(window.pixels, x, y, direction + 1):
        if is_solid(window.pixels, x, y, direction + 2) and is_joined(window, x, y):
            return (direction + 1) & 3
        return (direction + 3) & 3
    return (direction + 1) & 3 if is_solid(window.pixels, x, y, direction + 2) else direction


@subkernel
def walked_back(window, x, y, direction, cracks):
    """Return (x, y, direction) of the path `cracks` cracks before the one that leaves a corner in a direction."""
    for _ in range(cracks):
        direction = backward(window, x, y, direction)
        x -= right_of(direction)
        y -= down_of(direction)
    return x, y, direction


@subkernel
def follow(window, x, y, direction, marks_inout):
    """Return the number of cracks of the path within the tile, from one on; of a loop the number of all.

    marks_inout: [row, col] uint8, set for each crack whose solid pixel lies below it.
    """
    first_x = x
    first_y = y
    first = direction
    count = 0
    while is_own(window, x, y, direction):
        if direction == 0:
            marks_inout[y, x] = 1
        count += 1
        x += right_of(direction)
        y += down_of(direction)
        direction = onward(window, x, y, direction)
        if x == first_x and y == first_y and direction == first:
            break
    return count


@subkernel
def record(window, x, y, direction, cracks, runs_out):
    """Write the runs (RUN) of the next `cracks` cracks of a path. Returns the number of runs."""
    count = -1
    turned = True
    joined = False
    for k in range(cracks):
        if turned:
            count += 1
            run = runs_out[count]
            run.x = x
            run.y = y
            run.direction = direction
            run.length = 0
            run.at = k
            run.joined = joined
        runs_out[count].length += 1
        x += right_of(direction)
        y += down_of(direction)
        after = onward(window, x, y, direction)
        turned = after != direction
        joined = not is_solid(window.pixels, x, y, direction) and after == (direction + 3) & 3
        direction = after
    return count + 1


# ---- straight lines --------------------------------------------------------------------------------------------------
# Least-cost straight lines along a path of cracks: the kernels of `outline`.

AREA_PRICE = 0.25  # [corners / px2] weight of the area that a line adds or removes, relative to a corner

PLACE = np.dtype(
    [  # a candidate for a corner of the outline along a path
        ("x", np.float64),
        ("y", np.float64),
        ("right", np.int64),  # direction of the path from it
        ("down", np.int64),
        ("corner", np.bool_),  # the path turns here
        ("allowed", np.bool_),  # a line may end here
        ("anchor", np.bool_),  # no line may pass it
        ("swept", np.float64),  # [px2] twice the area between the path so far and the origin
        ("cost", np.float64),
        ("previous", np.int64),
    ],
    align=True,
)


@subkernel
def try_lines(start, last, reach, places_inout):
    """Lower the costs of the places up to `last` that a line from `start` can reach (O'Rourke 1981)."""
    begin = places_inout[start]
    x = begin.x
    y = begin.y
    along_x = begin.right
    along_y = begin.down
    least = 0.0  # bounds of dy / (dx + dy), both along the path
    most = 1.0
    bent = False
    for at in range(start, last):
        place = places_inout[at]
        if at > start and place.corner:
            if place.anchor or place.right * along_x < 0 or place.down * along_y < 0:
                return
            along_x = place.right if along_x == 0 else along_x
            along_y = place.down if along_y == 0 else along_y
            rise = along_y * (place.y - y)
            size = along_x * (place.x - x) + rise
            if size > 0.0:
                least = max(least, (rise - reach) / size)
                most = min(most, (rise + reach) / size)
            if least > most:
                return
            bent = True
        to = places_inout[at + 1]
        if not to.allowed:
            continue
        rise = along_y * (to.y - y)
        size = along_x * (to.x - x) + rise
        if not bent or (size > 0.0 and least <= rise / size <= most):
            area = to.swept - begin.swept - (x * to.y - y * to.x)
            cost = begin.cost + 1.0 + AREA_PRICE * 0.5 * abs(area)
            if cost < to.cost:
                to.cost = cost
                to.previous = start


@subkernel
def cheapest(first, last, reach, places_inout, chain_out):
    """Write the places (rows of PLACE, last to first) where the least-cost lines from first to last end.

    reach [px]: as in outline. Returns their number; 0: no lines reach the last place. O(places * places of a line).
    """
    for k in range(first, last + 1):
        places_inout[k].cost = math.inf
    places_inout[first].cost = 0.0
    for start in range(first, last):
        if places_inout[start].cost < math.inf:
            try_lines(start, last, reach, places_inout)
    if places_inout[last].cost == math.inf:
        return 0
    count = 1
    chain_out[0] = last
    while chain_out[count - 1] != first:
        chain_out[count] = places_inout[chain_out[count - 1]].previous
        count += 1
    return count


@subkernel
def cheapest_loop(around, anchor, reach, places_inout, chain_out):
    """Write the same for a loop, whose places are listed twice, followed by the first one again.

    around: number of places of the loop; anchor: the first that no line may pass, -1: none. Returns (number, start of
    the loop).
    """
    begin = anchor
    if anchor < 0:
        # The best polygon may not pass through the first start, but then the result has at most one corner more. The
        # next start is a corner far from it.
        begin = 1
        for _ in range(2):
            found = cheapest(begin, begin + around, reach, places_inout, chain_out)
            begin = chain_out[found - 1 - (found - 1) // 2]
            begin -= around if begin >= around else 0
    return cheapest(begin, begin + around, reach, places_inout, chain_out), begin


@kernel
def lines_of_loop(around, anchor, reach, places_inout, chain_out):
    """Write cheapest_loop for places (PLACE) made outside a kernel. Returns the number of places."""
    count, _ = cheapest_loop(around, anchor, reach, places_inout, chain_out)
    return count


# ---- outline ---------------------------------------------------------------------------------------------------------
# Smooth outline of pixels: staircases become straight lines, all else is unchanged.
#
# A line may replace a stretch of a crack loop with at most one horizontal and one vertical direction, a staircase, if
# for each corner c within it
#
#     |cross(d, c - start)| <= reach * (|dx| + |dy|)        with reach = min(smooth, just under 0.5)
#
# This inequality is the whole contract. Between two legs that meet at c, the line is at most `reach` from the nearer
# leg, and c at most sqrt(2) * reach <= smooth + 0.21 from the line. A pixel's centre lies (0.5, 0.5) from a corner, so
# below 0.5 every solid centre stays inside and every clear one outside. Lines that separate the same centres as their
# cracks never cross each other: outlines are simple, and pieces touch only in pinches.
#
# For a fixed start the inequality bounds the direction to an interval, so lines are found in one pass (as in O'Rourke
# 1981, "An on-line algorithm for fitting straight lines between data ranges"). The fewest lines are found by dynamic
# programming.

LARGEST_REACH = 0.5 - 2.0**-20  # [px] less than the distance from a crack to a pixel's centre
JOINING = 0.25  # [px] from this smoothing on a line can pass a pinch, so that pieces are 8-connected


class Outline(NamedTuple):
    """One piece: simple polygons in raster pixels that touch at most in single points."""

    outer: np.ndarray  # (n, 2) float64: corners, clockwise on the screen
    holes: list[np.ndarray]  # each (n, 2) float64: corners, counter-clockwise on the screen


def outline(solid: np.ndarray, smooth: float = 0.5) -> list[Outline]:
    """Return the outlines of the pieces of solid[row, col] bool in straight lines, in the order of contours.

    smooth [px] >= 0: each point of an outline is within it of the pixels' edges, and each point of those within smooth
    + 0.21 of the outline; 0: the edges themselves. Solid pixels' centres are inside, clear ones' outside. A corner
    between straight runs of 3 px and more is kept, as are all corners of a rectangle. Pieces are 8-connected where the
    outline can pass between two diagonal pixels: not at such a corner, nor for smooth < 0.25. The number of corners is
    near the least possible on corners and middles of runs. O(corners * corners per line).
    """
    return [smoothed_piece(piece, smooth) for piece in pieces_of(solid, smooth)]


def pieces_of(solid: np.ndarray, smooth: float) -> list[Contour]:
    """Return the crack loops of outlines, with pinches joined where a line can pass."""
    return contours(solid, SHARP if smooth >= JOINING else 0)


def smoothed_piece(piece: Contour, smooth: float) -> Outline:
    """Return the outline of one piece."""
    reach = min(smooth, LARGEST_REACH)
    return Outline(smoothed(piece.outer, reach), [smoothed(hole, reach) for hole in piece.holes])


def smoothed(loop: Loop, reach: float) -> np.ndarray:
    """Return the corners (n, 2) float64 of a crack loop in straight lines; reach [px] as above."""
    if reach <= 0.0:
        return loop.corners.astype(float)
    places, anchor = _places(loop)
    chain = np.empty(len(places), np.int64)
    count = lines_of_loop(len(places) // 2, anchor, reach, places, chain)
    around = np.sort(chain[1:count] % (len(places) // 2))  # the first and the last are the same place
    points = np.stack([places["x"][around], places["y"][around]], axis=1)
    before, after = points - np.roll(points, 1, axis=0), np.roll(points, -1, axis=0) - points
    return points[before[:, 0] * after[:, 1] != before[:, 1] * after[:, 0]]


def sharp(loop: Loop) -> np.ndarray:
    """Return the fixed corners of a crack loop, (n,) bool: those between runs of 3 px and more, and of rectangles."""
    runs = np.roll(loop.corners, -1, axis=0) - loop.corners
    lengths, signs = np.abs(runs).sum(axis=1), np.sign(runs)
    before = np.roll(signs, 1, axis=0)
    turns = before[:, 0] * signs[:, 1] - before[:, 1] * signs[:, 0]
    cap = turns == np.roll(turns, -1)  # a run whose ends turn to the same side does not belong to a staircase
    return ((np.minimum(lengths, np.roll(lengths, 1)) >= SHARP) | (cap & np.roll(cap, 1))) & ~loop.joined


def _places(loop):
    """Return the candidate corners (PLACE) of an outline along a crack loop, and the index of the first fixed one or
    -1.

    Candidates are the loop's corners other than joined pinches, the middle of each run, and half a pixel from its ends.
    They are listed twice, followed by the first one again.
    """
    corners = loop.corners
    runs = np.roll(corners, -1, axis=0) - corners
    lengths = np.abs(runs).sum(axis=1)
    signs = np.sign(runs)
    steps = np.stack([0.0 * lengths, 0.0 * lengths + 0.5, lengths / 2.0, lengths - 0.5], axis=1)
    several = np.stack([lengths > 0, lengths > 1, lengths > 0, lengths > 1], axis=1)
    run = np.nonzero(several)[0]
    first = np.cumsum(several.sum(axis=1)) - several.sum(axis=1)
    places = np.zeros(len(run), PLACE)
    places["x"], places["y"] = (corners[run] + steps[several][:, None] * signs[run]).T
    places["right"], places["down"] = signs[run].T
    places["corner"][first] = True
    places["allowed"] = True
    places["allowed"][first[loop.joined]] = False
    stay = first[sharp(loop)]
    places["anchor"][stay] = True
    places = np.concatenate([places, places, places[:1]])
    x, y = places["x"], places["y"]
    places["swept"][1:] = np.cumsum(x[:-1] * y[1:] - y[:-1] * x[1:])
    return places, int(stay[0]) if len(stay) else -1
