"""The candidate pairs, kept between steps: only pairs with a changed side are searched again."""

import numpy as np

from physics.broadphase.proxies import (
    Arena,
    Strategy,
    keep_pairs,
    mark_settled,
    merge_pairs,
    pair_keys,
    tell_rows,
    write_states,
)
from physics.shapes.shape import Filter
from physics.tables.shape import PART, PROXY
from physics.tables.step_state import CANDIDATES, COUNTERS, StepState, stage

SOLID, PIXEL, OUTLINE, SENSED, NOWHERE = 1, 2, 4, 8, 16
EVERYTHING = 31
AVOIDS = np.zeros(NOWHERE + 1, np.int64)  # by plane
AVOIDS[[SOLID, PIXEL, OUTLINE, SENSED, NOWHERE]] = (
    PIXEL | NOWHERE,
    EVERYTHING - SENSED,
    PIXEL | SENSED | NOWHERE,
    OUTLINE | NOWHERE,
    EVERYTHING,
)
NOBODY_COUNTS = np.zeros(len(COUNTERS), np.int64)


class PairList:
    """The proxies of the shapes of a world, and the sorted list of their pairs.

    `rows` (n, 2): shape rows of the candidates of this step. sleeping: new proxies are asleep until they are set awake;
    pairs without an awake side are not kept. Methods skip the slot -1 of a shape whose body is disabled (quarantine).
    """

    def __init__(self, sleeping: bool = False) -> None:
        self.sleeping = sleeping
        self.arena = Arena()
        self.free = []  # slots available to new shapes
        self.freed = []  # slots freed since the last update, still in the strategy
        self.slots = np.zeros((64, 2), np.int32)
        self.candidates = np.zeros((64, 2), np.int64)
        self.changed = np.zeros(64, np.int64)
        self.count = 0
        self.rows = self.candidates[:0]
        self.known_ids = self.owners = self.candidates[:0]  # None until they are read; owners as in SHAPE
        self.everything = False  # the strategy is new: pass it all proxies
        self.can_recycle = []  # slots whose pairs have to be searched again, besides those with changed boxes
        self.sensors = 0  # number of sensor proxies
        self.moved = False  # shape rows have moved since the last update
        self.resting = False  # pairs may have lost their last awake side
        self._make_room()

    def _make_room(self):
        """Create the arrays that an update writes before it reads them."""
        self.kept, self.kept_rows = np.zeros((64, 2), np.int32), np.zeros((64, 2), np.int64)
        self.states, self.keys = np.zeros(64, np.int8), np.zeros(64, np.int64)

    def __getstate__(self):
        room = ("kept", "kept_rows", "states", "keys")
        return {name: value for name, value in vars(self).items() if name not in room}

    def __setstate__(self, state):
        vars(self).update(state)
        self._make_room()

    @property
    def proxies(self) -> np.ndarray:
        return self.arena.proxies

    def ids(self, shapes: np.ndarray) -> np.ndarray:
        """Return the (n, 2) owner ids of the candidates; their rows refer to SHAPE rows unless named before."""
        if self.known_ids is None:
            owners = np.sort(self.name(shapes), axis=1)  # new parts of a mask are in rows after those of later shapes
            keys = np.unique(owners[:, 0] << 32 | owners[:, 1])  # each once, in the order of both
            self.known_ids = np.stack([keys >> 32, keys & 0xFFFFFFFF], axis=1)
        return self.known_ids

    def name(self, shapes: np.ndarray) -> np.ndarray:
        """Return the (n, 2) owner ids of the candidates, read while the given SHAPE rows are still valid."""
        if self.owners is None:
            self.owners = shapes["parent"][self.rows]
        return self.owners

    def add_proxies(self, shapes: np.ndarray, rows: np.ndarray, still: np.ndarray) -> None:
        """Assign a slot to each shape at these rows of a SHAPE array; still: whether each is static."""
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

    def free_proxies(self, slots: np.ndarray) -> None:
        """Remove shapes from the broad phase."""
        slots = slots[slots >= 0]
        self.sensors -= int(np.count_nonzero(self.proxies["plane"][slots] == SENSED))
        self.proxies["plane"][slots] = NOWHERE
        self.proxies["row"][slots] = -1
        self.proxies["changed"][slots] = True
        self.freed += slots.tolist()

    def touch(self, slots: np.ndarray) -> None:
        """Mark slots to have their swept AABBs written, and their pairs searched, again."""
        slots = slots[slots >= 0]
        self.proxies["changed"][slots] = True

    def let_sleep(self, sleeping: bool) -> None:
        """Set whether new proxies are asleep until they are set awake; otherwise all are awake."""
        self.sleeping = sleeping
        self.proxies["awake"] = not sleeping
        self.start_over()

    def set_awake(self, slots: np.ndarray, awake: bool) -> None:
        """Set whether slots are awake: pairs of woken slots are searched again, pairs of two sleeping ones dropped."""
        slots = slots[slots >= 0]
        self.proxies["awake"][slots] = awake
        if awake:
            known = slots[self.proxies["row"][slots] >= 0]  # a new proxy is listed with its swept AABB
            self.proxies["changed"][known] = True
            self.can_recycle.append(known)
        else:
            self.resting = True

    def room_for(self, count: int) -> np.ndarray:
        """Return an array for the slots that update_rectangles lists for `count` shapes."""
        if len(self.changed) < count:
            self.changed = np.zeros(2 * count, np.int64)
        return self.changed

    def rename(self, shapes: np.ndarray) -> None:
        """Write the new shape rows to the proxies after rows have moved; the next update writes the candidates'."""
        tell_rows(shapes, self.proxies)
        self.moved = True

    def widen(self, shapes: np.ndarray, margin: float) -> int:
        """Extend the swept AABBs of SHAPE rows by their present AABBs, grown by a margin [px], and list them as
        changed.

        Return their number.
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

    def set_filter(self, slots: np.ndarray, value: Filter) -> None:
        """Set the filter of slots."""
        slots = slots[slots >= 0]
        self.proxies["membership"][slots], self.proxies["mask"][slots] = value.membership, value.mask
        self.touch(slots)

    def set_sensor(self, shapes: np.ndarray, rows: np.ndarray) -> None:
        """Update the proxies after the shapes at these rows of a SHAPE array became sensors, or solid again."""
        rows = rows[shapes["proxy"][rows] >= 0]
        self._set_planes(shapes["proxy"][rows], shapes["role"][rows], shapes["sensor"][rows])
        self.touch(shapes["proxy"][rows])

    def _set_planes(self, slots, roles, sensors):
        """Write the planes of slots: sensors and pixel shapes pair with whole masks, solid shapes with their parts."""
        plane = np.where(sensors, SENSED, np.array([SOLID, PIXEL, OUTLINE])[roles])
        plane[sensors & (roles == PART)] = NOWHERE
        before = self.proxies["plane"][slots]
        self.sensors += int(np.count_nonzero(plane == SENSED)) - int(np.count_nonzero(before == SENSED))
        self.proxies["plane"][slots], self.proxies["avoids"][slots] = plane, AVOIDS[plane]

    def set_still(self, slots: np.ndarray, still: bool) -> None:
        """Set whether slots are static."""
        slots = slots[slots >= 0]
        self.proxies["still"][slots] = still
        self.touch(slots)

    def start_over(self) -> None:
        """Mark all proxies to be passed to a new strategy."""
        self.everything = True

    def update(self, strategy: Strategy, shapes: np.ndarray, changed_count: int, work: np.ndarray) -> None:
        """Update the candidates with `changed_count` slots in `self.changed`, and the freed ones."""
        news = changed_count or self.freed or self.can_recycle or self.everything or self.moved or self.resting
        if news or not strategy.incremental:
            self._take_in(strategy, shapes, changed_count, work)
        work[CANDIDATES] = self.count

    def _take_in(self, strategy, shapes, changed_count, work):
        arena = self.arena
        arena.work = work
        freed = np.array(self.freed, np.int64)
        if self.everything or not strategy.incremental:
            # A new strategy has no freed slots; no pair is kept.
            arena.changed = np.flatnonzero(self.proxies["row"] >= 0)
            self.proxies["changed"][arena.changed] = True
            self.proxies["changed"][freed] = False
            self.everything = False
            self.count = 0
            self.rows = self.known_ids = self.owners = self.candidates[:0]
        else:
            arena.changed = self.changed[:changed_count]
            if len(freed) or self.can_recycle:
                arena.changed = np.unique(np.concatenate([arena.changed, freed, *self.can_recycle]))
        self.can_recycle = []
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
        # Without changed proxies, pairs may only have fallen asleep: the strategy is not queried.
        found = arena.collect(strategy.query(arena)) if len(arena.changed) else 0
        if len(self.kept) < self.count:
            self.kept, self.kept_rows = np.zeros_like(self.slots), np.zeros_like(self.candidates)
        if len(self.states) < len(proxies):
            self.states = np.zeros(len(proxies), np.int8)
        if self.moved:
            self._rename(shapes)
        write_states(proxies, self.states[: len(proxies)])
        kept = keep_pairs(self.states, self.slots, self.candidates, self.count, self.kept, self.kept_rows)
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
        """Write the shape rows of the candidates again: removing a body without proxies moves rows."""
        self.candidates[: self.count] = self.proxies["row"][self.slots[: self.count]]
        self.rows = self.candidates[: self.count]
        self.known_ids = self.owners = None


@stage("broad_phase", reads=("broadphase", "pairs", "shapes", "changed_count"), writes=("pairs", "broadphase", "work"))
def broad_phase(state: StepState) -> None:
    """Find the pairs whose swept AABBs touch and whose filters agree."""
    state.pairs.update(state.broadphase, state.shapes, state.changed_count, state.work)
