"""Search index of queries between steps, and the boxes that the last query visited in the broad phase."""

from math import floor
from typing import Any, NamedTuple, Protocol

import numpy as np

from physics.annotations import Coordinates
from physics.broadphase.dynamic_tree import ROOT_MOVING, DynamicTree
from physics.broadphase.proxies import Box, Strategy
from physics.broadphase.spatial_hash import CELL_RANGE, LEVELS, SpatialHashGrid
from physics.broadphase.sweep_and_prune import SweepAndPrune
from physics.dynamics.integrate import is_within_limits
from physics.jit import kernel, subkernel
from physics.shapes.placement import add_missing_rasters, refresh_aabbs
from physics.tables.step_state import COUNTERS, PAIRS_TESTED, WorldTables

# ---- index -----------------------------------------------------------------------------------------------------------
# The shapes that may meet a box at present, found in the data structure of the broad phase between steps.
#
# The structure has the state of the last step. Shapes that were added since, or are no longer inside their boxes, are
# listed as loose and compared one by one. So a query has the same result as a search of all shapes. Callers may write
# poses into world.bodies. So the poses are compared with the poses last read, in one pass over the bodies that may have
# moved.

ROUNDING = 2.0**-48  # margin of a searched box relative to its coordinates, because casts are also rounded


@subkernel
def is_found(body):
    """Return whether queries find a body (BODY row): it is not quarantined, and its pose is finite and in range."""
    return is_within_limits(body) and not body.quarantined


@kernel
def find_moved(rows, bodies, poses_inout, moved_out):
    """Find the bodies whose pose has changed since the last call. Return the number of these bodies. O(rows).

    rows: BODY row numbers of the bodies to compare; poses_inout: (bodies, 3) poses (x, y, angle) at the last call,
    which are updated; moved_out: BODY row numbers of the bodies that have moved.
    """
    found = 0
    for n in range(len(rows)):
        k = rows[n]
        b = bodies[k]
        if not is_found(b):
            continue
        if poses_inout[k, 0] != b.x or poses_inout[k, 1] != b.y or poses_inout[k, 2] != b.angle:
            poses_inout[k, 0] = b.x
            poses_inout[k, 1] = b.y
            poses_inout[k, 2] = b.angle
            moved_out[found] = k
            found += 1
    return found


@kernel
def find_loose(rows, bodies, shapes, proxies, known, row_of_slot_inout, loose_out):
    """Find the loose shapes, which a search of the broad phase may miss. Return the number of these shapes. O(rows).

    The broad phase finds a shape if its AABB is within the box of its proxy. Then the shape's row number is written to
    row_of_slot_inout[slot of the proxy]. Otherwise -1 is written there, and the row number is written to loose_out.
    Shapes of bodies that queries do not find (see is_found) are in neither array. rows: SHAPE row numbers of the shapes
    to examine; known: 0 if the broad phase has no data yet, else 1; proxies: PROXY table.
    """
    found = 0
    for n in range(len(rows)):
        row = rows[n]
        s = shapes[row]
        if not is_found(bodies[s.body_row]):
            if s.proxy >= 0:
                row_of_slot_inout[s.proxy] = -1
            continue
        held = False
        if known == 1 and s.proxy >= 0:
            p = proxies[s.proxy]
            held = (
                p.row >= 0
                and not p.changed
                and p.lower_x <= s.min_x
                and p.upper_x >= s.max_x
                and p.lower_y <= s.min_y
                and p.upper_y >= s.max_y
            )
        if s.proxy >= 0:
            row_of_slot_inout[s.proxy] = row if held else -1
        if not held:
            loose_out[found] = row
            found += 1
    return found


@subkernel
def meets_aabb(shape, box):
    """Return whether the AABB of a shape (SHAPE row) overlaps or touches a box.

    box: (lower x, lower y, upper x, upper y) [px].
    """
    return shape.min_x <= box[2] and shape.max_x >= box[0] and shape.min_y <= box[3] and shape.max_y >= box[1]


@kernel
def rows_meeting(shapes, row_of_slot, slots, loose, box, rows_out, work_inout):
    """Find the shapes whose AABBs overlap or touch a box. Write their SHAPE row numbers, and return their number.

    slots: slots of the proxies that the broad phase found; row_of_slot: SHAPE row number for each slot, or -1; loose:
    SHAPE row numbers of further shapes to test; box: (lower x, lower y, upper x, upper y) [px]; rows_out: the result;
    work_inout: counters, see COUNTERS.
    """
    found = 0
    for k in range(len(slots) + len(loose)):
        if k >= len(slots):
            row = loose[k - len(slots)]
            work_inout[PAIRS_TESTED] += 1
        else:
            row = row_of_slot[slots[k]]
        if row < 0:
            continue
        if meets_aabb(shapes[row], box):
            rows_out[found] = row
            found += 1
    return found


def is_same(now: tuple, before: tuple) -> bool:
    """Return whether two tuples contain identical objects in the same order. Ints are compared by value."""
    return len(now) == len(before) and all(
        a is b or (type(a) is int and a == b) for a, b in zip(now, before, strict=True)
    )


class IndexedWorld(WorldTables, Protocol):
    """Protocol of a World or a StepState that has a QueryIndex of its shapes."""

    queries: "QueryIndex"
    steps: int

    @property
    def broadphase(self) -> Strategy:
        """The broad phase whose data structure queries search."""
        ...


class AskedWorld(IndexedWorld, Protocol):
    """Protocol of the attributes of a World that queries use.

    An attribute is annotated Any if its type is defined in a module that imports this module.
    """

    def body(self, identity: int) -> Any:
        """Return the Body with an id."""
        ...


class QueryIndex:
    """The search index of one world's shapes for queries by boxes, and the work counters of the last query.

    asked: the boxes (lower x, lower y, upper x, upper y) [px] that the last query searched, in order. work: the work
    counters, which are separate from those of the last step. outlines: a batches.OutlineStore, the outlines of masks at
    which rays were cast.
    """

    def __init__(self) -> None:
        self.work = np.zeros(len(COUNTERS), np.int64)
        self.asked: Any = []  # Box tuples, or an array (n, 4)
        self.seen = ()  # the tables that were read; other tables make the index stale
        self.step = -1  # the step after which the index was last refreshed
        self.awake = np.zeros(0, np.int64)  # body rows that were awake at the last refresh
        self.lists, self.watched = (), np.zeros(0, np.int64)
        self.poses = np.zeros((0, 3))
        self.moved = np.zeros(0, np.int64)
        self.row_of_slot = np.zeros(0, np.int64)
        self.loose = self.rows = np.zeros(0, np.int64)
        self.slots = np.zeros(0, np.int64)
        self.loose_count = 0
        self.stamps, self.stamp = np.zeros(0, np.int64), 1  # see batches.Targets
        self.corners = np.zeros((16, 2))
        self.outlines: Any = None  # made by batches, which imports this file

    def __getstate__(self):
        return self.work, self.asked  # the other attributes belong to tables that a copy does not have

    def __setstate__(self, state):
        self.__init__()
        self.work, self.asked = state

    @property
    def counters(self) -> dict[str, int]:
        """The work counters of the last query, {name: int}, with all names in COUNTERS."""
        return dict(zip(COUNTERS, self.work.tolist(), strict=True))

    def begin(self, world: IndexedWorld) -> None:
        """Start a query: reset the counters, and update the index to the present poses of the world's bodies."""
        self.work[:] = 0
        self.asked = []
        self.refresh(world)

    def asks_broadphase(self, world: IndexedWorld) -> bool:
        """Return whether queries search the broad phase: it has data, and at least one shape is not loose."""
        return not world.pairs.everything and self.loose_count < len(world.shapes)

    def refresh(self, world: IndexedWorld) -> None:
        """Update the AABBs of shapes to the present poses, and the list of loose shapes.

        Loose shapes are those that a search of the broad phase may miss. If no body has moved since the last call,
        nothing is done. After a step of a world with sleeping, only some bodies are read: those that were awake before
        or after the step, were moved by the caller, or were edited. Otherwise all bodies are read. world: a World or a
        StepState.
        """
        bodies, shapes, pairs, awake = world.bodies, world.shapes, world.pairs, world.awake
        newest = int(shapes["id"][-1]) if len(shapes) else -1
        seen = (pairs, world.broadphase, len(bodies), len(shapes), newest, len(pairs.free), pairs.everything)
        known = seen == self.seen
        some = known and awake.sleeping and awake.is_known(bodies, shapes) and world.steps - self.step <= 1
        rows = self._watched(awake, bodies) if some else np.arange(len(bodies))
        if not known:
            self._grow(bodies, shapes, pairs)
        moved = find_moved(rows, bodies, self.poses, self.moved)
        if known and world.steps == self.step:
            if not moved:
                return
            rows = self.moved[:moved]  # the boxes in the structure have not changed
        self.seen, self.step = seen, world.steps
        self.awake = np.arange(len(bodies)) if awake.stale else awake.bodies  # a stale index may name removed rows
        of = awake.shapes_of(rows) if some else np.arange(len(shapes))
        if some:
            of = np.union1d(of, self.loose[: self.loose_count])
        else:
            self.row_of_slot[:] = -1
        add_missing_rasters(world.library, of, bodies, shapes, 0.0)
        refresh_aabbs(of, world.library.tables, bodies, shapes)
        self.loose_count = find_loose(
            of, bodies, shapes, pairs.proxies, int(not pairs.everything), self.row_of_slot, self.loose
        )

    def _watched(self, awake, bodies):
        """Return the BODY row numbers of the bodies that may have moved since the last refresh.

        The result is cached while the lists of awake bodies are unchanged. awake: the world's Awake.
        """
        lists = (self.awake, awake.bodies, awake.dynamic, awake.kinematic)
        if awake.dirty or not is_same(lists, self.lists):
            self.lists, self.watched = lists, awake.may_move(bodies, self.awake)
        return self.watched

    def _grow(self, bodies, shapes, pairs):
        self.poses = np.full((len(bodies), 3), np.nan)
        self.moved = np.zeros(len(bodies), np.int64)
        self.lists = ()
        self.row_of_slot, self.slots = np.zeros(len(pairs.proxies), np.int64), np.zeros(len(pairs.proxies), np.int64)
        if len(self.loose) < len(shapes):
            self.loose, self.rows = np.zeros(2 * len(shapes), np.int64), np.zeros(2 * len(shapes), np.int64)
            self.stamps = np.zeros(2 * len(shapes), np.int64)

    def next_stamps(self, count: int) -> int:
        """Return the first of `count` consecutive unused stamps, which number rays, see batches.Workspace."""
        self.stamp += count
        return self.stamp - count

    def rows_in(self, world: IndexedWorld, lower: Coordinates, upper: Coordinates) -> np.ndarray:
        """Return the ascending SHAPE row numbers of the shapes whose AABBs overlap or touch a box.

        lower, upper: corners of the box (x, y) [px]. Shapes of quarantined (disabled) bodies are omitted.
        """
        reach = ROUNDING * max(abs(lower[0]), abs(lower[1]), abs(upper[0]), abs(upper[1]))
        box = (float(lower[0]) - reach, float(lower[1]) - reach, float(upper[0]) + reach, float(upper[1]) + reach)
        self.asked.append(box)
        found = 0
        if self.asks_broadphase(world):
            found = world.broadphase.query_box(world.pairs.proxies, box, self.slots, self.work)
        slots, loose = self.slots[:found], self.loose[: self.loose_count]
        count = rows_meeting(world.shapes, self.row_of_slot, slots, loose, box, self.rows, self.work)
        return np.sort(self.rows[:count])


# ---- visited ---------------------------------------------------------------------------------------------------------
# The boxes of the last query in the data structure of the broad phase, for drawing. These functions change nothing.
#
# The structure is searched once more, as by `query_box` of the strategies, with each box that the query searched.

CORNERS = ("lower_x", "lower_y", "upper_x", "upper_y")


class Visited(NamedTuple):
    """The boxes that the last query visited in the broad phase.

    kind: the broad phase, "brute", "sweep", "hash" or "tree".
    asked: (k, 4) boxes for which the query searched: min_x, min_y, max_x, max_y [px].
    rects: (m, 4) boxes with which these were compared, in order and with repetitions: nodes of the tree, cells of the
        hash, or AABBs [px].
    met: (m,) bool, whether each box in `rects` overlaps the searched box.
    """

    kind: str
    asked: np.ndarray
    rects: np.ndarray
    met: np.ndarray


def visited(world: IndexedWorld) -> Visited:
    """Return the boxes that the last query of a world visited, as a Visited.

    world: a World, which must not have changed since the query.
    """
    strategy, asked = world.broadphase, np.array(world.queries.asked).reshape(-1, 4)
    boxes = asked.tolist() if world.queries.asks_broadphase(world) else []
    found = [_rects(strategy, world.pairs.proxies, tuple(box)) for box in boxes]
    met = [_meets(rects, box) for rects, box in zip(found, asked, strict=False)]
    return Visited(
        strategy.name, asked, np.concatenate([np.zeros((0, 4)), *found]), np.concatenate([np.zeros(0, bool), *met])
    )


def _meets(rects, box):
    return (rects[:, 0] <= box[2]) & (rects[:, 2] >= box[0]) & (rects[:, 1] <= box[3]) & (rects[:, 3] >= box[1])


def _rects(strategy, proxies, box: Box) -> np.ndarray:
    if isinstance(strategy, DynamicTree):
        return _nodes(strategy, box)
    if isinstance(strategy, SpatialHashGrid):
        return _cells(strategy, proxies, box)
    if isinstance(strategy, SweepAndPrune):
        return _stretch(strategy, proxies, box)
    return _boxes(proxies[proxies["row"] >= 0])


def _boxes(rows):
    return np.stack([rows[name] for name in CORNERS], axis=1)


def _nodes(tree, box):
    """Return the boxes (n, 4) of the tree nodes that a search for `box` visits.

    They are the roots, and the children of all nodes that overlap the box.
    """
    boxes, children, height = _boxes(tree.nodes), tree.nodes[["child_a", "child_b"]], tree.nodes["height"]
    found, level = [], tree.state[ROOT_MOVING:]
    level = level[level >= 0]
    while len(level):
        found.append(boxes[level])
        inner = level[_meets(boxes[level], box) & (height[level] > 0)]
        level = np.concatenate([children["child_a"][inner], children["child_b"][inner]])
    return np.concatenate([np.zeros((0, 4)), *found])


def _cells(grid, proxies, box):
    """Return the boxes (n, 4) that a search for `box` compares on all levels of a SpatialHashGrid.

    On each level they are the cells that the box touches, or the AABBs of the level's proxies if these are fewer.
    """
    found, (x0, y0, x1, y1) = [np.zeros((0, 4))], box
    for level in np.flatnonzero(grid.lists.level_counts).tolist():
        size = grid.base * 2.0**level
        if level < LEVELS and max(map(abs, box)) < CELL_RANGE * size:
            left, top, right, bottom = (floor(each * (1.0 / size)) for each in box)
            most = grid.lists.level_counts[level] + 4
            if (right - left + 1) * (bottom - top + 1) <= most and (x1 - x0) / size + (y1 - y0) / size <= most:
                y, x = np.mgrid[top : bottom + 1, left : right + 1].reshape(2, -1) * size
                found.append(np.stack([x, y, x + size, y + size], axis=1))
                continue
        slots, slot = [], int(grid.lists.level_heads[level])
        while slot >= 0:
            slots.append(slot)
            slot = int(grid.lists.lists[slot, 1])
        found.append(_boxes(proxies[slots]))
    return np.concatenate(found)


def _stretch(sweep, proxies, box):
    """Return the AABBs (n, 4) of the proxies that a SweepAndPrune compares with `box`.

    They are the proxies whose intervals on the sorted axis may overlap the interval of the box.
    """
    axis = sweep.sorted[0]
    lows, highest = axis.boxes[: len(axis.order), 0], np.maximum.accumulate(axis.boxes[: len(axis.order), 1])
    first = int(np.searchsorted(highest, box[axis.axis]))
    last = int(np.searchsorted(lows, box[axis.axis + 2], side="right"))
    return _boxes(proxies[axis.order[first:last]])
