"""Substeps by load: how many substeps an island needs, and the release of cached forces when a load is removed."""

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
# Release of cached forces under a heavy load that is removed; otherwise those forces would throw the bodies below.
#
# A contact starts from the force at the end of the step before. After a body of a thousand times its mass is removed,
# that is a thousand times the force that is needed. A pass removes as much of it as the order of the contacts allows;
# the rest becomes velocity.

FORCES = ("normal_force_1", "tangent_force_1", "normal_force_2", "tangent_force_2", "rolling_force")


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
        contacts[name][borne] = 0.0


# ---- demand ----------------------------------------------------------------------------------------------------------
# Substep estimate of an island: as many as keep the sag of its contacts within the accuracy.
#
# A contact is a spring whose frequency is a share of the substeps per second: under a force F it sags by F / (m ω²), a
# quarter of that with twice the substeps. The loads of the last step give the number for the next one. It rises at
# once; it falls by half after half has been enough for a whole island for a while: the sag then stays within half of
# the accuracy, so that islands do not alternate. A load alone takes no more than LOAD_SUBSTEPS, and so does a heap. A
# leaning column takes more: its load shifts further out, and it does not recover. Source of the spring: Catto, Soft
# Constraints, GDC 2011.


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
    """Write to both motions of each constraint the square of the substeps that it needs, if it is greater.

    Also write whether its load would need more than these `substeps` and than a load may take. blocks: so many blocks
    of lanes, see lanes.py. rate, rate_still: that square per speed that the impulses of the step give [s/px], between
    bodies and against static ones, without firmness (see Pace). most_by_load, most: the most substeps of a load, and of
    a leaning stack. O(constraints).
    """
    reach = max(substeps, most_by_load)
    reach_squared = float(reach * reach)
    # Half of the square keeps the present number, and lets a lean that took twice as many come down to it.
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
                    # A body on one sole support leans by the difference of its points, and the rest of the face is its
                    # margin.
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
    """Write the substeps that each island body needs after a step of so many. Return whether all need the present
    number. See ask_by_load. O(members).
    """
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
    """Give each body the most substeps that a body of its island needs, after a step of so many.

    In a heap it is no more than a load may take, since some body leans there all the time. Return the number of islands
    that are reported as capped. parents (motions) int32: the root of each island, its lowest row. O(members).
    """
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
    """Write the substeps of the islands after a step of so many.

    Return the number of islands that needed more than they may take for `patience` [s], which leaves out impacts.
    members: rows of MOTION, ascending. degrees, joins, edges, constraints, parents_inout, joined_inout: see find_roots
    and Plan. Islands are found only if the bodies differ. See add_demands. O(members + constraints).
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
    """Estimate the substeps of the next step from the contacts of a group, so many blocks."""
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
