"""Release of cached forces under a heavy load that is removed or moved; they would throw the bodies below.

A contact starts from the force at the end of the step before. After a body of a thousand times its mass is removed,
that is a thousand times the force that is needed. A pass removes as much of it as the order of the contacts allows;
the rest becomes velocity.
"""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from physics.jit import kernel
from physics.settings import BLOW
from physics.tables.step_state import WorldTables
from physics.tables.table import rows_of

FORCES = ("normal_force_1", "tangent_force_1", "normal_force_2", "tangent_force_2", "rolling_force")
NO_SIDE = -1


@kernel
def link_contacts(contacts, heads_out, nexts_out):
    """Link the contacts of each body to a list of sides: 2 i is that of body A of contact i, 2 i + 1 that of body B.

    heads_out (bodies) int64: the first side of each row of BODY; nexts_out (2 · contacts) int64: the next side of the
    same body. Both hold NO_SIDE after the last. O(bodies + contacts).
    """
    for k in range(len(heads_out)):
        heads_out[k] = NO_SIDE
    for i in range(len(contacts)):
        a, b = contacts[i].body_row_a, contacts[i].body_row_b
        nexts_out[2 * i] = heads_out[a]
        heads_out[a] = 2 * i
        nexts_out[2 * i + 1] = heads_out[b]
        heads_out[b] = 2 * i + 1


@kernel
def forget_in_turn(rows, bodies, blow, heads, nexts, stamp, marks_inout, reached_out, contacts_inout):
    """Clear the cached forces below each of some bodies, one after the other, as forget_loads does for one body.

    rows: of dynamic bodies. blow [px/s2]: a force per mass beyond it is a blow. heads, nexts: see link_contacts.
    stamp: greater than all marks. marks_inout (bodies) int64; reached_out (bodies) int64: the rows reached last. Return
    the greatest stamp used. O(contacts of these bodies), and of the stacks that are cleared.
    """
    for k in range(len(rows)):
        stamp += 1
        count = 0
        side = heads[rows[k]]
        while side >= 0:
            c = contacts_inout[side // 2]
            other = c.body_row_b if side % 2 == 0 else c.body_row_a
            force = c.normal_force_1
            if c.count == 2:
                force += c.normal_force_2
            if force > 0.0 and force * bodies[other].inverse_mass > blow and marks_inout[other] != stamp:
                marks_inout[other] = stamp
                reached_out[count] = other
                count += 1
            side = nexts[side]
        at = 0
        while at < count:
            side = heads[reached_out[at]]
            at += 1
            while side >= 0:
                c = contacts_inout[side // 2]
                c.normal_force_1 = 0.0
                c.tangent_force_1 = 0.0
                c.normal_force_2 = 0.0
                c.tangent_force_2 = 0.0
                c.rolling_force = 0.0
                other = c.body_row_b if side % 2 == 0 else c.body_row_a
                if other != rows[k] and bodies[other].inverse_mass > 0.0 and marks_inout[other] != stamp:
                    marks_inout[other] = stamp
                    reached_out[count] = other
                    count += 1
                side = nexts[side]
    return stamp


class ContactLists:
    """The contacts of each body between two steps, linked again when they have changed."""

    def __init__(self) -> None:
        self.contacts, self.step = None, -1  # that the lists are of
        self.heads = self.nexts = self.marks = self.reached = np.zeros(0, np.int64)
        self.stamp = 0

    def __getstate__(self):
        return {}  # the lists belong to tables that a copy does not have

    def __setstate__(self, state):
        self.__init__()

    def refresh(self, contacts: np.ndarray, bodies: np.ndarray, step: int) -> None:
        """Link the contacts of a world again if they are not those of the last call."""
        if contacts is self.contacts and step == self.step and len(self.heads) >= len(bodies):
            return
        if len(self.heads) < len(bodies):
            room = 2 * len(bodies)
            self.heads, self.marks, self.reached = (np.zeros(room, np.int64) for _ in range(3))
            self.stamp = 0
        if len(self.nexts) < 2 * len(contacts):
            self.nexts = np.zeros(4 * len(contacts), np.int64)
        link_contacts(contacts, self.heads, self.nexts)
        self.contacts, self.step = contacts, step

    def forget_loads(self, world: Any, rows: np.ndarray) -> None:
        """Clear the cached forces under dynamic bodies that are moved one after the other. rows: of BODY, int64.

        The same as one call of forget_loads for each; O(contacts of these bodies), and O(contacts) after each step. The
        tables are read as they are, see World._row_at. Any stands for World, whose package imports this one.
        """
        contacts, bodies = world._contact_rows, world._bodies.rows
        if not len(contacts) or not world.stacks or not len(rows):
            return  # contacts are not cached
        self.refresh(contacts, bodies, world.steps)
        work = self.marks, self.reached, contacts
        self.stamp = forget_in_turn(rows, bodies, blow_of(world), self.heads, self.nexts, self.stamp, *work)

    def forget_loads_under(self, world: Any, row: int) -> None:
        """Do the same as forget_loads for one body, also for one that is removed."""
        if world.stacks and len(world._contact_rows):
            self.refresh(world._contact_rows, world._bodies.rows, world.steps)
            if self.heads.item(row) != NO_SIDE:
                self.forget_loads(world, np.array([row]))


def blow_of(tables: WorldTables) -> float:
    """Return the force per mass [px/s2] beyond which a cached force is a blow once its load is gone."""
    return BLOW * math.hypot(*tables.gravity) if tables.effects.gravity else 0.0


def is_any_blow(bodies: np.ndarray, contacts: np.ndarray, ids: np.ndarray, blow: float) -> bool:
    """Return whether the cached force of any contact of these bodies, by id, is a blow to its other side."""
    force = contacts["normal_force_1"] + np.where(contacts["count"] == 2, contacts["normal_force_2"], 0.0)
    for side, other in (("body_a", "body_b"), ("body_b", "body_a")):
        mine = (force > 0.0) & np.isin(contacts[side], ids)
        if (force[mine] * bodies["inverse_mass"][rows_of(bodies, contacts[other][mine])] > blow).any():
            return True
    return False


def forget_loads(tables: WorldTables, ids: Sequence[int] | np.ndarray) -> None:
    """Clear the cached forces under a load that is removed or moved.

    Where a removed body lay on a body of a small fraction of its weight, all contacts of the stack below, through
    dynamic bodies, lose their cached forces. O(contacts · depth of the stack), in worlds that stack.
    """
    contacts, bodies = tables.contact_rows, tables.bodies
    if not len(contacts) or not tables.stacks:
        return  # contacts are not cached
    ids_a, ids_b = contacts["body_a"], contacts["body_b"]
    going_a, going_b = np.isin(ids_a, ids), np.isin(ids_b, ids)
    lost = going_a != going_b
    if not lost.any():
        return
    left = rows_of(bodies, np.where(going_a, ids_b, ids_a)[lost])
    force = (contacts["normal_force_1"] + np.where(contacts["count"] == 2, contacts["normal_force_2"], 0.0))[lost]
    reached = np.zeros(len(bodies), bool)
    reached[left[(force > 0.0) & (force * bodies["inverse_mass"][left] > blow_of(tables))]] = True
    if not reached.any():
        return
    row_a, row_b, loose = rows_of(bodies, ids_a), rows_of(bodies, ids_b), bodies["inverse_mass"] > 0.0
    inner = loose[row_a] & loose[row_b] & ~(going_a | going_b)
    a, b = row_a[inner], row_b[inner]
    while (reached[a] != reached[b]).any():
        reached[a[reached[b]]] = True
        reached[b[reached[a]]] = True
    borne = reached[row_a] | reached[row_b]
    for name in FORCES:
        contacts[name][borne] = 0.0
