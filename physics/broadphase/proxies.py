"""Proxies of shapes for the broad phase, their swept AABBs, and the list of pairs whose swept AABBs overlap."""

from collections.abc import Callable
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import ArrayLike

from physics.jit import kernel, subkernel
from physics.math2d import norm
from physics.settings import AABB_MARGIN, AABB_MARGIN_FRACTION, AHEAD_FRACTION, STEPS_AHEAD
from physics.shapes.placement import (
    PLACED,
    add_missing_rasters,
    drawn_beyond,
    is_drawn_when_asked,
    refresh_boxes,
    snapped,
)  # fmt: skip
from physics.shapes.shape import Filter
from physics.tables.body import DYNAMIC, STATIC
from physics.tables.shape import PART, PIXELS, PROXY
from physics.tables.step_state import CANDIDATES, COUNTERS, FILTERED, PAIRS_TESTED, StepState, WorldTables, stage
from physics.tables.table import columns_of, distinct

# ---- proxies ---------------------------------------------------------------------------------------------------------
# The boxes that every broad phase works on, and the overlap test of two of them.
#
# A proxy is a slot of the PROXY table: box, filter, body. All strategies make the same test, and find the same pairs.
# A changed proxy is new or freed, or its box or filter has changed since the last update of the pairs.

Box = tuple[float, float, float, float]  # lower x, y, upper x, y [px]
Query = Callable[[np.ndarray, np.ndarray], int]  # (pairs, work) -> number of pairs


@subkernel
def overlaps(proxies, a, b, work_inout):
    """Return whether two proxies are a candidate pair: their boxes overlap or touch, and may_meet allows it. O(1).

    proxies: PROXY table; a, b: slots of the two proxies; work_inout: counters, see COUNTERS.
    """
    p, q = proxies[a], proxies[b]
    work_inout[PAIRS_TESTED] += 1
    if p.lower_x > q.upper_x or q.lower_x > p.upper_x or p.lower_y > q.upper_y or q.lower_y > p.upper_y:
        return False
    return may_meet(proxies, a, b, work_inout)


@subkernel
def may_meet(proxies, a, b, work_inout):
    """Return whether two proxies whose boxes overlap may be a candidate pair. O(1).

    The result is False for two static proxies, two sleeping proxies, and two proxies of one body. It is also False if
    the columns `plane` and `avoids`, or the collision filters, exclude the pair. Pairs excluded by filters are counted
    in work_inout[FILTERED]. proxies: PROXY table; a, b: slots of the two proxies.
    """
    p, q = proxies[a], proxies[b]
    if (p.still and q.still) or p.body == q.body or not (p.awake or q.awake) or (p.plane & q.avoids) != 0:
        return False
    if (p.membership & q.mask) == 0 or (q.membership & p.mask) == 0:
        work_inout[FILTERED] += 1
        return False
    return True


@subkernel
def meets_box(row, box):
    """Return whether the box of `row` overlaps or touches the box `box`.

    row: a PROXY row, or another record with lower_x, lower_y, upper_x, upper_y; box: (lower x, lower y, upper x,
    upper y) [px].
    """
    return row.lower_x <= box[2] and row.upper_x >= box[0] and row.lower_y <= box[3] and row.upper_y >= box[1]


@subkernel
def write_pair(a, b, found, pairs_out):
    """Write the slots (a, b) to pairs_out[found] if `found` is less than the capacity. Return found + 1. O(1).

    pairs_out: (capacity, 2) int32. If the number of pairs exceeds the capacity in the end, the caller enlarges the
    array and repeats the search.
    """
    if found < pairs_out.shape[0]:
        pairs_out[found, 0] = a
        pairs_out[found, 1] = b
    return found + 1


class Arena:
    """The data of one broad-phase update: proxies, slots of the changed proxies, array for pairs, and work counters."""

    def __init__(self) -> None:
        self.proxies = np.zeros(0, PROXY)
        self.changed = np.zeros(0, np.int64)  # slots, ascending: box, filter or existence changed
        self.pairs = np.zeros((64, 2), np.int32)  # slots, in any order
        self.work = np.zeros(len(COUNTERS), np.int64)

    def collect(self, query: Query) -> int:
        """Call `query` to write all pairs to self.pairs, and return the number of pairs.

        query: function (pairs, work) -> number of pairs, from Strategy.query. If the number exceeds the length of the
        array, the array is enlarged and the query repeated.
        """
        work = self.work.copy()
        count = query(self.pairs, self.work)
        if count > len(self.pairs):
            self.pairs = np.zeros((max(count, 2 * len(self.pairs)), 2), np.int32)
            self.work[:] = work
            count = query(self.pairs, self.work)
        return count


class Strategy(Protocol):
    """The interface of a broad phase: BruteForce, SweepAndPrune, SpatialHashGrid or DynamicTree.

    name: "brute", "sweep", "hash" or "tree".
    incremental: whether pairs of two unchanged proxies are kept from the last step without a test.
    """

    name: str
    incremental: bool  # whether the pairs of unchanged proxies are kept from the last step

    def find_pairs(self, lower: ArrayLike, upper: ArrayLike) -> np.ndarray:
        """Return the pairs of overlapping or touching boxes: (m, 2) int32 indices a < b, sorted.

        lower, upper: corners of n boxes, (n, 2) [px].

        Raises TypeError for values that are not numbers, ValueError for a wrong shape, NaN, and lower > upper.
        """
        ...

    def fresh(self) -> "Strategy":
        """Return a new broad phase with the same settings and without proxies."""
        ...

    def update(self, arena: Arena) -> None:
        """Update the data structure of the broad phase with the changed proxies, whose slots are in arena.changed.

        arena: the Arena with the proxies and the slots of the changed ones.
        """
        ...

    def query(self, arena: Arena) -> Query:
        """Return a function (pairs, work) -> count, which writes the overlapping pairs that contain a changed proxy.

        arena: the Arena with the proxies and the slots of the changed ones.

        The function writes the slots of each pair to `pairs`, (capacity, 2) int32. It returns the number of pairs, even
        if they do not fit, and increases `work`, the counters named in COUNTERS.
        """
        ...

    def query_box(self, proxies: np.ndarray, box: Box, slots: np.ndarray, work: np.ndarray) -> int:
        """Write the slots of the proxies whose boxes overlap a box to `slots`, and return the number of slots.

        proxies: PROXY table; box: (lower x, lower y, upper x, upper y) [px].
        slots: array with room for all proxies, which is written; work: counters, see COUNTERS, which are increased.

        Proxies whose boxes are only near the box may also be found.
        """
        ...

    def structure(self, proxies: np.ndarray) -> tuple:
        """Return the arrays and numbers with which a kernel finds the proxies whose boxes overlap a box.

        proxies: PROXY table.
        """
        ...


@kernel
def write_row_numbers(shapes, proxies_inout):
    """Write the number of each SHAPE row to the column `row` of the shape's proxy, after rows have moved. O(shapes).

    Shapes without a proxy, and proxies without a swept AABB, are skipped. proxies_inout: PROXY table.
    """
    for k in range(len(shapes)):
        slot = shapes[k].proxy
        if slot >= 0 and proxies_inout[slot].row >= 0:
            proxies_inout[slot].row = k


def write_states(proxies: np.ndarray, states_out: np.ndarray) -> None:
    """Write 2 · changed + awake of each proxy to states_out, where both flags are 0 or 1. O(proxies).

    proxies: PROXY table; states_out: (proxies,) int8. keep_pairs reads this compact copy of the flags for every pair.
    """
    np.left_shift(proxies["changed"].view(np.int8), 1, out=states_out)
    states_out |= proxies["awake"].view(np.int8)


@kernel
def keep_pairs(states, old, old_rows, old_count, kept_out, rows_out):
    """Copy the old pairs that have no changed proxy and at least one awake proxy. Return the number of pairs. O(pairs).

    Freed proxies count as changed. The order of the pairs is unchanged. states: (proxies,) int8, result of
    write_states; old, kept_out: (capacity, 2) int32, slots of each old and each copied pair; old_rows, rows_out:
    (capacity, 2) int64, the SHAPE row numbers of the same proxies; old_count: number of old pairs. The loop has no
    branch, because a branch would be mispredicted.
    """
    kept = 0
    for i in range(old_count):
        a = old[i, 0]
        b = old[i, 1]
        kept_out[kept, 0] = a
        kept_out[kept, 1] = b
        rows_out[kept, 0] = old_rows[i, 0]
        rows_out[kept, 1] = old_rows[i, 1]
        kept += int((states[a] | states[b]) == 1)
    return kept


@kernel
def drop_apart(proxies, count, apart, pairs_inout, work_inout):
    """Remove the pairs whose bodies must not collide. Return the number of remaining pairs. O(pairs · log apart).

    proxies: PROXY table; apart: sorted keys of the pairs of bodies that must not collide, see PairList.keep_apart;
    pairs_inout: (capacity, 2) int32, the slots of each pair; count: number of pairs in use; work_inout: counters, see
    COUNTERS.
    """
    kept = 0
    for i in range(count):
        a, b = proxies[pairs_inout[i, 0]].body, proxies[pairs_inout[i, 1]].body
        key = (min(a, b) << 32) | max(a, b)
        low, high = 0, len(apart)
        while low < high:
            middle = (low + high) // 2
            if apart[middle] < key:
                low = middle + 1
            else:
                high = middle
        if low < len(apart) and apart[low] == key:
            work_inout[FILTERED] += 1
            continue
        pairs_inout[kept, 0] = pairs_inout[i, 0]
        pairs_inout[kept, 1] = pairs_inout[i, 1]
        kept += 1
    return kept


@kernel
def pair_keys(proxies, pairs, count, pairs_inout, keys_out):
    """Order the two slots of each pair by their SHAPE row numbers, and write a sort key for each pair. O(pairs).

    proxies: PROXY table; pairs and pairs_inout are the same array, (capacity, 2) int32, the slots of each pair; count:
    number of pairs in use; keys_out: int64, lower row number << 32 | higher row number.
    """
    for i in range(count):
        a = pairs[i, 0]
        b = pairs[i, 1]
        row_a, row_b = proxies[a].row, proxies[b].row
        if row_a > row_b:
            pairs_inout[i, 0] = b
            pairs_inout[i, 1] = a
            row_a, row_b = row_b, row_a
        keys_out[i] = (row_a << 32) | row_b


@kernel
def merge_pairs(shapes, kept, kept_rows, kept_count, keys, new_count, pairs_out, candidates_out):
    """Merge the pairs kept from the last step with the new pairs, in the order of their SHAPE row numbers. O(pairs).

    kept: (n, 2) slots of the kept pairs; kept_rows: (n, 2) SHAPE row numbers of the kept pairs; kept_count: number of
    kept pairs; keys: sorted int64 keys (lower row << 32 | higher row) of the new pairs; new_count: number of new pairs;
    pairs_out: (capacity, 2) int32, slots of the merged pairs; candidates_out: (capacity, 2) int64, SHAPE row numbers of
    the merged pairs.
    """
    i = 0
    at = 0
    for j in range(new_count + 1):
        while i < kept_count and (j == new_count or ((kept_rows[i, 0] << 32) | kept_rows[i, 1]) < keys[j]):
            pairs_out[at, 0] = kept[i, 0]
            pairs_out[at, 1] = kept[i, 1]
            candidates_out[at, 0] = kept_rows[i, 0]
            candidates_out[at, 1] = kept_rows[i, 1]
            i += 1
            at += 1
        if j < new_count:
            row_a, row_b = keys[j] >> 32, keys[j] & 0xFFFFFFFF
            pairs_out[at, 0] = shapes[row_a].proxy
            pairs_out[at, 1] = shapes[row_b].proxy
            candidates_out[at, 0] = row_a
            candidates_out[at, 1] = row_b
            at += 1


@kernel
def mark_settled(changed, proxies_inout):
    """Set the flag `changed` of the proxies in the slots `changed` to False. O(changed). proxies_inout: PROXY table."""
    for i in range(len(changed)):
        proxies_inout[changed[i]].changed = False


# ---- rectangles ------------------------------------------------------------------------------------------------------
# Swept AABBs ("bounding motion rectangles"): the box that contains a shape during the whole step. The broad phase
# compares these boxes.
#
# A swept AABB is kept while it contains the box that the shape needs. In a world with stacking it has a margin on all
# sides, so that resting bodies need no updates. In other worlds it is extended along the motion for several steps, so
# that a moving body is updated once in several steps. This adds candidates, not contacts, because the narrow phase
# tests the tight boxes. Source: Catto, Box2D v3.2, constants.h (margin); Bullet, btDbvtBroadphase (boxes extended
# along the velocity).


class Reach(NamedTuple):
    """The parameters of a step from which swept AABBs are computed."""

    gravity_x: float  # [px/s2]
    gravity_y: float
    dt: float  # [s]
    margin: float  # [px] largest gap of a candidate pair
    spare: float  # [px] largest margin of a swept AABB …
    share: float  # … and its largest share of the box size
    ahead: float  # number of further steps by whose motion a swept AABB is extended


@kernel
def update_rectangles(rows, geometry, bodies, reach, shapes_inout, proxies_inout, changed_out):
    """Write the AABBs of the shapes in `rows`, and new swept AABBs where the old ones no longer fit. O(rows).

    Return the number of new swept AABBs, and write the slots of their proxies to changed_out. rows: SHAPE row numbers;
    geometry: tables of the shape library; bodies: BODY table; reach: a Reach; shapes_inout: SHAPE table; proxies_inout:
    PROXY table.
    """
    refresh_boxes(rows, geometry, bodies, shapes_inout)
    rasters = geometry.rasters
    dt = reach.dt
    margin = reach.margin
    ahead = reach.ahead
    found = 0
    for k in range(len(rows)):
        row = rows[k]
        s = shapes_inout[row]
        if s.proxy < 0:
            continue
        b = bodies[s.body_row]
        p = proxies_inout[s.proxy]
        fresh = p.row < 0
        p.row = row
        moved = b.x != b.previous_x or b.y != b.previous_y or b.angle != b.previous_angle
        if b.kind == STATIC and not (fresh or p.changed or moved):
            continue
        lower_x, lower_y = s.min_x, s.min_y
        upper_x, upper_y = s.max_x, s.max_y
        fat = 0.0
        ahead_x, ahead_y = 0.0, 0.0
        if is_drawn_when_asked(s):
            beyond = drawn_beyond(b, s)
            lower_x -= beyond
            lower_y -= beyond
            upper_x += beyond
            upper_y += beyond
        if b.kind != STATIC:
            dx, dy = dt * b.vx, dt * b.vy
            if b.kind == DYNAMIC:
                dx += dt * dt * (b.gravity_scale * reach.gravity_x + b.inverse_mass * b.force_x)
                dy += dt * dt * (b.gravity_scale * reach.gravity_y + b.inverse_mass * b.force_y)
            size = max(s.max_x - s.min_x, s.max_y - s.min_y)
            fat = min(reach.spare, reach.share * size)
            most = AHEAD_FRACTION * size
            steps = ahead
            if fresh and ahead > 0.0:
                steps = 1.0 + s.proxy % int(ahead)  # else shapes added together are always updated in the same step
            way_x, way_y = dx, dy
            if ahead > 0.0 and b.vx == 0.0 and b.vy == 0.0:
                # The caller may move the body in each step, and then probably goes on as in the last one.
                way_x, way_y = b.x - b.previous_x, b.y - b.previous_y
            ahead_x, ahead_y = min(max(steps * way_x, -most), most), min(max(steps * way_y, -most), most)
            # Rotation moves a point by at most its arc, or the diameter of its circle.
            arc = b.extent * min(abs(dt * b.angular_velocity), 2.0)
            if s.snap and s.role != PIXELS:
                # The mask is snapped to the pixel grid at both ends of the motion; at another angle its sides are
                # rounded again.
                r = rasters[s.raster]
                dx = float(snapped(b.x + dx, r.origin_x) - s.left)
                dy = float(snapped(b.y + dy, r.origin_y) - s.top)
                if b.angular_velocity != 0.0:
                    arc += 1.0
            lower_x += min(dx, 0.0) - arc - margin
            lower_y += min(dy, 0.0) - arc - margin
            upper_x += max(dx, 0.0) + arc + margin
            upper_y += max(dy, 0.0) + arc + margin
        fits = p.lower_x <= lower_x and p.lower_y <= lower_y and p.upper_x >= upper_x and p.upper_y >= upper_y
        room = max(fat, abs(ahead_x), abs(ahead_y))
        if room > 0.0:
            # The swept AABB of an earlier, faster step would be far too large.
            slack = 4.0 * room + norm(upper_x - lower_x, upper_y - lower_y)
            fits = fits and norm(p.upper_x - p.lower_x, p.upper_y - p.lower_y) <= slack
            p.idle = 0
        elif p.lower_x != lower_x or p.lower_y != lower_y or p.upper_x != upper_x or p.upper_y != upper_y:
            # A sprite moved by whole pixels may stand still in every second step.
            p.idle = min(p.idle + 1, int(ahead))
            fits = fits and p.idle < int(ahead)
        if fresh or p.changed or not fits:
            p.lower_x = lower_x - fat + min(ahead_x, 0.0)
            p.lower_y = lower_y - fat + min(ahead_y, 0.0)
            p.upper_x = upper_x + fat + max(ahead_x, 0.0)
            p.upper_y = upper_y + fat + max(ahead_y, 0.0)
            p.changed = True
            changed_out[found] = s.proxy
            found += 1
    return found


@kernel
def list_outside(rows, bodies, shapes, proxies, rows_out):
    """Find the shapes whose AABB, or whose drawn mask pixels, extend beyond their swept AABB. O(rows).

    Write their SHAPE row numbers to rows_out, and return the number of these shapes. rows: SHAPE row numbers to test;
    proxies: PROXY table.
    """
    found = 0
    for k in range(len(rows)):
        s = shapes[rows[k]]
        if s.proxy < 0:
            continue
        p = proxies[s.proxy]
        beyond = drawn_beyond(bodies[s.body_row], s)
        if (
            s.min_x - beyond < p.lower_x
            or s.max_x + beyond > p.upper_x
            or s.min_y - beyond < p.lower_y
            or s.max_y + beyond > p.upper_y
        ):
            rows_out[found] = rows[k]
            found += 1
    return found


def cover_final_poses(state: StepState, rows: np.ndarray) -> None:
    """Write new swept AABBs for the shapes in `rows` that have left their old ones, and search the shapes' pairs.

    Afterwards the candidate pairs contain all overlaps at the final poses of the step, and are valid for the next step.
    rows: SHAPE row numbers.
    """
    outside = state.workspace.rows_for(len(rows))
    found = list_outside(rows, state.bodies, state.shapes, state.pairs.proxies, outside)
    if found:
        changed = write_rectangles(state, outside[:found])
        state.pairs.update(state.broadphase, state.shapes, changed, state.work)


@stage(
    "motion_rectangles",
    reads=("effects", "stacks", "tolerances", "gravity", "dt", "awake", "bodies", "shapes", "library", "pairs"),
    writes=("pairs", "changed_count", "library", *PLACED),
)
def motion_rectangles(state: StepState) -> None:
    """Update the AABBs of all awake shapes, and their swept AABBs where these no longer fit."""
    state.changed_count = write_rectangles(state, state.awake.shapes)


def write_rectangles(tables: WorldTables, rows: np.ndarray) -> int:
    """Update the AABBs of the shapes in `rows`, and their swept AABBs where the old ones no longer fit.

    Return the number of proxies with new swept AABBs, whose slots are in tables.pairs.changed. rows: SHAPE row numbers;
    tables: a StepState, or a World whose shapes have just been added to the broad phase.
    """
    bodies, shapes, pairs, tolerances, dt = tables.bodies, tables.shapes, tables.pairs, tables.tolerances, tables.dt
    piles = tables.stacks
    add_missing_rasters(tables.library, rows, bodies, shapes, dt)
    # In worlds without stacking, velocities are integrated before this and already include gravity and forces.
    gravity_x, gravity_y = tables.gravity if tables.effects.gravity and piles else (0.0, 0.0)
    reach = Reach(
        gravity_x,
        gravity_y,
        dt,
        tolerances.speculative if piles else tolerances.slop,
        AABB_MARGIN * tolerances.pixels_per_meter if piles else 0.0,
        AABB_MARGIN_FRACTION if piles else 0.0,
        0.0 if piles else STEPS_AHEAD,
    )
    changed = pairs.room_for(len(rows))
    return update_rectangles(rows, tables.library.tables, bodies, reach, shapes, pairs.proxies, changed)


# ---- pair list -------------------------------------------------------------------------------------------------------
# The candidate pairs are kept between steps: only pairs with a changed side are searched again.

SOLID, PIXEL, OUTLINE, SENSED, NOWHERE = 1, 2, 4, 8, 16
EVERYTHING = 31
AVOIDS = np.zeros(NOWHERE + 1, np.int64)  # for each plane, the planes that it never pairs with
AVOIDS[[SOLID, PIXEL, OUTLINE, SENSED, NOWHERE]] = (
    PIXEL | NOWHERE,
    EVERYTHING - SENSED,
    PIXEL | SENSED | NOWHERE,
    OUTLINE | NOWHERE,
    EVERYTHING,
)
NOBODY_COUNTS = np.zeros(len(COUNTERS), np.int64)


class PairList:
    """The proxies of all shapes of a world, and the sorted list of their overlapping pairs, the candidates.

    The attribute rows, (n, 2), contains the SHAPE row numbers of the candidates. sleeping: whether new proxies are
    asleep until set_awake is called; pairs of two sleeping proxies are then dropped. Shapes of quarantined (disabled)
    bodies have slot -1, which all methods skip.
    """

    def __init__(self, sleeping: bool = False) -> None:
        self.sleeping = sleeping
        self.arena = Arena()
        self.free = []  # slots available to new shapes
        self.freed = []  # slots freed since the last update, which are still in the strategy
        self.slots = np.zeros((64, 2), np.int32)
        self.candidates = np.zeros((64, 2), np.int64)
        self.changed = np.zeros(64, np.int64)
        self.count = 0
        self.rows = self.candidates[:0]
        self.known_ids = self.owners = self.candidates[:0]  # None until they are read; owners: parent ids of SHAPE
        self.everything = False  # the strategy is new: pass it all proxies
        self.search_again = []  # slots whose pairs must be searched again, in addition to slots with changed boxes
        self.sensors = 0  # number of sensor proxies
        self.apart = np.zeros(0, np.int64)  # pairs of bodies that never pair, see keep_apart
        self.moved = False  # whether shape rows have moved since the last update
        self.resting = False  # whether pairs may have lost their last awake side
        self._make_room()

    def _make_room(self):
        """Allocate the scratch arrays. Each update overwrites their contents before it reads them."""
        self.kept, self.kept_rows = np.zeros((64, 2), np.int32), np.zeros((64, 2), np.int64)
        self.states, self.keys = np.zeros(64, np.int8), np.zeros(64, np.int64)
        self.viewed, self.views = None, {}  # columns of the proxies, for writes to single rows

    def __getstate__(self):
        room = ("kept", "kept_rows", "states", "keys", "viewed", "views")
        return {name: value for name, value in vars(self).items() if name not in room}

    def __setstate__(self, state):
        vars(self).update(state)
        self._make_room()

    @property
    def proxies(self) -> np.ndarray:
        return self.arena.proxies

    def ids(self, shapes: np.ndarray) -> np.ndarray:
        """Return the candidate pairs as shape ids, (n, 2), each pair once, sorted.

        Instead of the id of a part, the id of the whole shape is returned. shapes: the SHAPE table to which the
        candidates refer; it is not read if `name` was called since the last update.
        """
        if self.known_ids is None:
            owners = np.sort(self.name(shapes), axis=1)  # new parts of a mask have rows after those of later shapes
            keys = np.unique(owners[:, 0] << 32 | owners[:, 1])  # each pair once, ordered by both ids
            self.known_ids = np.stack([keys >> 32, keys & 0xFFFFFFFF], axis=1)
        return self.known_ids

    def name(self, shapes: np.ndarray) -> np.ndarray:
        """Return the ids of the whole shapes (SHAPE.parent) of all candidates, (n, 2), and store them for later calls.

        Call this method while the row numbers of the candidates are valid for the table `shapes`.
        """
        if self.owners is None:
            self.owners = shapes["parent"][self.rows]
        return self.owners

    def add_proxies(self, shapes: np.ndarray, rows: np.ndarray, still: np.ndarray) -> None:
        """Add a proxy for each shape in `rows`, and write its slot to SHAPE.proxy.

        shapes: SHAPE table; rows: row numbers (n,); still: (n,) bool, whether each shape is static.
        """
        while len(self.free) < len(rows):
            used = len(self.proxies)
            grown = np.zeros(max(64, 2 * used, used + len(rows)), PROXY)
            grown[:used] = self.proxies
            grown["row"][used:] = -1
            self.arena.proxies = grown
            self.free += range(len(grown) - 1, used - 1, -1)
        slots = np.array([self.free.pop() for _ in range(len(rows))], np.int64)
        shapes["proxy"][rows] = slots
        for name in ("body", "membership", "mask"):
            self.proxies[name][slots] = shapes[name][rows]
        self._set_planes(slots, shapes["role"][rows], shapes["sensor"][rows])
        self.proxies["still"][slots] = still
        self.proxies["awake"][slots] = not self.sleeping
        self.proxies["row"][slots] = -1  # until its swept AABB is written

    def add_proxy(self, slot: int, body: int, values: dict[str, int], still: bool) -> None:
        """Add the proxy of one new shape in a free slot, which the caller has taken from self.free.

        body: id of the shape's body; values: membership, mask, plane and avoids of the proxy by name; still: whether
        the shape is static.
        """
        if self.viewed is not self.arena.proxies:
            self.viewed = self.arena.proxies
            self.views = columns_of(self.viewed)
        views = self.views
        self.sensors += (values["plane"] == SENSED) - (views["plane"][slot] == SENSED)
        for name, value in values.items():
            views[name][slot] = value
        views["body"][slot], views["still"][slot], views["awake"][slot] = body, still, not self.sleeping
        views["row"][slot] = -1  # until its swept AABB is written

    def free_proxies(self, slots: np.ndarray) -> None:
        """Remove the proxies in these slots from the broad phase. slots: (n,) slots; -1 is skipped."""
        slots = slots[slots >= 0]
        self.sensors -= int(np.count_nonzero(self.proxies["plane"][slots] == SENSED))
        self.proxies["plane"][slots] = NOWHERE
        self.proxies["row"][slots] = -1
        self.proxies["changed"][slots] = True
        self.freed += slots.tolist()

    def touch(self, slots: np.ndarray) -> None:
        """Have the next step write the swept AABBs of these proxies and search their pairs again. slots: (n,) slots."""
        slots = slots[slots >= 0]
        self.proxies["changed"][slots] = True

    def let_sleep(self, sleeping: bool) -> None:
        """Set all present proxies and the initial state of new proxies to asleep (`sleeping` True) or awake (False)."""
        self.sleeping = sleeping
        self.proxies["awake"] = not sleeping
        self.start_over()

    def set_awake(self, slots: np.ndarray, awake: bool) -> None:
        """Set the proxies in these slots awake or asleep. awake: True for awake.

        The next update searches the pairs of woken proxies again, and drops the pairs of two sleeping proxies.
        """
        slots = slots[slots >= 0]
        self.proxies["awake"][slots] = awake
        if awake:
            known = slots[self.proxies["row"][slots] >= 0]  # a new proxy is listed when its swept AABB is written
            self.proxies["changed"][known] = True
            self.search_again.append(known)
        else:
            self.resting = True

    def room_for(self, count: int) -> np.ndarray:
        """Return self.changed, enlarged to at least `count` elements, for the slots that update_rectangles writes."""
        if len(self.changed) < count:
            self.changed = np.zeros(2 * count, np.int64)
        return self.changed

    def rename(self, shapes: np.ndarray) -> None:
        """Write the SHAPE row numbers of all shapes to their proxies again, after rows of `shapes` have moved.

        The next update also corrects the row numbers of the candidates.
        """
        write_row_numbers(shapes, self.proxies)
        self.moved = True

    def widen(self, shapes: np.ndarray, margin: float) -> int:
        """Extend the swept AABBs of shapes, so that they contain the AABBs enlarged by a margin [px].

        Return the number of changed proxies, whose slots are written to self.changed. shapes: SHAPE rows (n,).
        """
        shapes = shapes[shapes["proxy"] >= 0]  # shapes of disabled bodies have no proxy
        slots = shapes["proxy"]
        for low, high, axis in (
            ("lower_x", "min_x", -1.0),
            ("lower_y", "min_y", -1.0),
            ("upper_x", "max_x", 1.0),
            ("upper_y", "max_y", 1.0),
        ):
            pick = np.minimum if axis < 0.0 else np.maximum
            self.proxies[low][slots] = pick(self.proxies[low][slots], shapes[high] + axis * margin)
        self.proxies["changed"][slots] = True
        self.room_for(len(slots))[: len(slots)] = slots
        return len(slots)

    def keep_apart(self, keys: np.ndarray) -> bool:
        """Set the pairs of bodies that must not collide. Return whether they differ from the pairs set before.

        If they differ, the caller must call `touch` for the proxies of these bodies. keys: sorted int64 keys, lower
        body id << 32 | higher body id.
        """
        changed = not np.array_equal(keys, self.apart)
        self.apart = keys
        return changed

    def set_filter(self, slots: np.ndarray, value: Filter) -> None:
        """Set the collision filter of the proxies in these slots."""
        slots = slots[slots >= 0]
        self.proxies["membership"][slots], self.proxies["mask"][slots] = value.membership, value.mask
        self.touch(slots)

    def set_sensor(self, shapes: np.ndarray, rows: np.ndarray) -> None:
        """Update the proxies after the sensor flags of shapes changed. shapes: SHAPE table; rows: row numbers (n,)."""
        rows = rows[shapes["proxy"][rows] >= 0]
        self._set_planes(shapes["proxy"][rows], shapes["role"][rows], shapes["sensor"][rows])
        self.touch(shapes["proxy"][rows])

    def _set_planes(self, slots, roles, sensors):
        """Write the columns `plane` and `avoids` of proxies, which exclude pairs by the roles of the two shapes.

        Sensors pair with whole masks; solid shapes pair with the parts of masks. slots: slots (n,) of the proxies;
        roles: SHAPE.role of each shape; sensors: whether each shape is a sensor.
        """
        plane = np.where(sensors, SENSED, np.array([SOLID, PIXEL, OUTLINE])[roles])
        plane[sensors & (roles == PART)] = NOWHERE
        before = self.proxies["plane"][slots]
        self.sensors += int(np.count_nonzero(plane == SENSED)) - int(np.count_nonzero(before == SENSED))
        self.proxies["plane"][slots], self.proxies["avoids"][slots] = plane, AVOIDS[plane]

    def set_still(self, slots: np.ndarray, still: bool) -> None:
        """Set whether the proxies in these slots are static."""
        slots = slots[slots >= 0]
        self.proxies["still"][slots] = still
        self.touch(slots)

    def start_over(self) -> None:
        """Have the next update pass all proxies to the broad phase and search all pairs again."""
        self.everything = True

    def update(self, strategy: Strategy, shapes: np.ndarray, changed_count: int, work: np.ndarray) -> None:
        """Update the candidates after proxies were freed, touched, woken, or got new swept AABBs.

        strategy: the broad phase that finds the pairs; shapes: SHAPE table; changed_count: number of valid slots in
        self.changed; work: counters, see COUNTERS.
        """
        news = changed_count or self.freed or self.search_again or self.everything or self.moved or self.resting
        if news or not strategy.incremental:
            self._take_in(strategy, shapes, changed_count, work)
        work[CANDIDATES] = self.count

    def _take_in(self, strategy, shapes, changed_count, work):
        arena = self.arena
        arena.work = work
        freed = np.array(self.freed, np.int64)
        if self.everything or not strategy.incremental:
            # A new strategy does not contain the freed slots. No pair is kept.
            arena.changed = np.flatnonzero(self.proxies["row"] >= 0)
            self.proxies["changed"][arena.changed] = True
            self.proxies["changed"][freed] = False
            self.everything = False
            self.count = 0
            self.rows = self.known_ids = self.owners = self.candidates[:0]
        else:
            arena.changed = self.changed[:changed_count]
            if len(freed) or self.search_again:
                arena.changed = distinct(np.concatenate([arena.changed, freed, *self.search_again]), len(self.proxies))
        self.search_again = []
        if len(arena.changed) or (self.resting and self.count):
            if len(arena.changed):
                strategy.update(arena)
            self._collect(strategy, shapes)
            mark_settled(arena.changed, self.proxies)
        elif self.moved and self.count:
            self._rename(shapes)
        self.moved = self.resting = False
        self.free += self.freed
        self.freed = []
        arena.work = NOBODY_COUNTS  # the step's counters are released

    def _collect(self, strategy, shapes):
        arena, proxies = self.arena, self.proxies
        # Without changed proxies, pairs can only have fallen asleep, so the strategy is not queried.
        found = arena.collect(strategy.query(arena)) if len(arena.changed) else 0
        if len(self.kept) < self.count:
            self.kept, self.kept_rows = np.zeros_like(self.slots), np.zeros_like(self.candidates)
        if len(self.states) < len(proxies):
            self.states = np.zeros(len(proxies), np.int8)
        if self.moved:
            self._rename(shapes)
        write_states(proxies, self.states[: len(proxies)])
        kept = keep_pairs(self.states, self.slots, self.candidates, self.count, self.kept, self.kept_rows)
        if len(self.apart) and found:
            found = drop_apart(proxies, found, self.apart, arena.pairs, arena.work)
        if len(self.keys) < found:
            self.keys = np.zeros(2 * found, np.int64)
        pair_keys(proxies, arena.pairs, found, arena.pairs, self.keys)
        self.keys[:found].sort()
        total = kept + found
        if len(self.slots) < total:
            self.slots = np.zeros((2 * total, 2), np.int32)
            self.candidates = np.zeros((2 * total, 2), np.int64)
        merge_pairs(shapes, self.kept, self.kept_rows, kept, self.keys, found, self.slots, self.candidates)
        self.count = total
        self.rows = self.candidates[:total]
        self.known_ids = self.owners = None

    def _rename(self, shapes):
        """Write the SHAPE row numbers of the candidates again, after the removal of shapes has moved rows."""
        self.candidates[: self.count] = self.proxies["row"][self.slots[: self.count]]
        self.rows = self.candidates[: self.count]
        self.known_ids = self.owners = None


@stage("broad_phase", reads=("broadphase", "pairs", "shapes", "changed_count"), writes=("pairs", "broadphase", "work"))
def broad_phase(state: StepState) -> None:
    """Find the candidate pairs: the pairs of shapes whose swept AABBs overlap and whose filters allow a collision."""
    state.pairs.update(state.broadphase, state.shapes, state.changed_count, state.work)
