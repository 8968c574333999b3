"""Brute-force broad phase: test every changed proxy against every other proxy. O(changed · n).

It stores nothing between steps. It is the fastest broad phase for a few dozen bodies, and the reference with which
tests and measurements compare the others.
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
    """Write the overlapping pairs that contain a changed proxy to pairs_out, and return their number. O(changed · n).

    proxies: PROXY table, in which free slots have row -1; changed: slots of the changed proxies; pairs_out: (capacity,
    2) int32, the slots of each pair; work_inout: counters, see COUNTERS.
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
    """Write the slots of the proxies whose boxes overlap `box` to slots_out, and return the number of slots. O(n).

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
    """Search the proxies whose boxes overlap a box, see near_in_all. Return the number of proxies found.

    structure: result of BruteForce.structure, (PROXY table,); other arguments: see near_in_all.
    """
    return near_in_all(structure[0], box, slots_out, work_inout)


class BruteForce:
    """Broad phase that tests all pairs: O(n²) in the first step, O(moved · n) in later steps.

    incremental: whether the pairs of two proxies that have not changed since the last step are kept without a test.
        False tests all n (n - 1) / 2 pairs in every step, as in the textbook method. The resulting pairs are the same.

    Raises TypeError for a value that is not a bool.
    """

    name = "brute"

    def __init__(self, incremental: bool = True) -> None:
        self.incremental = checks.flag("incremental", incremental)

    def find_pairs(self, lower: ArrayLike, upper: ArrayLike) -> np.ndarray:
        """Return the pairs of overlapping or touching boxes: (m, 2) int32 indices a < b, sorted.

        lower, upper: corners of n boxes, (n, 2) [px].

        Raises TypeError for values that are not numbers, ValueError for a wrong shape, NaN, and lower > upper.
        """
        return find_pairs(self.fresh(), lower, upper)

    __copy__ = checks.independent("copy.deepcopy(…), or BruteForce()")

    def fresh(self) -> "BruteForce":
        """Return a new broad phase with the same settings and without proxies."""
        return BruteForce(self.incremental)

    def update(self, arena: Arena) -> None:
        """Do nothing, because this broad phase stores nothing between steps.

        arena: see proxies.Arena.
        """

    def query(self, arena: Arena) -> Query:
        """Return a function (pairs, work) -> count, which writes the overlapping pairs that contain a changed proxy.

        arena: the Arena with the proxies and the slots of the changed ones.

        The function writes the slots of each pair to `pairs`, (capacity, 2) int32. It returns the number of pairs, even
        if they do not fit, and increases `work`, the counters named in COUNTERS.
        """
        return lambda pairs, work: find_all(arena.proxies, arena.changed, pairs, work)

    def query_box(self, proxies: np.ndarray, box: Box, slots: np.ndarray, work: np.ndarray) -> int:
        """Write the slots of the proxies whose boxes overlap a box to `slots`, and return the number of slots.

        proxies: PROXY table; box: (lower x, lower y, upper x, upper y) [px].
        slots: array with room for all proxies, which is written; work: counters, see COUNTERS, which are increased.
        """
        return near_in_all(proxies, box, slots, work)

    def structure(self, proxies: np.ndarray) -> tuple:
        """Return the tuple (proxies,), which is the argument `structure` of the kernel search_all.

        proxies: PROXY table.
        """
        return (proxies,)
