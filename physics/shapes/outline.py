"""The outline of a mask as convex shapes, whole or tile by tile, and its upper side where it is one-way."""

import math
from collections import defaultdict
from collections.abc import Iterable, Sequence
from functools import cached_property
from itertools import pairwise, product
from typing import Any, NamedTuple, Protocol

import numpy as np

from physics.outline.contour import outline
from physics.outline.mask_parts import Part, mask_parts
from physics.outline.tile_seams import (
    COVERED,
    HALF_TURN,
    NOBODY,
    Survey,
    corner_bits,
    inner_bits,
    movings,
    seam_turn,
    survey,
    turn_bits,
)
from physics.outline.tiled import HALO, tile_parts
from physics.settings import LARGE_MASK, MASK_TILE
from physics.shapes.values import Capsule, Chain, Circle, Polygon
from physics.tables.shape import SHARPEST, WHOLE_MASK

# ---- outline tiles ---------------------------------------------------------------------------------------------------
# The outline of a large mask tile by tile, so that where it is carved only the tiles touched are made anew.
#
# Tiles lie at multiples of MASK_TILE pixels from the mask's first pixel, row by row. What has been made of a tile is
# kept in `fitted`, and taken over by a mask that differs from this one in a few pixels (keep_tiles).

Box = tuple[int, int, int, int]  # left, top, right, bottom [px]


class Sprite(Protocol):
    """What an outline is taken of: shapes.mask.PixelMask has it."""

    @property
    def solid(self) -> np.ndarray: ...  # bool [row, col]
    @property
    def size(self) -> tuple[int, int]: ...  # [px]
    @property
    def area(self) -> int: ...  # solid pixels
    @property
    def origin(self) -> tuple[float, float]: ...
    @property
    def smooth(self) -> float: ...

    fitted: dict[Any, Any]  # what has been worked out

    def window(self, left: int, top: int, size: int) -> np.ndarray: ...  # (size, size) bool, clear beyond the mask


class OutlinePart(NamedTuple):
    """A convex part of an outline in body space, and what of it lies inside the outline."""

    shape: Circle | Capsule | Polygon
    inner: int  # as in SHAPE


class Tile:
    """What one tile has of an outline, whatever lies around it but for a halo of pixels."""

    def __init__(self, mask: Sprite, number: int) -> None:
        down, across = divmod(number, tiles_of(mask)[1])
        self.number, self.at = number, (across * MASK_TILE, down * MASK_TILE)
        self.origin = (mask.origin[0], mask.origin[1])
        window = mask.window(self.at[0] - HALO, self.at[1] - HALO, MASK_TILE + 2 * HALO)
        self.parts = tile_parts(window, mask.smooth, self.at)  # in raster pixels

    def has_parts_of(self, other: "Tile") -> bool:
        """Whether its parts are those of another, to the bit."""
        return all(mine.tobytes() == its.tobytes() for mine, its in zip(self.parts, other.parts, strict=True))

    @cached_property
    def known(self) -> Survey:
        return survey(self.parts, self.at, MASK_TILE, self.number, self.origin)

    @cached_property
    def shapes(self) -> list[Polygon]:
        return polygons(self.known.corners, self.known.counts)


def polygons(corners: np.ndarray, counts: np.ndarray, which: np.ndarray | None = None) -> list[Polygon]:
    """Polygons of corners (n, 2), one after another, of which each has (k,) counts; which: some of these, None: all."""
    points, ends = corners.tolist(), [0, *np.cumsum(counts).tolist()]
    some = range(len(counts)) if which is None else which.tolist()
    return [Polygon.known(points[ends[k] : ends[k + 1]]) for k in some]


class TiledParts(NamedTuple):
    """The parts of some tiles, one after another, in body space."""

    corners: np.ndarray  # (n, 2) float64 [px], of each part clockwise on the screen
    counts: np.ndarray  # (k,) int64: corners of each part
    inner: np.ndarray  # (k,) int64, as in SHAPE
    tiles: np.ndarray  # (k,) int64: the number of the tile


def is_tiled(mask: Sprite) -> bool:
    """Whether a mask's outline is made of tiles: a large one's, unless that is a full rectangle."""
    width, height = mask.size
    return max(width, height) > LARGE_MASK and mask.area < width * height


def tiles_of(mask: Sprite) -> tuple[int, int]:
    """How many rows and columns of tiles a mask has."""
    width, height = mask.size
    return -(-height // MASK_TILE), -(-width // MASK_TILE)


def tile_outlines(mask: Sprite, numbers: Sequence[int]) -> list[tuple[OutlinePart, ...]]:
    """The parts of a mask's outline in each of some tiles, which count row by row; () of an empty tile."""
    found = zip(_tiles(mask, numbers), _inner(mask, numbers), strict=True)
    return [tuple(map(OutlinePart, tile.shapes, inner.tolist())) for tile, inner in found]


def tiled_parts(mask: Sprite, numbers: Sequence[int]) -> TiledParts:
    """The same of one or more tiles, in their order, in arrays."""
    tiles, inner = _tiles(mask, numbers), _inner(mask, numbers)
    return TiledParts(
        np.concatenate([each.known.corners for each in tiles]),
        np.concatenate([each.known.counts for each in tiles]),
        np.concatenate(inner),
        np.repeat(numbers, [len(each) for each in inner]),
    )


def keep_tiles(mask: Sprite, old: Sprite, boxes: Iterable[Box]) -> list[int]:
    """Take over what has been made of tiles from a mask that differs in pixels within some boxes only.

    Both have the same size, origin and smooth; old may be the mask itself, its pixels changed; boxes: left, top, right,
    bottom [px] in the raster, the last two exclusive. Only tiles within HALO of those pixels are worked out anew.
    Returns the numbers of all whose outline may differ now, in their order: those that came out otherwise, and the
    ones around them where their corners on the border changed.
    """
    tiles, inner = (_known(old, name).copy() for name in KEPT)
    mask.fitted.update(tiles=tiles, inner=inner)
    mask.fitted.pop("outline", None)
    rows, columns = tiles_of(mask)
    near, changed = set[int](), set[int]()
    for left, top, right, bottom in boxes:
        down = range(max((top - HALO) // MASK_TILE, 0), min((bottom - 1 + HALO) // MASK_TILE + 1, rows))
        across = range(max((left - HALO) // MASK_TILE, 0), min((right - 1 + HALO) // MASK_TILE + 1, columns))
        near.update(row * columns + column for row, column in product(down, across))
    for number in near:
        before, after = tiles[number], Tile(mask, number)
        if before is not None and after.has_parts_of(before):
            continue
        tiles[number] = after
        changed.add(number)
        known = NOBODY if before is None else before.known.meetings
        moved = movings(known, after.known.meetings, *divmod(number, columns), MASK_TILE)
        changed.update(y * columns + x for y, x in moved if 0 <= y < rows and 0 <= x < columns)
    for number in changed:
        inner[number] = None
    return sorted(changed)


KEPT = ("tiles", "inner")  # what is known of tiles, by number: Tile, and `inner` of its parts; else None


def _known(mask, name) -> list:
    if name not in mask.fitted:
        rows, columns = tiles_of(mask)
        mask.fitted[name] = [None] * (rows * columns)
    return mask.fitted[name]


def _tiles(mask, numbers) -> list[Tile]:
    """What some tiles have of the outline, worked out once."""
    known = _known(mask, "tiles")
    for number in numbers:
        if known[number] is None:
            known[number] = Tile(mask, number)
    return [known[number] for number in numbers]


def _inner(mask, numbers) -> list[np.ndarray]:
    """What of the parts of some tiles lies inside the outline, as in SHAPE, worked out once."""
    known, (rows, columns) = _known(mask, "inner"), tiles_of(mask)
    missing = [number for number in numbers if known[number] is None]
    if missing:
        near = sorted(set[int]().union(*(_near(number, rows, columns) for number in missing)))
        around = np.concatenate([each.known.meetings for each in _tiles(mask, near)])
        for tile in _tiles(mask, missing):
            known[tile.number] = inner_bits(tile.parts, tile.known, around, tile.number, columns)
    return [known[number] for number in numbers]


def _near(number, rows, columns):
    """A tile and those around it, of those there are, in their order."""
    row, column = divmod(number, columns)
    across = range(max(column - 1, 0), min(column + 2, columns))
    return [y * columns + x for y in range(max(row - 1, 0), min(row + 2, rows)) for x in across]


# ---- outline ---------------------------------------------------------------------------------------------------------
# The outline of a mask as convex shapes: what is pushed, swept, cast and walked on meets these, and no pixels.


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


# ---- surface ---------------------------------------------------------------------------------------------------------
# The upper side of a mask that is open from below: what stands on it meets these chains, and no convex parts.


class Stretch(NamedTuple):
    """A stretch of an upper side in body space."""

    shape: Chain
    inner: int = 0  # as OutlinePart's: no line lies inside


def surfaces_of(mask: Sprite) -> tuple[Stretch, ...]:
    """Chains in body space along the upper side of a mask's outline, worked out once; () for a mask without pixels.

    Each is a run of the outline's lines that lead to the right, from its left end to its right one: all whose outward
    normals point upwards in the mask's own space, floors of holes among them. Vertical lines and undersides are no part
    of them, and part runs from one another; but steps of at most `smooth` [px], where two lines miss each other, are
    joined in their middle: nobody stumbles over them. The outline as in fitting.outline; O(pixels).
    """
    if "surfaces" not in mask.fitted:
        rings = [ring for piece in outline(mask.solid, mask.smooth) for ring in (piece.outer, *piece.holes)]
        runs = [run - np.array(mask.origin) for ring in rings for run in _runs(_joined(ring, mask.smooth))]
        mask.fitted["surfaces"] = tuple(Stretch(Chain(run.tolist())) for run in runs)
    return mask.fitted["surfaces"]


def _joined(ring, most):
    """A ring without the steps of at most so many px between two lines that lead to the right."""
    way = np.roll(ring, -1, axis=0) - ring
    right = way[:, 0] > 0.0
    step = (way[:, 0] == 0.0) & (np.abs(way[:, 1]) <= most) & np.roll(right, 1) & np.roll(right, -1)
    middle = np.where(step[:, None], ring + 0.5 * way, ring)
    return middle[~np.roll(step, 1)]


def _runs(ring):
    """Points of the stretches of a ring, its inside to the right, that lead to the right [px]."""
    right = np.roll(ring[:, 0], -1) > ring[:, 0]
    first = int(np.flatnonzero(~right)[0])  # what leads back: no stretch goes over it
    ring, right = np.roll(ring, -first, axis=0), np.roll(right, -first)
    closed = np.concatenate([ring, ring[:1]])
    turns = np.flatnonzero(np.diff(right.astype(np.int8), prepend=0, append=0))
    return [closed[start : end + 1] for start, end in pairwise(turns.tolist()) if right[start]]
