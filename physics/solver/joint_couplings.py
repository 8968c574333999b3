"""Gears, pulleys and ratchets in the passes of the stacking solvers.

A gear holds a sum of two coordinates: coordinate of A plus ratio times coordinate of B. A coordinate is the angle or
the translation of another joint, or the angle of a body. A pulley bounds a sum of two lengths of rope in the same way
(Catto, Box2D v2, b2GearJoint and b2PulleyJoint). Both are one row on up to four bodies, solved after the other joints
and before the trees. A ratchet is a limit of an angle that follows the teeth from step to step (Chipmunk,
cpRatchetJoint); the pass of the other joints solves this limit.
"""

import math

from physics.jit import kernel, subkernel
from physics.math2d import norm
from physics.solver.joint_rows import (
    begin_joint,
    bounded,
    coordinate_of,
    coordinate_speed,
    limit_change,
    place_joint,
    push,
    push_coordinate,
    rigid_softness,
    turns,
)
from physics.solver.motions import change_velocity
from physics.tables.joint import GEARED, TOOTHED

# ---- start of a step -------------------------------------------------------------------------------------------------


@kernel
def list_couplings(rows, joints, found_out):
    """List the gears, pulleys and ratchets of a group in the order of ids. Return their number. O(rows).

    rows: JOINT rows of the group; joints: all JOINT rows; found_out (rows,): int32 JOINT rows.
    """
    found = 0
    for k in range(len(rows)):
        if joints[rows[k]].hold >= TOOTHED:
            found_out[found] = rows[k]
            found += 1
    return found


@subkernel
def follow_teeth(joint_inout):
    """Move the limit of a ratchet to the last tooth that its angle has passed. joint_inout: JOINT row.

    With a positive distance of the teeth the lower limit rises, with a negative one the upper limit falls. The limit
    never moves back.
    """
    j = joint_inout
    if j.ratchet == 0.0:
        return
    tooth = j.phase + (j.start_angle - j.phase) // j.ratchet * j.ratchet
    if tooth - tooth != 0.0:
        tooth = j.start_angle  # the teeth are too fine for a number of them
    if j.ratchet > 0.0:
        j.lower = max(j.lower, tooth)
    else:
        j.upper = min(j.upper, tooth)


@subkernel
def begin_gear(bodies, h, gear_inout, joints_inout):
    """Write the angles of the bodies of a gear at the start of a step, and begin its joints that are not solved.

    bodies: BODY rows; h [s]: length of a substep; gear_inout: JOINT row of the gear; joints_inout: all JOINT rows.
    """
    j = gear_inout
    j.start_a, j.start_b = 0.0, 0.0
    if j.joint_row_a >= 0:
        if not joints_inout[j.joint_row_a].awake:
            begin_joint(bodies, h, joints_inout[j.joint_row_a])
    elif j.body_row_a >= 0:
        j.start_a = bodies[j.body_row_a].angle
    if j.joint_row_b >= 0:
        if not joints_inout[j.joint_row_b].awake:
            begin_joint(bodies, h, joints_inout[j.joint_row_b])
    elif j.body_row_b >= 0:
        j.start_b = bodies[j.body_row_b].angle


@subkernel
def begin_pulley(bodies, joint_inout):
    """Write the vectors from the pulleys to the anchors at the start of a step.

    bodies: BODY rows; joint_inout: JOINT row after begin_joint.
    """
    j = joint_inout
    ax, ay, bx, by = j.local_ax, j.local_ay, j.local_bx, j.local_by
    if j.body_row_a >= 0:
        body = bodies[j.body_row_a]
        ax, ay = body.center_x + j.arm_ax, body.center_y + j.arm_ay
    if j.body_row_b >= 0:
        body = bodies[j.body_row_b]
        bx, by = body.center_x + j.arm_bx, body.center_y + j.arm_by
    j.rope_ax, j.rope_ay = ax - j.ground_ax, ay - j.ground_ay
    j.rope_bx, j.rope_by = bx - j.ground_bx, by - j.ground_by


@kernel
def begin_couplings(rows, bodies, h, joints_inout):
    """Write the state of gears, pulleys and ratchets at the start of a step, after begin_joints. O(rows).

    rows: JOINT rows from list_couplings; bodies: BODY rows; h [s]: length of a substep.
    """
    for k in range(len(rows)):
        j = joints_inout[rows[k]]
        j.total_sum = 0.0
        if j.hold == TOOTHED:
            follow_teeth(j)
        elif j.hold == GEARED:
            begin_gear(bodies, h, j, joints_inout)
        else:
            begin_pulley(bodies, j)


# ---- gear ------------------------------------------------------------------------------------------------------------


@subkernel
def side_value(row, start, motion, joints):
    """Return the coordinate of a side of a gear at the present poses [rad or px].

    row: JOINT row of the side, NO_JOINT for a body, whose angle was `start` [rad] at the start of the step; motion:
    MOTION row of the body; joints: all JOINT rows.
    """
    if row < 0:
        return start + motion.turn
    j = joints[row]
    return j.turn if turns(j) else coordinate_of(j)


@subkernel
def side_speed(row, motion, joints, motions):
    """Return the rate of the coordinate of a side of a gear. Arguments as in side_value; motions: MOTION rows."""
    if row < 0:
        return motion.angular_velocity
    j = joints[row]
    a, b = motions[j.motion_a], motions[j.motion_b]
    return b.angular_velocity - a.angular_velocity if turns(j) else coordinate_speed(j, a, b)


@subkernel
def push_side(row, impulse, motion, joints, motions_inout):
    """Apply an impulse on the coordinate of a side of a gear; > 0 increases it.

    row, joints: see side_value; motion: index of the MOTION row of the body.
    """
    if row < 0:
        m = motions_inout[motion]
        change_velocity(0.0, 0.0, m.inverse_inertia * impulse, m)
        return
    j = joints[row]
    a, b = motions_inout[j.motion_a], motions_inout[j.motion_b]
    if turns(j):
        push(j, 0.0, 0.0, impulse, a, b)
    else:
        push_coordinate(j, impulse, a, b)


@subkernel
def jacobian_of_side(row, motion, at_b, joints):
    """Return (MOTION row, x, y, angular) of the Jacobian of a side of a gear, for one of the two bodies of its joint.

    row, joints: see side_value; motion: index of the MOTION row of a body; at_b: True for body B of the joint.
    """
    if row < 0:
        return motion, 0.0, 0.0, 1.0 if at_b else 0.0
    j = joints[row]
    of = j.motion_b if at_b else j.motion_a
    if turns(j):
        return of, 0.0, 0.0, 1.0 if at_b else -1.0
    if at_b:
        return of, j.nx, j.ny, j.bx * j.ny - j.by * j.nx
    return of, -j.nx, -j.ny, j.ay * j.nx - j.ax * j.ny


@subkernel
def product_of_sides(row, motion, other_row, other_motion, joints, motions):
    """Return J W Kᵀ, the change of the coordinate of one side of a gear by a unit impulse on the other side.

    J, K: Jacobians of the two sides; W: inverse masses. For twice the same side this is its inverse effective mass.
    row, motion, other_row, other_motion: see jacobian_of_side; motions: MOTION rows.
    """
    total = 0.0
    for k in range(4):
        of, x, y, w = jacobian_of_side(row, motion, k < 2, joints)
        other, u, v, z = jacobian_of_side(other_row, other_motion, k % 2 == 0, joints)
        if of == other:
            m = motions[of]
            total += m.inverse_mass * (x * u + y * v) + m.inverse_inertia * w * z
    return total


@subkernel
def place_gear(at, motions, joints_inout):
    """Write the sum of coordinates of a gear at the present poses, and its inverse effective mass.

    The bodies of both sides may be the same, as in a planetary gear. at: JOINT row; motions: MOTION rows.
    """
    j = joints_inout[at]
    for side in range(2):
        row = j.joint_row_a if side == 0 else j.joint_row_b
        if row >= 0 and not joints_inout[row].awake:
            o = joints_inout[row]
            place_joint(motions[o.motion_a], motions[o.motion_b], o)
    row_a, row_b = j.joint_row_a, j.joint_row_b
    value = side_value(row_a, j.start_a, motions[j.motion_a], joints_inout)
    other = side_value(row_b, j.start_b, motions[j.motion_b], joints_inout)
    j.sum = value + j.ratio * other
    of_a = product_of_sides(row_a, j.motion_a, row_a, j.motion_a, joints_inout, motions)
    of_b = product_of_sides(row_b, j.motion_b, row_b, j.motion_b, joints_inout, motions)
    mixed = product_of_sides(row_a, j.motion_a, row_b, j.motion_b, joints_inout, motions)
    j.inverse_sum_mass = of_a + 2.0 * j.ratio * mixed + j.ratio * j.ratio * of_b


@subkernel
def push_gear(joint, impulse, joints, motions_inout):
    """Apply an impulse on the sum of coordinates of a gear; > 0 increases it.

    joint: JOINT row of the gear; joints: all JOINT rows.
    """
    j = joint
    push_side(j.joint_row_a, impulse, j.motion_a, joints, motions_inout)
    push_side(j.joint_row_b, j.ratio * impulse, j.motion_b, joints, motions_inout)


# ---- pulley ----------------------------------------------------------------------------------------------------------


@subkernel
def place_pulley(a, b, joint_inout):
    """Write the length of the rope of a pulley at the present poses, its directions, and its inverse effective mass.

    a, b: MOTION rows; joint_inout: JOINT row after place_joint. An anchor in its pulley has no direction, and is not
    pulled.
    """
    j = joint_inout
    ax, ay = j.rope_ax + a.dx + (j.ax - j.arm_ax), j.rope_ay + a.dy + (j.ay - j.arm_ay)
    bx, by = j.rope_bx + b.dx + (j.bx - j.arm_bx), j.rope_by + b.dy + (j.by - j.arm_by)
    length, other = norm(ax, ay), norm(bx, by)
    j.pull_ax, j.pull_ay, j.pull_bx, j.pull_by = 0.0, 0.0, 0.0, 0.0
    if length > 0.0:
        j.pull_ax, j.pull_ay = ax / length, ay / length
    if other > 0.0:
        j.pull_bx, j.pull_by = bx / other, by / other
    on_a, on_b = j.ax * j.pull_ay - j.ay * j.pull_ax, j.bx * j.pull_by - j.by * j.pull_bx
    of_a = (a.inverse_mass if length > 0.0 else 0.0) + a.inverse_inertia * on_a * on_a
    of_b = (b.inverse_mass if other > 0.0 else 0.0) + b.inverse_inertia * on_b * on_b
    j.sum = length + j.ratio * other
    j.inverse_sum_mass = of_a + j.ratio * j.ratio * of_b


@subkernel
def push_pulley(joint, impulse, a_inout, b_inout):
    """Apply an impulse on the length of the rope of a pulley; > 0 lengthens it. a_inout, b_inout: MOTION rows."""
    j, a, b = joint, a_inout, b_inout
    w = a.inverse_inertia * (j.ax * j.pull_ay - j.ay * j.pull_ax) * impulse
    change_velocity(a.inverse_mass * impulse * j.pull_ax, a.inverse_mass * impulse * j.pull_ay, w, a)
    other = j.ratio * impulse
    w = b.inverse_inertia * (j.bx * j.pull_by - j.by * j.pull_bx) * other
    change_velocity(b.inverse_mass * other * j.pull_bx, b.inverse_mass * other * j.pull_by, w, b)


@subkernel
def pulley_speed(joint, a, b):
    """Return the rate [px/s] at which the rope of a pulley lengthens. a, b: MOTION rows."""
    j = joint
    speed = a.vx * j.pull_ax + a.vy * j.pull_ay + a.angular_velocity * (j.ax * j.pull_ay - j.ay * j.pull_ax)
    other = b.vx * j.pull_bx + b.vy * j.pull_by + b.angular_velocity * (j.bx * j.pull_by - j.by * j.pull_bx)
    return speed + j.ratio * other


# ---- passes ----------------------------------------------------------------------------------------------------------


@subkernel
def place_coupling(at, motions, joints_inout):
    """Place a gear or pulley at the present poses. at: JOINT row; motions: MOTION rows."""
    j = joints_inout[at]
    if j.hold == GEARED:
        place_gear(at, motions, joints_inout)
    else:
        place_pulley(motions[j.motion_a], motions[j.motion_b], j)


@subkernel
def push_sum(joint, impulse, joints, motions_inout):
    """Apply an impulse on the sum of a gear or pulley. joint: its JOINT row; joints: all JOINT rows."""
    j = joint
    if j.hold == GEARED:
        push_gear(j, impulse, joints, motions_inout)
    else:
        push_pulley(j, impulse, motions_inout[j.motion_a], motions_inout[j.motion_b])


@subkernel
def sum_speed(joint, joints, motions):
    """Return the rate of the sum of a gear or pulley. joint: its JOINT row; joints: all JOINT rows; motions: MOTION."""
    j = joint
    a, b = motions[j.motion_a], motions[j.motion_b]
    if j.hold == GEARED:
        speed = side_speed(j.joint_row_a, a, joints, motions)
        return speed + j.ratio * side_speed(j.joint_row_b, b, joints, motions)
    return pulley_speed(j, a, b)


@subkernel
def warm_couplings(rows, joints_inout, motions_inout):
    """Place gears and pulleys at the present poses, and apply the impulses of the last substep. O(rows).

    rows: JOINT rows from list_couplings, placed as joints by warm_joints.
    """
    for k in range(len(rows)):
        j = joints_inout[rows[k]]
        if j.hold != TOOTHED:
            place_coupling(rows[k], motions_inout, joints_inout)
            push_sum(j, j.low - j.high, joints_inout, motions_inout)


@subkernel
def solve_sum(biased, context, joints, joint_inout, motions_inout):
    """Solve the sum of a gear or pulley, between its limits. A gear is held at its phase.

    biased: see solve_joints; context: see StepContext; joint_inout: JOINT row; joints: all JOINT rows.
    """
    j = joint_inout
    inverse = j.inverse_sum_mass
    if not inverse > 0.0:
        return
    mass = 1.0 / inverse
    soft, most = rigid_softness(biased, context), context.push_speed
    low, high = j.lower, j.upper
    if j.hold == GEARED:
        low, high = j.phase, j.phase
        if j.joint_row_a < 0 or turns(joints[j.joint_row_a]):
            most = context.push_turn
    if low == high:
        rate, mass_share, give = soft
        speed = sum_speed(j, joints, motions_inout) + bounded(rate * (j.sum - low), most)
        change = -mass * mass_share * speed - give * j.low
        j.low += change
        push_sum(j, change, joints, motions_inout)
        return
    if low > -math.inf:
        speed = sum_speed(j, joints, motions_inout)
        change = limit_change(j.sum - low, speed, j.low, mass, soft, most, context.inverse_h)
        j.low += change
        push_sum(j, change, joints, motions_inout)
    if high < math.inf:
        speed = -sum_speed(j, joints, motions_inout)
        change = limit_change(high - j.sum, speed, j.high, mass, soft, most, context.inverse_h)
        j.high += change
        push_sum(j, -change, joints, motions_inout)


@subkernel
def solve_couplings(rows, biased, context, joints_inout, motions_inout):
    """Solve every gear and pulley once. O(rows).

    rows: JOINT rows from list_couplings; biased: see solve_joints; context: see StepContext.
    """
    for k in range(len(rows)):
        j = joints_inout[rows[k]]
        if j.hold != TOOTHED:
            if not biased:
                place_coupling(rows[k], motions_inout, joints_inout)
            solve_sum(biased, context, joints_inout, j, motions_inout)


@subkernel
def sum_couplings(rows, joints_inout):
    """Add the impulses of gears and pulleys in a substep to the totals of the step. O(rows).

    rows: JOINT rows from list_couplings.
    """
    for k in range(len(rows)):
        j = joints_inout[rows[k]]
        if j.hold == TOOTHED:
            continue
        impulse = j.low - j.high
        j.total_sum += impulse
        impulse *= j.ratio
        if j.hold != GEARED:
            j.total_x += impulse * j.pull_bx
            j.total_y += impulse * j.pull_by
        elif j.joint_row_b < 0 or turns(joints_inout[j.joint_row_b]):
            j.total_torque += impulse
        else:
            o = joints_inout[j.joint_row_b]
            j.total_x += impulse * o.nx
            j.total_y += impulse * o.ny
