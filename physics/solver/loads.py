"""Removal of the cached contact forces below a body that is removed or moved by the program.

The solver starts a contact from its force at the end of the last step. After a body a thousand times as heavy as the
body below it is removed, this cached force is a thousand times too large. A solver pass removes only a part of the
excess, depending on the order of the contacts. The rest would become velocity and throw the bodies below.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from physics.jit import kernel
from physics.settings import BLOW
from physics.tables.step_state import WorldTables
from physics.tables.table import rows_of

NO_SIDE = -1


@kernel
def link_contacts(contacts, heads_out, nexts_out):
    """Link the contacts of each body into a list of sides. O(bodies + contacts).

    A side is one end of a contact: 2 i is body A of contact i, and 2 i + 1 is its body B. contacts: CONTACT rows;
    heads_out (bodies) int64: first side of each BODY row; nexts_out (2 · contacts) int64: next side of the same body.
    NO_SIDE ends a list.
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
def forget_below(rows, size, bodies, blow, stamp, lists_inout, contacts_inout):
    """Clear the cached contact forces of bodies under groups of bodies that are about to be removed or moved.

    A body outside a group is affected if a body of the group presses on it with a force per mass above `blow` [px/s2].
    So are all dynamic bodies that contacts connect to an affected body. All contacts of affected bodies lose their
    cached forces.

    Return the greatest stamp used. rows: row numbers in BODY of the groups, `size` per group; bodies: all BODY rows;
    stamp: a number not less than any mark in lists_inout (see Lists); contacts_inout: CONTACT rows. O(contacts of the
    groups and of the connected bodies).
    """
    heads, nexts = lists_inout.heads, lists_inout.nexts
    marks, reached = lists_inout.marks, lists_inout.reached
    for start in range(0, len(rows), size):
        stamp += 1
        group = rows[start : start + size]
        for k in range(len(group)):
            marks[group[k]] = stamp
        count = 0
        for k in range(len(group)):
            side = heads[group[k]]
            while side >= 0:
                c = contacts_inout[side // 2]
                other = c.body_row_b if side % 2 == 0 else c.body_row_a
                force = c.normal_force_1
                if c.count == 2:
                    force += c.normal_force_2
                if force > 0.0 and force * bodies[other].inverse_mass > blow and marks[other] != stamp:
                    marks[other] = stamp
                    reached[count] = other
                    count += 1
                side = nexts[side]
        at = 0
        while at < count:
            side = heads[reached[at]]
            at += 1
            while side >= 0:
                c = contacts_inout[side // 2]
                c.normal_force_1 = c.tangent_force_1 = c.normal_force_2 = c.tangent_force_2 = c.rolling_force = 0.0
                other = c.body_row_b if side % 2 == 0 else c.body_row_a
                if bodies[other].inverse_mass > 0.0 and marks[other] != stamp:
                    marks[other] = stamp
                    reached[count] = other
                    count += 1
                side = nexts[side]
    return stamp


class Lists(NamedTuple):
    """Arrays of a ContactLists object, all int64. In the fields below, (rows) is a capacity for BODY rows."""

    heads: np.ndarray  # (rows) first side of each body, NO_SIDE: no contact
    nexts: np.ndarray  # (2 · contacts) next side of the same body, NO_SIDE after the last
    marks: np.ndarray  # (rows) stamp of the last group whose search reached the body
    reached: np.ndarray  # (rows) scratch


class ContactLists:
    """Lists of each body's contacts, for use between two steps. They are rebuilt after the contacts have changed."""

    def __init__(self) -> None:
        self.contacts, self.step = None, -1  # the contacts and the step for which the lists were built
        self.lists = Lists(*(np.zeros(0, np.int64) for _ in range(4)))
        self.stamp = 0

    def __getstate__(self):
        return {}  # the lists refer to the tables of this world, not to the tables of a copy

    def __setstate__(self, state):
        self.__init__()

    def _refresh(self, contacts, bodies, step):
        """Rebuild the lists, unless they were built for these contacts in the same step. step: number of the step."""
        lists = self.lists
        if contacts is self.contacts and step == self.step and len(lists.heads) >= len(bodies):
            return
        if len(lists.heads) < len(bodies):
            heads, marks, reached = (np.zeros(2 * len(bodies), np.int64) for _ in range(3))
            lists, self.stamp = Lists(heads, lists.nexts, marks, reached), 0
        if len(lists.nexts) < 2 * len(contacts):
            lists = lists._replace(nexts=np.zeros(4 * len(contacts), np.int64))
        link_contacts(contacts, lists.heads, lists.nexts)
        self.lists, self.contacts, self.step = lists, contacts, step

    def forget_loads_of(self, world: Any, row: int) -> None:
        """Clear the cached forces under one body, as forget_loads does, but faster. row: its row number in BODY."""
        contacts = world._contact_rows
        if not len(contacts) or not world.stacks:
            return  # contacts are not cached
        self._refresh(contacts, world._bodies.rows, world.steps)
        if self.lists.heads.item(row) != NO_SIDE:
            self.forget_loads(world, np.array([row]))

    def forget_loads(self, world: Any, rows: np.ndarray, together: bool = False) -> None:
        """Clear the cached forces under bodies that are about to be removed or have been moved, see forget_below.

        world: a World, annotated Any because its module imports this one. rows: int64 row numbers in BODY. together:
        True makes all rows one group, False makes each row a group of its own. Rows that were removed since the last
        step stay in the tables, see World._row_at. O(contacts of these bodies); the first call after a step also costs
        O(bodies + contacts).
        """
        contacts, bodies = world._contact_rows, world._bodies.rows
        if not len(contacts) or not world.stacks or not len(rows):
            return  # contacts are not cached
        self._refresh(contacts, bodies, world.steps)
        size = len(rows) if together else 1
        self.stamp = forget_below(rows, size, bodies, blow_of(world), self.stamp, self.lists, contacts)


def blow_of(tables: WorldTables) -> float:
    """Return the force per mass [px/s2] above which a cached contact force would throw a body once its load is removed.

    The result is BLOW times gravity, and 0 in a world without gravity. tables: a World or StepState.
    """
    return BLOW * math.hypot(*tables.gravity) if tables.effects.gravity else 0.0


def is_any_blow(bodies: np.ndarray, contacts: np.ndarray, ids: np.ndarray, blow: float) -> bool:
    """Return whether one of the given bodies presses on another body with a force per mass above `blow` [px/s2].

    The cached contact forces are compared. bodies, contacts: BODY and CONTACT rows; ids: ids of the given bodies.
    """
    force = contacts["normal_force_1"] + np.where(contacts["count"] == 2, contacts["normal_force_2"], 0.0)
    for side, other in (("body_a", "body_b"), ("body_b", "body_a")):
        mine = (force > 0.0) & np.isin(contacts[side], ids)
        if (force[mine] * bodies["inverse_mass"][rows_of(bodies, contacts[other][mine])] > blow).any():
            return True
    return False
