"""Release of cached forces under a heavy load that is removed or moved; they would throw the bodies below.

A contact starts from the force at the end of the step before. After a load of a thousand times the mass of a body is
removed, the cached force is a thousand times the force needed. A pass removes only a part of it, which depends on the
order of the contacts; the rest becomes velocity.
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
def forget_below(rows, size, bodies, blow, stamp, lists_inout, contacts_inout):
    """Clear the cached forces below groups of bodies that go, `size` rows each, one group after the other.

    Where a body that goes pressed on one that stays with more than a blow, all contacts of that one and of the stack
    below it, through dynamic bodies, lose their forces. blow [px/s2]: force per mass. lists_inout: see Lists; stamp:
    greater than all its marks. Return the greatest stamp used. O(contacts of the bodies that go, and of the stacks).
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
    """Arrays of ContactLists, all int64; rows are those of BODY."""

    heads: np.ndarray  # (rows) the first side of each body …
    nexts: np.ndarray  # (2 · contacts) … and the next side of the same body, NO_SIDE after the last
    marks: np.ndarray  # (rows) stamp of the group that reached a body last
    reached: np.ndarray  # (rows) scratch


class ContactLists:
    """The contacts of each body between two steps, linked again when they have changed."""

    def __init__(self) -> None:
        self.contacts, self.step = None, -1  # that the lists are of
        self.lists = Lists(*(np.zeros(0, np.int64) for _ in range(4)))
        self.stamp = 0

    def __getstate__(self):
        return {}  # the lists belong to tables that a copy does not have

    def __setstate__(self, state):
        self.__init__()

    def _refresh(self, contacts, bodies, step):
        """Link the contacts of a world again if they are not those of the last call."""
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

    def forget_loads(self, world: Any, rows: np.ndarray, together: bool = False) -> None:
        """Clear the cached forces under bodies that are removed or moved, one after the other or all together.

        rows: of BODY, int64. O(contacts of these bodies), and O(contacts) after each step. The tables are read as they
        are, see World._row_at. Any stands for World, whose package imports this one.
        """
        contacts, bodies = world._contact_rows, world._bodies.rows
        if not len(contacts) or not world.stacks or not len(rows):
            return  # contacts are not cached
        self._refresh(contacts, bodies, world.steps)
        if len(rows) == 1 and self.lists.heads.item(rows[0]) == NO_SIDE:
            return
        size = len(rows) if together else 1
        self.stamp = forget_below(rows, size, bodies, blow_of(world), self.stamp, self.lists, contacts)


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
