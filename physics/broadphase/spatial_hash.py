"""A uniform grid in a hash table, with coarser grids above it for what outgrows a cell.

A proxy sits in the level whose cells are at least as large as its box, so it touches at most four cells, whatever its
size: a giant sits in one coarse cell and floods nothing. A box that spans more cells of a finer level than its
outline is long walks the list of that level instead. Source: Ericson, Real-Time Collision Detection, 7.1–7.2.
O(cells touched + candidates). Suits many things of one size, moving or not.
"""

import numpy as np
from numpy.typing import ArrayLike

from physics import checks
from physics.broadphase.cell_pairs import CHAINS, NEAR, find_in_cells, near_in_cells
from physics.broadphase.cells import ENTRY, LEVELS, place_changed
from physics.broadphase.proxies import Arena, Box, Query, find_pairs

CELL_OF_MEDIAN = 2.0  # an untuned cell is this many median boxes wide: the flat optimum of `tests.bench broadphase`
SMALLEST_CELL = 2.0**-1000  # its inverse is still finite


class SpatialHashGrid:
    """cell: size of the finest cells [px]; None tunes itself to the bodies.
    Raises ValueError for a cell below 2^-1000."""

    name = "hash"
    incremental = True

    def __init__(self, cell: float | None = None) -> None:
        self.cell = None if cell is None else checks.number("cell", cell, low=SMALLEST_CELL)
        self.base = self.cell or 0.0
        self.tuned_for = 0
        self.chains, self.near_entries = np.zeros((CHAINS, 3), np.int64), np.zeros(NEAR, np.int64)
        self._clear(0, 16)

    def _clear(self, slots, buckets):
        self.levels = np.full(slots, -1, np.int64)
        self.heads = np.full(buckets, -1, np.int64)
        self.entries = np.zeros(4 * slots, ENTRY)
        self.entries["bucket"] = -1
        self.lists = np.full((slots, 2), -1, np.int64)
        self.level_heads = np.full(LEVELS + 1, -1, np.int64)
        self.level_counts = np.zeros(LEVELS + 1, np.int64)

    def find_pairs(self, lower: ArrayLike, upper: ArrayLike) -> np.ndarray:
        """(m, 2) int32 pairs a < b, sorted, of closed boxes (n, 2) lower, upper [px]. Raises ValueError."""
        return find_pairs(self.fresh(), lower, upper)

    def fresh(self) -> "SpatialHashGrid":
        """A copy without state."""
        return SpatialHashGrid(self.cell)

    def update(self, arena: Arena) -> None:
        """Move what changed to its cells; grow, and tune the cell size anew, when the number of bodies doubled."""
        proxies = arena.proxies
        changed = arena.changed
        alive = int(self.level_counts.sum()) + len(changed)  # an upper bound, cheap, good enough to double by
        coarse = int(self.level_counts[2:LEVELS].sum())
        retune = self.cell is None and (alive > 2 * self.tuned_for or 2 * coarse > max(alive, 8))
        if retune or alive > len(self.heads) or len(proxies) > len(self.levels):
            rows = np.flatnonzero(proxies["row"] >= 0)
            if self.cell is None and retune and len(rows):
                self.base = self._tuned(proxies[rows])
                self.tuned_for = max(len(rows), 8)
            buckets = len(self.heads)
            while buckets < 2 * alive:
                buckets *= 2
            self._clear(
                max(len(proxies), 2 * len(self.levels) if len(proxies) > len(self.levels) else len(self.levels)),
                buckets,
            )
            changed = rows
        place_changed(proxies, changed, self.base, *self._state(), arena.work)

    def _state(self):
        return self.levels, self.heads, self.entries, self.lists, self.level_heads, self.level_counts

    @staticmethod
    def _tuned(boxes):
        """Twice the median box, in finite boxes that have a size; 1 when there is none."""
        with np.errstate(invalid="ignore", over="ignore"):
            extent = np.maximum(boxes["upper_x"] - boxes["lower_x"], boxes["upper_y"] - boxes["lower_y"])
        extent = extent[np.isfinite(extent) & (extent > 0.0)]
        return max(SMALLEST_CELL, CELL_OF_MEDIAN * float(np.median(extent))) if len(extent) else 1.0

    def query(self, arena: Arena) -> Query:
        """A function (pairs, work) -> count that lists the pairs of the changed proxies."""
        return lambda pairs, work: find_in_cells(
            arena.proxies, arena.changed, self.base, *self._state(), self.chains, self.near_entries, pairs, work
        )

    def near(self, proxies: np.ndarray, box: Box, slots: np.ndarray, work: np.ndarray) -> int:
        """List the slots whose box meets box (lower x, y, upper x, y) [px] in `slots`; how many there are."""
        return near_in_cells(
            self.base,
            self.heads,
            self.entries,
            self.lists,
            self.level_heads,
            self.level_counts,
            proxies,
            *box,
            slots,
            work,
        )

    def cells(self) -> tuple[np.ndarray, np.ndarray]:
        """Occupied cells: (m, 4) rectangles [px] and (m,) levels, for drawing."""
        used = self.entries[self.entries["bucket"] >= 0]
        level = np.repeat(self.levels, 4)[self.entries["bucket"] >= 0]
        cells = (
            np.unique(np.stack([level, used["cell_x"], used["cell_y"]], axis=1), axis=0)
            if len(used)
            else np.zeros((0, 3), np.int64)
        )
        size = self.base * 2.0 ** cells[:, 0]
        low = cells[:, 1:] * size[:, None]
        return np.concatenate([low, low + size[:, None]], axis=1), cells[:, 0]
