"""PixelTiles: a raster of pixels in tiles of 64 x 64, its connected pieces, and carving (removal of pixels).

A node is an 8-connected component of the solid pixels inside one tile. A piece is an 8-connected component of all solid
pixels.
"""

import math
from collections.abc import Callable, Iterable, Mapping
from functools import cache, cached_property
from typing import NamedTuple

import numpy as np

from physics.jit import kernel, subkernel
from physics.jit.plain import word
from physics.raster.bits import either, first_run, has_bit, is_set, minus, packed, run_bits, touch
from physics.settings import MASK_TILE
from physics.tables.table import join_trees, joined, root_of

# ---- pieces ----------------------------------------------------------------------------------------------------------
# Connected components of pixels, stored per tile, so that a change to one tile needs no pass over the others.
#
# A tile is 64 x 64 pixels, one word per row. A node is an 8-connected component of the pixels inside one tile. Nodes of
# adjacent tiles that touch are linked; a piece is a connected component of linked nodes, and so of all pixels. A node
# stores its pixels along the tile's borders as four words, so that a link test takes three operations. Source: runs and
# union-find by Rosenfeld and Pfaltz 1966, "Sequential operations in digital picture processing".

TILE = MASK_TILE  # [px] per side: one word per row
MOST_RUNS = TILE * TILE // 2  # largest number of runs in a tile
MOST_NODES = TILE * TILE // 4
NODE = np.dtype(
    [  # connected pixels of one tile
        ("tile", np.int64),  # row * columns + column
        ("count", np.int64),  # [px]
        ("sum_x", np.int64),  # sums of the columns and rows of its pixels in the raster
        ("sum_y", np.int64),
        ("sum_squares", np.int64),  # sum of the squares of columns and rows
        ("first", np.int64),  # the first pixel in reading order: row * 64 + column within the tile
        ("min_x", np.int64),  # bounds in the raster; max exclusive
        ("min_y", np.int64),
        ("max_x", np.int64),
        ("max_y", np.int64),
        ("top", np.uint64),  # its pixels along the tile's borders, one bit per column or row
        ("bottom", np.uint64),
        ("left", np.uint64),
        ("right", np.uint64),
    ],
    align=True,
)


@subkernel
def trace_runs(words, runs_out, parents_out):
    """Write the runs of a tile (sequences of solid pixels in a row), and join runs that touch. Return their number.

    words (64,) uint64: pixels of the tile; runs_out (n, 3): row, start and end of each run, end exclusive; parents_out
    (n,): parent run of each run, a union-find forest. Runs that touch, also diagonally, are in one tree. O(runs).
    """
    count = 0
    above = 0
    for row in range(len(words)):
        begin = count
        rest = words[row]
        while rest != word(0):
            start, end = first_run(rest)
            rest = minus(rest, run_bits(start, end))
            runs_out[count, 0] = row
            runs_out[count, 1] = start
            runs_out[count, 2] = end
            parents_out[count] = count
            # A run of the row above that ends before this run touches no later run of this row either.
            while above < begin and runs_out[above, 2] < start:
                above += 1
            other = above
            while other < begin and runs_out[other, 1] <= end:
                join_trees(other, count, parents_out)
                other += 1
            count += 1
        above = begin
    return count


@kernel
def find_nodes(words, tile, left, top, runs_out, parents_out, nodes_out):
    """Write the nodes (8-connected components) of a tile in the order of their first pixels. Return their number.

    words (64,) uint64: pixels of the tile; tile: number of the tile; left, top [px]: position of the tile in its
    raster; runs_out (2048, 3), parents_out (2048,) int64: scratch arrays; nodes_out (1024,): NODE rows. O(runs).
    """
    count = trace_runs(words, runs_out, parents_out)
    found = 0
    for k in range(count):
        root = root_of(k, parents_out)
        row = runs_out[k, 0]
        start = runs_out[k, 1]
        end = runs_out[k, 2]
        if root == k:
            n = nodes_out[found]
            n.tile = tile
            n.count, n.sum_x, n.sum_y, n.sum_squares = 0, 0, 0, 0
            n.first = row * TILE + start
            n.min_x, n.max_x = left + start, left + end
            n.min_y, n.max_y = top + row, top + row + 1
            n.top, n.bottom, n.left, n.right = word(0), word(0), word(0), word(0)
            # The root run now holds the number of its node; later runs look it up there.
            runs_out[k, 0] = -1 - found
            found += 1
        at = -1 - runs_out[root, 0]
        n = nodes_out[at]
        size = end - start
        first = left + start
        last = left + end - 1
        y = top + row
        n.count += size
        n.sum_x += (first + last) * size // 2
        n.sum_y += y * size
        squares = last * (last + 1) * (2 * last + 1) // 6 - (first - 1) * first * (2 * first - 1) // 6
        n.sum_squares += squares + y * y * size
        n.min_x, n.max_x = min(n.min_x, first), max(n.max_x, last + 1)
        n.max_y = max(n.max_y, y + 1)
        if row == 0:
            n.top = either(n.top, run_bits(start, end))
        if row == TILE - 1:
            n.bottom = either(n.bottom, run_bits(start, end))
        if start == 0:
            n.left = either(n.left, run_bits(row, row + 1))
        if end == TILE:
            n.right = either(n.right, run_bits(row, row + 1))
    return found


@kernel
def pick_node(words, first, runs_out, parents_out, picked_out):
    """Write the pixels of one node: all pixels of a tile that are connected to pixel `first` inside the tile.

    words (64,) uint64: pixels of the tile; first: row * 64 + column; picked_out (64,) uint64: pixels of the node;
    runs_out, parents_out: scratch arrays, see find_nodes. O(runs).
    """
    count = trace_runs(words, runs_out, parents_out)
    wanted = -1
    for k in range(count):
        if runs_out[k, 0] == first // TILE and runs_out[k, 1] <= first % TILE < runs_out[k, 2]:
            wanted = root_of(k, parents_out)
    for row in range(len(words)):
        picked_out[row] = word(0)
    for k in range(count):
        if root_of(k, parents_out) == wanted:
            row = runs_out[k, 0]
            picked_out[row] = either(picked_out[row], run_bits(runs_out[k, 1], runs_out[k, 2]))


@subkernel
def link_nodes(nodes, starts, tile, other, across, down, parents_inout):
    """Join the trees of each two nodes of two adjacent tiles that touch (union-find).

    nodes: NODE rows, connected components of the tiles' pixels; starts (tiles + 1,): index of the first node of each
    tile; tile, other: numbers of the two tiles; across, down: offset from `tile` to `other`, in columns and rows of
    tiles; parents_inout (nodes,): parent of each node.
    """
    for i in range(starts[tile], starts[tile + 1]):
        a = nodes[i]
        for j in range(starts[other], starts[other + 1]):
            b = nodes[j]
            if down == 0:
                meets = touch(a.right, b.left)
            elif across == 0:
                meets = touch(a.bottom, b.top)
            elif across > 0:
                meets = has_bit(a.bottom, TILE - 1) and has_bit(b.top, 0)
            else:
                meets = has_bit(a.bottom, 0) and has_bit(b.top, TILE - 1)
            if meets:
                join_trees(i, j, parents_inout)


@kernel
def label_pieces(nodes, starts, columns, labels_out):
    """Write the number of the piece (8-connected component of all pixels) that contains each node. O(nodes).

    Return the number of pieces. Pieces are numbered from 0 in the order of their first nodes. nodes: NODE rows,
    connected components of one tile each, in the order of tiles; starts (tiles + 1,): index of the first node of each
    tile; columns: number of tiles per row; labels_out (nodes,): the piece numbers.
    """
    for k in range(len(nodes)):
        labels_out[k] = k
    tiles = len(starts) - 1
    for tile in range(tiles):
        if starts[tile] == starts[tile + 1]:
            continue
        column = tile % columns
        if column + 1 < columns:
            link_nodes(nodes, starts, tile, tile + 1, 1, 0, labels_out)
        if tile + columns < tiles:
            link_nodes(nodes, starts, tile, tile + columns, 0, 1, labels_out)
            if column + 1 < columns:
                link_nodes(nodes, starts, tile, tile + columns + 1, 1, 1, labels_out)
            if column > 0:
                link_nodes(nodes, starts, tile, tile + columns - 1, -1, 1, labels_out)
    # The parent of a node precedes the node, so the parent's piece is known. Piece numbers are stored as negative
    # values.
    found = 0
    for k in range(len(nodes)):
        if labels_out[k] == k:
            labels_out[k] = -1 - found
            found += 1
        else:
            labels_out[k] = labels_out[labels_out[k]]
    for k in range(len(nodes)):
        labels_out[k] = -1 - labels_out[k]
    return found


@kernel
def measure_pieces(nodes, labels, width, counts_inout, firsts_inout):
    """Add up the pixels of each piece, and find its first pixel in reading order. O(nodes).

    A piece consists of nodes, connected components of one tile each. nodes: NODE rows; labels (nodes,): piece of each
    node; width [px]: width of the raster; counts_inout (pieces,): increased by the number of pixels; firsts_inout
    (pieces,): lowered to row * width + column of the first pixel.
    """
    within = TILE - 1  # mask of a column within its tile
    for k in range(len(nodes)):
        n = nodes[k]
        piece = labels[k]
        x = n.min_x - (n.min_x & within) + (n.first & within)
        counts_inout[piece] += n.count
        firsts_inout[piece] = min(firsts_inout[piece], n.min_y * width + x)


@kernel
def add_up(nodes, totals_out):
    """Write eight totals over all pixels of a raster, given by its nodes, to totals_out (8,). O(nodes).

    The totals are: number of pixels, sum of columns, sum of rows, sum of column² + row², and the bounds left, top,
    right, bottom; right and bottom are exclusive. Without nodes all are 0. nodes: NODE rows.
    """
    for k in range(8):
        totals_out[k] = 0
    for k in range(len(nodes)):
        n = nodes[k]
        totals_out[0] += n.count
        totals_out[1] += n.sum_x
        totals_out[2] += n.sum_y
        totals_out[3] += n.sum_squares
        totals_out[4] = n.min_x if k == 0 else min(totals_out[4], n.min_x)
        totals_out[5] = n.min_y if k == 0 else min(totals_out[5], n.min_y)
        totals_out[6] = max(totals_out[6], n.max_x)
        totals_out[7] = max(totals_out[7], n.max_y)


# ---- pixel tiles -----------------------------------------------------------------------------------------------------
# PixelTiles: the solid pixels of a raster in immutable tiles of 64 x 64; a change copies the changed tiles.
#
# Rasters that differ in some tiles share all others. A carved copy of a terrain costs only the tiles that changed.

EMPTY = np.zeros(TILE, np.uint64)
EMPTY.flags.writeable = False
FULL = np.uint64(2**64 - 1)


@cache
def _room():
    """Return scratch arrays (runs, parents, nodes) for the kernels.

    All callers share the arrays, so a caller must copy its results before another call.
    """
    return np.empty((MOST_RUNS, 3), np.int64), np.empty(MOST_RUNS, np.int64), np.empty(MOST_NODES, NODE)


class Pieces(NamedTuple):
    """The 8-connected pieces of a raster's solid pixels."""

    labels: np.ndarray  # (nodes,) number of the piece of each node
    counts: np.ndarray  # (pieces,) number of pixels of each piece
    firsts: np.ndarray  # (pieces,) first pixel of each piece in reading order: row * width + column


class PixelTiles:
    """Pixels of a raster in tiles of 64 x 64, with the connected components inside each tile (nodes).

    words[tile] (64,) uint64: one word per row of the tile; tiles are numbered row by row. nodes: NODE rows, in the
    order of tiles. starts (tiles + 1,): index of the first node of each tile.
    """

    def __init__(
        self, width: int, height: int, words: list[np.ndarray], nodes: np.ndarray, starts: np.ndarray | None = None
    ) -> None:
        self.width, self.height = width, height
        self.columns, self.rows = -(-width // TILE), -(-height // TILE)
        self.words, self.nodes = words, nodes
        if starts is None:
            starts = np.searchsorted(nodes["tile"], np.arange(self.columns * self.rows + 1))
        self.starts = starts

    @classmethod
    def of(cls, solid: np.ndarray) -> "PixelTiles":
        """Return the PixelTiles of solid[row, column] bool. O(pixels)."""
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
        """Return the NODE rows of fully solid tiles, one for each tile number in `tiles`, as find_nodes would."""
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
        """Return the nodes (NODE rows) of one tile. tile: number of the tile; words (64,) uint64: its pixels."""
        (runs, parents, nodes), (row, column) = _room(), divmod(tile, self.columns)
        return joined([nodes[: find_nodes(words, tile, column * TILE, row * TILE, runs, parents, nodes)]])

    def replaced(self, changed: Mapping[int, np.ndarray]) -> "PixelTiles":
        """Return a copy of this raster in which some tiles have other pixels.

        changed: {tile number: (64,) uint64 words}; its arrays become read-only. O(tiles + runs of the changed tiles).
        """
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
        """The 8-connected pieces of all solid pixels, computed at the first use. O(nodes)."""
        labels = np.empty(len(self.nodes), np.int64)
        count = label_pieces(self.nodes, self.starts, self.columns, labels)
        counts, firsts = np.zeros(count, np.int64), np.full(count, self.width * self.height)
        measure_pieces(self.nodes, labels, self.width, counts, firsts)
        return Pieces(labels, counts, firsts)

    def words_of(self, node: int) -> np.ndarray:
        """Return the pixels of one node (connected component of a tile) as words of its tile, (64,) uint64."""
        runs, parents, _ = _room()
        picked, of = np.empty(TILE, np.uint64), self.nodes[node]
        pick_node(self.words[int(of["tile"])], int(of["first"]), runs, parents, picked)
        return picked

    def node_at(self, tile: int, first: int) -> int:
        """Return the index of the node (connected component of a tile) that contains a solid pixel of a tile.

        tile: number of the tile; first: row * 64 + column of the pixel.
        """
        begin, end = self.starts[tile : tile + 2].tolist()
        if end - begin == 1:
            return begin
        row, column = divmod(first, TILE)
        return next(node for node in range(begin, end) if int(self.words_of(node)[row]) >> column & 1)

    def cut_out(self, nodes: np.ndarray) -> tuple[np.ndarray, int, int]:
        """Return the pixels of the given nodes as (solid[row, column] bool, left, top).

        A node is a connected component of one tile. solid covers the bounding box of the pixels; left, top [px]:
        position of this box in the raster. nodes: indices of nodes. The raster itself is not changed.
        """
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
        """Return a square of pixels, (size, size) bool, whose first pixel is at column `left`, row `top`. O(size²).

        Pixels beyond the raster are clear.
        """
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
        """Return boxes around the pixels that differ from another raster, one box for each tile with such pixels.

        A box is (left, top, right, bottom) [px]; right and bottom are exclusive. other: a raster of the same size;
        tiles: numbers of the tiles to compare.
        """
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
        """Pixels as an array solid[row, column] bool. O(pixels)."""
        return np.ascontiguousarray(unpacked(self.packed)[: self.height, : self.width])

    @property
    def packed(self) -> np.ndarray:
        """Pixels as bits, (64 · tile rows, tile columns) uint64.

        Bit b of word k in a row is the pixel in column 64k + b. O(words).
        """
        whole = np.array(self.words, np.uint64).reshape(self.rows, self.columns, TILE)
        return np.ascontiguousarray(whole.transpose(0, 2, 1)).reshape(-1, self.columns)

    @cached_property
    def _totals(self) -> list[int]:
        found = np.empty(8, np.int64)
        add_up(self.nodes, found)
        return found.tolist()

    @property
    def sums(self) -> tuple[int, int, int, int]:
        """Integer sums over the solid pixels: (number, sum of columns, sum of rows, sum of column² + row²)."""
        count, x, y, squares = self._totals[:4]
        return count, x, y, squares

    @property
    def bounds(self) -> tuple[int, int, int, int] | None:
        """Box (left, top, right, bottom) of the solid pixels, right and bottom exclusive; None without solid pixels."""
        if not len(self.nodes):
            return None
        left, top, right, bottom = self._totals[4:]
        return left, top, right, bottom


def unpacked(words: np.ndarray) -> np.ndarray:
    """Return packed words (rows, columns) uint64 as pixels (rows, 64 * columns) bool, the inverse of bits.packed."""
    return np.unpackbits(words.astype("<u8", copy=False).view(np.uint8), axis=1, bitorder="little").view(bool)


# ---- cut -------------------------------------------------------------------------------------------------------------
# Carving: removal of pixels from tiles, and the pieces that it separates.

Tool = Callable[[np.ndarray, int, int, np.ndarray], int]  # (words, left, top, found_out) -> number of pixels found
Box = tuple[float, float, float, float]  # min_x, min_y, max_x, max_y [px]


class Loose(NamedTuple):
    """A piece that a cut separated, as an array of pixels.

    solid[row, column] bool: pixels in the bounding box of the piece; left, top [px]: position of this box in the
    raster.
    """

    solid: np.ndarray
    left: int
    top: int


class Cut(NamedTuple):
    """Result of `cut`: the remaining pixels, and the pieces that the cut separated from them."""

    tiles: PixelTiles  # the remaining pixels
    changed: tuple[int, ...]  # numbers of the tiles with other pixels than before the cut
    removed: int  # number of pixels that the tool removed
    loose: tuple[Loose, ...]  # in the order of their first pixels
    crumbs: int  # pixels of separated pieces that were too small to keep


def cut(tiles: PixelTiles, tool: Tool, box: Box, one_piece: bool, crumb: int) -> Cut:
    """Remove the pixels that a tool covers, and the pieces that this separates. Return a Cut.

    one_piece: True if only the largest of all remaining pieces stays; False if of each piece before the cut its largest
    remaining part stays. All others are separated. Of equally large ones, the one with the first pixel in reading order
    stays. The Cut lists the separated pieces, except those of fewer than `crumb` pixels. tool: function that finds the
    pixels to remove in a tile, see Tool; box [px]: bounds of the tool in the raster. O(tiles + runs of changed tiles).
    """
    changed, removed = _taken(tiles, tool, box)
    if not removed:
        return Cut(tiles, (), 0, (), 0)
    left = tiles.replaced(changed)
    pieces = left.pieces
    group = np.zeros(len(pieces.counts), np.int64) if one_piece else _pieces_before(tiles, left, changed)
    if np.bincount(group, minlength=1).max() <= 1:
        return Cut(left, tuple(changed), removed, (), 0)
    order = np.lexsort((pieces.firsts, -pieces.counts, group))
    stays = np.zeros(len(order), bool)
    stays[order[np.unique(group[order], return_index=True)[1]]] = True
    gone = np.flatnonzero(~stays)
    gone = gone[np.argsort(pieces.firsts[gone])]
    loose, crumbs, fewer = [], 0, dict[int, np.ndarray]()
    for piece in gone.tolist():
        nodes = np.flatnonzero(pieces.labels == piece)
        for node in nodes.tolist():
            tile = int(left.nodes["tile"][node])
            fewer[tile] = fewer.get(tile, left.words[tile]) & ~left.words_of(node)
        if pieces.counts[piece] < crumb:
            crumbs += int(pieces.counts[piece])
        else:
            loose.append(Loose(*left.cut_out(nodes)))
    return Cut(left.replaced(fewer), tuple(sorted({*changed, *fewer})), removed, tuple(loose), crumbs)


def _taken(tiles, tool, box):
    """Return ({tile number: words of the remaining pixels} for each changed tile, number of removed pixels).

    tool: function that finds the pixels to remove in a tile, see Tool; box [px]: bounds of the tool in the raster.
    """
    first_column, first_row = (max(0, int(each // TILE)) for each in box[:2])
    last_column, last_row = int(min(box[2] // TILE, tiles.columns - 1)), int(min(box[3] // TILE, tiles.rows - 1))
    changed, removed, found = {}, 0, np.empty(TILE, np.uint64)
    for row in range(first_row, last_row + 1):
        for column in range(first_column, last_column + 1):
            tile = row * tiles.columns + column
            words = tiles.words[tile]
            count = tool(words, column * TILE, row * TILE, found)
            if count:
                changed[tile] = words & ~found
                removed += count
    return changed, removed


def _pieces_before(before, after, changed):
    """Return, for each piece after a cut, the number of the piece that contained it before: (pieces,) int64.

    before, after: PixelTiles; changed: numbers of the tiles that the cut changed.
    """
    labels, parts, last = before.pieces.labels, [], 0
    for tile in sorted(changed):
        # The nodes of unchanged tiles are the same, in the same order.
        parts.append(labels[last : before.starts[tile]])
        firsts = after.nodes["first"][after.starts[tile] : after.starts[tile + 1]].tolist()
        parts.append(np.array([labels[before.node_at(tile, first)] for first in firsts], np.int64))
        last = before.starts[tile + 1]
    old = np.concatenate([*parts, labels[last:]])
    group = np.empty(len(after.pieces.counts), np.int64)
    group[after.pieces.labels] = old
    return group


# ---- erase -----------------------------------------------------------------------------------------------------------
# Pixels of a tile that a tool removes: their centres are in a convex shape, or in the pixel squares of another mask.


@subkernel
def is_in_hull(corners, radius, x, y):
    """Return whether point (x, y) [px] is inside or on the boundary of a convex hull rounded by a radius [px].

    corners (n, 2) [px], n >= 1, clockwise on the screen.
    """
    inside = len(corners) > 2
    least = math.inf
    for k in range(len(corners)):
        ax = corners[k, 0]
        ay = corners[k, 1]
        following = k + 1 if k + 1 < len(corners) else 0
        dx = corners[following, 0] - ax
        dy = corners[following, 1] - ay
        px, py = x - ax, y - ay
        inside = inside and dx * py - dy * px >= 0.0
        size = dx * dx + dy * dy
        along = min(1.0, max(0.0, (px * dx + py * dy) / size)) if size > 0.0 else 0.0
        px -= along * dx
        py -= along * dy
        least = min(least, px * px + py * py)
    return inside or least <= radius * radius


@kernel
def find_in_hull(words, left, top, corners, radius, found_out):
    """Find the solid pixels of a tile whose centres are in a rounded convex hull. Return their number.

    words (64,) uint64: pixels of the tile, one bit each; found_out (64,) uint64: the found pixels in the same form;
    left, top [px]: position of the tile in the hull's coordinate system; corners (n, 2) [px], n >= 1, clockwise on the
    screen; radius [px]: rounding of the hull. O(pixels within the hull's box · n).
    """
    min_x, max_x = math.inf, -math.inf
    min_y, max_y = math.inf, -math.inf
    for k in range(len(corners)):
        min_x = min(min_x, corners[k, 0])
        max_x = max(max_x, corners[k, 0])
        min_y = min(min_y, corners[k, 1])
        max_y = max(max_y, corners[k, 1])
    begin = max(0, math.floor(min(min_x - radius - left, float(TILE))))
    end = min(TILE, math.ceil(max(max_x + radius - left, 0.0)))
    upper = max(0, math.floor(min(min_y - radius - top, float(TILE))))
    lower = min(TILE, math.ceil(max(max_y + radius - top, 0.0)))
    count = 0
    for row in range(TILE):
        found_out[row] = word(0)
    for row in range(upper, lower):
        for column in range(begin, end):
            if is_set(words, row, column) and is_in_hull(corners, radius, left + column + 0.5, top + row + 0.5):
                found_out[row] = either(found_out[row], run_bits(column, column + 1))
                count += 1
    return count


@subkernel
def is_in_pixels(solid, x, y):
    """Return whether point (x, y) [px] is inside or on the boundary of a solid pixel of solid[row, column] bool."""
    column, row = math.floor(x), math.floor(y)
    for j in range(row - 1 if y == row else row, row + 1):
        for i in range(column - 1 if x == column else column, column + 1):
            if 0 <= j < solid.shape[0] and 0 <= i < solid.shape[1] and solid[j, i]:
                return True
    return False


@kernel
def find_in_pixels(words, solid, x, y, cosine, sine, found_out):
    """Find the solid pixels of a tile whose centres are in solid pixels of another mask. Return their number.

    words (64,) uint64: pixels of the tile, one bit each; found_out (64,) uint64: the found pixels in the same form;
    solid[row, column] bool: pixels of the other mask; x, y [px]: top left corner of the tile in the other mask's
    raster; cosine, sine: cosine and sine of the tile's angle in that raster. O(pixels of the tile).
    """
    count = 0
    for row in range(TILE):
        found_out[row] = word(0)
        rest = words[row]
        while rest != word(0):
            start, end = first_run(rest)
            rest = minus(rest, run_bits(start, end))
            for column in range(start, end):
                u = x + cosine * (column + 0.5) - sine * (row + 0.5)
                v = y + sine * (column + 0.5) + cosine * (row + 0.5)
                if is_in_pixels(solid, u, v):
                    found_out[row] = either(found_out[row], run_bits(column, column + 1))
                    count += 1
    return count
