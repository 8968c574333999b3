"""Pixels taken out of tiles, and what comes loose by it."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from physics.raster.pieces import TILE
from physics.raster.pixel_tiles import PixelTiles

Tool = Callable[[np.ndarray, int, int, np.ndarray], int]  # (words, left, top, found_out) -> how many are found
Box = tuple[float, float, float, float]  # min_x, min_y, max_x, max_y [px]


class Loose(NamedTuple):
    """A piece that came loose: solid[row, column] bool within its bounds, and where these begin in the raster [px]."""

    solid: np.ndarray
    left: int
    top: int


class Cut(NamedTuple):
    """What a tool did."""

    tiles: PixelTiles  # what is left
    changed: tuple[int, ...]  # numbers of the tiles that differ
    removed: int  # pixels that the tool took
    loose: tuple[Loose, ...]  # in the order of their first pixels
    crumbs: int  # pixels of pieces that were too small to come loose


def cut(tiles: PixelTiles, tool: Tool, box: Box, one_piece: bool, crumb: int) -> Cut:
    """Take out the pixels that a tool finds within its box [px, of the raster], and what hangs on nothing then.

    one_piece: only the largest piece stays; else the largest of each piece that was there before, so that what was
    apart stays. Of pieces of one size the one with the first pixel. Those of less than `crumb` pixels are gone.
    O(tiles + runs of those that change).
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
    """({tile: its words without what the tool finds}, how many pixels it found)."""
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
    """(pieces,): the number of the piece before that each piece after is of."""
    labels, parts, last = before.pieces.labels, [], 0
    for tile in sorted(changed):
        # The nodes of the other tiles are those that were there, in the same order.
        parts.append(labels[last : before.starts[tile]])
        firsts = after.nodes["first"][after.starts[tile] : after.starts[tile + 1]].tolist()
        parts.append(np.array([labels[before.node_at(tile, first)] for first in firsts], np.int64))
        last = before.starts[tile + 1]
    old = np.concatenate([*parts, labels[last:]])
    group = np.empty(len(after.pieces.counts), np.int64)
    group[after.pieces.labels] = old
    return group
