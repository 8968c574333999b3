"""How many substeps an island needs, and forces that are forgotten when a load is removed."""

import math
from collections.abc import Sequence

import numpy as np

from physics.islands.graph import find_roots
from physics.jit import kernel, subkernel
from physics.settings import AUTO_SUBSTEPS, BLOW, EASE_TIME, LEAN, LOAD_SUBSTEPS, STILL_STIFFNESS
from physics.solver import lanes as at
from physics.solver.constraints import Group, Selection, demand_rate
from physics.solver.lanes import Blocks
from physics.solver.motions import Motions
from physics.tables.step_state import CAP_HITS, StepState, WorldTables
from physics.tables.table import rows_of

# ---- unloading -------------------------------------------------------------------------------------------------------
# What bore a heavy load that is gone starts from nothing: or the forces that held the load throw what lay under it.
#
# A contact starts from the force that it ended the step before with. Where a body of a thousand times its mass has
# gone, that is a thousand times what is needed now; a pass takes back what the order of contacts lets it, the rest is
# speed.

FORCES = ("normal_force_1", "tangent_force_1", "normal_force_2", "tangent_force_2", "rolling_force")


def forget_loads(tables: WorldTables, ids: Sequence[int] | np.ndarray) -> None:
    """Of bodies that are taken away, or put elsewhere: where one lay on something with many times its weight, the
    contacts of all that this is piled with, through whatever can be pushed, forget their forces.

    O(contacts · depth of the pile), in worlds that stack.
    """
    manifolds, anchors, bodies = tables.manifolds, tables.anchors, tables.bodies
    if not len(manifolds) or len(anchors) != len(manifolds):
        return  # nothing is remembered
    ids_a, ids_b = manifolds["body_a"], manifolds["body_b"]
    going_a, going_b = np.isin(ids_a, ids), np.isin(ids_b, ids)
    lost = going_a != going_b
    if not lost.any():
        return
    left = rows_of(bodies, np.where(going_a, ids_b, ids_a)[lost])
    force = (anchors["normal_force_1"] + np.where(manifolds["count"] == 2, anchors["normal_force_2"], 0.0))[lost]
    reached = np.zeros(len(bodies), bool)
    weight = math.hypot(*tables.gravity) if tables.effects.gravity else 0.0
    reached[left[(force > 0.0) & (force * bodies["inverse_mass"][left] > BLOW * weight)]] = True
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
        anchors[name][borne] = 0.0


# ---- demand ----------------------------------------------------------------------------------------------------------
# How many substeps an island asks for: as many as keep its contacts from sinking further than the accuracy.
#
# A contact is a spring whose frequency is a share of the substeps per second: under a force F it sinks by F / (m ω²), a
# quarter of that with twice the substeps. What the last step bore tells what the next one needs. Up at once; down, by
# half, when that has been enough for all of an island for a while: its contacts would still sink by no more than half
# of the accuracy, or islands would go up and down. A load alone may ask for no more than LOAD_SUBSTEPS, and so may a
# heap; a column that leans for more: what begins to lean shifts its load further out, and has no second try. Source of
# the spring: Catto, Soft Constraints, GDC 2011.


@subkernel
def add_demands(
    # read
    blocks,
    count,
    rate,
    rate_still,
    substeps,
    most_by_load,
    most,
    # write
    motions_inout,
):
    """Write to both motions of each constraint the square of the substeps that it asks for, where it is greater, and
    whether its load would need more than these `substeps` and than a load may ask for.

    blocks: so many blocks of lanes, see lanes.py; rate, rate_still: that square per speed that the impulses of the step
    give [s/px], between bodies and with what cannot be pushed, where nothing grips firmer (see Pace); most_by_load,
    most: the most substeps that a load may ask for, and what leans. O(constraints).
    """
    reach = max(substeps, most_by_load)
    reach_squared = float(reach * reach)
    # Half of their square asks for as many, and lets what took twice as many, because it leant, come down to them.
    by_load = 0.5 * float(most_by_load * most_by_load)
    for block in range(count):
        c = blocks.lines[block * at.SIZE : (block + 1) * at.SIZE]
        for lane in range(at.LANES):
            if blocks.manifold[block, lane] < 0:
                continue
            still = c[at.IM_A + lane] == 0.0 or c[at.IM_B + lane] == 0.0
            per_speed = (rate_still if still else rate) / abs(c[at.FIRMNESS + lane])
            lean = 1.0
            demand = per_speed * c[at.TOTAL_1 + lane] / c[at.MASS_1 + lane]
            if c[at.MASS_2 + lane] > 0.0:
                other = per_speed * c[at.TOTAL_2 + lane] / c[at.MASS_2 + lane]
                least = min(demand, other)
                demand = max(demand, other)
                if c[at.FIRMNESS + lane] < 0.0 and least > 0.0:
                    # What stands alone on an edge leans by the difference, and has but the rest of the face to lean.
                    lean = min(demand / least, LEAN)
            overloaded = demand > reach_squared
            demand = min(lean * min(demand, by_load), float(most * most))
            a = motions_inout[blocks.motion_a[block, lane]]
            b = motions_inout[blocks.motion_b[block, lane]]
            a.overloaded = a.overloaded or overloaded
            b.overloaded = b.overloaded or overloaded
            a.demand = max(a.demand, demand)
            b.demand = max(b.demand, demand)


@subkernel
def choose_substeps(
    # read
    members,
    degrees,
    substeps,
    least,
    most_by_load,
    most,
    dt,
    patience,
    # write
    motions_inout,
):
    """Write how many substeps each of the members would take after a step of so many. Returns whether all of them are
    content with these. See ask_by_load. O(members)."""
    content = True
    for k in range(len(members)):
        i = members[k]
        m = motions_inout[i]
        m.crowded = degrees[i] > 2
        demand = m.demand
        wanted = substeps
        eased = 0.0
        if m.overloaded and substeps >= most_by_load:
            eased = min(m.eased, 0.0) - dt
            if eased <= -patience:
                m.demand = math.inf
                content = False
        if demand > substeps * substeps:
            while wanted < most and wanted * wanted < demand:
                wanted *= 2
        elif substeps > least and 8.0 * demand <= substeps * substeps:
            if not m.overloaded:
                eased = min(m.eased + dt, patience)
            if abs(eased) >= patience:
                wanted = substeps // 2
        m.eased = eased
        m.substeps = wanted
        content = content and wanted == substeps and not (m.crowded and substeps > most_by_load)
    return content


@subkernel
def share_substeps(
    # read
    members,
    parents,
    substeps,
    most_by_load,
    # write
    motions_inout,
):
    """Give each member the most that one of its island would take, after a step of so many; in a heap no more than a
    load may ask for, since something leans there all the time. Returns how many islands are told to have asked for too
    many. parents (motions) int32: the root of each one's island, its lowest row. O(members)."""
    for k in range(len(members)):
        m = motions_inout[members[k]]
        root = motions_inout[parents[members[k]]]
        root.substeps = max(root.substeps, m.substeps)
        root.demand = max(root.demand, m.demand)
        root.crowded = root.crowded or m.crowded
    capped = 0
    for k in range(len(members)):
        i = members[k]
        m = motions_inout[i]
        root = motions_inout[parents[i]]
        m.substeps = min(root.substeps, most_by_load) if root.crowded else root.substeps
        if m.substeps != substeps:
            m.eased = 0.0
        capped += int(parents[i] == i and root.demand == math.inf)
    return capped


@kernel
def ask_by_load(
    # read
    blocks,
    count,
    rate,
    rate_still,
    members,
    degrees,
    joins,
    edges,
    constraints,
    substeps,
    least,
    most_by_load,
    most,
    dt,
    patience,
    # write
    parents_inout,
    joined_inout,
    motions_inout,
):
    """Write the substeps that the islands of the members are to take after a step of so many. Returns how many islands
    have asked for more than they may for as long as `patience` [s], which is none of an impact. See add_demands.
    O(members + constraints).

    members: rows of MOTION, ascending; degrees, joins, edges, constraints, parents_inout, joined_inout: see find_roots,
    Plan: who is of which island is asked only where they differ.
    """
    add_demands(blocks, count, rate, rate_still, substeps, most_by_load, most, motions_inout)
    if choose_substeps(members, degrees, substeps, least, most_by_load, most, dt, patience, motions_inout):
        return 0
    if not joined_inout[0]:
        find_roots(edges, constraints, joins, parents_inout[: len(motions_inout)])
        joined_inout[0] = True
    return share_substeps(members, parents_inout, substeps, most_by_load, motions_inout)


def ask_for_substeps(
    state: StepState, motions: Motions, selection: Selection, group: Group, blocks: Blocks, count: int
) -> None:
    """Have the bodies of a group ask for what their contacts, so many blocks of them, need in the next step."""
    plan = selection.plan
    rate = demand_rate(state)
    state.work[CAP_HITS] += ask_by_load(
        blocks,
        count,
        rate,
        rate / STILL_STIFFNESS**2,
        group.members,
        plan.degrees,
        motions.joins,
        plan.edges,
        selection.count,
        group.substeps,
        AUTO_SUBSTEPS[0],
        LOAD_SUBSTEPS,
        AUTO_SUBSTEPS[-1],
        state.dt,
        EASE_TIME,
        plan.parents,
        plan.joined,
        motions.used,
    )
