"""Contacts as a constraint set: which manifolds are solved, in which order, as which rows, and what is stored of them.

A solver prepares the rows, runs its passes over them in one kernel, and stores what came of it. Source of the arms and
effective masses: Catto, Box2D v3, contact_solver.c; the row holds arms from the centres of mass at the beginning of the
step, and a separation that follows from how far both sides have moved since. Where two faces stick, the arms stay as
they were when they were found: arms that turn with a column that leans give its load a torque, and it buckles (Catto,
Box2D v3: contact recycling).
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from physics.jit import kernel, subkernel
from physics.math2d import length_of
from physics.settings import CALM_SHARE, CROWD, STICKING_SHARE, STICKING_TURN
from physics.solver.bounce import restore_bounces
from physics.solver.lanes import Blocks, blocks_needed, make_blocks
from physics.solver.motions import Motions
from physics.solver.selection import Group, Selection
from physics.solver.two_points import split_of
from physics.tables.constraint import CONSTRAINT
from physics.tables.counters import SOLVER_ROWS, TANGENT_ROWS
from physics.tables.step_state import StepState

BOTH = (False, True)


@subkernel
def effective_mass(a, b, ax, ay, bx, by, x, y):
    """Mass that an impulse along a unit direction (x, y) at these arms feels; 0 where nothing can be pushed."""
    a_arm = ax * y - ay * x
    b_arm = bx * y - by * x
    k = a.inverse_mass + b.inverse_mass + a.inverse_inertia * a_arm * a_arm + b.inverse_inertia * b_arm * b_arm
    return 1.0 / k if k > 0.0 else 0.0


@subkernel
def couple(a, b, row_out):
    """Write how the two points of a CONSTRAINT row feel each other; a, b: its MOTION rows."""
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
    """Whether two faces lie on each other nearly as when they were found: normal and arms may stay as they were then.

    They bear a load, neither is round, neither body (BODY rows) turned by more than STICKING_TURN, their centres moved
    against each other by no more than distance [px]. What bears nothing has to find its own way out of an overlap.
    """
    return (
        (anchor.normal_force_1 > 0.0 or anchor.normal_force_2 > 0.0)
        and anchor.radius_a == 0.0
        and anchor.radius_b == 0.0
        and abs(a.angle - anchor.angle_a) <= STICKING_TURN
        and abs(b.angle - anchor.angle_b) <= STICKING_TURN
        and length_of(b.center_x - a.center_x - anchor.apart_x, b.center_y - a.center_y - anchor.apart_y) <= distance
    )


class Limits(NamedTuple):
    """By what a row is told to be still, to stick or to rest."""

    calm_speed: float  # [px/s] what approaches no faster is still
    sticking: float  # [px] see sticks
    slop: float  # [px] see touches_slowly
    bounce_speed: float  # [px/s] slower impacts do not bounce


@subkernel
def touches_slowly(separation, speed, limits):
    """Whether a point lies on the other side, or as good as that, too slow to bounce."""
    return separation <= limits.slop and abs(speed) <= limits.bounce_speed


def make_prepare(friction: bool, conveyor: bool) -> Callable:
    """The pass from contacts to constraint rows for a world with these effects."""

    @kernel
    def prepare_constraints(
        # read
        bodies,
        motions,
        manifolds,
        plan,
        start,
        h,
        limits,
        # write
        anchors_inout,
        constraints_out,
        work_inout,
    ):
        """Fill the constraint rows, from row `start` of the plan on, with the impulses that the last step found for a
        substep of h [s].

        plan: see Plan, limits: see Limits. Arms go from the centres of mass to the contact point. Contacts are read in
        the order in which they stand, for a processor that reads ahead: what is far apart is written. O(edges).
        """
        for edge in range(plan.count):
            place = plan.places[edge] - start
            if place < 0 or place >= len(constraints_out):
                continue  # of another group
            first = plan.selected[edge]
            m = manifolds[first]
            c = anchors_inout[first]
            c.color = plan.colors[edge]
            r = constraints_out[place]
            r.motion_a = plan.edges[edge, 0]
            r.motion_b = plan.edges[edge, 1]
            a = motions[r.motion_a]
            b = motions[r.motion_b]
            p = bodies[m.body_row_a]
            q = bodies[m.body_row_b]
            r.manifold = first
            r.count = m.count
            held = m.count == 2 and sticks(p, q, c, limits.sticking)
            nx = c.held_nx if held else m.normal_x
            ny = c.held_ny if held else m.normal_y
            r.normal_x = nx
            r.normal_y = ny
            r.friction = c.friction if friction else 0.0
            r.surface_speed = c.surface_speed if conveyor else 0.0
            # One contact below, and one above.
            r.alone = (
                held
                and (a.inverse_mass == 0.0 or plan.degrees[r.motion_a] <= 2)
                and (b.inverse_mass == 0.0 or plan.degrees[r.motion_b] <= 2)
            )
            crowd = max(
                plan.degrees[r.motion_a] if a.inverse_mass > 0.0 else 0,
                plan.degrees[r.motion_b] if b.inverse_mass > 0.0 else 0,
            )
            r.push_share = CROWD / crowd if crowd > CROWD else 1.0
            r.calm = m.speed_1 <= limits.calm_speed and (m.count == 1 or m.speed_2 <= limits.calm_speed)
            r.loaded = c.normal_force_1 > 0.0 or (m.count == 2 and c.normal_force_2 > 0.0)
            r.meets = m.speed_1 > limits.bounce_speed or (m.count == 2 and m.speed_2 > limits.bounce_speed)
            r.rests = touches_slowly(m.separation_1, m.speed_1, limits) or (
                m.count == 2 and touches_slowly(m.separation_2, m.speed_2, limits)
            )
            r.still = a.inverse_mass == 0.0 or b.inverse_mass == 0.0
            r.rolling_limit = c.rolling_resistance if friction else 0.0
            turning = a.inverse_inertia + b.inverse_inertia
            r.rolling_mass = 1.0 / turning if turning > 0.0 else 0.0
            r.rolling_impulse = h * c.rolling_force
            r.push_impulse_1 = 0.0
            r.push_impulse_2 = 0.0
            r.normal_impulse_2 = 0.0  # the rows are used again: a manifold of one point has no second
            r.ax_2, r.ay_2, r.bx_2, r.by_2 = 0.0, 0.0, 0.0, 0.0
            r.tangent_impulse_2 = 0.0
            r.normal_total_2 = 0.0
            r.tangent_total_2 = 0.0
            r.radius_a = c.radius_a
            r.radius_b = c.radius_b
            core = c.radius_a + c.radius_b
            for k in range(m.count):
                work_inout[SOLVER_ROWS] += 1
                if r.friction > 0.0:
                    work_inout[TANGENT_ROWS] += 1
                x = m.x_1 if k == 0 else m.x_2
                y = m.y_1 if k == 0 else m.y_2
                ax = x - p.center_x
                ay = y - p.center_y
                bx = x - q.center_x + m.lead * ny  # where B's point is now
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

    return prepare_constraints


def make_warm_start(rotation: bool) -> Callable:
    """The pass that applies the impulses a substep starts from."""

    @subkernel
    def warm_start(
        # read
        constraints,
        # write
        motions_inout,
    ):
        """Apply the impulses that the rows hold already. O(constraints)."""
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
    """Write the step's impulses, and the forces that the next step starts from, back to the manifolds: as far as they
    are of this step, the share, and of the ones before. O(constraints).

    A step of a thousandth of the last one's length says little of the forces: what stops a tremble in it is, by its
    length, a blow, and a step as long as before would give a thousand times as much of it.
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
    """The pass that ends with friction what other impulses have left."""

    @subkernel
    def limit_friction(motions_inout, constraints_inout):
        """Take back what friction is more than its share of the final normal impulse, over the step. O(constraints)."""
        for i in range(len(constraints_inout)):
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
    """What every solver that stacks ends with in a world with these effects."""
    limit_friction = make_friction_limit(rotation)

    @kernel
    def finish_constraints(
        # read
        threshold,
        inverse_h,
        share,
        # write
        motions_inout,
        constraints_inout,
        manifolds_inout,
        anchors_inout,
        work_inout,
    ):
        """Bounce what has met, end friction where less presses, and write the impulses back. O(constraints).

        threshold [px/s]: see restore_bounces; inverse_h [1/s], share: see store_impulses.
        """
        if restitution:
            restore_bounces(manifolds_inout, anchors_inout, threshold, motions_inout, constraints_inout, work_inout)
        if friction:
            limit_friction(motions_inout, constraints_inout)
        store_impulses(constraints_inout, inverse_h, share, manifolds_inout, anchors_inout)

    return finish_constraints


FINISH = {(e, f, r): make_finish(restitution=e, friction=f, rotation=r) for e in BOTH for f in BOTH for r in BOTH}
PREPARE = {(f, c): make_prepare(friction=f, conveyor=c) for f in BOTH for c in BOTH}
WARM_START = {r: make_warm_start(rotation=r) for r in BOTH}


class ContactSet:
    """The contacts of one world as constraints; arrays are grown and used again."""

    def __init__(self) -> None:
        self.selection = Selection()
        self.constraints = np.zeros(16, CONSTRAINT)
        self.lanes = make_blocks(0)

    def choose(self, state: StepState, motions: Motions, substeps: int) -> list[Group]:
        """Which islands take how many substeps; 0: as many as they ask for."""
        groups = self.selection.choose(state, motions, substeps)
        if len(self.constraints) < self.selection.count:
            self.constraints = np.zeros(2 * self.selection.count, CONSTRAINT)
        return groups

    def prepare(self, state: StepState, motions: Motions, group: Group, h: float) -> np.ndarray:
        """Fill the rows of a group, for substeps of h [s], and return them."""
        rows = self.constraints[group.start : group.stop]
        tolerances = state.tolerances
        limits = Limits(
            CALM_SHARE * tolerances.push_speed,
            STICKING_SHARE * tolerances.speculative,
            tolerances.slop,
            tolerances.restitution_speed,
        )
        PREPARE[state.effects.friction, state.effects.conveyor](
            state.bodies,
            motions.used,
            state.manifolds,
            self.selection.plan,
            group.start,
            h,
            limits,
            state.anchors,
            rows,
            state.work,
        )
        return rows

    def blocks(self, group: Group) -> Blocks:
        """Arrays for the rows of a group in lanes."""
        needed = blocks_needed(group.stop - group.start, group.starts)
        if len(self.lanes.row_of) < needed:
            self.lanes = make_blocks(2 * needed)
        return self.lanes

    def store(self, state: StepState, motions: Motions, rows: np.ndarray, h: float) -> None:
        """Bounce what has met, end friction where less presses, and write the impulses of a group's rows back."""
        effects, threshold = state.effects, state.tolerances.restitution_speed
        FINISH[effects.restitution, effects.friction, effects.rotation](
            threshold, 1.0 / h, state.dt / state.span, motions.used, rows, state.manifolds, state.anchors, state.work
        )
