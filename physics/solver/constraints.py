"""Contacts as constraint rows: selection, order, preparation, and the impulses that are stored."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from physics.islands.graph import color_edges, find_roots, order_edges, order_nodes, share_classes
from physics.jit import inlined, kernel, subkernel
from physics.settings import AUTO_SUBSTEPS, COLORS, CROWD, HERTZ_SHARE, LOAD_SUBSTEPS, STICKING_TURN
from physics.solver.lanes import Blocks, blocks_needed, make_blocks
from physics.solver.motions import Motions
from physics.solver.restitution import restore_bounces, split_of
from physics.tables.contact import CONSTRAINT
from physics.tables.step_state import SOLVER_ROWS, TANGENT_ROWS, StepState

# ---- rows ------------------------------------------------------------------------------------------------------------
# CONSTRAINT rows: contacts as the solvers read them.
#
# Source of the arms and effective masses: Catto, Box2D v3, contact_solver.c. A row holds arms from the centres of mass
# at the start of the step, and a separation that follows from the motion of both sides since. Where two faces stick,
# the arms stay as they were at detection: arms that rotate with a leaning column give its load a torque, and the column
# buckles (Catto, Box2D v3: contact recycling).

BOTH = (False, True)


@subkernel
def effective_mass(a, b, ax, ay, bx, by, x, y):
    """Return the effective mass along a unit direction (x, y) at these arms; 0 if neither side has a finite mass."""
    a_arm = ax * y - ay * x
    b_arm = bx * y - by * x
    k = a.inverse_mass + b.inverse_mass + a.inverse_inertia * a_arm * a_arm + b.inverse_inertia * b_arm * b_arm
    return 1.0 / k if k > 0.0 else 0.0


@subkernel
def couple(a, b, row_out):
    """Write the off-diagonal terms of the block solver: how the two points of a CONSTRAINT row affect each other. a, b:
    its MOTION rows.
    """
    r = row_out
    r.couple_1 = 0.0
    r.couple_2 = 0.0
    r.split = 0.0
    if r.count == 2:
        a_1 = r.ax_1 * r.normal_y - r.ay_1 * r.normal_x
        b_1 = r.bx_1 * r.normal_y - r.by_1 * r.normal_x
        a_2 = r.ax_2 * r.normal_y - r.ay_2 * r.normal_x
        b_2 = r.bx_2 * r.normal_y - r.by_2 * r.normal_x
        k_12 = a.inverse_mass + b.inverse_mass + a.inverse_inertia * a_1 * a_2 + b.inverse_inertia * b_1 * b_2
        r.couple_1 = r.normal_mass_1 * k_12
        r.couple_2 = r.normal_mass_2 * k_12
        r.split = split_of(r.couple_1, r.couple_2)


@subkernel
def sticks(a, b, anchor, distance):
    """Return whether two faces stick: normal and moment arms may stay as they were when the contact was found.

    They stick if they carry a load, neither shape is round, neither body (BODY rows) rotated by more than
    STICKING_TURN, and their centres moved relative to each other by no more than distance [px]. An unloaded contact
    never sticks, because it has to leave its overlap.
    """
    x = b.center_x - a.center_x - anchor.apart_x
    y = b.center_y - a.center_y - anchor.apart_y
    return (
        (anchor.normal_force_1 > 0.0 or anchor.normal_force_2 > 0.0)
        and anchor.radius_a == 0.0
        and anchor.radius_b == 0.0
        and abs(a.angle - anchor.angle_a) <= STICKING_TURN
        and abs(b.angle - anchor.angle_b) <= STICKING_TURN
        and x * x + y * y <= distance * distance
    )


@subkernel
def touches_slowly(separation, speed, limits):
    """Return whether a point touches, and approaches too slowly to bounce."""
    return separation <= limits.slop and abs(speed) <= limits.bounce_speed


@inlined
def judge_row(m, c, held, a, b, degree_a, degree_b, limits, row_out):
    """Write the flags of a CONSTRAINT row (sole support, approaching, resting).

    They follow from its manifold, the cached contact, whether its faces stick, the MOTION rows of its sides, and their
    numbers of contacts.
    """
    r = row_out
    # One contact below and one above.
    r.alone = held and (a.inverse_mass == 0.0 or degree_a <= 2) and (b.inverse_mass == 0.0 or degree_b <= 2)
    crowd = max(degree_a if a.inverse_mass > 0.0 else 0, degree_b if b.inverse_mass > 0.0 else 0)
    r.push_share = CROWD / crowd if crowd > CROWD else 1.0
    r.calm = m.speed_1 <= limits.calm_speed and (m.count == 1 or m.speed_2 <= limits.calm_speed)
    r.loaded = c.normal_force_1 > 0.0 or (m.count == 2 and c.normal_force_2 > 0.0)
    r.meets = m.speed_1 > limits.bounce_speed or (m.count == 2 and m.speed_2 > limits.bounce_speed)
    r.rests = touches_slowly(m.separation_1, m.speed_1, limits) or (
        m.count == 2 and touches_slowly(m.separation_2, m.speed_2, limits)
    )
    r.still = a.inverse_mass == 0.0 or b.inverse_mass == 0.0


def make_prepare_row(friction: bool, conveyor: bool) -> Callable:
    """Return the function that makes a constraint of a contact in a world with these effects."""

    @inlined
    def prepare_row(
        # read
        bodies,
        motions,
        manifolds,
        plan,
        edge,
        h,
        limits,
        # write
        anchors_inout,
        row_out,
        work_inout,
    ):
        """Fill a CONSTRAINT row for an edge of the plan, with the cached impulses for a substep of h [s].

        plan: see Plan. limits: see settings.Limits. Arms go from the centres of mass to the contact point.
        """
        first = plan.selected[edge]
        m = manifolds[first]
        c = anchors_inout[first]
        r = row_out
        c.color = plan.colors[edge]
        r.motion_a = plan.edges[edge, 0]
        r.motion_b = plan.edges[edge, 1]
        a = motions[r.motion_a]
        b = motions[r.motion_b]
        p = bodies[m.body_row_a]
        q = bodies[m.body_row_b]
        r.manifold = first
        r.count = m.count
        held = m.count == 2 and m.lead == 0.0 and sticks(p, q, c, limits.sticking)
        nx = c.held_nx if held else m.normal_x
        ny = c.held_ny if held else m.normal_y
        r.normal_x = nx
        r.normal_y = ny
        r.friction = c.friction if friction else 0.0
        r.surface_speed = c.surface_speed if conveyor else 0.0
        judge_row(m, c, held, a, b, plan.degrees[r.motion_a], plan.degrees[r.motion_b], limits, r)
        r.rolling_limit = c.rolling_resistance if friction else 0.0
        turning = a.inverse_inertia + b.inverse_inertia
        r.rolling_mass = 1.0 / turning if turning > 0.0 else 0.0
        r.rolling_impulse = h * c.rolling_force
        r.push_impulse_1, r.push_impulse_2 = 0.0, 0.0
        # Rows are reused: a manifold of one point has no second.
        r.ax_2, r.ay_2, r.bx_2, r.by_2 = 0.0, 0.0, 0.0, 0.0
        r.normal_impulse_2, r.tangent_impulse_2 = 0.0, 0.0
        r.normal_total_2, r.tangent_total_2 = 0.0, 0.0
        r.radius_a, r.radius_b = c.radius_a, c.radius_b
        core = c.radius_a + c.radius_b
        for k in range(m.count):
            work_inout[SOLVER_ROWS] += 1
            if r.friction > 0.0:
                work_inout[TANGENT_ROWS] += 1
            x = m.x_1 if k == 0 else m.x_2
            y = m.y_1 if k == 0 else m.y_2
            ax = x - p.center_x
            ay = y - p.center_y
            bx = x - q.center_x + m.lead * ny  # the present position of B's point
            by = y - q.center_y - m.lead * nx
            if held:
                ax = c.held_ax_1 if k == 0 else c.held_ax_2
                ay = c.held_ay_1 if k == 0 else c.held_ay_2
                bx = ax - c.apart_x
                by = ay - c.apart_y
            base = (m.separation_1 if k == 0 else m.separation_2) - ((bx - ax) * nx + (by - ay) * ny) - core
            normal_mass = effective_mass(a, b, ax, ay, bx, by, nx, ny)
            tangent_mass = effective_mass(a, b, ax, ay, bx, by, -ny, nx)
            if k == 0:
                r.ax_1, r.ay_1, r.bx_1, r.by_1, r.base_1 = ax, ay, bx, by, base
                r.normal_mass_1, r.tangent_mass_1 = normal_mass, tangent_mass
                r.normal_impulse_1, r.tangent_impulse_1 = h * c.normal_force_1, h * c.tangent_force_1
                r.normal_total_1, r.tangent_total_1 = 0.0, 0.0
            else:
                r.ax_2, r.ay_2, r.bx_2, r.by_2, r.base_2 = ax, ay, bx, by, base
                r.normal_mass_2, r.tangent_mass_2 = normal_mass, tangent_mass
                r.normal_impulse_2, r.tangent_impulse_2 = h * c.normal_force_2, h * c.tangent_force_2
        couple(a, b, r)

    return prepare_row


PREPARE_ROW = {(f, c): make_prepare_row(friction=f, conveyor=c) for f in BOTH for c in BOTH}


# ---- selection -------------------------------------------------------------------------------------------------------
# Selection of the contacts to solve, and their order: by the substeps of their islands, then by colour.
#
# Islands with the same number of substeps form a group, which advances by the whole step before the next group begins.
# Islands do not affect each other: the motion of kinematic bodies between them is a function of time.


class Plan(NamedTuple):
    """The manifolds to solve and their order; each array has room for all manifolds."""

    selected: np.ndarray  # (edges) int32 manifold of each edge
    edges: np.ndarray  # (edges, 2) int32 rows of MOTION
    colors: np.ndarray  # (edges) int32 of each edge
    places: np.ndarray  # (edges) int32 row of each among the constraints, by group and colour
    taken: np.ndarray  # (motions) int64 bits of the colours that each has
    degrees: np.ndarray  # (motions) int64 edges of each
    classes: np.ndarray  # (motions) int32 index of the substeps of each among the choices
    parents: np.ndarray  # (motions) int32 root of the island of each, if …
    joined: np.ndarray  # (1) bool … it was computed
    members: np.ndarray  # (motions) int32 moving bodies, by group
    starts: np.ndarray  # int64 first row of each colour of each group, rows without a colour first
    firsts: np.ndarray  # int64 first body of each group
    cursors: np.ndarray  # scratch, as long as starts


CHOICES = np.array(AUTO_SUBSTEPS, np.int64)
BY_LOAD = AUTO_SUBSTEPS.index(LOAD_SUBSTEPS)  # index of the greatest that a load alone may take


def new_plan(edges: int, motions: int) -> Plan:
    """Return room for so many edges between so many motions."""
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
    """The islands that take the same number of substeps."""

    substeps: int
    start: int  # rows of the constraints, from …
    stop: int  # … to
    loose: int  # number of rows without a colour
    members: np.ndarray  # int32 rows of MOTION
    starts: np.ndarray  # int64 first row of each colour, rows without a colour first, and the end of the last


def demand_rate(state: StepState) -> float:
    """Return the square of the substeps that keep the sag of a contact within the accuracy, per speed [s/px].

    The speed is that which the impulses of a step give the effective mass. A contact sags by F / (m ω²), with ω by
    HERTZ_SHARE.
    """
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
    """List the manifolds to solve and the motions of both sides: edges_out (manifolds, 2) int32. Return their number.

    Sensors, pairs without a dynamic body, and contacts under a character's feet are left out. O(manifolds).
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
    """List the manifolds to solve as edges, and colour these. Return their number. See select_manifolds, color_edges.
    O(manifolds + motions).
    """
    nodes = len(motions)
    count = select_manifolds(manifolds, motion_of, motions, plan_out.selected, plan_out.edges)
    taken = plan_out.taken[:nodes]
    degrees = plan_out.degrees[:nodes]
    color_edges(plan_out.edges, count, pushable, taken, degrees, plan_out.colors)
    return count


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

    A body without contacts takes the fewest, a new one as many as a load may need. O(motions).
    """
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
    """Raise the class of bodies that meet within dt [s] to the substeps that the impact will need.

    A light body carries the momentum of a heavy one. rate: see demand_rate. O(count).
    """
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
    """Give new two-contact stacks the most substeps: the class `most`.

    How a column leans is unknown until the load has reached its foot, and a lean does not stop by itself. O(count).
    """
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
    """Return whether the bodies with contacts are of more than one class. O(motions)."""
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
    """List the manifolds to solve in one group, by colour. Return their number, and the number without a colour.
    O(manifolds + motions).
    """
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
    """List the manifolds to solve by the number of substeps of their islands, and by colour. Return their number.

    dt [s], rate: see expect_impacts. by_load: index of the greatest choice that a load alone may need. limits: see
    settings.Limits. O(manifolds + motions).
    """
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
    """The order of the contacts of one world; its arrays grow and are reused."""

    def __init__(self) -> None:
        self.count = 0
        self.plan = new_plan(16, 16)

    def choose(self, state: StepState, motions: Motions, substeps: int) -> list[Group]:
        """Select, colour and order the contacts. substeps: their number, 0 for as many as each island needs."""
        rows, manifolds = motions.used, state.contact_rows
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
        # Kinematic bodies move even if no dynamic body does.
        return groups or [Group(AUTO_SUBSTEPS[0], 0, 0, 0, motions.movers, plan.starts[: colors + 1])]


# ---- contacts --------------------------------------------------------------------------------------------------------
# The contacts of a world as constraints. A solver prepares the rows, runs its passes over them in one kernel, and
# stores the impulses.


def make_prepare(friction: bool, conveyor: bool) -> Callable:
    """Return the pass from contacts to constraint rows for a world with these effects."""
    prepare_row = PREPARE_ROW[friction, conveyor]

    @kernel
    def prepare_constraints(
        # read
        bodies,
        motions,
        manifolds,
        plan,
        count,
        start,
        h,
        limits,
        # write
        anchors_inout,
        constraints_out,
        work_inout,
    ):
        """Fill the constraint rows of the plan's edges, from row `start` on, with the cached impulses for a substep of
        h [s].

        See prepare_row. Contacts are read in memory order, for the prefetcher of the processor; the writes are
        scattered. O(edges).
        """
        for edge in range(count):
            place = plan.places[edge] - start
            if 0 <= place < len(constraints_out):  # otherwise it belongs to another group
                row = constraints_out[place]
                prepare_row(bodies, motions, manifolds, plan, edge, h, limits, anchors_inout, row, work_inout)

    return prepare_constraints


def make_warm_start(rotation: bool) -> Callable:
    """Return the pass that applies the impulses with which a substep starts."""

    @subkernel
    def warm_start(
        # read
        constraints,
        # write
        motions_inout,
    ):
        """Apply the cached impulses of the rows. O(constraints)."""
        for i in range(len(constraints)):
            r = constraints[i]
            a = motions_inout[r.motion_a]
            b = motions_inout[r.motion_b]
            nx = r.normal_x
            ny = r.normal_y
            x = r.normal_impulse_1 * nx - r.tangent_impulse_1 * ny
            y = r.normal_impulse_1 * ny + r.tangent_impulse_1 * nx
            a_turn = 0.0
            b_turn = 0.0
            if rotation:
                a_turn = r.ax_1 * y - r.ay_1 * x + r.rolling_impulse
                b_turn = r.bx_1 * y - r.by_1 * x + r.rolling_impulse
            if r.count == 2:
                u = r.normal_impulse_2 * nx - r.tangent_impulse_2 * ny
                v = r.normal_impulse_2 * ny + r.tangent_impulse_2 * nx
                if rotation:
                    a_turn += r.ax_2 * v - r.ay_2 * u
                    b_turn += r.bx_2 * v - r.by_2 * u
                x += u
                y += v
            a.vx -= a.inverse_mass * x
            a.vy -= a.inverse_mass * y
            b.vx += b.inverse_mass * x
            b.vy += b.inverse_mass * y
            if rotation:
                a.angular_velocity -= a.inverse_inertia * a_turn
                b.angular_velocity += b.inverse_inertia * b_turn

    return warm_start


@subkernel
def store_impulses(
    # read
    constraints,
    inverse_h,
    share,
    # write
    manifolds_inout,
    anchors_inout,
):
    """Write the impulses of the step, and the cached forces for the next one, back to the manifolds. O(constraints).

    share: weight of this step in the cached forces. A step of a thousandth of the last one's length says little about
    forces: an impulse that stops a small motion in it would count as a thousand times the force in a step of usual
    length.
    """
    rest = 1.0 - share
    for i in range(len(constraints)):
        r = constraints[i]
        m = manifolds_inout[r.manifold]
        c = anchors_inout[r.manifold]
        m.normal_impulse_1 = r.normal_total_1
        m.tangent_impulse_1 = r.tangent_total_1
        c.normal_force_1 = share * (inverse_h * r.normal_impulse_1) + rest * c.normal_force_1
        c.tangent_force_1 = share * (inverse_h * r.tangent_impulse_1) + rest * c.tangent_force_1
        c.rolling_force = share * (inverse_h * r.rolling_impulse) + rest * c.rolling_force
        if r.count == 2:
            m.normal_impulse_2 = r.normal_total_2
            m.tangent_impulse_2 = r.tangent_total_2
            c.normal_force_2 = share * (inverse_h * r.normal_impulse_2) + rest * c.normal_force_2
            c.tangent_force_2 = share * (inverse_h * r.tangent_impulse_2) + rest * c.tangent_force_2


def make_friction_limit(rotation: bool) -> Callable:
    """Return the pass that limits friction to its final normal impulse."""

    @subkernel
    def limit_friction(count, motions_inout, constraints_inout):
        """Remove friction beyond its share of the final normal impulse, over the step, of so many rows. O(count)."""
        for i in range(count):
            r = constraints_inout[i]
            for k in range(r.count):
                total = r.tangent_total_1 if k == 0 else r.tangent_total_2
                limit = r.friction * (r.normal_total_1 if k == 0 else r.normal_total_2)
                if abs(total) <= limit:
                    continue
                change = max(-limit, min(limit, total)) - total
                a = motions_inout[r.motion_a]
                b = motions_inout[r.motion_b]
                x = -change * r.normal_y
                y = change * r.normal_x
                a.vx -= a.inverse_mass * x
                a.vy -= a.inverse_mass * y
                b.vx += b.inverse_mass * x
                b.vy += b.inverse_mass * y
                if k == 0:
                    r.tangent_total_1 = total + change
                    r.tangent_impulse_1 += change
                else:
                    r.tangent_total_2 = total + change
                    r.tangent_impulse_2 += change
                if rotation:
                    ax = r.ax_1 if k == 0 else r.ax_2
                    ay = r.ay_1 if k == 0 else r.ay_2
                    bx = r.bx_1 if k == 0 else r.bx_2
                    by = r.by_1 if k == 0 else r.by_2
                    a.angular_velocity -= a.inverse_inertia * (ax * y - ay * x)
                    b.angular_velocity += b.inverse_inertia * (bx * y - by * x)

    return limit_friction


def make_finish(restitution: bool, friction: bool, rotation: bool) -> Callable:
    """Return the last pass of every stacking solver in a world with these effects."""
    limit_friction = make_friction_limit(rotation)

    @kernel
    def finish_constraints(
        # read
        threshold,
        dt,
        inverse_h,
        share,
        # write
        motions_inout,
        constraints_inout,
        manifolds_inout,
        anchors_inout,
        work_inout,
    ):
        """Apply restitution, limit friction, and write the impulses back. O(constraints).

        threshold [px/s], dt [s]: see restore_bounces. inverse_h [1/s], share: see store_impulses.
        """
        count = len(constraints_inout)
        if restitution:
            restore_bounces(
                manifolds_inout, anchors_inout, threshold, dt, count, motions_inout, constraints_inout, work_inout
            )
        if friction:
            limit_friction(count, motions_inout, constraints_inout)
        store_impulses(constraints_inout, inverse_h, share, manifolds_inout, anchors_inout)

    return finish_constraints


FINISH = {(e, f, r): make_finish(restitution=e, friction=f, rotation=r) for e in BOTH for f in BOTH for r in BOTH}
PREPARE = {(f, c): make_prepare(friction=f, conveyor=c) for f in BOTH for c in BOTH}
WARM_START = {r: make_warm_start(rotation=r) for r in BOTH}


class ContactSet:
    """The contacts of one world as constraints; its arrays grow and are reused."""

    def __init__(self) -> None:
        self.selection = Selection()
        self.constraints = np.zeros(16, CONSTRAINT)
        self.lanes = make_blocks(0)

    def choose(self, state: StepState, motions: Motions, substeps: int) -> list[Group]:
        """Group the islands by substeps; 0: as many as each needs."""
        groups = self.selection.choose(state, motions, substeps)
        if len(self.constraints) < self.selection.count:
            self.constraints = np.zeros(2 * self.selection.count, CONSTRAINT)
        return groups

    def prepare(self, state: StepState, motions: Motions, group: Group, h: float) -> np.ndarray:
        """Fill the rows of a group, for substeps of h [s], and return them."""
        rows = self.constraints[group.start : group.stop]
        PREPARE[state.effects.friction, state.effects.conveyor](
            state.bodies,
            motions.used,
            state.contact_rows,
            self.selection.plan,
            self.selection.count,
            group.start,
            h,
            state.tolerances.limits,
            state.contact_rows,
            rows,
            state.work,
        )
        return rows

    def blocks(self, group: Group) -> Blocks:
        """Return arrays for the rows of a group in lanes."""
        needed = blocks_needed(group.stop - group.start, group.loose)
        if len(self.lanes.manifold) < needed:
            self.lanes = make_blocks(2 * needed)
        return self.lanes

    def store(self, state: StepState, motions: Motions, rows: np.ndarray, h: float) -> None:
        """Apply restitution, limit friction, and write the impulses of a group's rows back."""
        effects, threshold = state.effects, state.tolerances.restitution_speed
        FINISH[effects.restitution, effects.friction, effects.rotation](
            threshold, state.dt, 1.0 / h, state.dt / state.span, motions.used, rows, state.contact_rows, state.contact_rows, state.work
        )
