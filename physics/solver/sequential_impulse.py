"""Sequential impulses: one step, several passes, warm start, Baumgarte stabilisation.

It differs from `soft_step` in that positions move once, after all passes, and in that contacts are hard: stacks are
livelier and sag by the slop. Unloaded contacts separate by a pseudo-velocity (split impulses). Cost:
ITERATIONS_PER_SUBSTEP passes for each substep of soft_step. Each pass transmits a load by one or two rows. A pyramid of
45 rows (1,035 boxes) does not come to rest with the ten passes of four substeps: it moves at 8 to 22 px/s for over a
minute. With the forty passes of sixteen it rests. Source: Catto, Iterative Dynamics with Temporal Coherence, GDC 2005,
and Box2D-Lite, 2006.
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
# impulses of a CONSTRAINT row with which the passes of a step start
IMPULSES = ("normal_impulse_1", "normal_impulse_2", "tangent_impulse_1", "tangent_impulse_2", "rolling_impulse")


class Pace(NamedTuple):
    """The constants of all passes of a step."""

    passes: int
    dt: float  # [s]
    inverse_dt: float
    inverse_span: float  # [1/s] of a step that is no shorter than those before: a short step separates no faster
    drag: float  # [1/s]
    push_speed: float  # [px/s]


@subkernel
def push_wanted(separation, inverse_h, slop, rate, push_speed):
    """Return the separation speed [px/s] of an overlapping point; negative: the speed at which a gap may close."""
    if separation > 0.0:
        return -separation * inverse_h
    return min(rate * max(-separation - slop, 0.0), push_speed)


def make_sequential_pass(rotation: bool, friction: bool) -> Callable:
    """Return one pass over the constraints of a world with these effects, with the block solver for two points."""

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

        A loaded contact separates as in push_overlaps, as far as that takes no more than slow [px/s]: in all passes and
        with warm start, otherwise columns would sag. rate [1/s]: share of the overlap beyond the slop that is removed.
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
    """Return one pass of push-out over the constraints of a world with this effect."""

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
        """Give the bodies pseudo-velocities that separate unloaded contacts, in the order of the rows. O(constraints).

        slop [px], rate [1/s], push_speed [px/s]: see wanted_apart. The impulses of these velocities accumulate apart
        from those of the contacts.
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
    """Remove from contacts that met in this step the speed with which they closed their gaps. O(constraints).

    Otherwise they would meet again in the next step. Slow approaches are left out: the passes leave some speed in
    loaded stacks, which the next step removes.
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
    """Copy the impulses of the one substep to those of the step. O(constraints)."""
    for i in range(len(constraints_inout)):
        r = constraints_inout[i]
        r.normal_total_1 = r.normal_impulse_1
        r.tangent_total_1 = r.tangent_impulse_1
        r.normal_total_2 = r.normal_impulse_2
        r.tangent_total_2 = r.tangent_impulse_2


SOLVE = {(r, f): make_sequential_pass(rotation=r, friction=f) for r in BOTH for f in BOTH}
PUSH_OUT = {r: make_push_pass(rotation=r) for r in BOTH}


def make_passes(drag: bool, rotation: bool, friction: bool) -> Callable:
    """Return all passes of a step in a world with these effects."""
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
        """Advance island bodies and kinematic ones, rows of MOTION, by a step under the constraints. pace: see Pace.

        O(members + passes · constraints).
        """
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
    """Advance the motions by a step under the contacts. Return the step [s] to which the impulses belong.

    For measurements (studied_solvers.py): passes, None for those of the substeps; warm: whether they start from the
    cached impulses.
    """
    effects, motions, tolerances, dt = state.effects, state.workspace.motions, state.tolerances, state.dt
    # A loaded contact separates by the velocities of its bodies, by as much at a time.
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
    """Solve the contacts and move the bodies of a world that stacks."""
    push_piles(state, solve)
