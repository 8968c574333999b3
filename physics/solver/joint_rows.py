"""Joints as soft constraints that the stacking solvers solve one after the other, with warm starting (iterative tier).

A joint of any kind consists of parts. One part holds its anchors together, and one holds its angle. On its coordinate
(an angle, a translation or a length) there may be a spring, a motor and two limits. Moment arms, axes and effective
masses are recomputed in each substep. Sources: Catto, Soft Constraints, GDC 2011, and Solver2D, 2024 (soft joints with
a relaxing pass); Catto, Box2D v3, joint.c (the parts).
"""

import math

from physics.jit import inlined, kernel, subkernel
from physics.math2d import norm, rotation_of
from physics.solver.motions import change_velocity
from physics.tables.joint import ANGLE, FREE, GEARED, LENGTH, NO_COORDINATE, NO_JOINT, ON_AXIS, PINNED, TRANSLATION
from physics.tables.step_state import JOINTS_SOLVED
from physics.tables.table import row_of

LEAST_INVERSE = 1e-9  # least share of an inverse inertia that remains after a hold of the anchors: less is rounding
RESOLVED = 0.5  # [rad] phase of a spring in a substep up to which an undamped spring keeps its energy
LIMIT_SHARE = 0.25  # fraction of the error of a limit that a substep removes, for a joint that a tree solves

# ---- selection -------------------------------------------------------------------------------------------------------


@subkernel
def is_idle(joint):
    """Return whether the solver can skip a JOINT row: it is disabled, or only prevents contacts of its bodies."""
    j = joint
    if not j.enabled:
        return True
    return j.hold == FREE and not j.locks_angle and j.coordinate == NO_COORDINATE and not j.turns_motor


@subkernel
def side_of_gear(identity, body_row, motion_of, motions, joints):
    """Return (BODY row that represents a side of a gear, whether the side acts).

    If the side is a joint with a dynamic body, the result is the row of that body. In the graph, the gear's edge then
    connects all bodies that the gear moves, because the joint has an edge of its own. A removed or disabled joint does
    not act. identity: id of the joint, NO_JOINT for a side that is a body; body_row: present BODY row of the side;
    motion_of, motions: see list_joints; joints: all JOINT rows.
    """
    if identity == NO_JOINT:
        return body_row, True
    row = row_of(joints, identity)
    if row < 0 or not joints[row].enabled:
        return body_row, False
    j = joints[row]
    if j.body_row_b >= 0 and motions[motion_of[j.body_row_b]].is_dynamic:
        return j.body_row_b, True
    if j.body_row_a >= 0 and motions[motion_of[j.body_row_a]].is_dynamic:
        return j.body_row_a, True
    return body_row, True


@subkernel
def find_sides(motion_of, motions, joints, joint_inout):
    """Write the BODY rows of both sides of a gear. Return whether both sides act. Arguments: see side_of_gear."""
    j = joint_inout
    j.body_row_a, first = side_of_gear(j.joint_a, j.body_row_a, motion_of, motions, joints)
    j.body_row_b, second = side_of_gear(j.joint_b, j.body_row_b, motion_of, motions, joints)
    return first and second


@kernel
def list_joints(motion_of, motions_inout, joints_inout, links_out, work_inout):
    """List the joints to solve in this step, in the order of ids. Return their number. O(joints).

    motion_of (bodies): MOTION row of each body, 0 for a body that does not move; MOTION.jointed of listed bodies is
    set. links_out (joints, 4) int32: JOINT row, MOTION row of A, MOTION row of B of each listed joint, and whether the
    joint also pushes on the world (gears, pulleys). work_inout: counters.
    """
    found = 0
    for i in range(len(joints_inout)):
        j = joints_inout[i]
        j.awake = False
        if is_idle(j):
            continue
        if j.hold == GEARED and not find_sides(motion_of, motions_inout, joints_inout, j):
            continue
        j.motion_a = motion_of[j.body_row_a] if j.body_row_a >= 0 else 0
        j.motion_b = motion_of[j.body_row_b] if j.body_row_b >= 0 else 0
        a, b = motions_inout[j.motion_a], motions_inout[j.motion_b]
        if a.inverse_mass + a.inverse_inertia + b.inverse_mass + b.inverse_inertia == 0.0:
            continue
        j.awake = True
        # A spring balances a load within each substep, so the load must not be divided into halves.
        rigid = j.spring_hertz == 0.0 and j.point_hertz == 0.0 and j.angle_hertz == 0.0
        a.halves = rigid and (a.halves or not a.jointed)
        b.halves = rigid and (b.halves or not b.jointed)
        drives = not rigid or j.motor_max > 0.0 or not j.follows_point
        drives = drives or (a.moves and not a.is_dynamic) or (b.moves and not b.is_dynamic)  # a kinematic body
        a.driven = a.driven or drives
        b.driven = b.driven or drives
        a.jointed = a.is_dynamic
        b.jointed = b.is_dynamic
        links_out[found, 0] = i
        links_out[found, 1] = j.motion_a
        links_out[found, 2] = j.motion_b
        links_out[found, 3] = 1 if j.hold >= GEARED else 0
        found += 1
    work_inout[JOINTS_SOLVED] += found
    return found


# ---- geometry --------------------------------------------------------------------------------------------------------


@subkernel
def begin_joint(bodies, h, joint_inout):
    """Write the anchors, axis and angle of a joint at the start of a step, and its warm-start impulses for a substep.

    bodies: BODY rows; h [s]: length of the substep, by which the cached forces are multiplied; joint_inout: JOINT row.
    """
    j = joint_inout
    angle_a, angle_b = 0.0, 0.0
    ax, ay, bx, by = j.local_ax, j.local_ay, j.local_bx, j.local_by
    j.arm_ax, j.arm_ay, j.arm_bx, j.arm_by = 0.0, 0.0, 0.0, 0.0
    j.start_nx, j.start_ny = j.axis_x, j.axis_y
    if j.body_row_a >= 0:
        body = bodies[j.body_row_a]
        angle_a = body.angle
        c, s = rotation_of(angle_a)
        u, v = ax - body.local_center_x, ay - body.local_center_y
        j.arm_ax, j.arm_ay = c * u - s * v, s * u + c * v
        ax, ay = body.center_x + j.arm_ax, body.center_y + j.arm_ay
        j.start_nx, j.start_ny = c * j.axis_x - s * j.axis_y, s * j.axis_x + c * j.axis_y
    if j.body_row_b >= 0:
        body = bodies[j.body_row_b]
        angle_b = body.angle
        c, s = rotation_of(angle_b)
        u, v = bx - body.local_center_x, by - body.local_center_y
        j.arm_bx, j.arm_by = c * u - s * v, s * u + c * v
        bx, by = body.center_x + j.arm_bx, body.center_y + j.arm_by
    j.base_x, j.base_y = bx - ax, by - ay
    j.start_angle = angle_b - angle_a - j.reference
    j.point_x, j.point_y = h * j.point_force_x, h * j.point_force_y
    j.hold_impulse, j.spring, j.motor = h * j.hold_torque, h * j.spring_force, h * j.motor_force
    j.low, j.high = h * j.lower_force, h * j.upper_force
    j.total_x, j.total_y, j.total_torque = 0.0, 0.0, 0.0


@kernel
def begin_joints(rows, bodies, h, joints_inout):
    """Write the anchors, axes and angles of joints at the start of a step, and their warm-start impulses. O(rows).

    rows: indices of JOINT rows; h [s]: length of a substep.
    """
    for k in range(len(rows)):
        begin_joint(bodies, h, joints_inout[rows[k]])


@subkernel
def place_anchors(a, b, joint_inout):
    """Compute the moment arms and the anchor offset of a joint at the present poses. a, b: MOTION rows.

    joint_inout: JOINT row. The arms are to the anchors of both bodies.
    """
    j = joint_inout
    j.ax, j.ay = a.cosine * j.arm_ax - a.sine * j.arm_ay, a.sine * j.arm_ax + a.cosine * j.arm_ay
    j.bx, j.by = b.cosine * j.arm_bx - b.sine * j.arm_by, b.sine * j.arm_bx + b.cosine * j.arm_by
    j.apart_x = j.base_x + (b.dx - a.dx) + (j.bx - j.arm_bx) - (j.ax - j.arm_ax)
    j.apart_y = j.base_y + (b.dy - a.dy) + (j.by - j.arm_by) - (j.ay - j.arm_ay)


@subkernel
def place_joint(a, b, joint_inout):
    """Compute the moment arms, axis, angle and anchor offset of a joint at the present poses.

    a, b: MOTION rows; joint_inout: JOINT row.
    """
    j = joint_inout
    place_anchors(a, b, j)
    j.turn = j.start_angle + b.turn - a.turn
    if j.coordinate == LENGTH:
        length = norm(j.apart_x, j.apart_y)
        if length > 0.0:
            j.nx, j.ny = j.apart_x / length, j.apart_y / length
    else:
        j.nx = a.cosine * j.start_nx - a.sine * j.start_ny
        j.ny = a.sine * j.start_nx + a.cosine * j.start_ny
    if j.hold == ON_AXIS or j.coordinate == TRANSLATION:
        # The axis rotates with A, so the impulse on A also acts at B's anchor.
        j.ax += j.apart_x
        j.ay += j.apart_y


# ---- impulses --------------------------------------------------------------------------------------------------------


@subkernel
def push(joint, x, y, torque, a_inout, b_inout):
    """Apply an impulse (x, y) at B's anchor and an angular impulse `torque` to B, and the opposite impulses to A.

    The velocities without contact impulses (free_vx, free_vy, free_w) change by the same amounts. The warm start of
    contacts therefore does not repeat these impulses; joints have a warm start of their own. joint: JOINT row; a_inout,
    b_inout: MOTION rows.
    """
    j = joint
    a, b = a_inout, b_inout
    w = a.inverse_inertia * (j.ax * y - j.ay * x + torque)
    change_velocity(-(a.inverse_mass * x), -(a.inverse_mass * y), -w, a)
    w = b.inverse_inertia * (j.bx * y - j.by * x + torque)
    change_velocity(b.inverse_mass * x, b.inverse_mass * y, w, b)


@subkernel
def push_coordinate(joint, impulse, a_inout, b_inout):
    """Apply an impulse along the coordinate of a joint; positive values increase the coordinate.

    The impulse acts along the axis of the joint, or is an angular impulse if the coordinate is an angle. joint: JOINT
    row; a_inout, b_inout: MOTION rows.
    """
    j = joint
    if j.coordinate == ANGLE:
        push(j, 0.0, 0.0, impulse, a_inout, b_inout)
    else:
        push(j, impulse * j.nx, impulse * j.ny, 0.0, a_inout, b_inout)


@subkernel
def speed_across(joint, nx, ny, a, b):
    """Return the speed [px/s] of B's anchor relative to A's anchor along a unit vector (nx, ny).

    joint: JOINT row; a, b: MOTION rows.
    """
    j = joint
    speed = (b.vx - a.vx) * nx + (b.vy - a.vy) * ny
    speed += b.angular_velocity * (j.bx * ny - j.by * nx)
    return speed - a.angular_velocity * (j.ax * ny - j.ay * nx)


@subkernel
def inverse_mass_along(joint, nx, ny, a, b):
    """Return the inverse effective mass of a joint at its anchors along a unit vector (nx, ny).

    joint: JOINT row; a, b: MOTION rows.
    """
    j = joint
    on_a, on_b = j.ax * ny - j.ay * nx, j.bx * ny - j.by * nx
    return a.inverse_mass + b.inverse_mass + a.inverse_inertia * on_a * on_a + b.inverse_inertia * on_b * on_b


@subkernel
def point_inverse_mass(joint, a, b):
    """Return the inverse effective mass of a joint at its anchors, as (k_11, k_12, k_22) of the symmetric matrix.

    joint: JOINT row; a, b: MOTION rows.
    """
    j = joint
    k_11 = a.inverse_mass + b.inverse_mass + a.inverse_inertia * j.ay * j.ay + b.inverse_inertia * j.by * j.by
    k_12 = -a.inverse_inertia * j.ax * j.ay - b.inverse_inertia * j.bx * j.by
    k_22 = a.inverse_mass + b.inverse_mass + a.inverse_inertia * j.ax * j.ax + b.inverse_inertia * j.bx * j.bx
    return k_11, k_12, k_22


@subkernel
def coordinate_of(joint):
    """Return the coordinate of a JOINT row at the present poses: its angle [rad], translation [px] or length [px]."""
    j = joint
    return j.turn if j.coordinate == ANGLE else j.apart_x * j.nx + j.apart_y * j.ny


@subkernel
def coordinate_speed(joint, a, b):
    """Return the rate at which the coordinate of a joint changes [px/s or rad/s]. a, b: MOTION rows."""
    j = joint
    return b.angular_velocity - a.angular_velocity if j.coordinate == ANGLE else speed_across(j, j.nx, j.ny, a, b)


@subkernel
def coordinate_inverse_mass(joint, a, b):
    """Return the inverse effective mass of the coordinate of a joint; for an angle, the inverse moment of inertia.

    joint: JOINT row; a, b: MOTION rows.
    """
    j = joint
    return a.inverse_inertia + b.inverse_inertia if j.coordinate == ANGLE else inverse_mass_along(j, j.nx, j.ny, a, b)


@subkernel
def spring_inverse_mass(joint, a, b):
    """Return the inverse effective mass that a joint's spring acts on, if the joint's other parts are rigid.

    The frequency and the damping ratio of the spring refer to this mass. A door on a spring swings with its inertia
    about the hinge, and a slider does not rotate. Box2D v3 uses the moments of inertia about the centres instead. A
    door then swings slower, and overshoots when critically damped. For the axis of a Wheel and for a Distance the
    result is coordinate_inverse_mass. joint: JOINT row; a, b: MOTION rows.
    """
    j = joint
    if j.hold == ON_AXIS and j.coordinate == TRANSLATION and j.locks_angle:
        return a.inverse_mass + b.inverse_mass
    inverse = coordinate_inverse_mass(j, a, b)
    if j.hold == PINNED and j.coordinate == ANGLE:
        k_11, k_12, k_22 = point_inverse_mass(j, a, b)
        determinant = k_11 * k_22 - k_12 * k_12
        if determinant > 0.0:
            x = a.inverse_inertia * j.ay + b.inverse_inertia * j.by
            y = a.inverse_inertia * j.ax + b.inverse_inertia * j.bx
            shared = (k_22 * x * x + 2.0 * k_12 * x * y + k_11 * y * y) / determinant
            return max(inverse - shared, LEAST_INVERSE * inverse)
    return inverse


@inlined
def softness_of(hertz, damping, h):
    """Return (bias rate [1/s], factor on the effective mass, fraction of the impulse given up) of an implicit spring.

    The constants are for one substep of h [s]. hertz [1/s]: frequency; damping: damping ratio. The last two results add
    up to 1.
    """
    omega = math.tau * hertz
    rate = 2.0 * damping + h * omega
    grip = h * omega * rate
    give = 1.0 / (1.0 + grip)
    return omega / rate if rate > 0.0 else 0.0, grip * give, give


@inlined
def spring_of(hertz, damping, h):
    """Return (rate [1/s], carry, give) of a spring on a coordinate, over a substep of h [s]. Stable at any frequency.

    Let c be the coordinate's distance from rest, v its velocity at the start of the substep, and w its inverse
    effective mass. The spring solves: new velocity + give · w · impulse = carry · v - rate · c.

    An undamped spring has the stiffness of the implicit midpoint rule, and keeps its energy (Hairer, Lubich and Wanner,
    Geometric Numerical Integration, 2006, chapter 6). With a damping ratio of 1 or more, the spring is an implicit
    Euler step, which does not overshoot (Catto, Soft Constraints, GDC 2011). So is a spring that oscillates too fast
    for the substeps. hertz [1/s]: frequency; damping: damping ratio.
    """
    x = h * math.tau * hertz
    implicit = max(min(damping, 1.0), 1.0 - RESOLVED / x if x > RESOLVED else 0.0)
    grip = 0.25 * (1.0 + 3.0 * implicit) * x * x + 2.0 * damping * x
    if not grip > 0.0:
        return 0.0, 0.0, 0.0
    return x * x / (grip * h), 0.25 * (1.0 - implicit) * x * x / grip, 1.0 / grip


@subkernel
def aim_springs(rows, h, motions, joints_inout):
    """Write the target velocities of springs on coordinates for a substep, before other impulses act. O(rows).

    rows: indices of JOINT rows; h [s]: length of the substep; motions: MOTION rows. joints_inout: JOINT rows.
    """
    for k in range(len(rows)):
        j = joints_inout[rows[k]]
        if has_spring(j):
            a, b = motions[j.motion_a], motions[j.motion_b]
            place_joint(a, b, j)
            rate, carry, _ = spring_of(j.spring_hertz, j.spring_damping, h)
            j.spring_aim = carry * coordinate_speed(j, a, b) - rate * (coordinate_of(j) - j.spring_target)


@inlined
def rigid_softness(biased, context):
    """Return the softness of a joint's part that has no spring of its own. The result has the format of softness_of.

    biased: False in the relaxing pass, in which the part is fully rigid and errors of position are ignored; context:
    see StepContext, whose `joint` gives the softness in the pass with bias.
    """
    if not biased:
        return 0.0, 1.0, 0.0
    give = 1.0 / (1.0 + context.joint.grip)
    return context.joint.bias_rate, context.joint.grip * give, give


@inlined
def bounded(value, most):
    """Return a value clamped to the range from -most to most."""
    return min(max(value, -most), most)


@inlined
def slowed(bias, most, mass_share, give):
    """Return (factor on the bias, mass_share, give) of a soft part whose bias is limited to a speed `most`.

    An impulse loses the share `give` in each substep. With a limited bias and the same `give`, the greatest force would
    be limited too: a loaded net stretched without end. So `give` shrinks as the bias does, and the part stays a spring
    of the same stiffness. bias: size of the bias without the limit; mass_share, give: see softness_of.
    """
    if not bias > most:
        return 1.0, mass_share, give
    factor = most / bias
    return factor, 1.0 - factor * give, factor * give


@inlined
def holds_point(joint):
    """Return whether the tree solver can solve the anchors of a joint: they are held together, with unbounded force."""
    return joint.hold != FREE and joint.follows_point and joint.point_max == math.inf


@inlined
def holds_angle(joint):
    """Return whether the tree solver can solve the angle of a joint: it is held, with unbounded torque."""
    return joint.locks_angle and joint.follows_angle and joint.angle_max == math.inf


@inlined
def holds_coordinate(joint):
    """Return whether the tree solver can solve the coordinate of a joint: it has equal limits, or a spring."""
    return joint.coordinate != NO_COORDINATE and (joint.lower == joint.upper or joint.spring_hertz > 0.0)


@inlined
def has_spring(joint):
    """Return whether a joint has a spring on its coordinate."""
    return joint.coordinate != NO_COORDINATE and joint.spring_hertz > 0.0


@inlined
def is_coordinate_free(joint):
    """Return whether no spring, motor or limit acts on a joint's coordinate. True also for a joint without one."""
    j = joint
    unlimited = j.lower == -math.inf and j.upper == math.inf
    return j.coordinate == NO_COORDINATE or (j.spring_hertz == 0.0 and j.motor_max == 0.0 and unlimited)


@inlined
def is_rigid_pin(joint):
    """Return whether a joint only holds its anchors together, rigidly, in both directions and at any force."""
    j = joint
    rigid = j.hold == PINNED and j.follows_point and j.point_hertz == 0.0 and j.point_max == math.inf
    return rigid and not j.locks_angle and not has_motor(j) and is_coordinate_free(j)


@inlined
def has_wide_gap(joint, wide_gap):
    """Return whether the anchors of a joint are too far apart to be drawn together by a velocity.

    joint: JOINT row, placed by place_joint; wide_gap [px]: see StepContext.
    """
    j = joint
    error = 0.0
    if holds_point(j) and j.hold == PINNED:
        error = norm(j.apart_x, j.apart_y) if j.point_hertz == 0.0 else 0.0
    elif holds_point(j):
        error = abs(j.apart_y * j.nx - j.apart_x * j.ny)
    if holds_coordinate(j) and j.coordinate != ANGLE and j.lower == j.upper:
        error = max(error, abs(coordinate_of(j) - j.lower))
    return error > wide_gap


@inlined
def has_limits(joint):
    """Return whether a joint's coordinate has limits and can move between them. False for gears and pulleys."""
    bounded_side = joint.lower > -math.inf or joint.upper < math.inf
    return joint.coordinate != NO_COORDINATE and joint.hold < GEARED and joint.lower != joint.upper and bounded_side


@inlined
def has_motor(joint):
    """Return whether a joint has a motor, on its angle or on its coordinate."""
    return joint.motor_max > 0.0 and (joint.turns_motor or joint.coordinate != NO_COORDINATE)


@inlined
def turns(joint):
    """Return whether a gear uses the angle of this joint (True) or its translation (False)."""
    return joint.coordinate == ANGLE or joint.turns_motor


# ---- Jacobians -------------------------------------------------------------------------------------------------------


@subkernel
def write_line(joint, nx, ny, row_out):
    """Write the Jacobian of the velocity of B's anchor relative to A's anchor, along a unit vector (nx, ny).

    joint: JOINT row; row_out: JOINT_ROW.
    """
    j, r = joint, row_out
    r.ax, r.ay, r.aw = -nx, -ny, j.ay * nx - j.ax * ny
    r.bx, r.by, r.bw = nx, ny, j.bx * ny - j.by * nx


@subkernel
def write_turn(row_out):
    """Write the Jacobian of the angular velocity of B relative to A. row_out: JOINT_ROW."""
    r = row_out
    r.ax, r.ay, r.aw = 0.0, 0.0, -1.0
    r.bx, r.by, r.bw = 0.0, 0.0, 1.0


# ---- parts -----------------------------------------------------------------------------------------------------------


@subkernel
def solve_motor(context, joint_inout, a_inout, b_inout):
    """Solve the motor of a joint: it drives the coordinate or the angle at motor_speed, with a bounded force or torque.

    context: see StepContext; joint_inout: JOINT row; a_inout, b_inout: MOTION rows.
    """
    j, a, b = joint_inout, a_inout, b_inout
    if j.turns_motor:
        inverse = a.inverse_inertia + b.inverse_inertia
        speed = b.angular_velocity - a.angular_velocity
    else:
        inverse = coordinate_inverse_mass(j, a, b)
        speed = coordinate_speed(j, a, b)
    if inverse <= 0.0:
        return
    before = j.motor
    j.motor = bounded(before + (j.motor_speed - speed) / inverse, j.motor_max * context.h)
    if j.turns_motor:
        push(j, 0.0, 0.0, j.motor - before, a, b)
    else:
        push_coordinate(j, j.motor - before, a, b)


@subkernel
def limit_change(gap, speed, old, mass, soft, most, inverse_h):
    """Return the change of impulse of a joint limit that keeps gap >= 0. The accumulated impulse stays at least 0.

    gap [px or rad]: distance of the coordinate from the limit, which may close completely in this substep; speed: rate
    of change of the gap; old: accumulated impulse; mass: effective mass; soft: result of softness_of; most: greatest
    speed at which a violation is corrected; inverse_h [1/s]: inverse of a substep.
    """
    bias_rate, mass_share, give = soft
    if gap > 0.0:
        change = -mass * (speed + gap * inverse_h)
    else:
        bias = bias_rate * gap
        factor, mass_share, give = slowed(-bias, most, mass_share, give)
        change = -mass * mass_share * (speed + factor * bias) - give * old
        # A motor may press so hard on the limit that the softness alone would let it pass.
        change = max(change, -mass * speed)
    return max(old + change, 0.0) - old


@subkernel
def solve_coordinate(biased, soft, context, joint_inout, a_inout, b_inout):
    """Solve the spring, the motor and the limits on the coordinate of a joint.

    biased: True to also remove errors of position; soft: result of rigid_softness; context: see StepContext;
    joint_inout: JOINT row; a_inout, b_inout: MOTION rows.
    """
    j, a, b = joint_inout, a_inout, b_inout
    inverse = coordinate_inverse_mass(j, a, b)
    if inverse <= 0.0:
        return
    mass = 1.0 / inverse
    now = coordinate_of(j)
    if j.spring_hertz > 0.0 and not j.direct:
        _, _, give = spring_of(j.spring_hertz, j.spring_damping, context.h)
        compliance = give * spring_inverse_mass(j, a, b)
        change = (j.spring_aim - coordinate_speed(j, a, b) - compliance * j.spring) / (inverse + compliance)
        j.spring += change
        push_coordinate(j, change, a, b)
    if j.motor_max > 0.0 and not j.turns_motor and not j.exact_motor:
        solve_motor(context, j, a, b)
    if j.exact_limits:
        return
    most = context.push_turn if j.coordinate == ANGLE else context.push_speed
    if j.direct and biased:
        soft = (LIMIT_SHARE * context.inverse_h, 1.0, 0.0)  # a soft limit would yield to the rigid parts of the tree
    if j.lower == j.upper:
        if j.direct:
            return
        rate, mass_share, give = soft
        bias = rate * (now - j.lower)
        factor, mass_share, give = slowed(abs(bias), most, mass_share, give)
        change = -mass * mass_share * (coordinate_speed(j, a, b) + factor * bias) - give * j.low
        j.low += change
        push_coordinate(j, change, a, b)
        return
    if j.lower > -math.inf:
        change = limit_change(now - j.lower, coordinate_speed(j, a, b), j.low, mass, soft, most, context.inverse_h)
        j.low += change
        push_coordinate(j, change, a, b)
    if j.upper < math.inf:
        change = limit_change(j.upper - now, -coordinate_speed(j, a, b), j.high, mass, soft, most, context.inverse_h)
        j.high += change
        push_coordinate(j, -change, a, b)


@subkernel
def solve_hold_of_angle(soft, context, joint_inout, a_inout, b_inout):
    """Solve the part of a joint that holds its angle, with a bounded torque.

    The angle is held rigidly or by a spring, or only the angular velocity is controlled. soft: result of
    rigid_softness; context: see StepContext; joint_inout: JOINT row; a_inout, b_inout: MOTION rows.
    """
    j, a, b = joint_inout, a_inout, b_inout
    inverse = a.inverse_inertia + b.inverse_inertia
    if inverse <= 0.0:
        return
    rate, mass_share, give = soft
    if j.angle_hertz > 0.0:
        rate, mass_share, give = softness_of(j.angle_hertz, j.angle_damping, context.h)
    if not j.follows_angle:
        rate, mass_share, give = 0.0, 1.0, 0.0
    speed = b.angular_velocity - a.angular_velocity - j.target_spin + rate * j.turn
    before = j.hold_impulse
    j.hold_impulse = bounded(before - mass_share * speed / inverse - give * before, j.angle_max * context.h)
    push(j, 0.0, 0.0, j.hold_impulse - before, a, b)


@subkernel
def solve_hold_across(soft, context, joint_inout, a_inout, b_inout):
    """Solve the part of a joint that keeps B's anchor on the axis of A.

    soft: result of rigid_softness; context: see StepContext; joint_inout: JOINT row; a_inout, b_inout: MOTION rows.
    """
    j, a, b = joint_inout, a_inout, b_inout
    inverse = inverse_mass_along(j, -j.ny, j.nx, a, b)
    if inverse <= 0.0:
        return
    rate, mass_share, give = soft
    across = j.apart_y * j.nx - j.apart_x * j.ny
    bias = rate * across
    factor, mass_share, give = slowed(abs(bias), context.push_speed, mass_share, give)
    change = -mass_share * (speed_across(j, -j.ny, j.nx, a, b) + factor * bias) / inverse - give * j.point_y
    j.point_y += change
    push(j, -j.ny * change, j.nx * change, 0.0, a, b)


@subkernel
def change_point(bias_x, bias_y, mass_share, give, a, b, joint_inout):
    """Change the impulse at the anchors of a joint, so that B's anchor moves at minus a bias relative to A's anchor.

    Both directions are solved together. The caller applies the change. bias_x, bias_y [px/s]; mass_share, give: see
    softness_of; a, b: MOTION rows; joint_inout: JOINT row.
    """
    j = joint_inout
    k_11, k_12, k_22 = point_inverse_mass(j, a, b)
    determinant = k_11 * k_22 - k_12 * k_12
    if determinant <= 0.0:
        return
    x = b.vx - a.vx - b.angular_velocity * j.by + a.angular_velocity * j.ay + bias_x
    y = b.vy - a.vy + b.angular_velocity * j.bx - a.angular_velocity * j.ax + bias_y
    before_x, before_y = j.point_x, j.point_y
    j.point_x -= mass_share * (k_22 * x - k_12 * y) / determinant + give * before_x
    j.point_y -= mass_share * (k_11 * y - k_12 * x) / determinant + give * before_y


@subkernel
def solve_hold_of_point(soft, context, joint_inout, a_inout, b_inout):
    """Solve the part of a joint that holds its two anchors together, with a bounded force.

    The anchors are held rigidly or by a spring, or only their relative velocity is controlled. soft: result of
    rigid_softness; context: see StepContext; joint_inout: JOINT row; a_inout, b_inout: MOTION rows.
    """
    j, a, b = joint_inout, a_inout, b_inout
    rate, mass_share, give = soft
    if j.point_hertz > 0.0:
        rate, mass_share, give = softness_of(j.point_hertz, j.point_damping, context.h)
    bias_x, bias_y = rate * j.apart_x, rate * j.apart_y
    if max(abs(bias_x), abs(bias_y)) > 0.5 * context.push_speed and j.point_hertz == 0.0:
        factor, mass_share, give = slowed(norm(bias_x, bias_y), context.push_speed, mass_share, give)
        bias_x, bias_y = factor * bias_x, factor * bias_y
    if not j.follows_point:
        mass_share, give = 1.0, 0.0
        bias_x = j.ny * j.target_vy - j.nx * j.target_vx  # nx, ny: the x axis of A
        bias_y = -j.ny * j.target_vx - j.nx * j.target_vy
    before_x, before_y = j.point_x, j.point_y
    change_point(bias_x, bias_y, mass_share, give, a, b, j)
    if j.point_max < math.inf:
        most = j.point_max * context.h
        size = norm(j.point_x, j.point_y)
        if size > most:
            j.point_x *= most / size
            j.point_y *= most / size
    push(j, j.point_x - before_x, j.point_y - before_y, 0.0, a, b)


@subkernel
def solve_pin(soft, push_speed, joint_inout, a_inout, b_inout):
    """Solve a joint with JOINT.is_pin. The result is that of solve_hold_of_point, to the bit, in less time.

    It reads three cache lines of the row, and a substep of a net of 4,900 pins takes .6 of the time.
    soft: result of rigid_softness; push_speed [px/s]: greatest speed at which a gap closes; joint_inout: JOINT row;
    a_inout, b_inout: MOTION rows.
    """
    j, a, b = joint_inout, a_inout, b_inout
    rate, mass_share, give = soft
    bias_x, bias_y = rate * j.apart_x, rate * j.apart_y
    if max(abs(bias_x), abs(bias_y)) > 0.5 * push_speed:
        factor, mass_share, give = slowed(norm(bias_x, bias_y), push_speed, mass_share, give)
        bias_x, bias_y = factor * bias_x, factor * bias_y
    before_x, before_y = j.point_x, j.point_y
    change_point(bias_x, bias_y, mass_share, give, a, b, j)
    push(j, j.point_x - before_x, j.point_y - before_y, 0.0, a, b)


# ---- passes ----------------------------------------------------------------------------------------------------------


@subkernel
def impulse_of(joint):
    """Return (x, y, angular impulse) that a JOINT row has applied to body B in the present substep."""
    j = joint
    x, y, torque = 0.0, 0.0, j.hold_impulse
    if j.hold == PINNED:
        x, y = j.point_x, j.point_y
    elif j.hold == ON_AXIS:
        x, y = -j.ny * j.point_y, j.nx * j.point_y
    along = j.spring + j.low - j.high
    if j.turns_motor:
        torque += j.motor
    else:
        along += j.motor
    if j.coordinate == ANGLE:
        torque += along
    else:
        x += along * j.nx
        y += along * j.ny
    return x, y, torque


@subkernel
def warm_joints(rows, first, wide_gap, joints_inout, motions_inout):
    """Apply the impulses of the last substep (warm start). O(rows).

    rows: indices of JOINT rows; first: True in the first substep of a step; wide_gap [px]: see StepContext;
    motions_inout: MOTION rows. In the first substep, the geometry of the joints is computed, and wide gaps are noted.
    In later substeps, the geometry is known from the end of the previous substep, whose impulses are added to the
    totals of the step.
    """
    for k in range(len(rows)):
        j = joints_inout[rows[k]]
        a, b = motions_inout[j.motion_a], motions_inout[j.motion_b]
        if first:
            if j.is_pin:
                place_anchors(a, b, j)
                far = norm(j.apart_x, j.apart_y) > wide_gap
            else:
                place_joint(a, b, j)
                far = has_wide_gap(j, wide_gap)
            a.has_wide_gap = a.has_wide_gap or far
            b.has_wide_gap = b.has_wide_gap or far
        if j.is_pin:
            x, y, torque = j.point_x, j.point_y, 0.0
        else:
            x, y, torque = impulse_of(j)
        if not first:
            j.total_x += x
            j.total_y += y
            j.total_torque += torque
        push(j, x, y, torque, a, b)
        a.in_contact = True
        b.in_contact = True


@subkernel
def solve_joints(rows, biased, context, joints_inout, motions_inout):
    """Solve every joint once, except for the parts that the tree solver solves. O(rows).

    rows: indices of JOINT rows; biased: True to also remove errors of position, False to solve only the velocities at
    the present poses; context: see StepContext. motions_inout: MOTION rows.
    """
    soft = rigid_softness(biased, context)
    for k in range(len(rows)):
        j = joints_inout[rows[k]]
        a, b = motions_inout[j.motion_a], motions_inout[j.motion_b]
        if j.is_pin:
            if not biased:
                place_anchors(a, b, j)
            solve_pin(soft, context.push_speed, j, a, b)
            continue
        if not biased:
            place_joint(a, b, j)
        if j.turns_motor and j.motor_max > 0.0 and not j.exact_motor:
            solve_motor(context, j, a, b)
        if not is_coordinate_free(j):
            solve_coordinate(biased, soft, context, j, a, b)
        if j.locks_angle and not (j.direct and holds_angle(j)):
            solve_hold_of_angle(soft, context, j, a, b)
        if j.direct and holds_point(j):
            continue
        if j.hold == ON_AXIS:
            solve_hold_across(soft, context, j, a, b)
        elif j.hold == PINNED:
            solve_hold_of_point(soft, context, j, a, b)


@subkernel
def sum_joints(rows, joints_inout):
    """Add the impulses of the last substep to the totals of the step. rows: indices of JOINT rows. O(rows)."""
    for k in range(len(rows)):
        j = joints_inout[rows[k]]
        if j.is_pin:
            j.total_x += j.point_x
            j.total_y += j.point_y
            continue
        x, y, torque = impulse_of(j)
        j.total_x += x
        j.total_y += y
        j.total_torque += torque
