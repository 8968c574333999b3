"""How many substeps an island asks for: as many as keep its contacts from sinking further than the accuracy.

A contact is a spring whose frequency is a share of the substeps per second: under a force F it sinks by F / (m ω²), a
quarter of that with twice the substeps. What the last step bore tells what the next one needs. Up at once; down, by
half, when that has been enough for all of an island for a while: its contacts would still sink by no more than half of
the accuracy, or islands would go up and down.
Source of the spring: Catto, Soft Constraints, GDC 2011.
"""

import math

import numpy as np

from physics.jit import kernel
from physics.settings import AUTO_SUBSTEPS, EASE_TIME, LEAN, STILL_STIFFNESS
from physics.solver.motions import Motions
from physics.solver.pace import Pace, firmness_of
from physics.solver.selection import Group, demand_rate
from physics.tables.counters import CAP_HITS
from physics.tables.step_state import StepState


@kernel
def add_demands(
    # read
    constraints,
    rate,
    rate_still,
    most,
    pace,
    # write
    motions_inout,
):
    """Write to both motions of each constraint the square of the substeps that it asks for, where it is greater.

    rate, rate_still: that square per speed that the impulses of the step give [s/px], between bodies and with what
    cannot be pushed, where nothing grips firmer (see Pace); most: the square of the most substeps, than which nobody
    asks for more because it leans. O(constraints).
    """
    for i in range(len(constraints)):
        r = constraints[i]
        per_speed = (rate_still if r.still else rate) / firmness_of(r, pace)
        demand = per_speed * r.normal_total_1 / r.normal_mass_1
        if r.count == 2:
            other = per_speed * r.normal_total_2 / r.normal_mass_2
            least = min(demand, other)
            demand = max(demand, other)
            if r.alone and least > 0.0:
                # What stands on an edge leans by the difference, and has but the rest of the face to lean.
                demand = max(demand, min(demand * min(demand / least, LEAN), most))
        a = motions_inout[r.motion_a]
        b = motions_inout[r.motion_b]
        a.demand = max(a.demand, demand)
        b.demand = max(b.demand, demand)


@kernel
def choose_substeps(
    # read
    members,
    parents,
    substeps,
    least,
    most,
    dt,
    patience,
    # write
    motions_inout,
):
    """Write the substeps that the islands of the members are to take after a step of so many. Returns how many islands
    have asked for more than the most for as long as `patience` [s], which is none of an impact. O(members).

    members: rows of MOTION, ascending; parents (motions) int32: the root of each one's island, its lowest row.
    """
    for k in range(len(members)):
        i = members[k]
        m = motions_inout[i]
        wanted = substeps
        eased = 0.0
        if m.demand > most * most and substeps == most:
            eased = min(m.eased, 0.0) - dt
            if eased <= -patience:
                motions_inout[parents[i]].demand = math.inf
        elif m.demand > substeps * substeps:
            while wanted < most and wanted * wanted < m.demand:
                wanted *= 2
        elif substeps > least and 8.0 * m.demand <= substeps * substeps:
            eased = min(m.eased + dt, patience)
            if eased >= patience:
                wanted = substeps // 2
        m.eased = eased
        m.substeps = wanted
        root = motions_inout[parents[i]]
        root.substeps = max(root.substeps, wanted)
    capped = 0
    for k in range(len(members)):
        i = members[k]
        m = motions_inout[i]
        root = motions_inout[parents[i]]
        m.substeps = root.substeps
        if m.substeps != substeps:
            m.eased = 0.0
        capped += int(parents[i] == i and root.demand == math.inf)
    return capped


def ask_for_substeps(
    state: StepState, motions: Motions, parents: np.ndarray, group: Group, pace: Pace, rows: np.ndarray
) -> None:
    """Have the bodies of a group ask for what their contacts, CONSTRAINT rows, need in the next step."""
    rate = demand_rate(state)
    least, most = AUTO_SUBSTEPS[0], AUTO_SUBSTEPS[-1]
    add_demands(rows, rate, rate / STILL_STIFFNESS**2, float(most * most), pace, motions.used)
    state.work[CAP_HITS] += choose_substeps(
        group.members, parents, group.substeps, least, most, state.dt, EASE_TIME, motions.used
    )
