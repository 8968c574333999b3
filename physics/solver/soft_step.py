"""Small substeps with soft contacts: each substep is solved once with a spring that pushes overlaps out, then relaxed.

Differs from `sequential_impulse` in that the step is cut into substeps of one pass each, and in that a loaded contact
gives way as a spring does. What bears nothing is let out of an overlap by speeds of its own, which are none of its
velocity. Cost per substep: three passes over the constraints, two over the bodies. Sources: Macklin et al., Small Steps
in Physics Simulation, SCA 2019; Catto, Soft Constraints, GDC 2011, and Solver2D, 2024: contacts as damped springs,
friction in the relaxing pass alone.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

from physics.jit import kernel, subkernel
from physics.settings import (
    AUTO_SUBSTEPS,
    CALM_SHARE,
    CONTACT_DAMPING,
    CONTACT_HERTZ,
    HERTZ_SHARE,
    PUSH_SHARE,
    STILL_STIFFNESS,
)
from physics.solver.contacts import WARM_START, ContactSet
from physics.solver.demand import ask_for_substeps
from physics.solver.motions import READS, SUBSTEP_POSITIONS, SUBSTEP_VELOCITIES, WRITES, move_driven, push_piles
from physics.solver.two_points import solve_two
from physics.tables.step_state import StepState, stage

BOTH = (False, True)


class Softness(NamedTuple):
    """A damped spring as a constraint over a substep: speed per px of overlap, shares of mass and impulse."""

    bias_rate: float
    mass_scale: float
    impulse_scale: float


class Pace(NamedTuple):
    """What all substeps of a group of islands have in common."""

    substeps: int
    h: float  # [s]
    inverse_h: float
    drag: float  # [1/s]
    push_speed: float  # [px/s]
    push_rate: float  # [1/s] of an overlap that bears nothing
    deep_rate: float  # [1/s] of one that is deep, 0: as fast as it can, beyond …
    shallow_speed: float  # [px/s] … what a shallow one may come out with


def softness(hertz: float, damping: float, h: float) -> Softness:
    """The implicit spring of a frequency [1/s] and damping ratio over h [s] (Catto, Soft Constraints, 2011)."""
    omega = math.tau * hertz
    a1 = 2.0 * damping + h * omega
    a2 = h * omega * a1
    a3 = 1.0 / (1.0 + a2)
    return Softness(omega / a1, a2 * a3, a3)


@subkernel
def wanted_change(speed, separation, given, inverse_h, biased, spring, push_speed):
    """The change of its speed [px/s] along the normal that one point wants; `given` [px/s]: by its impulse so far.

    Apart: brake so that the gap is just closed in this substep. Overlapping: with bias, what a Softness gives it that
    pushes out at no more than push_speed [px/s], without a dead zone; without bias, no approach.
    """
    if separation > 0.0:
        return -speed - separation * inverse_h
    if not biased:
        return -speed
    bias = max(spring.mass_scale * spring.bias_rate * separation, -push_speed)
    return -spring.mass_scale * speed - bias - spring.impulse_scale * given


@subkernel
def let_out(speed, separation, mass, pace):
    """Impulse that lets an overlap out: by a share of it per second, at the push speed at most."""
    if separation > 0.0:
        return max(-mass * (speed + separation * pace.inverse_h), 0.0)
    return max(mass * (min(-separation * pace.push_rate, pace.push_speed) - speed), 0.0)


@subkernel
def let_out_both(r, speed_1, speed_2, gap_1, gap_2, k_12, pace, rotation, a_inout, b_inout):
    """Push two bodies apart at the points of a constraint row that bears nothing, by the speeds that only move them.

    speeds [px/s] of their own and gaps [px] at both points; k_12: speed of one point per impulse on the other.
    """
    nx = r.normal_x
    ny = r.normal_y
    pushed = (b_inout.push_vx - a_inout.push_vx) * nx + (b_inout.push_vy - a_inout.push_vy) * ny
    a_1 = r.ax_1 * ny - r.ay_1 * nx
    b_1 = r.bx_1 * ny - r.by_1 * nx
    a_2 = r.ax_2 * ny - r.ay_2 * nx
    b_2 = r.bx_2 * ny - r.by_2 * nx
    total = speed_1 + pushed
    if rotation:
        total += b_inout.push_w * b_1 - a_inout.push_w * a_1
    push_1 = let_out(total, gap_1, r.normal_mass_1, pace)
    push_2 = 0.0
    if r.count == 2:
        total = speed_2 + pushed + k_12 * push_1
        if rotation:
            total += b_inout.push_w * b_2 - a_inout.push_w * a_2
        push_2 = let_out(total, gap_2, r.normal_mass_2, pace)
    if push_1 + push_2 > 0.0:
        x = (push_1 + push_2) * nx
        y = (push_1 + push_2) * ny
        a_inout.push_vx -= a_inout.inverse_mass * x
        a_inout.push_vy -= a_inout.inverse_mass * y
        b_inout.push_vx += b_inout.inverse_mass * x
        b_inout.push_vy += b_inout.inverse_mass * y
        if rotation:
            a_inout.push_w -= a_inout.inverse_inertia * (push_1 * a_1 + push_2 * a_2)
            b_inout.push_w += b_inout.inverse_inertia * (push_1 * b_1 + push_2 * b_2)


@subkernel
def turned_along(a, b, ax, ay, bx, by, nx, ny):
    """How far apart [px] along the normal the two arms reach, turned as their bodies since the step began."""
    x = (b.cosine * bx - b.sine * by) - (a.cosine * ax - a.sine * ay)
    y = (b.sine * bx + b.cosine * by) - (a.sine * ax + a.cosine * ay)
    return x * nx + y * ny


def make_soft_pass(biased: bool, rotation: bool, friction: bool) -> Callable:
    """One pass over the constraints: with bias (and no friction), or relaxing (with friction where declared)."""

    @subkernel
    def solve_soft(
        # read, scalars
        pace,
        soft,
        soft_still,
        # write
        motions_inout,
        constraints_inout,
    ):
        """Solve every constraint once, in the order of the rows. O(constraints).

        pace: see Pace; soft, soft_still: Softness of a contact between bodies and of one with what cannot be pushed.
        """
        inverse_h = pace.inverse_h
        push_speed = pace.push_speed
        calm_speed = CALM_SHARE * push_speed
        for i in range(len(constraints_inout)):
            r = constraints_inout[i]
            a = motions_inout[r.motion_a]
            b = motions_inout[r.motion_b]
            nx = r.normal_x
            ny = r.normal_y
            spring = soft_still if r.still else soft
            most = push_speed * r.push_share
            vx = b.vx - a.vx
            vy = b.vy - a.vy
            wa = a.angular_velocity
            wb = b.angular_velocity
            # A round surface stays where it is when its body turns: cores are what moves.
            core = r.radius_a * a.cosine + r.radius_b * b.cosine
            masses = a.inverse_mass + b.inverse_mass
            a_1 = r.ax_1 * ny - r.ay_1 * nx
            b_1 = r.bx_1 * ny - r.by_1 * nx
            a_2 = r.ax_2 * ny - r.ay_2 * nx
            b_2 = r.bx_2 * ny - r.by_2 * nx
            # Arms turn with their bodies where separations are measured, and stay where speeds are.
            gap = core + (b.dx - a.dx) * nx + (b.dy - a.dy) * ny
            gap_1 = gap + r.base_1 + turned_along(a, b, r.ax_1, r.ay_1, r.bx_1, r.by_1, nx, ny)
            gap_2 = gap_1
            if r.count == 2:
                gap_2 = gap + r.base_2 + turned_along(a, b, r.ax_2, r.ay_2, r.bx_2, r.by_2, nx, ny)
            speed_1 = vx * nx + vy * ny
            speed_2 = speed_1
            if rotation:
                speed_1 += wb * b_1 - wa * a_1
                speed_2 += wb * b_2 - wa * a_2
            old_1 = r.normal_impulse_1
            old_2 = r.normal_impulse_2
            if pace.deep_rate > 0.0:
                # Deep overlaps come out as slowly as with the fewest substeps; shallow ones may be what bears a load.
                deep = -gap_1 if r.count == 1 else -min(gap_1, gap_2)
                most = min(most, max(pace.deep_rate * deep, pace.shallow_speed))
            # A spring would let a fast impact through: what has just met is stopped hard, and pushed out from then on.
            still = speed_1 >= -calm_speed and (r.count == 1 or speed_2 >= -calm_speed)
            bears = old_1 > calm_speed * r.normal_mass_1 or old_2 > calm_speed * r.normal_mass_2
            soft_now = biased and (still or bears)
            # What bears nothing, and has not just met, is let out of its overlap and gets no speed from that.
            free = soft_now and r.calm and not bears
            k_11 = 1.0 / r.normal_mass_1
            wanted_1 = wanted_change(speed_1, gap_1, k_11 * old_1, inverse_h, soft_now, spring, most)
            impulse_1 = max(old_1 + r.normal_mass_1 * wanted_1, 0.0)
            impulse_2 = old_2
            k_12 = 0.0
            if r.count == 2:
                k_12 = masses
                if rotation:
                    k_12 += a.inverse_inertia * a_1 * a_2 + b.inverse_inertia * b_1 * b_2
                k_22 = 1.0 / r.normal_mass_2
                wanted_2 = wanted_change(speed_2, gap_2, k_22 * old_2, inverse_h, soft_now, spring, most)
                # Together, or the first would spin the body, and a box on its base would lean to one side.
                solved, both_1, both_2 = solve_two(k_11, k_12, k_22, wanted_1, wanted_2, old_1, old_2)
                if solved:
                    impulse_1 = both_1
                    impulse_2 = both_2
                else:
                    impulse_2 = max(old_2 + r.normal_mass_2 * (wanted_2 - k_12 * (impulse_1 - old_1)), 0.0)
            if free:
                impulse_1 = 0.0
                impulse_2 = 0.0
                let_out_both(r, speed_1, speed_2, gap_1, gap_2, k_12, pace, rotation, a, b)
            r.normal_impulse_1 = impulse_1
            r.normal_impulse_2 = impulse_2
            if biased and (r.rests or impulse_1 + impulse_2 > 0.0):
                a.pressed = True
                b.pressed = True
            if not biased:
                r.normal_total_1 += impulse_1
                r.normal_total_2 += impulse_2
            change = impulse_1 - old_1 + impulse_2 - old_2
            x = change * nx  # sums of the impulses on B
            y = change * ny
            vx += masses * x
            vy += masses * y
            if rotation:
                wa -= a.inverse_inertia * ((impulse_1 - old_1) * a_1 + (impulse_2 - old_2) * a_2)
                wb += b.inverse_inertia * ((impulse_1 - old_1) * b_1 + (impulse_2 - old_2) * b_2)
            # After the normals: what the bias has pushed in too much is out again, and does not count as pressure.
            if not biased and friction and r.friction > 0.0:
                tx = -ny
                ty = nx
                if rotation and r.rolling_limit > 0.0:
                    limit = r.rolling_limit * (r.normal_impulse_1 + r.normal_impulse_2)
                    impulse = max(-limit, min(limit, r.rolling_impulse - r.rolling_mass * (wb - wa)))
                    change = impulse - r.rolling_impulse
                    r.rolling_impulse = impulse
                    wa -= a.inverse_inertia * change
                    wb += b.inverse_inertia * change
                for k in range(r.count):
                    ax = r.ax_1 if k == 0 else r.ax_2
                    ay = r.ay_1 if k == 0 else r.ay_2
                    bx = r.bx_1 if k == 0 else r.bx_2
                    by = r.by_1 if k == 0 else r.by_2
                    old = r.tangent_impulse_1 if k == 0 else r.tangent_impulse_2
                    mass = r.tangent_mass_1 if k == 0 else r.tangent_mass_2
                    limit = r.friction * (r.normal_impulse_1 if k == 0 else r.normal_impulse_2)
                    speed = (vx + (wa * ay - wb * by)) * tx + (vy + (wb * bx - wa * ax)) * ty - r.surface_speed
                    impulse = max(-limit, min(limit, old - mass * speed))
                    change = impulse - old
                    px = change * tx
                    py = change * ty
                    x += px
                    y += py
                    vx += masses * px
                    vy += masses * py
                    if rotation:
                        wa -= a.inverse_inertia * (ax * py - ay * px)
                        wb += b.inverse_inertia * (bx * py - by * px)
                    if k == 0:
                        r.tangent_impulse_1 = impulse
                        r.tangent_total_1 += impulse
                    else:
                        r.tangent_impulse_2 = impulse
                        r.tangent_total_2 += impulse
            a.vx -= a.inverse_mass * x
            a.vy -= a.inverse_mass * y
            b.vx += b.inverse_mass * x
            b.vy += b.inverse_mass * y
            if rotation:
                a.angular_velocity = wa
                b.angular_velocity = wb

    return solve_soft


PUSH_OUT = {r: make_soft_pass(biased=True, rotation=r, friction=False) for r in BOTH}
RELAX = {(r, f): make_soft_pass(biased=False, rotation=r, friction=f) for r in BOTH for f in BOTH}


def make_substeps(drag: bool, rotation: bool, friction: bool) -> Callable:
    """All substeps of a step in a world with these effects."""
    velocities, positions = SUBSTEP_VELOCITIES[drag, rotation], SUBSTEP_POSITIONS[rotation]
    warm_start, push_out, relax = WARM_START[rotation], PUSH_OUT[rotation], RELAX[rotation, friction]

    @kernel
    def run_substeps(
        # read
        members,
        driven,
        pace,
        soft,
        soft_still,
        # write
        motions_inout,
        constraints_inout,
    ):
        """Advance the members by substeps under the constraints, and what moves by hand beside them: rows of MOTION.
        O(substeps · (members + constraints)).

        pace: see Pace. One kernel for them all: with ten boxes five sixths of a substep were calls from Python.
        """
        h = pace.h
        move_driven(driven, 0.0, motions_inout)
        for n in range(pace.substeps):
            velocities(members, h, pace.drag, motions_inout)
            warm_start(constraints_inout, motions_inout)
            push_out(pace, soft, soft_still, motions_inout, constraints_inout)
            positions(members, h, pace.push_speed, motions_inout)
            move_driven(driven, (n + 1) * h, motions_inout)
            relax(pace, soft, soft_still, motions_inout, constraints_inout)

    return run_substeps


SUBSTEPS = {(d, r, f): make_substeps(drag=d, rotation=r, friction=f) for d in BOTH for r in BOTH for f in BOTH}


def solve(state: StepState, contacts: ContactSet) -> float:
    """Advance the motions by a step under the contacts, group by group. Returns the shortest substep [s]."""
    effects, motions, tolerances, dt = state.effects, state.workspace.motions, state.tolerances, state.dt
    run, h = SUBSTEPS[effects.drag, effects.rotation, effects.friction], dt
    asked = state.substeps == 0
    slowest = dt / AUTO_SUBSTEPS[0]
    deep_rate = softness(HERTZ_SHARE / slowest, CONTACT_DAMPING, slowest).bias_rate if asked else 0.0
    for group in contacts.choose(state, motions, state.substeps):
        h = dt / group.substeps
        # Where the substeps follow from the loads, springs are as stiff as they allow.
        hertz = HERTZ_SHARE / h if asked else min(CONTACT_HERTZ, HERTZ_SHARE / h)
        soft = softness(hertz, CONTACT_DAMPING, h)
        soft_still = softness(STILL_STIFFNESS * hertz, CONTACT_DAMPING, h)
        rows = contacts.prepare(state, motions, group, h)
        # More substeps let nothing out faster.
        push_rate = PUSH_SHARE * min(group.substeps, AUTO_SUBSTEPS[0]) / dt
        shallow_speed = soft.bias_rate * tolerances.speculative
        pace = Pace(group.substeps, h, 1.0 / h, state.drag, tolerances.push_speed, push_rate, deep_rate, shallow_speed)
        run(group.members, motions.driven, pace, soft, soft_still, motions.used, rows)
        if asked:
            ask_for_substeps(state, motions, contacts.selection.parents, group, rows)
        contacts.store(state, motions, rows, h)
    return h


@stage("soft_step", reads=READS, writes=WRITES)
def soft_step(state: StepState) -> None:
    """Push and move the bodies of a world that stacks."""
    push_piles(state, solve)
