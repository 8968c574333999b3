"""The outline of a mask as convex shapes: what is pushed, swept, cast and walked on meets these, and no pixels."""

import math
from collections import defaultdict
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from physics.fitting.mask_parts import Part, mask_parts
from physics.fitting.tile_seams import COVERED, HALF_TURN, corner_bits, seam_turn, turn_bits
from physics.shapes.convex import Capsule, Circle, Polygon
from physics.shapes.outline_tiles import OutlinePart, Sprite, is_tiled, tile_outlines, tiles_of
from physics.tables.shape import SHARPEST, WHOLE_MASK


def outline_of(mask: Sprite) -> tuple[OutlinePart, ...]:
    """The parts of a mask's outline, worked out once; () for a mask without pixels."""
    if "outline" not in mask.fitted:
        if is_tiled(mask):
            mask.fitted["outline"] = tuple(part for _, tile in outline_by_tile(mask) for part in tile)
        else:
            parts = mask_parts(mask.solid, mask.smooth)
            found = corner_turns(parts)
            mask.fitted["outline"] = tuple(
                _placed(part, corners, mask.origin) for part, corners in zip(parts, found, strict=True)
            )
    return mask.fitted["outline"]


def outline_by_tile(mask: Sprite) -> list[tuple[int, tuple[OutlinePart, ...]]]:
    """(number of the tile, its parts) of each tile of a mask's outline.

    Of a mask whose outline is in one piece that is (WHOLE_MASK, all parts).
    """
    if not is_tiled(mask):
        return [(WHOLE_MASK, outline_of(mask))]
    rows, columns = tiles_of(mask)
    return list(enumerate(tile_outlines(mask, range(rows * columns))))


def _placed(part, outline_turns, origin):
    """In body space, with one edge for each straight side: inner where a neighbour covers all of it."""
    turns = np.flatnonzero(np.array(_angles(part.corners)) < HALF_TURN)
    corners, inner = part.corners - np.array(origin), np.asarray(part.inner, bool)
    if len(corners) == 1:
        return OutlinePart(Circle(part.radius, tuple(corners[0].tolist())), 0)
    if len(corners) == 2:
        return OutlinePart(Capsule(tuple(corners[0].tolist()), tuple(corners[1].tolist()), part.radius), 0)
    sides = [np.take(inner, range(k, n), mode="wrap").all() for k, n in pairwise((*turns, turns[0] + len(corners)))]
    return OutlinePart(Polygon(corners[turns].tolist(), part.radius), _bits(sides, outline_turns[turns].tolist()))


def _bits(sides, turns):
    most = max((turn for turn in turns if turn <= SHARPEST), default=0.0)
    found = sum(1 << k for k, inner in enumerate(sides) if inner) | turn_bits(most)
    return found | sum(corner_bits(k, turn) for k, turn in enumerate(turns))


def corner_turns(parts: Sequence[Part]) -> list[np.ndarray]:
    """For each part, by how much the outline turns at each corner [rad]: pi where no other part meets it there.

    COVERED where parts that meet leave no corner that sticks out. Where they do leave one, the first of them that has a
    side of the outline there has it. Corners are the same where their coordinates are.
    """
    angles: defaultdict[tuple, float] = defaultdict(float)
    for part in parts:
        for point, angle in zip(map(tuple, part.corners.tolist()), _angles(part.corners), strict=True):
            angles[point] += angle
    taken, found = set(), []
    for part in parts:
        inner = np.asarray(part.inner, bool)
        at_seam = inner ^ np.roll(inner, 1)
        turns = np.where(inner & np.roll(inner, 1), COVERED, math.pi)
        for k, point in enumerate(map(tuple, part.corners.tolist())):
            if at_seam[k]:
                turns[k] = COVERED if point in taken else seam_turn(angles[point])
                taken.add(point)
        found.append(turns)
    return found


def _angles(corners):
    """The angle inside each corner of a convex outline [rad]."""
    before, after = np.roll(corners, 1, axis=0) - corners, np.roll(corners, -1, axis=0) - corners
    cross = np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])
    return np.arctan2(cross, (before * after).sum(axis=1)).tolist()
