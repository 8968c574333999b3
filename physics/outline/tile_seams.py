"""Corners of a tile's parts that other parts cover, of the tile or of its neighbours, and the remaining outer corners.

Parts that meet in a point and together take half a turn or more there leave no convex corner. Otherwise the corner
belongs to the first of them with a side of the outline there: tiles in the order of rows, then parts in their order. A
corner at which the outline hardly turns is marked as blunt, because its part is sharper than the outline there. The
inner side beside it does not belong to the outline.
"""

import math
from typing import NamedTuple

import numpy as np

from physics.jit import kernel, subkernel
from physics.outline.tiled import TileParts
from physics.tables.shape import SHARPEST, TURNS

STRAIGHT = 1e-9  # of half a turn: a corner with a smaller turn lies within a side
HALF_TURN = math.pi * (1.0 - STRAIGHT)  # [rad]
COVERED = 0.0  # [rad] turn of the outline at a covered corner

NOBODY = np.zeros((0, 5))  # no corner on a border


class Survey(NamedTuple):
    """Data of a tile's parts that is independent of the neighbouring tiles."""

    angles: np.ndarray  # (n,) float64 [rad] interior angle of each corner
    seams: np.ndarray  # (n,) bool: one of the two sides at it is inner, the other is not
    meetings: np.ndarray  # (m, 5) its corners on the border: x, y [px], angle, is a seam, tile number
    corners: np.ndarray  # (k, 2) float64 [px] for a world: in body space, without collinear corners
    counts: np.ndarray  # (parts,) int64: number of these per part


def survey(parts: TileParts, at: tuple[int, int], size: int, number: int, origin: tuple[float, float]) -> Survey:
    """Return the survey of a tile's parts.

    parts in raster pixels; at: the tile's top left corner there; size: its pixels per side; number: its rank among the
    tiles; origin [px] of body space in the raster.
    """
    n, (left, top) = len(parts.corners), at
    found = Survey(
        np.empty(n), np.empty(n, bool), np.empty((n, 5)), np.empty((n, 2)), np.empty(len(parts.counts), np.int64)
    )
    met, kept = survey_tile(parts, (left, top, left + size, top + size), float(number), origin, found)
    return Survey(found.angles, found.seams, found.meetings[:met].copy(), found.corners[:kept].copy(), found.counts)


def movings(before: np.ndarray, after: np.ndarray, row: int, column: int, size: int) -> list[tuple[int, int]]:
    """Return (row, column) of the tiles with a border corner that is in only one of two lists of meetings of a tile.

    row, column: of the tile; size: its pixels per side.
    """
    found = np.zeros(9, bool)
    mark_moved(before, after, (column * size, row * size, size), found)
    return [(row + k // 3 - 1, column + k % 3 - 1) for k, moved in enumerate(found.tolist()) if moved]


def inner_bits(parts: TileParts, known: Survey, around: np.ndarray, number: int, columns: int) -> np.ndarray:
    """Return (k,) int64 flags of inner edges and corners of parts, without collinear corners; see SHAPE.

    around: meetings of the tile, of its neighbours, and possibly of others, in the order of their numbers; number: of
    the tile; columns: tiles per row.
    """
    inner = np.empty(len(parts.counts), np.int64)
    tell_inner(parts, known, around, (number, columns), np.empty(len(parts.corners)), inner)
    return inner


@subkernel
def find_seams(parts, angles_out, seams_out):
    """Write the interior angle [rad] of each corner (n,) of a tile's parts, and whether exactly one side at it is
    inner.
    """
    corners = parts.corners
    inner = parts.inner
    first = 0
    for part in range(len(parts.counts)):
        count = parts.counts[part]
        for k in range(count):
            at = first + k
            last = first + (k - 1 if k > 0 else count - 1)
            after = first + (k + 1 if k + 1 < count else 0)
            ux = corners[last, 0] - corners[at, 0]
            uy = corners[last, 1] - corners[at, 1]
            vx = corners[after, 0] - corners[at, 0]
            vy = corners[after, 1] - corners[at, 1]
            angles_out[at] = math.atan2(abs(ux * vy - uy * vx), ux * vx + uy * vy)
            seams_out[at] = inner[at] != inner[last]
        first += count


@subkernel
def gather(corners, known, box, number, found_out):
    """Write the corners (n, 2) [px] on the border of a box (left, top, right, bottom) as meetings of a Survey.

    known: a Survey with angles and seams. Returns the number of meetings.
    """
    left, top, right, bottom = box
    count = 0
    for k in range(len(corners)):
        x = corners[k, 0]
        y = corners[k, 1]
        if x == left or y == top or x == right or y == bottom:
            found_out[count, 0] = x
            found_out[count, 1] = y
            found_out[count, 2] = known.angles[k]
            found_out[count, 3] = 1.0 if known.seams[k] else 0.0
            found_out[count, 4] = number
            count += 1
    return count


@subkernel
def mark_alone(mine, others, place, moved_out):
    """Flag which of 9 tiles, row by row, around a tile share a corner that is in `mine` (n, 5) but not in `others` (m,
    5).

    place: left, top, size [px] of the tile. O(n m).
    """
    left, top, size = place
    for i in range(len(mine)):
        known = False
        for j in range(len(others)):
            known = known or (
                mine[i, 0] == others[j, 0]
                and mine[i, 1] == others[j, 1]
                and mine[i, 2] == others[j, 2]
                and mine[i, 3] == others[j, 3]
            )
        if known:
            continue
        x = mine[i, 0] - left
        y = mine[i, 1] - top
        for row in range(0 if y == 0.0 else 1, 3 if y == size else 2):
            for column in range(0 if x == 0.0 else 1, 3 if x == size else 2):
                moved_out[3 * row + column] = True


@kernel
def mark_moved(before, after, place, moved_out):
    """Flag which of 9 tiles share a corner that is in only one of two lists of meetings; place: left, top, size [px].

    O(n m).
    """
    mark_alone(before, after, place, moved_out)
    mark_alone(after, before, place, moved_out)


@subkernel
def seam_turn(angle):
    """Return the turn [rad] of the outline at a point where the parts take `angle` [rad] in total, or COVERED."""
    return COVERED if angle >= HALF_TURN else math.pi - angle


@subkernel
def corner_bits(k, turn):
    """Return the bits of SHAPE's inner for corner k of a part, at which the outline turns by `turn` [rad]."""
    if turn == COVERED:
        return 1 << (k + 16)
    return 1 << (k + 32) if turn <= SHARPEST else 0


@subkernel
def turn_bits(turn):
    """Return the bits of SHAPE's inner for a part with `turn` [rad] as the largest turn at its blunt corners."""
    return (math.floor(turn * TURNS) + 1) << 48


@subkernel
def first_of(around, number):
    """Return the index of the first meeting of a tile numbered `number` or higher. O(log meetings)."""
    low, high = 0, len(around)
    while low < high:
        middle = (low + high) // 2
        if around[middle, 4] < number:
            low = middle + 1
        else:
            high = middle
    return low


@subkernel
def cover_corners(corners, known, around, place, turns_out):
    """Write the turn [rad] of the outline at each corner (n,), by the parts that meet there.

    pi where no other part meets it, COVERED where the parts cover it or another part owns it. around (m, 5): as in
    inner_bits; place: number of the tile, and tiles per row. O(n²), plus the meetings of the tiles around.
    """
    there = known.seams
    number, columns = place
    left = number - (1 if number % columns > 0 else 0)
    right = number + (1 if number % columns + 1 < columns else 0)
    for k in range(len(there)):
        turns_out[k] = math.pi
        if not there[k]:
            continue
        x = corners[k, 0]
        y = corners[k, 1]
        total = 0.0
        taken = False
        for m in range(len(there)):
            if corners[m, 0] == x and corners[m, 1] == y:
                total += known.angles[m]
                taken = taken or (m < k and there[m])
        for row in range(-1, 2):
            m = first_of(around, left + row * columns)
            while m < len(around) and around[m, 4] <= right + row * columns:
                if around[m, 0] == x and around[m, 1] == y and around[m, 4] != number:
                    total += around[m, 2]
                    taken = taken or (around[m, 3] != 0.0 and around[m, 4] < number)
                m += 1
        turns_out[k] = COVERED if taken else seam_turn(total)


@subkernel
def first_turn(angles, first):
    """Return the first corner of a part, from `first` on, that does not lie within a side."""
    while angles[first] >= HALF_TURN:
        first += 1
    return first


@subkernel
def leave_straight(parts, angles, origin, corners_out, counts_out):
    """Write the corners (n, 2) of TileParts at which they turn, minus the origin, and their number per part.

    Returns the total number of corners.
    """
    left, top = origin
    n = 0
    first = 0
    for part in range(len(parts.counts)):
        count = parts.counts[part]
        begin = n
        start = first_turn(angles, first)
        for step in range(count):
            at = start + step if start + step < first + count else start + step - count
            if angles[at] < HALF_TURN:
                # Differences of whole grains are exact for any origin, so they are the same in each tile with the
                # corner.
                corners_out[n, 0] = parts.corners[at, 0] - left
                corners_out[n, 1] = parts.corners[at, 1] - top
                n += 1
        counts_out[part] = n - begin
        first += count
    return n


@kernel
def survey_tile(parts, box, number, origin, survey_out):
    """Write the survey of TileParts; box: left, top, right, bottom of the tile. Returns the numbers of meetings and
    corners.
    """
    find_seams(parts, survey_out.angles, survey_out.seams)
    met = gather(parts.corners, survey_out, box, number, survey_out.meetings)
    return met, leave_straight(parts, survey_out.angles, origin, survey_out.corners, survey_out.counts)


@kernel
def tell_inner(parts, known, around, place, turns_out, inner_out):
    """Write the flags of inner edges and corners of each part, as inner_bits, for the corners of leave_straight.

    An edge of several sides is inner if all of them are. place: number of the tile, and tiles per row; turns_out (n,):
    turn [rad] of the outline at each corner.
    """
    cover_corners(parts.corners, known, around, place, turns_out)
    first = 0
    for part in range(len(parts.counts)):
        count = parts.counts[part]
        start = first_turn(known.angles, first)
        edge = -1
        bits = 0
        most = 0.0
        for step in range(count):
            at = start + step if start + step < first + count else start + step - count
            if known.angles[at] < HALF_TURN:
                edge += 1
                bits |= 1 << edge
                last = at - 1 if at > first else first + count - 1
                turn = COVERED if parts.inner[at] and parts.inner[last] else turns_out[at]
                bits |= corner_bits(edge, turn)
                most = max(most, turn if turn <= SHARPEST else 0.0)
            if not parts.inner[at]:
                bits &= ~(1 << edge)
        inner_out[part] = bits | turn_bits(most)
        first += count
