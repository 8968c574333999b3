"""Which corners of a tile's parts are covered by others, of its own or of the tiles around, and what sides are left.

Parts that meet in a point and together take half a turn or more there leave no corner that sticks out. Of those that
leave one the first that has a side of the outline there has it: tiles count row by row, parts in their order. Of a
corner that hardly sticks out it is told, as its part seems sharper than the outline is there: the inner side beside it
is none of the outline's.
"""

import math
from typing import NamedTuple

import numpy as np

from physics.jit import kernel, subkernel
from physics.outline.tiled import TileParts
from physics.tables.shape import SHARPEST, TURNS

STRAIGHT = 1e-9  # of half a turn: corners that are no sharper lie within a side
HALF_TURN = math.pi * (1.0 - STRAIGHT)  # [rad]
COVERED = 0.0  # [rad] the turn of the outline where none of its corners sticks out

NOBODY = np.zeros((0, 5))  # no corner on a border


class Survey(NamedTuple):
    """What is known of a tile's parts, whatever lies around it."""

    angles: np.ndarray  # (n,) float64 [rad] inside each corner
    seams: np.ndarray  # (n,) bool: whether one of the two sides at it is inner, and the other not
    meetings: np.ndarray  # (m, 5) its corners on the border: x, y [px], angle, whether a seam, number of the tile
    corners: np.ndarray  # (k, 2) float64 [px] as a world takes them: in body space, those in a line left out
    counts: np.ndarray  # (parts,) int64: how many of these each part has


def survey(parts: TileParts, at: tuple[int, int], size: int, number: int, origin: tuple[float, float]) -> Survey:
    """What is known of a tile's parts.

    parts in raster pixels; at: the tile's top left corner there; size: its pixels a side; number: in which order it
    counts; origin [px] of body space in the raster.
    """
    n, (left, top) = len(parts.corners), at
    found = Survey(
        np.empty(n), np.empty(n, bool), np.empty((n, 5)), np.empty((n, 2)), np.empty(len(parts.counts), np.int64)
    )
    met, kept = survey_tile(parts, (left, top, left + size, top + size), float(number), origin, found)
    return Survey(found.angles, found.seams, found.meetings[:met].copy(), found.corners[:kept].copy(), found.counts)


def movings(before: np.ndarray, after: np.ndarray, row: int, column: int, size: int) -> list[tuple[int, int]]:
    """(row, column) of the tiles that have a corner which only one of two lists of meetings of a tile, at a row and
    column of tiles of so many pixels a side, has."""
    found = np.zeros(9, bool)
    mark_moved(before, after, (column * size, row * size, size), found)
    return [(row + k // 3 - 1, column + k % 3 - 1) for k, moved in enumerate(found.tolist()) if moved]


def inner_bits(parts: TileParts, known: Survey, around: np.ndarray, number: int, columns: int) -> np.ndarray:
    """(k,) int64, see SHAPE: which edges and corners of parts, without those in a line, are inner.

    around: meetings of its tile, of all around, and of others, in the order of their numbers; number: of its tile;
    columns: tiles in a row.
    """
    inner = np.empty(len(parts.counts), np.int64)
    tell_inner(parts, known, around, (number, columns), np.empty(len(parts.corners)), inner)
    return inner


@subkernel
def find_seams(parts, angles_out, seams_out):
    """The angle inside each corner (n,) of a tile's parts [rad], and whether one of the sides at it is inner."""
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
    """Write the corners (n, 2) [px] that lie on the border of a box (left, top, right, bottom), as the meetings of a
    Survey, known but for these. Returns how many."""
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
    """Flag which of 9 tiles, row by row, around one have a corner of its meetings `mine` (n, 5) that is none of
    the others (m, 5); place: left, top, size [px] of the tile. O(n m)."""
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
    """Flag which of 9 tiles have a corner that only one of two lists of meetings has; place: left, top, size [px].
    O(n m)."""
    mark_alone(before, after, place, moved_out)
    mark_alone(after, before, place, moved_out)


@subkernel
def seam_turn(angle):
    """By how much [rad] the outline turns where parts meet that take so much of a turn together, or COVERED."""
    return COVERED if angle >= HALF_TURN else math.pi - angle


@subkernel
def corner_bits(k, turn):
    """The bits of SHAPE's inner for corner k of a part, at which the outline turns by so much [rad]."""
    if turn == COVERED:
        return 1 << (k + 16)
    return 1 << (k + 32) if turn <= SHARPEST else 0


@subkernel
def turn_bits(turn):
    """The bits of SHAPE's inner for a part at whose blunt corners the outline turns by so much [rad] at most."""
    return (math.floor(turn * TURNS) + 1) << 48


@subkernel
def first_of(around, number):
    """The first of meetings, in the order of their tiles' numbers, of a tile from this number on. O(log meetings)."""
    low = 0
    high = len(around)
    while low < high:
        middle = (low + high) // 2
        if around[middle, 4] < number:
            low = middle + 1
        else:
            high = middle
    return low


@subkernel
def cover_corners(corners, known, around, place, turns_out):
    """By how much [rad] the outline turns at each corner (n,), by the parts that meet there: pi where none does,
    COVERED where they or another of them has it; around (m, 5): as in inner_bits; place: number of the tile, and how
    many there are in a row. O(n²) but for the meetings of the tiles around."""
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
    """The first corner of a part, from `first` on, that is not within a side."""
    while angles[first] >= HALF_TURN:
        first += 1
    return first


@subkernel
def leave_straight(parts, angles, origin, corners_out, counts_out):
    """Write the corners (n, 2) of TileParts that turn, less the origin, and how many each part has. Returns how many
    there are."""
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
                # Differences of whole grains: exact wherever the origin is, so the same in each tile with the corner.
                corners_out[n, 0] = parts.corners[at, 0] - left
                corners_out[n, 1] = parts.corners[at, 1] - top
                n += 1
        counts_out[part] = n - begin
        first += count
    return n


@kernel
def survey_tile(parts, box, number, origin, survey_out):
    """Write what is known of TileParts, as in survey; box: left, top, right, bottom of the tile. Returns how many
    meetings and corners there are."""
    find_seams(parts, survey_out.angles, survey_out.seams)
    met = gather(parts.corners, survey_out, box, number, survey_out.meetings)
    return met, leave_straight(parts, survey_out.angles, origin, survey_out.corners, survey_out.counts)


@kernel
def tell_inner(parts, known, around, place, turns_out, inner_out):
    """Write which edges and corners of each part, as leave_straight writes them, are inner; as in inner_bits.

    An edge of several sides is inner where all of them are. place: number of the tile, and how many there are in a row;
    turns_out (n,): by how much the outline turns at each corner.
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
