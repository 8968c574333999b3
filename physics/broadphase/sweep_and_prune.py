"""Sweep and prune: sort the boxes along an axis, and test only the pairs whose intervals overlap on this axis.

`axes="auto"` sorts along the axis with the greater variance of the centres, and tests the intervals on the other axis.
`axes="both"` sorts and sweeps along x and along y, and intersects the two lists of overlaps (dimension reduction). The
order is kept between steps. Insertion sort repairs it, with one swap for each pair that has changed its order. O(n +
swaps + interval overlaps of the changed proxies). Suitable for slow bodies that are spread along one axis. Source:
Baraff 1992; Ericson, Real-Time Collision Detection, 7.5.
"""

import numpy as np
from numpy.typing import ArrayLike

from physics import checks
from physics.broadphase.pairs_of_boxes import find_pairs
from physics.broadphase.proxies import Arena, Box, Query, may_meet, write_pair
from physics.jit import kernel, subkernel
from physics.tables.step_state import NODES_VISITED, PAIRS_TESTED, SWAPS

AXIS_SWITCH = 2.0  # the axis is switched if the variance along the other axis is greater by this factor
AXIS_INTERVAL = 32  # updates between two measurements of the variance
SWAP_BUDGET = 16  # swaps per proxy after which a full sort is cheaper than insertion sort


@kernel
def refresh_order(proxies, axis, order_inout, lower_out):
    """Remove freed slots from order_inout, and write the lower ends of the remaining boxes to lower_out. O(n).

    Return the number of remaining slots. proxies: PROXY table; axis: 0 for x, 1 for y; order_inout: slots in sorted
    order; lower_out: lower end [px] of each box along the axis, in the same order.
    """
    count = 0
    for i in range(len(order_inout)):
        slot = order_inout[i]
        p = proxies[slot]
        if p.row >= 0:
            order_inout[count] = slot
            lower_out[count] = p.lower_x if axis == 0 else p.lower_y
            count += 1
    return count


@kernel
def insertion_sort(count, budget, order_inout, lower_inout, work_inout):
    """Sort nearly sorted slots by the lower ends of their boxes, by insertion sort. O(n + swaps).

    Return 0, or 1 if the sort was stopped after more than `budget` swaps. order_inout: slots; lower_inout: lower end
    [px] of each slot's box; count: number of slots in use; work_inout: counters, see COUNTERS.
    """
    left = budget
    for i in range(1, count):
        value = lower_inout[i]
        slot = order_inout[i]
        j = i - 1
        while j >= 0 and lower_inout[j] > value:
            lower_inout[j + 1] = lower_inout[j]
            order_inout[j + 1] = order_inout[j]
            j -= 1
            left -= 1
        lower_inout[j + 1] = value
        order_inout[j + 1] = slot
        work_inout[SWAPS] += i - 1 - j
        if left < 0:
            return 1
    return 0


@kernel
def sort_boxes(proxies, order, count, axis, boxes_out, next_changed_out):
    """Copy the boxes of the proxies in sorted order, so that the sweep reads them sequentially. O(n).

    proxies: PROXY table; order: slots in sorted order; count: number of slots in use; axis: 0 for x, 1 for y;
    boxes_out: (n, 4) float64 [px], low and high end along the axis, then low and high end along the other axis;
    next_changed_out: (n,) for each position in the order, the position of the next changed proxy after it.
    """
    following = count
    for k in range(count):
        i = count - 1 - k
        p = proxies[order[i]]
        boxes_out[i, 0] = p.lower_x if axis == 0 else p.lower_y
        boxes_out[i, 1] = p.upper_x if axis == 0 else p.upper_y
        boxes_out[i, 2] = p.lower_y if axis == 0 else p.lower_x
        boxes_out[i, 3] = p.upper_y if axis == 0 else p.upper_x
        next_changed_out[i] = following
        if p.changed:
            following = i


@kernel
def sweep_one(proxies, order, count, boxes, next_changed, pairs_out, work_inout):
    """Write the overlapping pairs that contain a changed proxy, by a sweep along the axis. Return the number of pairs.

    If the pairs do not fit into pairs_out, the result is a number above the capacity. An unchanged proxy is tested only
    against changed proxies, so few tests are made if few bodies move. proxies: PROXY table; order: slots in sorted
    order; count: number of slots in use; boxes, next_changed: see sort_boxes; pairs_out: (capacity, 2) int32, the slots
    of each pair; work_inout: counters, see COUNTERS.
    """
    found = 0
    tested = 0
    room = pairs_out.shape[0] - 1
    for i in range(count):
        a = order[i]
        upper = boxes[i, 1]
        other_low = boxes[i, 2]
        other_high = boxes[i, 3]
        changed = proxies[a].changed
        j = i + 1 if changed else next_changed[i]
        if changed:
            tested -= j
        while j < count and boxes[j, 0] <= upper:
            if not changed:
                tested += 1
            # Each tested pair is written, but counted only if it overlaps, without a branch that could be mispredicted.
            # When pairs_out is full, all further pairs are written to its last row.
            at = min(found, room)
            pairs_out[at, 0] = a
            pairs_out[at, 1] = order[j]
            found += int((boxes[j, 2] <= other_high) & (boxes[j, 3] >= other_low))
            j = j + 1 if changed else next_changed[j]
        if changed:
            tested += j
    work_inout[PAIRS_TESTED] += tested
    if found > room:
        return found + 1
    kept = 0
    for i in range(found):
        a = pairs_out[i, 0]
        b = pairs_out[i, 1]
        if may_meet(proxies, a, b, work_inout):
            pairs_out[kept, 0] = a
            pairs_out[kept, 1] = b
            kept += 1
    return kept


@kernel
def sweep_intervals(proxies, order, count, boxes, next_changed, keys_out, work_inout):
    """Write the pairs that contain a changed proxy and whose intervals along one axis overlap. Return their number.

    keys_out: for each pair the key lower slot << 32 | higher slot. Pairs that do not fit into keys_out are only
    counted. Other arguments: see sweep_one.
    """
    found = 0
    for i in range(count):
        a = order[i]
        p = proxies[a]
        upper = boxes[i, 1]
        j = i + 1 if p.changed else next_changed[i]
        while j < count and boxes[j, 0] <= upper:
            b = order[j]
            q = proxies[b]
            if not ((p.still and q.still) or p.body == q.body):
                work_inout[PAIRS_TESTED] += 1
                if found < len(keys_out):
                    low, high = min(a, b), max(a, b)
                    keys_out[found] = (low << 32) | high
                found += 1
            j = j + 1 if p.changed else next_changed[j]
    return found


@kernel
def intersect(proxies, keys_x, count_x, keys_y, count_y, pairs_out, work_inout):
    """Write the pairs that are in both sorted lists of keys and that may_meet allows. Return their number. O(keys).

    proxies: PROXY table; keys_x, keys_y: the lists, see sweep_intervals; count_x, count_y: lengths of the lists;
    pairs_out: (capacity, 2) int32, the slots of each pair; work_inout: counters, see COUNTERS.
    """
    found = 0
    i, j = 0, 0
    low = 0xFFFFFFFF
    while i < count_x and j < count_y:
        if keys_x[i] < keys_y[j]:
            i += 1
        elif keys_x[i] > keys_y[j]:
            j += 1
        else:
            a, b = keys_x[i] >> 32, keys_x[i] & low
            if may_meet(proxies, a, b, work_inout):
                found = write_pair(a, b, found, pairs_out)
            i += 1
            j += 1
    return found


@kernel
def near_in_order(order, boxes, highest, axis, box, slots_out, work_inout):
    """Write the slots of the proxies whose boxes overlap `box`, and return the number of slots. O(log n + boxes read).

    order: slots sorted by the lower ends of their boxes; boxes: (n, 4) [px], see sort_boxes; highest: (n,) running
    maximum of the high ends [px]; a binary search in it skips the first boxes, which end before `box` begins; axis: 0
    for x, 1 for y; box: (lower x, lower y, upper x, upper y) [px]; slots_out: the result; work_inout: counters, see
    COUNTERS.
    """
    count = len(order)
    lower, upper = box[axis], box[axis + 2]
    first = 0
    last = count
    while first < last:
        middle = (first + last) // 2
        work_inout[NODES_VISITED] += 1
        if highest[middle] < lower:
            first = middle + 1
        else:
            last = middle
    found = 0
    k = first
    while k < count and boxes[k, 0] <= upper:
        work_inout[PAIRS_TESTED] += 1
        if boxes[k, 1] >= lower and boxes[k, 2] <= box[3 - axis] and boxes[k, 3] >= box[1 - axis]:
            slots_out[found] = order[k]
            found += 1
        k += 1
    return found


@subkernel
def search_order(box, structure, slots_out, work_inout):
    """Search the proxies whose boxes overlap a box, see near_in_order. Return the number of proxies found.

    structure: result of Axis.structure, (order, boxes, highest, axis); other arguments: see near_in_order.
    """
    order, boxes, highest, axis = structure
    return near_in_order(order, boxes, highest, axis, box, slots_out, work_inout)


class Axis:
    """The slots of the proxies, sorted by the lower ends of their boxes along one axis.

    The order is kept between steps.
    """

    def __init__(self, axis: int) -> None:
        self.axis = axis
        self.order = np.zeros(0, np.int64)
        self.known = np.zeros(0, bool)  # whether each slot is in the order
        self.boxes = np.zeros((0, 4))
        self.next_changed = np.zeros(0, np.int64)
        self.keys = np.zeros(64, np.int64)
        self.highest = None  # running maximum of the upper ends; None until a query needs it

    def update(self, arena: Arena) -> None:
        """Add new proxies to the order, remove freed proxies, and sort the order again. arena: see proxies.Arena."""
        proxies, changed = arena.proxies, arena.changed
        if len(self.known) < len(proxies):
            self.known = np.concatenate([self.known, np.zeros(len(proxies) - len(self.known), bool)])
        alive = proxies["row"][changed] >= 0
        self.known[changed[~alive]] = False
        added = changed[alive & ~self.known[changed]]
        self.known[added] = True
        lower = np.empty(len(self.order))
        count = refresh_order(proxies, self.axis, self.order, lower)
        order = np.concatenate([self.order[:count], added])
        lower = np.concatenate([lower[:count], proxies["lower_x" if self.axis == 0 else "lower_y"][added]])
        few = len(added) * 8 <= len(order)
        if not few or insertion_sort(len(order), SWAP_BUDGET * len(order) + 64, order, lower, arena.work):
            order = order[np.argsort(lower, kind="stable")]
        self.order = order
        if len(self.boxes) < len(order):
            room = max(len(order), 2 * len(self.boxes))
            self.boxes, self.next_changed = np.zeros((room, 4)), np.zeros(room, np.int64)
        sort_boxes(proxies, order, len(order), self.axis, self.boxes, self.next_changed)
        self.highest = None

    def query_box(self, box: Box, slots: np.ndarray, work: np.ndarray) -> int:
        """Write the slots of the proxies whose boxes overlap `box` to `slots`, and return the number of slots.

        box: (lower x, lower y, upper x, upper y) [px]; work: counters, see COUNTERS, which are increased.
        """
        order, boxes, highest, axis = self.structure()
        return near_in_order(order, boxes, highest, axis, box, slots, work)

    def structure(self) -> tuple:
        """Return (order, boxes, highest, axis), which is the argument `structure` of the kernel search_order."""
        if self.highest is None:
            self.highest = np.maximum.accumulate(self.boxes[: len(self.order), 1])
        return self.order, self.boxes, self.highest, self.axis

    def sweep(self, arena: Arena, pairs: np.ndarray, work: np.ndarray) -> int:
        return sweep_one(arena.proxies, self.order, len(self.order), self.boxes, self.next_changed, pairs, work)

    def intervals(self, arena: Arena, work: np.ndarray) -> tuple[np.ndarray, int]:
        """Return (keys, count): the sorted keys of the pairs with a changed proxy whose intervals on this axis overlap.

        Only the first `count` keys are valid. For their form see sweep_intervals. arena: see proxies.Arena; work:
        counters, see COUNTERS.
        """
        before = work.copy()
        count = sweep_intervals(
            arena.proxies, self.order, len(self.order), self.boxes, self.next_changed, self.keys, work
        )
        if count > len(self.keys):
            self.keys = np.zeros(count, np.int64)
            work[:] = before
            sweep_intervals(arena.proxies, self.order, len(self.order), self.boxes, self.next_changed, self.keys, work)
        self.keys[:count].sort()
        return self.keys, count


class SweepAndPrune:
    """Broad phase that sorts the boxes along one axis or along both axes (sweep and prune).

    axes: "auto": choose the axis with the greater variance of the boxes' centres; "both": sort along x and along y.

    Raises ValueError for another string, TypeError for a value that is not a string.
    """

    name = "sweep"
    incremental = True

    def __init__(self, axes: str = "auto") -> None:
        self.axes = checks.choice("axes", axes, ("auto", "both"))
        self.updates = 0
        self.sorted = [Axis(0), Axis(1)] if self.axes == "both" else [Axis(0)]

    def find_pairs(self, lower: ArrayLike, upper: ArrayLike) -> np.ndarray:
        """Return the pairs of overlapping or touching boxes: (m, 2) int32 indices a < b, sorted.

        lower, upper: corners of n boxes, (n, 2) [px].

        Raises TypeError for values that are not numbers, ValueError for a wrong shape, NaN, and lower > upper.
        """
        return find_pairs(self.fresh(), lower, upper)

    __copy__ = checks.independent("copy.deepcopy(…), or SweepAndPrune()")

    def fresh(self) -> "SweepAndPrune":
        """Return a new broad phase with the same settings and without proxies."""
        return SweepAndPrune(self.axes)

    def update(self, arena: Arena) -> None:
        """Sort the proxies again after some of them have changed.

        arena: the Arena with the proxies and the slots of the changed ones.

        With axes="auto", the axis is chosen again every AXIS_INTERVAL updates, and whenever most proxies are new.
        """
        self.updates += 1
        if self.axes == "auto" and (
            self.updates % AXIS_INTERVAL == 1 or len(arena.changed) > 2 * len(self.sorted[0].order)
        ):
            best = self._best_axis(arena.proxies)
            if best != self.sorted[0].axis:
                everything = arena.changed
                self.sorted = [Axis(best)]
                arena.changed = np.arange(len(arena.proxies), dtype=np.int64)
                self.sorted[0].update(arena)
                arena.changed = everything
                return
        for axis in self.sorted:
            axis.update(arena)

    def _best_axis(self, proxies):
        alive = proxies[proxies["row"] >= 0]
        now = self.sorted[0].axis
        if not len(alive):
            return now
        with np.errstate(over="ignore", invalid="ignore"):
            spread = [float(np.var(alive["lower_" + axis] + alive["upper_" + axis])) for axis in "xy"]
        needed = AXIS_SWITCH if len(self.sorted[0].order) else 1.0
        return 1 - now if spread[1 - now] > needed * spread[now] else now

    def query(self, arena: Arena) -> Query:
        """Return a function (pairs, work) -> count, which writes the overlapping pairs that contain a changed proxy.

        arena: the Arena with the proxies and the slots of the changed ones.

        The function writes the slots of each pair to `pairs`, (capacity, 2) int32. It returns the number of pairs, even
        if they do not fit, and increases `work`, the counters named in COUNTERS.
        """
        if self.axes == "auto":
            return lambda pairs, work: self.sorted[0].sweep(arena, pairs, work)

        def both(pairs, work):
            keys_x, count_x = self.sorted[0].intervals(arena, work)
            keys_y, count_y = self.sorted[1].intervals(arena, work)
            return intersect(arena.proxies, keys_x, count_x, keys_y, count_y, pairs, work)

        return both

    def query_box(self, proxies: np.ndarray, box: Box, slots: np.ndarray, work: np.ndarray) -> int:
        """Write the slots of the proxies whose boxes overlap a box to `slots`, and return the number of slots.

        proxies: PROXY table (unused); box: (lower x, lower y, upper x, upper y) [px].
        slots: array with room for all proxies, which is written; work: counters, see COUNTERS, which are increased.
        """
        return self.sorted[0].query_box(box, slots, work)

    def structure(self, proxies: np.ndarray) -> tuple:
        """Return (order, boxes, highest, axis), which is the argument `structure` of the kernel search_order.

        proxies: PROXY table, unused.
        """
        return self.sorted[0].structure()
