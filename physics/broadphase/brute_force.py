"""Brute force: every changed proxy against every other proxy. The baseline of all measurements.

Exact, without state between steps, O(changed · n). Best for a few dozen bodies, and the reference with which tests
compare the other strategies.
"""

import numpy as np
from numpy.typing import ArrayLike

from physics import checks
from physics.broadphase.pairs_of_boxes import find_pairs
from physics.broadphase.proxies import Arena, Box, Query, meets_box, overlaps, write_pair
from physics.jit import kernel, subkernel
from physics.tables.step_state import PAIRS_TESTED


@kernel
def find_all(proxies, changed, pairs_out, work_inout):
    """List the overlapping pairs that contain a changed proxy. Return their number. O(changed · n).

    proxies: PROXY table, in which free slots have row -1; changed: slots of the changed proxies; pairs_out (capacity,
    2) int32: pairs of slots; work_inout: counters, see COUNTERS.
    """
    found = 0
    for i in range(len(changed)):
        a = changed[i]
        if proxies[a].row < 0:
            continue
        for b in range(len(proxies)):
            q = proxies[b]
            if q.row < 0 or b == a or (q.changed and b < a):
                continue
            if overlaps(proxies, a, b, work_inout):
                found = write_pair(a, b, found, pairs_out)
    return found


@kernel
def near_in_all(proxies, box, slots_out, work_inout):
    """Write the slots of the proxies whose boxes overlap `box` to slots_out. Return their number. O(n).

    proxies: PROXY table, in which free slots have row -1; box [px]: lower x, y, upper x, y; work_inout: counters, see
    COUNTERS.
    """
    found = 0
    for slot in range(len(proxies)):
        p = proxies[slot]
        if p.row < 0:
            continue
        work_inout[PAIRS_TESTED] += 1
        if meets_box(p, box):
            slots_out[found] = slot
            found += 1
    return found


@subkernel
def search_all(box, structure, slots_out, work_inout):
    """Find the proxies whose boxes overlap `box`, as near_in_all does.

    Return their number. structure: (PROXY table,).
    """
    return near_in_all(structure[0], box, slots_out, work_inout)


class BruteForce:
    """Broad phase that tests all pairs: O(n²) in the first step, O(moved · n) in later steps.

    incremental: whether to keep the pairs of proxies that have not changed since the last step. False tests all n (n -
        1) / 2 pairs in every step, as "brute force" means in papers, and finds the same pairs.

    Raises TypeError for a value that is not a bool.
    """

    name = "brute"

    def __init__(self, incremental: bool = True) -> None:
        self.incremental = checks.flag("incremental", incremental)

    def find_pairs(self, lower: ArrayLike, upper: ArrayLike) -> np.ndarray:
        """Return the overlapping pairs of n closed boxes: (m, 2) int32, sorted, each as indices a < b.

        lower, upper: corners of the boxes, (n, 2) [px].

        Raises TypeError for values that are not numbers, ValueError for a wrong shape, NaN, and lower > upper.
        """
        return find_pairs(self.fresh(), lower, upper)

    def fresh(self) -> "BruteForce":
        """Return a new broad phase with the same settings and without proxies."""
        return BruteForce(self.incremental)

    def update(self, arena: Arena) -> None:
        """Do nothing: this broad phase stores nothing between steps.

        arena: see proxies.Arena.
        """

    def query(self, arena: Arena) -> Query:
        """Return a function (pairs, work) -> count, which writes the pairs with a changed proxy to `pairs`.

        arena: the proxies, and which have changed.

        pairs (capacity, 2) int32 are slots, work the counters, see COUNTERS.
        """
        return lambda pairs, work: find_all(arena.proxies, arena.changed, pairs, work)

    def query_box(self, proxies: np.ndarray, box: Box, slots: np.ndarray, work: np.ndarray) -> int:
        """Find the proxies whose boxes overlap a box. Write their slots, and return their number.

        proxies: PROXY table; box: (lower x, lower y, upper x, upper y) [px].
        slots: array with room for all proxies, which is written; work: counters, see COUNTERS, which are increased.
        """
        return near_in_all(proxies, box, slots, work)

    def structure(self, proxies: np.ndarray) -> tuple:
        """Return the data that the kernel search_all reads.

        proxies: PROXY table.
        """
        return (proxies,)
