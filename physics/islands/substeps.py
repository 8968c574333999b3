"""Choice of the number of substeps of each island: from its loads in the last step, its impacts and its new bodies."""

import math
from typing import NamedTuple

import numpy as np

from physics.islands.graph import MOST_NODES
from physics.jit import subkernel
from physics.settings import HERTZ_SHARE
from physics.tables.step_state import StepState

# ---- substep classes -------------------------------------------------------------------------------------------------
# The number of substeps of each island, as an index in the numbers to choose from: its class.


class Islands(NamedTuple):
    """The bodies of the awake islands, and the numbers of substeps from which each island may choose."""

    members: np.ndarray  # int32 indices of MOTION rows
    rate: float  # see estimate_rate
    choices: np.ndarray  # int64 numbers of substeps, ascending
    by_load: int  # index in `choices` of the greatest number of substeps for a load alone
    jointed: int  # index in `choices` for a new body with joints and without contacts


def estimate_rate(state: StepState) -> float:
    """Return the factor r [s/px] from which the number of substeps of a contact follows: n² = r v.

    v [px/s] is the load: the impulse of the contact in the step, divided by its effective mass m. In n substeps, the
    contact sags by no more than state.accuracy [px]. The sag under a force F is F / (m ω²). HERTZ_SHARE gives ω as a
    fraction of the substeps per second.
    """
    return state.dt / ((math.tau * HERTZ_SHARE) ** 2 * state.accuracy)


@subkernel
def class_for(choices, square, least):
    """Return the index in `choices` of the least number of substeps n with n² >= square.

    The search begins at index `least`. choices: numbers of substeps, ascending. If no choice is large enough, the
    result is the last index.
    """
    place = least
    while place < len(choices) - 1 and choices[place] * choices[place] < square:
        place += 1
    return place


@subkernel
def class_motions(motions, degrees, islands, classes_out):
    """Write the substep class of each MOTION row: the index of its number of substeps in islands.choices. O(motions).

    Return whether there are new bodies with contacts. A body without constraints gets the fewest substeps. A new body
    gets the class islands.by_load if it has contacts, and islands.jointed if it has only joints. Every other body keeps
    the number that the last step chose (MOTION.substeps). degrees: number of contacts of each body.
    """
    unknown = False
    choices, by_load = islands.choices, islands.by_load
    for i in range(len(classes_out)):
        classes_out[i] = 0
        m = motions[i]
        if (degrees[i] > 0 or m.jointed) and m.is_dynamic:
            if m.substeps == 0:
                unknown = unknown or degrees[i] > 0
                classes_out[i] = by_load if degrees[i] > 0 else islands.jointed
            else:
                classes_out[i] = class_for(choices, float(m.substeps * m.substeps), 0)
    return unknown


@subkernel
def expect_impacts(edges, count, motions, rate, choices, classes_inout):
    """Raise the substep class of bodies that collide in this step, to the class that the impact needs. O(count).

    More substeps are needed for a greater ratio of the masses, because a light body has to transmit the momentum of a
    heavy one. count: number of contacts, the first entries of `edges`; motions: MOTION rows; rate: result of
    estimate_rate; choices: numbers of substeps, ascending; classes_inout: substep classes, see class_motions.
    """
    for i in range(count):
        speed = edges.impact_speeds[i]
        if speed <= 0.0:
            continue
        square = speed * rate
        least = math.inf
        most = 0.0
        for k in range(MOST_NODES):
            if edges.nodes[i, k] < 0:
                break
            inverse_mass = motions[edges.nodes[i, k]].inverse_mass
            least = min(least, inverse_mass)
            most = max(most, inverse_mass)
        if least > 0.0:
            square *= most / least
        for k in range(MOST_NODES):
            node = edges.nodes[i, k]
            if node < 0:
                break
            if motions[node].is_dynamic:
                classes_inout[node] = class_for(choices, square, int(classes_inout[node]))


@subkernel
def expect_columns(edges, count, motions, degrees, most, classes_inout):
    """Give new columns the most substeps. A column is a stack of bodies with at most two contacts each. O(count).

    How far a column leans is unknown until the load has reached its foot, and a lean does not stop by itself. count:
    number of contacts, the first entries of `edges`; motions: MOTION rows; degrees: number of contacts of each body;
    most: index of the greatest number of substeps in the choices; classes_inout: substep classes, see class_motions.
    """
    for i in range(count):
        if not edges.resting[i]:
            continue
        is_new = False
        column = True
        for k in range(MOST_NODES):
            node = edges.nodes[i, k]
            if node < 0:
                break
            is_new = is_new or motions[node].substeps == 0
            column = column and motions[node].is_dynamic and degrees[node] <= 2
        if is_new and column:
            classes_inout[edges.nodes[i, 0]] = most


@subkernel
def are_mixed(motions, degrees, classes):
    """Return whether the bodies with constraints are in different substep classes, see class_motions. O(motions).

    degrees: number of contacts of each MOTION row; classes: class of each MOTION row.
    """
    first = -1
    for i in range(len(classes)):
        if motions[i].is_dynamic and (degrees[i] > 0 or motions[i].jointed):
            if first < 0:
                first = classes[i]
            elif classes[i] != first:
                return True
    return False


# ---- estimate --------------------------------------------------------------------------------------------------------
# Substep estimate of an island: the number of substeps that keeps the sag of its contacts within the accuracy.
#
# A contact is a spring whose frequency is a fixed fraction of the substeps per second: under a force F it sags by
# F / (m ω²), and with twice the substeps by a quarter. The loads of the last step give the number for the next step.
# The number rises immediately. It is halved after half the number has been enough for the whole island for a while,
# with a sag of at most half the accuracy, so that islands do not alternate. Loads alone, and heaps, take at most
# LOAD_SUBSTEPS. A leaning column takes more, because its lean would increase and not stop. Source of the spring: Catto,
# Soft Constraints, GDC 2011.


class LoadRules(NamedTuple):
    """Constants that determine the number of substeps of an island from its loads."""

    rate: float  # see estimate_rate; for contacts between dynamic bodies …
    rate_static: float  # … and with static bodies, both without the factor STIFFNESS of lanes.py
    least: int  # fewest substeps
    most_by_load: int  # greatest number of substeps for a load …
    most: int  # … and for a leaning stack
    dt: float  # [s]
    patience: float  # [s] time for which fewer substeps must have been enough


@subkernel
def choose_substeps(members, degrees, substeps, rules, motions_inout):
    """Write the number of substeps that each body of a group needs in the next step. O(members).

    Return True if every body needs the same number as in this step; the caller then need not determine the islands.
    members: indices of the MOTION rows of the group; degrees: number of contacts of each body; substeps: number in this
    step; rules: see LoadRules.
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
def share_substeps(members, parents, substeps, most_by_load, motions_inout):
    """Give each body the greatest number of substeps that any body of its island needs. O(members).

    Return the number of capped islands, which need more substeps than they may take. An island in which a body has more
    than two contacts is a heap. A heap takes at most most_by_load substeps, because some body of a heap always leans.
    members: indices of MOTION rows; parents (motions,) int32: the lowest row of the island of each body; substeps:
    number of substeps in this step.
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
