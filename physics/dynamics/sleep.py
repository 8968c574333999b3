"""Falling asleep and waking: an island keeps its contacts aside while it sleeps, and comes back with their forces.

An island sleeps as one and wakes as one. What is kept aside is neither tested, nor solved, nor reported, and its pairs
have not ended. Sleeping by the larger of velocity and half the real displacement: Box2D v3.2, solver.c.

These functions take a world, between steps, or the StepState of a step: both have the tables, `manifolds`, `anchors`,
`awake`, `sleepers`, `pairs`, `touching` and `sensing`.
"""

import math
from collections.abc import Iterable

import numpy as np

from physics.dynamics.awake import is_active, list_active
from physics.dynamics.graph import join, root_of
from physics.dynamics.sleepers import Island, order_of
from physics.jit import kernel, subkernel
from physics.math2d import length_of
from physics.settings import SLEEP_TIME
from physics.tables.body import DYNAMIC
from physics.tables.contact import EVENT
from physics.tables.counters import ISLANDS
from physics.tables.manifold import ANCHOR
from physics.tables.rows import rows_of
from physics.tables.step_state import StepState, stage
from physics.tables.world_tables import WorldTables


def disturb(tables: WorldTables, ids: Iterable[int]) -> None:
    """Wake the islands of bodies by id, and of what touches them: what is moved, changed or taken away; and have these
    bodies looked at in the next step."""
    awake, sleepers = tables.awake, tables.sleepers
    if not awake.sleeping:
        return
    ids = [int(each) for each in ids]
    sleepers.return_told(tables, ids)
    awake.stir(ids)
    rows = rows_of(tables.bodies, ids)
    keys = set()
    for identity, row in zip(ids, rows.tolist(), strict=True):
        keys |= sleepers.links.get(identity, set())
        own = int(tables.bodies["island"][row]) if row >= 0 else -1
        if own in sleepers.islands and row >= 0 and not tables.bodies["awake"][row]:
            keys.add(own)
            keys |= _islands_beside(tables, sleepers.islands[own].manifolds, identity)
    wake(tables, keys)


def _islands_beside(tables, manifolds, identity):
    """Other islands that manifolds with a body lead to."""
    own = manifolds[(manifolds["body_a"] == identity) | (manifolds["body_b"] == identity)]
    others = np.union1d(own["body_a"], own["body_b"])
    rows = rows_of(tables.bodies, others)
    asleep = ~tables.bodies["awake"][rows] & (rows >= 0)
    return {key for key in tables.bodies["island"][rows[asleep]].tolist() if key in tables.sleepers.islands}


def wake_all(tables: WorldTables) -> None:
    """Wake everything: gravity, or the solver, changed."""
    wake(tables, list(tables.sleepers.islands))


def wake(tables: WorldTables, keys: Iterable[int]) -> None:
    """Wake islands: their bodies, and the contacts that name these, come back into the step."""
    sleepers = tables.sleepers
    keys = [key for key in sorted(keys) if key in sleepers.islands]
    if not keys:
        return
    bodies, parts, told = tables.bodies, [], []
    woken = [sleepers.take(key) for key in keys]
    ids = np.concatenate([island.bodies for island in woken])
    for island in woken:
        parts.append((island.manifolds, island.anchors))
        told.append(island.touching)
    for identity in sorted(set(ids.tolist()) & sleepers.links.keys()):
        for manifolds, anchors, touching in sleepers.take_naming(identity):
            parts.append((manifolds, anchors))
            told.append(touching)
    rows = rows_of(bodies, ids)
    rows = rows[rows >= 0]
    bodies["awake"][rows] = True
    bodies["sleep_time"][rows] = 0.0
    bodies["island"][rows] = -1
    tables.touching.give_back(np.concatenate(told))
    sleepers.return_told(tables, ids)
    tables.awake.include(tables, rows)
    _bring_back(tables, np.concatenate([m for m, _ in parts]), np.concatenate([a for _, a in parts]))


def _bring_back(tables, manifolds, anchors):
    """Add manifolds whose pairs are not known to those of the step, with their rows of today."""
    found = tables.manifolds
    known = found["shape_a"] << 32 | found["shape_b"]
    new = ~np.isin(manifolds["shape_a"] << 32 | manifolds["shape_b"], known)
    again, anchors = with_rows(tables, manifolds[new], anchors[new])
    if len(again):
        again["previous"] = -1
        both = np.concatenate([found, again])
        order = order_of(both)
        tables.manifolds, tables.anchors = both[order], np.concatenate([tables.anchors, anchors])[order]


def with_rows(tables: WorldTables, manifolds: np.ndarray, anchors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Manifolds and anchors with the rows that bodies and shapes have now; without those whose sides are gone."""
    there = np.ones(len(manifolds), bool)
    for side in "ab":
        for table, name, column in ((tables.bodies, "body_", "body_row_"), (tables.shapes, "shape_", "row_")):
            rows = rows_of(table, manifolds[name + side])
            manifolds[column + side] = rows
            there &= rows >= 0
    return (manifolds, anchors) if there.all() else (manifolds[there], anchors[there])


def forget(tables: WorldTables) -> None:
    """Drop the manifolds of bodies and shapes that are gone; refresh the rows of the others."""
    if len(tables.manifolds):
        anchors = tables.anchors if len(tables.anchors) else np.zeros(len(tables.manifolds), ANCHOR)
        found, kept = with_rows(tables, tables.manifolds.copy(), anchors)
        tables.manifolds = found
        tables.anchors = kept if len(tables.anchors) else tables.anchors


@kernel
def find_disturbed(
    # read
    bodies,
    manifolds,
    dt,
    # write
    rows_out,
):
    """List the sleeping bodies that something on its way touches, or will within dt [s]. Returns their number.
    O(manifolds).

    rows_out (2 · manifolds) int64; one may be named twice.
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
        if is_active(a) and b.kind == DYNAMIC and not b.awake:
            rows_out[found] = m.body_row_b
            found += 1
        if is_active(b) and a.kind == DYNAMIC and not a.awake:
            rows_out[found] = m.body_row_a
            found += 1
    return found


@stage(
    "wake",
    reads=("bodies", "shapes", "manifolds", "anchors", "awake", "sleepers", "pairs", "touching", "sensing", "dt"),
    writes=(
        "manifolds",
        "anchors",
        "awake",
        "sleepers",
        "pairs",
        "touching",
        "sensing",
        "bodies.awake",
        "bodies.active",
        "bodies.sleep_time",
        "bodies.island",
    ),
)
def wake_disturbed(state: StepState) -> None:
    """Wake the islands that something touches, or on which something that stood has begun to move."""
    sleepers, bodies = state.sleepers, state.bodies
    if not sleepers.islands:
        return
    keys = set()
    rows = state.awake.bodies
    fixed = rows[bodies["kind"][rows] != DYNAMIC]
    if len(fixed) and sleepers.links:
        moving = np.empty(len(fixed), np.int64)
        moving = moving[: list_active(bodies, fixed, moving)]
        for identity in bodies["id"][moving].tolist():
            keys |= sleepers.links.get(identity, set())
    near = np.empty(2 * len(state.manifolds), np.int64)
    near = near[: find_disturbed(bodies, state.manifolds, state.dt, near)]
    keys |= set(bodies["island"][near].tolist())
    wake(state, keys)


@kernel
def list_edges(
    # read
    bodies,
    manifolds,
    anchors,
    # write
    edges_out,
):
    """List the rows (a, b) of awake dynamic bodies that touch. edges_out (manifolds, 2) int32. Returns their number.
    O(manifolds)."""
    found = 0
    for i in range(len(manifolds)):
        m = manifolds[i]
        a = bodies[m.body_row_a]
        b = bodies[m.body_row_b]
        if m.sensor or a.kind != DYNAMIC or b.kind != DYNAMIC or not (a.awake and b.awake):
            continue
        touches = m.separation_1 <= 0.0 or anchors[i].normal_force_1 > 0.0
        if m.count == 2:
            touches = touches or m.separation_2 <= 0.0 or anchors[i].normal_force_2 > 0.0
        if touches:
            edges_out[found, 0] = m.body_row_a
            edges_out[found, 1] = m.body_row_b
            found += 1
    return found


@subkernel
def is_pressed(manifold):
    """Whether two sides touch or push each other: near ones have not met yet."""
    m = manifold
    if m.separation_1 <= 0.0 or m.normal_impulse_1 > 0.0:
        return True
    return m.count == 2 and (m.separation_2 <= 0.0 or m.normal_impulse_2 > 0.0)


@kernel
def start_islands(rows, parents_out):
    """Each of the rows an island of its own. O(rows)."""
    for k in range(len(rows)):
        parents_out[rows[k]] = rows[k]


@kernel
def fall_asleep(
    # read
    rows,
    manifolds,
    anchors,
    dt,
    slow,
    patience,
    conveyor,
    # write
    parents_inout,
    least_out,
    bodies_inout,
):
    """Put the islands to sleep of which every body has been slow [px/s] for `patience` [s]. Returns (islands of dynamic
    bodies that were awake, bodies that fell asleep).

    What touches a kinematic body on its way stays awake, and so does what is on a surface that runs, with conveyor 1,
    however slowly. rows: the awake ones; parents_inout: see graph.join; least_out
    (bodies): scratch. O(rows + manifolds).
    """
    islands = 0
    for k in range(len(rows)):
        i = rows[k]
        b = bodies_inout[i]
        least_out[i] = math.inf
        parents_inout[i] = root_of(i, parents_inout)
        if b.kind == DYNAMIC and b.awake and parents_inout[i] == i:
            islands += 1
        if b.kind != DYNAMIC or not b.awake or b.quarantined:
            continue
        speed = length_of(b.vx, b.vy) + abs(b.angular_velocity) * b.extent
        if dt > 0.0:
            moved = length_of(b.x - b.previous_x, b.y - b.previous_y) + abs(b.angle - b.previous_angle) * b.extent
            speed = max(speed, 0.5 * moved / dt)
        b.sleep_time = b.sleep_time + dt if speed <= slow else 0.0
        b.island = bodies_inout[parents_inout[i]].id
    for i in range(len(manifolds)):
        m = manifolds[i]
        a = bodies_inout[m.body_row_a]
        b = bodies_inout[m.body_row_b]
        if m.sensor:
            continue
        if a.kind != DYNAMIC and is_active(a):
            b.sleep_time = 0.0
        if b.kind != DYNAMIC and is_active(b):
            a.sleep_time = 0.0
        if conveyor == 1 and anchors[i].surface_speed != 0.0 and is_pressed(m):
            a.sleep_time = 0.0
            b.sleep_time = 0.0
    for k in range(len(rows)):
        b = bodies_inout[rows[k]]
        root = parents_inout[rows[k]]
        if b.kind == DYNAMIC and b.awake and not b.quarantined:
            least_out[root] = min(least_out[root], b.sleep_time)
    slept = 0
    for k in range(len(rows)):
        b = bodies_inout[rows[k]]
        if b.kind == DYNAMIC and b.awake and not b.quarantined and least_out[parents_inout[rows[k]]] >= patience:
            b.awake = False
            b.vx = 0.0
            b.vy = 0.0
            b.angular_velocity = 0.0
            b.previous_x = b.x  # or it would seem to have been moved, and wake
            b.previous_y = b.y
            b.previous_angle = b.angle
            slept += 1
    return islands, slept


class IslandWorkspace:
    """Scratch for the search for islands."""

    def __init__(self) -> None:
        self.parents, self.least = np.zeros(16, np.int32), np.zeros(16)
        self.edges = np.zeros((16, 2), np.int32)

    def grow(self, bodies: int, manifolds: int) -> None:
        """Make room; nothing is kept."""
        if len(self.parents) < bodies:
            self.parents, self.least = np.zeros(2 * bodies, np.int32), np.zeros(2 * bodies)
        if len(self.edges) < manifolds:
            self.edges = np.zeros((2 * manifolds, 2), np.int32)


@stage(
    "islands",
    reads=(
        "effects",
        "bodies",
        "shapes",
        "manifolds",
        "anchors",
        "awake",
        "sleepers",
        "pairs",
        "tolerances",
        "dt",
        "workspace",
    ),
    writes=(
        "manifolds",
        "anchors",
        "awake",
        "sleepers",
        "pairs",
        "parked",
        "work",
        "workspace",
        "bodies.awake",
        "bodies.active",
        "bodies.island",
        "bodies.sleep_time",
        "bodies.vx",
        "bodies.vy",
        "bodies.angular_velocity",
        "bodies.previous_x",
        "bodies.previous_y",
        "bodies.previous_angle",
    ),
)
def rest(state: StepState) -> None:
    """Let islands fall asleep that have been slow for long enough; their contacts go with them."""
    awake, bodies, manifolds, search = state.awake, state.bodies, state.manifolds, state.workspace.islands
    if not len(awake.dynamic):
        return
    rows = awake.bodies
    search.grow(len(bodies), len(manifolds))
    start_islands(rows, search.parents)
    join(search.edges, list_edges(bodies, manifolds, state.anchors, search.edges), search.parents)
    state.work[ISLANDS], slept = fall_asleep(
        rows,
        manifolds,
        state.anchors,
        state.dt,
        state.tolerances.sleep_speed,
        SLEEP_TIME,
        int(state.effects.conveyor),
        search.parents,
        search.least,
        bodies,
    )
    if not slept:
        return
    slept = awake.dynamic[~bodies["awake"][awake.dynamic]]
    awake.exclude(state, slept)
    state.parked = _park(state, slept)


def _park(state, slept):
    """Put the islands of these rows aside with their manifolds; what only nearly touched is dropped. Returns the
    manifolds that went with them, in order, and the island of each."""
    bodies, m, anchors = state.bodies, state.manifolds, state.anchors
    still = (bodies["kind"][m["body_row_a"]] != DYNAMIC) | ~bodies["awake"][m["body_row_a"]]
    still &= (bodies["kind"][m["body_row_b"]] != DYNAMIC) | ~bodies["awake"][m["body_row_b"]]
    new = np.isin(m["body_row_a"], slept)
    parking = still & ~m["sensor"] & (new | np.isin(m["body_row_b"], slept))
    slop = state.tolerances.slop
    touching = (m["separation_1"] <= slop) | (m["normal_impulse_1"] > 0.0)
    touching |= (m["count"] == 2) & ((m["separation_2"] <= slop) | (m["normal_impulse_2"] > 0.0))
    kept = parking & touching
    parked, parked_anchors, new = m[kept], anchors[kept], new[kept]
    # What is not dynamic is in no island, whatever it was in before it changed its kind.
    sides = [
        np.where(bodies["kind"][parked[side]] == DYNAMIC, bodies["island"][parked[side]], -1)
        for side in ("body_row_a", "body_row_b")
    ]
    keys = np.where(new, *sides)
    # By island: its bodies, and its manifolds in their order.
    islands = bodies["island"][slept]
    by_island, by_key = np.argsort(islands, kind="stable"), np.argsort(keys, kind="stable")
    names, starts = np.unique(islands[by_island], return_index=True)
    members = np.split(bodies["id"][slept][by_island], starts[1:])
    own, own_anchors = parked[by_key], parked_anchors[by_key]
    cuts = np.searchsorted(keys[by_key], names)
    ends = [*cuts[1:].tolist(), len(own)]
    untold = np.zeros(0, EVENT)
    put_aside = [
        Island(ids, own[start:end], own_anchors[start:end], untold)
        for ids, start, end in zip(members, cuts.tolist(), ends, strict=True)
    ]
    foreign = [(sides[k] != keys, parked[name]) for k, name in enumerate(("body_a", "body_b"))]
    named = np.concatenate([ids[outside] for outside, ids in foreign]).tolist()
    owners = np.concatenate([keys[outside] for outside, _ in foreign]).tolist()
    state.sleepers.put_many(names.tolist(), put_aside, named, owners)
    state.manifolds, state.anchors = m[~parking], anchors[~parking]
    return parked, keys
