"""Soft step: a solver with small substeps and soft contacts, and its passes over lanes of contacts."""

import math
from collections.abc import Callable, Mapping

from physics.jit import inlined, kernel, noalias, subkernel
from physics.settings import BLOW_GIVE, CALM_SHARE
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
    start_joints,
)
from physics.solver.joint_report import store_joints
from physics.solver.lanes import (
    IN_CONTACT,
    SIZE,
    UNLOADED,
    gather_poses,
    gather_velocities,
    lanes_of,
    make_friction,
    measure_gaps,
    resist_rolling,
    scatter_velocities,
    solve_two,
    write_arms,
    write_masses,
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
from physics.solver.step_context import context_of, separation_speed
from physics.tables.step_state import CAP_HITS, StepState, stage

# ---- soft pass -------------------------------------------------------------------------------------------------------
# Passes of the soft step over blocks of lanes; see lanes.py for the layout.
#
# The velocities of the bodies of a block are gathered, its contacts are solved side by side without a branch, and the
# velocities are written back. Push-out by pseudo-velocity is rare, and is done one contact after another. Sources: see
# "soft step" below.

BOTH = (False, True)


@subkernel
def push_out_unloaded(c, lane, context, rotation, a_inout, b_inout):
    """Separate two bodies at both points of an unloaded contact, by pseudo-velocities.

    c, lane: the contact's lane in a block; context: see StepContext; rotation: whether bodies rotate; a_inout, b_inout:
    MOTION rows.
    """
    nx = c[at.NX + lane]
    ny = c[at.NY + lane]
    a = a_inout
    b = b_inout
    a_1, b_1, a_2, b_2 = c[at.A_1 + lane], c[at.B_1 + lane], c[at.A_2 + lane], c[at.B_2 + lane]
    speed_1 = (b.vx - a.vx) * nx + (b.vy - a.vy) * ny
    speed_2 = speed_1
    k_12 = c[at.IM_A + lane] + c[at.IM_B + lane]
    if rotation:
        speed_1 += b.angular_velocity * b_1 - a.angular_velocity * a_1
        speed_2 += b.angular_velocity * b_2 - a.angular_velocity * a_2
        k_12 += c[at.II_A + lane] * a_1 * a_2 + c[at.II_B + lane] * b_1 * b_2
    pushed = (b.pseudo_vx - a.pseudo_vx) * nx + (b.pseudo_vy - a.pseudo_vy) * ny
    total = speed_1 + pushed
    if rotation:
        total += b.pseudo_w * b_1 - a.pseudo_w * a_1
    wanted = separation_speed(
        c[at.GAP_1 + lane], context.inverse_h, context.slop, context.push_rate, context.push_speed
    )
    push_1 = max(c[at.MASS_1 + lane] * (wanted - total), 0.0)
    total = speed_2 + pushed + k_12 * push_1
    if rotation:
        total += b.pseudo_w * b_2 - a.pseudo_w * a_2
    wanted = separation_speed(
        c[at.GAP_2 + lane], context.inverse_h, context.slop, context.push_rate, context.push_speed
    )
    push_2 = max(c[at.MASS_2 + lane] * (wanted - total), 0.0)
    if push_1 + push_2 > 0.0:
        x = (push_1 + push_2) * nx
        y = (push_1 + push_2) * ny
        a_inout.pseudo_vx -= a.inverse_mass * x
        a_inout.pseudo_vy -= a.inverse_mass * y
        b_inout.pseudo_vx += b.inverse_mass * x
        b_inout.pseudo_vy += b.inverse_mass * y
        if rotation:
            a_inout.pseudo_w -= a.inverse_inertia * (push_1 * a_1 + push_2 * a_2)
            b_inout.pseudo_w += b.inverse_inertia * (push_1 * b_1 + push_2 * b_2)


@inlined
def rigid_change(speed, gap, mass, inverse_h):
    """Return the change of normal impulse that stops the approach of a contact point, as a rigid contact does.

    If there is a gap [px], the point keeps the approach speed that closes the gap by the end of this substep. speed
    [px/s]: negative for an approach; mass: effective mass; inverse_h [1/s]: inverse of a substep.
    """
    return -mass * (speed + gap * inverse_h if gap > 0.0 else speed)


@inlined
def soft_change(speed, gap, mass, old, bias_rate, impulse_scale, most):
    """Return the change of normal impulse at a contact point that acts as a damped spring.

    speed [px/s]: negative for an approach; gap [px]: negative for an overlap; mass: effective mass; old: accumulated
    impulse; bias_rate [1/s]: see Softness; impulse_scale: 1 / (1 + grip), see Softness; most [px/s]: greatest
    separation speed.
    """
    grip = 1.0 - impulse_scale
    bias = grip * bias_rate * gap
    bias = -most if bias < -most else bias
    return -mass * (grip * speed + bias) - impulse_scale * old


@inlined
def greatest_separation_speed(c, lane, gap_1, gap_2, context):
    """Return the greatest speed [px/s] at which a contact may separate.

    A deep overlap separates no faster with many substeps than with the fewest. A shallow overlap may separate faster,
    so that the contact carries its load. c, lane: the contact's lane in a block; gap_1, gap_2 [px]: separations at its
    points; context: see StepContext.
    """
    most = context.push_speed * abs(c[at.PUSH_OUT_SHARE + lane])
    deep = -gap_2 if gap_2 < gap_1 else -gap_1
    slow = context.deep_rate * deep
    slow = slow if slow > context.shallow_speed else context.shallow_speed
    return slow if (context.deep_rate > 0.0) & (slow < most) else most


@inlined
def angular_impulses(lane, c):
    """Return the angular impulses (on_a, on_b) of a contact about the centres of A and B, without rolling resistance.

    Both are computed from the impulse that acts on B. So the angular velocity of B changes by on_b, and that of A by
    -on_a (each times the inverse inertia). c, lane: the contact's lane in a block.
    """
    n_1 = c[at.NORMAL_1 + lane]
    n_2 = c[at.NORMAL_2 + lane]
    t_1 = c[at.TANGENT_1 + lane]
    t_2 = c[at.TANGENT_2 + lane]
    on_a = n_1 * c[at.A_1 + lane] + t_1 * c[at.TANGENT_A_1 + lane]
    on_b = n_1 * c[at.B_1 + lane] + t_1 * c[at.TANGENT_B_1 + lane]
    on_a += n_2 * c[at.A_2 + lane] + t_2 * c[at.TANGENT_A_2 + lane]
    on_b += n_2 * c[at.B_2 + lane] + t_2 * c[at.TANGENT_B_2 + lane]
    return on_a, on_b


def make_warm_lanes(rotation: bool) -> Callable:
    """Return the function that applies the cached impulses (warm start). rotation: whether bodies rotate."""

    @noalias
    def warm_lanes(
        # read
        count,
        # write
        motions_inout,
        blocks_inout,
    ):
        """Apply the cached impulses of all contacts to their bodies (warm start). O(count).

        count: number of blocks; motions_inout: MOTION rows; blocks_inout: the contacts, see lanes.Blocks.
        """
        s = blocks_inout.gathered
        for block in range(count):
            c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
            wide = lanes_of(blocks_inout.contact, block)
            for lane in range(wide):
                gather_velocities(
                    motions_inout[blocks_inout.motion_a[block, lane]],
                    motions_inout[blocks_inout.motion_b[block, lane]],
                    lane,
                    s,
                )
            for lane in range(wide):
                nx = c[at.NX + lane]
                ny = c[at.NY + lane]
                x = c[at.NORMAL_1 + lane] * nx - c[at.TANGENT_1 + lane] * ny
                y = c[at.NORMAL_1 + lane] * ny + c[at.TANGENT_1 + lane] * nx
                u = c[at.NORMAL_2 + lane] * nx - c[at.TANGENT_2 + lane] * ny
                v = c[at.NORMAL_2 + lane] * ny + c[at.TANGENT_2 + lane] * nx
                if rotation:
                    a_turn, b_turn = angular_impulses(lane, c)
                    a_turn += c[at.ROLLING + lane]
                    b_turn += c[at.ROLLING + lane]
                    s[at.W_A + lane] -= c[at.II_A + lane] * a_turn
                    s[at.W_B + lane] += c[at.II_B + lane] * b_turn
                s[at.VX_A + lane] -= c[at.IM_A + lane] * (x + u)
                s[at.VY_A + lane] -= c[at.IM_A + lane] * (y + v)
                s[at.VX_B + lane] += c[at.IM_B + lane] * (x + u)
                s[at.VY_B + lane] += c[at.IM_B + lane] * (y + v)
            for lane in range(wide):
                scatter_velocities(
                    s,
                    lane,
                    motions_inout[blocks_inout.motion_a[block, lane]],
                    motions_inout[blocks_inout.motion_b[block, lane]],
                )

    return warm_lanes


@subkernel
def clear_impulses(members, count, motions_inout, blocks_inout):
    """Clear the impulses from which a substep would start, to measure the effect of warm starting. O(members + count).

    members: indices of MOTION rows; count: number of blocks. blocks_inout: the contacts, see lanes.Blocks.
    """
    for i in range(len(members)):
        m = motions_inout[members[i]]
        m.free_vx = m.vx
        m.free_vy = m.vy
        m.free_w = m.angular_velocity
    for block in range(count):
        c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
        wide = lanes_of(blocks_inout.contact, block)
        for lane in range(wide):
            c[at.NORMAL_1 + lane] = 0.0
            c[at.TANGENT_1 + lane] = 0.0
            c[at.NORMAL_2 + lane] = 0.0
            c[at.TANGENT_2 + lane] = 0.0
            c[at.ROLLING + lane] = 0.0


def make_soft_pass(biased: bool, rotation: bool, friction: bool, alone: bool = False) -> Callable:
    """Return the function that solves all contacts once, either with bias or as a relaxing pass.

    biased: True for the pass with bias, which separates overlaps. False for the relaxing pass, which measures gaps,
    applies friction and sums impulses. alone: True if no relaxing pass follows; the pass with bias then also does the
    work of the relaxing pass. rotation, friction: whether the world has these effects.
    """
    last = alone or not biased
    rubs = friction and last
    friction_1, friction_2 = make_friction(False, rotation, True), make_friction(True, rotation, True)

    @noalias
    def solve_soft(
        # read, scalars
        count,
        context,
        # write
        motions_inout,
        blocks_inout,
    ):
        """Solve every contact once. O(count).

        count: number of blocks; context: see StepContext; motions_inout: MOTION rows; blocks_inout: the contacts, see
        lanes.Blocks.
        """
        calm_speed = CALM_SHARE * context.push_speed
        s = blocks_inout.gathered
        for block in range(count):
            c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
            wide = lanes_of(blocks_inout.contact, block)
            for lane in range(wide):
                a = motions_inout[blocks_inout.motion_a[block, lane]]
                b = motions_inout[blocks_inout.motion_b[block, lane]]
                gather_velocities(a, b, lane, s)
                if last:
                    gather_poses(a, b, lane, s)
            for lane in range(wide):
                nx = c[at.NX + lane]
                ny = c[at.NY + lane]
                ii_a = c[at.II_A + lane]
                ii_b = c[at.II_B + lane]
                masses = c[at.IM_A + lane] + c[at.IM_B + lane]
                a_1, b_1, a_2, b_2 = c[at.A_1 + lane], c[at.B_1 + lane], c[at.A_2 + lane], c[at.B_2 + lane]
                if last:
                    measure_gaps(lane, s, c)
                gap_1 = c[at.GAP_1 + lane]
                gap_2 = c[at.GAP_2 + lane]
                wa = s[at.W_A + lane]
                wb = s[at.W_B + lane]
                vx = s[at.VX_B + lane] - s[at.VX_A + lane]
                vy = s[at.VY_B + lane] - s[at.VY_A + lane]
                speed_1 = vx * nx + vy * ny
                speed_2 = speed_1
                if rotation:
                    speed_1 += wb * b_1 - wa * a_1
                    speed_2 += wb * b_2 - wa * a_2
                old_1 = c[at.NORMAL_1 + lane]
                old_2 = c[at.NORMAL_2 + lane]
                mass_1 = c[at.MASS_1 + lane]
                mass_2 = c[at.MASS_2 + lane]
                change_1 = rigid_change(speed_1, gap_1, mass_1, context.inverse_h)
                change_2 = rigid_change(speed_2, gap_2, mass_2, context.inverse_h)
                unloaded = False
                if biased:
                    # A soft contact would let a fast body sink in. So an approaching contact is rigid until it is
                    # loaded, and soft afterwards.
                    loaded = (old_1 > calm_speed * mass_1) | (old_2 > calm_speed * mass_2)
                    not_approaching = (speed_1 >= -calm_speed) & (speed_2 >= -calm_speed)
                    rate = c[at.BIAS_RATE + lane]
                    impulse_scale = c[at.IMPULSE_SCALE + lane]
                    # If an impact impulse is kept in full from substep to substep, the body bounces.
                    impulse_scale = (
                        impulse_scale + BLOW_GIVE if old_1 + old_2 > c[at.STRIKE_LIMIT + lane] else impulse_scale
                    )
                    most = greatest_separation_speed(c, lane, gap_1, gap_2, context)
                    soft_1 = soft_change(speed_1, gap_1, mass_1, old_1, rate, impulse_scale, most)
                    soft_2 = soft_change(speed_2, gap_2, mass_2, old_2, rate, impulse_scale, most)
                    change_1 = soft_1 if (not_approaching | loaded) & (gap_1 <= 0.0) else change_1
                    change_2 = soft_2 if (not_approaching | loaded) & (gap_2 <= 0.0) else change_2
                    # An unloaded contact that did not approach before the step separates by pseudo-velocity alone.
                    unloaded = not_approaching & (not loaded) & (c[at.PUSH_OUT_SHARE + lane] < 0.0)
                else:
                    # The pass with bias of the next substep handles a gap that closes.
                    carried = old_1 + old_2 + c[at.TOTAL_1 + lane] + c[at.TOTAL_2 + lane]
                    apart = (gap_1 > 0.0) & (gap_2 > 0.0) & (carried == 0.0)
                    change_1 = 0.0 if apart else change_1
                    change_2 = 0.0 if apart else change_2
                # Both points are solved together, otherwise the first would rotate the body: a standing box would lean.
                impulse_1, impulse_2 = solve_two(
                    change_1,
                    change_2,
                    c[at.OFF_DIAGONAL_1 + lane],
                    c[at.OFF_DIAGONAL_2 + lane],
                    c[at.BLOCK_FACTOR + lane],
                    old_1,
                    old_2,
                )
                impulse_1 = impulse_1 if impulse_1 < c[at.MOST + lane] else c[at.MOST + lane]
                impulse_2 = impulse_2 if impulse_2 < c[at.MOST + lane] else c[at.MOST + lane]
                impulse_1 = 0.0 if unloaded else impulse_1
                impulse_2 = 0.0 if unloaded else impulse_2
                c[at.NORMAL_1 + lane] = impulse_1
                c[at.NORMAL_2 + lane] = impulse_2
                if biased:
                    in_contact = (c[at.RESTING + lane] > 0.0) | (impulse_1 + impulse_2 > 0.0)
                    s[at.OUTCOME + lane] = (IN_CONTACT if in_contact else 0.0) + (UNLOADED if unloaded else 0.0)
                if last:
                    c[at.TOTAL_1 + lane] += impulse_1
                    c[at.TOTAL_2 + lane] += impulse_2
                change = impulse_1 - old_1 + impulse_2 - old_2
                x = change * nx  # sums of the impulses on B
                y = change * ny
                vx += masses * x
                vy += masses * y
                if rotation:
                    wa -= ii_a * ((impulse_1 - old_1) * a_1 + (impulse_2 - old_2) * a_2)
                    wb += ii_b * ((impulse_1 - old_1) * b_1 + (impulse_2 - old_2) * b_2)
                # Friction follows the relaxed normal impulses: the excess by the bias does not count as pressure.
                if rubs:
                    if rotation:
                        wa, wb = resist_rolling(lane, wa, wb, impulse_1 + impulse_2, c)
                    dx, dy, wa, wb = friction_1(lane, vx, vy, wa, wb, impulse_1, c)
                    vx += masses * dx
                    vy += masses * dy
                    dx_2, dy_2, wa, wb = friction_2(lane, vx, vy, wa, wb, impulse_2, c)
                    x = x + dx + dx_2
                    y = y + dy + dy_2
                s[at.VX_A + lane] -= c[at.IM_A + lane] * x
                s[at.VY_A + lane] -= c[at.IM_A + lane] * y
                s[at.VX_B + lane] += c[at.IM_B + lane] * x
                s[at.VY_B + lane] += c[at.IM_B + lane] * y
                if rotation:
                    s[at.W_A + lane] = wa
                    s[at.W_B + lane] = wb
            for lane in range(wide):
                a = motions_inout[blocks_inout.motion_a[block, lane]]
                b = motions_inout[blocks_inout.motion_b[block, lane]]
                if biased and s[at.OUTCOME + lane] > 0.0:
                    if s[at.OUTCOME + lane] >= UNLOADED:
                        push_out_unloaded(c, lane, context, rotation, a, b)
                    if s[at.OUTCOME + lane] != UNLOADED:
                        a.in_contact = True
                        b.in_contact = True
                scatter_velocities(s, lane, a, b)

    return solve_soft


PUSH_OUT = {r: make_soft_pass(biased=True, rotation=r, friction=False) for r in BOTH}
RELAX = {(r, f): make_soft_pass(biased=False, rotation=r, friction=f) for r in BOTH for f in BOTH}
WARM_LANES = {r: make_warm_lanes(rotation=r) for r in BOTH}


@inlined
def turn_normal(lane, s, c_inout):
    """Write the normal of a round contact at the present poses, and adapt BASE_1 and BASE_2 to this normal.

    The lane field TURNS determines how the normal follows the bodies. lane: lane of the contact in the block c_inout;
    s: gathered poses, see lanes.GATHERED.
    """
    c = c_inout
    turns = c[at.TURNS + lane]
    of_a = turns == at.NORMAL_OF_A
    of_b = turns == at.NORMAL_OF_B
    cosine = s[at.COS_A + lane] if of_a else (s[at.COS_B + lane] if of_b else 1.0)
    sine = s[at.SIN_A + lane] if of_a else (s[at.SIN_B + lane] if of_b else 0.0)
    start_x = c[at.START_NX + lane]
    start_y = c[at.START_NY + lane]
    nx = cosine * start_x - sine * start_y
    ny = sine * start_x + cosine * start_y
    # Vector from the core of A to the core of B; cores are shapes without their radius.
    apart_x = c[at.BX_1 + lane] - c[at.AX_1 + lane]
    apart_y = c[at.BY_1 + lane] - c[at.AY_1 + lane]
    x = c[at.BX_1 + lane] + c[at.RADIUS_B + lane] * start_x
    y = c[at.BY_1 + lane] + c[at.RADIUS_B + lane] * start_y
    dx = s[at.DX_B + lane] - s[at.DX_A + lane] - apart_x + s[at.COS_B + lane] * x - s[at.SIN_B + lane] * y
    dy = s[at.DY_B + lane] - s[at.DY_A + lane] - apart_y + s[at.SIN_B + lane] * x + s[at.COS_B + lane] * y
    x = c[at.AX_1 + lane] - c[at.RADIUS_A + lane] * start_x
    y = c[at.AY_1 + lane] - c[at.RADIUS_A + lane] * start_y
    dx -= s[at.COS_A + lane] * x - s[at.SIN_A + lane] * y
    dy -= s[at.SIN_A + lane] * x + s[at.COS_A + lane] * y
    length = math.sqrt(dx * dx + dy * dy)
    of_cores = (turns == at.NORMAL_OF_CORES) & (length > 0.0)
    over = 1.0 / (length if length > 0.0 else 1.0)
    nx = dx * over if of_cores else nx
    ny = dy * over if of_cores else ny
    c[at.BASE_1 + lane] += apart_x * (c[at.NX + lane] - nx) + apart_y * (c[at.NY + lane] - ny)
    c[at.BASE_2 + lane] = c[at.BASE_1 + lane] if turns >= at.NORMAL_OF_A else c[at.BASE_2 + lane]
    c[at.NX + lane] = nx
    c[at.NY + lane] = ny


@inlined
def follow_core(lane, s, c_inout):
    """Update the moment arms of the body with the face, in a contact between a face and a round shape.

    The core of the round shape is the shape without its radius. If the core has moved along the face, the arms move
    with it. Only contacts whose lane field TURNS is NORMAL_OF_A or NORMAL_OF_B change. lane, s, c_inout: see
    turn_normal.
    """
    c = c_inout
    turns = c[at.TURNS + lane]
    of_a = turns == at.NORMAL_OF_A
    of_b = turns == at.NORMAL_OF_B
    nx = c[at.NX + lane]
    ny = c[at.NY + lane]
    x = s[at.DX_B + lane] - s[at.DX_A + lane] + c[at.AX_1 + lane] - c[at.BX_1 + lane]
    y = s[at.DY_B + lane] - s[at.DY_A + lane] + c[at.AY_1 + lane] - c[at.BY_1 + lane]
    across = x * ny - y * nx
    along = x * nx + y * ny
    c[at.A_1 + lane] = c[at.B_1 + lane] + across if of_a else c[at.A_1 + lane]
    c[at.TANGENT_A_1 + lane] = c[at.TANGENT_B_1 + lane] + along if of_a else c[at.TANGENT_A_1 + lane]
    c[at.B_1 + lane] = c[at.A_1 + lane] - across if of_b else c[at.B_1 + lane]
    c[at.TANGENT_B_1 + lane] = c[at.TANGENT_A_1 + lane] - along if of_b else c[at.TANGENT_B_1 + lane]


@noalias
def turn_arms(count, motions_inout, blocks_inout):
    """Write the normals, moment arms and effective masses of contacts with a round shape at the present poses.

    The next substep then starts with impulses at the new arms, and along the new normals (see turn_impulses). With the
    former arms and normals, torques and forces would lag behind the motion and add energy. count: number of blocks.
    motions_inout: MOTION rows; blocks_inout: the contacts, see lanes.Blocks. O(count).
    """
    s = blocks_inout.gathered
    for block in range(count):
        if not blocks_inout.turns[block]:
            continue
        c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
        wide = lanes_of(blocks_inout.contact, block)
        for lane in range(wide):
            a = motions_inout[blocks_inout.motion_a[block, lane]]
            b = motions_inout[blocks_inout.motion_b[block, lane]]
            gather_poses(a, b, lane, s)
        for lane in range(wide):
            turns = c[at.TURNS + lane] != at.FIXED
            cos_a = s[at.COS_A + lane] if turns else 1.0
            sin_a = s[at.SIN_A + lane] if turns else 0.0
            cos_b = s[at.COS_B + lane] if turns else 1.0
            sin_b = s[at.SIN_B + lane] if turns else 0.0
            c[at.LAST_NX + lane] = c[at.NX + lane]
            c[at.LAST_NY + lane] = c[at.NY + lane]
            c[at.LAST_NORMAL + lane] = c[at.NORMAL_1 + lane] + c[at.NORMAL_2 + lane]
            c[at.LAST_TANGENT + lane] = c[at.TANGENT_1 + lane] + c[at.TANGENT_2 + lane]
            before_a, before_b = angular_impulses(lane, c)
            turn_normal(lane, s, c)
            write_arms(lane, cos_a, sin_a, cos_b, sin_b, c)
            follow_core(lane, s, c)
            write_masses(lane, c)
            on_a, on_b = angular_impulses(lane, c)
            s[at.W_A + lane] = c[at.II_A + lane] * (on_a - before_a)
            s[at.W_B + lane] = c[at.II_B + lane] * (on_b - before_b)
        for lane in range(wide):
            motions_inout[blocks_inout.motion_a[block, lane]].free_w += s[at.W_A + lane]
            motions_inout[blocks_inout.motion_b[block, lane]].free_w -= s[at.W_B + lane]


@noalias
def turn_impulses(count, motions_inout, blocks_inout):
    """Rotate the impulses of contacts with a round shape to their present normals, after the relaxing pass. O(count).

    The next substep starts with these impulses. The relaxing pass removed part of the impulses along the present
    normals, although they had been applied along the former normals. This error of the velocities is corrected. count:
    number of blocks. motions_inout: MOTION rows; blocks_inout: the contacts, see lanes.Blocks.
    """
    for block in range(count):
        if not blocks_inout.turns[block]:
            continue
        c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(lanes_of(blocks_inout.contact, block)):
            a = motions_inout[blocks_inout.motion_a[block, lane]]
            b = motions_inout[blocks_inout.motion_b[block, lane]]
            nx = c[at.LAST_NX + lane] - c[at.NX + lane]
            ny = c[at.LAST_NY + lane] - c[at.NY + lane]
            normal = c[at.NORMAL_1 + lane] + c[at.NORMAL_2 + lane]
            tangent = c[at.TANGENT_1 + lane] + c[at.TANGENT_2 + lane]
            kept_x, kept_y = normal * nx - tangent * ny, normal * ny + tangent * nx
            normal = c[at.LAST_NORMAL + lane] - normal
            tangent = c[at.LAST_TANGENT + lane] - tangent
            removed_x, removed_y = normal * nx - tangent * ny, normal * ny + tangent * nx
            a.free_vx -= c[at.IM_A + lane] * kept_x
            a.free_vy -= c[at.IM_A + lane] * kept_y
            a.vx += c[at.IM_A + lane] * removed_x
            a.vy += c[at.IM_A + lane] * removed_y
            b.free_vx += c[at.IM_B + lane] * kept_x
            b.free_vy += c[at.IM_B + lane] * kept_y
            b.vx -= c[at.IM_B + lane] * removed_x
            b.vy -= c[at.IM_B + lane] * removed_y


@subkernel
def follow_inertias(count, motions, blocks_inout):
    """Write the present inverse inertias of bodies to the lanes of their contacts, and update the effective masses.

    Tension in a tree of joints raises the inertia of its links (see joint_direct.add_inertia). Contacts must use the
    same inertia, because passes over constraints with different masses of a body need not converge. count: number of
    blocks; motions: MOTION rows; blocks_inout: the contacts, see lanes.Blocks. O(lanes).
    """
    for block in range(count):
        c = blocks_inout.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(lanes_of(blocks_inout.contact, block)):
            on_a = motions[blocks_inout.motion_a[block, lane]].inverse_inertia
            on_b = motions[blocks_inout.motion_b[block, lane]].inverse_inertia
            if on_a == c[at.II_A + lane] and on_b == c[at.II_B + lane]:
                continue
            c[at.II_A + lane] = on_a
            c[at.II_B + lane] = on_b
            write_masses(lane, c)
            c[at.ROLLING_MASS + lane] = 1.0 / (on_a + on_b) if on_a + on_b > 0.0 else 0.0


# ---- soft step -------------------------------------------------------------------------------------------------------
# Small substeps with soft contacts: each substep has one pass with springs that separate overlaps, and a relaxing pass.
#
# Unlike `sequential_impulse`, the step is divided into substeps of one pass each, and a loaded contact is a damped
# spring. Unloaded contacts separate by a pseudo-velocity. Cost per substep: two to three passes over the constraints,
# two over the bodies. Sources: Macklin et al., Small Steps in Physics Simulation, SCA 2019; Catto, Soft
# Constraints, GDC 2011, and Solver2D, 2024: contacts as damped springs, friction in the relaxing pass alone.


def make_substeps(
    drag: bool,
    rotation: bool,
    friction: bool,
    joints: bool = False,
    iterations: int = 1,
    warm: bool = True,
    relaxed: bool = True,
) -> Callable:
    """Return the kernel that runs all substeps of a step.

    drag, rotation, friction, joints: whether the world has these effects. The last three arguments are for measurements
    (studied_solvers.py). iterations: number of passes with bias in a substep; warm: whether each substep starts from
    the impulses of the last substep; relaxed: whether a relaxing pass follows. If False, the pass with bias applies
    friction.
    """
    velocities, positions = SUBSTEP_VELOCITIES[drag, rotation], SUBSTEP_POSITIONS[rotation]
    warm_start, push_out, relax = WARM_LANES[rotation], PUSH_OUT[rotation], RELAX[rotation, friction]
    if not relaxed:
        push_out = make_soft_pass(biased=True, rotation=rotation, friction=friction, alone=True)

    @kernel
    def run_substeps(
        # read
        members,
        kinematic,
        count,
        context,
        # write
        motions_inout,
        joints_inout,
        blocks_inout,
    ):
        """Advance island bodies and kinematic bodies by all substeps of a step. O(substeps · (members + constraints)).

        members, kinematic: indices of MOTION rows; count: number of blocks; context: see StepContext; joints_inout: a
        JointSet, or 0 in a world without joints. All substeps are in one kernel: with ten boxes, calls from Python took
        five sixths of the time of a substep. blocks_inout: the contacts, see lanes.Blocks.
        """
        h = context.h
        if joints:
            begin_trees(context, joints_inout, motions_inout)
        move_kinematic(kinematic, 0.0, motions_inout)
        for n in range(context.substeps):
            if not warm:
                clear_impulses(members, count, motions_inout, blocks_inout)
            if joints:
                begin_substep(context, motions_inout, joints_inout)
            velocities(members, h, context.drag, motions_inout)
            if warm and n == 0:
                warm_start(count, motions_inout, blocks_inout)
            if joints:
                start_joints(n == 0, context, joints_inout, motions_inout)
            for _ in range(iterations):
                push_out(count, context, motions_inout, blocks_inout)
            if joints:
                any_wide = solve_all_trees(True, context, joints_inout, motions_inout)
                close_gaps(any_wide, context, joints_inout, motions_inout)
            positions(members, h, context.push_speed, motions_inout)
            move_kinematic(kinematic, (n + 1) * h, motions_inout)
            if rotation:
                turn_arms(count, motions_inout, blocks_inout)
            if joints:
                accelerate_again(members, h, motions_inout)
                finish_joints(context, joints_inout, motions_inout)
            if relaxed:
                relax(count, context, motions_inout, blocks_inout)
            if rotation:
                turn_impulses(count, motions_inout, blocks_inout)
        if joints:
            end_joints(joints_inout)

    return run_substeps


SUBSTEPS = {
    (d, r, f, j): make_substeps(drag=d, rotation=r, friction=f, joints=j)
    for d in BOTH
    for r in BOTH
    for f in BOTH
    for j in BOTH
}


def solve(state: StepState, contacts: ContactLanes, kernels: Mapping = SUBSTEPS) -> float:
    """Solve the constraints of a step, one group of islands after the other, and move the bodies.

    Return the length [s] of a substep of the last group, which has the shortest substeps. contacts: ContactLanes of the
    world; kernels: {(drag, rotation, friction, joints): result of make_substeps}.
    """
    effects, motions, dt = state.effects, state.workspace.motions, state.dt
    run, h = kernels[effects.drag, effects.rotation, effects.friction, effects.joints], dt
    by_load = state.substeps == 0
    for group in contacts.choose(state, motions, state.substeps):
        context = context_of(group.substeps, by_load, dt, state.span, state.drag, state.tolerances)
        h = context.h
        blocks, count = contacts.prepare(state, motions, group, context)
        found = contacts.joints(state, motions, group, h) if effects.joints else 0
        run(group.members, motions.kinematic, count, context, motions.used, found, blocks)
        if by_load:
            estimate_substeps(state, motions, contacts.selection.plan, group, blocks, count, found)
        contacts.store(state, motions, count, context)
        if len(group.joints):
            store_joints(group.joints, context, state.joints)
            state.work[CAP_HITS] += contacts.trees.schur.counts[2]
        lists, plan, moving = motions.lists, contacts.selection.plan, len(motions.kinematic)
        limit_energy(blocks, count, group, lists.links_islands, moving, context, plan, lists.balance, motions.used)
    return h


@stage("soft_step", reads=READS, writes=WRITES)
def soft_step(state: StepState) -> None:
    """Solve the contacts and joints in small soft substeps, and move the bodies."""
    run_solver(state, solve)
