"""The outline in one tile: its paths of cracks, from border to border or closed, in straight lines."""

from typing import NamedTuple

import numpy as np

from physics.fitting.cracks import (
    RUN,
    SHARP,
    backward,
    down_of,
    follow,
    is_own,
    is_solid,
    record,
    right_of,
    walked_back,
)
from physics.fitting.crossings import SEEN, crossing
from physics.fitting.straight_lines import PLACE, cheapest, cheapest_loop
from physics.jit import subkernel

NEAREST = 0.24  # [px] places nearer to a crossing are left out: they would make slivers

POINT = np.dtype([("x", np.float64), ("y", np.float64)], align=True)
PIECE = np.dtype(
    [  # a stretch of the outline: lines from point to point
        ("first", np.int64),
        ("count", np.int64),
        ("closed", np.bool_),  # from the last point back to the first one; else from border to border
        ("start", np.float64),  # [px] along the tile's border, clockwise from its top left corner
        ("end", np.float64),
        ("used", np.bool_),
    ],
    align=True,
)


class Paths(NamedTuple):
    """Room to work in, as large as a tile can need, and what is found."""

    marks: np.ndarray  # [row, col] uint8 of the window
    runs: np.ndarray  # RUN
    places: np.ndarray  # PLACE
    chain: np.ndarray  # int64
    pieces: np.ndarray  # PIECE
    points: np.ndarray  # POINT
    counts: np.ndarray  # int64: pieces, points


def room_for_paths(size: int, halo: int) -> Paths:
    """For tiles of so many pixels a side."""
    cracks = 2 * size * size + 4 * SEEN + 8  # of a checkerboard: no tile has more
    wide = size + 2 * halo
    return Paths(
        np.zeros((wide, wide), np.uint8),
        np.zeros(cracks, RUN),
        np.zeros(4 * cracks + 8, PLACE),
        np.zeros(4 * cracks + 8, np.int64),
        np.zeros(cracks, PIECE),
        np.zeros(2 * cracks, POINT),
        np.zeros(2, np.int64),
    )


@subkernel
def along_border(window, x, y):
    """Distance [px] of a point on the tile's border from its top left corner, clockwise."""
    size = float(window.high - window.low)
    if y == window.low:
        return x - window.low
    if x == window.high:
        return size + y - window.low
    if y == window.high:
        return 2.0 * size + window.high - x
    return 3.0 * size + window.high - y


@subkernel
def stays(runs, count, k, closed):
    """Whether the corner at the start of run k stays: between long runs, and of rectangles."""
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
def put_place(n, x, y, run, corner, allowed, places_inout):
    """Append a place on a run to places (PLACE)."""
    place = places_inout[n]
    place.x = x
    place.y = y
    place.right = right_of(run.direction)
    place.down = down_of(run.direction)
    place.corner = corner
    place.allowed = allowed
    place.anchor = False
    place.swept = 0.0
    if n > 0:
        last = places_inout[n - 1]
        place.swept = last.swept + last.x * y - last.y * x


@subkernel
def put_run(n, run, start, end, places_inout):
    """Append the places within a run, those between two lengths of the path. Returns how many places there are."""
    for step in range(3):
        if step != 1 and run.length == 1:
            continue
        along = 0.5 if step == 0 else (run.length / 2.0 if step == 1 else run.length - 0.5)
        if start < run.at + along < end:
            x = run.x + along * right_of(run.direction)
            y = run.y + along * down_of(run.direction)
            put_place(n, x, y, run, False, True, places_inout)
            n += 1
    return n


@subkernel
def put_end(n, runs, count, at, off_x, off_y, places_inout):
    """Append a crossing, off a place of the path."""
    k = 0
    while k + 1 < count and runs[k + 1].at <= at:
        k += 1
    run = runs[k]
    x = run.x + (at - run.at) * right_of(run.direction) + off_x
    y = run.y + (at - run.at) * down_of(run.direction) + off_y
    put_place(n, x, y, run, False, True, places_inout)


@subkernel
def put_points(window, found, closed, workspace):
    """Append the chain of so many places as a piece (PIECE), backward: points (POINT). Returns whether there is one."""
    if found == 0:
        return False
    counts = workspace.counts
    piece = workspace.pieces[counts[0]]
    piece.first = counts[1]
    piece.count = found - 1 if closed else found
    piece.closed = closed
    piece.used = False
    for k in range(piece.count):
        place = workspace.places[workspace.chain[found - 1 - k]]
        point = workspace.points[counts[1] + k]
        point.x = place.x
        point.y = place.y
    a = workspace.points[piece.first]
    b = workspace.points[piece.first + piece.count - 1]
    piece.start = along_border(window, a.x, a.y)
    piece.end = along_border(window, b.x, b.y)
    counts[0] += 1
    counts[1] += piece.count
    return True


@subkernel
def add_open(window, x, y, direction, cracks, workspace):
    """Append the piece of a path between two borders: so many cracks from a corner on; 0: the path only passes the
    corner of the tile from one border to another. Returns whether it could be done."""
    runs, places = workspace.runs, workspace.places
    x, y, direction = walked_back(window, x, y, direction, SEEN)
    count = record(window, x, y, direction, cracks + 2 * SEEN, runs)
    start, start_x, start_y = crossing(window, runs, count, SEEN, cracks > 0)
    end, end_x, end_y = crossing(window, runs, count, SEEN + cracks, cracks == 0)
    put_end(0, runs, count, start, start_x, start_y, places)
    n = 1
    for k in range(count):
        run = runs[k]
        if start < run.at < end:
            # A crossing on another tile's pixels: the line from it leaves the border at once.
            barred = (run.at == SEEN and start < run.at) or (run.at == SEEN + cracks and end > run.at)
            put_place(n, float(run.x), float(run.y), run, True, not (run.joined or barred), places)
            places[n].anchor = not barred and stays(runs, count, k, False)
            n += 1
        n = put_run(n, run, max(start + NEAREST, float(SEEN)), min(end - NEAREST, float(SEEN + cracks)), places)
    put_end(n, runs, count, end, end_x, end_y, places)
    return put_points(window, cheapest(0, n, window.reach, places, workspace.chain), False, workspace)


@subkernel
def add_closed(window, x, y, direction, cracks, workspace):
    """Append the piece of a loop of so many cracks, from a corner on where it turns. Returns whether it could be
    done."""
    runs, places = workspace.runs, workspace.places
    count = record(window, x, y, direction, cracks, runs)
    n = 0
    around = 0
    anchor = -1
    for turn in range(2):
        for k in range(count):
            run = runs[k]
            put_place(n, float(run.x), float(run.y), run, True, not run.joined, places)
            places[n].anchor = stays(runs, count, k, True)
            if anchor < 0 and places[n].anchor:
                anchor = n
            n = put_run(n + 1, run, -1.0, cracks + 1.0, places)
        if turn == 0:
            around = n
    found, _ = cheapest_loop(around, anchor, window.reach, places, workspace.chain)
    return put_points(window, found, True, workspace)


@subkernel
def add_at_corner(window, x, y, workspace):
    """Append all pieces that start at a corner of the grid on the tile's border. Returns whether it could be done."""
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
    """Find all pieces of the outline in a tile. Returns whether it could be done.

    workspace: Paths. Linear in pixels and corners, but for the lines.
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
