"""The constraints of a step: selection, order by substeps and colour, and groups of islands with equal substeps.

Islands with the same number of substeps form a group, which advances by the whole step before the next group begins.
Islands do not affect each other: the motion of kinematic bodies between them is a function of time.
"""

import math
from typing import NamedTuple

import numpy as np

from physics.islands.graph import (
    MOST_NODES,
    Edges,
    color_edges,
    find_roots,
    new_edges,
    order_edges,
    order_nodes,
    share_classes,
    write_pair,
)
from physics.jit import kernel, subkernel
from physics.math2d import norm
from physics.settings import AUTO_SUBSTEPS, COLORS, HERTZ_SHARE, LOAD_SUBSTEPS
from physics.solver.motions import Motions
from physics.solver.squeeze import find_squeezed
from physics.tables.contact import SQUEEZE
from physics.tables.step_state import StepState

CHOICES = np.array(AUTO_SUBSTEPS, np.int64)
BY_LOAD = AUTO_SUBSTEPS.index(LOAD_SUBSTEPS)  # index of the greatest that a load alone may take


class Plan(NamedTuple):
    """The constraints to solve and their order; each array has room for all of them."""

    edges: Edges  # their nodes are rows of MOTION
    colors: np.ndarray  # (edges) int32 of each edge
    places: np.ndarray  # (edges) int32 place of each among the constraints, by group and colour
    taken: np.ndarray  # (motions) int64 bits of the colours that each has
    degrees: np.ndarray  # (motions) int64 edges of each
    classes: np.ndarray  # (motions) int32 index of the substeps of each among the choices
    parents: np.ndarray  # (motions) int32 root of the island of each, if …
    joined: np.ndarray  # (1) bool … it was computed
    touching: np.ndarray  # (motions) int32 root of the bodies with which each exchanged impulses, see energy.py
    squeezed: np.ndarray  # (1) bool an island has no room, …
    squeeze: np.ndarray  # SQUEEZE (motions) … and impulses in it are bounded
    members: np.ndarray  # (motions) int32 island bodies, by group
    starts: np.ndarray  # int64 first constraint of each colour of each group, those without a colour first
    firsts: np.ndarray  # int64 first body of each group
    cursors: np.ndarray  # scratch, as long as starts


def new_plan(edges: int, motions: int) -> Plan:
    """Return room for so many edges between so many motions."""
    slots = len(AUTO_SUBSTEPS) * (COLORS + 1) + 1
    return Plan(
        edges=new_edges(edges),
        colors=np.zeros(edges, np.int32),
        places=np.zeros(edges, np.int32),
        taken=np.zeros(motions, np.int64),
        degrees=np.zeros(motions, np.int64),
        classes=np.zeros(motions, np.int32),
        parents=np.zeros(motions, np.int32),
        joined=np.zeros(1, np.bool_),
        touching=np.zeros(motions, np.int32),
        squeezed=np.zeros(1, np.bool_),
        squeeze=np.zeros(motions, SQUEEZE),
        members=np.zeros(motions, np.int32),
        starts=np.zeros(slots, np.int64),
        firsts=np.zeros(len(AUTO_SUBSTEPS) + 1, np.int64),
        cursors=np.zeros(slots, np.int64),
    )


class Group(NamedTuple):
    """The islands that take the same number of substeps."""

    substeps: int
    edges: int  # number of edges of all groups
    count: int  # number of constraints of the group …
    uncolored: int  # … and of those without a colour
    members: np.ndarray  # int32 rows of MOTION
    starts: np.ndarray  # int64 first constraint of each colour, those without a colour first, and the end of the last


# ---- edges of contacts -----------------------------------------------------------------------------------------------


@subkernel
def touches_slowly(separation, speed, limits):
    """Return whether a point touches, and approaches too slowly to bounce."""
    return separation <= limits.slop and abs(speed) <= limits.impact_speed


@subkernel
def credit_overlap(overlap, motion, balance_inout):
    """Add the energy that lifts a body by an overlap [px] to what it may take."""
    m = motion
    if m.inverse_mass > 0.0:
        balance_inout.reserve += overlap * norm(m.acceleration_x, m.acceleration_y) / m.inverse_mass


@subkernel
def list_contact_edges(
    # read
    contacts,
    bodies,
    motions,
    dt,
    limits,
    # write
    lists_inout,
    edges_out,
):
    """List the contacts to solve as edges between rows of MOTION. Return their number, that of overlaps with bodies of
    infinite mass, and the greatest overlap [px] of all. O(contacts).

    Sensors, pairs without a dynamic body, and contacts under a character's feet are left out.
    """
    motion_of = lists_inout.motion_of
    found = 0
    faces = 0
    deepest = 0.0
    for i in range(len(contacts)):
        c = contacts[i]
        row_a = motion_of[c.body_row_a]
        row_b = motion_of[c.body_row_b]
        a = motions[row_a]
        b = motions[row_b]
        if (
            c.sensor
            or a.inverse_mass + b.inverse_mass == 0.0
            or (a.is_character and c.normal_y > abs(c.normal_x))
            or (b.is_character and -c.normal_y > abs(c.normal_x))
        ):
            continue
        write_pair(found, i, row_a, row_b, edges_out)
        speed = c.speed_1 if c.speed_1 * dt > c.separation_1 else 0.0
        if c.count == 2 and c.speed_2 * dt > c.separation_2:
            speed = max(speed, c.speed_2)
        edges_out.impact_speeds[found] = speed
        edges_out.resting[found] = touches_slowly(c.separation_1, c.speed_1, limits)
        overlap = -(min(c.separation_1, c.separation_2) if c.count == 2 else c.separation_1)
        edges_out.overlaps[found] = overlap
        deepest = max(deepest, overlap)
        edges_out.faces[found, 0] = 0.0
        edges_out.faces[found, 1] = 0.0
        for side in range(2):
            o = a if side == 0 else b
            # A character that is pushed gives way, unless it is wedged.
            if overlap > 0.0 and o.inverse_mass == 0.0 and not o.is_character:
                sign = 1.0 if side == 0 else -1.0
                edges_out.faces[found, 0] = sign * c.normal_x
                edges_out.faces[found, 1] = sign * c.normal_y
                body = bodies[c.body_row_a if side == 0 else c.body_row_b]
                x, y = c.x_1 - body.center_x, c.y_1 - body.center_y
                speed = norm(o.vx - o.angular_velocity * y, o.vy + o.angular_velocity * x)
                edges_out.face_speeds[found] = speed if o.moves else 0.0
                faces += 1
        if overlap > 0.0 and c.of_new_pair:
            # What is made inside another may be lifted out of it.
            credit_overlap(overlap, a, lists_inout.balance[row_a])
            credit_overlap(overlap, b, lists_inout.balance[row_b])
        found += 1
    return found, faces, deepest


# ---- substep classes -------------------------------------------------------------------------------------------------
# The number of substeps of each island, as an index of the choices.


def estimate_rate(state: StepState) -> float:
    """Return the square of the substeps that keep the sag of a contact within the accuracy, per speed [s/px].

    The speed is that which the impulses of a step give the effective mass. A contact sags by F / (m ω²), with ω by
    HERTZ_SHARE.
    """
    return state.dt / ((math.tau * HERTZ_SHARE) ** 2 * state.accuracy)


@subkernel
def class_for(choices, square, least):
    """Return the index of the first choice, from `least` on, whose square is at least that; the last one if there is
    none.
    """
    place = least
    while place < len(choices) - 1 and choices[place] * choices[place] < square:
        place += 1
    return place


@subkernel
def class_motions(motions, degrees, choices, by_load, classes_out):
    """Write the index of each motion's number of substeps among the choices. Return whether there are new bodies.

    A body without constraints takes the fewest, a new one as many as a load may need. O(motions).
    """
    unknown = False
    for i in range(len(classes_out)):
        classes_out[i] = 0
        m = motions[i]
        if degrees[i] > 0 and m.is_dynamic:
            if m.substeps == 0:
                unknown = True
                classes_out[i] = by_load
            else:
                classes_out[i] = class_for(choices, float(m.substeps * m.substeps), 0)
    return unknown


@subkernel
def expect_impacts(edges, count, motions, rate, choices, classes_inout):
    """Raise the class of bodies that meet in this step to the substeps that the impact will need. O(count).

    A light body carries the momentum of a heavy one. rate: see estimate_rate.
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
    """Give new two-contact stacks the most substeps: the class `most`. O(count).

    How a column leans is unknown until the load has reached its foot, and a lean does not stop by itself.
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
def are_mixed(links_islands, degrees, classes):
    """Return whether the bodies with constraints are of more than one class. O(motions)."""
    first = -1
    for i in range(len(classes)):
        if links_islands[i] and degrees[i] > 0:
            if first < 0:
                first = classes[i]
            elif classes[i] != first:
                return True
    return False


# ---- order -----------------------------------------------------------------------------------------------------------


@subkernel
def list_and_color(
    # read
    contacts,
    bodies,
    motions,
    dt,
    limits,
    # write
    lists_inout,
    plan_out,
):
    """List the constraints to solve as edges, and colour these. Return their number. O(contacts + motions).

    lists_inout: see MotionLists. See list_contact_edges, color_edges.
    """
    nodes = len(motions)
    count, faces, deepest = list_contact_edges(contacts, bodies, motions, dt, limits, lists_inout, plan_out.edges)
    taken = plan_out.taken[:nodes]
    degrees = plan_out.degrees[:nodes]
    color_edges(plan_out.edges, count, lists_inout.has_finite_mass, lists_inout.rank, taken, degrees, plan_out.colors)
    plan_out.squeezed[0] = False
    if faces > 1 and deepest > limits.deep:
        parents, squeeze = plan_out.parents[:nodes], plan_out.squeeze
        plan_out.squeezed[0] = find_squeezed(plan_out.edges, count, lists_inout, motions, limits, parents, squeeze)
    return count


@kernel
def order_in_one_group(
    # read
    contacts,
    bodies,
    motions,
    dt,
    limits,
    # write
    lists_inout,
    plan_out,
):
    """List the constraints to solve in one group, by colour. Return their number, and the number without a colour.
    O(contacts + motions).
    """
    count = list_and_color(contacts, bodies, motions, dt, limits, lists_inout, plan_out)
    starts = plan_out.starts[: COLORS + 2]
    order_edges(plan_out.edges, count, plan_out.colors, plan_out.classes[:0], starts, plan_out.cursors, plan_out.places)
    return count, starts[1] - starts[0]


@kernel
def order_by_load(
    # read
    contacts,
    bodies,
    motions,
    members,
    dt,
    limits,
    rate,
    choices,
    by_load,
    # write
    lists_inout,
    plan_out,
):
    """List the constraints to solve by the number of substeps of their islands, and by colour. Return their number.

    dt [s]; limits: see settings.Limits; rate: see estimate_rate; by_load: index of the greatest choice that a load
    alone may need; members: rows of MOTION. O(contacts + motions).
    """
    plan = plan_out
    nodes = len(motions)
    classes = plan.classes[:nodes]
    count = list_and_color(contacts, bodies, motions, dt, limits, lists_inout, plan)
    unknown = class_motions(motions, plan.degrees, choices, by_load, classes)
    expect_impacts(plan.edges, count, motions, rate, choices[: by_load + 1], classes)
    if unknown:
        expect_columns(plan.edges, count, motions, plan.degrees, len(choices) - 1, classes)
    plan.joined[0] = are_mixed(lists_inout.links_islands, plan.degrees, classes)
    if plan.joined[0]:
        parents = plan.parents[:nodes]
        find_roots(plan.edges, count, lists_inout.links_islands, parents)
        share_classes(parents, classes)
    order_edges(plan.edges, count, plan.colors, classes, plan.starts, plan.cursors, plan.places)
    order_nodes(members, classes, plan.firsts, plan.cursors, plan.members)
    return count


class Selection:
    """The order of the constraints of one world; its arrays grow and are reused."""

    def __init__(self) -> None:
        self.plan = new_plan(16, 16)

    def choose(self, state: StepState, motions: Motions, substeps: int) -> list[Group]:
        """Select, colour and order the constraints. substeps: their number, 0 for as many as each island needs."""
        rows, contacts, limits = motions.used, state.contact_rows, state.tolerances.limits
        if len(self.plan.colors) < len(contacts) or len(self.plan.taken) < len(rows):
            self.plan = new_plan(2 * len(contacts), 2 * len(rows))
        plan = self.plan
        if substeps:
            count, uncolored = order_in_one_group(contacts, state.bodies, rows, state.dt, limits, motions.lists, plan)
            return [Group(substeps, count, count, uncolored, motions.island_bodies, plan.starts[: COLORS + 2])]
        rate = estimate_rate(state)
        edges = order_by_load(
            contacts,
            state.bodies,
            rows,
            motions.island_bodies,
            state.dt,
            limits,
            rate,
            CHOICES,
            BY_LOAD,
            motions.lists,
            plan,
        )
        colors, firsts, starts = COLORS + 1, plan.firsts.tolist(), plan.starts
        groups = [
            Group(
                substeps=number,
                edges=edges,
                count=starts.item((k + 1) * colors) - starts.item(k * colors),
                uncolored=starts.item(k * colors + 1) - starts.item(k * colors),
                members=plan.members[firsts[k] : firsts[k + 1]],
                starts=starts[k * colors : (k + 1) * colors + 1],
            )
            for k, number in enumerate(AUTO_SUBSTEPS)
            if firsts[k] < firsts[k + 1]
        ]
        # Kinematic bodies move even if no dynamic body does.
        return groups or [Group(AUTO_SUBSTEPS[0], 0, 0, 0, motions.island_bodies, plan.starts[: colors + 1])]
