"""Report of joints after a step, as in `world.joints`: forces, coordinates, speeds, errors, and whether a joint broke.

Also here: the impulses that are kept for the next step, and the number of substeps that the joints need.
"""

import numpy as np

from physics.jit import kernel, subkernel
from physics.math2d import norm, rotation_of
from physics.solver.joint_rows import turns
from physics.tables.joint import GEARED, LENGTH, ON_AXIS, PINNED, SLUNG, TRANSLATION
from physics.tables.step_state import StepState, stage
from physics.tables.table import row_of


@subkernel
def place_anchor(body, x, y):
    """Return the world position (x, y) [px] of a point of a body. body: BODY row; x, y [px]: point in body space."""
    c, s = rotation_of(body.angle)
    return body.x + c * x - s * y, body.y + s * x + c * y


@subkernel
def velocity_at(body, x, y):
    """Return the velocity (x, y) [px/s] of a body at a point (x, y) [px] of the world. body: BODY row."""
    w = body.angular_velocity
    return body.vx - w * (y - body.center_y), body.vy + w * (x - body.center_x)


@subkernel
def side_after_step(identity, body_row, bodies, joints):
    """Return (coordinate, its rate, speed [px/s]) of one side of a gear at the present poses.

    A side of a gear is a joint or, with the id NO_JOINT, a body. Its coordinate is an angle [rad] or a translation
    [px]. For an angle, the speed is that of the body's point furthest from its centre. identity: id of the joint;
    body_row: row number in BODY of the side; joints: JOINT rows, reported up to this joint.
    """
    row = row_of(joints, identity)
    extent = bodies[body_row].extent if body_row >= 0 else 0.0
    if row < 0:
        if body_row < 0:
            return 0.0, 0.0, 0.0
        spin = bodies[body_row].angular_velocity
        return bodies[body_row].angle, spin, abs(spin) * extent
    j = joints[row]
    if not turns(j):
        return j.translation, j.speed, abs(j.speed)
    spin = bodies[j.body_row_b].angular_velocity if j.body_row_b >= 0 else 0.0
    spin -= bodies[j.body_row_a].angular_velocity if j.body_row_a >= 0 else 0.0
    return j.angle, spin, abs(spin) * extent


@subkernel
def report_gear(bodies, joints, joint_inout):
    """Write the sum of a gear's coordinates, its rate and its error, and the speed of the gear's faster side.

    bodies: BODY rows; joints: JOINT rows, in which the rows before the gear hold their results; joint_inout: JOINT row
    of the gear.
    """
    j = joint_inout
    value, speed, rate = side_after_step(j.joint_a, j.body_row_a, bodies, joints)
    other, other_speed, other_rate = side_after_step(j.joint_b, j.body_row_b, bodies, joints)
    j.translation = value + j.ratio * other
    j.speed = speed + j.ratio * other_speed
    j.separation = abs(j.translation - j.phase)
    j.rate = max(rate, other_rate)


@subkernel
def rope_after_step(body_row, x, y, ground_x, ground_y, bodies):
    """Return (length [px], its rate [px/s]) of the rope from a pulley wheel to the anchor of a body.

    body_row: row number in BODY, WORLD for the world; x, y [px]: the anchor in the space of the body; ground_x,
    ground_y [px]: position of the wheel in the world.
    """
    vx, vy = 0.0, 0.0
    if body_row >= 0:
        body = bodies[body_row]
        x, y = place_anchor(body, x, y)
        vx, vy = velocity_at(body, x, y)
    x, y = x - ground_x, y - ground_y
    length = norm(x, y)
    return length, (vx * x + vy * y) / length if length > 0.0 else 0.0


@subkernel
def report_pulley(bodies, joint_inout):
    """Write a pulley's rope length, the rate and the error of this length, and the speed of its faster side.

    bodies: BODY rows; joint_inout: JOINT row.
    """
    j = joint_inout
    value, speed = rope_after_step(j.body_row_a, j.local_ax, j.local_ay, j.ground_ax, j.ground_ay, bodies)
    other, other_speed = rope_after_step(j.body_row_b, j.local_bx, j.local_by, j.ground_bx, j.ground_by, bodies)
    j.translation = value + j.ratio * other
    j.speed = speed + j.ratio * other_speed
    j.separation = max(j.lower - j.translation, j.translation - j.upper, 0.0)
    j.rate = max(abs(speed), abs(other_speed))


@kernel
def report_joints(bodies, joints_inout):
    """Write angle, translation, speed, separation and `broken` of all joints at the present poses. O(joints).

    bodies: BODY rows; joints_inout: JOINT rows.
    """
    for k in range(len(joints_inout)):
        j = joints_inout[k]
        ax, ay, bx, by = j.local_ax, j.local_ay, j.local_bx, j.local_by
        nx, ny = j.axis_x, j.axis_y
        angle, spin, vx, vy = -j.reference, 0.0, 0.0, 0.0
        if j.body_row_b >= 0:
            b = bodies[j.body_row_b]
            bx, by = place_anchor(b, bx, by)
            angle += b.angle
            spin += b.angular_velocity
            vx, vy = velocity_at(b, bx, by)
        if j.body_row_a >= 0:
            a = bodies[j.body_row_a]
            c, s = rotation_of(a.angle)
            ax, ay = a.x + c * ax - s * ay, a.y + s * ax + c * ay
            nx, ny = c * j.axis_x - s * j.axis_y, s * j.axis_x + c * j.axis_y
            angle -= a.angle
            spin -= a.angular_velocity
            # Where the axis turns with A, the speed along it is relative to A at the anchor of B.
            on_axis = j.coordinate == TRANSLATION
            ux, uy = velocity_at(a, bx if on_axis else ax, by if on_axis else ay)
            vx -= ux
            vy -= uy
        x, y = bx - ax, by - ay
        apart = norm(x, y)
        j.angle = angle
        j.translation = x * nx + y * ny
        j.speed = spin
        j.separation = apart if j.hold == PINNED and j.follows_point else 0.0
        if j.hold == ON_AXIS:
            j.separation = abs(y * nx - x * ny)
        if j.coordinate == TRANSLATION:
            j.speed = vx * nx + vy * ny
        elif j.coordinate == LENGTH:
            j.translation = apart
            j.speed = (vx * x + vy * y) / apart if apart > 0.0 else 0.0
            j.separation = max(j.lower - apart, apart - j.upper, 0.0)
        if j.hold == GEARED:
            report_gear(bodies, joints_inout, j)
        elif j.hold == SLUNG:
            report_pulley(bodies, j)
        j.broken = j.awake and (norm(j.force_x, j.force_y) > j.break_force or abs(j.torque) > j.break_torque)


@stage("joints", reads=("bodies", "joints"), writes=("joints",))
def measure_joints(state: StepState) -> None:
    """Write coordinates, speeds and errors of all joints at the final poses of the step, and mark broken joints."""
    report_joints(state.bodies, state.joints)


def mark_sleeping(bodies: np.ndarray, joints: np.ndarray) -> None:
    """Clear the column `awake` of the joints that have no awake body. bodies: BODY rows; joints: JOINT rows."""
    a, b = joints["body_row_a"], joints["body_row_b"]
    joints["awake"] &= ((a >= 0) & bodies["awake"][a]) | ((b >= 0) & bodies["awake"][b])


# ---- forces and loads ------------------------------------------------------------------------------------------------


@kernel
def store_joints(rows, context, joints_inout):
    """Write the forces of the step, and the cached forces for the next step, to the joints. O(rows).

    rows: indices of JOINT rows; context: see StepContext.
    """
    rest = 1.0 - context.share
    rate = context.share * context.inverse_h
    for k in range(len(rows)):
        j = joints_inout[rows[k]]
        j.force_x, j.force_y = j.total_x * context.inverse_dt, j.total_y * context.inverse_dt
        j.torque = j.total_torque * context.inverse_dt
        j.point_force_x = rate * j.point_x + rest * j.point_force_x
        j.point_force_y = rate * j.point_y + rest * j.point_force_y
        j.hold_torque = rate * j.hold_impulse + rest * j.hold_torque
        j.spring_force = rate * j.spring + rest * j.spring_force
        j.motor_force = rate * j.motor + rest * j.motor_force
        j.lower_force = rate * j.low + rest * j.lower_force
        j.upper_force = rate * j.high + rest * j.upper_force


@kernel
def estimate_joints(rows, joints, substeps, rules, accuracy, motions_inout):
    """Raise MOTION.estimate to the square of the number of substeps that the joints of a body need. O(rows).

    In the iterative tier, a joint's spring has twice the frequency of a contact's spring, so the joint sags by a
    quarter as much. For the force of a joint, as for the load of a contact, an island takes at most rules.most_by_load
    substeps; MOTION.capped is set if it would need more. The sag of a held angle counts in full, because it adds up
    along a beam. In both tiers, if an arm r rotates by an angle φ in a substep, its anchor is displaced by r φ² / 2.

    rows: indices of JOINT rows; substeps: number in this step; rules: see substeps.LoadRules; accuracy [px]: greatest
    accepted error. motions_inout: MOTION rows.
    """
    reach = max(substeps, rules.most_by_load)
    reach_squared = float(reach * reach)
    by_load = 0.5 * float(rules.most_by_load * rules.most_by_load)  # see contact_lanes.add_estimates
    for k in range(len(rows)):
        j = joints[rows[k]]
        a, b = motions_inout[j.motion_a], motions_inout[j.motion_b]
        arm_a, arm_b = norm(j.ax, j.ay), norm(j.bx, j.by)
        turn_a, turn_b = rules.dt * a.angular_velocity, rules.dt * b.angular_velocity
        estimate = 0.5 * max(turn_a * turn_a * arm_a, turn_b * turn_b * arm_b) / accuracy
        if not j.direct:
            per_sag = 0.25 * rules.rate
            compliance = a.inverse_mass + b.inverse_mass
            compliance += a.inverse_inertia * arm_a * arm_a + b.inverse_inertia * arm_b * arm_b
            stretch = per_sag * norm(j.total_x, j.total_y) * compliance
            capped = stretch > reach_squared
            a.capped = a.capped or capped
            b.capped = b.capped or capped
            bend = abs(j.hold_impulse) * (a.inverse_inertia + b.inverse_inertia) * max(arm_a, arm_b)
            estimate = max(estimate, min(stretch, by_load), per_sag * bend)
        a.estimate = max(a.estimate, estimate)
        b.estimate = max(b.estimate, estimate)
