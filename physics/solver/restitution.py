"""Restitution after the last substep, and simultaneous impacts on one body."""

import math

from physics.jit import inlined, subkernel
from physics.tables.step_state import CAP_HITS, RESTITUTION_ROWS

# ---- impulses --------------------------------------------------------------------------------------------------------
# Impulses between two motions at a point, and the velocities that they change.


@subkernel
def relative_speed(a, b, nx, ny, ax, ay, bx, by):
    """Return the speed [px/s] of B relative to A along a normal at these arms; negative if they approach."""
    vx = (b.vx - b.angular_velocity * by) - (a.vx - a.angular_velocity * ay)
    vy = (b.vy + b.angular_velocity * bx) - (a.vy + a.angular_velocity * ax)
    return vx * nx + vy * ny


@subkernel
def push_pair(nx, ny, ax, ay, bx, by, impulse, a_inout, b_inout):
    """Apply an impulse along the normal, to B forwards and to A backwards."""
    x = impulse * nx
    y = impulse * ny
    a_inout.vx -= a_inout.inverse_mass * x
    a_inout.vy -= a_inout.inverse_mass * y
    a_inout.angular_velocity -= a_inout.inverse_inertia * (ax * y - ay * x)
    b_inout.vx += b_inout.inverse_mass * x
    b_inout.vy += b_inout.inverse_mass * y
    b_inout.angular_velocity += b_inout.inverse_inertia * (bx * y - by * x)


@subkernel
def speed_of_impact(speed, separation, acceleration):
    """Return the approach speed [px/s] at the moment of impact.

    separation [px] before the step; speed and acceleration [px/s2] of approach. Sides that overlapped keep their speed.
    """
    if speed <= 0.0 or separation <= 0.0:
        return speed
    return math.sqrt(max(speed * speed + 2.0 * acceleration * separation, 0.0))


# ---- two points ------------------------------------------------------------------------------------------------------
# Block solver for two contact points: the linear complementarity problem of two variables, by trying its four cases.
#
# Solving one point after the other lets a body rock from corner to corner. The problem is written in impulses and in
# ratios that last for the step, so that there is no division. Source: Catto, Modeling and Solving Constraints, GDC 2007
# (block solver).

FLAT = 1e-3  # share of k_11 · k_22 below which the two points count as one


@inlined
def split_of(couple_1, couple_2):
    """Return the factor of solve_two where both points press: 1 / (1 - couple_1 · couple_2); 0 where the points
    coincide.
    """
    apart = 1.0 - couple_1 * couple_2
    return 1.0 / apart if apart > FLAT else 0.0


@inlined
def solve_two(change_1, change_2, couple_1, couple_2, split, old_1, old_2):
    """Return the impulses x >= 0 of two points such that each gets the velocity change it needs, or separates.

    change: of each impulse if it were alone. couple: k_12 / k_11 and k_12 / k_22. split: see split_of. old: accumulated
    impulses. The points are solved in sequence where they nearly coincide, or where rounding leaves no case. All cases
    are computed side by side, so that the loop has no branch and vectorises.
    """
    only_1 = old_1 + change_1 + couple_1 * old_2
    only_2 = old_2 + change_2 + couple_2 * old_1
    both = (split > 0.0) & (only_1 >= couple_1 * only_2) & (only_2 >= couple_2 * only_1)
    first = (only_1 >= 0.0) & (couple_2 * only_1 >= only_2)
    second = (only_2 >= 0.0) & (couple_1 * only_2 >= only_1)
    neither = (only_1 <= 0.0) & (only_2 <= 0.0)
    x_1 = old_1 + change_1
    x_1 = x_1 if x_1 > 0.0 else 0.0
    x_2 = old_2 + change_2 - couple_2 * (x_1 - old_1)
    x_2 = x_2 if x_2 > 0.0 else 0.0
    x_1 = 0.0 if second | neither else x_1
    x_2 = only_2 if second else (0.0 if neither else x_2)
    x_1 = only_1 if first else x_1
    x_2 = 0.0 if first else x_2
    x_1 = split * (only_1 - couple_1 * only_2) if both else x_1
    x_2 = split * (only_2 - couple_2 * only_1) if both else x_2
    return x_1, x_2


# ---- hits ------------------------------------------------------------------------------------------------------------
# Simultaneous impacts: several impacts of one body within a step, simulated in sequence.
#
# A flying body may hit a wall with one end, rotate, and hit it with the other end within the step, or hit the wall and
# the floor of a corner. The velocity before the step says nothing about the second impact, and the velocity that the
# substeps removed is not that of a bounce. So the impacts of such a body on static bodies are simulated from one to the
# next, along straight lines. Each keeps the energy that Newton's law of restitution gives at the time of the impact.

MOST_HITS = 16  # impacts of one body within a step; more are left to the next step, and counted in cap_hits
TOGETHER = 1.0 / 64.0  # share of a step within which two points of a manifold hit at once
NOBODY, CROWDED = 0, -1  # values of MOTION.hits: no row yet; not to be simulated


@subkernel
def mover_of(r, motions):
    """Return the dynamic side of a CONSTRAINT row against a static body: its MOTION row, and 1.0 for B, -1.0 for A."""
    if motions[r.motion_b].inverse_mass > 0.0:
        return r.motion_b, 1.0
    return r.motion_a, -1.0


@subkernel
def link_hits(anchors, count, constraints_inout, motions_inout):
    """Link the rows of each body that may bounce: MOTION.hits is its last row plus one, CONSTRAINT.before the one
    before.

    A body that also has a resting contact, or hits a dynamic body, is left out: CROWDED. O(count).
    """
    for i in range(count):
        r = constraints_inout[i]
        r.played = False
        r.linked = anchors[r.manifold].restitution > 0.0 and r.normal_total_1 + r.normal_total_2 > 0.0
        if not r.linked:
            continue
        if r.still and not r.rests:
            mover, _ = mover_of(r, motions_inout)
            m = motions_inout[mover]
            r.before = m.hits
            if m.hits != CROWDED:
                m.hits = i + 1
        else:
            for side in range(2):
                m = motions_inout[r.motion_a if side == 0 else r.motion_b]
                if m.inverse_mass > 0.0:
                    m.hits = CROWDED


@subkernel
def unlink_hits(constraints, count, motions_inout):
    """Reset the links in the motions."""
    for i in range(count):
        motions_inout[constraints[i].motion_a].hits = NOBODY
        motions_inout[constraints[i].motion_b].hits = NOBODY


@subkernel
def lever_of(r, second, sign):
    """Return the moment arm [px] of an impulse along the normal at a point of the mover."""
    if sign > 0.0:
        return (r.bx_2 * r.normal_y - r.by_2 * r.normal_x) if second else (r.bx_1 * r.normal_y - r.by_1 * r.normal_x)
    return (r.ax_2 * r.normal_y - r.ay_2 * r.normal_x) if second else (r.ax_1 * r.normal_y - r.ay_1 * r.normal_x)


@subkernel
def is_played(constraints, last, manifolds, threshold):
    """Return whether the impacts of a body, linked from row `last`, are to be simulated in sequence.

    That is so if it has impacts at two points, other than the two of one manifold that both approached before.
    """
    points = 0
    rows = 0
    fast = 0
    at = last
    while at != NOBODY:
        r = constraints[at - 1]
        m = manifolds[r.manifold]
        rows += 1
        for k in range(r.count):
            total = r.normal_total_1 if k == 0 else r.normal_total_2
            speed = m.speed_1 if k == 0 else m.speed_2
            points += int(total > 0.0)
            fast += int(total > 0.0 and speed > threshold)
        at = r.before
    return fast > 0 and points > 1 and (rows > 1 or fast < points)


@subkernel
def speed_now(constraints, last, row, second, mover, motions):
    """Return the approach speed [px/s] of a point after the impulses that its body got so far."""
    r = constraints[row]
    _, sign = mover_of(r, motions)
    lever = lever_of(r, second, sign)
    speed = r.met_2 if second else r.met_1
    at = last
    while at != NOBODY:
        o = constraints[at - 1]
        _, other = mover_of(o, motions)
        along = r.normal_x * o.normal_x + r.normal_y * o.normal_y
        for k in range(o.count):
            impulse = o.push_impulse_1 if k == 0 else o.push_impulse_2
            if impulse > 0.0:
                turn = mover.inverse_inertia * lever * lever_of(o, k == 1, other)
                speed -= sign * other * (mover.inverse_mass * along + turn) * impulse
        at = o.before
    return speed


@subkernel
def play_hits(last, manifolds, anchors, threshold, dt, mover, motions, constraints_inout):
    """Simulate the impacts of a body, linked from `last`, over dt [s]: the impulse of each point goes to push_impulse.

    mover: its MOTION row. Return whether MOST_HITS was enough.
    """
    at = last
    while at != NOBODY:
        r = constraints_inout[at - 1]
        m = manifolds[r.manifold]
        a = motions[r.motion_a]
        b = motions[r.motion_b]
        nearing = (a.acceleration_x - b.acceleration_x) * r.normal_x
        nearing += (a.acceleration_y - b.acceleration_y) * r.normal_y
        r.push_impulse_1, r.push_impulse_2 = 0.0, 0.0
        r.met_1 = speed_of_impact(m.speed_1, m.separation_1, nearing)
        r.met_2 = speed_of_impact(m.speed_2, m.separation_2, nearing) if r.count == 2 else 0.0
        r.gap_1 = max(m.separation_1, 0.0)
        r.gap_2 = max(m.separation_2, 0.0) if r.count == 2 else 0.0
        at = r.before
    left = dt
    for _ in range(MOST_HITS):
        soonest = math.inf
        hit = NOBODY
        second = False
        hit_speed = 0.0
        at = last
        while at != NOBODY:
            r = constraints_inout[at - 1]
            for k in range(r.count):
                speed = speed_now(constraints_inout, last, at - 1, k == 1, mover, motions)
                gap = r.gap_1 if k == 0 else r.gap_2
                if speed > threshold and gap < soonest * speed:
                    soonest = gap / speed
                    hit = at
                    second = k == 1
                    hit_speed = speed
            at = r.before
        if hit == NOBODY or soonest > left:
            return True
        left -= soonest
        at = last
        while at != NOBODY:
            r = constraints_inout[at - 1]
            r.gap_1 = max(r.gap_1 - soonest * speed_now(constraints_inout, last, at - 1, False, mover, motions), 0.0)
            if r.count == 2:
                r.gap_2 = max(r.gap_2 - soonest * speed_now(constraints_inout, last, at - 1, True, mover, motions), 0.0)
            at = r.before
        r = constraints_inout[hit - 1]
        back = 1.0 + anchors[r.manifold].restitution
        other_speed = 0.0
        if r.count == 2:
            other_speed = speed_now(constraints_inout, last, hit - 1, not second, mover, motions)
        # Two points that hit nearly at the same time hit together, otherwise a flat landing would start a rotation.
        together = other_speed > threshold and (r.gap_1 if second else r.gap_2) <= TOGETHER * dt * other_speed
        speed_1 = hit_speed if not second else (other_speed if together else 0.0)
        speed_2 = hit_speed if second else (other_speed if together else 0.0)
        change_1 = r.normal_mass_1 * back * speed_1
        change_2 = r.normal_mass_2 * back * speed_2
        if together:
            change_1, change_2 = solve_two(change_1, change_2, r.couple_1, r.couple_2, r.split, 0.0, 0.0)
        r.push_impulse_1 += change_1
        r.push_impulse_2 += change_2
    return False


@subkernel
def take_hits(last, constraints_inout, motions_inout):
    """Replace the impulses of the substeps by those of the simulated impacts. They are no cached forces for the next
    step.
    """
    at = last
    while at != NOBODY:
        r = constraints_inout[at - 1]
        a = motions_inout[r.motion_a]
        b = motions_inout[r.motion_b]
        change = r.push_impulse_1 - r.normal_total_1
        push_pair(r.normal_x, r.normal_y, r.ax_1, r.ay_1, r.bx_1, r.by_1, change, a, b)
        r.normal_impulse_1 = 0.0
        r.normal_total_1 = r.push_impulse_1
        if r.count == 2:
            change = r.push_impulse_2 - r.normal_total_2
            push_pair(r.normal_x, r.normal_y, r.ax_2, r.ay_2, r.bx_2, r.by_2, change, a, b)
            r.normal_impulse_2 = 0.0
            r.normal_total_2 = r.push_impulse_2
        r.push_impulse_1, r.push_impulse_2 = 0.0, 0.0
        r.played = True
        at = r.before


@subkernel
def play_all_hits(
    # read
    manifolds,
    anchors,
    threshold,
    dt,
    count,
    # write
    motions_inout,
    constraints_inout,
    work_inout,
):
    """Apply simultaneous impacts: flying bodies that hit static ones several times within a step of dt [s].

    They are among so many CONSTRAINT rows with restitution and an impulse; their rows are then `played`. threshold
    [px/s]: slower impacts do not bounce. O(count + hits · points² of such a body).
    """
    link_hits(anchors, count, constraints_inout, motions_inout)
    for i in range(count):
        r = constraints_inout[i]
        if not r.linked or not r.still or r.rests:
            continue
        row, _ = mover_of(r, motions_inout)
        mover = motions_inout[row]
        # The last row represents the body.
        if mover.hits == i + 1 and is_played(constraints_inout, i + 1, manifolds, threshold):
            if not play_hits(i + 1, manifolds, anchors, threshold, dt, mover, motions_inout, constraints_inout):
                work_inout[CAP_HITS] += 1
            take_hits(i + 1, constraints_inout, motions_inout)
    unlink_hits(constraints_inout, count, motions_inout)


# ---- bounce ----------------------------------------------------------------------------------------------------------
# Restitution, once, after the last substep, for every stacking solver.
#
# It uses the approach speed at the moment of impact, by the parabola from before the step. So a speculative contact
# that slowed the body does not reduce the bounce (Rapier #919, #974), and no height is lost by the length of steps. Two
# points of one manifold are solved together, otherwise a box that lands flat would rotate. For several impacts in one
# step see "hits" above.


@subkernel
def bounces(speed, threshold, total):
    """Return whether a point bounces: it approached fast enough before the step, and got an impulse in it."""
    return speed > threshold and total > 0.0


@subkernel
def bounce_once(wanted, nx, ny, ax, ay, bx, by, mass, impulse, a_inout, b_inout):
    """Apply restitution at one point, for a separation speed [px/s]. Return the change of its impulse."""
    missing = wanted - relative_speed(a_inout, b_inout, nx, ny, ax, ay, bx, by)
    change = max(impulse + mass * missing, 0.0) - impulse
    push_pair(nx, ny, ax, ay, bx, by, change, a_inout, b_inout)
    return change


@subkernel
def bounce_together(wanted_1, wanted_2, r, a_inout, b_inout):
    """Apply restitution at two points at once, for separation speeds [px/s], by the 2 x 2 system. Return the changes of
    their impulses.
    """
    nx = r.normal_x
    ny = r.normal_y
    missing_1 = wanted_1 - relative_speed(a_inout, b_inout, nx, ny, r.ax_1, r.ay_1, r.bx_1, r.by_1)
    missing_2 = wanted_2 - relative_speed(a_inout, b_inout, nx, ny, r.ax_2, r.ay_2, r.bx_2, r.by_2)
    old_1 = r.normal_total_1
    old_2 = r.normal_total_2
    x_1, x_2 = solve_two(
        r.normal_mass_1 * missing_1, r.normal_mass_2 * missing_2, r.couple_1, r.couple_2, r.split, old_1, old_2
    )
    push_pair(nx, ny, r.ax_1, r.ay_1, r.bx_1, r.by_1, x_1 - old_1, a_inout, b_inout)
    push_pair(nx, ny, r.ax_2, r.ay_2, r.bx_2, r.by_2, x_2 - old_2, a_inout, b_inout)
    return x_1 - old_1, x_2 - old_2


@subkernel
def restore_bounces(
    # read
    manifolds,
    anchors,
    threshold,
    dt,
    count,
    # write
    motions_inout,
    constraints_inout,
    work_inout,
):
    """Set the separation speed of points with an impulse to restitution times the approach speed. O(count).

    dt [s] of the step. threshold [px/s]: slower impacts do not bounce. CONTACT, ANCHOR and MOTION rows, and so many
    CONSTRAINT rows.
    """
    play_all_hits(manifolds, anchors, threshold, dt, count, motions_inout, constraints_inout, work_inout)
    for i in range(count):
        r = constraints_inout[i]
        if r.played:
            work_inout[RESTITUTION_ROWS] += int(r.normal_total_1 > 0.0) + int(r.normal_total_2 > 0.0)
            continue
        m = manifolds[r.manifold]
        restitution = anchors[r.manifold].restitution
        if restitution <= 0.0:
            continue
        a = motions_inout[r.motion_a]
        b = motions_inout[r.motion_b]
        nearing = (a.acceleration_x - b.acceleration_x) * r.normal_x
        nearing += (a.acceleration_y - b.acceleration_y) * r.normal_y
        speed_1 = speed_of_impact(m.speed_1, m.separation_1, nearing)
        speed_2 = speed_of_impact(m.speed_2, m.separation_2, nearing) if r.count == 2 else 0.0
        first = bounces(speed_1, threshold, r.normal_total_1)
        second = r.count == 2 and bounces(speed_2, threshold, r.normal_total_2)
        if not (first or second):
            continue
        work_inout[RESTITUTION_ROWS] += int(first) + int(second)
        change_1 = 0.0
        change_2 = 0.0
        wanted_1 = restitution * speed_1
        wanted_2 = restitution * speed_2
        nx = r.normal_x
        ny = r.normal_y
        if first and second:
            change_1, change_2 = bounce_together(wanted_1, wanted_2, r, a, b)
        elif first:
            change_1 = bounce_once(
                wanted_1, nx, ny, r.ax_1, r.ay_1, r.bx_1, r.by_1, r.normal_mass_1, r.normal_total_1, a, b
            )
        else:
            change_2 = bounce_once(
                wanted_2, nx, ny, r.ax_2, r.ay_2, r.bx_2, r.by_2, r.normal_mass_2, r.normal_total_2, a, b
            )
        # It is no cached force for the next step.
        r.normal_total_1 += change_1
        r.normal_total_2 += change_2
