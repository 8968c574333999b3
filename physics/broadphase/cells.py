"""The cells of a hashed hierarchy of grids: which of them a box touches, who is in them, who meets whom there.

See spatial_hash.py for what a grid keeps, and the sources.
"""

import math

import numpy as np

from physics.jit import kernel, subkernel
from physics.tables.counters import CELLS_TOUCHED, REINSERTS

LEVELS = 24  # cell sizes base · 2^0 … 2^23; level 24 is the list of what fits nowhere
CELL_RANGE = 1e9  # cells from the origin up to which coordinates are hashed exactly in 64 bits
ENTRY = np.dtype(
    [
        ("lower_x", np.float64),
        ("lower_y", np.float64),
        ("upper_x", np.float64),
        ("upper_y", np.float64),
        ("cell_x", np.int64),
        ("cell_y", np.int64),
        ("next", np.int64),
        ("level", np.int64),
        ("bucket", np.int64),
        ("previous", np.int64),
    ],
    align=True,
)


@subkernel
def cell_of(coordinate, inverse_size):
    """The cell a coordinate [px] lies in."""
    return math.floor(coordinate * inverse_size)


@subkernel
def bucket_at(level, cell_x, cell_y, mask):
    """The bucket of a cell. Products stay below 2^62 for cells within CELL_RANGE. Source: Teschner 2003."""
    return ((cell_x * 73856093) ^ (cell_y * 19349663) ^ (level * 83492791)) & mask


@subkernel
def level_of(lower_x, lower_y, upper_x, upper_y, base):
    """The finest level whose cells hold the box; LEVELS when none does or the box lies too far out."""
    extent = max(upper_x - lower_x, upper_y - lower_y)
    size = base
    level = 0
    while level < LEVELS and size < extent:
        size *= 2.0
        level += 1
    reach = max(max(abs(lower_x), abs(upper_x)), max(abs(lower_y), abs(upper_y)))
    if not reach < CELL_RANGE * size:
        return LEVELS
    return level


@subkernel
def take_out(
    # scalars
    slot,
    # write
    levels_inout,
    heads_inout,
    entries_inout,
    lists_inout,
    level_heads_inout,
    level_counts_inout,
    work_inout,
):
    """Unlink a slot from its cells and from the list of its level. O(4)."""
    level = levels_inout[slot]
    if level < 0:
        return
    for k in range(4 * slot, 4 * slot + 4):
        e = entries_inout[k]
        if e.bucket >= 0:
            work_inout[CELLS_TOUCHED] += 1
            if e.previous >= 0:
                entries_inout[e.previous].next = e.next
            else:
                heads_inout[e.bucket] = e.next
            if e.next >= 0:
                entries_inout[e.next].previous = e.previous
            e.bucket = -1
    before = lists_inout[slot, 0]
    after = lists_inout[slot, 1]
    if before >= 0:
        lists_inout[before, 1] = after
    else:
        level_heads_inout[level] = after
    if after >= 0:
        lists_inout[after, 0] = before
    level_counts_inout[level] -= 1
    levels_inout[slot] = -1


@subkernel
def put_in(
    # read
    proxies,
    # scalars
    slot,
    level,
    base,
    mask,
    # write
    levels_inout,
    heads_inout,
    entries_inout,
    lists_inout,
    level_heads_inout,
    level_counts_inout,
    work_inout,
):
    """Link a slot into the cells its box touches and into the list of its level. O(4)."""
    p = proxies[slot]
    levels_inout[slot] = level
    lists_inout[slot, 0] = -1
    lists_inout[slot, 1] = level_heads_inout[level]
    if level_heads_inout[level] >= 0:
        lists_inout[level_heads_inout[level], 0] = slot
    level_heads_inout[level] = slot
    level_counts_inout[level] += 1
    if level == LEVELS:
        return
    inverse = 1.0 / (base * (1 << level))
    k = 4 * slot
    for cell_y in range(cell_of(p.lower_y, inverse), cell_of(p.upper_y, inverse) + 1):
        for cell_x in range(cell_of(p.lower_x, inverse), cell_of(p.upper_x, inverse) + 1):
            bucket = bucket_at(level, cell_x, cell_y, mask)
            e = entries_inout[k]
            e.lower_x = p.lower_x
            e.lower_y = p.lower_y
            e.upper_x = p.upper_x
            e.upper_y = p.upper_y
            e.level = level
            e.cell_x = cell_x
            e.cell_y = cell_y
            e.bucket = bucket
            e.previous = -1
            e.next = heads_inout[bucket]
            if e.next >= 0:
                entries_inout[e.next].previous = k
            heads_inout[bucket] = k
            work_inout[CELLS_TOUCHED] += 1
            k += 1


@kernel
def place_changed(
    # read
    proxies,
    changed,
    base,
    # write
    levels_inout,
    heads_inout,
    entries_inout,
    lists_inout,
    level_heads_inout,
    level_counts_inout,
    work_inout,
):
    """Move the changed proxies to the cells they touch now; those that stay in theirs are left alone.

    changed: slots; levels_inout (slots) level or -1; heads_inout: first entry of each bucket; entries_inout four per
    slot; lists_inout (slots, 2) previous and next of the level. Returns 1 when a box spans more than four cells,
    which rounding alone cannot do, else 0. O(changed).
    """
    mask = len(heads_inout) - 1
    for i in range(len(changed)):
        slot = changed[i]
        p = proxies[slot]
        if p.row < 0:
            take_out(
                slot,
                levels_inout,
                heads_inout,
                entries_inout,
                lists_inout,
                level_heads_inout,
                level_counts_inout,
                work_inout,
            )
            continue
        level = level_of(p.lower_x, p.lower_y, p.upper_x, p.upper_y, base)
        if level < LEVELS:
            inverse = 1.0 / (base * (1 << level))
            columns = cell_of(p.upper_x, inverse) - cell_of(p.lower_x, inverse) + 1
            rows = cell_of(p.upper_y, inverse) - cell_of(p.lower_y, inverse) + 1
            if columns > 2 or rows > 2:  # a box as wide as a cell, with both ends on borders
                level += 1
                inverse *= 0.5
                columns = cell_of(p.upper_x, inverse) - cell_of(p.lower_x, inverse) + 1
                rows = cell_of(p.upper_y, inverse) - cell_of(p.lower_y, inverse) + 1
            if level == levels_inout[slot] and level < LEVELS:
                first = entries_inout[4 * slot]
                last = entries_inout[4 * slot + columns * rows - 1]
                if (
                    first.bucket >= 0
                    and first.cell_x == cell_of(p.lower_x, inverse)
                    and first.cell_y == cell_of(p.lower_y, inverse)
                    and last.bucket >= 0
                    and last.cell_x == cell_of(p.upper_x, inverse)
                    and last.cell_y == cell_of(p.upper_y, inverse)
                    and (columns * rows == 4 or entries_inout[4 * slot + columns * rows].bucket < 0)
                ):
                    for k in range(4 * slot, 4 * slot + columns * rows):
                        e = entries_inout[k]
                        e.lower_x = p.lower_x
                        e.lower_y = p.lower_y
                        e.upper_x = p.upper_x
                        e.upper_y = p.upper_y
                    continue
        take_out(
            slot,
            levels_inout,
            heads_inout,
            entries_inout,
            lists_inout,
            level_heads_inout,
            level_counts_inout,
            work_inout,
        )
        put_in(
            proxies,
            slot,
            level,
            base,
            mask,
            levels_inout,
            heads_inout,
            entries_inout,
            lists_inout,
            level_heads_inout,
            level_counts_inout,
            work_inout,
        )
        work_inout[REINSERTS] += 1
