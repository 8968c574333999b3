"""Broad phase with a hierarchical spatial hash: a uniform grid in a hash table, and coarser grids for larger boxes."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from physics import checks
from physics.broadphase.pairs_of_boxes import find_pairs
from physics.broadphase.proxies import Arena, Box, Query, may_meet, meets_box, overlaps, write_pair
from physics.jit import kernel, subkernel
from physics.tables.step_state import CELLS_TOUCHED, NODES_VISITED, PAIRS_TESTED, REINSERTS

# ---- cells -----------------------------------------------------------------------------------------------------------
# The cells of a hashed hierarchy of grids: the cells of a box, and the lists of proxies in them.
#
# See "spatial hash" below for the structure and its sources.

LEVELS = 24  # cell sizes base · 2^0 … base · 2^23; level 24 is the list of boxes that fit no level
CELL_RANGE = 1e9  # largest number of cells from the origin at which coordinates are hashed exactly in 64 bits
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


class Cells(NamedTuple):
    """Linked lists of proxies: one list for each hash bucket, and one for each level of the grid hierarchy."""

    levels: np.ndarray  # (slots,) level of each proxy, or -1
    heads: np.ndarray  # (buckets,) first entry of each bucket, or -1; the number of buckets is a power of two
    entries: np.ndarray  # ENTRY, four for each slot: one for each cell that its box touches
    lists: np.ndarray  # (slots, 2) previous and next slot in the list of the slot's level
    level_heads: np.ndarray  # (LEVELS + 1,) first slot of each level, or -1
    level_counts: np.ndarray  # (LEVELS + 1,) number of slots on each level


def empty_cells(slots: int, buckets: int) -> Cells:
    """Return empty Cells with room for `slots` proxies, and with `buckets` hash buckets. buckets: a power of two."""
    entries = np.zeros(4 * slots, ENTRY)
    entries["bucket"] = -1
    levels, heads, lists = np.full(slots, -1), np.full(buckets, -1), np.full((slots, 2), -1)
    return Cells(levels, heads, entries, lists, np.full(LEVELS + 1, -1), np.zeros(LEVELS + 1, np.int64))


@subkernel
def cell_of(coordinate, inverse_size):
    """Return the index of the column (or row) of cells that contains an x (or y) coordinate [px].

    inverse_size: 1 / (size of a cell) [1/px].
    """
    return math.floor(coordinate * inverse_size)


@subkernel
def bucket_at(level, cell_x, cell_y, mask):
    """Return the hash bucket of the cell in column cell_x and row cell_y of a level. Source: Teschner 2003.

    mask: number of buckets minus one. For cells within CELL_RANGE, the products are below 2^62.
    """
    return ((cell_x * 73856093) ^ (cell_y * 19349663) ^ (level * 83492791)) & mask


@subkernel
def level_of(lower_x, lower_y, upper_x, upper_y, base):
    """Return the finest level whose cells are at least as large as a box; LEVELS if there is no such level.

    The result is also LEVELS if the box is outside CELL_RANGE. lower_x, lower_y, upper_x, upper_y: the box [px]; base:
    cell size on level 0 [px].
    """
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
def write_box(proxy, entry_out):
    """Copy the box of a PROXY row to an ENTRY row, so that searches read only the entry."""
    entry_out.lower_x, entry_out.lower_y = proxy.lower_x, proxy.lower_y
    entry_out.upper_x, entry_out.upper_y = proxy.upper_x, proxy.upper_y


@subkernel
def take_out(slot, cells_inout, work_inout):
    """Unlink the proxy in `slot` from the lists of its cells (at most four) and of its level. O(1).

    Do nothing if the proxy is not linked. cells_inout: Cells; work_inout: counters, see COUNTERS.
    """
    entries = cells_inout.entries
    lists = cells_inout.lists
    level = cells_inout.levels[slot]
    if level < 0:
        return
    for k in range(4 * slot, 4 * slot + 4):
        e = entries[k]
        if e.bucket >= 0:
            work_inout[CELLS_TOUCHED] += 1
            if e.previous >= 0:
                entries[e.previous].next = e.next
            else:
                cells_inout.heads[e.bucket] = e.next
            if e.next >= 0:
                entries[e.next].previous = e.previous
            e.bucket = -1
    before = lists[slot, 0]
    after = lists[slot, 1]
    if before >= 0:
        lists[before, 1] = after
    else:
        cells_inout.level_heads[level] = after
    if after >= 0:
        lists[after, 0] = before
    cells_inout.level_counts[level] -= 1
    cells_inout.levels[slot] = -1


@subkernel
def put_in(proxies, slot, level, base, cells_inout, work_inout):
    """Link the proxy in `slot` into the lists of the cells that its box touches (at most four) and of its level. O(1).

    proxies: PROXY table; level: a level whose cells are at least as large as the box, or LEVELS; base: cell size on
    level 0 [px]; cells_inout: Cells; work_inout: counters, see COUNTERS.
    """
    p = proxies[slot]
    heads = cells_inout.heads
    entries = cells_inout.entries
    level_heads = cells_inout.level_heads
    cells_inout.levels[slot] = level
    cells_inout.lists[slot, 0] = -1
    cells_inout.lists[slot, 1] = level_heads[level]
    if level_heads[level] >= 0:
        cells_inout.lists[level_heads[level], 0] = slot
    level_heads[level] = slot
    cells_inout.level_counts[level] += 1
    if level == LEVELS:
        return
    mask = len(heads) - 1
    inverse = 1.0 / (base * (1 << level))
    k = 4 * slot
    for cell_y in range(cell_of(p.lower_y, inverse), cell_of(p.upper_y, inverse) + 1):
        for cell_x in range(cell_of(p.lower_x, inverse), cell_of(p.upper_x, inverse) + 1):
            bucket = bucket_at(level, cell_x, cell_y, mask)
            e = entries[k]
            write_box(p, e)
            e.level = level
            e.cell_x, e.cell_y = cell_x, cell_y
            e.bucket = bucket
            e.previous = -1
            e.next = heads[bucket]
            if e.next >= 0:
                entries[e.next].previous = k
            heads[bucket] = k
            work_inout[CELLS_TOUCHED] += 1
            k += 1


@kernel
def place_changed(proxies, changed, base, cells_inout, work_inout):
    """Link the changed proxies into the cells that their boxes touch, and unlink the freed proxies. O(changed).

    If a proxy is still in the same cells, only the copies of its box in these cells are updated. A box whose ends are
    on cell borders may touch three cells along an axis; such a box is linked on the next coarser level. proxies: PROXY
    table; changed: slots of the changed and freed proxies; base: cell size on level 0 [px]; cells_inout: Cells;
    work_inout: counters, see COUNTERS.
    """
    entries = cells_inout.entries
    for i in range(len(changed)):
        slot = changed[i]
        p = proxies[slot]
        if p.row < 0:
            take_out(slot, cells_inout, work_inout)
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
            if level == cells_inout.levels[slot] and level < LEVELS:
                first = entries[4 * slot]
                last = entries[4 * slot + columns * rows - 1]
                if (
                    first.bucket >= 0
                    and first.cell_x == cell_of(p.lower_x, inverse)
                    and first.cell_y == cell_of(p.lower_y, inverse)
                    and last.bucket >= 0
                    and last.cell_x == cell_of(p.upper_x, inverse)
                    and last.cell_y == cell_of(p.upper_y, inverse)
                    and (columns * rows == 4 or entries[4 * slot + columns * rows].bucket < 0)
                ):
                    for k in range(4 * slot, 4 * slot + columns * rows):
                        write_box(p, entries[k])
                    continue
        take_out(slot, cells_inout, work_inout)
        put_in(proxies, slot, level, base, cells_inout, work_inout)
        work_inout[REINSERTS] += 1


# ---- cell pairs ------------------------------------------------------------------------------------------------------
# Search in the cells of a hashed hierarchy of grids: pairs of changed proxies, and proxies that meet a query box.

CHAINS, NEAR = 8, 64  # number of cells whose lists are traversed side by side; entries collected before their pair test


@subkernel
def follow(entries, p, level, count, chains_inout, near_out):
    """Traverse the lists of several cells, and collect the entries whose boxes overlap the box of the PROXY row p.

    Return (number of unfinished lists, number of collected entries, number of tests). The traversal stops before more
    than NEAR entries could be collected. entries: ENTRY rows; level: level of the cells; count: number of lists;
    chains_inout: (CHAINS, 3) int64, for each list the index of its next entry, and column and row of its cell;
    near_out: (NEAR,) int64, indices of the collected entries. The lists are traversed in parallel, so that their memory
    latencies overlap. The tests have no branch, because a branch would be mispredicted.
    """
    near = 0
    tested = 0
    while count > 0 and near + count <= NEAR:
        left = 0
        for i in range(count):
            k = chains_inout[i, 0]
            cell_x = chains_inout[i, 1]
            cell_y = chains_inout[i, 2]
            e = entries[k]  # the entry contains the box, so most tests read nothing else
            near_out[near] = k
            near += int(
                (e.lower_x <= p.upper_x)
                & (e.upper_x >= p.lower_x)
                & (e.lower_y <= p.upper_y)
                & (e.upper_y >= p.lower_y)
                & (e.cell_x == cell_x)
                & (e.cell_y == cell_y)
                & (e.level == level)
            )
            chains_inout[left, 0] = e.next
            chains_inout[left, 1] = cell_x
            chains_inout[left, 2] = cell_y
            left += int(e.next >= 0)
        tested += count
        count = left
    return count, near, tested


@kernel
def find_in_cells(proxies, changed, base, cells, chains_out, near_out, pairs_out, work_inout):
    """Write the overlapping pairs that contain a changed proxy, and return their number. O(cells + candidates).

    On each level, a box is tested against the proxies in the cells that the box touches. If these cells are too many,
    the box is tested against all proxies of the level instead. Therefore the number of cells read is at most
    proportional to the perimeter of the box. A pair that shares several cells is reported only in the cell that
    contains the lower corner of the overlap.

    proxies: PROXY table; changed: slots of the changed proxies; base: cell size on level 0 [px]; cells: Cells;
    chains_out, near_out: scratch, see follow; pairs_out: (capacity, 2) int32, the slots of each pair; work_inout:
    counters, see COUNTERS.
    """
    heads = cells.heads
    entries = cells.entries
    level_counts = cells.level_counts
    mask = len(heads) - 1
    found = 0
    tested = 0
    for i in range(len(changed)):
        a = changed[i]
        p = proxies[a]
        if p.row < 0:
            continue
        for level in range(LEVELS + 1):
            if level_counts[level] == 0:
                continue
            by_list = level == LEVELS or cells.levels[a] == LEVELS
            first_x, first_y = 0, 0
            last_x, last_y = -1, -1
            inverse = 1.0
            if not by_list:
                inverse = 1.0 / (base * (1 << level))
                if (p.upper_x - p.lower_x) * inverse + (p.upper_y - p.lower_y) * inverse > level_counts[level] + 4:
                    by_list = True
                else:
                    first_x = cell_of(p.lower_x, inverse)
                    last_x = cell_of(p.upper_x, inverse)
                    first_y = cell_of(p.lower_y, inverse)
                    last_y = cell_of(p.upper_y, inverse)
                    columns, rows = last_x - first_x + 1, last_y - first_y + 1
                    by_list = columns * rows > 4 * (columns + rows)
            if by_list:
                b = cells.level_heads[level]
                while b >= 0:
                    if b != a and not (proxies[b].changed and b < a) and overlaps(proxies, a, b, work_inout):
                        found = write_pair(a, b, found, pairs_out)
                    b = cells.lists[b, 1]
                continue
            cell_x, cell_y = first_x, first_y
            count = 0
            while cell_y <= last_y or count > 0:
                while cell_y <= last_y and count < CHAINS:
                    work_inout[NODES_VISITED] += 1
                    k = heads[bucket_at(level, cell_x, cell_y, mask)]
                    chains_out[count, 0] = k
                    chains_out[count, 1] = cell_x
                    chains_out[count, 2] = cell_y
                    count += int(k >= 0)
                    cell_x += 1
                    if cell_x > last_x:
                        cell_x = first_x
                        cell_y += 1
                count, near, met = follow(entries, p, level, count, chains_out, near_out)
                tested += met
                for i in range(near):
                    e = entries[near_out[i]]
                    b = near_out[i] // 4
                    if (
                        b != a
                        and not (b < a and proxies[b].changed)
                        and cell_of(max(p.lower_x, e.lower_x), inverse) == e.cell_x
                        and cell_of(max(p.lower_y, e.lower_y), inverse) == e.cell_y
                        and may_meet(proxies, a, b, work_inout)
                    ):
                        found = write_pair(a, b, found, pairs_out)
    work_inout[PAIRS_TESTED] += tested
    return found


@kernel
def near_in_cells(base, cells, proxies, box, slots_out, work_inout):
    """Write the slots of the proxies whose boxes overlap `box`, and return their number. O(cells + boxes in them).

    On each level, the lists of the cells that the box touches are read. If there are more such cells than proxies, the
    list of all proxies of the level is read instead. A proxy in several cells is reported only in the cell that
    contains the lower corner of the overlap. base: cell size on level 0 [px]; cells: Cells; proxies: PROXY table; box:
    (lower x, lower y, upper x, upper y) [px]; slots_out: the result; work_inout: counters, see COUNTERS.
    """
    heads = cells.heads
    level_counts = cells.level_counts
    lower_x, lower_y, upper_x, upper_y = box
    mask = len(heads) - 1
    reach = max(max(abs(lower_x), abs(upper_x)), max(abs(lower_y), abs(upper_y)))
    found = 0
    for level in range(LEVELS + 1):
        if level_counts[level] == 0:
            continue
        inverse = 1.0
        by_list = level == LEVELS
        if not by_list:
            size = base * (1 << level)
            inverse = 1.0 / (base * (1 << level))
            by_list = (
                not reach < CELL_RANGE * size
                or (upper_x - lower_x) * inverse + (upper_y - lower_y) * inverse > level_counts[level] + 4
            )
        if not by_list:
            columns = cell_of(upper_x, inverse) - cell_of(lower_x, inverse) + 1
            rows = cell_of(upper_y, inverse) - cell_of(lower_y, inverse) + 1
            by_list = columns * rows > level_counts[level] + 4
        if by_list:
            slot = cells.level_heads[level]
            while slot >= 0:
                work_inout[PAIRS_TESTED] += 1
                if meets_box(proxies[slot], box):
                    slots_out[found] = slot
                    found += 1
                slot = cells.lists[slot, 1]
            continue
        for cell_y in range(cell_of(lower_y, inverse), cell_of(upper_y, inverse) + 1):
            for cell_x in range(cell_of(lower_x, inverse), cell_of(upper_x, inverse) + 1):
                work_inout[NODES_VISITED] += 1
                k = heads[bucket_at(level, cell_x, cell_y, mask)]
                while k >= 0:
                    e = cells.entries[k]
                    work_inout[PAIRS_TESTED] += 1
                    if (
                        e.level == level
                        and e.cell_x == cell_x
                        and e.cell_y == cell_y
                        and meets_box(e, box)
                        and cell_of(max(lower_x, e.lower_x), inverse) == cell_x
                        and cell_of(max(lower_y, e.lower_y), inverse) == cell_y
                    ):
                        slots_out[found] = k // 4
                        found += 1
                    k = e.next
    return found


@subkernel
def search_cells(box, structure, slots_out, work_inout):
    """Search the proxies whose boxes overlap a box, see near_in_cells. Return the number of proxies found.

    structure: result of SpatialHashGrid.structure, (base, cells, PROXY table); other arguments: see near_in_cells.
    """
    base, cells, proxies = structure
    return near_in_cells(base, cells, proxies, box, slots_out, work_inout)


# ---- spatial hash ----------------------------------------------------------------------------------------------------
# A uniform grid in a hash table, with coarser grids above it for larger boxes.
#
# A proxy is on the finest level whose cells are at least as large as its box, so it touches at most four cells. A very
# large box is in a few coarse cells, and not in many fine ones. A box that would cover too many cells of a finer level
# is tested against the list of that level instead. Source: Ericson, Real-Time Collision Detection, 7.1–7.2. O(cells
# touched + candidates). Suitable for many bodies of similar size, moving or not.

CELL_OF_MEDIAN = 2.0  # cell size / median extent of the boxes: the flat optimum of `tests.bench broadphase`
SMALLEST_CELL = 2.0**-1000  # [px] its inverse is finite


class SpatialHashGrid:
    """Broad phase with a hierarchical hash grid: a grid of cells in a hash table, and coarser grids for larger boxes.

    cell: size of the finest cells [px]; None: the size is computed from the sizes of the boxes.

    Raises TypeError for a cell that is not a number, ValueError for a cell below 2^-1000.
    """

    name = "hash"
    incremental = True

    def __init__(self, cell: float | None = None) -> None:
        if cell is not None:
            cell = checks.number("cell", checks.number("cell", cell, above=0.0), low=SMALLEST_CELL)
        self.cell = cell
        self.base = self.cell or 0.0
        self.tuned_for = 0
        self.chains, self.near_entries = np.zeros((CHAINS, 3), np.int64), np.zeros(NEAR, np.int64)
        self.lists = empty_cells(0, 16)

    def find_pairs(self, lower: ArrayLike, upper: ArrayLike) -> np.ndarray:
        """Return the pairs of overlapping or touching boxes: (m, 2) int32 indices a < b, sorted.

        lower, upper: corners of n boxes, (n, 2) [px].

        Raises TypeError for values that are not numbers, ValueError for a wrong shape, NaN, and lower > upper.
        """
        return find_pairs(self.fresh(), lower, upper)

    __copy__ = checks.independent("copy.deepcopy(…), or SpatialHashGrid()")

    def fresh(self) -> "SpatialHashGrid":
        """Return a new broad phase with the same settings and without proxies."""
        return SpatialHashGrid(self.cell)

    def update(self, arena: Arena) -> None:
        """Link the changed proxies into the cells that their boxes touch.

        arena: the Arena with the proxies and the slots of the changed ones.

        The hash table is enlarged when it has fewer buckets than proxies. The cell size is computed again when the
        number of proxies has doubled, or when most proxies are on coarse levels.
        """
        proxies = arena.proxies
        changed = arena.changed
        alive = int(self.lists.level_counts.sum()) + len(changed)  # a cheap upper bound
        coarse = int(self.lists.level_counts[2:LEVELS].sum())
        slots, buckets = len(self.lists.levels), len(self.lists.heads)
        retune = self.cell is None and (alive > 2 * self.tuned_for or 2 * coarse > max(alive, 8))
        if retune or alive > buckets or len(proxies) > slots:
            rows = np.flatnonzero(proxies["row"] >= 0)
            if self.cell is None and retune and len(rows):
                self.base = self._tuned(proxies[rows])
                self.tuned_for = max(len(rows), 8)
            while buckets < 2 * alive:
                buckets *= 2
            if len(proxies) > slots:
                slots = max(len(proxies), 2 * slots)
            self.lists = empty_cells(slots, buckets)
            changed = rows
        place_changed(proxies, changed, self.base, self.lists, arena.work)

    @staticmethod
    def _tuned(boxes):
        """Return a cell size [px] for these boxes (PROXY rows): CELL_OF_MEDIAN (2) times the median of their extents.

        Infinite boxes and boxes of size 0 are ignored; if there are no other boxes, the result is 1.
        """
        with np.errstate(invalid="ignore", over="ignore"):
            extent = np.maximum(boxes["upper_x"] - boxes["lower_x"], boxes["upper_y"] - boxes["lower_y"])
        extent = extent[np.isfinite(extent) & (extent > 0.0)]
        return max(SMALLEST_CELL, CELL_OF_MEDIAN * float(np.median(extent))) if len(extent) else 1.0

    def query(self, arena: Arena) -> Query:
        """Return a function (pairs, work) -> count, which writes the overlapping pairs that contain a changed proxy.

        arena: the Arena with the proxies and the slots of the changed ones.

        The function writes the slots of each pair to `pairs`, (capacity, 2) int32. It returns the number of pairs, even
        if they do not fit, and increases `work`, the counters named in COUNTERS.
        """
        return lambda pairs, work: find_in_cells(
            arena.proxies, arena.changed, self.base, self.lists, self.chains, self.near_entries, pairs, work
        )

    def query_box(self, proxies: np.ndarray, box: Box, slots: np.ndarray, work: np.ndarray) -> int:
        """Write the slots of the proxies whose boxes overlap a box to `slots`, and return the number of slots.

        proxies: PROXY table; box: (lower x, lower y, upper x, upper y) [px].
        slots: array with room for all proxies, which is written; work: counters, see COUNTERS, which are increased.
        """
        return near_in_cells(self.base, self.lists, proxies, box, slots, work)

    def structure(self, proxies: np.ndarray) -> tuple:
        """Return (cell size on level 0, Cells, proxies), which is the argument `structure` of the kernel search_cells.

        proxies: PROXY table.
        """
        return self.base, self.lists, proxies

    def cells(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the cells that contain proxies, for drawing: (boxes (m, 4) [px], levels (m,)).

        The columns of the boxes are lower x, lower y, upper x, upper y.
        """
        linked = self.lists.entries["bucket"] >= 0
        used, level = self.lists.entries[linked], np.repeat(self.lists.levels, 4)[linked]
        cells = np.unique(np.stack([level, used["cell_x"], used["cell_y"]], axis=1), axis=0)
        size = self.base * 2.0 ** cells[:, 0]
        low = cells[:, 1:] * size[:, None]
        return np.concatenate([low, low + size[:, None]], axis=1), cells[:, 0]
