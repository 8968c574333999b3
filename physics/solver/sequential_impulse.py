"""Sequential impulses: one step, several passes, warm start, Baumgarte stabilisation.

Unlike in `soft_step`, bodies move once, after all passes, and contacts are rigid. Stacks therefore tremble more, and
sag by the slop. Unloaded contacts separate by a pseudo-velocity (split impulses). The loads determine the number of
substeps that soft_step would take, and this solver makes ITERATIONS_PER_SUBSTEP passes for each of these substeps.

The energy bound of energy.py applies to this solver too. Without it, discs that a block had pressed against a wall
reached 1,160 px/s in one step after the block had stopped.

Each pass transmits a load by one or two rows of a stack. With ten passes for all islands, a pyramid of 45 rows moves at
8 to 60 px/s for over a minute. A plank with a hundredth of the mass of its load creeps by 0.4 to 5 m in that time. If
the loads determine the number of passes, pyramid and plank come to rest, and a step takes 1.5 times as long.

Source: Catto, Iterative Dynamics with Temporal Coherence, GDC 2005, and Box2D-Lite, 2006.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

from physics.jit import inlined, kernel, noalias, subkernel
from physics.math2d import rotation_of
from physics.settings import AUTO_SUBSTEPS, BAUMGARTE, ITERATIONS_PER_SUBSTEP, PUSH_PASSES, PUSH_SHARE
from physics.solver import lanes as at
from physics.solver.contact_lanes import ContactLanes, estimate_substeps
from physics.solver.energy import limit_energy
from physics.solver.joint_direct import (
    begin_substep,
    begin_trees,
    close_gaps,
    end_joints,
    finish_joints,
    solve_all_trees,
    solve_once,
    start_joints,
)
from physics.solver.joint_report import store_joints
from physics.solver.lanes import (
    SIZE,
    gather_velocities,
    lanes_of,
    make_friction,
    relative_speed,
    resist_rolling,
    scatter_velocities,
    solve_two,
)
from physics.solver.motions import (
    READS,
    SUBSTEP_POSITIONS,
    SUBSTEP_VELOCITIES,
    WRITES,
    accelerate_again,
    move_kinematic,
    run_solver,
)
from physics.solver.restitution import bounce_once
from physics.solver.soft_step import WARM_LANES, clear_impulses, follow_inertias, turn_arms
from physics.solver.step_context import context_of, separation_speed
from physics.tables.step_state import CAP_HITS, StepState, stage

BOTH = (False, True)
# Moment arms and normals of round contacts are taken after this fraction of the step. With 0, the start, planks that
# rock on a disc swing up to 8 % further in half a minute. With 0.5, the middle, planks and eccentric discs stop within
# seconds.
LEAD = 0.1


class Passes(NamedTuple):
    """Settings of the passes that a step makes over its contacts."""

    count: int  # number of passes
    warm: bool  # whether the passes start from the cached impulses
    bias_rate: float  # [1/s] separation speed of a loaded contact per px of overlap beyond the slop
    bias_speed: float  # [px/s] greatest separation speed of a loaded contact
    push_rate: float  # [1/s] see separation_speed


@inlined
def bias_speed(gap, inverse_h, slop, rate, most):
    """Return the speed [px/s] at which a point of a loaded contact should separate (Baumgarte stabilisation).

    A negative result is the speed at which a gap may close within the step. gap [px]: negative for an overlap;
    inverse_h [1/s]: inverse of the step length; rate [1/s]: speed per px of overlap beyond the slop [px]; most [px/s]:
    greatest result.
    """
    beyond = -gap - slop
    speed = rate * (beyond if beyond > 0.0 else 0.0)
    speed = speed if speed < most else most
    return -gap * inverse_h if gap > 0.0 else speed


def make_sequential_pass(rotation: bool, friction: bool) -> Callable:
    """Return the function that solves all contacts once. rotation, friction: whether the world has these effects."""
    friction_1, friction_2 = make_friction(False, rotation, False), make_friction(True, rotation, False)

    @noalias
    def solve_sequential(
        # read, scalars
        count,
        context,
        passes,
        # write
        motions_inout,
        blocks_inout,
    ):
        """Solve every contact once: friction first, then both normal impulses together. O(count).

        count: number of blocks; context: see StepContext; passes: see Passes. Overlaps of loaded contacts are removed
        through the velocities of their bodies, not through pseudo-velocities. The impulses that remove overlaps act in
        every pass and are cached, otherwise columns would sag. motions_inout: MOTION rows; blocks_inout: the contacts,
        see lanes.Blocks.
        """
        s = blocks_inout.gathered
        for block in range(count):
            c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
            wide = lanes_of(blocks_inout.contact, block)
            for lane in range(wide):
                a = motions_inout[blocks_inout.motion_a[block, lane]]
                b = motions_inout[blocks_inout.motion_b[block, lane]]
                gather_velocities(a, b, lane, s)
            for lane in range(wide):
                nx = c[at.NX + lane]
                ny = c[at.NY + lane]
                ii_a = c[at.II_A + lane]
                ii_b = c[at.II_B + lane]
                masses = c[at.IM_A + lane] + c[at.IM_B + lane]
                a_1, b_1, a_2, b_2 = c[at.A_1 + lane], c[at.B_1 + lane], c[at.A_2 + lane], c[at.B_2 + lane]
                old_1 = c[at.NORMAL_1 + lane]
                old_2 = c[at.NORMAL_2 + lane]
                wa = s[at.W_A + lane]
                wb = s[at.W_B + lane]
                vx = s[at.VX_B + lane] - s[at.VX_A + lane]
                vy = s[at.VY_B + lane] - s[at.VY_A + lane]
                x = 0.0
                y = 0.0
                if friction:
                    if rotation:
                        wa, wb = resist_rolling(lane, wa, wb, old_1 + old_2, c)
                    x, y, wa, wb = friction_1(lane, vx, vy, wa, wb, old_1, c)
                    vx += masses * x
                    vy += masses * y
                    dx, dy, wa, wb = friction_2(lane, vx, vy, wa, wb, old_2, c)
                    vx += masses * dx
                    vy += masses * dy
                    x += dx
                    y += dy
                speed_1 = vx * nx + vy * ny
                speed_2 = speed_1
                if rotation:
                    speed_1 += wb * b_1 - wa * a_1
                    speed_2 += wb * b_2 - wa * a_2
                most = passes.bias_speed * c[at.LOADED + lane]
                wanted_1 = bias_speed(c[at.GAP_1 + lane], context.inverse_h, context.slop, passes.bias_rate, most)
                wanted_2 = bias_speed(c[at.GAP_2 + lane], context.inverse_h, context.slop, passes.bias_rate, most)
                impulse_1, impulse_2 = solve_two(
                    c[at.MASS_1 + lane] * (wanted_1 - speed_1),
                    c[at.MASS_2 + lane] * (wanted_2 - speed_2),
                    c[at.OFF_DIAGONAL_1 + lane],
                    c[at.OFF_DIAGONAL_2 + lane],
                    c[at.BLOCK_FACTOR + lane],
                    old_1,
                    old_2,
                )
                c[at.NORMAL_1 + lane] = impulse_1
                c[at.NORMAL_2 + lane] = impulse_2
                change = impulse_1 - old_1 + impulse_2 - old_2
                x += change * nx
                y += change * ny
                s[at.VX_A + lane] -= c[at.IM_A + lane] * x
                s[at.VY_A + lane] -= c[at.IM_A + lane] * y
                s[at.VX_B + lane] += c[at.IM_B + lane] * x
                s[at.VY_B + lane] += c[at.IM_B + lane] * y
                if rotation:
                    s[at.W_A + lane] = wa - ii_a * ((impulse_1 - old_1) * a_1 + (impulse_2 - old_2) * a_2)
                    s[at.W_B + lane] = wb + ii_b * ((impulse_1 - old_1) * b_1 + (impulse_2 - old_2) * b_2)
                s[at.OUTCOME + lane] = c[at.RESTING + lane] + impulse_1 + impulse_2
            for lane in range(wide):
                a = motions_inout[blocks_inout.motion_a[block, lane]]
                b = motions_inout[blocks_inout.motion_b[block, lane]]
                if s[at.OUTCOME + lane] > 0.0:
                    a.in_contact = True
                    b.in_contact = True
                scatter_velocities(s, lane, a, b)

    return solve_sequential


def make_push_point(second: bool, rotation: bool) -> Callable:
    """Return the function that pushes bodies apart at one point of an unloaded contact.

    second: True for the second point; rotation: whether bodies rotate.
    """
    gap_line, push_line = (at.GAP_2, at.PUSH_2) if second else (at.GAP_1, at.PUSH_1)
    mass_line = at.MASS_2 if second else at.MASS_1

    @inlined
    def push_point(lane, a_arm, b_arm, context, rate, s_inout, c_inout):
        """Change the gathered pseudo-velocities of two bodies, which separates their unloaded contact at the point.

        Nothing changes if the contact is loaded. lane: lane of the contact in the block c_inout; a_arm, b_arm [px]:
        moment arms of the normal impulse; context: see StepContext; rate [1/s]: see separation_speed; s_inout: gathered
        values.
        """
        c = c_inout
        s = s_inout
        nx = c[at.NX + lane]
        ny = c[at.NY + lane]
        old = c[push_line + lane]
        pushed = (s[at.PUSH_VX_B + lane] - s[at.PUSH_VX_A + lane]) * nx
        pushed += (s[at.PUSH_VY_B + lane] - s[at.PUSH_VY_A + lane]) * ny
        speed = (s[at.VX_B + lane] - s[at.VX_A + lane]) * nx + (s[at.VY_B + lane] - s[at.VY_A + lane]) * ny
        if rotation:
            pushed += s[at.PUSH_W_B + lane] * b_arm - s[at.PUSH_W_A + lane] * a_arm
            speed += s[at.W_B + lane] * b_arm - s[at.W_A + lane] * a_arm
        wanted = separation_speed(c[gap_line + lane], context.inverse_h, context.slop, rate, context.push_speed)
        impulse = old + c[mass_line + lane] * (wanted - speed - pushed)
        impulse = impulse if impulse > 0.0 else 0.0
        # A point that needs no push-out and has received none is handled by the contact impulses.
        idle = (c[at.LOADED + lane] > 0.0) | ((old == 0.0) & (pushed >= 0.0) & (wanted <= 0.0))
        impulse = old if idle else impulse
        c[push_line + lane] = impulse
        change = impulse - old
        s[at.PUSH_VX_A + lane] -= c[at.IM_A + lane] * change * nx
        s[at.PUSH_VY_A + lane] -= c[at.IM_A + lane] * change * ny
        s[at.PUSH_VX_B + lane] += c[at.IM_B + lane] * change * nx
        s[at.PUSH_VY_B + lane] += c[at.IM_B + lane] * change * ny
        if rotation:
            s[at.PUSH_W_A + lane] -= c[at.II_A + lane] * change * a_arm
            s[at.PUSH_W_B + lane] += c[at.II_B + lane] * change * b_arm

    return push_point


def make_push_pass(rotation: bool) -> Callable:
    """Return the function that makes one pass over all contacts and separates the unloaded contacts.

    rotation: whether bodies rotate.
    """
    push_first, push_second = make_push_point(False, rotation), make_push_point(True, rotation)

    @noalias
    def push_overlaps(
        # read, scalars
        count,
        context,
        rate,
        # write
        motions_inout,
        blocks_inout,
    ):
        """Give bodies pseudo-velocities that separate their unloaded contacts. O(count).

        count: number of blocks; context: see StepContext; rate [1/s]: see separation_speed. The impulses behind the
        pseudo-velocities are accumulated separately from the contact impulses. motions_inout: MOTION rows;
        blocks_inout: the contacts, see lanes.Blocks.
        """
        s = blocks_inout.gathered
        for block in range(count):
            c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
            wide = lanes_of(blocks_inout.contact, block)
            for lane in range(wide):
                a = motions_inout[blocks_inout.motion_a[block, lane]]
                b = motions_inout[blocks_inout.motion_b[block, lane]]
                gather_velocities(a, b, lane, s)
                s[at.PUSH_VX_A + lane] = a.pseudo_vx
                s[at.PUSH_VY_A + lane] = a.pseudo_vy
                s[at.PUSH_W_A + lane] = a.pseudo_w
                s[at.PUSH_VX_B + lane] = b.pseudo_vx
                s[at.PUSH_VY_B + lane] = b.pseudo_vy
                s[at.PUSH_W_B + lane] = b.pseudo_w
            for lane in range(wide):
                a_1, b_1, a_2, b_2 = c[at.A_1 + lane], c[at.B_1 + lane], c[at.A_2 + lane], c[at.B_2 + lane]
                push_first(lane, a_1, b_1, context, rate, s, c)
                push_second(lane, a_2, b_2, context, rate, s, c)
            for lane in range(wide):
                a = motions_inout[blocks_inout.motion_a[block, lane]]
                b = motions_inout[blocks_inout.motion_b[block, lane]]
                a.pseudo_vx = s[at.PUSH_VX_A + lane]
                a.pseudo_vy = s[at.PUSH_VY_A + lane]
                a.pseudo_w = s[at.PUSH_W_A + lane]
                b.pseudo_vx = s[at.PUSH_VX_B + lane]
                b.pseudo_vy = s[at.PUSH_VY_B + lane]
                b.pseudo_w = s[at.PUSH_W_B + lane]

    return push_overlaps


@subkernel
def stop_impacts(count, motions_inout, blocks_inout):
    """Remove the approach speed that the solver passes left at impacts, which are contacts with the field BOUNCING.

    Only points with a normal impulse are changed, because they would hit again in the next step if they still
    approached. Slow contacts are excluded: in loaded stacks the passes leave a small approach speed, which the next
    step removes. count: number of blocks. motions_inout: MOTION rows; blocks_inout: the contacts, see lanes.Blocks.
    O(lanes).
    """
    for block in range(count):
        c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(lanes_of(blocks_inout.contact, block)):
            if c[at.BOUNCING + lane] == 0.0:
                continue
            a = motions_inout[blocks_inout.motion_a[block, lane]]
            b = motions_inout[blocks_inout.motion_b[block, lane]]
            for point in range(2):
                line = (at.NORMAL_1 if point == 0 else at.NORMAL_2) + lane
                if c[line] > 0.0 and relative_speed(c, lane, point == 1, a, b) < 0.0:
                    c[line] += bounce_once(0.0, c, lane, point == 1, c[line], a, b)


@subkernel
def sum_up(count, blocks_inout):
    """Copy the contact impulses to the totals of the step, because this step has only one substep. O(lanes).

    count: number of blocks. blocks_inout: the contacts, see lanes.Blocks.
    """
    for block in range(count):
        c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(lanes_of(blocks_inout.contact, block)):
            c[at.TOTAL_1 + lane] = c[at.NORMAL_1 + lane]
            c[at.TOTAL_2 + lane] = c[at.NORMAL_2 + lane]
            c[at.TANGENT_TOTAL_1 + lane] = c[at.TANGENT_1 + lane]
            c[at.TANGENT_TOTAL_2 + lane] = c[at.TANGENT_2 + lane]


@subkernel
def turns_any(count, blocks):
    """Return whether the first `count` blocks contain a round contact whose moment arms change within the step."""
    for block in range(count):
        if blocks.turns[block]:
            return True
    return False


@subkernel
def foresee_turns(members, kinematic, time, count, motions_inout, blocks_inout):
    """Write normals and moment arms of round contacts at the poses predicted for `time` [s] later. O(members + lanes).

    members, kinematic: indices of MOTION rows; count: number of blocks. The bodies are moved to the predicted poses,
    and then back to the poses at the start of the step. blocks_inout: the contacts, see lanes.Blocks.
    """
    for k in range(len(members)):
        m = motions_inout[members[k]]
        m.dx, m.dy = time * m.vx, time * m.vy
        m.cosine, m.sine = rotation_of(time * m.angular_velocity)
    move_kinematic(kinematic, time, motions_inout)
    turn_arms(count, motions_inout, blocks_inout)
    for k in range(len(members)):
        m = motions_inout[members[k]]
        m.dx, m.dy, m.cosine, m.sine = 0.0, 0.0, 1.0, 0.0
    move_kinematic(kinematic, 0.0, motions_inout)


SOLVE = {(r, f): make_sequential_pass(rotation=r, friction=f) for r in BOTH for f in BOTH}
PUSH_OUT = {r: make_push_pass(rotation=r) for r in BOTH}


def make_passes(drag: bool, rotation: bool, friction: bool, joints: bool) -> Callable:
    """Return the kernel that runs all passes of a step.

    drag, rotation, friction, joints: whether the world has these effects.
    """
    velocities, positions = SUBSTEP_VELOCITIES[drag, rotation], SUBSTEP_POSITIONS[rotation]
    warm_start, solve_all, push_out = WARM_LANES[rotation], SOLVE[rotation, friction], PUSH_OUT[rotation]

    @kernel
    def run_passes(
        # read
        members,
        kinematic,
        count,
        context,
        passes,
        # write
        motions_inout,
        joints_inout,
        blocks_inout,
    ):
        """Advance island bodies and kinematic bodies by one step. O(members + passes · constraints).

        members, kinematic: indices of MOTION rows; count: number of blocks; context: see StepContext; passes: see
        Passes; joints_inout: a JointSet, or 0 in a world without joints; blocks_inout: the contacts.
        """
        if not passes.warm:
            clear_impulses(members, count, motions_inout, blocks_inout)
        if joints:
            begin_substep(context, motions_inout, joints_inout)
        velocities(members, context.h, context.drag, motions_inout)
        if rotation and turns_any(count, blocks_inout):
            foresee_turns(members, kinematic, LEAD * context.h, count, motions_inout, blocks_inout)
        if joints:
            begin_trees(context, joints_inout, motions_inout)
            if len(joints_inout.order) > 0:
                follow_inertias(count, motions_inout, blocks_inout)
        warm_start(count, motions_inout, blocks_inout)
        if joints:
            start_joints(True, context, joints_inout, motions_inout)
        for n in range(passes.count):
            if joints and n > 0:
                solve_once(True, context, joints_inout, motions_inout)
            solve_all(count, context, passes, motions_inout, blocks_inout)
        if joints:
            any_wide = solve_all_trees(True, context, joints_inout, motions_inout)
        for block in range(count):
            c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
            for lane in range(lanes_of(blocks_inout.contact, block)):
                c[at.PUSH_1 + lane] = 0.0
                c[at.PUSH_2 + lane] = 0.0
        for _ in range(PUSH_PASSES):
            push_out(count, context, passes.push_rate, motions_inout, blocks_inout)
        if joints:
            close_gaps(any_wide, context, joints_inout, motions_inout)
        positions(members, context.h, context.push_speed, motions_inout)
        move_kinematic(kinematic, context.h, motions_inout)
        if joints:
            accelerate_again(members, context.h, motions_inout)
            finish_joints(context, joints_inout, motions_inout)
            end_joints(joints_inout)
        stop_impacts(count, motions_inout, blocks_inout)
        sum_up(count, blocks_inout)

    return run_passes


PASSES = {
    (d, r, f, j): make_passes(drag=d, rotation=r, friction=f, joints=j)
    for d in BOTH
    for r in BOTH
    for f in BOTH
    for j in BOTH
}


def solve(state: StepState, contacts: ContactLanes, passes: int | None = None, warm: bool = True) -> float:
    """Solve the constraints of a step and move the bodies. Return the step length [s].

    contacts: ContactLanes of the world. The last two arguments are for measurements (studied_solvers.py). passes:
    number of passes, None: as many as the loads need, see ITERATIONS_PER_SUBSTEP. warm: whether the passes start from
    the cached impulses.
    """
    effects, motions, tolerances, dt = state.effects, state.workspace.motions, state.tolerances, state.dt
    run = PASSES[effects.drag, effects.rotation, effects.friction, effects.joints]
    context = context_of(1, False, dt, state.span, state.drag, tolerances)
    bias_rate = BAUMGARTE / state.span  # a step shorter than span does not separate faster
    substeps = state.substeps if passes is None else AUTO_SUBSTEPS[0]
    for group in contacts.choose(state, motions, substeps):
        blocks, count = contacts.prepare(state, motions, group, context)
        settings = Passes(
            count=passes or math.ceil(ITERATIONS_PER_SUBSTEP * group.substeps),
            warm=warm,
            bias_rate=bias_rate,
            bias_speed=bias_rate * tolerances.speculative,
            push_rate=PUSH_SHARE / state.span,
        )
        found = contacts.joints(state, motions, group, context.h) if effects.joints else 0
        run(group.members, motions.kinematic, count, context, settings, motions.used, found, blocks)
        if substeps == 0:
            estimate_substeps(state, motions, contacts.selection.plan, group, blocks, count, found)
        contacts.store(state, motions, count, context)
        if len(group.joints):
            store_joints(group.joints, context, state.joints)
            state.work[CAP_HITS] += contacts.trees.schur.counts[2]
        lists, plan, moving = motions.lists, contacts.selection.plan, len(motions.kinematic)
        limit_energy(blocks, count, group, lists.links_islands, moving, context, plan, lists.balance, motions.used)
    return dt


@stage("sequential_impulse", reads=READS, writes=WRITES)
def sequential_impulse(state: StepState) -> None:
    """Solve the contacts and joints by sequential impulses, and move the bodies."""
    run_solver(state, solve)
