"""Outline of a large raster, computed tile by tile: points on tile borders, lines between them, and convex parts."""

import math
from functools import cache
from typing import NamedTuple

import numpy as np

from physics.jit import kernel, subkernel
from physics.outline.contour import LARGEST_REACH
from physics.outline.curves import GRAIN, GRAINS, JOINING, POINT, Lines, Path, lay_lines, room_for_lines
from physics.outline.kept import Parts, fitted
from physics.outline.paths import (
    LINE_PRICES,
    SHARP,
    Window,
    backward,
    cheapest,
    cheapest_loop,
    down_of,
    follow,
    is_own,
    is_solid,
    put_loop,
    put_place,
    put_run,
    record,
    right_of,
    stays,
    walked_back,
)
from physics.outline.rings import SIDE, close_ring, put_side, write_parts
from physics.settings import MAX_CORNERS

# ---- crossings -------------------------------------------------------------------------------------------------------
# A crossing is the point where the outline crosses the border of two tiles. Both tiles compute the same point.
#
# A crossing depends only on cracks within SEEN of the corner where the path of cracks changes from one tile's pixels to
# another tile's pixels. A line is fitted to the longest straight stretch of these cracks. If the path turns at the
# border, the crossing is on a run of the path. If the path goes straight on, the crossing may be a little off the path.
# A corner between long runs is itself the crossing.

SEEN = 12  # [cracks] used on either side of the corner. More: a wider halo; fewer: bends in gentle slopes
STRAIGHT = 0.6  # [px] a path is straight if the middles of its cracks are this near to a line: 0.5 for slight slopes
U_2 = SEEN * (4.0 * SEEN * SEEN - 1.0) / 6.0  # sums of the squares and …
U_4 = U_2 * (12.0 * SEEN * SEEN - 7.0) / 20.0  # … fourth powers of 0.5 - SEEN to SEEN - 0.5
SPREAD = 2.0 * SEEN * U_4 - U_2 * U_2
KNOWN = SEEN - SHARP - 1  # [px] longest run that is fully within SEEN, with its neighbours
BESIDE = 0.25  # [px] least distance of a crossing from a run's ends


@subkernel
def whole_grains(length):
    """Return a length [px] rounded down to a multiple of GRAIN, the spacing of the grid of outline points."""
    return math.floor(length * GRAINS) * GRAIN


@subkernel
def to_border(window, x, y, direction):
    """Return the distance [px] from a corner (x, y) on the tile's border to the next border line in a direction.

    direction: 0 right, 1 down, 2 left, 3 up. The result is KNOWN + 1 if there is no border line in this direction.
    window: pixels of the tile and settings, a paths.Window.
    """
    at = y if direction & 1 else x
    ahead = window.high - at if direction < 2 else at - window.low
    return ahead if ahead > 0 else KNOWN + 1


@subkernel
def stretch(runs, count, at, seen, x, y):
    """Fit a line (least squares) to the middles of a path's pixel edges near a corner (x, y).

    Return (x, y, slope, steep, straight). x, y [px]: a point on the line, relative to the corner; steep: whether the
    slope is dx / dy instead of dy / dx; straight: whether all middles are near the line. Only the `seen` edges before
    and the `seen` edges after the corner are used. runs: RUN rows, of which the first `count` are the path; at: number
    of edges of the path before the corner.
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
    x_x, y_y = sum_xx - sum_x * sum_x / n, sum_yy - sum_y * sum_y / n
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
def is_straight(runs, count, at):
    """Return whether a straight line separates the solid from the clear pixels along a path near a corner.

    Such a line exists if the directions from centres of solid pixels to centres of clear pixels span less than half a
    turn. Only pixels at the ends of runs are tested, which is sufficient. Edges within SEEN of the corner are used.
    runs: RUN rows, of which the first `count` are the path; at: number of pixel edges of the path before the corner.
    """
    first_x = first_y = last_x = last_y = 0.0
    for k in range(count):
        run = runs[k]
        right, down = right_of(run.direction), down_of(run.direction)
        begin, end = max(run.at, at - SEEN) - run.at, min(run.at + run.length, at + SEEN) - run.at
        for step in range(begin, end, max(end - begin - 1, 1)):
            solid_x = run.x + (step + 0.5) * right - 0.5 * down
            solid_y = run.y + (step + 0.5) * down + 0.5 * right
            for m in range(count):
                other = runs[m]
                over, under = right_of(other.direction), down_of(other.direction)
                begin, end = max(other.at, at - SEEN) - other.at, min(other.at + other.length, at + SEEN) - other.at
                for there in range(begin, end, max(end - begin - 1, 1)):
                    x = other.x + (there + 0.5) * over + 0.5 * under - solid_x
                    y = other.y + (there + 0.5) * under - 0.5 * over - solid_y
                    if first_x == 0.0 and first_y == 0.0:
                        first_x = last_x = x
                        first_y = last_y = y
                    before = first_x * y - first_y * x < 0.0
                    after = last_x * y - last_y * x > 0.0
                    if before and after:
                        return False
                    if before:
                        first_x, first_y = x, y
                    elif after:
                        last_x, last_y = x, y
                    if first_x * last_y - first_y * last_x < 0.0:
                        return False
    return True


@subkernel
def bend(runs, count, at, x, y):
    """Fit a parabola (least squares) to the middles of a path's pixel edges within SEEN edges of a corner (x, y).

    Return the parabola's tangent at the corner as (x, y, slope, steep, near), see `stretch`; near: whether all middles
    are near the parabola. runs: RUN rows, of which the first `count` are the path; at: number of edges of the path
    before the corner.
    """
    sum_x = sum_y = u_x = u_y = uu_x = uu_y = 0.0
    for part in range(2):
        base_x, base_y = (U_4 * sum_x - U_2 * uu_x) / SPREAD, (U_4 * sum_y - U_2 * uu_y) / SPREAD
        bend_x = (2.0 * SEEN * uu_x - U_2 * sum_x) / SPREAD
        bend_y = (2.0 * SEEN * uu_y - U_2 * sum_y) / SPREAD
        for k in range(count):
            run = runs[k]
            for step in range(max(run.at, at - SEEN) - run.at, min(run.at + run.length, at + SEEN) - run.at):
                u = run.at + step + 0.5 - at
                off_x = run.x - x + (step + 0.5) * right_of(run.direction)
                off_y = run.y - y + (step + 0.5) * down_of(run.direction)
                if part == 0:
                    sum_x += off_x
                    sum_y += off_y
                    u_x += u * off_x
                    u_y += u * off_y
                    uu_x += u * u * off_x
                    uu_y += u * u * off_y
                    continue
                along_x, along_y = u_x / U_2 + 2.0 * u * bend_x, u_y / U_2 + 2.0 * u * bend_y
                off_x -= base_x + u * (u_x / U_2 + u * bend_x)
                off_y -= base_y + u * (u_y / U_2 + u * bend_y)
                off = along_x * off_y - along_y * off_x
                if off * off > STRAIGHT * STRAIGHT * (along_x * along_x + along_y * along_y):
                    return 0.0, 0.0, 0.0, False, False
    steep = abs(u_y) > abs(u_x)
    most = u_y if steep else u_x
    if most == 0.0:
        return 0.0, 0.0, 0.0, False, False
    return base_x, base_y, (u_x if steep else u_y) / most, steep, True


@subkernel
def line_at(runs, count, at, x, y):
    """Return the line (x, y, slope, steep) that approximates a path at a corner (x, y), in the format of `stretch`.

    The line is fitted to the longest straight part of the path around the corner, or is the tangent of a parabola.
    runs: RUN rows, of which the first `count` are the path; at: number of pixel edges of the path before the corner.
    """
    for seen in range(SEEN, 1, -1):
        line_x, line_y, slope, steep, straight = stretch(runs, count, at, seen, x, y)
        if seen == SEEN and not (straight and is_straight(runs, count, at)):
            bent_x, bent_y, bent_slope, bent_steep, curved = bend(runs, count, at, x, y)
            if curved:
                return bent_x, bent_y, bent_slope, bent_steep
        if straight:
            return line_x, line_y, slope, steep
    line_x, line_y, slope, steep, _ = stretch(runs, count, at, 1, x, y)
    return line_x, line_y, slope, steep


@subkernel
def meets(runs, count, at, x, y, level):
    """Return the signed distance [px] from a corner to the point where the path meets the corner's row or column.

    The path is approximated by the line that line_at returns. runs: RUN rows, of which the first `count` are the path;
    at: number of pixel edges of the path before the corner; x, y: the corner; level: True for the row, False for the
    column.
    """
    line_x, line_y, slope, steep = line_at(runs, count, at, x, y)
    if level == steep:
        return line_x - slope * line_y if level else line_y - slope * line_x
    if slope == 0.0:
        return 0.0
    return line_x - line_y / slope if level else line_y - line_x / slope


@subkernel
def room_in(window, runs, count, k, x, y, after):
    """Return the distance [px] by which the outline's crossing of the tile border is moved from a corner along a run.

    x, y: the corner of the path; k: index of the run (a straight row of pixel edges); after: True if run k starts at
    the corner, False if it ends there; runs: RUN rows, of which the first `count` are the path; window: pixels of the
    tile and settings, a paths.Window.
    """
    run = runs[k]
    direction = run.direction if after else (run.direction + 2) & 3
    ahead = to_border(window, x, y, direction)
    length = 0.5 * min(run.length, KNOWN)  # the run's other end may also be a crossing
    if ahead < run.length:
        length = min(ahead, KNOWN)
    elif run.length <= KNOWN:
        length = run.length
        # A run whose ends turn to the same side does not belong to a staircase.
        other = k + 1 if after else k
        if other == 0 or other >= count or runs[other].direction != (runs[other - 1].direction + 1) & 3:
            return 0.0
    level = direction & 1 == 0
    room = meets(runs, count, run.at if after else run.at + run.length, x, y, level)
    room = min(max(room * (right_of(direction) if level else down_of(direction)), BESIDE), length - BESIDE)
    # Limit: a line past the corner needs a place to end half a pixel behind the corner.
    if room * (0.5 - window.reach) > 0.5 * window.reach:
        room = 0.5 * window.reach / max(0.5 - window.reach, GRAIN * GRAIN)
    return whole_grains(room)


@subkernel
def aside(window, runs, count, k, distance):
    """Return the distance [px] from a point of run k to the line that approximates the path, perpendicular to the run.

    A run is a straight row of pixel edges. The result is positive in the direction of run k - 1, and its absolute value
    is at most window.reach. runs: RUN rows, of which the first `count` are the path; distance: position of the point
    from the start of the run, in pixel edges.
    """
    run = runs[k]
    if k == 0 or k == count - 1 or distance > KNOWN or run.length - distance > KNOWN:
        return 0.0
    side = -1 if 2 * distance < run.length else 1
    step = runs[k + side]
    if runs[k - 1].direction != runs[k + 1].direction or min(step.length, run.length) >= SHARP:
        return 0.0
    x, y = run.x + right_of(run.direction) * distance, run.y + down_of(run.direction) * distance
    level = run.direction & 1 == 1
    way = runs[k - 1].direction
    off = meets(runs, count, run.at + distance, x, y, level) * (right_of(way) if level else down_of(way))
    return whole_grains(min(off, window.reach)) if off > 0.0 else -whole_grains(min(-off, window.reach))


@subkernel
def crossing(window, runs, count, at, after):
    """Return the point where the outline crosses the tile's border near a corner of a path of pixel edges.

    The result is (position along the path, x offset, y offset from the path) [px]. runs: RUN rows (straight rows of
    pixel edges), of which the first `count` are the path, with SEEN edges on either side of the corner; at: number of
    pixel edges before the corner. after: used only if the corner is also a corner of the tile: True to move the
    crossing along the run that starts at the corner, False along the run that ends there; window: pixels of the tile
    and settings, a paths.Window.
    """
    k = 0
    while k + 1 < count and runs[k + 1].at <= at:
        k += 1
    run = runs[k]
    distance = at - run.at
    x, y = run.x + right_of(run.direction) * distance, run.y + down_of(run.direction) * distance
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
        # The line leads from one border of the tile to another, past the tile's corner, and lies on neither border.
        other = room_in(window, runs, count, k - 1 if after else k, x, y, not after)
        if other == 0.0:
            return float(at), 0.0, 0.0
        if room * other > window.reach * (room + other):
            room = min(room, whole_grains(1.9 * window.reach))
    return at + room if after else at - room, 0.0, 0.0


# ---- tile paths ------------------------------------------------------------------------------------------------------
# The outline in one tile: its crack paths, from border to border or closed, simplified to straight lines.

NEAREST = 0.24  # [px] candidate corners nearer to a crossing are left out, because they would make slivers

PIECE = np.dtype(
    [  # a piece of the outline: lines from point to point
        ("first", np.int64),
        ("count", np.int64),
        ("closed", np.bool_),  # the last point is joined to the first; else the piece leads from border to border
        ("start", np.float64),  # [px] position of the ends along the tile's border, clockwise from its top left corner
        ("end", np.float64),
        ("used", np.bool_),
    ],
    align=True,
)


class Paths(NamedTuple):
    """Pieces of the outline in one tile and their points, written by find_paths, with scratch arrays."""

    marks: np.ndarray  # [row, col] uint8 of the window; not 0: the crack above this pixel is already in a path
    lines: Lines
    pieces: np.ndarray  # PIECE
    points: np.ndarray  # POINT
    counts: np.ndarray  # (2,) int64: number of pieces, number of points


def room_for_paths(size: int, halo: int) -> Paths:
    """Return scratch arrays for tiles of `size` px per side with a margin of `halo` px."""
    cracks = 2 * size * size + 4 * SEEN + 8  # of a checkerboard, the largest possible number
    wide = size + 2 * halo
    return Paths(
        np.zeros((wide, wide), np.uint8),
        room_for_lines(cracks),
        np.zeros(cracks, PIECE),
        np.zeros(2 * cracks, POINT),
        np.zeros(2, np.int64),
    )


@subkernel
def along_border(window, x, y):
    """Return the position [px] of border point (x, y) along the tile's border, clockwise from its top left corner.

    window: the tile, a paths.Window.
    """
    size = float(window.high - window.low)
    if y == window.low:
        return x - window.low
    if x == window.high:
        return size + y - window.low
    if y == window.high:
        return 2.0 * size + window.high - x
    return 3.0 * size + window.high - y


@subkernel
def put_end(n, runs, count, at, off_x, off_y, places_inout):
    """Write row n of places_inout (PLACE rows): the point where the outline crosses the tile's border.

    The point is given by its position along a path and an offset from the path. at: the position, in pixel edges;
    off_x, off_y [px]: the offset; runs: RUN rows, of which the first `count` are the path.
    """
    k = 0
    while k + 1 < count and runs[k + 1].at <= at:
        k += 1
    run = runs[k]
    x = run.x + (at - run.at) * right_of(run.direction) + off_x
    y = run.y + (at - run.at) * down_of(run.direction) + off_y
    put_place(n, x, y, at, run, False, True, places_inout)


@subkernel
def put_points(window, found, path, workspace):
    """Append the lines found along a path as a piece of the outline (PIECE row) with its points (POINT rows).

    Return whether a piece was appended: False if `found` is 0. found: number of line ends in workspace.lines.chain, see
    paths.cheapest; path: the Path; workspace: Paths; window: pixels of the tile and settings, a paths.Window.
    """
    if found == 0:
        return False
    counts = workspace.counts
    piece = workspace.pieces[counts[0]]
    piece.first = counts[1]
    piece.count = lay_lines(found, path, workspace.lines, counts[1], workspace.points) - counts[1]
    piece.closed = path.closed
    piece.used = False
    a, b = workspace.points[piece.first], workspace.points[piece.first + piece.count - 1]
    piece.start = along_border(window, a.x, a.y)
    piece.end = along_border(window, b.x, b.y)
    counts[0] += 1
    counts[1] += piece.count
    return True


@subkernel
def path_within(window, count, cracks, begin, end):
    """Return the Path of `count` runs and `cracks` pixel edges in the tile.

    begin, end: range of the path inside the tile, in pixel edges along the path; infinite for a loop; window: pixels of
    the tile and settings, a paths.Window.
    """
    low, high = float(window.low), float(window.high)
    return Path(count, cracks, math.isinf(end), window.reach, low, high, begin, end, window.joins)


@subkernel
def add_open(window, x, y, direction, cracks, workspace):
    """Append the outline along a path from border to border of the tile. Return whether the lines along it were found.

    x, y, direction: corner at which the path enters the tile, and its direction there; cracks: number of the path's
    pixel edges inside the tile. cracks is 0 if the path only passes the tile's corner, from one border to another.
    window: pixels of the tile and settings, a paths.Window; workspace: Paths, which receives the result.
    """
    runs, places = workspace.lines.runs, workspace.lines.places
    x, y, direction = walked_back(window, x, y, direction, SEEN)
    count = record(window, x, y, direction, cracks + 2 * SEEN, runs)
    start, start_x, start_y = crossing(window, runs, count, SEEN, cracks > 0)
    end, end_x, end_y = crossing(window, runs, count, SEEN + cracks, cracks == 0)
    put_end(0, runs, count, start, start_x, start_y, places)
    n = 1
    for k in range(count):
        run = runs[k]
        if start < run.at < end:
            # No line ends where the path meets the border, if the crossing is on another tile's pixels.
            barred = (run.at == SEEN and start < run.at) or (run.at == SEEN + cracks and end > run.at)
            put_place(n, float(run.x), float(run.y), float(run.at), run, True, not (run.joined or barred), places)
            places[n].anchor = not barred and stays(runs, count, k, False)
            n += 1
        n = put_run(n, run, max(start + NEAREST, float(SEEN)), min(end - NEAREST, float(SEEN + cracks)), 0.0, places)
    put_end(n, runs, count, end, end_x, end_y, places)
    path = path_within(window, count, cracks + 2 * SEEN, float(SEEN), float(SEEN + cracks))
    found = cheapest(0, n, window.reach, LINE_PRICES, places, workspace.lines.chain)
    return put_points(window, found, path, workspace)


@subkernel
def add_closed(window, x, y, direction, cracks, workspace):
    """Append the outline along a loop of `cracks` pixel edges in the tile. Return whether lines were found.

    x, y, direction: a corner where the loop turns, and the direction in which it leaves the corner; window: pixels of
    the tile and settings, a paths.Window; workspace: Paths, which receives the result.
    """
    lines = workspace.lines
    count = record(window, x, y, direction, cracks, lines.runs)
    around, anchor = put_loop(lines.runs, count, cracks, lines.places)
    found = cheapest_loop(around, anchor, window.reach, lines.places, lines.chain)
    path = path_within(window, count, cracks, -math.inf, math.inf)
    return put_points(window, found, path, workspace)


@subkernel
def add_at_corner(window, x, y, workspace):
    """Append all pieces of the outline that enter the tile at border point (x, y).

    Return whether the lines of each piece were found. window: pixels of the tile and settings, a paths.Window;
    workspace: Paths, which receives the result.
    """
    pixels = window.pixels
    done = True
    solid = 0
    for quadrant in range(4):
        solid += 1 if is_solid(pixels, x, y, quadrant) else 0
    if solid == 0 or solid == 4:
        return True
    for d in range(4):
        if is_solid(pixels, x, y, d) and not is_solid(pixels, x, y, d + 3) and is_own(window, x, y, d):
            arriving = backward(window, x, y, d)
            if not is_own(window, x, y, arriving + 1):
                cracks = follow(window, x, y, d, workspace.marks)
                done = add_open(window, x, y, d, cracks, workspace) and done
    at_both = (x == window.low or x == window.high) and (y == window.low or y == window.high)
    if solid == 3 and at_both:
        for quadrant in range(4):
            if not is_solid(pixels, x, y, quadrant) and is_own(window, x, y, quadrant):
                done = add_open(window, x, y, (quadrant + 1) & 3, 0, workspace) and done
    return done


@subkernel
def find_paths(window, workspace):
    """Find all pieces of the outline in a tile. Return whether the lines of each piece were found.

    window: pixels of the tile and settings, a paths.Window; workspace: Paths, which receives the pieces. The time is
    linear in pixels and corners, except for the search of lines.
    """
    low, high = window.low, window.high
    workspace.counts[0] = 0
    workspace.counts[1] = 0
    for y in range(low, high + 1):
        for x in range(low, high + 1):
            workspace.marks[y, x] = 0
    done = True
    for k in range(high - low):
        done = add_at_corner(window, low + k, low, workspace) and done
        done = add_at_corner(window, high, low + k, workspace) and done
        done = add_at_corner(window, high - k, high, workspace) and done
        done = add_at_corner(window, low, high - k, workspace) and done
    for y in range(low, high):
        for x in range(low, high):
            if window.pixels[y, x] != 0 and window.pixels[y - 1, x] == 0 and workspace.marks[y, x] == 0:
                cracks = follow(window, x, y, 0, workspace.marks)
                done = add_closed(window, x, y, 0, cracks, workspace) and done
    return done


# ---- tile regions ----------------------------------------------------------------------------------------------------
# The solid part of a tile as rings of sides: its pieces of the outline, and the tile's border between them.
#
# From the end of a piece a ring follows the border, clockwise on the screen, to the start of the next piece. The pixels
# on the other side of this stretch of the border are also solid, so its sides are inner.


@subkernel
def tile_corner(window, number):
    """Return (x, y) [px] of a corner of the tile. number: 0 top left, then clockwise on the screen, modulo 4."""
    number &= 3
    return (
        float(window.high if number == 1 or number == 2 else window.low),
        float(window.high if number >= 2 else window.low),
    )


@subkernel
def put_piece(n, first, piece, points, sides_inout):
    """Append the sides of a piece (PIECE row) to a ring. Return the new number of SIDE rows.

    In an open piece the side that starts at the last point is inner, because it follows the tile's border. n: number of
    rows before; first: row of the ring's first side; points: POINT rows. sides_inout: SIDE rows.
    """
    for k in range(piece.count):
        point = points[piece.first + k]
        n = put_side(n, first, point.x, point.y, not piece.closed and k == piece.count - 1, sides_inout)
    return n


@subkernel
def next_piece(pieces, count, at, around):
    """Return (index, distance [px]) of the open piece that starts next along the tile's border, clockwise.

    pieces: PIECE rows, of which the first `count` are in use; at [px]: position along the border from which the
    distance is measured; around [px]: length of the border.
    """
    best = -1
    nearest = math.inf
    for k in range(count):
        piece = pieces[k]
        if not piece.closed:
            ahead = piece.start - at
            if ahead < 0.0:
                ahead += around
            if ahead < nearest:
                nearest = ahead
                best = k
    return best, nearest


@subkernel
def put_border(window, n, first, start, length, sides_inout):
    """Append the tile's corners on a section of the tile's border to a ring. Return the new number of SIDE rows.

    n: number of rows before; first: row of the ring's first side; start [px]: start of the section along the border;
    length [px]: length of the section. Corners at the ends of the section are not added. sides_inout: SIDE rows;
    window: pixels of the tile and settings, a paths.Window.
    """
    size = float(window.high - window.low)
    number = math.floor(start / size) + 1
    while number * size < start + length:
        x, y = tile_corner(window, number)
        n = put_side(n, first, x, y, True, sides_inout)
        number += 1
    return n


@subkernel
def put_open(window, n, number, workspace, sides_inout):
    """Append a ring: open pieces of the outline, starting with piece `number`, and the tile's border between them.

    Return the new number of SIDE rows. n: number of rows before; workspace: Paths; sides_inout: SIDE rows; window:
    pixels of the tile and settings, a paths.Window.
    """
    around = 4.0 * (window.high - window.low)
    pieces = workspace.pieces
    first = n
    while not pieces[number].used:
        piece = pieces[number]
        piece.used = True
        n = put_piece(n, first, piece, workspace.points, sides_inout)
        number, ahead = next_piece(pieces, workspace.counts[0], piece.end, around)
        n = put_border(window, n, first, piece.end, ahead, sides_inout)
    return close_ring(n, first, sides_inout)


@subkernel
def is_hole(piece, points):
    """Return whether a closed piece of the outline bounds a hole.

    The points of a hole are counter-clockwise on the screen. piece: PIECE row; points: POINT rows.
    """
    doubled = 0.0
    before = points[piece.first + piece.count - 1]
    for k in range(piece.first, piece.first + piece.count):
        point = points[k]
        doubled += before.x * point.y - before.y * point.x
        before = point
    return doubled < 0.0


@subkernel
def put_regions(window, workspace, sides_out):
    """Write the rings around the solid part of a tile as SIDE rows. Return the number of rows.

    Holes are separate rings. workspace: Paths, filled by find_paths; window: pixels of the tile and settings, a
    paths.Window.
    """
    n = 0
    holes = 0
    crossed = False
    for k in range(workspace.counts[0]):
        piece = workspace.pieces[k]
        if not piece.closed:
            crossed = True
            if not piece.used:
                n = put_open(window, n, k, workspace, sides_out)
            continue
        first = n
        n = close_ring(put_piece(n, n, piece, workspace.points, sides_out), first, sides_out)
        if n > first and is_hole(piece, workspace.points):
            holes += 1
            for side in range(first, n):
                sides_out[side].apart = holes
    low = window.low
    if not crossed and is_solid(window.pixels, low, low, 0) and is_solid(window.pixels, low, low, 3):
        first = n
        for number in range(4):
            x, y = tile_corner(window, number)
            n = put_side(n, first, x, y, True, sides_out)
        n = close_ring(n, first, sides_out)
    return n


# ---- tile parts ------------------------------------------------------------------------------------------------------
# The outline of one tile of a larger mask in convex parts. Carving recomputes only the tiles that it touches.
#
# A tile's parts cover its solid pixels. Where the pixels on both sides of the tile's border are solid, the parts' sides
# are inner. The parts of neighbouring tiles have the same points on their common border (see "crossings"). All tiles
# together have an outline within the same distances of the pixels' edges as contour.outline.

HALO = SEEN + SHARP + 1  # [px] width of the margin in neighbouring tiles on which a tile's outline depends


class TileParts(NamedTuple):
    """Convex parts of one tile: polygons whose corners are listed part after part."""

    corners: np.ndarray  # (n, 2) float64 [px], clockwise on the screen; topmost, then leftmost corner first
    inner: np.ndarray  # (n,) bool: the side after the corner is shared with a part of this or a neighbouring tile
    counts: np.ndarray  # (k,) int64: corners of each polygon


NONE = TileParts(np.zeros((0, 2)), np.zeros(0, bool), np.zeros(0, np.int64))


def tile_parts(window: np.ndarray, smooth: float, at: tuple[int, int] = (0, 0)) -> TileParts:
    """Return the convex parts of the outline in one tile of a mask, with at most 16 corners each.

    window[row, col] bool: the square tile with a margin of HALO pixels on each side, clear outside the mask; at [px]:
    top left corner of the tile in the mask; smooth [px]: largest distance of the outline from the pixels' edges. The
    parts of all tiles together are as near to the pixels' edges as the result of contour.outline. An empty tile has no
    parts. A solid tile with only solid pixels around it is one square of inner sides. Raises ValueError for a window
    that is not square, or whose tile is not larger than HALO.
    """
    height, width = window.shape
    size = width - 2 * HALO
    if height != width or size <= HALO:
        raise ValueError(f"window must be square, its tile larger than {HALO} (got {width} x {height})")
    near = window[HALO - 1 : HALO + size + 1, HALO - 1 : HALO + size + 1]
    solid = np.count_nonzero(near)
    if solid == 0 or not np.count_nonzero(near[1:-1, 1:-1]):
        if not _is_cornered(near):
            return NONE
    if solid == near.size:
        square = np.array([(0, 0), (size, 0), (size, size), (0, size)], float)
        return TileParts(square + at, np.ones(4, bool), np.array([4]))
    found = fitted("tile_parts", window, smooth, lambda: _fit(window, size, smooth))
    return TileParts(found.corners + at, found.inner.copy(), found.counts.copy())


def _fit(window, size, smooth):
    pixels = np.ascontiguousarray(window, dtype=np.uint8)
    paths, sides, corners, inner, counts = _room(size)
    found = convex_tile(
        Window(pixels, HALO, HALO + size, min(smooth, LARGEST_REACH), smooth >= JOINING),
        MAX_CORNERS,
        paths,
        sides,
        corners,
        inner,
        counts,
    )
    if found < 0:
        raise RuntimeError("the outline of a tile is no polygon: a defect of outline.tiled")
    n = sum(counts[:found].tolist())
    return Parts(corners[:n].copy(), inner[:n].copy(), counts[:found].copy(), np.zeros(found))


def _is_cornered(near):
    """Return whether the outline cuts off a corner of a clear tile: the other three pixels at this corner are solid.

    near [row, col] bool: the tile's pixels with a margin of 1 px.
    """
    return (
        (near[:2, :2].sum() == 3)
        or (near[:2, -2:].sum() == 3)
        or (near[-2:, :2].sum() == 3)
        or (near[-2:, -2:].sum() == 3)
    )


@cache
def _room(size):
    """Return the scratch arrays of convex_tile for tiles of `size` px: 12 MB for 64 px. All calls share the arrays."""
    paths = room_for_paths(size, HALO)
    most = 3 * len(paths.points)
    return (paths, np.zeros(most, SIDE), np.zeros((most, 2)), np.zeros(most, bool), np.zeros(most, np.int64))


@kernel
def convex_tile(window, most, workspace, sides_inout, corners_out, inner_out, counts_out):
    """Write the convex parts of a tile's outline. Return their number, or -1 if the outline is not a polygon.

    window: Window; most: largest number of corners of a part; workspace: Paths, scratch; sides_inout: SIDE rows,
    scratch; corners_out (n, 2) [px], inner_out (n,), counts_out (parts,): the parts, in the format of TileParts.
    """
    if not find_paths(window, workspace):
        return -1
    n = put_regions(window, workspace, sides_inout)
    return write_parts(n, most, window.low, sides_inout, corners_out, inner_out, counts_out)
