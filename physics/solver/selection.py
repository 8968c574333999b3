"""Which contacts are solved, in which order: island by island of as many substeps, and in each colour by colour.

Islands of the same number of substeps make a group, which is advanced by the whole step before the next begins. Nothing
passes from one island to another: the motions of what stands between them and is not pushed are functions of time.
"""

import math
from typing import NamedTuple

import numpy as np

from physics.dynamics.graph import color_edges, find_roots, order_edges, order_nodes, share_classes
from physics.jit import kernel, subkernel
from physics.settings import AUTO_SUBSTEPS, COLORS, HERTZ_SHARE, LOAD_SUBSTEPS
from physics.solver.motions import Motions
from physics.solver.rows import touches_slowly
from physics.tables.step_state import StepState


class Plan(NamedTuple):
    """Which manifolds are solved, and in which order: room for at least as many as there are."""

    selected: np.ndarray  # (edges) int32 manifold of each edge
    edges: np.ndarray  # (edges, 2) int32 rows of MOTION
    colors: np.ndarray  # (edges) int32 of each edge
    places: np.ndarray  # (edges) int32 row of each among the constraints, by group and colour
    taken: np.ndarray  # (motions) int64 bits of the colours that each has
    degrees: np.ndarray  # (motions) int64 edges of each
    classes: np.ndarray  # (motions) int32 where the substeps of each stand among the choices
    parents: np.ndarray  # (motions) int32 root of the island of each, where …
    joined: np.ndarray  # (1) bool … somebody had to know
    members: np.ndarray  # (motions) int32 what moves, by group
    starts: np.ndarray  # int64 where the rows of each colour of each group begin, the colourless first
    firsts: np.ndarray  # int64 where the members of each group begin
    cursors: np.ndarray  # as long as starts: scratch


CHOICES = np.array(AUTO_SUBSTEPS, np.int64)
BY_LOAD = AUTO_SUBSTEPS.index(LOAD_SUBSTEPS)  # the last that a load alone may ask for


def new_plan(edges: int, motions: int) -> Plan:
    """Room for so many edges between so many motions."""
    slots = len(AUTO_SUBSTEPS) * (COLORS + 1) + 1
    return Plan(
        selected=np.zeros(edges, np.int32),
        edges=np.zeros((edges, 2), np.int32),
        colors=np.zeros(edges, np.int32),
        places=np.zeros(edges, np.int32),
        taken=np.zeros(motions, np.int64),
        degrees=np.zeros(motions, np.int64),
        classes=np.zeros(motions, np.int32),
        parents=np.zeros(motions, np.int32),
        joined=np.zeros(1, np.bool_),
        members=np.zeros(motions, np.int32),
        starts=np.zeros(slots, np.int64),
        firsts=np.zeros(len(AUTO_SUBSTEPS) + 1, np.int64),
        cursors=np.zeros(slots, np.int64),
    )


class Group(NamedTuple):
    """The islands that take as many substeps each."""

    substeps: int
    start: int  # rows of the constraints, from …
    stop: int  # … to
    loose: int  # how many of them have no colour
    members: np.ndarray  # int32 rows of MOTION
    starts: np.ndarray  # int64 where the rows of each colour begin, the colourless first, and where the last end


def demand_rate(state: StepState) -> float:
    """The square of the substeps that keep a contact from sinking by more than the accuracy, per speed that the
    impulses on it in a step would give the mass that it moves [s/px]: it sinks by F / (m ω²), ω by HERTZ_SHARE."""
    return state.dt / ((math.tau * HERTZ_SHARE) ** 2 * state.accuracy)


@subkernel
def select_manifolds(
    # read
    manifolds,
    motion_of,
    motions,
    # write
    selected_out,
    edges_out,
):
    """List the manifolds that are solved, and the motions that each joins: edges_out (manifolds, 2) int32. Returns
    their number. O(manifolds).

    Sensors, pairs of which neither side can be pushed, and what lies under the feet of a character are left out.
    """
    found = 0
    for i in range(len(manifolds)):
        m = manifolds[i]
        row_a = motion_of[m.body_row_a]
        row_b = motion_of[m.body_row_b]
        a = motions[row_a]
        b = motions[row_b]
        if (
            m.sensor
            or a.inverse_mass + b.inverse_mass == 0.0
            or (a.walks and m.normal_y > abs(m.normal_x))
            or (b.walks and -m.normal_y > abs(m.normal_x))
        ):
            continue
        selected_out[found] = i
        edges_out[found, 0] = row_a
        edges_out[found, 1] = row_b
        found += 1
    return found


@subkernel
def color_manifolds(
    # read
    manifolds,
    motion_of,
    motions,
    pushable,
    # write
    plan_out,
):
    """List the manifolds that are solved, as edges, and colour these. Returns their number. See select_manifolds,
    color_edges. O(manifolds + motions)."""
    nodes = len(motions)
    count = select_manifolds(manifolds, motion_of, motions, plan_out.selected, plan_out.edges)
    taken = plan_out.taken[:nodes]
    degrees = plan_out.degrees[:nodes]
    color_edges(plan_out.edges, count, pushable, taken, degrees, plan_out.colors)
    return count


@subkernel
def class_for(choices, square, least):
    """Where among the choices, from the place `least` on, is the first whose square is at least that; or the last."""
    place = least
    while place < len(choices) - 1 and choices[place] * choices[place] < square:
        place += 1
    return place


@subkernel
def class_motions(motions, degrees, choices, by_load, classes_out):
    """Write where among the choices each motion's substeps stand; what nothing touches takes the fewest, who is not
    known yet as many as a load may ask for. Returns whether there are such. O(motions)."""
    unknown = False
    for i in range(len(classes_out)):
        classes_out[i] = 0
        m = motions[i]
        if degrees[i] > 0 and m.pushed:
            if m.substeps == 0:
                unknown = True
                classes_out[i] = by_load
            else:
                classes_out[i] = class_for(choices, float(m.substeps * m.substeps), 0)
    return unknown


@subkernel
def expect_impacts(
    # read
    manifolds,
    selected,
    edges,
    count,
    motions,
    dt,
    rate,
    choices,
    # write
    classes_inout,
):
    """Raise the class of what meets within dt [s] to that which the loads of the impact will ask for: what is light
    bears the momentum of what is heavy. rate: see demand_rate. O(count)."""
    for i in range(count):
        m = manifolds[selected[i]]
        speed = m.speed_1 if m.speed_1 * dt > m.separation_1 else 0.0
        if m.count == 2 and m.speed_2 * dt > m.separation_2:
            speed = max(speed, m.speed_2)
        if speed <= 0.0:
            continue
        demand = speed * rate
        a = motions[edges[i, 0]].inverse_mass
        b = motions[edges[i, 1]].inverse_mass
        if a > 0.0 and b > 0.0:
            demand *= max(a, b) / min(a, b)
        for side in range(2):
            node = edges[i, side]
            if motions[node].pushed:
                classes_inout[node] = class_for(choices, demand, int(classes_inout[node]))


@subkernel
def expect_columns(manifolds, selected, edges, count, motions, degrees, limits, most, classes_inout):
    """Raise what newly lies on one thing, and bears no more than another, to the class `most`: how a column leans is
    not known before its load has come down it, contact by contact, and what began to lean goes on. O(count)."""
    for i in range(count):
        row_a = edges[i, 0]
        row_b = edges[i, 1]
        a = motions[row_a]
        b = motions[row_b]
        m = manifolds[selected[i]]
        if (
            (a.substeps == 0 or b.substeps == 0)
            and a.pushed
            and b.pushed
            and degrees[row_a] <= 2
            and degrees[row_b] <= 2
            and touches_slowly(m.separation_1, m.speed_1, limits)
        ):
            classes_inout[row_a] = most


@subkernel
def are_mixed(joins, degrees, classes):
    """Whether what touches something is not all of one class. O(motions)."""
    first = -1
    for i in range(len(classes)):
        if joins[i] and degrees[i] > 0:
            if first < 0:
                first = classes[i]
            elif classes[i] != first:
                return True
    return False


@kernel
def order_contacts(
    # read
    manifolds,
    motion_of,
    motions,
    pushable,
    # write
    plan_out,
):
    """List the manifolds that are solved, in one group, by colour. Returns their number, and how many have no colour.
    O(manifolds + motions)."""
    count = color_manifolds(manifolds, motion_of, motions, pushable, plan_out)
    starts = plan_out.starts[: COLORS + 2]
    order_edges(plan_out.edges, count, plan_out.colors, plan_out.classes[:0], starts, plan_out.cursors, plan_out.places)
    return count, starts[1] - starts[0]


@kernel
def order_by_load(
    # read
    manifolds,
    motion_of,
    motions,
    pushable,
    joins,
    movers,
    dt,
    rate,
    choices,
    by_load,
    limits,
    # write
    plan_out,
):
    """List the manifolds that are solved by how many of the choices of substeps their islands ask for, and by colour.
    Returns their number. dt [s], rate: see expect_impacts; by_load: the last of the choices that a load alone may ask
    for; limits: see settings.Limits. O(manifolds + motions)."""
    plan = plan_out
    nodes = len(motions)
    classes = plan.classes[:nodes]
    count = color_manifolds(manifolds, motion_of, motions, pushable, plan)
    unknown = class_motions(motions, plan.degrees, choices, by_load, classes)
    expect_impacts(manifolds, plan.selected, plan.edges, count, motions, dt, rate, choices[: by_load + 1], classes)
    if unknown:
        most = len(choices) - 1
        expect_columns(manifolds, plan.selected, plan.edges, count, motions, plan.degrees, limits, most, classes)
    plan.joined[0] = are_mixed(joins, plan.degrees, classes)
    if plan.joined[0]:
        parents = plan.parents[:nodes]
        find_roots(plan.edges, count, joins, parents)
        share_classes(parents, classes)
    order_edges(plan.edges, count, plan.colors, classes, plan.starts, plan.cursors, plan.places)
    order_nodes(movers, classes, plan.firsts, plan.cursors, plan.members)
    return count


class Selection:
    """The order of one world's contacts; arrays are grown and used again."""

    def __init__(self) -> None:
        self.count = 0
        self.plan = new_plan(16, 16)

    def choose(self, state: StepState, motions: Motions, substeps: int) -> list[Group]:
        """Select, colour and order the contacts; substeps 0: as many as each island asks for."""
        rows, manifolds = motions.used, state.manifolds
        if len(self.plan.selected) < len(manifolds) or len(self.plan.taken) < len(rows):
            self.plan = new_plan(2 * len(manifolds), 2 * len(rows))
        plan = self.plan
        if substeps:
            self.count, loose = order_contacts(manifolds, motions.motion_of, rows, motions.pushable, plan)
            return [Group(substeps, 0, self.count, loose, motions.movers, plan.starts[: COLORS + 2])]
        self.count = order_by_load(
            manifolds,
            motions.motion_of,
            rows,
            motions.pushable,
            motions.joins,
            motions.movers,
            state.dt,
            demand_rate(state),
            CHOICES,
            BY_LOAD,
            state.tolerances.limits,
            plan,
        )
        colors, firsts, starts = COLORS + 1, plan.firsts.tolist(), plan.starts
        groups = [
            Group(
                substeps=number,
                start=starts.item(k * colors),
                stop=starts.item((k + 1) * colors),
                loose=starts.item(k * colors + 1) - starts.item(k * colors),
                members=plan.members[firsts[k] : firsts[k + 1]],
                starts=starts[k * colors : (k + 1) * colors + 1],
            )
            for k, number in enumerate(AUTO_SUBSTEPS)
            if firsts[k] < firsts[k + 1]
        ]
        # What moves by hand is moved though nobody is pushed.
        return groups or [Group(AUTO_SUBSTEPS[0], 0, 0, 0, motions.movers, plan.starts[: colors + 1])]
