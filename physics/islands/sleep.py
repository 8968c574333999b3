"""Sleeping and waking of islands, and the sleeping set, which stores sleeping islands with their contacts."""

import math
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from physics.islands.awake import (
    free_fall,
    is_active,
    is_free,
    keep_awake_what_moves_freely,
    list_active,
    list_joint_edges,
    new_groups,
    wakes,
)
from physics.islands.graph import CONTACT_EDGE, MOST_NODES, NO_NODE, join, new_edges, write_pair
from physics.jit import inlined, kernel
from physics.math2d import norm
from physics.settings import SLEEP_TIME
from physics.tables.body import DYNAMIC, KINEMATIC
from physics.tables.contact import CONTACT, EVENT, with_rows
from physics.tables.joint import WORLD
from physics.tables.step_state import ISLANDS, StepState, WorldTables, stage
from physics.tables.table import joined, root_of, rows_of

# ---- sleeping set ----------------------------------------------------------------------------------------------------
# The sleeping set: sleeping islands with their contacts, and touching pairs of bodies that no step visits.


class Island(NamedTuple):
    """A sleeping island: its bodies, contacts and touching pairs."""

    bodies: np.ndarray  # int64 ids
    contacts: np.ndarray  # CONTACT rows
    touching: np.ndarray  # EVENT rows of the touching pairs


class SleepingSet:
    """The sleeping islands of a world, by key, and the touching pairs of other bodies at rest.

    The key of an island is the lowest id of its bodies. "Outside" bodies are bodies that are not in the island.
    """

    def __init__(self) -> None:
        self.islands = {}
        self.links = {}  # id of a body outside -> keys of the islands with contacts on this body
        self.touching_pairs = np.zeros(0, EVENT)  # pairs of bodies that no step visits, outside of islands
        self.sensing_pairs = np.zeros(0, EVENT)

    def put(self, key: int, island: Island) -> None:
        """Add a sleeping Island to the set. key: the lowest id of the island's bodies."""
        self.islands[key] = island
        self._link(self._named(island), [key])

    def put_many(self, keys: list[int], islands: list[Island], named: list[int], owners: list[int]) -> None:
        """Store islands[k] under keys[k], for all k.

        named: ids of outside bodies in contacts of the islands; owners: for each of these ids, the key of the island.
        """
        self.islands.update(zip(keys, islands, strict=True))
        for identity, key in set(zip(named, owners, strict=True)):
            self._link([identity], [key])

    def _link(self, named, keys):
        for identity in named:
            self.links.setdefault(identity, set()).update(keys)

    def take(self, key: int) -> Island:
        """Remove the island with this key from the set, and return the island."""
        island = self.islands.pop(key)
        for identity in self._named(island):
            keys = self.links[identity]
            keys.discard(key)
            if not keys:
                del self.links[identity]
        return island

    @staticmethod
    def _named(island) -> list:
        """Return the ids of the bodies outside an island that touch it, according to its contacts."""
        named = np.union1d(island.contacts["body_a"], island.contacts["body_b"])
        return np.setdiff1d(named, island.bodies).tolist()

    def take_naming(self, identity: int) -> list[tuple[np.ndarray, np.ndarray]]:
        """Remove the contacts and touching pairs of an outside body (id) from all islands.

        Return a list with the removed (CONTACT rows, EVENT rows) of each island.
        """
        found = []
        for key in sorted(self.links.get(identity, ())):
            island = self.take(key)
            m, t = island.contacts, island.touching
            goes = (m["body_a"] == identity) | (m["body_b"] == identity)
            named = (t["body_a"] == identity) | (t["body_b"] == identity)
            found.append((m[goes], t[named]))
            self.put(key, Island(island.bodies, m[~goes], t[~named]))
        return found

    def keep_touching(self, rows: np.ndarray, fell_asleep: np.ndarray, keys: np.ndarray) -> None:
        """Store the touching pairs of islands that have just fallen asleep.

        rows: EVENT rows of the pairs; fell_asleep: CONTACT rows of the islands in the order of shape ids; keys: for
        each CONTACT row, the key of its island.
        """
        known = fell_asleep["shape_a"] << 32 | fell_asleep["shape_b"]
        place = np.searchsorted(known, rows["shape_a"] << 32 | rows["shape_b"])
        owners = keys[place]
        order = np.argsort(owners, kind="stable")
        names, starts = np.unique(owners[order], return_index=True)
        for key, part in zip(names.tolist(), np.split(rows[order], starts[1:]), strict=True):
            self.islands[key] = self.islands[key]._replace(touching=part)

    def naming(self, identity: int, own: int) -> np.ndarray:
        """Return the sleeping CONTACT rows of body `identity`. own: key of the island that contains it, -1 for none."""
        parts = [np.zeros(0, CONTACT)]
        for key in sorted({own, *self.links.get(identity, ())} & self.islands.keys()):
            m = self.islands[key].contacts
            parts.append(m[(m["body_a"] == identity) | (m["body_b"] == identity)])
        return in_order(joined(parts))

    def contacts(self) -> np.ndarray:
        """Return the CONTACT rows of all islands in the order of shape ids."""
        return in_order(joined([np.zeros(0, CONTACT), *(each.contacts for each in self.islands.values())]))

    def keep_reported(self, tables: WorldTables) -> None:
        """Move the touching pairs and sensor pairs whose bodies are both inactive from `tables` to this set."""
        self.touching_pairs = np.concatenate([self.touching_pairs, tables.touching_pairs.take_resting(tables.bodies)])
        self.sensing_pairs = np.concatenate([self.sensing_pairs, tables.sensing_pairs.take_resting(tables.bodies)])

    def return_all(self, tables: WorldTables) -> None:
        """Move all touching pairs and sensor pairs that are stored outside of islands back to `tables`."""
        for name in ("touching_pairs", "sensing_pairs"):
            getattr(tables, name).give_back(getattr(self, name))
            setattr(self, name, np.zeros(0, EVENT))

    def return_reported(self, tables: WorldTables, ids: np.ndarray) -> None:
        """Move the stored touching pairs and sensor pairs of bodies (ids) back to `tables`."""
        for name in ("touching_pairs", "sensing_pairs"):
            kept = getattr(self, name)
            if len(kept):
                back = np.isin(kept["body_a"], ids) | np.isin(kept["body_b"], ids)
                getattr(tables, name).give_back(kept[back])
                setattr(self, name, kept[~back])


def order_of(manifolds: np.ndarray) -> np.ndarray:
    """Return the indices that sort CONTACT rows by shape ids. The sort is stable within a pair of shapes."""
    return np.lexsort((np.arange(len(manifolds)), manifolds["shape_b"], manifolds["shape_a"]))


def in_order(manifolds: np.ndarray) -> np.ndarray:
    """Return the CONTACT rows sorted by shape ids."""
    return manifolds[order_of(manifolds)]


# ---- sleep -----------------------------------------------------------------------------------------------------------
# Sleeping and waking: an island keeps its contacts while it sleeps, and wakes with their forces.
#
# An island sleeps and wakes as a whole. While it sleeps, its contacts are not tested, solved or reported, and its
# touching pairs do not end. See "rest" below for the condition of sleep.
#
# These functions take a World, between steps, or the StepState during a step: see WorldTables.


def disturb(tables: WorldTables, ids: Iterable[int]) -> None:
    """Wake the islands of bodies, and islands that touch them, before the bodies are moved, edited or removed.

    ids: ids of the bodies; bodies that joints link to them are included. The next step visits these bodies, and their
    sleep time is reset to 0. No effect without sleeping. tables: a World or StepState.
    """
    if not tables.awake.sleeping:
        return
    ids = [int(each) for each in ids]
    if len(tables.joints):
        ids = with_partners(tables.joints, ids)
    rows = rows_of(tables.bodies, ids)
    keys = islands_at(tables, ids, rows)
    stir(tables, ids, rows[rows >= 0])
    wake(tables, keys)


def disturb_one(world: Any, identity: int, row: int) -> int:
    """Wake the island of one body, as `disturb` does, but faster and only between steps.

    Return the body's row number afterwards. It may change if an island wakes or the world has joints, because the rows
    of bodies that were removed before are then deleted. Otherwise the call is fast, because it processes no arrays.
    identity, row: id and row number of the body; world: a World, annotated Any because its module imports this one.
    """
    awake, sleeping_set = world.awake, world.sleeping_set
    if not awake.sleeping:
        return row
    if world._joints.count:
        disturb(world, [identity])
        return world._row_number(identity)
    if len(sleeping_set.touching_pairs) or len(sleeping_set.sensing_pairs):
        sleeping_set.return_reported(world, [identity])
    awake.dirty.append(identity)
    columns = world._bodies.columns
    columns["sleep_time"][row] = 0.0
    if sleeping_set.islands and (identity in sleeping_set.links or not columns["awake"][row]):
        row = world._row_number(identity)
        wake(world, islands_at(world, [identity], np.array([row])))
    return row


def with_partners(joints: np.ndarray, ids: list[int]) -> list[int]:
    """Return `ids`, followed by the ids of the bodies that joints link to these bodies. joints: JOINT rows."""
    mine = np.isin(joints["body_a"], ids) | np.isin(joints["body_b"], ids)
    if not mine.any():
        return ids
    linked = np.unique(np.concatenate([joints["body_a"][mine], joints["body_b"][mine]]))
    return [*ids, *np.setdiff1d(linked[linked != WORLD], ids).tolist()]


def stir(tables: WorldTables, ids: list[int], rows: np.ndarray) -> None:
    """Include bodies in the next step, and reset their sleep time. ids, rows: their ids and BODY row numbers."""
    tables.sleeping_set.return_reported(tables, ids)
    tables.awake.mark_dirty(ids)
    tables.bodies["sleep_time"][rows] = 0.0


def islands_at(tables: WorldTables, ids: list[int], rows: np.ndarray) -> set[int]:
    """Return the keys of the sleeping islands that contain or touch the given bodies. A key: see SleepingSet.

    ids: ids of the bodies; rows: their row numbers in BODY, -1 for a body that does not exist; tables: a World or
    StepState.
    """
    islands, links, keys = tables.sleeping_set.islands, tables.sleeping_set.links, set()
    if not islands:
        return keys
    for identity in links.keys() & set(ids):
        keys |= links[identity]
    there = rows >= 0
    asleep = np.flatnonzero(there)[~tables.bodies["awake"][rows[there]]]
    for k in asleep.tolist():
        own = tables.bodies["island"].item(rows[k])
        if own in islands:
            keys.add(own)
            keys |= _islands_beside(tables, islands[own].contacts, ids[k])
    return keys


def disturb_shapes(tables: WorldTables, identity: int, shapes: np.ndarray) -> bool:
    """Wake the sleeping islands that touch changed shapes of a body at rest. Return whether this is sufficient.

    If the result is False, nothing was changed. The caller must then call `disturb`, because other pairs of the body
    may be affected. identity: id of the body; shapes: ids of the changed shapes; tables: a World or StepState.
    """
    sleeping_set = tables.sleeping_set
    row = rows_of(tables.bodies, [identity])[0]
    if not tables.awake.sleeping or tables.bodies["active"][row]:
        return False
    for kept in (sleeping_set.touching_pairs, sleeping_set.sensing_pairs):
        if len(kept) and ((kept["body_a"] == identity) | (kept["body_b"] == identity)).any():
            return False
    keys, some = [], set(shapes.tolist())
    for key in sleeping_set.links.get(identity, ()):
        named = sleeping_set.islands[key].contacts
        if not (some.isdisjoint(named["shape_a"].tolist()) and some.isdisjoint(named["shape_b"].tolist())):
            keys.append(key)
    wake(tables, keys)
    return True


def _islands_beside(tables, manifolds, identity):
    """Return the keys of the sleeping islands that touch a body. manifolds: CONTACT rows; identity: body id."""
    own = manifolds[(manifolds["body_a"] == identity) | (manifolds["body_b"] == identity)]
    others = np.union1d(own["body_a"], own["body_b"])
    rows = rows_of(tables.bodies, others)
    asleep = ~tables.bodies["awake"][rows] & (rows >= 0)
    return {key for key in tables.bodies["island"][rows[asleep]].tolist() if key in tables.sleeping_set.islands}


def wake_all(tables: WorldTables) -> None:
    """Wake all islands, after a change of gravity or of the solver. tables: a World or StepState."""
    wake(tables, list(tables.sleeping_set.islands))


def wake(tables: WorldTables, keys: Iterable[int]) -> None:
    """Wake islands: move their bodies, and the sleeping contacts of these bodies, to the awake tables.

    keys: the keys of the islands, see SleepingSet; tables: a World or StepState.
    """
    sleeping_set = tables.sleeping_set
    keys = [key for key in sorted(keys) if key in sleeping_set.islands]
    if not keys:
        return
    bodies, parts, pairs = tables.bodies, [], []
    woken = [sleeping_set.take(key) for key in keys]
    ids = np.concatenate([island.bodies for island in woken])
    for island in woken:
        parts.append(island.contacts)
        pairs.append(island.touching)
    for identity in sorted(set(ids.tolist()) & sleeping_set.links.keys()):
        for contacts, touching in sleeping_set.take_naming(identity):
            parts.append(contacts)
            pairs.append(touching)
    rows = rows_of(bodies, ids)
    rows = rows[rows >= 0]
    bodies["awake"][rows] = True
    bodies["sleep_time"][rows] = 0.0
    bodies["island"][rows] = -1
    tables.touching_pairs.give_back(joined(pairs))
    sleeping_set.return_reported(tables, ids)
    tables.awake.include(tables, rows)
    _bring_back(tables, joined(parts))


def _bring_back(tables, contacts):
    """Add woken CONTACT rows with present row numbers to tables.contact_rows, unless their pair is already there."""
    found = tables.contact_rows
    known = found["shape_a"] << 32 | found["shape_b"]
    new = ~np.isin(contacts["shape_a"] << 32 | contacts["shape_b"], known)
    woken = with_rows(tables.bodies, tables.shapes, contacts[new])
    if len(woken):
        woken["previous"] = -1
        both = joined([found, woken])
        tables.contact_rows = both[order_of(both)]


@kernel
def find_disturbed(
    # read
    bodies,
    manifolds,
    dt,
    # write
    rows_out,
):
    """List sleeping bodies that an active or edited body touches, or may touch within dt [s].

    Return their number. manifolds: CONTACT rows; rows_out (2 · manifolds) int64: BODY row numbers, with repeats.
    O(manifolds).
    """
    found = 0
    for i in range(len(manifolds)):
        m = manifolds[i]
        a = bodies[m.body_row_a]
        b = bodies[m.body_row_b]
        if m.sensor or (a.awake and b.awake):
            continue
        near = m.separation_1 <= max(0.0, m.speed_1 * dt)
        if m.count == 2:
            near = near or m.separation_2 <= max(0.0, m.speed_2 * dt)
        if not near:
            continue
        if wakes(a, b):
            rows_out[found] = m.body_row_b
            found += 1
        if wakes(b, a):
            rows_out[found] = m.body_row_a
            found += 1
    return found


@kernel
def find_run_over(
    # read
    bodies,
    shapes,
    pairs,
    dt,
    # write
    rows_out,
):
    """List sleeping bodies that a fast kinematic body may tunnel through within dt [s]. O(pairs).

    Return their number. pairs (n, 2) int64: rows of shapes with overlapping swept AABBs; rows_out (n,) int64: BODY
    rows.
    """
    found = 0
    for i in range(len(pairs)):
        for side in range(2):
            k = shapes[pairs[i, side]].body_row
            b = bodies[k]
            row = shapes[pairs[i, 1 - side]].body_row
            if b.kind != KINEMATIC or not b.active or bodies[row].kind != DYNAMIC or bodies[row].awake:
                continue
            if dt * (norm(b.vx, b.vy) + b.extent * abs(b.angular_velocity)) > b.inradius:
                rows_out[found] = row
                found += 1
    return found


@stage(
    "wake",
    reads=(
        "bodies",
        "shapes",
        "contact_rows",
        "joints",
        "awake",
        "sleeping_set",
        "pairs",
        "touching_pairs",
        "sensing_pairs",
        "dt",
    ),
    writes=(
        "contact_rows",
        "awake",
        "sleeping_set",
        "pairs",
        "touching_pairs",
        "sensing_pairs",
        "bodies.awake",
        "bodies.active",
        "bodies.sleep_time",
        "bodies.island",
    ),
)
def wake_disturbed(state: StepState) -> None:
    """Wake islands touched by active, edited or fast kinematic bodies, and islands with a joint to a moving body."""
    sleeping_set, bodies = state.sleeping_set, state.bodies
    if not sleeping_set.islands:
        return
    keys = set()
    rows = state.awake.bodies
    fixed = rows[bodies["kind"][rows] != DYNAMIC]
    if len(fixed) and sleeping_set.links:
        moving = np.empty(len(fixed), np.int64)
        moving = moving[: list_active(bodies, fixed, moving)]
        for identity in bodies["id"][moving].tolist():
            keys |= sleeping_set.links.get(identity, set())
    if len(fixed) and len(state.joints):
        moving = np.empty(len(fixed), np.int64)
        moving = moving[: list_active(bodies, fixed, moving)]
        linked = rows_of(bodies, np.array(with_partners(state.joints, bodies["id"][moving].tolist()), np.int64))
        keys |= set(bodies["island"][linked[~bodies["awake"][linked]]].tolist())
    near = np.empty(2 * len(state.contact_rows), np.int64)
    near = near[: find_disturbed(bodies, state.contact_rows, state.dt, near)]
    keys |= set(bodies["island"][near].tolist())
    if len(fixed):
        pairs = state.pairs.rows
        near = np.empty(len(pairs), np.int64)
        near = near[: find_run_over(bodies, state.shapes, pairs, state.dt, near)]
        keys |= set(bodies["island"][near].tolist())
    wake(state, keys)


# ---- rest ------------------------------------------------------------------------------------------------------------
# Falling asleep: which islands have stayed in place for long enough, and which contacts move to the sleeping set.
#
# The criterion is the distance that a body has moved, not its speed: in a heap some bodies tremble without moving away.
# Source: Jolt Physics, Body::UpdateSleepStateInternal, where three points of a body must stay within spheres. Here
# the displacement of the furthest point since the start of the sleep time is bounded. Speed and time: Box2D v3.2,
# solver.c. If no friction holds a body, its predicted motion in a minute must also be small: see awake.py.

COUNTED = 2.0**62  # greatest number of sleep periods that a kernel counts as an integer


@inlined
def is_touching(contact):
    """Return whether a contact overlaps, or had a normal force in the last substep."""
    c = contact
    if c.separation_1 <= 0.0 or c.normal_force_1 > 0.0:
        return True
    return c.count == 2 and (c.separation_2 <= 0.0 or c.normal_force_2 > 0.0)


@inlined
def is_pressed(contact):
    """Return whether a contact overlaps or had a normal impulse in the step. False for a merely speculative gap."""
    c = contact
    if c.separation_1 <= 0.0 or c.normal_impulse_1 > 0.0:
        return True
    return c.count == 2 and (c.separation_2 <= 0.0 or c.normal_impulse_2 > 0.0)


@kernel
def list_contact_edges(
    # read
    bodies,
    contacts,
    conveyor,
    # write
    edges_out,
):
    """List the contacts that link bodies or keep a body awake, as graph edges between BODY rows. O(contacts).

    Return the number of edges. An edge with two nodes links two awake dynamic bodies that touch. An edge with one node
    keeps a body awake that touches a moving kinematic or static body. With conveyor 1, a loaded contact with a surface
    speed also keeps its bodies awake. edges_out: Edges with room for two edges per contact.
    """
    found = 0
    for i in range(len(contacts)):
        c = contacts[i]
        if c.sensor:
            continue
        a = bodies[c.body_row_a]
        b = bodies[c.body_row_b]
        carried = conveyor == 1 and c.surface_speed != 0.0 and is_pressed(c)
        if a.kind == DYNAMIC and b.kind == DYNAMIC and a.awake and b.awake and is_touching(c):
            write_pair(found, CONTACT_EDGE, i, c.body_row_a, c.body_row_b, edges_out)
            edges_out.keeps_awake[found] = carried
            found += 1
            continue
        if carried or (b.kind != DYNAMIC and is_active(b)):
            write_pair(found, CONTACT_EDGE, i, c.body_row_a, NO_NODE, edges_out)
            edges_out.keeps_awake[found] = True
            found += 1
        if carried or (a.kind != DYNAMIC and is_active(a)):
            write_pair(found, CONTACT_EDGE, i, c.body_row_b, NO_NODE, edges_out)
            edges_out.keeps_awake[found] = True
            found += 1
    return found


@kernel
def start_islands(rows, parents_out):
    """Make each body of `rows` a separate island in the union-find forest parents_out. O(rows)."""
    for k in range(len(rows)):
        parents_out[rows[k]] = rows[k]


@inlined
def way_from(body, x, y, angle):
    """Return an upper bound [px] of the distance that any point of a body has moved since it was at another pose.

    x, y [px], angle [rad]: the other pose. The result is NaN if a number of either pose is NaN.
    """
    return norm(body.x - x, body.y - y) + abs(body.angle - angle) * body.extent


@kernel
def advance_sleep_times(
    # read
    rows,
    edges,
    count,
    dt,
    slow,
    patience,
    rocking_range,
    # write
    parents_inout,
    least_out,
    excess_out,
    bodies_inout,
):
    """Advance the sleep times and rocking times of awake bodies by dt [s]. O(rows + count).

    Return (number of islands of awake dynamic bodies, whether any body has a sleep time of at least `patience` [s]).

    The sleep time restarts at 0 when a body is further than `slow` [px/s] times `patience` from its reference pose for
    sleep. The rocking time restarts when the body is further than rocking_range [px] from its reference pose for
    rocking, see settings.ROCKING_RANGE.

    rows: rows of the awake bodies; edges, count, parents_inout: see graph.join. The results of an island are written at
    its root row: least_out (bodies,): the least sleep time [s] of its bodies; excess_out (bodies,): the sum of speed² -
    slow² [px²/s²] over its bodies. bodies_inout: BODY table.
    """
    distance = slow * patience
    islands = 0
    for k in range(len(rows)):
        i = rows[k]
        b = bodies_inout[i]
        least_out[i] = math.inf
        excess_out[i] = 0.0
        parents_inout[i] = root_of(i, parents_inout)
        if b.kind == DYNAMIC and b.awake and parents_inout[i] == i:
            islands += 1
        if not is_free(b):
            continue
        if not way_from(b, b.rocking_x, b.rocking_y, b.rocking_angle) <= rocking_range:
            b.rocking_x = b.x
            b.rocking_y = b.y
            b.rocking_angle = b.angle
            b.rocking_time = 0.0
        b.rocking_time += dt
        before = b.sleep_time
        far = way_from(b, b.still_x, b.still_y, b.still_angle) > distance
        b.sleep_time = 0.0 if far or not b.allow_sleep else before + dt
        # The reference pose is renewed once per sleep period, so that a slowly creeping body stays near it.
        times = b.sleep_time / patience
        if far or (abs(times) < COUNTED and math.floor(times) > math.floor(before / patience)):
            b.still_x = b.x
            b.still_y = b.y
            b.still_angle = b.angle
        b.island = bodies_inout[parents_inout[i]].id
    for i in range(count):
        for k in range(MOST_NODES):
            if edges.nodes[i, k] < 0 or not edges.keeps_awake[i]:
                break
            bodies_inout[edges.nodes[i, k]].sleep_time = 0.0
    ready = False
    for k in range(len(rows)):
        b = bodies_inout[rows[k]]
        root = parents_inout[rows[k]]
        if is_free(b):
            least_out[root] = min(least_out[root], b.sleep_time)
            speed = norm(b.vx, b.vy) + abs(b.angular_velocity) * b.extent
            excess_out[root] += speed * speed - slow * slow
            ready = ready or b.sleep_time >= patience
    return islands, ready


@kernel
def fall_asleep(
    # read
    rows,
    parents,
    least,
    excess,
    patience,
    # write
    bodies_inout,
):
    """Put islands to sleep if all their bodies have stayed in place for `patience` [s]. O(rows).

    Return the number of bodies that fell asleep. The mean square speed of the island must also be at most the square of
    the sleep speed. With this rule a few bodies may tremble, but an island that has just begun to fall, or was pushed,
    stays awake. rows: rows of the awake bodies; parents, least, excess: see advance_sleep_times. bodies_inout: BODY
    table.
    """
    slept = 0
    for k in range(len(rows)):
        b = bodies_inout[rows[k]]
        root = parents[rows[k]]
        if is_free(b) and least[root] >= patience and excess[root] <= 0.0:
            b.awake = False
            b.vx = 0.0
            b.vy = 0.0
            b.angular_velocity = 0.0
            b.previous_x = b.x  # otherwise the body would count as moved
            b.previous_y = b.y
            b.previous_angle = b.angle
            slept += 1
    return slept


class IslandWorkspace:
    """Scratch arrays for finding the islands that may fall asleep."""

    def __init__(self) -> None:
        self.parents, self.least, self.excess = np.zeros(16, np.int32), np.zeros(16), np.zeros(16)
        self.groups = new_groups(16)
        self.edges = new_edges(32)

    def grow(self, bodies: int, contacts: int, joints: int) -> None:
        """Make room for these numbers of bodies, contacts and joints. The contents of an enlarged array are lost."""
        if len(self.parents) < bodies:
            self.parents = np.zeros(2 * bodies, np.int32)
            self.least, self.excess = np.zeros(2 * bodies), np.zeros(2 * bodies)
            self.groups = new_groups(2 * bodies)
        if len(self.edges.kinds) < 2 * contacts + joints:
            self.edges = new_edges(2 * (2 * contacts + joints))


@stage(
    "islands",
    reads=(
        "effects",
        "bodies",
        "shapes",
        "contact_rows",
        "joints",
        "awake",
        "sleeping_set",
        "pairs",
        "tolerances",
        "gravity",
        "drag",
        "wind",
        "dt",
        "workspace",
    ),
    writes=(
        "contact_rows",
        "awake",
        "sleeping_set",
        "pairs",
        "fell_asleep",
        "work",
        "workspace",
        "bodies.awake",
        "bodies.active",
        "bodies.island",
        "bodies.still_x",
        "bodies.still_y",
        "bodies.still_angle",
        "bodies.sleep_time",
        "bodies.rocking_x",
        "bodies.rocking_y",
        "bodies.rocking_angle",
        "bodies.rocking_time",
        "bodies.vx",
        "bodies.vy",
        "bodies.angular_velocity",
        "bodies.previous_x",
        "bodies.previous_y",
        "bodies.previous_angle",
    ),
)
def rest(state: StepState) -> None:
    """Put islands to sleep that have stayed in place for long enough, and move these islands to the sleeping set."""
    awake, bodies, contacts, search = state.awake, state.bodies, state.contact_rows, state.workspace.islands
    if not len(awake.dynamic):
        return
    rows = awake.bodies
    search.grow(len(bodies), len(contacts), len(state.joints))
    start_islands(rows, search.parents)
    count = list_contact_edges(bodies, contacts, int(state.effects.conveyor), search.edges)
    if len(state.joints):
        count = list_joint_edges(bodies, state.joints, count, search.edges)
    join(search.edges, count, search.parents)
    state.work[ISLANDS], ready = advance_sleep_times(
        rows,
        search.edges,
        count,
        state.dt,
        state.tolerances.sleep_speed,
        SLEEP_TIME,
        state.tolerances.limits.rocking_range,
        search.parents,
        search.least,
        search.excess,
        bodies,
    )
    if not ready:
        return
    e, still = state.effects, (0.0, 0.0)
    fall = free_fall(
        state.gravity if e.gravity else still,
        state.drag,
        state.wind if e.wind else still,
        e.drag,
        state.tolerances.slop,
    )
    keep_awake_what_moves_freely(
        rows, bodies, contacts, state.joints, e.friction, fall, search.groups, search.parents, search.least
    )
    slept = fall_asleep(rows, search.parents, search.least, search.excess, SLEEP_TIME, bodies)
    if not slept:
        return
    slept = awake.dynamic[~bodies["awake"][awake.dynamic]]
    awake.exclude(state, slept)
    state.fell_asleep = _park(state, slept)


def _park(state, slept):
    """Move the islands of bodies that fell asleep, and their touching contacts, to the sleeping set.

    slept: row numbers in BODY. Return (CONTACT rows that were moved, in the order of shape ids; for each of these rows,
    the key of its island).
    """
    bodies, m = state.bodies, state.contact_rows
    still = (bodies["kind"][m["body_row_a"]] != DYNAMIC) | ~bodies["awake"][m["body_row_a"]]
    still &= (bodies["kind"][m["body_row_b"]] != DYNAMIC) | ~bodies["awake"][m["body_row_b"]]
    new = np.isin(m["body_row_a"], slept)
    parking = still & ~m["sensor"] & (new | np.isin(m["body_row_b"], slept))
    slop = state.tolerances.slop
    touching = (m["separation_1"] <= slop) | (m["normal_impulse_1"] > 0.0)
    touching |= (m["count"] == 2) & ((m["separation_2"] <= slop) | (m["normal_impulse_2"] > 0.0))
    kept = parking & touching
    fell_asleep, new = m[kept], new[kept]
    fell_asleep["can_recycle"] = False  # the other side may move meanwhile
    # A body that is not dynamic is in no island, even if BODY.island has a value from before its kind changed.
    sides = [
        np.where(bodies["kind"][fell_asleep[side]] == DYNAMIC, bodies["island"][fell_asleep[side]], -1)
        for side in ("body_row_a", "body_row_b")
    ]
    keys = np.where(new, *sides)
    # By island: its bodies, and its manifolds in their order.
    islands = bodies["island"][slept]
    by_island, by_key = np.argsort(islands, kind="stable"), np.argsort(keys, kind="stable")
    names, starts = np.unique(islands[by_island], return_index=True)
    members = np.split(bodies["id"][slept][by_island], starts[1:])
    own = fell_asleep[by_key]
    cuts = np.searchsorted(keys[by_key], names)
    ends = [*cuts[1:].tolist(), len(own)]
    no_events = np.zeros(0, EVENT)
    disable_body = [
        Island(ids, own[start:end], no_events) for ids, start, end in zip(members, cuts.tolist(), ends, strict=True)
    ]
    foreign = [(sides[k] != keys, fell_asleep[name]) for k, name in enumerate(("body_a", "body_b"))]
    named = np.concatenate([ids[outside] for outside, ids in foreign]).tolist()
    owners = np.concatenate([keys[outside] for outside, _ in foreign]).tolist()
    state.sleeping_set.put_many(names.tolist(), disable_body, named, owners)
    state.contact_rows = m[~parking]
    return fell_asleep, keys
