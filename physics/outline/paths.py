"""Paths along the edges between solid and clear pixels, and the best straight lines along a path."""

import math
from typing import NamedTuple

import numpy as np

from physics.jit import subkernel

# ---- cracks ----------------------------------------------------------------------------------------------------------
# Crack following from any corner, forwards and backwards. A crack is the pixel edge between a solid and a clear pixel.
#
# A corner (x, y) of the pixel grid has four pixels around it, its quadrants, numbered clockwise on the screen from the
# lower right one. Directions are numbered in the same order: right, down, left, up. Paths have solid pixels on their
# right: if a crack leaves a corner in direction d, quadrant d is solid and quadrant d - 1 is clear.
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
        ("x", np.int64),  # (x, y): start of the run
        ("y", np.int64),
        ("direction", np.int64),
        ("length", np.int64),  # [cracks]
        ("at", np.int64),  # number of cracks of the path before this run
        ("joined", np.bool_),  # at its start the path passes from a pixel to a diagonal one
    ],
    align=True,
)


class Window(NamedTuple):
    """The pixels of a tile with a margin around it, and the settings of the outline."""

    pixels: np.ndarray  # [row, col] uint8; not 0: solid
    low: int  # first row and column of the tile, and …
    high: int  # … end of its rows and columns, exclusive
    reach: float  # [px] largest distance of outline lines from cracks
    joins: bool  # whether a path may pass from a solid pixel to a diagonal one, which joins them


@subkernel
def right_of(direction):
    """Return the x component of a direction (0 right, 1 down, 2 left, 3 up): -1, 0 or 1."""
    return (1 if direction == 0 else 0) - (1 if direction == 2 else 0)


@subkernel
def down_of(direction):
    """Return the y component of a direction (0 right, 1 down, 2 left, 3 up): -1, 0 or 1."""
    return (1 if direction == 1 else 0) - (1 if direction == 3 else 0)


@subkernel
def is_solid(pixels, x, y, quadrant):
    """Return whether one of the four pixels at corner (x, y) of the pixel grid is solid.

    quadrant: the pixel: 0 lower right, 1 lower left, 2 upper left, 3 upper right (modulo 4).
    """
    q = quadrant & 3
    return pixels[y - (1 if q >= 2 else 0), x - (1 if q == 1 or q == 2 else 0)] != 0


@subkernel
def is_own(window, x, y, quadrant):
    """Return whether one of the four pixels at corner (x, y) of the pixel grid belongs to the tile.

    quadrant: the pixel: 0 lower right, 1 lower left, 2 upper left, 3 upper right (modulo 4). window: pixels of the tile
    and settings.
    """
    q = quadrant & 3
    column = x - (1 if q == 1 or q == 2 else 0)
    row = y - (1 if q >= 2 else 0)
    return window.low <= column < window.high and window.low <= row < window.high


@subkernel
def length_from(pixels, x, y, direction):
    """Return the length [px] of the straight row of pixel edges that starts at corner (x, y), at most SHARP.

    direction: direction of the row (0 right, 1 down, 2 left, 3 up), which must have at least one edge.
    """
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
    """Return whether paths connect the two diagonal solid pixels at corner (x, y).

    The result is False where two long runs (straight rows of pixel edges) meet, because such a corner is fixed. The
    result is also False on the border of the tile, because the neighbouring tile might find another path. window:
    pixels of the tile and settings.
    """
    if not window.joins or x == window.low or x == window.high or y == window.low or y == window.high:
        return False
    level = max(length_from(window.pixels, x, y, 0), length_from(window.pixels, x, y, 2))
    upright = max(length_from(window.pixels, x, y, 1), length_from(window.pixels, x, y, 3))
    return min(level, upright) < SHARP


@subkernel
def onward(window, x, y, direction):
    """Return the direction in which a path leaves corner (x, y), after arriving there in `direction`.

    Directions are 0 right, 1 down, 2 left, 3 up.
    """
    if not is_solid(window.pixels, x, y, direction):
        if is_solid(window.pixels, x, y, direction + 3) and is_joined(window, x, y):
            return (direction + 3) & 3
        return (direction + 1) & 3
    return (direction + 3) & 3 if is_solid(window.pixels, x, y, direction + 3) else direction


@subkernel
def backward(window, x, y, direction):
    """Return the direction in which a path arrives at corner (x, y), which it leaves in `direction`.

    Directions are 0 right, 1 down, 2 left, 3 up.
    """
    if not is_solid(window.pixels, x, y, direction + 1):
        if is_solid(window.pixels, x, y, direction + 2) and is_joined(window, x, y):
            return (direction + 1) & 3
        return (direction + 3) & 3
    return (direction + 1) & 3 if is_solid(window.pixels, x, y, direction + 2) else direction


@subkernel
def walked_back(window, x, y, direction, cracks):
    """Return (x, y, direction) of a path at the corner that is `cracks` pixel edges before corner (x, y).

    direction: the direction in which the path leaves corner (x, y); the returned direction is the one in which it
    leaves the returned corner. window: pixels of the tile and settings.
    """
    for _ in range(cracks):
        direction = backward(window, x, y, direction)
        x -= right_of(direction)
        y -= down_of(direction)
    return x, y, direction


@subkernel
def follow(window, x, y, direction, marks_inout):
    """Return the number of pixel edges for which a path stays in the tile, starting at corner (x, y).

    For a loop inside the tile this is the loop's length. direction: the direction in which the path leaves the corner;
    marks_inout [row, col] uint8: set to 1 for each solid pixel whose upper edge is on the path; window: pixels of the
    tile and settings.
    """
    first_x, first_y = x, y
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
    """Write the runs (RUN rows) of a path of `cracks` pixel edges that starts at corner (x, y). Return their number.

    A run is a straight row of pixel edges. direction: the direction in which the path leaves the corner; window: pixels
    of the tile and settings.
    """
    count = -1
    turned = True
    joined = False
    for k in range(cracks):
        if turned:
            count += 1
            run = runs_out[count]
            run.x, run.y = x, y
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
# Least-cost straight lines along a path of cracks: the kernels of contour.outline.

AREA_PRICE = 0.25  # [corners / px2] cost of the area that a line adds to or removes from the pixels; a corner costs 1

PLACE = np.dtype(
    [  # a candidate for a corner of the outline along a path
        ("x", np.float64),
        ("y", np.float64),
        ("at", np.float64),  # [cracks] along the path
        ("right", np.int64),  # direction (right, down) of the path from here on
        ("down", np.int64),
        ("corner", np.bool_),  # the path turns here
        ("allowed", np.bool_),  # a line may end here
        ("anchor", np.bool_),  # a fixed corner: no line may pass it
        ("swept", np.float64),  # [px2] twice the area between the origin and the path up to here
        ("along_x", np.float64),  # direction of the curve here, a unit vector; 0, 0 outside of curves
        ("along_y", np.float64),
        ("cost", np.float64),  # [corners] least cost of lines from the start to here
        ("previous", np.int64),  # row of the place where the last line of that least cost starts
    ],
    align=True,
)


class Prices(NamedTuple):
    """Weights of a line's errors in the line search, relative to the cost of one corner.

    The search replaces an outline of pixels by few straight lines. Each line costs 1 for its corner, plus its errors
    times these weights.
    """

    area: float  # [1/px2] cost of the area that the line adds or removes
    angle: float  # [1/(rad2 px)] cost of the line's squared angles to the curve at both ends, times the line's length


LINE_PRICES = Prices(AREA_PRICE, 0.0)


@subkernel
def stays(runs, count, k, closed):
    """Return whether smoothing keeps the corner at the start of run k (a straight row of pixel edges).

    Smoothing keeps a corner between two long runs, and a corner of a rectangle. runs: RUN rows, of which the first
    `count` are the path; closed: whether the path is closed.
    """
    if not closed and k == 0:
        return False
    run = runs[k]
    before = runs[k - 1 if k > 0 else count - 1]
    if run.joined:
        return False
    if min(before.length, run.length) >= SHARP:
        return True
    if not closed and (k < 2 or k > count - 2):
        return False
    turn = (run.direction - before.direction) & 3
    earlier = runs[(k - 2 + count) % count]
    later = runs[(k + 1) % count]
    return (before.direction - earlier.direction) & 3 == turn and (later.direction - run.direction) & 3 == turn


@subkernel
def put_place(n, x, y, at, run, corner, allowed, places_inout):
    """Write row n of the PLACE rows places_inout: a candidate (x, y) for a corner of the outline.

    run: RUN row that contains the candidate; at: position along the path, in pixel edges; corner: whether the path
    turns there; allowed: whether a line may end there.
    """
    place = places_inout[n]
    place.x, place.y = x, y
    place.at = at
    place.right = right_of(run.direction)
    place.down = down_of(run.direction)
    place.corner = corner
    place.allowed = allowed
    place.anchor = False
    place.along_x, place.along_y, place.swept = 0.0, 0.0, 0.0
    if n > 0:
        last = places_inout[n - 1]
        place.swept = last.swept + last.x * y - last.y * x


@subkernel
def put_run(n, run, start, end, offset, places_inout):
    """Append up to three candidate corners (PLACE rows) inside a run. Return the new number of PLACE rows.

    A run is a straight row of pixel edges. n: number of PLACE rows before; run: RUN row; start, end: positions along
    the path, in pixel edges; only candidates between them are added; offset: number added to the positions of the
    candidates, for the second turn around a loop.
    """
    for step in range(3):
        if step != 1 and run.length == 1:
            continue
        along = 0.5 if step == 0 else (run.length / 2.0 if step == 1 else run.length - 0.5)
        if start < run.at + along < end:
            x, y = run.x + along * right_of(run.direction), run.y + along * down_of(run.direction)
            put_place(n, x, y, run.at + along + offset, run, False, True, places_inout)
            n += 1
    return n


@subkernel
def put_loop(runs, count, cracks, places_out):
    """Write the candidate corners (PLACE rows) of two turns around a loop, followed by the first candidate once more.

    Return (number of rows of one turn, row of the first fixed corner or -1). No line may pass a fixed corner. runs: RUN
    rows, of which the first `count` are the loop; cracks: number of pixel edges of the loop.
    """
    n = 0
    around = 0
    anchor = -1
    for turn in range(2):
        for k in range(count):
            run = runs[k]
            put_place(
                n, float(run.x), float(run.y), float(run.at + turn * cracks), run, True, not run.joined, places_out
            )
            places_out[n].anchor = stays(runs, count, k, True)
            if anchor < 0 and places_out[n].anchor:
                anchor = n
            n = put_run(n + 1, run, -1.0, cracks + 1.0, float(turn * cracks), places_out)
        if turn == 0:
            around = n
    run = runs[0]
    put_place(n, float(run.x), float(run.y), float(2 * cracks), run, True, not run.joined, places_out)
    places_out[n].anchor = stays(runs, count, 0, True)
    return around, anchor


@subkernel
def faults_of_angles(begin, to):
    """Return the cost of a line's angles to a curve: (sin² at its start + sin² at its end) · the line's length [px].

    begin, to: PLACE rows of the line's ends, which hold the direction of the curve there. At an end where the line is
    directed against the curve, sin² is replaced by 1.
    """
    x, y = to.x - begin.x, to.y - begin.y
    squared = x * x + y * y
    if squared == 0.0:
        return 0.0
    first = x * begin.along_y - y * begin.along_x
    last = x * to.along_y - y * to.along_x
    found = first * first / squared if x * begin.along_x + y * begin.along_y > 0.0 else 1.0
    found += last * last / squared if x * to.along_x + y * to.along_y > 0.0 else 1.0
    return found * math.sqrt(squared)


@subkernel
def try_lines(start, last, reach, prices, places_inout):
    """Lower the cost of each PLACE row that a line from row `start` reaches at a lower cost (O'Rourke 1981).

    The rows after `start`, up to row `last`, are tried as ends of the line. reach [px]: largest distance of a line from
    the pixel edges; prices: weights of a line's errors; places_inout: PLACE rows.
    """
    begin = places_inout[start]
    x, y = begin.x, begin.y
    along_x, along_y = begin.right, begin.down
    least = 0.0  # bounds of dy / (dx + dy), with dx and dy along the path
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
        if not to.allowed or begin.cost + 1.0 >= to.cost:
            continue
        rise = along_y * (to.y - y)
        size = along_x * (to.x - x) + rise
        if not bent or (size > 0.0 and least <= rise / size <= most):
            cost = begin.cost + 1.0
            if prices.area > 0.0:
                cost += prices.area * 0.5 * abs(to.swept - begin.swept - (x * to.y - y * to.x))
            if prices.angle > 0.0:
                cost += prices.angle * faults_of_angles(begin, to)
            if cost < to.cost:
                to.cost = cost
                to.previous = start


@subkernel
def cheapest(first, last, reach, prices, places_inout, chain_out):
    """Find the lines of least total cost from PLACE row `first` to row `last`. Return the number of their ends.

    The number is 0 if no lines reach row `last`. chain_out: rows of the lines' ends, from `last` to `first`; reach
    [px]: largest distance of a line from the pixel edges; prices: weights of a line's errors; places_inout: PLACE rows.
    O(rows * rows of a line).
    """
    for k in range(first, last + 1):
        places_inout[k].cost = math.inf
    places_inout[first].cost = 0.0
    for start in range(first, last):
        if places_inout[start].cost < math.inf:
            try_lines(start, last, reach, prices, places_inout)
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
    """Find the lines of least total cost around a loop. Return the number of line ends.

    The first line end is counted twice, because it is also the last. around: number of PLACE rows of one turn; anchor:
    row of a fixed corner, which no line may pass, or -1; reach [px]: largest distance of a line from the pixel edges;
    places_inout: PLACE rows written by put_loop; chain_out: rows of the line ends, from last to first.
    """
    begin = anchor
    if anchor < 0:
        # The best polygon may have no corner at the tried start; then the result has at most one corner more than the
        # best. So the next start is a corner of the result, far from the start before.
        begin = 1
        for _ in range(2):
            found = cheapest(begin, begin + around, reach, LINE_PRICES, places_inout, chain_out)
            begin = chain_out[found - 1 - (found - 1) // 2]
            begin -= around if begin >= around else 0
    return cheapest(begin, begin + around, reach, LINE_PRICES, places_inout, chain_out)
