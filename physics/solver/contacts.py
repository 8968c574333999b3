"""Contacts as a constraint set: which manifolds are solved, in which order, as which rows, and what is stored of them.

A solver prepares the rows, runs its passes over them in one kernel, and stores what came of it.
"""

from collections.abc import Callable

import numpy as np

from physics.jit import kernel, subkernel
from physics.solver.bounce import restore_bounces
from physics.solver.lanes import Blocks, blocks_needed, make_blocks
from physics.solver.motions import Motions
from physics.solver.rows import BOTH, PREPARE_ROW
from physics.solver.selection import Group, Selection
from physics.tables.constraint import CONSTRAINT
from physics.tables.step_state import StepState


def make_prepare(friction: bool, conveyor: bool) -> Callable:
    """The pass from contacts to constraint rows for a world with these effects."""
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
        """Fill the constraint rows, from row `start` of a plan of so many edges on, with the impulses that the last
        step found for a substep of h [s]; see prepare_row. O(edges).

        Contacts are read in the order in which they stand, for a processor that reads ahead: what is far apart is
        written.
        """
        for edge in range(count):
            place = plan.places[edge] - start
            if 0 <= place < len(constraints_out):  # else it is of another group
                row = constraints_out[place]
                prepare_row(bodies, motions, manifolds, plan, edge, h, limits, anchors_inout, row, work_inout)

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
    def limit_friction(count, motions_inout, constraints_inout):
        """Take back what friction is more than its share of the final normal impulse, over the step: of so many rows.
        O(count)."""
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
    """What every solver that stacks ends with in a world with these effects."""
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
        """Bounce what has met, end friction where less presses, and write the impulses back. O(constraints).

        threshold [px/s], dt [s]: see restore_bounces; inverse_h [1/s], share: see store_impulses.
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
        PREPARE[state.effects.friction, state.effects.conveyor](
            state.bodies,
            motions.used,
            state.manifolds,
            self.selection.plan,
            self.selection.count,
            group.start,
            h,
            state.tolerances.limits,
            state.anchors,
            rows,
            state.work,
        )
        return rows

    def blocks(self, group: Group) -> Blocks:
        """Arrays for the rows of a group in lanes."""
        needed = blocks_needed(group.stop - group.start, group.loose)
        if len(self.lanes.manifold) < needed:
            self.lanes = make_blocks(2 * needed)
        return self.lanes

    def store(self, state: StepState, motions: Motions, rows: np.ndarray, h: float) -> None:
        """Bounce what has met, end friction where less presses, and write the impulses of a group's rows back."""
        effects, threshold = state.effects, state.tolerances.restitution_speed
        FINISH[effects.restitution, effects.friction, effects.rotation](
            threshold,
            state.dt,
            1.0 / h,
            state.dt / state.span,
            motions.used,
            rows,
            state.manifolds,
            state.anchors,
            state.work,
        )
