"""The outline of a large mask tile by tile, so that where it is carved only the tiles touched are made anew.

Tiles lie at multiples of MASK_TILE pixels from the mask's first pixel, row by row. What has been made of a tile is kept
in `fitted`, and taken over by a mask that differs from this one in a few pixels (keep_tiles).
"""

from collections.abc import Iterable, Sequence
from functools import cached_property
from itertools import product
from typing import Any, NamedTuple, Protocol

import numpy as np

from physics.fitting.tile_parts import HALO, tile_parts
from physics.fitting.tile_seams import NOBODY, Survey, inner_bits, movings, survey
from physics.settings import LARGE_MASK, MASK_TILE
from physics.shapes.convex import Capsule, Circle, Polygon

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
