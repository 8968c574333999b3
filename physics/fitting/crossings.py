"""Where an outline crosses the border of two tiles: one point, found in the same way from both sides.

Only cracks within SEEN of where the path of cracks changes from one tile's pixels to another's are looked at: the line
along the longest stretch of them that is straight crosses the border there, on the run of a path that turns at it, or a
little beside a path that goes straight on. A corner between long runs is crossed in itself.
"""

import math

from physics.fitting.cracks import SHARP, down_of, right_of
from physics.jit import subkernel

SEEN = 12  # [px] of the path on either side. More: a wider halo; fewer: gentle slopes are less straight at borders
STRAIGHT = 0.6  # [px] from a line that the middles of a straight path's cracks lie at most: of slight slopes 0.5
KNOWN = SEEN - SHARP - 1  # [px] a run of at most this length is seen whole, with its neighbours
BESIDE = 0.25  # [px] crossings are off a run's ends
GRAINS = 1024.0  # [1/px]
GRAIN = 1.0 / GRAINS  # [px] crossings are multiples of it: sums with whole pixels are exact in every tile


@subkernel
def whole_grains(length):
    """The length, not longer, in whole grains [px]."""
    return math.floor(length * GRAINS) * GRAIN


@subkernel
def to_border(window, x, y, direction):
    """Distance [px] from a corner on the tile's border to its next border line ahead, or more than KNOWN."""
    at = y if direction & 1 else x
    ahead = window.high - at if direction < 2 else at - window.low
    return ahead if ahead > 0 else KNOWN + 1


@subkernel
def stretch(runs, count, at, seen, x, y):
    """The line through the middles of the cracks within a way of the corner (x, y) after so many cracks of a path.

    Least squares. Returns (x, y [px] of a point of it, off the corner; its slope; whether that is dx / dy, not
    dy / dx; whether all middles lie near it).
    """
    n = 0
    sum_x = sum_y = sum_xx = sum_yy = sum_xy = 0.0
    right = down = 0
    for k in range(count):
        run = runs[k]
        first = max(run.at, at - seen) - run.at
        end = min(run.at + run.length, at + seen) - run.at
        if first >= end:
            continue
        if right * right_of(run.direction) < 0 or down * down_of(run.direction) < 0:
            return 0.0, 0.0, 0.0, False, False
        right += right_of(run.direction)
        down += down_of(run.direction)
        for step in range(first, end):
            off_x = run.x - x + (step + 0.5) * right_of(run.direction)
            off_y = run.y - y + (step + 0.5) * down_of(run.direction)
            n += 1
            sum_x += off_x
            sum_y += off_y
            sum_xx += off_x * off_x
            sum_yy += off_y * off_y
            sum_xy += off_x * off_y
    if n < 2:
        return 0.0, 0.0, 0.0, False, False
    x_x = sum_xx - sum_x * sum_x / n
    y_y = sum_yy - sum_y * sum_y / n
    steep = y_y > x_x
    spread = max(x_x, y_y)
    slope = (sum_xy - sum_x * sum_y / n) / spread if spread > 0.0 else 0.0
    room = STRAIGHT * math.sqrt(1.0 + slope * slope)
    for k in range(count):
        run = runs[k]
        first = max(run.at, at - seen) - run.at
        end = min(run.at + run.length, at + seen) - run.at
        for step in (first, end - 1):
            off_x = run.x - x + (step + 0.5) * right_of(run.direction) - sum_x / n
            off_y = run.y - y + (step + 0.5) * down_of(run.direction) - sum_y / n
            off = off_x - slope * off_y if steep else off_y - slope * off_x
            if first < end and abs(off) > room:
                return 0.0, 0.0, 0.0, False, False
    return sum_x / n, sum_y / n, slope, steep, True


@subkernel
def line_at(runs, count, at, x, y):
    """The line along the longest stretch of a path that is straight about a corner; as stretch."""
    for seen in range(SEEN, 1, -1):
        line_x, line_y, slope, steep, straight = stretch(runs, count, at, seen, x, y)
        if straight:
            return line_x, line_y, slope, steep
    line_x, line_y, slope, steep, _ = stretch(runs, count, at, 1, x, y)
    return line_x, line_y, slope, steep


@subkernel
def meets(runs, count, at, x, y, level):
    """How far [px] from a corner of a path the line along it meets the row (level) or column of the corner."""
    line_x, line_y, slope, steep = line_at(runs, count, at, x, y)
    if level == steep:
        return line_x - slope * line_y if level else line_y - slope * line_x
    if slope == 0.0:
        return 0.0
    return line_x - line_y / slope if level else line_y - line_x / slope


@subkernel
def room_in(window, runs, count, k, x, y, after):
    """How far [px] a crossing moves from a corner (x, y) into run k, which starts there (after) or ends there."""
    run = runs[k]
    direction = run.direction if after else (run.direction + 2) & 3
    ahead = to_border(window, x, y, direction)
    length = 0.5 * min(run.length, KNOWN)  # its other end may be a crossing, too
    if ahead < run.length:
        length = min(ahead, KNOWN)
    elif run.length <= KNOWN:
        length = run.length
        # A run whose ends turn to the same side is no part of a staircase.
        other = k + 1 if after else k
        if other == 0 or other >= count or runs[other].direction != (runs[other - 1].direction + 1) & 3:
            return 0.0
    level = direction & 1 == 0
    room = meets(runs, count, run.at if after else run.at + run.length, x, y, level)
    room = min(max(room * (right_of(direction) if level else down_of(direction)), BESIDE), length - BESIDE)
    # Not so far from the corner that a line past it finds no place to end half a pixel behind it.
    if room * (0.5 - window.reach) > 0.5 * window.reach:
        room = 0.5 * window.reach / max(0.5 - window.reach, GRAIN * GRAIN)
    return whole_grains(room)


@subkernel
def aside(window, runs, count, k, distance):
    """How far [px] beside run k, a distance after its start, the line along the path passes.

    Positive in the direction in which the path came to the run.
    """
    run = runs[k]
    if k == 0 or k == count - 1 or distance > KNOWN or run.length - distance > KNOWN:
        return 0.0
    side = -1 if 2 * distance < run.length else 1
    step = runs[k + side]
    if runs[k - 1].direction != runs[k + 1].direction or min(step.length, run.length) >= SHARP:
        return 0.0
    x = run.x + right_of(run.direction) * distance
    y = run.y + down_of(run.direction) * distance
    level = run.direction & 1 == 1
    way = runs[k - 1].direction
    off = meets(runs, count, run.at + distance, x, y, level) * (right_of(way) if level else down_of(way))
    return whole_grains(min(off, window.reach)) if off > 0.0 else -whole_grains(min(-off, window.reach))


@subkernel
def crossing(window, runs, count, at, after):
    """Where the outline crosses the border at the corner after so many cracks of a path.

    runs: RUN of the path, SEEN cracks on either side; after: at a corner of the tile, on the run that follows, not
    the one before. Returns (cracks along the path, x, y [px] off the path there).
    """
    k = 0
    while k + 1 < count and runs[k + 1].at <= at:
        k += 1
    run = runs[k]
    distance = at - run.at
    x = run.x + right_of(run.direction) * distance
    y = run.y + down_of(run.direction) * distance
    at_side = x == window.low or x == window.high
    at_end = y == window.low or y == window.high
    if distance > 0:
        if at_side and at_end:
            return float(at), 0.0, 0.0
        off = aside(window, runs, count, k, distance)
        way = runs[k - 1].direction if k > 0 else 0
        return float(at), off * right_of(way), off * down_of(way)
    if k == 0 or min(runs[k - 1].length, run.length) >= SHARP:
        return float(at), 0.0, 0.0
    if not (at_side and at_end):
        after = at_side == (run.direction & 1 == 1)
    room = room_in(window, runs, count, k if after else k - 1, x, y, after)
    if at_side and at_end:
        # A line leads from one border to the other there: past the corner, and along neither of them.
        other = room_in(window, runs, count, k - 1 if after else k, x, y, not after)
        if other == 0.0:
            return float(at), 0.0, 0.0
        if room * other > window.reach * (room + other):
            room = min(room, whole_grains(1.9 * window.reach))
    return at + room if after else at - room, 0.0, 0.0
