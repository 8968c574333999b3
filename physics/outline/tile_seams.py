"""Flags for corners and sides of a tile's convex parts that are not on the mask's outline, because other parts adjoin.

A side shared by two parts is inner: it is not on the outline. A corner is covered if the angles of all parts at the
corner sum to half a turn or more, because the outline is not convex there. Otherwise the corner belongs to the first
part that has a side on the outline there, and is covered for all other parts. Parts are ordered by tiles, row by row,
then by their order within the tile. A corner at which the whole outline turns less than the part is blunt.
"""

import math
from typing import NamedTuple

import numpy as np

from physics.jit import kernel, subkernel
from physics.outline.tiled import TileParts
from physics.tables.shape import SHARPEST, TURNS

STRAIGHT = 1e-9  # share of half a turn: a corner that turns less counts as part of a straight side
HALF_TURN = math.pi * (1.0 - STRAIGHT)  # [rad]
COVERED = 0.0  # [rad] turn of the outline at a covered corner

NOBODY = np.zeros((0, 5))  # meetings of a tile without parts: no corner on its border


class Survey(NamedTuple):
    """Angles and corners of a tile's parts: all data that do not depend on the neighbouring tiles."""

    angles: np.ndarray  # (n,) float64 [rad] interior angle of each corner
    seams: np.ndarray  # (n,) bool: one side at the corner is inner, the other is a side of the outline
    meetings: np.ndarray  # (m, 5) corners on the tile's border: x, y [px], angle [rad], seam (0 or 1), tile number
    corners: np.ndarray  # (k, 2) float64 [px] in body space, without collinear corners: the corners of shapes
    counts: np.ndarray  # (parts,) int64: number of these corners per part


def survey(parts: TileParts, at: tuple[int, int], size: int, number: int, origin: tuple[float, float]) -> Survey:
    """Return the Survey of the convex parts of a tile.

    parts: TileParts in raster pixels; at [px]: top left corner of the tile in the raster; size [px]: side of the tile;
    number: index of the tile, counted row by row; origin [px]: origin of body space in the raster.
    """
    n, (left, top) = len(parts.corners), at
    found = Survey(
        np.empty(n), np.empty(n, bool), np.empty((n, 5)), np.empty((n, 2)), np.empty(len(parts.counts), np.int64)
    )
    met, kept = survey_tile(parts, (left, top, left + size, top + size), float(number), origin, found)
    return Survey(found.angles, found.seams, found.meetings[:met].copy(), found.corners[:kept].copy(), found.counts)


def movings(before: np.ndarray, after: np.ndarray, row: int, column: int, size: int) -> list[tuple[int, int]]:
    """Return (row, column) of each tile with a changed corner on its border, after one tile's parts have changed.

    A corner is changed if only one of the arrays `before` and `after` (m, 5) contains it. The arrays list the corners
    on the border of the tile whose parts changed, before and after, see Survey.meetings. Tiles outside the mask are
    also returned. row, column: position of this tile; size [px]: side of a tile.
    """
    found = np.zeros(9, bool)
    mark_moved(before, after, (column * size, row * size, size), found)
    return [(row + k // 3 - 1, column + k % 3 - 1) for k, moved in enumerate(found.tolist()) if moved]


def inner_bits(parts: TileParts, known: Survey, around: np.ndarray, number: int, columns: int) -> np.ndarray:
    """Return which sides and corners of each part of a tile are not on the outline, as SHAPE.inner flags (k,) int64.

    known: Survey of the parts; around (m, 5): corners on the borders of this tile, its neighbours and possibly more
    tiles, in the order of tile numbers, see Survey.meetings; number: index of the tile, counted row by row; columns:
    number of tiles per row.
    """
    inner = np.empty(len(parts.counts), np.int64)
    tell_inner(parts, known, around, (number, columns), np.empty(len(parts.corners)), inner)
    return inner


@subkernel
def find_seams(parts, angles_out, seams_out):
    """Write the interior angle [rad] at each corner of a tile's parts, and whether the corner is a seam.

    A seam is a corner between an inner side (shared by two parts) and a side on the outline. parts: TileParts;
    angles_out (n,) float64; seams_out (n,) bool.
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
    """Write the corners of a tile's parts on the tile's border as rows of Survey.meetings. Return their number.

    corners (n, 2) [px]: corners of the parts; known: Survey with angles and seams; box [px]: left, top, right, bottom
    of the tile; number: index of the tile; found_out (n, 5): the rows.
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
    """Flag each tile whose border has a corner that is listed in `mine` (n, 5), but not in `others` (m, 5).

    mine, others: corners on the border of the tile at `place`, in the format of Survey.meetings; place: (left, top,
    size) [px] of this tile; moved_out (9,) bool: flags of the tile and its 8 neighbours, row by row. O(n m).
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
    """Flag each tile whose border has a corner that is listed in only one of `before` (n, 5) and `after` (m, 5).

    before, after: corners on the border of the tile at `place`, in the format of Survey.meetings; place: (left, top,
    size) [px] of this tile; moved_out (9,) bool: flags of the tile and its 8 neighbours, row by row. O(n m).
    """
    mark_alone(before, after, place, moved_out)
    mark_alone(after, before, place, moved_out)


@subkernel
def seam_turn(angle):
    """Return the turn [rad] of the outline at a corner where the interior angles of all parts sum to `angle` [rad].

    The result is COVERED if the outline has no convex corner there.
    """
    return COVERED if angle >= HALF_TURN else math.pi - angle


@subkernel
def corner_bits(k, turn):
    """Return the bits of SHAPE.inner that mark corner k of a part as covered or blunt; 0 for a sharp corner.

    turn [rad]: turn of the outline at the corner; COVERED for a covered corner, at most SHARPEST for a blunt one.
    """
    if turn == COVERED:
        return 1 << (k + 16)
    return 1 << (k + 32) if turn <= SHARPEST else 0


@subkernel
def turn_bits(turn):
    """Return the bits of SHAPE.inner that store `turn`: the outline's largest turn [rad] at a part's blunt corners."""
    return (math.floor(turn * TURNS) + 1) << 48


@subkernel
def first_of(around, number):
    """Return the index of the first row of `around` (m, 5) with a tile number (column 4) of `number` or higher.

    The rows are sorted by tile number. O(log m).
    """
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
    """Write the turn [rad] of the outline at each corner of a tile's parts to turns_out (n,).

    A seam is a corner between an inner side (shared by two parts) and a side on the outline. Only turns at seams
    (known.seams) are computed; at other corners pi is written. At a seam, the turn is pi minus the sum of the interior
    angles of all parts with this corner. COVERED is written instead if the sum is at least HALF_TURN, or if an earlier
    part has a seam at the corner. corners (n, 2) [px]: corners of the parts; known, around: see inner_bits; place:
    (index of the tile, tiles per row). O(n²), plus the meetings of neighbouring tiles.
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
    """Return the index of the first corner, from `first` on, that is not collinear (its angle is below HALF_TURN).

    angles (n,) [rad]: interior angles.
    """
    while angles[first] >= HALF_TURN:
        first += 1
    return first


@subkernel
def leave_straight(parts, angles, origin, corners_out, counts_out):
    """Write the corners of a tile's parts in body space, without collinear ones. Return the number written.

    parts: TileParts; angles (n,) [rad]: interior angles; origin [px]: origin of body space in the raster; corners_out
    (n, 2) [px]; counts_out (parts,): number of corners of each part.
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
                # Differences of whole grains are exact for any origin, so each tile with this corner computes the same
                # position.
                corners_out[n, 0] = parts.corners[at, 0] - left
                corners_out[n, 1] = parts.corners[at, 1] - top
                n += 1
        counts_out[part] = n - begin
        first += count
    return n


@kernel
def survey_tile(parts, box, number, origin, survey_out):
    """Write the Survey of a tile's parts to survey_out. Return (number of rows of meetings, number of rows of corners).

    parts: TileParts; box [px]: left, top, right, bottom of the tile; number: index of the tile; origin [px]: origin of
    body space in the raster.
    """
    find_seams(parts, survey_out.angles, survey_out.seams)
    met = gather(parts.corners, survey_out, box, number, survey_out.meetings)
    return met, leave_straight(parts, survey_out.angles, origin, survey_out.corners, survey_out.counts)


@kernel
def tell_inner(parts, known, around, place, turns_out, inner_out):
    """Write which edges and corners of each part are inner, covered or blunt, as flags in the format of SHAPE.inner.

    A side shared by two parts is inner. Collinear corners are ignored: adjacent collinear sides form one edge, which is
    inner if all these sides are inner. A corner between two inner sides is covered; for other corners see
    cover_corners. A corner is blunt if the outline turns less there than the part. parts: TileParts; known, around: see
    inner_bits; place: (index of the tile, tiles per row); turns_out (n,): see cover_corners; inner_out (parts,) int64:
    the flags.
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
