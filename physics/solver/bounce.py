"""Restitution, once, after the last substep: what every stacking solver ends with.

Seeded with the speed with which two sides meet, by the parabola from before the step: so a speculative row that has
already braked the body does not eat the bounce (Rapier #919, #974), and no height is lost by the length of steps. Two
points of one manifold are solved together, or a box that lands flat would spin. Who hits several things in one step:
see hits.py.
"""

from physics.jit import subkernel
from physics.solver.hits import play_all_hits
from physics.solver.impulses import push_pair, relative_speed, speed_of_impact
from physics.solver.two_points import solve_two
from physics.tables.counters import RESTITUTION_ROWS


@subkernel
def bounces(speed, threshold, total):
    """Whether a point bounces: fast enough before the step, and an impulse acted in it."""
    return speed > threshold and total > 0.0


@subkernel
def bounce_once(wanted, nx, ny, ax, ay, bx, by, mass, impulse, a_inout, b_inout):
    """Bounce one point, to part at the wanted speed [px/s]. Returns the change of its impulse."""
    missing = wanted - relative_speed(a_inout, b_inout, nx, ny, ax, ay, bx, by)
    change = max(impulse + mass * missing, 0.0) - impulse
    push_pair(nx, ny, ax, ay, bx, by, change, a_inout, b_inout)
    return change


@subkernel
def bounce_together(wanted_1, wanted_2, r, a_inout, b_inout):
    """Bounce two points at once, to part at the wanted speeds [px/s], by the 2 x 2 system.
    Returns the changes of their impulses."""
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
    """Give back restitution times the approach speed where an impulse acted in a step of dt [s]; threshold [px/s]:
    slower ones stay dead.

    MANIFOLD, ANCHOR, MOTION rows, and so many of CONSTRAINT. O(count).
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
        # No force that the next step could start from.
        r.normal_total_1 += change_1
        r.normal_total_2 += change_2
