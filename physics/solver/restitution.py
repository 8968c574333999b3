"""Restitution after the last substep of the stacking solvers, and simulation of several impacts within a step."""

import math

import numpy as np

from physics.jit import inlined, subkernel
from physics.solver import lanes as at
from physics.solver.lanes import (
    SIZE,
    block_factor,
    clamp,
    lanes_of,
    push_along,
    push_pair,
    relative_speed,
    solve_two,
    tangential_speed,
)
from physics.solver.step_context import speed_of_impact
from physics.tables.step_state import CAP_HITS, RESTITUTION_ROWS

# ---- impacts ---------------------------------------------------------------------------------------------------------
# IMPACT rows: contacts with an impulse in this step that may bounce, or that pass an impact on to another body.

NO_IMPACT, LEFT_OUT = 0, -1  # values of MOTION.last_impact: no impact; impacts of the body are not simulated

IMPACT = np.dtype(
    [
        ("block", np.int32),
        ("lane", np.int32),
        ("before", np.int32),  # index of the previous impact of the same body, plus one; NO_IMPACT: none
        ("simulated", np.bool_),
        ("bounces_1", np.bool_),  # whether each point bounces
        ("bounces_2", np.bool_),
        ("speed_1", np.float64),  # [px/s] predicted impact speed of each point
        ("speed_2", np.float64),
        ("gap_1", np.float64),  # [px] gap before the predicted impact
        ("gap_2", np.float64),
        ("wanted_1", np.float64),  # [px/s] separation speed after the impact
        ("wanted_2", np.float64),
        ("impulse_1", np.float64),  # impulse of each point
        ("impulse_2", np.float64),
        ("blow_1", np.float64),  # part of the impulse from the present moment of the simulation
        ("blow_2", np.float64),
        # Only in the last impact of a body: sums over its simulated impacts.
        ("vx", np.float64),  # [px/s] change of the velocity of the body
        ("vy", np.float64),
        ("angular_velocity", np.float64),
        ("x", np.float64),  # [px] displacement of the body up to its last hit
        ("y", np.float64),
        ("turn", np.float64),
    ],
    align=True,
)


def make_impacts(room: int) -> np.ndarray:
    """Return an array of `room` cleared IMPACT rows."""
    return np.zeros(room, IMPACT)


@inlined
def line_of(blocks, impact, line):
    """Return a lane field of the contact of an IMPACT row. line: offset of the field, such as lanes.NX."""
    return blocks.lines[impact.block * SIZE + line + impact.lane]


@inlined
def points_of(blocks, impact):
    """Return the number of contact points of an IMPACT row, 1 or 2. blocks: see lanes.Blocks."""
    return 2 if line_of(blocks, impact, at.MASS_2) > 0.0 else 1


@subkernel
def list_impacts(blocks, count, impacts_out):
    """Write contacts with an impulse and restitution as IMPACT rows. Return their number. count: blocks in use."""
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
def predict_impact(blocks, contacts, motions, impact_inout):
    """Write the impact speeds [px/s] and gaps [px] of an IMPACT row, predicted from the state before the step."""
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


# ---- simultaneous impacts on static bodies ---------------------------------------------------------------------------
# Several impacts of a flying body on static bodies within a step, simulated in the order of their times.
#
# A flying body may hit a wall with one end, rotate, and hit the wall with the other end within the step. Or it may hit
# both the wall and the floor of a corner. The speed of the second impact cannot be predicted from the velocity before
# the step, and the impulses of the substeps do not make the body bounce. So all impacts of such a body on static bodies
# are simulated in the order of their times, with straight motion in between. Each impact follows Newton's law of
# restitution at its time. Points that hit at the same time, of one manifold or several, are solved together: otherwise
# a box that lands flat on ground made of pieces would start to rotate.

MOST_IMPACTS = 16  # greatest number of moments with impacts of a body within a step; if exceeded: cap_hits
TOGETHER = 1.0 / 64.0  # fraction of a step within which hits count as simultaneous
LATE = 1.0 / 16.0  # fraction of a step by which an impact may be late: substeps reach further than a parabola
MOST_ROUNDS = 256  # greatest number of rounds over the points that hit at the same time
ROUNDS = 32  # greatest number of rounds over bounces that share bodies; the remaining error is left to the next step
SETTLED = 1e-6  # the rounds end at this change of speed in a round, relative to the impact speed


@subkernel
def is_against_static(blocks, impact):
    """Return whether one body of an IMPACT row has infinite mass. blocks: see lanes.Blocks."""
    return line_of(blocks, impact, at.IM_A) == 0.0 or line_of(blocks, impact, at.IM_B) == 0.0


@subkernel
def mover_of(blocks, impact, motions):
    """Return (MOTION row of the moving body, 1.0 if this is body B or -1.0 if A) for an impact on a static body."""
    row = blocks.motion_b[impact.block, impact.lane]
    if motions[row].inverse_mass > 0.0:
        return row, 1.0
    return blocks.motion_a[impact.block, impact.lane], -1.0


@subkernel
def link_impacts(blocks, count, impacts_inout, motions_inout):
    """Link the impacts of each body on static bodies into a list. O(count).

    MOTION.last_impact is the index of the body's last impact, plus one; other functions take it as `last`.
    IMPACT.before is the index of the previous impact of the same body, plus one. last_impact is LEFT_OUT for a body
    that also hits a body of finite mass, or that has a resting contact among its impacts. count: number of IMPACT rows.
    motions_inout: MOTION rows; blocks: see lanes.Blocks.
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
    """Reset MOTION.last_impact of the bodies of all impacts. count: number of IMPACT rows. blocks: see lanes.Blocks."""
    for i in range(count):
        r = impacts[i]
        motions_inout[blocks.motion_a[r.block, r.lane]].last_impact = NO_IMPACT
        motions_inout[blocks.motion_b[r.block, r.lane]].last_impact = NO_IMPACT


@subkernel
def arm_of(blocks, impact, second, sign):
    """Return the moment arm [px] of a normal impulse at a point, on the body of finite mass. sign: see mover_of."""
    if sign > 0.0:
        return line_of(blocks, impact, at.B_2 if second else at.B_1)
    return line_of(blocks, impact, at.A_2 if second else at.A_1)


@subkernel
def is_simulated(blocks, impacts, last, contacts):
    """Return whether the impacts of a body within a step have to be simulated one after the other.

    True if impulses acted at two or more points of the body, and at least one of these points approached fast enough to
    bounce. An exception is a single manifold with two fast points. last: list of impacts, see link_impacts.
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
            fast += int(total > 0.0 and speed > line_of(blocks, r, at.THRESHOLD))
        k = r.before
    return fast > 0 and points > 1 and (rows > 1 or fast < points)


@inlined
def speed_now(blocks, impact, second, sign, change):
    """Return the present approach speed [px/s] of a point, including the impulses simulated so far.

    second: True for the second point of the impact; sign: see mover_of; change: the last IMPACT row of the body, which
    holds the sum of the changes of its velocity; blocks: see lanes.Blocks.
    """
    r = impact
    along = change.vx * line_of(blocks, r, at.NX) + change.vy * line_of(blocks, r, at.NY)
    along += change.angular_velocity * arm_of(blocks, r, second, sign)
    return (r.speed_2 if second else r.speed_1) - sign * along


@inlined
def strike(blocks, impact, second, sign, impulse, mover, change_inout):
    """Add the velocity change by a normal impulse at a point to change_inout, the last IMPACT row of the body.

    mover: MOTION row of the body; second, sign: see speed_now; blocks: see lanes.Blocks.
    """
    r = impact
    change_inout.vx += mover.inverse_mass * sign * impulse * line_of(blocks, r, at.NX)
    change_inout.vy += mover.inverse_mass * sign * impulse * line_of(blocks, r, at.NY)
    change_inout.angular_velocity += mover.inverse_inertia * sign * impulse * arm_of(blocks, r, second, sign)


@subkernel
def soonest_impact(blocks, impacts, last, motions):
    """Return (time [s] to the next hit of a body, its approach speed [px/s] or 0 for none). last: see link_impacts."""
    soonest = math.inf
    hit_speed = 0.0
    k = last
    while k != NO_IMPACT:
        r = impacts[k - 1]
        _, sign = mover_of(blocks, r, motions)
        for point in range(points_of(blocks, r)):
            speed = speed_now(blocks, r, point == 1, sign, impacts[last - 1])
            gap = r.gap_1 if point == 0 else r.gap_2
            if speed > line_of(blocks, r, at.THRESHOLD) and gap < soonest * speed:
                soonest = gap / speed
                hit_speed = speed
        k = r.before
    return soonest, hit_speed


@subkernel
def close_gaps(blocks, last, time, motions, impacts_inout):
    """Reduce the gaps of a body's contact points by the body's motion over a time [s]. last: see link_impacts."""
    k = last
    while k != NO_IMPACT:
        r = impacts_inout[k - 1]
        _, sign = mover_of(blocks, r, motions)
        r.gap_1 = max(r.gap_1 - time * speed_now(blocks, r, False, sign, impacts_inout[last - 1]), 0.0)
        if points_of(blocks, r) == 2:
            r.gap_2 = max(r.gap_2 - time * speed_now(blocks, r, True, sign, impacts_inout[last - 1]), 0.0)
        k = r.before


@subkernel
def list_hits(blocks, last, span, motions, impacts_inout):
    """Mark a body's points that hit within `span` [s], and write their speeds after the hit. last: see link_impacts."""
    k = last
    while k != NO_IMPACT:
        r = impacts_inout[k - 1]
        _, sign = mover_of(blocks, r, motions)
        back = line_of(blocks, r, at.RESTITUTION)
        threshold = line_of(blocks, r, at.THRESHOLD)
        r.blow_1, r.blow_2 = 0.0, 0.0
        speed = speed_now(blocks, r, False, sign, impacts_inout[last - 1])
        r.bounces_1 = speed > threshold and r.gap_1 <= span * speed
        r.wanted_1 = back * speed
        speed = speed_now(blocks, r, True, sign, impacts_inout[last - 1])
        r.bounces_2 = points_of(blocks, r) == 2 and speed > threshold and r.gap_2 <= span * speed
        r.wanted_2 = back * speed
        k = r.before


@inlined
def hits_at(impact, second):
    """Return (whether a point of an impact hits now, its impulse in this hit, separation speed [px/s] to reach)."""
    r = impact
    if second:
        return r.bounces_2, r.blow_2, r.wanted_2
    return r.bounces_1, r.blow_1, r.wanted_1


@inlined
def add_blow(second, change, impact_inout):
    """Add `change` to the impulse of a point in the present hit, and to its impulse in the whole step."""
    if second:
        impact_inout.blow_2 += change
        impact_inout.impulse_2 += change
    else:
        impact_inout.blow_1 += change
        impact_inout.impulse_1 += change


@subkernel
def solve_pair(blocks, i, first_point, j, second_point, last, motions, impacts_inout):
    """Solve two points of one body that hit at the same time. Return the greater change of a normal speed [px/s].

    i, j: IMPACT rows of the two points, which may be equal; first_point, second_point: True for the second point of row
    i and of row j. One point passed twice is solved alone. last: see link_impacts; blocks: see lanes.Blocks.
    """
    r = impacts_inout[i]
    o = impacts_inout[j]
    row, sign = mover_of(blocks, r, motions)
    _, other = mover_of(blocks, o, motions)
    mover = motions[row]
    change = impacts_inout[last - 1]
    _, old_1, wanted_1 = hits_at(r, first_point)
    _, old_2, wanted_2 = hits_at(o, second_point)
    arm_1, arm_2 = arm_of(blocks, r, first_point, sign), arm_of(blocks, o, second_point, other)
    k_11 = mover.inverse_mass + mover.inverse_inertia * arm_1 * arm_1
    missing_1 = wanted_1 + speed_now(blocks, r, first_point, sign, change)
    if k_11 <= 0.0:
        return 0.0
    if i == j and first_point == second_point:
        x_1 = max(old_1 + missing_1 / k_11, 0.0)
        strike(blocks, r, first_point, sign, x_1 - old_1, mover, change)
        add_blow(first_point, x_1 - old_1, r)
        return abs(x_1 - old_1) * k_11
    k_22 = mover.inverse_mass + mover.inverse_inertia * arm_2 * arm_2
    along = line_of(blocks, r, at.NX) * line_of(blocks, o, at.NX) + line_of(blocks, r, at.NY) * line_of(
        blocks, o, at.NY
    )
    if k_22 <= 0.0:
        return 0.0
    k_12 = sign * other * (mover.inverse_mass * along + mover.inverse_inertia * arm_1 * arm_2)
    missing_2 = wanted_2 + speed_now(blocks, o, second_point, other, change)
    off_1, off_2 = k_12 / k_11, k_12 / k_22
    x_1, x_2 = solve_two(missing_1 / k_11, missing_2 / k_22, off_1, off_2, block_factor(off_1, off_2), old_1, old_2)
    strike(blocks, r, first_point, sign, x_1 - old_1, mover, change)
    strike(blocks, o, second_point, other, x_2 - old_2, mover, change)
    add_blow(first_point, x_1 - old_1, r)
    add_blow(second_point, x_2 - old_2, o)
    return max(abs(x_1 - old_1) * k_11, abs(x_2 - old_2) * k_22)


@subkernel
def solve_together(blocks, last, hit_speed, motions, impacts_inout):
    """Apply the impulses of all points of a body that hit at the present time. Return whether the impulses converged.

    last: see link_impacts; hit_speed [px/s]: approach speed of the soonest hit. Each point separates at restitution
    times its approach speed or faster. The points are solved in pairs, in rounds. On level ground, the first pair with
    the centre of mass between its points gives the final solution, and the other pairs do not change it. impacts_inout:
    IMPACT rows; blocks: see lanes.Blocks. motions: MOTION rows.
    """
    for _ in range(MOST_ROUNDS):
        changed = 0.0
        alone = True
        i = last
        while i != NO_IMPACT:
            for first in range(points_of(blocks, impacts_inout[i - 1])):
                hits, _, _ = hits_at(impacts_inout[i - 1], first == 1)
                if not hits:
                    continue
                j = i
                while j != NO_IMPACT:
                    for second in range(first + 1 if i == j else 0, points_of(blocks, impacts_inout[j - 1])):
                        hits, _, _ = hits_at(impacts_inout[j - 1], second == 1)
                        if hits:
                            alone = False
                            change = solve_pair(
                                blocks, i - 1, first == 1, j - 1, second == 1, last, motions, impacts_inout
                            )
                            changed = max(changed, change)
                    j = impacts_inout[j - 1].before
            i = impacts_inout[i - 1].before
        if alone:
            solve_alone(blocks, last, motions, impacts_inout)
            return True
        if changed <= SETTLED * hit_speed:
            return True
    return False


@subkernel
def solve_alone(blocks, last, motions, impacts_inout):
    """Apply the impulse at the only point of a body that hits at the present time. last: see link_impacts."""
    i = last
    while i != NO_IMPACT:
        for point in range(points_of(blocks, impacts_inout[i - 1])):
            hits, _, _ = hits_at(impacts_inout[i - 1], point == 1)
            if hits:
                solve_pair(blocks, i - 1, point == 1, i - 1, point == 1, last, motions, impacts_inout)
        i = impacts_inout[i - 1].before


@subkernel
def simulate_impacts(blocks, last, dt, contacts, motions, impacts_inout):
    """Simulate the impacts of a body in a step of dt [s], in the order of their times, and write their impulses.

    Return (time [s] from the last hit to the end of the step, whether MOST_IMPACTS and MOST_ROUNDS were enough).
    last: MOTION.last_impact of the body, see link_impacts. The IMPACT row last - 1 receives the body's displacement up
    to the last hit. blocks: see lanes.Blocks; contacts: CONTACT rows; motions: MOTION rows; impacts_inout: IMPACT rows.
    """
    k = last
    while k != NO_IMPACT:
        predict_impact(blocks, contacts, motions, impacts_inout[k - 1])
        k = impacts_inout[k - 1].before
    change = impacts_inout[last - 1]
    change.vx, change.vy, change.angular_velocity = 0.0, 0.0, 0.0
    change.x, change.y, change.turn = 0.0, 0.0, 0.0
    row, _ = mover_of(blocks, change, motions)
    m = motions[row]
    left = dt + LATE * dt
    settled = True
    for _ in range(MOST_IMPACTS):
        soonest, hit_speed = soonest_impact(blocks, impacts_inout, last, motions)
        if hit_speed == 0.0 or soonest > left:
            return max(left - LATE * dt, 0.0), settled
        left -= soonest
        change.x += soonest * (m.start_vx + change.vx)
        change.y += soonest * (m.start_vy + change.vy)
        change.turn += soonest * (m.start_w + change.angular_velocity)
        close_gaps(blocks, last, soonest, motions, impacts_inout)
        list_hits(blocks, last, TOGETHER * dt, motions, impacts_inout)
        settled = solve_together(blocks, last, hit_speed, motions, impacts_inout) and settled
    return 0.0, False


@subkernel
def rub(impact, second, to_rest, motions_inout, blocks_inout):
    """Remove the friction impulse at a point of an impact, or apply friction for the simulated normal impulse.

    Return the change of the tangential speed [px/s]. second: True for the second point; to_rest: True to apply
    friction, False to remove the friction impulse. The friction limit uses only the part of the normal impulse that
    stops the approach, as in substeps. motions_inout: MOTION rows; blocks_inout: the contacts, see lanes.Blocks.
    """
    r = impact
    lane = r.lane
    c = blocks_inout.lines[r.block * SIZE : (r.block + 1) * SIZE]
    a = motions_inout[blocks_inout.motion_a[r.block, lane]]
    b = motions_inout[blocks_inout.motion_b[r.block, lane]]
    line = (at.TANGENT_TOTAL_2 if second else at.TANGENT_TOTAL_1) + lane
    mass = c[(at.TANGENT_MASS_2 if second else at.TANGENT_MASS_1) + lane]
    impulse = 0.0
    if to_rest:
        most = c[at.FRICTION + lane] * (r.impulse_2 if second else r.impulse_1) / (1.0 + c[at.RESTITUTION + lane])
        impulse = clamp(c[line] - mass * tangential_speed(c, lane, second, a, b), most)
    change = impulse - c[line]
    push_along(c, lane, second, change, a, b)
    c[line] = impulse
    return abs(change) / mass if mass > 0.0 else 0.0


@subkernel
def greatest_speed(impacts, last):
    """Return the greatest predicted impact speed [px/s] of a body. last: list of its impacts, see link_impacts."""
    fastest = 0.0
    k = last
    while k != NO_IMPACT:
        fastest = max(fastest, impacts[k - 1].speed_1, impacts[k - 1].speed_2)
        k = impacts[k - 1].before
    return fastest


@subkernel
def apply_simulated(last, hit_speed, impacts_inout, motions_inout, blocks_inout):
    """Replace a body's impulses from the substeps by those of its simulated impacts, with friction.

    last: see link_impacts; hit_speed [px/s]: greatest impact speed of the body. The impulses are not cached for the
    next step. impacts_inout: IMPACT rows; motions_inout: MOTION rows; blocks_inout: the contacts, see lanes.Blocks.
    """
    k = last
    while k != NO_IMPACT:
        r = impacts_inout[k - 1]
        lane = r.lane
        c = blocks_inout.lines[r.block * SIZE : (r.block + 1) * SIZE]
        a = motions_inout[blocks_inout.motion_a[r.block, lane]]
        b = motions_inout[blocks_inout.motion_b[r.block, lane]]
        push_pair(c, lane, False, r.impulse_1 - c[at.TOTAL_1 + lane], a, b)
        rub(r, False, False, motions_inout, blocks_inout)
        c[at.NORMAL_1 + lane] = 0.0
        c[at.TANGENT_1 + lane] = 0.0
        c[at.TOTAL_1 + lane] = r.impulse_1
        if points_of(blocks_inout, r) == 2:
            push_pair(c, lane, True, r.impulse_2 - c[at.TOTAL_2 + lane], a, b)
            rub(r, True, False, motions_inout, blocks_inout)
            c[at.NORMAL_2 + lane] = 0.0
            c[at.TANGENT_2 + lane] = 0.0
            c[at.TOTAL_2 + lane] = r.impulse_2
        r.simulated = True
        k = r.before
    for _ in range(ROUNDS):
        changed = 0.0
        k = last
        while k != NO_IMPACT:
            r = impacts_inout[k - 1]
            for point in range(points_of(blocks_inout, r)):
                if (r.impulse_1 if point == 0 else r.impulse_2) > 0.0:
                    changed = max(changed, rub(r, point == 1, True, motions_inout, blocks_inout))
            k = r.before
        if changed <= SETTLED * hit_speed:
            return


@subkernel
def solve_simultaneous(contacts, count, dt, impacts_inout, motions_inout, blocks_inout, work_inout):
    """Simulate the impacts of flying bodies that hit static bodies several times within a step of dt [s].

    count: number of IMPACT rows; the simulated ones are marked. O(count + impacts · points² of each body).
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
        if is_simulated(blocks_inout, impacts_inout, i + 1, contacts):
            left, settled = simulate_impacts(blocks_inout, i + 1, dt, contacts, motions_inout, impacts_inout)
            work_inout[CAP_HITS] += int(not settled)
            apply_simulated(i + 1, greatest_speed(impacts_inout, i + 1), impacts_inout, motions_inout, blocks_inout)
            # The body is not accelerated after its last hit: acceleration in the rest of the step would cost energy.
            m = motions_inout[row]
            half = 0.5 * (dt - left) * (dt - left)
            m.dx = impacts_inout[i].x + half * m.acceleration_x
            m.dy = impacts_inout[i].y + half * m.acceleration_y
            m.turn = impacts_inout[i].turn + half * m.angular_acceleration
            m.vx -= left * m.acceleration_x
            m.vy -= left * m.acceleration_y
            m.angular_velocity -= left * m.angular_acceleration
    unlink_impacts(blocks_inout, impacts_inout, count, motions_inout)


# ---- bounce ----------------------------------------------------------------------------------------------------------
# Restitution, once, after the last substep, for every stacking solver.
#
# The approach speed at the moment of impact is predicted by a parabola from the state before the step. So a speculative
# contact that slowed the body does not reduce the bounce (Rapier #919, #974), and the step length costs no height. Two
# points of one manifold are solved together, otherwise a box that lands flat would rotate. If impacts share a body, or
# a bouncing body touches other bodies, all their contacts are solved in rounds. Contacts that only touch pass the
# impact on and do not bounce. No single impact adds energy, so their sum adds none.

LIGHT = 1e-4  # fraction of an impact impulse below which the load of a contact is neglected
MOST_BLOWS = 256  # greatest number of successive impacts between bodies without loads; if exceeded: cap_hits


@subkernel
def bounces(speed, threshold, total):
    """Return whether a contact point bounces: it approached faster than the threshold [px/s] and had an impulse."""
    return speed > threshold and total > 0.0


@subkernel
def bounce_once(wanted, c, lane, second, total, a_inout, b_inout):
    """Apply an impulse at one point of a contact, so that the point separates at `wanted` [px/s].

    Return the change of the impulse. c: fields of a block of contacts; lane: lane of the contact; second: True for the
    second point; total: impulse of the point before. a_inout, b_inout: MOTION rows.
    """
    mass = c[(at.MASS_2 if second else at.MASS_1) + lane]
    missing = wanted - relative_speed(c, lane, second, a_inout, b_inout)
    change = max(total + mass * missing, 0.0) - total
    push_pair(c, lane, second, change, a_inout, b_inout)
    return change


@subkernel
def bounce_together(wanted_1, wanted_2, old_1, old_2, c, lane, a_inout, b_inout):
    """Apply impulses at both points of a contact, so that they separate at wanted_1, wanted_2 [px/s] (block solver).

    Return the changes of both impulses. old_1, old_2: impulses of the points before; other arguments: see bounce_once.
    """
    missing_1 = wanted_1 - relative_speed(c, lane, False, a_inout, b_inout)
    missing_2 = wanted_2 - relative_speed(c, lane, True, a_inout, b_inout)
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
def list_bounces(contacts, count, motions_inout, impacts_inout, blocks_inout, work_inout):
    """Keep the IMPACT rows with a point that bounces, and write the speeds [px/s] at which these points must separate.

    Return (number of rows kept, whether two of the kept rows share a body of finite mass). Simulated impacts are
    dropped. The bodies of the kept rows are marked in MOTION.last_impact. count: number of rows before.
    """
    blocks = blocks_inout
    kept = 0
    shared = False
    for i in range(count):
        r = impacts_inout[i]
        total_1, total_2 = line_of(blocks, r, at.TOTAL_1), line_of(blocks, r, at.TOTAL_2)
        if r.simulated:
            work_inout[RESTITUTION_ROWS] += int(total_1 > 0.0) + int(total_2 > 0.0)
            continue
        predict_impact(blocks, contacts, motions_inout, r)
        threshold = line_of(blocks, r, at.THRESHOLD)
        first = bounces(r.speed_1, threshold, total_1)
        second = points_of(blocks, r) == 2 and bounces(r.speed_2, threshold, total_2)
        if not (first or second):
            continue
        work_inout[RESTITUTION_ROWS] += int(first) + int(second)
        k = impacts_inout[kept]
        k.block = r.block
        k.lane = r.lane
        k.bounces_1, k.bounces_2 = first, second
        k.impulse_1, k.impulse_2 = total_1, total_2
        k.wanted_1 = line_of(blocks, r, at.RESTITUTION) * r.speed_1
        k.wanted_2 = line_of(blocks, r, at.RESTITUTION) * r.speed_2
        kept += 1
        blocks.lines[r.block * SIZE + at.LISTED + r.lane] = 1.0
        shared = mark_bodies(blocks, r.block, r.lane, motions_inout) or shared
    return kept, shared


@subkernel
def mark_bodies(blocks, block, lane, motions_inout):
    """Set last_impact of the finite-mass bodies of a contact to LEFT_OUT. Return whether one was marked before."""
    shared = False
    for side in range(2):
        m = motions_inout[(blocks.motion_a if side == 0 else blocks.motion_b)[block, lane]]
        if m.inverse_mass > 0.0:
            shared = shared or m.last_impact != NO_IMPACT
            m.last_impact = LEFT_OUT
    return shared


@subkernel
def list_handed_on(blocks_count, count, motions_inout, impacts_inout, blocks_inout):
    """Append the contacts that can transmit an impact to other bodies. Return the new number of IMPACT rows.

    They are contacts of marked bodies (see mark_bodies) with an impulse in this step. Their bodies are marked too, and
    the search is repeated until it finds no more. An appended contact does not bounce. Its approach speed may remain,
    but not increase. blocks_count: number of blocks; count: number of IMPACT rows before; motions_inout: MOTION rows.
    """
    blocks = blocks_inout
    grown = True
    while grown:
        grown = False
        for block in range(blocks_count):
            c = blocks.lines[block * SIZE : (block + 1) * SIZE]
            for lane in range(lanes_of(blocks.contact, block)):
                if c[at.TOTAL_1 + lane] + c[at.TOTAL_2 + lane] <= 0.0 or c[at.LISTED + lane] != 0.0:
                    continue
                a = motions_inout[blocks.motion_a[block, lane]]
                b = motions_inout[blocks.motion_b[block, lane]]
                if a.last_impact == NO_IMPACT and b.last_impact == NO_IMPACT:
                    continue
                c[at.LISTED + lane] = 1.0
                mark_bodies(blocks, block, lane, motions_inout)
                r = impacts_inout[count]
                r.block = block
                r.lane = lane
                r.bounces_1, r.bounces_2 = False, False
                r.impulse_1, r.impulse_2 = 0.0, 0.0
                r.wanted_1 = min(relative_speed(c, lane, False, a, b), 0.0)
                r.wanted_2 = min(relative_speed(c, lane, True, a, b), 0.0) if c[at.MASS_2 + lane] > 0.0 else 0.0
                count += 1
                grown = True
    return count


@subkernel
def bounce_row(impact_inout, motions_inout, blocks_inout):
    """Apply restitution at the points of an IMPACT row. Return the greatest change of a normal speed [px/s]."""
    r = impact_inout
    lane = r.lane
    c = blocks_inout.lines[r.block * SIZE : (r.block + 1) * SIZE]
    a = motions_inout[blocks_inout.motion_a[r.block, lane]]
    b = motions_inout[blocks_inout.motion_b[r.block, lane]]
    handed_on = not (r.bounces_1 or r.bounces_2)
    first = r.bounces_1 or handed_on
    second = r.bounces_2 or (handed_on and points_of(blocks_inout, r) == 2)
    change_1, change_2 = 0.0, 0.0
    if first and second:
        change_1, change_2 = bounce_together(r.wanted_1, r.wanted_2, r.impulse_1, r.impulse_2, c, lane, a, b)
    elif first:
        change_1 = bounce_once(r.wanted_1, c, lane, False, r.impulse_1, a, b)
    else:
        change_2 = bounce_once(r.wanted_2, c, lane, True, r.impulse_2, a, b)
    r.impulse_1 += change_1
    r.impulse_2 += change_2
    # Impulses of an impact are not cached for the next step.
    if r.bounces_1:
        c[at.NORMAL_1 + lane] = 0.0
        c[at.TANGENT_1 + lane] = 0.0
    if r.bounces_2:
        c[at.NORMAL_2 + lane] = 0.0
        c[at.TANGENT_2 + lane] = 0.0
    c[at.TOTAL_1 + lane] += change_1
    c[at.TOTAL_2 + lane] += change_2
    changed = abs(change_1) / c[at.MASS_1 + lane]
    return max(changed, abs(change_2) / c[at.MASS_2 + lane]) if c[at.MASS_2 + lane] > 0.0 else changed


@subkernel
def are_unloaded(blocks, impacts, count, contacts, speed, dt):
    """Return whether cached contact forces are negligible compared with an impact at `speed` [px/s].

    The contacts of the first `count` IMPACT rows are tested. dt [s]: step length; blocks: see lanes.Blocks.
    """
    for i in range(count):
        r = impacts[i]
        c = contacts[blocks.contact[r.block, r.lane]]
        force = max(c.normal_force_1, c.normal_force_2)
        if force * dt > LIGHT * speed * line_of(blocks, r, at.MASS_1):
            return False
    return True


@subkernel
def bounce_in_rounds(count, hits_alone, least, impacts_inout, motions_inout, blocks_inout):
    """Solve IMPACT rows in rounds, until a round changes no normal speed by more than `least` [px/s].

    At most ROUNDS rounds are made. count: number of rows; hits_alone: True to solve only rows with a bouncing point.
    """
    for _ in range(ROUNDS):
        changed = 0.0
        for i in range(count):
            if not hits_alone or impacts_inout[i].bounces_1 or impacts_inout[i].bounces_2:
                changed = max(changed, bounce_row(impacts_inout[i], motions_inout, blocks_inout))
        if changed <= least:
            return


@subkernel
def hand_on(count, fastest, impacts_inout, motions_inout, blocks_inout):
    """Replace the impulses of contacts without loads by a sequence of impacts, as in Newton's cradle.

    In each impact all contacts that approach are solved together; contacts that approach after it form the next impact.
    An impact is thus transmitted through bodies that only touch. Return whether the sequence ended within MOST_BLOWS
    impacts. count: number of IMPACT rows; fastest [px/s]: greatest separation speed of the first impact.
    """
    for i in range(count):
        r = impacts_inout[i]
        c = blocks_inout.lines[r.block * SIZE : (r.block + 1) * SIZE]
        a = motions_inout[blocks_inout.motion_a[r.block, r.lane]]
        b = motions_inout[blocks_inout.motion_b[r.block, r.lane]]
        push_pair(c, r.lane, False, -c[at.TOTAL_1 + r.lane], a, b)
        push_pair(c, r.lane, True, -c[at.TOTAL_2 + r.lane], a, b)
        c[at.TOTAL_1 + r.lane] = 0.0
        c[at.TOTAL_2 + r.lane] = 0.0
        c[at.NORMAL_1 + r.lane] = 0.0
        c[at.NORMAL_2 + r.lane] = 0.0
    least = SETTLED * fastest
    for _ in range(MOST_BLOWS):
        found = False
        for i in range(count):
            r = impacts_inout[i]
            c = blocks_inout.lines[r.block * SIZE : (r.block + 1) * SIZE]
            a = motions_inout[blocks_inout.motion_a[r.block, r.lane]]
            b = motions_inout[blocks_inout.motion_b[r.block, r.lane]]
            speed_1 = -relative_speed(c, r.lane, False, a, b)
            speed_2 = -relative_speed(c, r.lane, True, a, b)
            r.bounces_1 = speed_1 > least
            r.bounces_2 = points_of(blocks_inout, r) == 2 and speed_2 > least
            r.wanted_1 = c[at.RESTITUTION + r.lane] * speed_1
            r.wanted_2 = c[at.RESTITUTION + r.lane] * speed_2
            r.impulse_1, r.impulse_2 = 0.0, 0.0
            found = found or r.bounces_1 or r.bounces_2
        if not found:
            return True
        bounce_in_rounds(count, True, least, impacts_inout, motions_inout, blocks_inout)
    return False


@subkernel
def restore_bounces(contacts, count, found, context, impacts_inout, motions_inout, blocks_inout, work_inout):
    """Make points that hit in this step separate at restitution times their impact speed. O(lanes).

    count: number of blocks; found: number of IMPACT rows written by list_impacts; context: see StepContext;
    impacts_inout: IMPACT rows, with room for all contacts.
    """
    solve_simultaneous(contacts, found, context.dt, impacts_inout, motions_inout, blocks_inout, work_inout)
    bouncing, shared = list_bounces(contacts, found, motions_inout, impacts_inout, blocks_inout, work_inout)
    if bouncing == 0:
        return
    rows = list_handed_on(count, bouncing, motions_inout, impacts_inout, blocks_inout)
    fastest = 0.0
    for i in range(bouncing):
        fastest = max(fastest, impacts_inout[i].wanted_1, impacts_inout[i].wanted_2)
    if not shared and rows == bouncing:
        for i in range(rows):
            bounce_row(impacts_inout[i], motions_inout, blocks_inout)
    elif are_unloaded(blocks_inout, impacts_inout, rows, contacts, fastest, context.dt):
        ended = hand_on(rows, fastest, impacts_inout, motions_inout, blocks_inout)
        work_inout[CAP_HITS] += int(not ended)
    else:
        bounce_in_rounds(rows, False, SETTLED * fastest, impacts_inout, motions_inout, blocks_inout)
    unlink_impacts(blocks_inout, impacts_inout, rows, motions_inout)
