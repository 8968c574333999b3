"""Restitution after the last substep, for every stacking solver."""

from physics.jit import subkernel
from physics.solver import lanes as at
from physics.solver.lanes import SIZE, lanes_of, solve_two
from physics.solver.simultaneous_impacts import (
    LEFT_OUT,
    NO_IMPACT,
    ROUNDS,
    SETTLED,
    line_of,
    list_impacts,
    points_of,
    predict_impact,
    push_pair,
    relative_speed,
    solve_simultaneous,
    unlink_impacts,
)
from physics.tables.step_state import CAP_HITS, RESTITUTION_ROWS

# ---- bounce ----------------------------------------------------------------------------------------------------------
# Restitution, once, after the last substep, for every stacking solver.
#
# It uses the approach speed at the moment of impact, by the parabola from before the step. So a speculative contact
# that slowed the body does not reduce the bounce (Rapier #919, #974), and no height is lost by the length of steps. Two
# points of one manifold are solved together, otherwise a box that lands flat would rotate. Where impacts share a body,
# or a body that bounces presses others, all of them are solved in rounds: contacts that only touch hand the blow on,
# without a bounce of their own. Each separation speed times its impulse loses energy or keeps it, so their sum does.

LIGHT = 1e-4  # share of a blow below which a load is left out
MOST_BLOWS = 256  # handed on by bodies without loads; later ones are left to the next step, and counted in cap_hits


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
def bounce_together(wanted_1, wanted_2, old_1, old_2, c, lane, a_inout, b_inout):
    """Apply restitution at two points at once, for separation speeds [px/s], by the 2 x 2 system. Return the changes of
    their impulses, which are `old` so far.
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
    """Keep those of so many IMPACT rows of which a point bounces, with the separation speeds that they want.

    Return their number, and whether two of them share a body. The bodies are marked in MOTION.last_impact.
    """
    blocks = blocks_inout
    kept = 0
    shared = False
    for i in range(count):
        r = impacts_inout[i]
        total_1 = line_of(blocks, r, at.TOTAL_1)
        total_2 = line_of(blocks, r, at.TOTAL_2)
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
        k.bounces_1 = first
        k.bounces_2 = second
        k.impulse_1 = total_1
        k.impulse_2 = total_2
        k.wanted_1 = line_of(blocks, r, at.RESTITUTION) * r.speed_1
        k.wanted_2 = line_of(blocks, r, at.RESTITUTION) * r.speed_2
        kept += 1
        blocks.lines[r.block * SIZE + at.LISTED + r.lane] = 1.0
        shared = mark_bodies(blocks, r.block, r.lane, motions_inout) or shared
    return kept, shared


@subkernel
def mark_bodies(blocks, block, lane, motions_inout):
    """Mark the dynamic bodies of a lane. Return whether one of them was marked before."""
    shared = False
    for side in range(2):
        m = motions_inout[(blocks.motion_a if side == 0 else blocks.motion_b)[block, lane]]
        if m.inverse_mass > 0.0:
            shared = shared or m.last_impact != NO_IMPACT
            m.last_impact = LEFT_OUT
    return shared


@subkernel
def list_handed_on(blocks_count, count, motions_inout, impacts_inout, blocks_inout):
    """Append to so many IMPACT rows the lanes with an impulse that touch a marked body, and mark theirs, over and over.

    Return the number of rows. Such a lane keeps the speed with which it approaches, and approaches no faster.
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
                r.bounces_1 = False
                r.bounces_2 = False
                r.impulse_1 = 0.0
                r.impulse_2 = 0.0
                r.wanted_1 = min(relative_speed(c, lane, False, a, b), 0.0)
                r.wanted_2 = min(relative_speed(c, lane, True, a, b), 0.0) if c[at.MASS_2 + lane] > 0.0 else 0.0
                count += 1
                grown = True
    return count


@subkernel
def bounce_row(impact_inout, motions_inout, blocks_inout):
    """Apply restitution at the points of an IMPACT row, to which its impulses are added. Return the change of speed."""
    r = impact_inout
    lane = r.lane
    c = blocks_inout.lines[r.block * SIZE : (r.block + 1) * SIZE]
    a = motions_inout[blocks_inout.motion_a[r.block, lane]]
    b = motions_inout[blocks_inout.motion_b[r.block, lane]]
    handed_on = not (r.bounces_1 or r.bounces_2)
    first = r.bounces_1 or handed_on
    second = r.bounces_2 or (handed_on and points_of(blocks_inout, r) == 2)
    change_1 = 0.0
    change_2 = 0.0
    if first and second:
        change_1, change_2 = bounce_together(r.wanted_1, r.wanted_2, r.impulse_1, r.impulse_2, c, lane, a, b)
    elif first:
        change_1 = bounce_once(r.wanted_1, c, lane, False, r.impulse_1, a, b)
    else:
        change_2 = bounce_once(r.wanted_2, c, lane, True, r.impulse_2, a, b)
    r.impulse_1 += change_1
    r.impulse_2 += change_2
    # They are no cached forces for the next step, nor is what stopped the approach.
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
    """Return whether the loads of so many IMPACT rows in the step before do not count beside a speed [px/s]."""
    for i in range(count):
        r = impacts[i]
        c = contacts[blocks.contact[r.block, r.lane]]
        force = max(c.normal_force_1, c.normal_force_2)
        if force * dt > LIGHT * speed * line_of(blocks, r, at.MASS_1):
            return False
    return True


@subkernel
def bounce_in_rounds(count, hits_alone, least, impacts_inout, motions_inout, blocks_inout):
    """Solve so many IMPACT rows that depend on each other, until none changes a speed by more than `least` [px/s].

    hits_alone: leave out those that hand on.
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
    """Replace the impulses of so many IMPACT rows of bodies without loads by a sequence of impacts.

    Contacts that approach are solved together; those that approach after that are next: a contact that only touches has
    the blow handed on, as in Newton's cradle. Return whether they end. fastest [px/s]: speed of the first impacts.
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
            r.impulse_1 = 0.0
            r.impulse_2 = 0.0
            found = found or r.bounces_1 or r.bounces_2
        if not found:
            return True
        bounce_in_rounds(count, True, least, impacts_inout, motions_inout, blocks_inout)
    return False


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
    found = list_impacts(blocks_inout, count, impacts_inout)
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
