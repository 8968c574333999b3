"""Narrow phase of worlds with a stacking solver: contacts are recycled, or detected and matched with the last step.

A contact is recycled if the step uses it without a new narrow phase. Its points and normal are then only moved with the
bodies. All other contacts of the last step are stale, and their pairs are detected again.
"""

import math
from typing import NamedTuple

import numpy as np

from physics.collision.manifold import NOTHING, Batch, approach, is_before, is_of, mixed
from physics.collision.narrow_phase import (
    BIAS,
    GRAZE,
    SOLIDS,
    WITH_CHILD,
    NarrowPhase,
    is_of_child,
    kind_asked,
    no_work,
)
from physics.contacts.cache import can_recycle, is_finite, is_unmoved, reset_impulses, write_cache
from physics.islands.sleep import order_of
from physics.jit import copy_head, copy_row, inlined, kernel, subkernel
from physics.math2d import rotation_of
from physics.shapes.placement import refresh_aabbs
from physics.tables.contact import CONTACT, MANIFOLD_BYTES
from physics.tables.shape import CHAIN, MASK, PIXELS
from physics.tables.step_state import NARROW_TESTS, StepState, WorldTables, stage
from physics.tables.table import joined, rows_of, zeros_in_lines

NO_CONTACTS, NO_ROWS = np.zeros(0, CONTACT), np.zeros(0, np.int32)

# ---- matching --------------------------------------------------------------------------------------------------------
# Matching of new contacts with contacts of the last step: a new contact takes over the cached forces (warm start).

LARGEST_FORCE = 1e100  # a larger or non-finite cached force is reset to 0


@subkernel
def transfer_impulses(previous, first, contact_inout):
    """Copy the cached forces of the last step to the points of a new contact that have the same feature id.

    previous: CONTACT rows of the last step; first: index in `previous` of the first contact of the same pair of shapes.
    contact_inout: CONTACT row.
    """
    c = contact_inout
    for point in range(c.count):
        feature = c.feature_1 if point == 0 else c.feature_2
        k = first
        known = False
        while not known and k < len(previous) and is_of(previous[k], c.shape_a, c.shape_b):
            o = previous[k]
            second = o.count == 2 and o.feature_2 == feature and o.feature_1 != feature
            if o.feature_1 == feature or second:
                known = True
                normal_force = o.normal_force_2 if second else o.normal_force_1
                tangent_force = o.tangent_force_2 if second else o.tangent_force_1
                if point == 0:
                    c.normal_force_1 = normal_force
                    c.tangent_force_1 = tangent_force
                    c.rolling_force = 0.0 if second else o.rolling_force
                    c.persisted_1 = True
                else:
                    c.normal_force_2 = normal_force
                    c.tangent_force_2 = tangent_force
                    c.persisted_2 = True
            k += 1


@inlined
def touches(contact):
    """Return whether a CONTACT row of the last step had a normal impulse, or overlapped without approaching."""
    c = contact
    pushed = c.normal_impulse_1 + c.normal_impulse_2 > 0.0
    first = c.separation_1 <= 0.0 and c.speed_1 <= 0.0
    return pushed or first or (c.count == 2 and c.separation_2 <= 0.0 and c.speed_2 <= 0.0)


@inlined
def begin_step(geometry, p, q, a, b, contact_inout):
    """Prepare a contact for a new step: reset impulses and colour, write mixed material values and approach speeds.

    p, q: BODY rows of A and B; a, b: SHAPE rows of A and B. contact_inout: CONTACT row.
    """
    c = contact_inout
    c.normal_impulse_1, c.tangent_impulse_1 = 0.0, 0.0
    c.normal_impulse_2, c.tangent_impulse_2 = 0.0, 0.0
    c.color = -1
    forces = abs(c.normal_force_1) + abs(c.tangent_force_1) + abs(c.normal_force_2) + abs(c.tangent_force_2)
    if not forces + abs(c.rolling_force) < LARGEST_FORCE:
        reset_impulses(c)
    c.friction, c.restitution, rolling_resistance, surface_speed = mixed(geometry, a, b, c)
    # If these values are unchanged, no field of this cache line is written, and it needs no transfer to memory.
    if c.rolling_resistance != rolling_resistance or c.surface_speed != surface_speed:
        c.rolling_resistance = rolling_resistance
        c.surface_speed = surface_speed
    approach(p, q, c)


@subkernel
def complete_contact(geometry, bodies, shapes, previous, first, contact_inout):
    """Write the cache of a contact detected in this step, and copy forces from contact points with the same feature id.

    previous: CONTACT rows of the last step, with these forces; first: index in `previous` at which the rows of the same
    pair of shapes begin, or would be inserted if there are none. contact_inout: CONTACT row.
    """
    c = contact_inout
    reset_impulses(c)
    c.of_new_pair = first == len(previous) or not is_of(previous[first], c.shape_a, c.shape_b)
    write_cache(geometry.polygons, geometry.corners, bodies, shapes, c)
    c.touched = False
    k = first
    while k < len(previous) and is_of(previous[k], c.shape_a, c.shape_b):
        c.touched = c.touched or touches(previous[k])
        k += 1
    transfer_impulses(previous, first, c)
    begin_step(geometry, bodies[c.body_row_a], bodies[c.body_row_b], shapes[c.row_a], shapes[c.row_b], c)


@kernel
def match_contacts(geometry, bodies, shapes, previous, stale, found, contacts_out):
    """Merge contacts kept from the last step and newly detected ones into contacts_out. Return their number.

    previous: CONTACT rows of the last step. stale: ascending int32 rows of `previous` that are not copied, because
    their pairs were detected again. All other rows of `previous` are kept.

    found: CONTACT rows of this step. A row whose field `previous` is -1 is new, and takes the forces of old points with
    the same feature id. Any other row is recycled and keeps its cache. All three tables are in the order of the
    candidate pairs. O(previous + found).
    """
    count = 0
    kept = 0
    passed = 0
    i, j = 0, 0
    while True:
        while passed < len(stale) and stale[passed] == kept:
            passed += 1
            kept += 1
        if kept < len(previous) and (i == len(found) or previous[kept].candidate < found[i].candidate):
            copy_row(previous[kept], contacts_out[count])
            kept += 1
        elif i < len(found):
            c = contacts_out[count]
            if found[i].previous >= 0:
                copy_row(previous[found[i].previous], c)
                copy_head(found[i], c, MANIFOLD_BYTES)
            else:
                copy_head(found[i], c, MANIFOLD_BYTES)
                while j < len(previous) and is_before(previous[j], c.shape_a, c.shape_b):
                    j += 1
                complete_contact(geometry, bodies, shapes, previous, j, c)
            i += 1
        else:
            return count
        count += 1


@kernel
def replace_contacts(geometry, bodies, shapes, stale, found_inout, previous_inout):
    """Overwrite the stale contacts with the detected ones, if each pair has as many detected as stale contacts.

    Return whether the contacts were overwritten. Unlike in match_contacts, nothing else is copied: O(found). In
    settling pyramids of 2,485 and 5,050 boxes, a step with 4 substeps takes 0.82 to 0.99 times as long as with
    match_contacts; with substeps by load the gain is within the noise. stale: int32 rows of `previous_inout` that must
    not be kept without a new narrow phase, ascending; found_inout: CONTACT rows of this step, in the order of the
    candidate pairs, used as scratch; previous_inout: CONTACT rows of the last step.
    """
    found, previous = found_inout, previous_inout
    if len(found) != len(stale):
        return False
    for i in range(len(found)):
        same = is_of(previous[stale[i]], found[i].shape_a, found[i].shape_b)
        if not same or found[i].previous >= 0:
            return False
    first = 0
    for i in range(len(found)):
        if i == 0 or not is_of(found[i - 1], found[i].shape_a, found[i].shape_b):
            first = stale[i]
        complete_contact(geometry, bodies, shapes, previous, first, found[i])
    for i in range(len(found)):  # after all previous forces have been read
        copy_row(found[i], previous[stale[i]])
    return True


@kernel
def copy_recycled(previous, stale, contacts_out):
    """Copy all contacts of the last step to contacts_out, except the stale ones. O(previous).

    previous: CONTACT rows; stale: int32 rows of `previous` that were detected again and are not copied, ascending.
    """
    count = 0
    passed = 0
    for k in range(len(previous)):
        if passed < len(stale) and stale[passed] == k:
            passed += 1
        else:
            copy_head(previous[k], contacts_out[count], MANIFOLD_BYTES)
            count += 1


# ---- recycling -------------------------------------------------------------------------------------------------------
# Contacts of the last step are used again if their bodies have hardly moved relative to each other.
#
# Source: Catto, Box2D v3, contact recycling; Coumans, Bullet, persistent manifolds.


@inlined
def refresh_recycled(a, b, row_a, row_b, candidate, place, contact_inout):
    """Write the fields of a contact that is kept without a new narrow phase: table rows, candidate, flags.

    a, b: SHAPE rows of A and B; row_a, row_b: numbers of these rows; candidate: index of the candidate pair; place: row
    of the contact in the table of the last step; contact_inout: CONTACT row.
    """
    c = contact_inout
    c.body_row_a, c.body_row_b = a.body_row, b.body_row
    c.row_a, c.row_b = row_a, row_b
    c.candidate = candidate
    c.previous = place
    c.persisted_1, c.persisted_2 = True, True
    c.of_new_pair = False
    c.touched = touches(c)


@kernel
def recycle_contacts(batch, distance, previous_inout, kinds_out, counts_out, stale_out, work_inout):
    """Keep contacts of the last step without a new narrow phase where possible, and classify the other pairs by kind.

    Return (number of stale rows, number of pairs). The second number is the sum of two counts: the pairs that are left
    to test, and all pairs with a part of a larger shape. Sensors are left out. If neither body has moved since the last
    step, a contact is kept if that step set CONTACT.can_recycle. Otherwise the function can_recycle is called, with
    `distance` [px].

    batch: see manifold.Batch; previous_inout: CONTACT rows of the last step, sorted by shape ids like the candidates;
    kept rows are updated to the present poses. kinds_out: kind of each pair, NOTHING if its contacts are kept.
    counts_out: number of pairs of each kind that are left. stale_out (previous,): int32 rows that are not kept,
    including all contacts of masks. work_inout: counters, see COUNTERS. O(candidates + contacts).
    """
    bodies = batch.bodies
    shapes = batch.shapes
    candidates = batch.candidates
    for i in range(len(counts_out)):
        counts_out[i] = 0
    stale, j = 0, 0
    row_a = -1
    p_unmoved = False
    for i in range(batch.count):
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        kind = kind_asked(bodies, a, b, batch.margin, batch.lookahead, SOLIDS)
        kinds_out[i] = kind
        counts_out[kind] += 1
        if kind == NOTHING:
            continue
        counts_out[WITH_CHILD] += int(is_of_child(a, b))
        while j < len(previous_inout) and is_before(previous_inout[j], a.id, b.id):
            stale_out[stale] = j
            stale += 1
            j += 1
        if j == len(previous_inout) or not is_of(previous_inout[j], a.id, b.id) or a.kind == MASK or b.kind == MASK:
            continue
        p, q = bodies[a.body_row], bodies[b.body_row]
        # The pairs of a body are adjacent.
        if a.body_row != row_a:
            row_a = a.body_row
            p_unmoved = is_unmoved(p)
        unmoved = p_unmoved and is_unmoved(q)
        fits, last = True, j
        while last < len(previous_inout) and is_of(previous_inout[last], a.id, b.id):
            c = previous_inout[last]
            if fits and not (unmoved and c.can_recycle and is_finite(c)):
                c.row_a = candidates[i, 0]
                c.row_b = candidates[i, 1]
                turn_p, turn_q = rotation_of(p.angle), rotation_of(q.angle)
                fits = not c.swept and can_recycle(shapes, p, turn_p, q, turn_q, distance, math.inf, c)
            last += 1
        if not fits:
            continue  # the next candidate lists the rows of this pair as stale
        for k in range(j, last):
            refresh_recycled(a, b, candidates[i, 0], candidates[i, 1], i, k, previous_inout[k])
            begin_step(batch.geometry, p, q, a, b, previous_inout[k])
        j = last
        counts_out[kind] -= 1
        kinds_out[i] = NOTHING
    for k in range(j, len(previous_inout)):
        stale_out[stale] = k
        stale += 1
    work_inout[NARROW_TESTS] += batch.count - counts_out[NOTHING]
    asking = counts_out[WITH_CHILD]
    for kind in range(NOTHING):
        asking += counts_out[kind]
    return stale, asking


# ---- narrow phase ----------------------------------------------------------------------------------------------------
# The narrow phase of worlds with a stacking solver: contacts at the start poses, with the impulses of the last step.


class Found(NamedTuple):
    """Result of ContactCache.find: contacts of this step, and the contacts of the last step that they replace."""

    rows: np.ndarray  # CONTACT rows in the order of the candidate pairs; valid until the next call
    stale: np.ndarray  # int32 rows of the contacts of the last step that are replaced, ascending


class ContactCache:
    """Two tables for the contacts of one world, used in turn: one holds the present contacts, the other the next."""

    def __init__(self) -> None:
        self.tables = [zeros_in_lines(16, CONTACT) for _ in range(2)]
        self.stale = np.zeros(64, np.int32)

    def room_beside(self, contacts: np.ndarray, count: int) -> np.ndarray:
        """Return the table that does not hold the present `contacts`, enlarged to `count` rows if necessary."""
        if contacts.base is self.tables[0].base:
            self.tables.reverse()
        if len(self.tables[0]) < count:
            self.tables[0] = zeros_in_lines(2 * count, CONTACT)
        return self.tables[0]

    def find(
        self, narrow: NarrowPhase, batch: Batch, previous: np.ndarray, distance: float, work: np.ndarray
    ) -> Found | None:
        """Find the contacts of all pairs without sensors. Contacts whose bodies have hardly moved are kept (recycled).

        Return a Found with the new contacts and the stale rows of `previous`, which are not kept. Return None if all
        contacts are kept and no pair is left to test. narrow: narrow phase of the world; batch: candidate pairs;
        previous: CONTACT rows of the last step, of which kept rows are updated in place; distance [px]: see
        recycle_contacts; work: counters of work done, see COUNTERS.
        """
        if len(self.stale) < len(previous):
            self.stale = np.zeros(2 * len(previous), np.int32)
        if narrow.boxes_only:
            return Found(narrow.find_boxes(batch, SOLIDS, work), self._all_stale(previous))
        stale_count, asking = recycle_contacts(batch, distance, previous, narrow.kinds, narrow.counts, self.stale, work)
        if not (stale_count or asking):
            return None
        stale = self.stale[:stale_count]
        recycled = 0
        if stale_count < len(previous) and narrow.counts[WITH_CHILD]:
            # Contacts of the parts of one shape depend on each other, so all contacts are completed together.
            recycled = len(previous) - stale_count
            copy_recycled(previous, stale, narrow.room_for(recycled))
            stale = self._all_stale(previous)
        return Found(narrow.complete(batch, previous, recycled, work), stale)

    def _all_stale(self, previous):
        self.stale[: len(previous)] = np.arange(len(previous))
        return self.stale[: len(previous)]


@stage(
    "narrow_phase",
    reads=("tolerances", "dt", "awake", "bodies", "shapes", "library", "pairs", "contact_rows", "workspace"),
    writes=("contact_rows", "work", "workspace"),
)
def find_contacts(state: StepState) -> None:
    """Write the contacts at the start of the step to state.contact_rows, with warm-start forces.

    Gaps up to the speculative distance also count as contacts. Contacts of the last step whose bodies have hardly moved
    are kept without a new narrow phase.
    """
    if not len(state.awake.bodies):
        state.contact_rows = NO_CONTACTS
        return
    tolerances, previous, cache, narrow = (
        state.tolerances,
        state.contact_rows,
        state.workspace.cache,
        state.workspace.narrow,
    )
    batch = narrow.batch_of(
        state.library,
        state.bodies,
        state.shapes,
        state.pairs.rows,
        tolerances.speculative,
        BIAS * tolerances.slop,
        GRAZE * tolerances.slop,
        state.dt,
    )
    news = cache.find(narrow, batch, previous, tolerances.recycle, state.work)
    if news is None or not (len(news.rows) or len(news.stale)):
        return
    tables = state.library.tables
    if replace_contacts(tables, state.bodies, state.shapes, news.stale, news.rows, previous):
        return
    contacts = cache.room_beside(previous, len(previous) - len(news.stale) + len(news.rows))
    count = match_contacts(tables, state.bodies, state.shapes, previous, news.stale, news.rows, contacts)
    state.contact_rows = contacts[:count]


# ---- replaced shapes -------------------------------------------------------------------------------------------------
# Replacement of a shape: contact forces are transferred to the new shape where its surface coincides with the old one.
#
# Feature ids are valid for one shape only, so no cached contact matches a contact of the new shape. Contacts of the new
# shape are detected immediately. Each new point takes the forces of the old point at the same place and normal.

# Smallest cosine between normals that count as equal: smoothing the new outline may rotate them slightly.
ALIKE = 0.9


class KeptImpulses:
    """Contacts of shapes that are about to be replaced, stored to transfer their forces to the new shapes.

    rows: row numbers of the shapes to be removed. No contacts are stored in a world without a contact cache.
    """

    def __init__(self, tables: WorldTables, rows: np.ndarray) -> None:
        found = tables.contact_rows
        self.contacts = found[:0]
        if len(rows) and tables.stacks and len(found):
            going = np.zeros(len(tables.shapes), bool)
            going[rows] = True
            # Contacts hold the SHAPE row numbers of the last step, which are valid: new shapes are appended after them,
            # and contacts of removed shapes are also removed.
            at_a = going[found["row_a"]]
            kept = np.flatnonzero(at_a | going[found["row_b"]])
            if len(kept):
                self.contacts = found[kept]
                self.others = np.unique(np.where(at_a, found["shape_b"], found["shape_a"])[kept])

    def transfer(self, tables: WorldTables, new: np.ndarray) -> None:
        """Detect the contacts of new shapes with bodies that touched the old shapes, and copy the kept forces to them.

        O(pairs). new: row numbers of the new shapes. Call this method after the removal of the old shapes. tables: a
        World or StepState.
        """
        if not len(self.contacts):
            return
        shapes = tables.shapes
        rows, others = new[shapes["role"][new] != PIXELS], rows_of(shapes, self.others)
        others = others[others >= 0]
        refresh_aabbs(rows, tables.library.tables, tables.bodies, shapes)
        pairs = np.array([sorted((row, other)) for row in rows.tolist() for other in others.tolist()], np.int64)
        if not len(pairs):
            return
        pairs = pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]
        slop, speculative = tables.tolerances.slop, tables.tolerances.speculative
        found = tables.workspace.narrow.collide(
            tables.library,
            tables.bodies,
            shapes,
            pairs,
            speculative,
            no_work(),
            which=SOLIDS,
            bias=BIAS * slop,
            previous=self._stood_on(shapes, pairs),
        )
        contacts = np.zeros(len(found), CONTACT)
        match_contacts(tables.library.tables, tables.bodies, shapes, NO_CONTACTS, NO_ROWS, found, contacts)
        for contact in contacts:
            for k in range(1, int(contact["count"]) + 1):
                self._take(contact, k, speculative)
        known = joined([tables.contact_rows, contacts])
        tables.contact_rows = known[order_of(known)]

    def _stood_on(self, shapes, pairs):
        """Return substitutes for contacts of the last step: one empty CONTACT row for each pair with a Chain.

        One-way surfaces do not stop a body that overlaps them without an earlier contact. With these rows, the new
        surface holds a body that stood on the old surface, at any depth. shapes: SHAPE table; pairs (n, 2): SHAPE row
        numbers.
        """
        some = shapes[pairs[(shapes["kind"][pairs] == CHAIN).any(axis=1)]]
        found = np.zeros(len(some), CONTACT)
        found["shape_a"], found["shape_b"] = some["id"].T
        return found

    def _take(self, contact, k, reach):
        """Copy the forces of the nearest kept contact point with a similar normal to point k (1 or 2) of a new contact.

        contact: CONTACT row. Only kept points of the same two bodies within `reach` [px] are considered.
        """
        old = self.contacts
        same = (old["body_a"] == contact["body_a"]) & (old["body_b"] == contact["body_b"])
        swapped = (old["body_a"] == contact["body_b"]) & (old["body_b"] == contact["body_a"])
        along = old["normal_x"] * contact["normal_x"] + old["normal_y"] * contact["normal_y"]
        fits = np.where(swapped & ~same, -along, along) > ALIKE
        best = (np.inf, -1, 0)
        for point in (1, 2):
            there = fits & (same | swapped) & (old["count"] >= point)
            gap = np.hypot(old[f"x_{point}"] - contact[f"x_{k}"], old[f"y_{point}"] - contact[f"y_{k}"])
            for at in np.flatnonzero(there & (gap <= reach)).tolist():
                best = min(best, (float(gap[at]), at, point))
        _, at, point = best
        if at >= 0:
            for name in ("normal_force", "tangent_force"):
                contact[f"{name}_{k}"] = old[f"{name}_{point}"][at]
            if k == point == 1:
                contact["rolling_force"] = old["rolling_force"][at]
