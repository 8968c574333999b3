"""PixelTiles: the solid pixels of a raster in tiles of 64 x 64 that never change; what is changed is a copy of a few.

Rasters that differ in some tiles share all others: a copy of a carved terrain costs the tiles that were touched.
"""

from collections.abc import Iterable, Mapping
from functools import cache, cached_property
from typing import NamedTuple

import numpy as np

from physics.raster.bits import packed
from physics.raster.pieces import (
    MOST_NODES,
    MOST_RUNS,
    NODE,
    TILE,
    add_up,
    find_nodes,
    label_pieces,
    measure_pieces,
    pick_node,
)
from physics.tables.rows import joined

EMPTY = np.zeros(TILE, np.uint64)
EMPTY.flags.writeable = False
FULL = np.uint64(2**64 - 1)


@cache
def _room():
    """(runs, parents, nodes) that kernels write to: read before the next call."""
    return np.empty((MOST_RUNS, 3), np.int64), np.empty(MOST_RUNS, np.int64), np.empty(MOST_NODES, NODE)


class Pieces(NamedTuple):
    """What hangs together, side to side or corner to corner."""

    labels: np.ndarray  # (nodes,) number of the piece that each node is of
    counts: np.ndarray  # (pieces,) pixels
    firsts: np.ndarray  # (pieces,) first pixel in reading order: row * width + column


class PixelTiles:
    """words[tile] (64,) uint64, one word a row; tiles in reading order; nodes: see physics/raster/pieces.py."""

    def __init__(
        self, width: int, height: int, words: list[np.ndarray], nodes: np.ndarray, starts: np.ndarray | None = None
    ) -> None:
        self.width, self.height = width, height
        self.columns, self.rows = -(-width // TILE), -(-height // TILE)
        self.words, self.nodes = words, nodes
        # (tiles + 1,) where the nodes of each tile begin.
        if starts is None:
            starts = np.searchsorted(nodes["tile"], np.arange(self.columns * self.rows + 1))
        self.starts = starts

    @classmethod
    def of(cls, solid: np.ndarray) -> "PixelTiles":
        """Of solid[row, column] bool. O(pixels)."""
        height, width = solid.shape
        blank = cls(width, height, [], np.zeros(0, NODE))
        whole = np.zeros((blank.rows * TILE, blank.columns * TILE), bool)
        whole[:height, :width] = solid
        words = np.ascontiguousarray(packed(whole).reshape(blank.rows, TILE, blank.columns).transpose(0, 2, 1))
        words = words.reshape(-1, TILE)
        words.flags.writeable = False
        full = (words == FULL).all(axis=1)
        mixed = np.flatnonzero(words.any(axis=1) & ~full)
        found = [blank._full_nodes(np.flatnonzero(full)), *(blank._nodes_of(int(tile), words[tile]) for tile in mixed)]
        nodes = joined(found)
        return cls(width, height, list(words), nodes[np.argsort(nodes["tile"], kind="stable")])

    def _full_nodes(self, tiles: np.ndarray) -> np.ndarray:
        """NODE rows of tiles that are solid throughout: what find_nodes() would write."""
        nodes = np.zeros(len(tiles), NODE)
        row, column = np.divmod(tiles, self.columns)
        squares = 0
        for axis, first in (("x", column * TILE), ("y", row * TILE)):
            places = first[:, None] + np.arange(TILE)
            nodes[f"min_{axis}"], nodes[f"max_{axis}"] = first, first + TILE
            nodes[f"sum_{axis}"] = places.sum(axis=1) * TILE
            squares = squares + (places * places).sum(axis=1) * TILE
        nodes["tile"], nodes["count"], nodes["sum_squares"] = tiles, TILE * TILE, squares
        for side in ("top", "bottom", "left", "right"):
            nodes[side] = FULL
        return nodes

    def _nodes_of(self, tile: int, words: np.ndarray) -> np.ndarray:
        """NODE rows of a tile."""
        (runs, parents, nodes), (row, column) = _room(), divmod(tile, self.columns)
        return joined([nodes[: find_nodes(words, tile, column * TILE, row * TILE, runs, parents, nodes)]])

    def replaced(self, changed: Mapping[int, np.ndarray]) -> "PixelTiles":
        """With other words in some tiles. O(tiles + runs of those)."""
        words, parts, starts, last = self.words.copy(), [], self.starts.copy(), 0
        for tile, new in sorted(changed.items()):
            new.flags.writeable = False
            words[tile] = new if new.any() else EMPTY
            first, after = self.starts[tile : tile + 2].tolist()
            parts += [self.nodes[last:first], self._nodes_of(tile, new)]
            starts[tile + 1 :] += len(parts[-1]) - (after - first)
            last = after
        return PixelTiles(self.width, self.height, words, joined([*parts, self.nodes[last:]]), starts)

    @cached_property
    def pieces(self) -> Pieces:
        """What hangs together. O(nodes)."""
        labels = np.empty(len(self.nodes), np.int64)
        count = label_pieces(self.nodes, self.starts, self.columns, labels)
        counts, firsts = np.zeros(count, np.int64), np.full(count, self.width * self.height)
        measure_pieces(self.nodes, labels, self.width, counts, firsts)
        return Pieces(labels, counts, firsts)

    def words_of(self, node: int) -> np.ndarray:
        """(64,) uint64: the pixels of one node in its tile."""
        runs, parents, _ = _room()
        picked, of = np.empty(TILE, np.uint64), self.nodes[node]
        pick_node(self.words[int(of["tile"])], int(of["first"]), runs, parents, picked)
        return picked

    def node_at(self, tile: int, first: int) -> int:
        """The node that a pixel (row * 64 + column) of a tile is of."""
        begin, end = self.starts[tile : tile + 2].tolist()
        if end - begin == 1:
            return begin
        row, column = divmod(first, TILE)
        return next(node for node in range(begin, end) if int(self.words_of(node)[row]) >> column & 1)

    def cut_out(self, nodes: np.ndarray) -> tuple[np.ndarray, int, int]:
        """(solid[row, column] bool of some nodes within their bounds, left, top [px] of it)."""
        some = self.nodes[nodes]
        left, top = int(some["min_x"].min()), int(some["min_y"].min())
        first_column, first_row = left // TILE, top // TILE
        columns, rows = -(-int(some["max_x"].max()) // TILE), -(-int(some["max_y"].max()) // TILE)
        words = np.zeros((rows - first_row, TILE, columns - first_column), np.uint64)
        for node in nodes.tolist():
            row, column = divmod(int(self.nodes["tile"][node]), self.columns)
            words[row - first_row, :, column - first_column] |= self.words_of(node)
        solid = unpacked(words.reshape(-1, columns - first_column))
        x, y = first_column * TILE, first_row * TILE
        window = solid[top - y : int(some["max_y"].max()) - y, left - x : int(some["max_x"].max()) - x]
        return np.ascontiguousarray(window), left, top

    def window(self, left: int, top: int, size: int) -> np.ndarray:
        """(size, size) bool: the pixels from column left and row top on, clear beyond the raster. O(size²)."""
        column, row = left // TILE, top // TILE
        columns, rows = (left + size - 1) // TILE - column + 1, (top + size - 1) // TILE - row + 1
        near = [
            self.words[j * self.columns + i] if 0 <= j < self.rows and 0 <= i < self.columns else EMPTY
            for j in range(row, row + rows)
            for i in range(column, column + columns)
        ]
        words = np.concatenate(near).reshape(rows, columns, TILE).transpose(0, 2, 1).reshape(-1, columns)
        x, y = left - column * TILE, top - row * TILE
        return unpacked(words[y : y + size])[:, x : x + size]

    def differences(self, other: "PixelTiles", tiles: Iterable[int]) -> list[tuple[int, int, int, int]]:
        """The boxes (left, top, right, bottom), the last two exclusive, in which some tiles differ from another's."""
        found = []
        for tile in tiles:
            row, column = divmod(tile, self.columns)
            changed = self.words[tile] ^ other.words[tile]
            lines, bits = np.flatnonzero(changed), int(np.bitwise_or.reduce(changed))
            if bits:
                left, right = (bits & -bits).bit_length() - 1, bits.bit_length()
                x, y = column * TILE, row * TILE
                found.append((x + left, y + int(lines[0]), x + right, y + int(lines[-1]) + 1))
        return found

    @property
    def solid(self) -> np.ndarray:
        """solid[row, column] bool. O(pixels)."""
        return np.ascontiguousarray(unpacked(self.packed)[: self.height, : self.width])

    @property
    def packed(self) -> np.ndarray:
        """(rows * 64, columns) uint64: bit b of word k in a row is x = 64k + b. O(words)."""
        whole = np.array(self.words, np.uint64).reshape(self.rows, self.columns, TILE)
        return np.ascontiguousarray(whole.transpose(0, 2, 1)).reshape(-1, self.columns)

    @cached_property
    def _totals(self) -> list[int]:
        found = np.empty(8, np.int64)
        add_up(self.nodes, found)
        return found.tolist()

    @property
    def sums(self) -> tuple[int, int, int, int]:
        """(pixels, sums of their columns, of their rows, of the squares of both), exactly."""
        count, x, y, squares = self._totals[:4]
        return count, x, y, squares

    @property
    def bounds(self) -> tuple[int, int, int, int] | None:
        """(left, top, right, bottom) of the solid pixels in the raster, the last two exclusive; None without any."""
        if not len(self.nodes):
            return None
        left, top, right, bottom = self._totals[4:]
        return left, top, right, bottom


def unpacked(words: np.ndarray) -> np.ndarray:
    """(rows, 64 * columns) bool of (rows, columns) uint64."""
    return np.unpackbits(words.astype("<u8", copy=False).view(np.uint8), axis=1, bitorder="little").view(bool)
