"""Restitution after the last substep, and simultaneous impacts on one body."""

import math

import numpy as np

from physics.jit import inlined, subkernel
from physics.solver import lanes as at
from physics.solver.lanes import SIZE, lanes_of, solve_two
from physics.tables.step_state import CAP_HITS, RESTITUTION_ROWS

# ---- impulses --------------------------------------------------------------------------------------------------------
# Impulses between two motions at a point, and the velocities that they change.


@subkernel
def relative_speed(c, lane, second, a, b):
    """Return the speed [px/s] of B relative to A along the normal at a point of a lane; negative if they approach."""
    speed = (b.vx - a.vx) * c[at.NX + lane] + (b.vy - a.vy) * c[at.NY + lane]
    speed += b.angular_velocity * c[(at.B_2 if second else at.B_1) + lane]
    return speed - a.angular_velocity * c[(at.A_2 if second else at.A_1) + lane]


@subkernel
def push_pair(c, lane, second, impulse, a_inout, b_inout):
    """Apply an impulse along the normal at a point of a lane, to B forwards and to A backwards."""
    x = impulse * c[at.NX + lane]
    y = impulse * c[at.NY + lane]
    a_inout.vx -= a_inout.inverse_mass * x
    a_inout.vy -= a_inout.inverse_mass * y
    a_inout.angular_velocity -= a_inout.inverse_inertia * impulse * c[(at.A_2 if second else at.A_1) + lane]
    b_inout.vx += b_inout.inverse_mass * x
    b_inout.vy += b_inout.inverse_mass * y
    b_inout.angular_velocity += b_inout.inverse_inertia * impulse * c[(at.B_2 if second else at.B_1) + lane]


@subkernel
def speed_of_impact(speed, separation, acceleration):
    """Return the approach speed [px/s] at the moment of impact.

    separation [px] before the step; speed and acceleration [px/s2] of approach. Sides that overlapped keep their speed.
    """
    if speed <= 0.0 or separation <= 0.0:
        return speed
    return math.sqrt(max(speed * speed + 2.0 * acceleration * separation, 0.0))


# ---- simultaneous impacts --------------------------------------------------------------------------------------------
# Simultaneous impacts: several impacts of one body within a step, simulated in sequence.
#
# A flying body may hit a wall with one end, rotate, and hit it with the other end within the step, or hit the wall and
# the floor of a corner. The velocity before the step says nothing about the second impact, and the velocity that the
# substeps removed is not that of a bounce. So the impacts of such a body on static bodies are simulated from one to the
# next, along straight lines. Each keeps the energy that Newton's law of restitution gives at the time of the impact.

MOST_IMPACTS = 16  # impacts of one body within a step; more are left to the next step, and counted in cap_hits
TOGETHER = 1.0 / 64.0  # share of a step within which two points of a manifold hit at once
NO_IMPACT, LEFT_OUT = 0, -1  # values of MOTION.last_impact: none yet; not to be simulated

# A lane with an impulse that may bounce.
IMPACT = np.dtype(
    [
        ("block", np.int32),
        ("lane", np.int32),
        ("before", np.int32),  # another impact of the same body, plus one; NO_IMPACT: none
        ("simulated", np.bool_),
        ("speed_1", np.float64),  # [px/s] predicted impact speed of each point
        ("speed_2", np.float64),
        ("gap_1", np.float64),  # [px] gap before that impact
        ("gap_2", np.float64),
        ("impulse_1", np.float64),
        ("impulse_2", np.float64),
    ],
    align=True,
)


def make_impacts(room: int) -> np.ndarray:
    """Return room for that many IMPACT rows."""
    return np.zeros(room, IMPACT)


@inlined
def line_of(blocks, impact, line):
    """Return the value of a line, such as lanes.NX, of the lane of an impact."""
    return blocks.lines[impact.block * SIZE + line + impact.lane]


@inlined
def points_of(blocks, impact):
    """Return the number of points of an impact."""
    return 2 if line_of(blocks, impact, at.MASS_2) > 0.0 else 1


@subkernel
def list_impacts(blocks, count, impacts_out):
    """List the lanes, of so many blocks, that may bounce and had an impulse in this step. Return their number."""
    found = 0
    for block in range(count):
        c = blocks.lines[block * SIZE : (block + 1) * SIZE]
        for lane in range(lanes_of(blocks.contact, block)):
            if c[at.RESTITUTION + lane] > 0.0 and c[at.TOTAL_1 + lane] + c[at.TOTAL_2 + lane] > 0.0:
                r = impacts_out[found]
                r.block = block
                r.lane = lane
                r.simulated = False
                found += 1
    return found


@subkernel
def is_against_static(blocks, impact):
    """Return whether one side of an impact has infinite mass."""
    return line_of(blocks, impact, at.IM_A) == 0.0 or line_of(blocks, impact, at.IM_B) == 0.0


@subkernel
def mover_of(blocks, impact, motions):
    """Return the dynamic side of an impact against a static body: its MOTION row, and 1.0 for B, -1.0 for A."""
    row = blocks.motion_b[impact.block, impact.lane]
    if motions[row].inverse_mass > 0.0:
        return row, 1.0
    return blocks.motion_a[impact.block, impact.lane], -1.0


@subkernel
def link_impacts(blocks, count, impacts_inout, motions_inout):
    """Link the impacts of each body that may bounce: MOTION.last_impact is its last one plus one, IMPACT.before the one
    before.

    A body that also has a resting contact, or hits a dynamic body, is left out. O(count).
    """
    for i in range(count):
        r = impacts_inout[i]
        if is_against_static(blocks, r) and line_of(blocks, r, at.RESTING) == 0.0:
            row, _ = mover_of(blocks, r, motions_inout)
            m = motions_inout[row]
            r.before = m.last_impact
            if m.last_impact != LEFT_OUT:
                m.last_impact = i + 1
        else:
            for side in range(2):
                rows = blocks.motion_a if side == 0 else blocks.motion_b
                m = motions_inout[rows[r.block, r.lane]]
                if m.inverse_mass > 0.0:
                    m.last_impact = LEFT_OUT


@subkernel
def unlink_impacts(blocks, impacts, count, motions_inout):
    """Reset the links in the motions."""
    for i in range(count):
        r = impacts[i]
        motions_inout[blocks.motion_a[r.block, r.lane]].last_impact = NO_IMPACT
        motions_inout[blocks.motion_b[r.block, r.lane]].last_impact = NO_IMPACT


@subkernel
def arm_of(blocks, impact, second, sign):
    """Return the moment arm [px] of an impulse along the normal at a point of the mover."""
    if sign > 0.0:
        return line_of(blocks, impact, at.B_2 if second else at.B_1)
    return line_of(blocks, impact, at.A_2 if second else at.A_1)


@subkernel
def is_simulated(blocks, impacts, last, contacts, threshold):
    """Return whether the impacts of a body, linked from `last`, are to be simulated in sequence.

    That is so if it has impacts at two points, other than the two of one manifold that both approached before.
    """
    points = 0
    rows = 0
    fast = 0
    k = last
    while k != NO_IMPACT:
        r = impacts[k - 1]
        c = contacts[blocks.contact[r.block, r.lane]]
        rows += 1
        for point in range(points_of(blocks, r)):
            total = line_of(blocks, r, at.TOTAL_1 if point == 0 else at.TOTAL_2)
            speed = c.speed_1 if point == 0 else c.speed_2
            points += int(total > 0.0)
            fast += int(total > 0.0 and speed > threshold)
        k = r.before
    return fast > 0 and points > 1 and (rows > 1 or fast < points)


@subkernel
def speed_now(blocks, impacts, last, row, second, motions):
    """Return the approach speed [px/s] of a point after the impulses that its body got so far."""
    r = impacts[row]
    mover_row, sign = mover_of(blocks, r, motions)
    mover = motions[mover_row]
    arm = arm_of(blocks, r, second, sign)
    speed = r.speed_2 if second else r.speed_1
    k = last
    while k != NO_IMPACT:
        o = impacts[k - 1]
        _, other = mover_of(blocks, o, motions)
        along = line_of(blocks, r, at.NX) * line_of(blocks, o, at.NX)
        along += line_of(blocks, r, at.NY) * line_of(blocks, o, at.NY)
        for point in range(points_of(blocks, o)):
            impulse = o.impulse_1 if point == 0 else o.impulse_2
            if impulse > 0.0:
                turn = mover.inverse_inertia * arm * arm_of(blocks, o, point == 1, other)
                speed -= sign * other * (mover.inverse_mass * along + turn) * impulse
        k = o.before
    return speed


@subkernel
def predict_impact(blocks, contacts, motions, impact_inout):
    """Write the predicted impact speeds and gaps of an impact, from the state before the step."""
    r = impact_inout
    c = contacts[blocks.contact[r.block, r.lane]]
    a = motions[blocks.motion_a[r.block, r.lane]]
    b = motions[blocks.motion_b[r.block, r.lane]]
    two = points_of(blocks, r) == 2
    acceleration = (a.acceleration_x - b.acceleration_x) * line_of(blocks, r, at.NX)
    acceleration += (a.acceleration_y - b.acceleration_y) * line_of(blocks, r, at.NY)
    r.impulse_1, r.impulse_2 = 0.0, 0.0
    r.speed_1 = speed_of_impact(c.speed_1, c.separation_1, acceleration)
    r.speed_2 = speed_of_impact(c.speed_2, c.separation_2, acceleration) if two else 0.0
    r.gap_1 = max(c.separation_1, 0.0)
    r.gap_2 = max(c.separation_2, 0.0) if two else 0.0


@subkernel
def soonest_impact(blocks, impacts, last, threshold, motions):
    """Return the next impact of a body: its time [s], row plus one, whether it is the second point, approach speed."""
    soonest = math.inf
    hit = NO_IMPACT
    second = False
    hit_speed = 0.0
    k = last
    while k != NO_IMPACT:
        r = impacts[k - 1]
        for point in range(points_of(blocks, r)):
            speed = speed_now(blocks, impacts, last, k - 1, point == 1, motions)
            gap = r.gap_1 if point == 0 else r.gap_2
            if speed > threshold and gap < soonest * speed:
                soonest = gap / speed
                hit = k
                second = point == 1
                hit_speed = speed
        k = r.before
    return soonest, hit, second, hit_speed


@subkernel
def simulate_impacts(blocks, last, threshold, dt, contacts, motions, impacts_inout):
    """Simulate the impacts of a body, linked from `last`, over dt [s]: the impulse of each point goes to its IMPACT.

    Return whether MOST_IMPACTS was enough.
    """
    k = last
    while k != NO_IMPACT:
        predict_impact(blocks, contacts, motions, impacts_inout[k - 1])
        k = impacts_inout[k - 1].before
    left = dt
    for _ in range(MOST_IMPACTS):
        soonest, hit, second, hit_speed = soonest_impact(blocks, impacts_inout, last, threshold, motions)
        if hit == NO_IMPACT or soonest > left:
            return True
        left -= soonest
        k = last
        while k != NO_IMPACT:
            r = impacts_inout[k - 1]
            r.gap_1 = max(r.gap_1 - soonest * speed_now(blocks, impacts_inout, last, k - 1, False, motions), 0.0)
            if points_of(blocks, r) == 2:
                r.gap_2 = max(r.gap_2 - soonest * speed_now(blocks, impacts_inout, last, k - 1, True, motions), 0.0)
            k = r.before
        r = impacts_inout[hit - 1]
        back = 1.0 + line_of(blocks, r, at.RESTITUTION)
        other_speed = 0.0
        if points_of(blocks, r) == 2:
            other_speed = speed_now(blocks, impacts_inout, last, hit - 1, not second, motions)
        # Two points that hit nearly at the same time hit together, otherwise a flat landing would start a rotation.
        together = other_speed > threshold and (r.gap_1 if second else r.gap_2) <= TOGETHER * dt * other_speed
        speed_1 = hit_speed if not second else (other_speed if together else 0.0)
        speed_2 = hit_speed if second else (other_speed if together else 0.0)
        change_1 = line_of(blocks, r, at.MASS_1) * back * speed_1
        change_2 = line_of(blocks, r, at.MASS_2) * back * speed_2
        if together:
            factors = (
                line_of(blocks, r, at.OFF_DIAGONAL_1),
                line_of(blocks, r, at.OFF_DIAGONAL_2),
                line_of(blocks, r, at.BLOCK_FACTOR),
            )
            change_1, change_2 = solve_two(change_1, change_2, factors[0], factors[1], factors[2], 0.0, 0.0)
        r.impulse_1 += change_1
        r.impulse_2 += change_2
    return False


@subkernel
def apply_simulated(last, impacts_inout, motions_inout, blocks_inout):
    """Replace the impulses of the substeps by those of the simulated impacts. They are no cached forces for the next
    step.
    """
    k = last
    while k != NO_IMPACT:
        r = impacts_inout[k - 1]
        lane = r.lane
        c = blocks_inout.lines[r.block * SIZE : (r.block + 1) * SIZE]
        a = motions_inout[blocks_inout.motion_a[r.block, lane]]
        b = motions_inout[blocks_inout.motion_b[r.block, lane]]
        push_pair(c, lane, False, r.impulse_1 - c[at.TOTAL_1 + lane], a, b)
        c[at.NORMAL_1 + lane] = 0.0
        c[at.TOTAL_1 + lane] = r.impulse_1
        if points_of(blocks_inout, r) == 2:
            push_pair(c, lane, True, r.impulse_2 - c[at.TOTAL_2 + lane], a, b)
            c[at.NORMAL_2 + lane] = 0.0
            c[at.TOTAL_2 + lane] = r.impulse_2
        r.simulated = True
        k = r.before


@subkernel
def solve_simultaneous(
    # read
    contacts,
    count,
    threshold,
    dt,
    # write
    impacts_inout,
    motions_inout,
    blocks_inout,
    work_inout,
):
    """Apply simultaneous impacts: flying bodies that hit static ones several times within a step of dt [s].

    They are among so many IMPACT rows, which are then `simulated`. threshold [px/s]: slower impacts do not bounce.
    O(count + impacts · points² of such a body).
    """
    link_impacts(blocks_inout, count, impacts_inout, motions_inout)
    for i in range(count):
        r = impacts_inout[i]
        if not is_against_static(blocks_inout, r) or line_of(blocks_inout, r, at.RESTING) > 0.0:
            continue
        row, _ = mover_of(blocks_inout, r, motions_inout)
        # The last impact represents the body.
        if motions_inout[row].last_impact != i + 1:
            continue
        if is_simulated(blocks_inout, impacts_inout, i + 1, contacts, threshold):
            if not simulate_impacts(blocks_inout, i + 1, threshold, dt, contacts, motions_inout, impacts_inout):
                work_inout[CAP_HITS] += 1
            apply_simulated(i + 1, impacts_inout, motions_inout, blocks_inout)
    unlink_impacts(blocks_inout, impacts_inout, count, motions_inout)


# ---- bounce ----------------------------------------------------------------------------------------------------------
# Restitution, once, after the last substep, for every stacking solver.
#
# It uses the approach speed at the moment of impact, by the parabola from before the step. So a speculative contact
# that slowed the body does not reduce the bounce (Rapier #919, #974), and no height is lost by the length of steps. Two
# points of one manifold are solved together, otherwise a box that lands flat would rotate.


@subkernel
def bounces(speed, threshold, total):
    """Return whether a point bounces: it approached fast enough before the step, and got an impulse in it."""
    return speed > threshold and total > 0.0


@subkernel
def bounce_once(wanted, c, lane, second, total, a_inout, b_inout):
    """Apply restitution at one point of a lane, for a separation speed [px/s]. Return the change of its impulse.

    total: the impulse of the point so far.
    """
    mass = c[(at.MASS_2 if second else at.MASS_1) + lane]
    missing = wanted - relative_speed(c, lane, second, a_inout, b_inout)
    change = max(total + mass * missing, 0.0) - total
    push_pair(c, lane, second, change, a_inout, b_inout)
    return change


@subkernel
def bounce_together(wanted_1, wanted_2, c, lane, a_inout, b_inout):
    """Apply restitution at two points at once, for separation speeds [px/s], by the 2 x 2 system. Return the changes of
    their impulses.
    """
    missing_1 = wanted_1 - relative_speed(c, lane, False, a_inout, b_inout)
    missing_2 = wanted_2 - relative_speed(c, lane, True, a_inout, b_inout)
    old_1 = c[at.TOTAL_1 + lane]
    old_2 = c[at.TOTAL_2 + lane]
    x_1, x_2 = solve_two(
        c[at.MASS_1 + lane] * missing_1,
        c[at.MASS_2 + lane] * missing_2,
        c[at.OFF_DIAGONAL_1 + lane],
        c[at.OFF_DIAGONAL_2 + lane],
        c[at.BLOCK_FACTOR + lane],
        old_1,
        old_2,
    )
    push_pair(c, lane, False, x_1 - old_1, a_inout, b_inout)
    push_pair(c, lane, True, x_2 - old_2, a_inout, b_inout)
    return x_1 - old_1, x_2 - old_2


@subkernel
def restore_bounces(
    # read
    contacts,
    count,
    context,
    # write
    impacts_inout,
    motions_inout,
    blocks_inout,
    work_inout,
):
    """Set the separation speed of points with an impulse to restitution times the approach speed. O(lanes).

    count: number of blocks; context: see StepContext; impacts_inout: scratch.
    """
    threshold = context.restitution_speed
    found = list_impacts(blocks_inout, count, impacts_inout)
    solve_simultaneous(contacts, found, threshold, context.dt, impacts_inout, motions_inout, blocks_inout, work_inout)
    for i in range(found):
        r = impacts_inout[i]
        lane = r.lane
        c = blocks_inout.lines[r.block * SIZE : (r.block + 1) * SIZE]
        if r.simulated:
            work_inout[RESTITUTION_ROWS] += int(c[at.TOTAL_1 + lane] > 0.0) + int(c[at.TOTAL_2 + lane] > 0.0)
            continue
        predict_impact(blocks_inout, contacts, motions_inout, r)
        first = bounces(r.speed_1, threshold, c[at.TOTAL_1 + lane])
        second = points_of(blocks_inout, r) == 2 and bounces(r.speed_2, threshold, c[at.TOTAL_2 + lane])
        if not (first or second):
            continue
        work_inout[RESTITUTION_ROWS] += int(first) + int(second)
        a = motions_inout[blocks_inout.motion_a[r.block, lane]]
        b = motions_inout[blocks_inout.motion_b[r.block, lane]]
        wanted_1 = c[at.RESTITUTION + lane] * r.speed_1
        wanted_2 = c[at.RESTITUTION + lane] * r.speed_2
        change_1 = 0.0
        change_2 = 0.0
        if first and second:
            change_1, change_2 = bounce_together(wanted_1, wanted_2, c, lane, a, b)
        elif first:
            change_1 = bounce_once(wanted_1, c, lane, False, c[at.TOTAL_1 + lane], a, b)
        else:
            change_2 = bounce_once(wanted_2, c, lane, True, c[at.TOTAL_2 + lane], a, b)
        # It is no cached force for the next step.
        c[at.TOTAL_1 + lane] += change_1
        c[at.TOTAL_2 + lane] += change_2
