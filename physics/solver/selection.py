"""Which contacts are solved, in which order: island by island of as many substeps, and in each colour by colour.

Islands of the same number of substeps make a group, which is advanced by the whole step before the next begins. Nothing
passes from one island to another: the motions of what stands between them and is not pushed are functions of time.
"""

import math
from typing import NamedTuple

import numpy as np

from physics.dynamics.graph import NO_CLASSES, color_edges, join_classes, order_edges, order_nodes
from physics.jit import kernel, subkernel
from physics.settings import AUTO_SUBSTEPS, COLORS, HERTZ_SHARE
from physics.solver.motions import Motions
from physics.tables.step_state import StepState


class Plan(NamedTuple):
    """Which manifolds are solved, and in which order."""

    count: int  # edges in use
    selected: np.ndarray  # (edges) manifold of each edge
    edges: np.ndarray  # (edges, 2) int32 rows of MOTION
    colors: np.ndarray  # (edges) int32 of each edge
    degrees: np.ndarray  # (motions) edges of each
    places: np.ndarray  # (edges) int32 row of each among the constraints, by group and colour


class Group(NamedTuple):
    """The islands that take as many substeps each."""

    substeps: int
    start: int  # rows of the constraints, from …
    stop: int  # … to
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


@kernel
def color_manifolds(
    # read
    manifolds,
    motion_of,
    motions,
    pushable,
    # write
    selected_out,
    edges_out,
    taken_out,
    degrees_out,
    colors_out,
):
    """List the manifolds that are solved, as edges, and colour these. Returns their number. See select_manifolds,
    color_edges. O(manifolds + motions)."""
    count = select_manifolds(manifolds, motion_of, motions, selected_out, edges_out)
    color_edges(edges_out, count, pushable, taken_out, degrees_out, colors_out)
    return count


@subkernel
def class_for(choices, square, least):
    """Where among the choices, from the place `least` on, is the first whose square is at least that; or the last."""
    place = least
    while place < len(choices) - 1 and choices[place] * choices[place] < square:
        place += 1
    return place


@kernel
def class_motions(motions, degrees, choices, classes_out):
    """Write where among the choices each motion's substeps stand; what nothing touches takes the fewest. O(motions)."""
    for i in range(len(classes_out)):
        classes_out[i] = 0
        m = motions[i]
        if degrees[i] > 0 and m.pushed:
            classes_out[i] = class_for(choices, float(m.substeps * m.substeps), 0)


@kernel
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


class Selection:
    """The order of one world's contacts; arrays are grown and used again."""

    def __init__(self) -> None:
        self.count = 0
        self.selected, self.places, self.colors = (np.zeros(16, np.int32) for _ in range(3))
        self.edges = np.zeros((16, 2), np.int32)
        self.taken, self.degrees = np.zeros(16, np.int64), np.zeros(16, np.int64)
        self.parents, self.classes, self.members = (np.zeros(16, np.int32) for _ in range(3))
        slots = len(AUTO_SUBSTEPS) * (COLORS + 1) + 1
        self.starts, self.cursors = np.zeros(slots, np.int64), np.zeros(slots, np.int64)
        self.firsts, self.next = np.zeros(len(AUTO_SUBSTEPS) + 1, np.int64), np.zeros(len(AUTO_SUBSTEPS) + 1, np.int64)
        self.choices = np.array(AUTO_SUBSTEPS, np.int64)

    def _grow(self, motions: int, manifolds: int):
        if len(self.taken) < motions:
            self.taken, self.degrees = np.zeros(2 * motions, np.int64), np.zeros(2 * motions, np.int64)
            self.parents, self.classes, self.members = (np.zeros(2 * motions, np.int32) for _ in range(3))
        if len(self.selected) < manifolds:
            self.edges = np.zeros((2 * manifolds, 2), np.int32)
            self.selected, self.places, self.colors = (np.zeros(2 * manifolds, np.int32) for _ in range(3))

    def choose(self, state: StepState, motions: Motions, substeps: int) -> list[Group]:
        """Select, colour and order the contacts; substeps 0: as many as each island asks for."""
        rows, manifolds = motions.used, state.manifolds
        self._grow(len(rows), len(manifolds))
        taken, degrees = self.taken[: len(rows)], self.degrees[: len(rows)]
        self.count = color_manifolds(
            manifolds, motions.motion_of, rows, motions.pushable, self.selected, self.edges, taken, degrees, self.colors
        )
        if substeps:
            starts = self.starts[: COLORS + 2]
            order_edges(self.edges, self.count, self.colors, NO_CLASSES, starts, self.cursors, self.places)
            return [Group(substeps, 0, self.count, motions.movers, starts)]
        classes, parents = self.classes[: len(rows)], self.parents[: len(rows)]
        class_motions(rows, degrees, self.choices, classes)
        rate = demand_rate(state)
        expect_impacts(manifolds, self.selected, self.edges, self.count, rows, state.dt, rate, self.choices, classes)
        join_classes(self.edges, self.count, motions.joins, classes, parents)
        order_edges(self.edges, self.count, self.colors, classes, self.starts, self.cursors, self.places)
        order_nodes(motions.movers, classes, self.firsts, self.next, self.members)
        colors, firsts = COLORS + 1, self.firsts.tolist()
        ends = self.starts[::colors].tolist()
        groups = [
            Group(
                substeps=number,
                start=ends[k],
                stop=ends[k + 1],
                members=self.members[firsts[k] : firsts[k + 1]],
                starts=self.starts[k * colors : (k + 1) * colors + 1],
            )
            for k, number in enumerate(AUTO_SUBSTEPS)
            if firsts[k] < firsts[k + 1]
        ]
        # What moves by hand is moved though nobody is pushed.
        return groups or [Group(AUTO_SUBSTEPS[0], 0, 0, motions.movers, self.starts[: colors + 1])]

    @property
    def plan(self) -> Plan:
        """What was chosen, for the kernels."""
        return Plan(self.count, self.selected, self.edges, self.colors, self.degrees, self.places)
