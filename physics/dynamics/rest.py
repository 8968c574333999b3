"""Falling asleep: which islands have got nowhere for long enough, and what is put aside with them.

What counts is how far a body got, not how fast it is: in a heap of ragged things some tremble, and get nowhere. Source:
Jolt Physics, Body::UpdateSleepStateInternal, which asks whether three points of a body stay within spheres; here it is
the way of the furthest point from where the clock began. Speed and time: Box2D v3.2, solver.c.
"""

import math

import numpy as np

from physics.dynamics.awake import is_active
from physics.dynamics.graph import join, root_of
from physics.dynamics.sleepers import Island
from physics.jit import kernel, subkernel
from physics.math2d import length_of
from physics.settings import SLEEP_TIME
from physics.tables.body import DYNAMIC
from physics.tables.contact import EVENT
from physics.tables.counters import ISLANDS
from physics.tables.step_state import StepState, stage

COUNTED = 2.0**62  # times that patience may have passed: more are no whole number of a kernel


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
    excess_out,
    bodies_inout,
):
    """Put the islands to sleep of which nobody got further for `patience` [s] than with the speed `slow` [px/s], and
    which as a whole are slower now. Returns (islands of dynamic bodies that were awake, bodies that fell asleep).

    So few may tremble, and what has only just begun to fall, or was shoved, stays awake. What touches a kinematic body
    on its way does too, and so does what is on a surface that runs, with conveyor 1, however slowly. rows: the awake
    ones; parents_inout: see graph.join; least_out, excess_out (bodies): scratch. O(rows + manifolds).
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
        if b.kind != DYNAMIC or not b.awake or b.quarantined:
            continue
        before = b.sleep_time
        far = length_of(b.x - b.still_x, b.y - b.still_y) + abs(b.angle - b.still_angle) * b.extent > distance
        b.sleep_time = 0.0 if far else before + dt
        # What creeps along, slower than this, stays near a pose that follows it.
        times = b.sleep_time / patience
        if far or (abs(times) < COUNTED and math.floor(times) > math.floor(before / patience)):
            b.still_x = b.x
            b.still_y = b.y
            b.still_angle = b.angle
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
            speed = length_of(b.vx, b.vy) + abs(b.angular_velocity) * b.extent
            excess_out[root] += speed * speed - slow * slow
    slept = 0
    for k in range(len(rows)):
        b = bodies_inout[rows[k]]
        root = parents_inout[rows[k]]
        calm = least_out[root] >= patience and excess_out[root] <= 0.0
        if b.kind == DYNAMIC and b.awake and not b.quarantined and calm:
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
        self.parents, self.least, self.excess = np.zeros(16, np.int32), np.zeros(16), np.zeros(16)
        self.edges = np.zeros((16, 2), np.int32)

    def grow(self, bodies: int, manifolds: int) -> None:
        """Make room; nothing is kept."""
        if len(self.parents) < bodies:
            self.parents = np.zeros(2 * bodies, np.int32)
            self.least, self.excess = np.zeros(2 * bodies), np.zeros(2 * bodies)
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
        "bodies.still_x",
        "bodies.still_y",
        "bodies.still_angle",
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
        search.excess,
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
    parked["again"] = False  # the other side may be carried elsewhere meanwhile
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
