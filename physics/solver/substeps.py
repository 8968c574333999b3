"""Substeps by load: how many substeps an island needs, and the release of cached forces when a load is removed."""

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from physics.islands.graph import find_roots
from physics.jit import kernel, subkernel
from physics.settings import AUTO_SUBSTEPS, BLOW, EASE_TIME, LEAN, LOAD_SUBSTEPS, STILL_STIFFNESS
from physics.solver import lanes as at
from physics.solver.lanes import Blocks
from physics.solver.motions import Motions
from physics.solver.selection import Group, Plan, estimate_rate
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


# ---- estimate --------------------------------------------------------------------------------------------------------
# Substep estimate of an island: as many as keep the sag of its contacts within the accuracy.
#
# A contact is a spring whose frequency is a share of the substeps per second: under a force F it sags by F / (m ω²), a
# quarter of that with twice the substeps. The loads of the last step give the number for the next one. It rises at
# once; it falls by half after half has been enough for a whole island for a while: the sag then stays within half of
# the accuracy, so that islands do not alternate. A load alone takes no more than LOAD_SUBSTEPS, and so does a heap. A
# leaning column takes more: its load shifts further out, and it does not recover. Source of the spring: Catto, Soft
# Constraints, GDC 2011.


class LoadRules(NamedTuple):
    """How the substeps of an island follow from its loads."""

    rate: float  # square of the substeps per speed that the impulses of the step give [s/px], between bodies …
    rate_static: float  # … and against static ones, without the factor on the stiffness (see StepContext)
    least: int  # fewest substeps
    most_by_load: int  # most substeps of a load …
    most: int  # … and of a leaning stack
    dt: float  # [s]
    patience: float  # [s] for which fewer must have been enough


@subkernel
def add_estimates(blocks, count, substeps, rules, motions_inout):
    """Write to both motions of each constraint the square of the substeps that it needs, if it is greater.

    Also write whether its load would need more than these `substeps` and than a load may take. blocks: so many blocks
    of lanes, see lanes.py. O(constraints).
    """
    reach = max(substeps, rules.most_by_load)
    reach_squared = float(reach * reach)
    # Half of the square keeps the present number, and lets a lean that took twice as many come down to it.
    by_load = 0.5 * float(rules.most_by_load * rules.most_by_load)
    for block in range(count):
        c = blocks.lines[block * at.SIZE : (block + 1) * at.SIZE]
        for lane in range(at.LANES):
            if blocks.contact[block, lane] < 0 or c[at.MOST + lane] < math.inf:
                continue
            static = c[at.IM_A + lane] == 0.0 or c[at.IM_B + lane] == 0.0
            per_speed = (rules.rate_static if static else rules.rate) / abs(c[at.STIFFNESS + lane])
            lean = 1.0
            estimate = per_speed * c[at.TOTAL_1 + lane] / c[at.MASS_1 + lane]
            if c[at.MASS_2 + lane] > 0.0:
                other = per_speed * c[at.TOTAL_2 + lane] / c[at.MASS_2 + lane]
                least = min(estimate, other)
                estimate = max(estimate, other)
                if c[at.STIFFNESS + lane] < 0.0 and least > 0.0:
                    # A body on one sole support leans by the difference of its points, and the rest of the face is its
                    # margin.
                    lean = min(estimate / least, LEAN)
            capped = estimate > reach_squared
            estimate = min(lean * min(estimate, by_load), float(rules.most * rules.most))
            a = motions_inout[blocks.motion_a[block, lane]]
            b = motions_inout[blocks.motion_b[block, lane]]
            a.capped = a.capped or capped
            b.capped = b.capped or capped
            a.estimate = max(a.estimate, estimate)
            b.estimate = max(b.estimate, estimate)


@subkernel
def choose_substeps(members, degrees, substeps, rules, motions_inout):
    """Write the substeps that each island body needs after a step of so many. Return whether all need the present
    number. O(members).
    """
    content = True
    for k in range(len(members)):
        i = members[k]
        m = motions_inout[i]
        m.branching = degrees[i] > 2
        estimate = m.estimate
        wanted = substeps
        cooldown = 0.0
        if m.capped and substeps >= rules.most_by_load:
            cooldown = min(m.cooldown, 0.0) - rules.dt
            if cooldown <= -rules.patience:
                m.estimate = math.inf
                content = False
        if estimate > substeps * substeps:
            while wanted < rules.most and wanted * wanted < estimate:
                wanted *= 2
        elif substeps > rules.least and 8.0 * estimate <= substeps * substeps:
            if not m.capped:
                cooldown = min(m.cooldown + rules.dt, rules.patience)
            if abs(cooldown) >= rules.patience:
                wanted = substeps // 2
        m.cooldown = cooldown
        m.substeps = wanted
        content = content and wanted == substeps and not (m.branching and substeps > rules.most_by_load)
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
        root.estimate = max(root.estimate, m.estimate)
        root.branching = root.branching or m.branching
    capped = 0
    for k in range(len(members)):
        i = members[k]
        m = motions_inout[i]
        root = motions_inout[parents[i]]
        m.substeps = min(root.substeps, most_by_load) if root.branching else root.substeps
        if m.substeps != substeps:
            m.cooldown = 0.0
        capped += int(parents[i] == i and root.estimate == math.inf)
    return capped


@kernel
def choose_by_load(
    # read
    blocks,
    count,
    group,
    links_islands,
    rules,
    # write
    plan_inout,
    motions_inout,
):
    """Write the substeps of the islands after a step of so many.

    Return the number of islands that needed more than they may take for `patience` [s], which leaves out impacts.
    blocks: so many blocks of lanes; group, plan_inout: see selection.py; links_islands: see find_roots. Islands are
    found only if the bodies differ. O(members + constraints).
    """
    plan = plan_inout
    substeps = group.substeps
    add_estimates(blocks, count, substeps, rules, motions_inout)
    if choose_substeps(group.members, plan.degrees, substeps, rules, motions_inout):
        return 0
    parents = plan.parents[: len(motions_inout)]
    if not plan.joined[0]:
        find_roots(plan.edges, group.edges, links_islands, parents)
        plan.joined[0] = True
    return share_substeps(group.members, parents, substeps, rules.most_by_load, motions_inout)


def estimate_substeps(state: StepState, motions: Motions, plan: Plan, group: Group, blocks: Blocks, count: int) -> None:
    """Estimate the substeps of the next step from the contacts of a group, so many blocks."""
    rate = estimate_rate(state)
    rules = LoadRules(
        rate, rate / STILL_STIFFNESS**2, AUTO_SUBSTEPS[0], LOAD_SUBSTEPS, AUTO_SUBSTEPS[-1], state.dt, EASE_TIME
    )
    links = motions.lists.links_islands
    state.work[CAP_HITS] += choose_by_load(blocks, count, group, links, rules, plan, motions.used)
