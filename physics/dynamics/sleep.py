"""Sleeping and waking: an island keeps its contacts aside while it sleeps, and comes back with their forces.

An island sleeps as one and wakes as one. What is kept aside is neither tested, nor solved, nor reported, and its pairs
have not ended. See rest.py for what falls asleep.

These functions take a world, between steps, or the StepState of a step: both have the tables, `manifolds`, `anchors`,
`awake`, `sleepers`, `pairs`, `touching` and `sensing`.
"""

from collections.abc import Iterable

import numpy as np

from physics.dynamics.awake import list_active, wakes
from physics.dynamics.sleepers import order_of
from physics.jit import kernel
from physics.math2d import length_of
from physics.tables.body import DYNAMIC, KINEMATIC
from physics.tables.manifold import ANCHOR
from physics.tables.rows import joined, row_of, rows_of
from physics.tables.step_state import StepState, stage
from physics.tables.world_tables import WorldTables


def disturb(tables: WorldTables, ids: Iterable[int]) -> None:
    """Wake the islands of bodies by id, and of what touches them: what is moved, changed or taken away; have these
    bodies looked at in the next step, and the time begin again after which they fall asleep."""
    awake, sleepers = tables.awake, tables.sleepers
    if not awake.sleeping:
        return
    ids = [int(each) for each in ids]
    sleepers.return_told(tables, ids)
    awake.stir(ids)
    rows = rows_of(tables.bodies, ids)
    tables.bodies["sleep_time"][rows[rows >= 0]] = 0.0
    keys = set()
    for identity, row in zip(ids, rows.tolist(), strict=True):
        keys |= sleepers.links.get(identity, set())
        own = int(tables.bodies["island"][row]) if row >= 0 else -1
        if own in sleepers.islands and row >= 0 and not tables.bodies["awake"][row]:
            keys.add(own)
            keys |= _islands_beside(tables, sleepers.islands[own].manifolds, identity)
    wake(tables, keys)


def disturb_shapes(tables: WorldTables, identity: int, shapes: np.ndarray) -> bool:
    """Wake the islands that rest on some shapes, by id, of a body that stands: the rest of it is as it was.

    Returns False, and wakes nothing, where more than its islands may have to be told: then see disturb.
    """
    sleepers = tables.sleepers
    row = rows_of(tables.bodies, [identity])[0]
    if not tables.awake.sleeping or tables.bodies["active"][row]:
        return False
    for kept in (sleepers.touching, sleepers.sensing):
        if len(kept) and ((kept["body_a"] == identity) | (kept["body_b"] == identity)).any():
            return False
    keys, some = [], set(shapes.tolist())
    for key in sleepers.links.get(identity, ()):
        named = sleepers.islands[key].manifolds
        if not (some.isdisjoint(named["shape_a"].tolist()) and some.isdisjoint(named["shape_b"].tolist())):
            keys.append(key)
    wake(tables, keys)
    return True


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
    tables.touching.give_back(joined(told))
    sleepers.return_told(tables, ids)
    tables.awake.include(tables, rows)
    _bring_back(tables, joined([m for m, _ in parts]), joined([a for _, a in parts]))


def _bring_back(tables, manifolds, anchors):
    """Add manifolds whose pairs are not known to those of the step, with their rows of today."""
    found = tables.manifolds
    known = found["shape_a"] << 32 | found["shape_b"]
    new = ~np.isin(manifolds["shape_a"] << 32 | manifolds["shape_b"], known)
    again, anchors = with_rows(tables, manifolds[new], anchors[new])
    if len(again):
        again["previous"] = -1
        both = joined([found, again])
        order = order_of(both)
        tables.manifolds, tables.anchors = both[order], joined([tables.anchors, anchors])[order]


def with_rows(tables: WorldTables, manifolds: np.ndarray, anchors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Manifolds and anchors with the rows that bodies and shapes have now; without those whose sides are gone."""
    there = np.empty(len(manifolds), bool)
    refresh_rows(tables.bodies, tables.shapes, manifolds, there)
    return (manifolds, anchors) if there.all() else (manifolds[there], anchors[there])


def forget(tables: WorldTables) -> None:
    """Drop the manifolds of bodies and shapes that are gone; refresh the rows of the others."""
    if len(tables.manifolds):
        anchors = tables.anchors if len(tables.anchors) else np.zeros(len(tables.manifolds), ANCHOR)
        found, kept = with_rows(tables, joined([tables.manifolds]), anchors)
        tables.manifolds = found
        tables.anchors = kept if len(tables.anchors) else tables.anchors


@kernel
def refresh_rows(bodies, shapes, manifolds_inout, there_out):
    """Write the rows that the bodies and shapes of manifolds have, and which manifolds have all of theirs.
    O(manifolds log shapes)."""
    for i in range(len(manifolds_inout)):
        m = manifolds_inout[i]
        m.body_row_a = row_of(bodies, m.body_a)
        m.body_row_b = row_of(bodies, m.body_b)
        m.row_a = row_of(shapes, m.shape_a)
        m.row_b = row_of(shapes, m.shape_b)
        there_out[i] = min(m.body_row_a, m.body_row_b, m.row_a, m.row_b) >= 0


@kernel
def find_disturbed(
    # read
    bodies,
    manifolds,
    dt,
    # write
    rows_out,
):
    """List the sleeping bodies that something on its way, or changed by hand, touches or will within dt [s]. Returns
    their number. O(manifolds).

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
    """List the sleeping bodies that a kinematic one may jump over within dt [s]. Returns their number. O(pairs).

    pairs (n, 2) int64: shape rows whose motion rectangles meet; rows_out (n,) int64; one may be named twice.
    """
    found = 0
    for i in range(len(pairs)):
        for side in range(2):
            k = shapes[pairs[i, side]].body_row
            b = bodies[k]
            row = shapes[pairs[i, 1 - side]].body_row
            if b.kind != KINEMATIC or not b.active or bodies[row].kind != DYNAMIC or bodies[row].awake:
                continue
            if dt * (length_of(b.vx, b.vy) + b.extent * abs(b.angular_velocity)) > b.thin_half:
                rows_out[found] = row
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
    if len(fixed):
        pairs = state.pairs.rows
        near = np.empty(len(pairs), np.int64)
        near = near[: find_run_over(bodies, state.shapes, pairs, state.dt, near)]
        keys |= set(bodies["island"][near].tolist())
    wake(state, keys)
