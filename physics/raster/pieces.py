"""Connected pieces of pixels, kept tile by tile: what a change to one tile parts is known without reading the others.

A tile is 64 x 64 pixels, one word a row. What hangs together within it, side to side or corner to corner, is a node;
nodes of neighbouring tiles that touch are linked. Pieces are what links hold together. A node knows its pixels along
the four borders as words, so that a link is three operations. Source: runs and union-find by Rosenfeld and Pfaltz
1966, "Sequential operations in digital picture processing".
"""

import numpy as np

from physics.jit import kernel, subkernel, word
from physics.raster.bits import either, first_run, has_bit, minus, run_bits, touch
from physics.settings import MASK_TILE

TILE = MASK_TILE  # [px] a side: one word a row
MOST_RUNS = TILE * TILE // 2  # in one tile
MOST_NODES = TILE * TILE // 4
NODE = np.dtype(
    [  # pixels of one tile that hang together
        ("tile", np.int64),  # row * columns + column
        ("count", np.int64),  # [px]
        ("sum_x", np.int64),  # of the columns and rows of its pixels in the raster
        ("sum_y", np.int64),
        ("sum_squares", np.int64),  # of columns and of rows
        ("first", np.int64),  # the first pixel in reading order: row * 64 + column within the tile
        ("min_x", np.int64),  # bounds in the raster; max exclusive
        ("min_y", np.int64),
        ("max_x", np.int64),
        ("max_y", np.int64),
        ("top", np.uint64),  # its pixels along the borders, by column or row
        ("bottom", np.uint64),
        ("left", np.uint64),
        ("right", np.uint64),
    ],
    align=True,
)


@subkernel
def root_of(k, parents_inout):
    """The root of k in a forest, whose paths are halved."""
    while parents_inout[k] != k:
        parents_inout[k] = parents_inout[parents_inout[k]]
        k = parents_inout[k]
    return k


@subkernel
def join(a, b, parents_inout):
    """Join two trees of a forest; the root is the earlier one."""
    a = root_of(a, parents_inout)
    b = root_of(b, parents_inout)
    parents_inout[max(a, b)] = min(a, b)


@subkernel
def trace_runs(words, runs_out, parents_out):
    """Write (row, start, end) of the runs of a tile's pixels, and the forest of those that touch. Returns how many.

    words (64,) uint64. O(runs).
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
            # Those above that end before it touch no later one either.
            while above < begin and runs_out[above, 2] < start:
                above += 1
            other = above
            while other < begin and runs_out[other, 1] <= end:
                join(other, count, parents_out)
                other += 1
            count += 1
        above = begin
    return count


@kernel
def find_nodes(
    # read
    words,
    tile,
    left,
    top,
    # write
    runs_out,
    parents_out,
    nodes_out,
):
    """Write the nodes of a tile in the order of their first pixels. Returns how many.

    words (64,) uint64; left, top [px] of the tile in its raster; runs_out (2048, 3), parents_out (2048,) int64: room
    for the work; nodes_out (1024,) NODE. O(runs).
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
            # From here on the run says which node it is of: later ones look it up at their root.
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
def pick_node(
    # read
    words,
    first,
    # write
    runs_out,
    parents_out,
    picked_out,
):
    """Write the pixels of a tile that hang together with its pixel `first` (row * 64 + column).

    words, picked_out (64,) uint64; runs_out, parents_out as find_nodes. O(runs).
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
    """Join the nodes of a tile with those of another, which lies across columns and down rows from it."""
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
                join(i, j, parents_inout)


@kernel
def label_pieces(
    # read
    nodes,
    starts,
    columns,
    # write
    labels_out,
):
    """Write the number of the piece of each node, from 0 in the order of their first nodes. Returns how many there are.

    nodes NODE in the order of tiles, starts (tiles + 1,) where those of each tile begin; columns: tiles in a row.
    O(nodes).
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
    # The parent of a node is an earlier one, whose number is known by then; numbers are told by their sign.
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
def measure_pieces(
    # read
    nodes,
    labels,
    width,
    # write
    counts_inout,
    firsts_inout,
):
    """Add up the pixels of pieces (pieces,), and lower their first pixels (row * width + column) to their nodes'.

    nodes NODE, labels (nodes,) the piece of each; width [px] of the raster. O(nodes).
    """
    within = TILE - 1  # the bits of a column in its tile
    for k in range(len(nodes)):
        n = nodes[k]
        piece = labels[k]
        x = n.min_x - (n.min_x & within) + (n.first & within)
        counts_inout[piece] += n.count
        firsts_inout[piece] = min(firsts_inout[piece], n.min_y * width + x)


@kernel
def add_up(nodes, totals_out):
    """Write pixels, sums of columns, of rows, of the squares of both, and left, top, right, bottom of all nodes (NODE);
    the last four are 0 without any. O(nodes)."""
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
