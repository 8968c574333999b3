"""Outline of a pixel mask as convex shapes, for the whole mask or tile by tile; chains for a one-way mask."""

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
# Tiled outline of a large mask: carving recomputes only the tiles that it touches.
#
# A tile is a square of MASK_TILE pixels per side. Tiles are numbered row by row from the mask's top left pixel. Results
# per tile are cached in `fitted`. A mask that differs from another in a few pixels reuses the other's tiles
# (keep_tiles).

Box = tuple[int, int, int, int]  # left, top, right, bottom [px]


class Sprite(Protocol):
    """The part of PixelMask's interface that this file uses."""

    @property
    def solid(self) -> np.ndarray: ...  # bool [row, col]
    @property
    def size(self) -> tuple[int, int]: ...  # [px]
    @property
    def area(self) -> int: ...  # number of solid pixels
    @property
    def origin(self) -> tuple[float, float]: ...
    @property
    def smooth(self) -> float: ...

    fitted: dict[Any, Any]  # cached results

    def window(self, left: int, top: int, size: int) -> np.ndarray: ...  # (size, size) bool, clear outside the mask


class OutlinePart(NamedTuple):
    """Convex part of an outline in body space, with flags for its sides and corners that are not on the outline."""

    shape: Circle | Capsule | Polygon
    inner: int  # flags in the format of the column `inner` of SHAPE


class Tile:
    """Part of a mask's outline in one square tile of the mask.

    The outline depends on the pixels of the tile, and on pixels up to HALO px around the tile.
    """

    def __init__(self, mask: Sprite, number: int) -> None:
        down, across = divmod(number, tiles_of(mask)[1])
        self.number, self.at = number, (across * MASK_TILE, down * MASK_TILE)
        self.origin = (mask.origin[0], mask.origin[1])
        window = mask.window(self.at[0] - HALO, self.at[1] - HALO, MASK_TILE + 2 * HALO)
        self.parts = tile_parts(window, mask.smooth, self.at)  # in raster pixels

    def has_parts_of(self, other: "Tile") -> bool:
        """Return whether this tile and another one have the same parts, bit for bit."""
        return all(mine.tobytes() == its.tobytes() for mine, its in zip(self.parts, other.parts, strict=True))

    @cached_property
    def known(self) -> Survey:
        return survey(self.parts, self.at, MASK_TILE, self.number, self.origin)

    @cached_property
    def shapes(self) -> list[Polygon]:
        return polygons(self.known.corners, self.known.counts)


def polygons(corners: np.ndarray, counts: np.ndarray, which: np.ndarray | None = None) -> list[Polygon]:
    """Return a Polygon for each list of corners.

    corners (n, 2) [px]: corners of all polygons, one polygon after another; counts (k,): number of corners of each
    polygon; which: indices of the polygons to return, None for all.
    """
    points, ends = corners.tolist(), [0, *np.cumsum(counts).tolist()]
    some = range(len(counts)) if which is None else which.tolist()
    return [Polygon.known(points[ends[k] : ends[k + 1]]) for k in some]


class TiledParts(NamedTuple):
    """Convex parts of one or more tiles of an outline in body space, one tile after another."""

    corners: np.ndarray  # (n, 2) float64 [px]: corners part after part, clockwise on the screen
    counts: np.ndarray  # (k,) int64: number of corners of each part
    inner: np.ndarray  # (k,) int64, flags in the format of the column `inner` of SHAPE
    tiles: np.ndarray  # (k,) int64: number of the tile that contains the part


def is_tiled(mask: Sprite) -> bool:
    """Return whether the outline of a mask is computed and stored in tiles.

    This is the case if a side of the mask exceeds LARGE_MASK px and not all of its pixels are solid.
    """
    width, height = mask.size
    return max(width, height) > LARGE_MASK and mask.area < width * height


def tiles_of(mask: Sprite) -> tuple[int, int]:
    """Return (number of rows, number of columns) of a mask's tiles."""
    width, height = mask.size
    return -(-height // MASK_TILE), -(-width // MASK_TILE)


def tile_outlines(mask: Sprite, numbers: Sequence[int]) -> list[tuple[OutlinePart, ...]]:
    """Return the outline parts of each tile in `numbers`; () for an empty tile. Tiles are numbered row by row."""
    found = zip(_tiles(mask, numbers), _inner(mask, numbers), strict=True)
    return [tuple(map(OutlinePart, tile.shapes, inner.tolist())) for tile, inner in found]


def tiled_parts(mask: Sprite, numbers: Sequence[int]) -> TiledParts:
    """Return the outline parts of the tiles in `numbers` as arrays, in the order of `numbers`."""
    tiles, inner = _tiles(mask, numbers), _inner(mask, numbers)
    return TiledParts(
        np.concatenate([each.known.corners for each in tiles]),
        np.concatenate([each.known.counts for each in tiles]),
        np.concatenate(inner),
        np.repeat(numbers, [len(each) for each in inner]),
    )


def keep_tiles(mask: Sprite, old: Sprite, boxes: Iterable[Box]) -> list[int]:
    """Copy the cached outline tiles of the mask `old` to `mask`, and recompute the tiles near changed pixels.

    Return the sorted numbers of the tiles whose outline may have changed: tiles with other parts, and their neighbours
    if corners on the common border changed. Both masks have the same size, origin and smooth; `old` may be the mask
    itself after a change of its pixels. boxes: rectangles (left, top, right, bottom) [px] in the raster that contain
    all changes, right and bottom exclusive. Only tiles within HALO px of a box are recomputed.
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


KEPT = ("tiles", "inner")  # lists in `fitted`, by tile number: the Tile, and `inner` of its parts; None: not computed


def _known(mask, name) -> list:
    if name not in mask.fitted:
        rows, columns = tiles_of(mask)
        mask.fitted[name] = [None] * (rows * columns)
    return mask.fitted[name]


def _tiles(mask, numbers) -> list[Tile]:
    """Return the Tile for each tile number. A Tile is computed when it is first requested."""
    known = _known(mask, "tiles")
    for number in numbers:
        if known[number] is None:
            known[number] = Tile(mask, number)
    return [known[number] for number in numbers]


def _inner(mask, numbers) -> list[np.ndarray]:
    """Return, for each tile number, the SHAPE.inner flags of the tile's parts: sides and corners not on the outline.

    The flags of a tile are computed when they are first requested.
    """
    known, (rows, columns) = _known(mask, "inner"), tiles_of(mask)
    missing = [number for number in numbers if known[number] is None]
    if missing:
        near = sorted(set[int]().union(*(_near(number, rows, columns) for number in missing)))
        around = np.concatenate([each.known.meetings for each in _tiles(mask, near)])
        for tile in _tiles(mask, missing):
            known[tile.number] = inner_bits(tile.parts, tile.known, around, tile.number, columns)
    return [known[number] for number in numbers]


def _near(number, rows, columns):
    """Return the numbers of a tile and its up to 8 neighbours, ascending. rows, columns: size of the mask in tiles."""
    row, column = divmod(number, columns)
    across = range(max(column - 1, 0), min(column + 2, columns))
    return [y * columns + x for y in range(max(row - 1, 0), min(row + 2, rows)) for x in across]


# ---- outline ---------------------------------------------------------------------------------------------------------
# Outline of a mask as convex shapes, for response, sweeps, casts and characters.


def outline_of(mask: Sprite) -> tuple[OutlinePart, ...]:
    """Return the convex parts of a mask's outline; () for a mask without solid pixels.

    The parts are computed at the first call.
    """
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
    """Return [(tile number, outline parts)] for all tiles of a mask; without tiles, [(WHOLE_MASK, all parts)]."""
    if not is_tiled(mask):
        return [(WHOLE_MASK, outline_of(mask))]
    rows, columns = tiles_of(mask)
    return list(enumerate(tile_outlines(mask, range(rows * columns))))


def _placed(part, outline_turns, origin):
    """Return a Part in raster pixels as an OutlinePart in body space, with collinear sides merged.

    A merged side is inner (not on the outline) if all sides merged into it are inner. outline_turns [rad]: turns of the
    outline at the corners, see corner_turns; origin [px]: origin of body space in the raster.
    """
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
    """Return the turn [rad] of the outline at each corner of each part: one array (corners,) for each part.

    A side shared by two parts is inner; all other sides are on the outline. There are three cases. At a corner between
    two sides on the outline, the result is pi. At a corner between two inner sides, it is COVERED. At any other corner,
    the interior angles of all parts with this corner (equal coordinates) are summed. The first of these parts gets pi
    minus the sum, or COVERED if the outline is not convex there. The other parts get COVERED.
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
    """Return the interior angle [rad] at each corner of a convex polygon, corners (n, 2)."""
    before, after = np.roll(corners, 1, axis=0) - corners, np.roll(corners, -1, axis=0) - corners
    cross = np.abs(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0])
    return np.arctan2(cross, (before * after).sum(axis=1)).tolist()


# ---- surface ---------------------------------------------------------------------------------------------------------
# Upper side of a one-way mask as chains, which replace the mask's convex parts in collisions.


class Stretch(NamedTuple):
    """One chain along the upper side of a one-way mask, in body space."""

    shape: Chain
    inner: int = 0  # flags as in OutlinePart; 0: no link lies inside the outline


def surfaces_of(mask: Sprite) -> tuple[Stretch, ...]:
    """Return chains in body space along the upper side of a mask's outline; () for a mask without solid pixels.

    A chain leads from left to right along consecutive sides of the outline whose outward normals point upwards. The
    floors of holes are included. A chain ends at a vertical side or an underside. A vertical step of at most `smooth`
    [px] between two upper sides is replaced by its middle point. So characters do not catch on it. The outline is the
    result of outline.contour.outline. O(pixels) at the first call, then cached.
    """
    if "surfaces" not in mask.fitted:
        rings = [ring for piece in outline(mask.solid, mask.smooth) for ring in (piece.outer, *piece.holes)]
        runs = [run - np.array(mask.origin) for ring in rings for run in _runs(_joined(ring, mask.smooth))]
        mask.fitted["surfaces"] = tuple(Stretch(Chain(run.tolist())) for run in runs)
    return mask.fitted["surfaces"]


def _joined(ring, most):
    """Return a closed outline with each short vertical step between two upper sides replaced by its middle point.

    ring (n, 2) [px]: corners of the outline; most [px]: greatest height of a short step. Upper sides lead to the right.
    """
    way = np.roll(ring, -1, axis=0) - ring
    right = way[:, 0] > 0.0
    step = (way[:, 0] == 0.0) & (np.abs(way[:, 1]) <= most) & np.roll(right, 1) & np.roll(right, -1)
    middle = np.where(step[:, None], ring + 0.5 * way, ring)
    return middle[~np.roll(step, 1)]


def _runs(ring):
    """Return the upper sides of a closed outline as arrays of connected points, (k, 2) [px] each.

    ring (n, 2) [px]: corners of the outline, with the solid on its right. Upper sides therefore lead to the right.
    """
    right = np.roll(ring[:, 0], -1) > ring[:, 0]
    first = int(np.flatnonzero(~right)[0])  # start at a side that does not lead right, so that no run crosses the start
    ring, right = np.roll(ring, -first, axis=0), np.roll(right, -first)
    closed = np.concatenate([ring, ring[:1]])
    turns = np.flatnonzero(np.diff(right.astype(np.int8), prepend=0, append=0))
    return [closed[start : end + 1] for start, end in pairwise(turns.tolist()) if right[start]]
