"""Sequential impulses: one step, several passes, contacts that remember, overlaps pushed out by a share per step.

Differs from `soft_step` in that positions move once, after all passes, and in that contacts are hard: piles are
livelier and sink by the slop. What bears nothing is let out of an overlap by speeds of its own, which are none of its
velocity (split impulses). Cost: ITERATIONS_PER_SUBSTEP passes over the constraints for each substep that soft_step
would take. Each carries loads on by a row or two: a pyramid of 45 rows, 1,035 boxes, does not come to rest with the ten
passes of four substeps (measured: it breathes at 8 to 22 px/s for a minute and more); with the forty of sixteen it
does. Source: Catto, Iterative Dynamics with Temporal Coherence, GDC 2005, and Box2D-Lite, 2006.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

from physics.jit import kernel, subkernel
from physics.settings import AUTO_SUBSTEPS, BAUMGARTE, ITERATIONS_PER_SUBSTEP, PUSH_PASSES, PUSH_SHARE
from physics.solver.constraints import WARM_START, ContactSet
from physics.solver.motions import READS, SUBSTEP_POSITIONS, SUBSTEP_VELOCITIES, WRITES, move_driven, push_piles
from physics.solver.restitution import bounce_once, relative_speed, solve_two
from physics.solver.step_context import wanted_apart
from physics.tables.step_state import StepState, stage

BOTH = (False, True)
# of a CONSTRAINT row, that the passes of a step start from
IMPULSES = ("normal_impulse_1", "normal_impulse_2", "tangent_impulse_1", "tangent_impulse_2", "rolling_impulse")


class Pace(NamedTuple):
    """What all passes of a step have in common."""

    passes: int
    dt: float  # [s]
    inverse_dt: float
    inverse_span: (
        float  # [1/s] of no shorter a time: overlaps come out no faster in a step that is shorter than those before
    )
    drag: float  # [1/s]
    push_speed: float  # [px/s]


@subkernel
def push_wanted(separation, inverse_h, slop, rate, push_speed):
    """Speed [px/s] that a point has to let an overlap out with, or, negative, may still close a gap with."""
    if separation > 0.0:
        return -separation * inverse_h
    return min(rate * max(-separation - slop, 0.0), push_speed)


def make_sequential_pass(rotation: bool, friction: bool) -> Callable:
    """One pass over the constraints of a world with these effects; the two points of a manifold are solved together."""

    @subkernel
    def solve_sequential(
        # read, scalars
        inverse_h,
        slow,
        slop,
        rate,
        # write
        motions_inout,
        constraints_inout,
    ):
        """Solve every constraint once, friction first, in the order of the rows. O(constraints).

        What bears something lets its overlap out as in push_overlaps, as far as that takes a speed of no more than slow
        [px/s]: through all passes, and with the memory of contacts, or columns would sink. rate [1/s]: of an overlap
        beyond the slop, that comes out.
        """
        for i in range(len(constraints_inout)):
            r = constraints_inout[i]
            a = motions_inout[r.motion_a]
            b = motions_inout[r.motion_b]
            nx = r.normal_x
            ny = r.normal_y
            masses = a.inverse_mass + b.inverse_mass
            vx = b.vx - a.vx
            vy = b.vy - a.vy
            wa = a.angular_velocity
            wb = b.angular_velocity
            x = 0.0
            y = 0.0
            if friction and rotation and r.rolling_limit > 0.0:
                limit = r.rolling_limit * (r.normal_impulse_1 + r.normal_impulse_2)
                impulse = max(-limit, min(limit, r.rolling_impulse - r.rolling_mass * (wb - wa)))
                change = impulse - r.rolling_impulse
                r.rolling_impulse = impulse
                wa -= a.inverse_inertia * change
                wb += b.inverse_inertia * change
            for k in range(r.count if friction and r.friction > 0.0 else 0):
                ax = r.ax_1 if k == 0 else r.ax_2
                ay = r.ay_1 if k == 0 else r.ay_2
                bx = r.bx_1 if k == 0 else r.bx_2
                by = r.by_1 if k == 0 else r.by_2
                old = r.tangent_impulse_1 if k == 0 else r.tangent_impulse_2
                mass = r.tangent_mass_1 if k == 0 else r.tangent_mass_2
                limit = r.friction * (r.normal_impulse_1 if k == 0 else r.normal_impulse_2)
                speed = vy * nx - vx * ny - r.surface_speed
                if rotation:
                    speed += (wb * bx - wa * ax) * nx - (wa * ay - wb * by) * ny
                impulse = max(-limit, min(limit, old - mass * speed))
                px = (old - impulse) * ny
                py = (impulse - old) * nx
                x += px
                y += py
                vx += masses * px
                vy += masses * py
                if rotation:
                    wa -= a.inverse_inertia * (ax * py - ay * px)
                    wb += b.inverse_inertia * (bx * py - by * px)
                if k == 0:
                    r.tangent_impulse_1 = impulse
                else:
                    r.tangent_impulse_2 = impulse
            speed_1 = vx * nx + vy * ny
            speed_2 = speed_1
            if rotation:
                speed_1 += (wa * r.ay_1 - wb * r.by_1) * nx + (wb * r.bx_1 - wa * r.ax_1) * ny
                speed_2 += (wa * r.ay_2 - wb * r.by_2) * nx + (wb * r.bx_2 - wa * r.ax_2) * ny
            core = r.radius_a + r.radius_b
            gap = core + r.base_1 + (r.bx_1 - r.ax_1) * nx + (r.by_1 - r.ay_1) * ny
            most = slow if r.loaded else 0.0
            wanted_1 = push_wanted(gap, inverse_h, slop, rate, most) - speed_1
            old_1 = r.normal_impulse_1
            old_2 = r.normal_impulse_2
            if r.count == 1:
                impulse_1 = max(old_1 + r.normal_mass_1 * wanted_1, 0.0)
                impulse_2 = old_2
            else:
                gap = core + r.base_2 + (r.bx_2 - r.ax_2) * nx + (r.by_2 - r.ay_2) * ny
                wanted_2 = push_wanted(gap, inverse_h, slop, rate, most) - speed_2
                change_1 = r.normal_mass_1 * wanted_1
                change_2 = r.normal_mass_2 * wanted_2
                impulse_1, impulse_2 = solve_two(change_1, change_2, r.couple_1, r.couple_2, r.split, old_1, old_2)
            r.normal_impulse_1 = impulse_1
            r.normal_impulse_2 = impulse_2
            if r.rests or impulse_1 + impulse_2 > 0.0:
                a.pressed = True
                b.pressed = True
            change = impulse_1 - old_1 + impulse_2 - old_2
            x += change * nx
            y += change * ny
            if rotation:
                wa -= a.inverse_inertia * (
                    (impulse_1 - old_1) * (r.ax_1 * ny - r.ay_1 * nx)
                    + (impulse_2 - old_2) * (r.ax_2 * ny - r.ay_2 * nx)
                )
                wb += b.inverse_inertia * (
                    (impulse_1 - old_1) * (r.bx_1 * ny - r.by_1 * nx)
                    + (impulse_2 - old_2) * (r.bx_2 * ny - r.by_2 * nx)
                )
            a.vx -= a.inverse_mass * x
            a.vy -= a.inverse_mass * y
            b.vx += b.inverse_mass * x
            b.vy += b.inverse_mass * y
            if rotation:
                a.angular_velocity = wa
                b.angular_velocity = wb

    return solve_sequential


def make_push_pass(rotation: bool) -> Callable:
    """One pass that lets overlaps out, over the constraints of a world with this effect."""

    @subkernel
    def push_overlaps(
        # read, scalars
        inverse_h,
        push_speed,
        slop,
        rate,
        # write
        motions_inout,
        constraints_inout,
    ):
        """Give the bodies the speeds beside their own that let overlaps out, in the order of the rows. O(constraints).

        Only where nothing was borne in the step before. slop [px], rate [1/s], push_speed [px/s]: see wanted_apart.
        Impulses of these speeds add up apart from the contacts'.
        """
        for i in range(len(constraints_inout)):
            r = constraints_inout[i]
            a = motions_inout[r.motion_a]
            b = motions_inout[r.motion_b]
            nx = r.normal_x
            ny = r.normal_y
            if r.loaded:
                continue
            core = r.radius_a + r.radius_b
            for k in range(r.count):
                ax = r.ax_1 if k == 0 else r.ax_2
                ay = r.ay_1 if k == 0 else r.ay_2
                bx = r.bx_1 if k == 0 else r.bx_2
                by = r.by_1 if k == 0 else r.by_2
                gap = core + (r.base_1 if k == 0 else r.base_2) + (bx - ax) * nx + (by - ay) * ny
                old = r.push_impulse_1 if k == 0 else r.push_impulse_2
                a_arm = ax * ny - ay * nx
                b_arm = bx * ny - by * nx
                pushed = (b.push_vx - a.push_vx) * nx + (b.push_vy - a.push_vy) * ny
                if rotation:
                    pushed += b.push_w * b_arm - a.push_w * a_arm
                wanted = wanted_apart(gap, inverse_h, slop, rate, push_speed)
                if old == 0.0 and pushed >= 0.0 and wanted <= 0.0:
                    continue
                speed = (b.vx - a.vx) * nx + (b.vy - a.vy) * ny
                if rotation:
                    speed += b.angular_velocity * b_arm - a.angular_velocity * a_arm
                mass = r.normal_mass_1 if k == 0 else r.normal_mass_2
                impulse = max(old + mass * (wanted - speed - pushed), 0.0)
                change = impulse - old
                if k == 0:
                    r.push_impulse_1 = impulse
                else:
                    r.push_impulse_2 = impulse
                a.push_vx -= a.inverse_mass * change * nx
                a.push_vy -= a.inverse_mass * change * ny
                b.push_vx += b.inverse_mass * change * nx
                b.push_vy += b.inverse_mass * change * ny
                if rotation:
                    a.push_w -= a.inverse_inertia * change * a_arm
                    b.push_w += b.inverse_inertia * change * b_arm

    return push_overlaps


@subkernel
def stop_met(constraints_inout, motions_inout):
    """Take from what met in this step the speed that it closed its gap with: or it would meet again in the next.
    O(constraints).

    Not from what comes slowly: of piles that tremble under a load the passes leave some speed, and it is borne next.
    """
    for i in range(len(constraints_inout)):
        r = constraints_inout[i]
        if not r.meets:
            continue
        a = motions_inout[r.motion_a]
        b = motions_inout[r.motion_b]
        nx = r.normal_x
        ny = r.normal_y
        if r.normal_impulse_1 > 0.0 and relative_speed(a, b, nx, ny, r.ax_1, r.ay_1, r.bx_1, r.by_1) < 0.0:
            r.normal_impulse_1 += bounce_once(
                0.0, nx, ny, r.ax_1, r.ay_1, r.bx_1, r.by_1, r.normal_mass_1, r.normal_impulse_1, a, b
            )
        if r.normal_impulse_2 > 0.0 and relative_speed(a, b, nx, ny, r.ax_2, r.ay_2, r.bx_2, r.by_2) < 0.0:
            r.normal_impulse_2 += bounce_once(
                0.0, nx, ny, r.ax_2, r.ay_2, r.bx_2, r.by_2, r.normal_mass_2, r.normal_impulse_2, a, b
            )


@subkernel
def sum_up(constraints_inout):
    """The impulses of the one substep are those of the step. O(constraints)."""
    for i in range(len(constraints_inout)):
        r = constraints_inout[i]
        r.normal_total_1 = r.normal_impulse_1
        r.tangent_total_1 = r.tangent_impulse_1
        r.normal_total_2 = r.normal_impulse_2
        r.tangent_total_2 = r.tangent_impulse_2


SOLVE = {(r, f): make_sequential_pass(rotation=r, friction=f) for r in BOTH for f in BOTH}
PUSH_OUT = {r: make_push_pass(rotation=r) for r in BOTH}


def make_passes(drag: bool, rotation: bool, friction: bool) -> Callable:
    """All passes of a step in a world with these effects."""
    velocities, positions = SUBSTEP_VELOCITIES[drag, rotation], SUBSTEP_POSITIONS[rotation]
    warm_start, solve_all, push_out = WARM_START[rotation], SOLVE[rotation, friction], PUSH_OUT[rotation]

    @kernel
    def run_passes(
        # read
        members,
        driven,
        pace,
        slow,
        slop,
        # write
        motions_inout,
        constraints_inout,
    ):
        """Advance the members by a step under the constraints, and what moves by hand: rows of MOTION. pace: see Pace.
        O(members + passes · constraints)."""
        velocities(members, pace.dt, pace.drag, motions_inout)
        warm_start(constraints_inout, motions_inout)
        for _ in range(pace.passes):
            solve_all(pace.inverse_dt, slow, slop, BAUMGARTE * pace.inverse_span, motions_inout, constraints_inout)
        for _ in range(PUSH_PASSES):
            push_out(
                pace.inverse_dt, pace.push_speed, slop, PUSH_SHARE * pace.inverse_span, motions_inout, constraints_inout
            )
        positions(members, pace.dt, pace.push_speed, motions_inout)
        move_driven(driven, pace.dt, motions_inout)
        stop_met(constraints_inout, motions_inout)
        sum_up(constraints_inout)

    return run_passes


PASSES = {(d, r, f): make_passes(drag=d, rotation=r, friction=f) for d in BOTH for r in BOTH for f in BOTH}


def solve(state: StepState, contacts: ContactSet, passes: int | None = None, warm: bool = True) -> float:
    """Advance the motions by a step under the contacts. Returns the step [s] that impulses belong to.

    For measuring alone (studied_solvers.py): passes, else those of the substeps; warm: they start from the impulses of
    the step before."""
    effects, motions, tolerances, dt = state.effects, state.workspace.motions, state.tolerances, state.dt
    # What bears something lets out an overlap of as much, at a time, by the speeds of its bodies.
    slow = BAUMGARTE / state.span * tolerances.speculative
    run = PASSES[effects.drag, effects.rotation, effects.friction]
    for group in contacts.choose(state, motions, state.substeps or AUTO_SUBSTEPS[0]):
        rows = contacts.prepare(state, motions, group, dt)
        if not warm:
            for name in IMPULSES:
                rows[name] = 0.0
        count = passes or math.ceil(ITERATIONS_PER_SUBSTEP * group.substeps)
        pace = Pace(count, dt, 1.0 / dt, 1.0 / state.span, state.drag, tolerances.push_speed)
        run(group.members, motions.driven, pace, slow, tolerances.slop, motions.used, rows)
        contacts.store(state, motions, rows, dt)
    return dt


@stage("sequential_impulse", reads=READS, writes=WRITES)
def sequential_impulse(state: StepState) -> None:
    """Push and move the bodies of a world that stacks."""
    push_piles(state, solve)
