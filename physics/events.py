"""Events of a step, as arrays: pairs that begin, continue or stop touching, hits, and overlaps with sensors."""

import math
from typing import Any, NamedTuple, cast

import numpy as np

from physics import hints
from physics.broadphase.proxies import cover_final_poses
from physics.collision.manifold import by_parent, is_before, is_of, measure_approach
from physics.collision.narrow_phase import SENSORS
from physics.islands.sleep import in_order
from physics.jit import copy_row, kernel, subkernel
from physics.shapes.placement import PLACED
from physics.tables.columns import BrokenRows, EventRows, HitRows, QuarantineRows
from physics.tables.contact import CONTACT, EVENT, HIT, QUARANTINE
from physics.tables.joint import BROKEN
from physics.tables.step_state import CONTACTS, StepState, WorldTables, stage
from physics.tables.table import joined, row_nearby, rows_of

NOTHING, NO_ROWS = np.zeros(0, CONTACT), np.zeros(0, np.int64)
NO_EVENTS, NO_HITS, UNBROKEN, NO_BROKEN = (cast(Any, np.zeros(0, each)) for each in (EVENT, HIT, QUARANTINE, BROKEN))


@subkernel
def write_event(contact, second, at, events_out):
    """Write the ids, the normal and one point of a CONTACT row to events_out[at], an EVENT row.

    second: True for the second point of the contact, False for the first point.
    """
    e = events_out[at]
    e.body_a, e.body_b = contact.body_a, contact.body_b
    e.shape_a, e.shape_b = contact.shape_a, contact.shape_b
    e.point_x = contact.x_2 if second else contact.x_1
    e.point_y = contact.y_2 if second else contact.y_1
    e.normal_x, e.normal_y = contact.normal_x, contact.normal_y


class Comparison(NamedTuple):
    """The output arrays of compare_pairs: the touching pairs of a step, and the differences from the previous step."""

    now: np.ndarray  # EVENT rows of the pairs that touch
    begin: np.ndarray  # EVENT rows of the pairs that began to touch
    persist: np.ndarray  # EVENT rows of the pairs that continue to touch
    end: np.ndarray  # EVENT rows of the pairs that stopped touching
    aside: np.ndarray  # EVENT rows of the touching pairs that fell asleep
    hits: np.ndarray  # HIT rows
    keep: np.ndarray  # bool for each contact, whether its pair touches
    counts: np.ndarray  # (7) numbers of rows: now, begin, persist, end, aside, hits; number of points of touching pairs


def new_comparison(room: int) -> Comparison:
    """Return a Comparison whose arrays have `room` rows each, one for each pair."""
    events = (np.zeros(room, EVENT) for _ in range(5))
    return Comparison._make((*events, np.zeros(room, HIT), np.zeros(room, np.bool_), np.zeros(7, np.int64)))


@subkernel
def look_at_pair(contacts, first, last, slop):
    """Summarise the contacts of one pair of shapes: the CONTACT rows first … last - 1. Return a tuple of eight values.

    1: whether the pair touches. 2: whether it has a normal impulse. 3: row of the deepest point. 4: whether this is the
    second point of its row. 5: row of the point with the greatest approach speed. 6: whether this is the second point
    of its row. 7: this speed [px/s]. 8: sum of the normal impulses. slop [px]: greatest separation that counts as
    touching.
    """
    active = False
    pushed = False
    deepest = first
    deepest_second = False
    fastest = first
    fastest_second = False
    least = math.inf
    most = -math.inf
    total = 0.0
    for i in range(first, last):
        m = contacts[i]
        for k in range(m.count):
            second = k == 1
            separation = m.separation_2 if second else m.separation_1
            speed = m.speed_2 if second else m.speed_1
            impulse = m.normal_impulse_2 if second else m.normal_impulse_1
            active = active or separation <= slop or impulse > 0.0 or m.swept
            pushed = pushed or impulse > 0.0
            total += impulse
            if separation < least:
                least = separation
                deepest = i
                deepest_second = second
            if speed > most:
                most = speed
                fastest = i
                fastest_second = second
    return active, pushed, deepest, deepest_second, fastest, fastest_second, most, total


@kernel
def compare_pairs(before, contacts, fell_asleep, sensors, persisting, slop, hit_speed, comparison_inout):
    """Compare the pairs that touched in the last step with the contacts of this step, and write the changes.

    Return False if a contact belongs to a part of a shape, otherwise True. The comparison stops at such a contact; the
    caller must replace the ids of parts by those of whole shapes and call again. O(before + contacts).

    before: EVENT rows of the pairs that touched in the last step; contacts: CONTACT rows of this step; both sorted by
    shape ids. fell_asleep: CONTACT rows of pairs whose island fell asleep. Such pairs still touch; they are not
    reported, but written to comparison_inout.aside. comparison_inout: a Comparison.

    sensors: 1: read only contacts of sensors, 0: read only other contacts. persisting: 1: report pairs that continue to
    touch. slop [px]: greatest separation at which a pair that touched before still touches. hit_speed [px/s]: approach
    speed above which a hit is reported.
    """
    counts = comparison_inout.counts
    now = comparison_inout.now
    begin = comparison_inout.begin
    persist = comparison_inout.persist
    keep = comparison_inout.keep
    hits = comparison_inout.hits
    for k in range(len(counts)):
        counts[k] = 0
    i, j = 0, 0
    asleep = 0
    while i < len(before) or j < len(contacts):
        if j < len(contacts) and contacts[j].sensor != (sensors == 1):
            j += 1
            continue
        # Merge in the order of shape ids. old: the next pair touched before; new: the next pair has contacts now.
        old = j >= len(contacts)
        new = i >= len(before)
        if not (old or new):
            p = before[i]
            m = contacts[j]
            old = p.shape_a < m.shape_a or (p.shape_a == m.shape_a and p.shape_b <= m.shape_b)
            new = not old or (p.shape_a == m.shape_a and p.shape_b == m.shape_b)
        if not new:
            p = before[i]
            while asleep < len(fell_asleep) and is_before(fell_asleep[asleep], p.shape_a, p.shape_b):
                asleep += 1
            if asleep < len(fell_asleep) and is_of(fell_asleep[asleep], p.shape_a, p.shape_b):
                copy_row(p, comparison_inout.aside[counts[4]])
                counts[4] += 1
            else:
                copy_row(p, comparison_inout.end[counts[3]])
                counts[3] += 1
            i += 1
            continue
        m = contacts[j]
        if sensors == 0 and m.of_child:
            return False
        last = j
        while last < len(contacts) and contacts[last].shape_a == m.shape_a and contacts[last].shape_b == m.shape_b:
            last += 1
        if last - j == 1 and m.count == 1:
            # Most pairs have one contact with one point.
            impulse = m.normal_impulse_1
            pushed = impulse > 0.0
            active = m.separation_1 <= (slop if old else 0.0) or pushed or m.swept
            speed = m.speed_1
            deepest = j
            fastest = j
            deepest_second = False
            fastest_second = False
        else:
            active, pushed, deepest, deepest_second, fastest, fastest_second, speed, impulse = look_at_pair(
                contacts, j, last, slop if old else 0.0
            )
        if active:
            d = contacts[deepest]
            write_event(d, deepest_second, counts[0], now)
            counts[0] += 1
            if not old:
                write_event(d, deepest_second, counts[1], begin)
                counts[1] += 1
            elif persisting == 1:
                write_event(d, deepest_second, counts[2], persist)
                counts[2] += 1
            if (pushed or not old) and speed > hit_speed:
                write_event(contacts[fastest], fastest_second, counts[5], hits)
                hits[counts[5]].speed = speed
                hits[counts[5]].normal_impulse = impulse
                counts[5] += 1
        elif old:
            copy_row(before[i], comparison_inout.end[counts[3]])
            counts[3] += 1
        for k in range(j, last):
            keep[k] = active
            if active:
                counts[6] += contacts[k].count
        if old:
            i += 1
        j = last
    return True


class Changes:
    """The changes of the touching pairs in one step, without unused rows. For the fields see Comparison.

    The arrays are valid until the next call of Pairs.compare.
    """

    __slots__ = ("aside", "begin", "end", "hits", "keep", "persist", "points")

    begin: Any  # EVENT
    persist: Any
    end: Any
    aside: np.ndarray  # EVENT rows of the touching pairs that fell asleep
    hits: Any  # HIT
    keep: np.ndarray  # bool for each contact, whether its pair touches
    points: int  # number of contact points of touching pairs


class Pairs:
    """The pairs of shapes that touch, as EVENT rows, and their changes in the last step."""

    def __init__(self) -> None:
        self._make_room(16)
        self.count = 0

    def _make_room(self, room):
        """Allocate the arrays of the last and the next comparison, with `room` rows each. The old contents are lost."""
        compared = new_comparison(room)
        self.compared, self.last, self.changes = compared, compared._replace(now=np.zeros(room, EVENT)), Changes()

    def __getstate__(self):
        return self.rows.copy()  # the other arrays are scratch for later comparisons

    def __setstate__(self, touching):
        self._make_room(16)
        self.restore(touching)

    @property
    def rows(self) -> np.ndarray:
        """EVENT rows (n,) of the pairs that touch, in the order of shape ids."""
        return self.last.now[: self.count]

    def compare(
        self,
        contacts: np.ndarray,
        fell_asleep: np.ndarray,
        sensors: bool,
        persisting: bool,
        slop: float,
        hit_speed: float,
    ) -> Changes | None:
        """Update the touching pairs from the contacts of a step, and return the changes.

        If a contact belongs to a part of a shape, return None and change nothing. The arguments are described in
        compare_pairs.
        """
        if self.count + len(contacts) > len(self.compared.keep):
            self._grow(2 * (self.count + len(contacts)))
        compared, changes = self.compared, self.changes
        flags = int(sensors), int(persisting)
        if not compare_pairs(self.rows, contacts, fell_asleep, *flags, slop, hit_speed, compared):
            return None
        # The next comparison starts from the pairs that touch now.
        self.compared, self.last = self.last, compared
        self.count, begin, persist, end, aside, hits, changes.points = compared.counts.tolist()
        changes.begin = compared.begin[:begin] if begin else NO_EVENTS
        changes.persist = compared.persist[:persist] if persist else NO_EVENTS
        changes.end = compared.end[:end] if end else NO_EVENTS
        changes.aside = compared.aside[:aside] if aside else NO_EVENTS
        changes.hits = compared.hits[:hits] if hits else NO_HITS
        changes.keep = compared.keep[: len(contacts)]
        return changes

    def _grow(self, room):
        before = self.rows
        self._make_room(room)
        self.last.now[: len(before)] = before

    def give_back(self, rows: np.ndarray) -> None:
        """Add touching pairs that were in the sleeping set. rows: EVENT rows (n,) of these pairs."""
        if len(rows):
            both = joined([self.rows, rows])
            self.restore(both[np.lexsort((both["shape_b"], both["shape_a"]))])

    def take_resting(self, bodies: np.ndarray) -> np.ndarray:
        """Remove the pairs whose two bodies are both not active, and return their EVENT rows for the sleeping set.

        bodies: BODY rows.
        """
        rows = self.rows
        if not len(rows):
            return rows.copy()
        resting = np.ones(len(rows), bool)
        for side in ("body_a", "body_b"):
            at = rows_of(bodies, rows[side])
            resting &= (at >= 0) & ~bodies["active"][at]  # pairs of removed bodies remain, and end
        taken = rows[resting]
        if len(taken):
            self.restore(rows[~resting])
        return taken

    def restore(self, touching: np.ndarray) -> None:
        """Replace all touching pairs by those in `touching`, EVENT rows in the order of shape ids."""
        if len(touching) > len(self.compared.keep):
            self._make_room(2 * len(touching))
        self.count = len(touching)
        self.last.now[: self.count] = touching


@kernel
def collect_bodies(touching, shapes, pairs_out):
    """Write the body ids a < b of touching pairs. Return (number of pairs written, whether they are sorted).

    Pairs with a shape that was removed after the step are omitted. A pair of bodies is written once if it occurs in
    consecutive rows. touching: EVENT rows (n,); pairs_out: (n, 2) int64. O(n) if no shape was ever removed, otherwise
    O(n log shapes).
    """
    found = 0
    in_order = True
    for i in range(len(touching)):
        t = touching[i]
        if row_nearby(shapes, t.shape_a) < 0 or row_nearby(shapes, t.shape_b) < 0:
            continue
        a, b = min(t.body_a, t.body_b), max(t.body_a, t.body_b)
        if found > 0:
            last_a, last_b = pairs_out[found - 1, 0], pairs_out[found - 1, 1]
            if a == last_a and b == last_b:
                continue
            in_order = in_order and (a > last_a or (a == last_a and b > last_b))
        pairs_out[found, 0], pairs_out[found, 1] = a, b
        found += 1
    return found, in_order


def touching_bodies(world: WorldTables) -> np.ndarray:
    """Return the pairs of touching bodies, awake and asleep, as a sorted array (n, 2) int64 of ids a < b, each once."""
    asleep = world.sleeping_set
    parts = [world.touching_pairs.rows, asleep.touching_pairs, *(each.touching for each in asleep.islands.values())]
    parts = [each for each in parts if len(each)] or parts[:1]
    touching = parts[0] if len(parts) == 1 else joined(parts)
    pairs = np.empty((len(touching), 2), np.int64)
    count, in_order = collect_bodies(touching, world.shapes, pairs)
    pairs = pairs[:count]
    if in_order:
        return pairs
    pairs = pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]
    new = np.ones(len(pairs), bool)
    new[1:] = (pairs[1:] != pairs[:-1]).any(axis=1)
    return pairs[new]


# ---- sensors ---------------------------------------------------------------------------------------------------------
# Overlaps of sensors at the final poses of a step, in worlds with the effect response.


@kernel
def is_any_sensor(pairs, shapes):
    """Return whether any pair contains a sensor. pairs: SHAPE row numbers (n, 2). O(pairs)."""
    for i in range(len(pairs)):
        if shapes[pairs[i, 0]].sensor or shapes[pairs[i, 1]].sensor:
            return True
    return False


@stage(
    "sensors",
    reads=(
        "awake",
        "bodies",
        "shapes",
        "library",
        "pairs",
        "broadphase",
        *("effects", "stacks", "tolerances", "gravity", "dt"),  # for new swept AABBs
        "swept_sensors",
        "workspace",
    ),
    writes=("sensed", "swept_sensors", "pairs", "broadphase", "work", "workspace", "library", *PLACED),
)
def sense(state: StepState) -> None:
    """Detect overlaps with sensors at the final poses of the step, and add those found by the continuous sweep."""
    bodies, shapes, swept = state.bodies, state.shapes, state.swept_sensors
    # Without sensors the loops are empty. The same kernels are called in every step, so that none has to be compiled
    # when the first sensor is added.
    asked = state.pairs.sensors > 0
    cover_final_poses(state, state.awake.shapes if asked else NO_ROWS)
    pairs = state.pairs.rows
    if not is_any_sensor(pairs if asked else pairs[:0], shapes) and not len(swept):
        state.sensed = NOTHING
        return
    sensed = state.workspace.sensing.collide(state.library, bodies, shapes, pairs, 0.0, state.work, which=SENSORS)
    if len(swept):
        known = sensed["shape_a"] << 32 | sensed["shape_b"]
        swept = swept[~np.isin(swept["shape_a"] << 32 | swept["shape_b"], known)]
        sensed = in_order(joined([sensed, swept]))
        state.swept_sensors = swept[:0]
    measure_approach(bodies, sensed)
    state.sensed = sensed


# ---- events ----------------------------------------------------------------------------------------------------------


class Events(metaclass=hints.WithForeignNames):
    """The events of the last step, one structured array for each kind. They are valid until the next step.

    begin: EVENT rows of the pairs of shapes that began to touch; end: EVENT rows of the pairs that stopped touching.
    persist: EVENT rows of the pairs that continue to touch; empty without the effect `persist`.
    sensor_begin, sensor_end: EVENT rows of the overlaps with sensors that began and ended; empty without the effect
        `sensors`.
    hits: HIT rows of the contacts that began, or have an impulse, with an approach speed above 1 m/s.
    quarantined: QUARANTINE rows of the bodies that were disabled because a number was not finite or out of range.
    broken: BROKEN rows of the joints that broke, or that were removed together with a body or a coupled joint.

    A row of a pair contains the ids of its two bodies in body_a and body_b: world.body(row["body_a"]). Body A has the
    shape with the smaller id; for example, a sensor that was added first is A.
    """

    begin: EventRows
    persist: EventRows
    end: EventRows
    sensor_begin: EventRows
    sensor_end: EventRows
    hits: HitRows
    quarantined: QuarantineRows
    broken: BrokenRows

    def __init__(self) -> None:
        self.begin = self.persist = self.end = self.sensor_begin = self.sensor_end = NO_EVENTS
        self.hits = NO_HITS
        self.quarantined = UNBROKEN
        self.broken = NO_BROKEN

    def __repr__(self):
        """Return a text with the number of events of each kind, and the speed of the fastest hit."""
        counts = [f"{name}={len(rows)}" for name, rows in vars(self).items()]
        fastest = f", fastest hit {self.hits['speed'].max():.4g} px/s" if len(self.hits) else ""
        return f"Events({', '.join(counts)}{fastest})"


@stage(
    "events",
    reads=(
        "effects", "tolerances", "bodies", "contact_rows", "sensed", "fell_asleep", "touching_pairs", "sensing_pairs",
        "sleeping_set", "events", "reported",
    ),
    writes=("touching_pairs", "sensing_pairs", "sleeping_set", "events", "reported", "work"),
)  # fmt: skip
def report_events(state: StepState) -> None:
    """Compare the touching pairs of this step with those of the last step, and write the changes to the Events."""
    contacts, events, tolerances, effects = state.contact_rows, state.events, state.tolerances, state.effects
    fell_asleep, keys = state.fell_asleep or (NOTHING, None)
    usual = False, effects.persist, tolerances.slop, tolerances.hit_speed
    compared = order = None
    if keys is None:
        compared = state.touching_pairs.compare(contacts, fell_asleep, *usual)
    if compared is None:
        whole, order = by_parent(contacts)
        fell_asleep, parked_order = by_parent(fell_asleep)
        if keys is not None and parked_order is not None:
            keys = keys[parked_order]
        compared = state.touching_pairs.compare(whole, fell_asleep, *usual)
    events.begin, events.persist, events.end, events.hits = (
        compared.begin,
        compared.persist,
        compared.end,
        compared.hits,
    )
    keep = compared.keep
    if order is not None:
        keep = np.empty_like(keep)
        keep[order] = compared.keep
    if effects.sensors:
        sensed = contacts if state.sensed is None else state.sensed
        if len(sensed) or state.sensing_pairs.count:
            found = state.sensing_pairs.compare(sensed, NOTHING, True, False, 0.0, np.inf)
            events.sensor_begin, events.sensor_end = found.begin, found.end
        if state.sensed is None:
            keep = keep & ~contacts["sensor"]
    if keys is not None:
        if len(compared.aside):
            state.sleeping_set.keep_touching(compared.aside, fell_asleep, keys)
        state.sleeping_set.keep_reported(state)
    state.reported = (contacts, keep)
    state.work[CONTACTS] = compared.points
