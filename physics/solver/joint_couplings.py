"""Gears, pulleys and ratchets in the passes of the stacking solvers.

A gear keeps a sum constant: coordinate of A + ratio · coordinate of B. A coordinate is the angle or the translation of
another joint, or the angle of a body. A pulley bounds a sum of two lengths of rope in the same way (Catto, Box2D v2,
b2GearJoint and b2PulleyJoint). A gear or pulley is one constraint row on up to four bodies, solved after the other
joints and before the trees. A ratchet is an angle limit that moves with the teeth from step to step (Chipmunk,
cpRatchetJoint). The pass of the other joints solves this limit.
"""

import math

from physics.jit import inlined, kernel, subkernel
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
from physics.tables.table import row_of

# ---- start of a step -------------------------------------------------------------------------------------------------


@kernel
def list_couplings(rows, joints, couplings_out):
    """List the gears, pulleys and ratchets of a group in the order of ids. Return their number. O(rows).

    rows: indices of the JOINT rows of the group; joints: all JOINT rows; couplings_out (rows,): COUPLING rows. Only
    their field `joint` is written.
    """
    found = 0
    for k in range(len(rows)):
        if joints[rows[k]].hold >= TOOTHED:
            couplings_out[found].joint = rows[k]
            found += 1
    return found


@subkernel
def follow_teeth(joint_inout):
    """Move the limit of a ratchet to the last tooth that its angle has passed. joint_inout: JOINT row.

    If the distance between teeth is positive, the lower limit rises. If it is negative, the upper limit falls. The
    limit never moves back.
    """
    j = joint_inout
    if j.ratchet == 0.0:
        return
    tooth = j.phase + (j.start_angle - j.phase) // j.ratchet * j.ratchet
    if tooth - tooth != 0.0:
        tooth = j.start_angle  # the teeth are too fine to be numbered
    if j.ratchet > 0.0:
        j.lower = max(j.lower, tooth)
    else:
        j.upper = min(j.upper, tooth)


@subkernel
def begin_gear(bodies, h, gear, coupling_out, joints_inout):
    """Write to a COUPLING row the joints of a gear, and the angles of its bodies at the start of a step.

    A joint of the gear that is not solved in this step is initialised here. Both joints lose JOINT.is_pin, because a
    gear reads their coordinates. bodies: BODY rows; h [s]: length of a substep; gear: JOINT row of the gear;
    joints_inout: all JOINT rows.
    """
    j, c = gear, coupling_out
    c.row_a, c.row_b = row_of(joints_inout, j.joint_a), row_of(joints_inout, j.joint_b)
    c.start_a = bodies[j.body_row_a].angle if j.body_row_a >= 0 else 0.0
    c.start_b = bodies[j.body_row_b].angle if j.body_row_b >= 0 else 0.0
    for side in range(2):
        row = c.row_a if side == 0 else c.row_b
        if row < 0:
            continue
        joints_inout[row].is_pin = False
        if not joints_inout[row].awake:
            begin_joint(bodies, h, joints_inout[row])


@subkernel
def begin_pulley(bodies, joint, coupling_out):
    """Write to a COUPLING row the vectors [px] from the pulley wheels to the anchors at the start of a step.

    bodies: BODY rows; joint: JOINT row after begin_joint.
    """
    j, c = joint, coupling_out
    ax, ay, bx, by = j.local_ax, j.local_ay, j.local_bx, j.local_by
    if j.body_row_a >= 0:
        body = bodies[j.body_row_a]
        ax, ay = body.center_x + j.arm_ax, body.center_y + j.arm_ay
    if j.body_row_b >= 0:
        body = bodies[j.body_row_b]
        bx, by = body.center_x + j.arm_bx, body.center_y + j.arm_by
    c.rope_ax, c.rope_ay = ax - j.ground_ax, ay - j.ground_ay
    c.rope_bx, c.rope_by = bx - j.ground_bx, by - j.ground_by


@kernel
def begin_couplings(bodies, h, couplings_inout, joints_inout):
    """Write the state of gears, pulleys and ratchets at the start of a step, after begin_joints. O(couplings).

    bodies: BODY rows; h [s]: length of a substep; couplings_inout: COUPLING rows from list_couplings; joints_inout: all
    JOINT rows.
    """
    for k in range(len(couplings_inout)):
        c = couplings_inout[k]
        j = joints_inout[c.joint]
        c.total = 0.0
        if j.hold == TOOTHED:
            follow_teeth(j)
        elif j.hold == GEARED:
            begin_gear(bodies, h, j, c, joints_inout)
        else:
            begin_pulley(bodies, j, c)


# ---- gear ------------------------------------------------------------------------------------------------------------


@subkernel
def side_value(row, start, motion, joints):
    """Return the coordinate [rad or px] of a gear's side at the present poses.

    row: index of the JOINT row of the side, or NO_JOINT if the side is a body; start [rad]: angle of this body at the
    start of the step; motion: MOTION row of the body; joints: all JOINT rows.
    """
    if row < 0:
        return start + motion.turn
    j = joints[row]
    return j.turn if turns(j) else coordinate_of(j)


@subkernel
def side_speed(row, motion, joints, motions):
    """Return the rate [rad/s or px/s] of the coordinate of a gear's side. row, motion, joints: see side_value.

    motions: MOTION rows.
    """
    if row < 0:
        return motion.angular_velocity
    j = joints[row]
    a, b = motions[j.motion_a], motions[j.motion_b]
    return b.angular_velocity - a.angular_velocity if turns(j) else coordinate_speed(j, a, b)


@subkernel
def push_side(row, impulse, motion, joints, motions_inout):
    """Apply an impulse to the coordinate of a gear's side. A positive impulse increases the coordinate.

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
    """Return (MOTION row, x, y, angular): the Jacobian of a gear's side with respect to one body of the side's joint.

    row, joints: see side_value; motion: index of the MOTION row of the body if the side is a body; at_b: True for body
    B of the joint.
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
    """Return J W Kᵀ, the change of the rate of one side's coordinate by a unit impulse on the other side of a gear.

    J, K: Jacobians of the two sides; W: inverse masses. For one side passed twice, the result is its inverse effective
    mass. row, motion, other_row, other_motion: see jacobian_of_side; motions: MOTION rows.
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
def place_gear(motions, coupling_inout, joints_inout):
    """Write to a COUPLING row the sum of coordinates of a gear at the present poses, and its inverse effective mass.

    The bodies of both sides may be the same, as in a planetary gear. motions: MOTION rows; coupling_inout: COUPLING
    row; joints_inout: all JOINT rows.
    """
    c = coupling_inout
    j = joints_inout[c.joint]
    for side in range(2):
        row = c.row_a if side == 0 else c.row_b
        if row >= 0 and not joints_inout[row].awake:
            o = joints_inout[row]
            place_joint(motions[o.motion_a], motions[o.motion_b], o)
    value = side_value(c.row_a, c.start_a, motions[j.motion_a], joints_inout)
    other = side_value(c.row_b, c.start_b, motions[j.motion_b], joints_inout)
    c.sum = value + j.ratio * other
    of_a = product_of_sides(c.row_a, j.motion_a, c.row_a, j.motion_a, joints_inout, motions)
    of_b = product_of_sides(c.row_b, j.motion_b, c.row_b, j.motion_b, joints_inout, motions)
    mixed = product_of_sides(c.row_a, j.motion_a, c.row_b, j.motion_b, joints_inout, motions)
    c.inverse_mass = of_a + 2.0 * j.ratio * mixed + j.ratio * j.ratio * of_b


@subkernel
def push_gear(coupling, impulse, joints, motions_inout):
    """Apply an impulse to the sum of coordinates of a gear. A positive impulse increases the sum.

    coupling: COUPLING row; joints: all JOINT rows.
    """
    c = coupling
    j = joints[c.joint]
    push_side(c.row_a, impulse, j.motion_a, joints, motions_inout)
    push_side(c.row_b, j.ratio * impulse, j.motion_b, joints, motions_inout)


# ---- pulley ----------------------------------------------------------------------------------------------------------


@subkernel
def place_pulley(joint, a, b, coupling_inout):
    """Write the rope length, the rope directions and the inverse effective mass of a pulley at the present poses.

    The result goes to the COUPLING row coupling_inout. An anchor at the position of its wheel has no direction, and is
    not pulled. joint: JOINT row after place_joint; a, b: MOTION rows.
    """
    j, c = joint, coupling_inout
    ax, ay = c.rope_ax + a.dx + (j.ax - j.arm_ax), c.rope_ay + a.dy + (j.ay - j.arm_ay)
    bx, by = c.rope_bx + b.dx + (j.bx - j.arm_bx), c.rope_by + b.dy + (j.by - j.arm_by)
    length, other = norm(ax, ay), norm(bx, by)
    c.pull_ax, c.pull_ay, c.pull_bx, c.pull_by = 0.0, 0.0, 0.0, 0.0
    if length > 0.0:
        c.pull_ax, c.pull_ay = ax / length, ay / length
    if other > 0.0:
        c.pull_bx, c.pull_by = bx / other, by / other
    on_a, on_b = j.ax * c.pull_ay - j.ay * c.pull_ax, j.bx * c.pull_by - j.by * c.pull_bx
    of_a = (a.inverse_mass if length > 0.0 else 0.0) + a.inverse_inertia * on_a * on_a
    of_b = (b.inverse_mass if other > 0.0 else 0.0) + b.inverse_inertia * on_b * on_b
    c.length_a, c.length_b, c.inverse_a, c.inverse_b = length, other, of_a, of_b
    c.sum = length + j.ratio * other
    c.inverse_mass = of_a + j.ratio * j.ratio * of_b


@subkernel
def push_ropes(joint, coupling, on_a, on_b, a_inout, b_inout):
    """Apply impulses to the rope lengths of a pulley: on_a at A and on_b at B. A positive impulse lengthens the rope.

    joint, coupling: JOINT and COUPLING row; a_inout, b_inout: MOTION rows.
    """
    j, c, a, b = joint, coupling, a_inout, b_inout
    w = a.inverse_inertia * (j.ax * c.pull_ay - j.ay * c.pull_ax) * on_a
    change_velocity(a.inverse_mass * on_a * c.pull_ax, a.inverse_mass * on_a * c.pull_ay, w, a)
    w = b.inverse_inertia * (j.bx * c.pull_by - j.by * c.pull_bx) * on_b
    change_velocity(b.inverse_mass * on_b * c.pull_bx, b.inverse_mass * on_b * c.pull_by, w, b)


@subkernel
def rope_speeds(joint, coupling, a, b):
    """Return the rates [px/s] at which the ropes of A and of B lengthen. Arguments: see push_ropes."""
    j, c = joint, coupling
    speed = a.vx * c.pull_ax + a.vy * c.pull_ay + a.angular_velocity * (j.ax * c.pull_ay - j.ay * c.pull_ax)
    other = b.vx * c.pull_bx + b.vy * c.pull_by + b.angular_velocity * (j.bx * c.pull_by - j.by * c.pull_bx)
    return speed, other


@subkernel
def stop_at_pulleys(context, coupling, joint_inout, a_inout, b_inout):
    """Stop anchors at the wheels of their pulley, so that no rope length becomes negative.

    Otherwise a light body would swing back and forth through the wheel, and would not hold the other body. The
    accumulated impulses are point_x (A) and point_y (B) of the joint. context: see StepContext; other arguments: see
    push_ropes.
    """
    j, c, a, b = joint_inout, coupling, a_inout, b_inout
    soft = (0.0, 1.0, 0.0)
    speed, other = rope_speeds(j, c, a, b)
    on_a, on_b = 0.0, 0.0
    if c.inverse_a > 0.0:
        on_a = limit_change(c.length_a, speed, j.point_x, 1.0 / c.inverse_a, soft, 0.0, context.inverse_h)
    if c.inverse_b > 0.0:
        on_b = limit_change(c.length_b, other, j.point_y, 1.0 / c.inverse_b, soft, 0.0, context.inverse_h)
    j.point_x += on_a
    j.point_y += on_b
    if on_a != 0.0 or on_b != 0.0:
        push_ropes(j, c, on_a, on_b, a, b)


# ---- passes ----------------------------------------------------------------------------------------------------------


@subkernel
def place_coupling(motions, coupling_inout, joints_inout):
    """Update a gear or pulley to the present poses, see place_gear and place_pulley.

    motions: MOTION rows; coupling_inout: COUPLING row; joints_inout: all JOINT rows.
    """
    j = joints_inout[coupling_inout.joint]
    if j.hold == GEARED:
        place_gear(motions, coupling_inout, joints_inout)
    else:
        place_pulley(j, motions[j.motion_a], motions[j.motion_b], coupling_inout)


@subkernel
def push_sum(coupling, impulse, joints, motions_inout):
    """Apply an impulse to the sum that a gear or pulley constrains. coupling: COUPLING row; joints: all JOINT rows."""
    j = joints[coupling.joint]
    if j.hold == GEARED:
        push_gear(coupling, impulse, joints, motions_inout)
    else:
        a, b = motions_inout[j.motion_a], motions_inout[j.motion_b]
        push_ropes(j, coupling, impulse, j.ratio * impulse, a, b)


@subkernel
def sum_speed(coupling, joints, motions):
    """Return the rate of the sum that a gear or pulley constrains, without anchors that are stopped at their wheels.

    coupling, joints: see push_sum; motions: MOTION rows.
    """
    c = coupling
    j = joints[c.joint]
    a, b = motions[j.motion_a], motions[j.motion_b]
    if j.hold == GEARED:
        return side_speed(c.row_a, a, joints, motions) + j.ratio * side_speed(c.row_b, b, joints, motions)
    speed, other = rope_speeds(j, c, a, b)
    speed = 0.0 if j.point_x > 0.0 else speed
    return speed if j.point_y > 0.0 else speed + j.ratio * other


@subkernel
def warm_couplings(couplings_inout, joints_inout, motions_inout):
    """Update gears and pulleys to the present poses, and apply the impulses of the last substep. O(couplings).

    couplings_inout: COUPLING rows from list_couplings; joints_inout: all JOINT rows, updated before by warm_joints.
    """
    for k in range(len(couplings_inout)):
        c = couplings_inout[k]
        j = joints_inout[c.joint]
        if j.hold != TOOTHED:
            place_coupling(motions_inout, c, joints_inout)
            push_sum(c, j.low - j.high, joints_inout, motions_inout)
        if j.hold > GEARED:
            push_ropes(j, c, j.point_x, j.point_y, motions_inout[j.motion_a], motions_inout[j.motion_b])


@inlined
def inverse_mass_of_sum(joint, coupling):
    """Return the inverse effective mass of the sum that a gear or pulley constrains.

    An anchor that is stopped at its wheel counts as immovable, because stop_at_pulleys removes its speed again. joint,
    coupling: JOINT and COUPLING row.
    """
    j, c = joint, coupling
    if j.hold == GEARED or (j.point_x == 0.0 and j.point_y == 0.0):
        return c.inverse_mass
    inverse = (0.0 if j.point_x > 0.0 else c.inverse_a) + (0.0 if j.point_y > 0.0 else j.ratio * j.ratio * c.inverse_b)
    return inverse if inverse > 0.0 else c.inverse_mass


@subkernel
def solve_sum(biased, context, coupling, joints_inout, motions_inout):
    """Solve the constraint of a gear or pulley once. A gear holds its sum at `phase`, a pulley keeps it within limits.

    biased: see solve_joints; context: see StepContext; coupling: COUPLING row; joints_inout: all JOINT rows.
    """
    c = coupling
    j = joints_inout[c.joint]
    inverse = inverse_mass_of_sum(j, c)
    if not inverse > 0.0:
        return
    mass = 1.0 / inverse
    soft, most = rigid_softness(biased, context), context.push_speed
    low, high = j.lower, j.upper
    if j.hold == GEARED:
        low, high = j.phase, j.phase
        if c.row_a < 0 or turns(joints_inout[c.row_a]):
            most = context.push_turn
    if low == high:
        rate, mass_share, give = soft
        speed = sum_speed(c, joints_inout, motions_inout) + bounded(rate * (c.sum - low), most)
        change = -mass * mass_share * speed - give * j.low
        j.low += change
        push_sum(c, change, joints_inout, motions_inout)
        return
    if low > -math.inf:
        speed = sum_speed(c, joints_inout, motions_inout)
        change = limit_change(c.sum - low, speed, j.low, mass, soft, most, context.inverse_h)
        j.low += change
        push_sum(c, change, joints_inout, motions_inout)
    if high < math.inf:
        speed = -sum_speed(c, joints_inout, motions_inout)
        change = limit_change(high - c.sum, speed, j.high, mass, soft, most, context.inverse_h)
        j.high += change
        push_sum(c, -change, joints_inout, motions_inout)


@subkernel
def solve_couplings(biased, context, couplings_inout, joints_inout, motions_inout):
    """Solve every gear and pulley once. O(couplings).

    biased: see solve_joints; context: see StepContext; couplings_inout: COUPLING rows from list_couplings;
    joints_inout: all JOINT rows.
    """
    for k in range(len(couplings_inout)):
        c = couplings_inout[k]
        j = joints_inout[c.joint]
        if j.hold == TOOTHED:
            continue
        if not biased:
            place_coupling(motions_inout, c, joints_inout)
        solve_sum(biased, context, c, joints_inout, motions_inout)
        if j.hold != GEARED:
            stop_at_pulleys(context, c, j, motions_inout[j.motion_a], motions_inout[j.motion_b])


@subkernel
def sum_couplings(couplings_inout, joints_inout):
    """Add the substep impulses of gears and pulleys to the totals of the step. O(couplings).

    couplings_inout: COUPLING rows from list_couplings; joints_inout: all JOINT rows.
    """
    for k in range(len(couplings_inout)):
        c = couplings_inout[k]
        j = joints_inout[c.joint]
        if j.hold == TOOTHED:
            continue
        impulse = j.low - j.high
        c.total += impulse
        impulse *= j.ratio
        if j.hold != GEARED:
            j.total_x += impulse * c.pull_bx
            j.total_y += impulse * c.pull_by
        elif c.row_b < 0 or turns(joints_inout[c.row_b]):
            j.total_torque += impulse
        else:
            o = joints_inout[c.row_b]
            j.total_x += impulse * o.nx
            j.total_y += impulse * o.ny


# ---- loads -----------------------------------------------------------------------------------------------------------


@inlined
def arm_of_side(row, joints, motion):
    """Return the arm [px] that converts an error of a gear's side to a length.

    The result is 1 for a translation, otherwise the radius of gyration of the body. row: index of the JOINT row of the
    side, NO_JOINT for a body; joints: all JOINT rows; motion: MOTION row of the side.
    """
    if row >= 0 and not turns(joints[row]):
        return 1.0
    return math.sqrt(motion.inverse_mass / motion.inverse_inertia) if motion.inverse_inertia > 0.0 else 0.0


@kernel
def estimate_couplings(couplings, joints, rate, motions_inout):
    """Raise MOTION.estimate to the square of the number of substeps that gears and pulleys need. O(couplings).

    The estimate is computed from the sag of the sum that the gear or pulley constrains, as for iterative joints. The
    sag of a gear is measured as a length, on the side where it is shorter. couplings: COUPLING rows of the step;
    joints: all JOINT rows; rate: see substeps.estimate_rate.
    """
    for k in range(len(couplings)):
        c = couplings[k]
        j = joints[c.joint]
        a, b = motions_inout[j.motion_a], motions_inout[j.motion_b]
        if j.hold == TOOTHED:
            continue
        sag = abs(c.total) * c.inverse_mass
        if j.hold == GEARED:
            arm, other = arm_of_side(c.row_a, joints, a), arm_of_side(c.row_b, joints, b)
            ratio = abs(j.ratio)
            sag *= arm if ratio == 0.0 or arm * ratio <= other else other / ratio
        a.estimate = max(a.estimate, 0.25 * rate * sag)
        b.estimate = max(b.estimate, 0.25 * rate * sag)
