"""The plain loop of a first game: no overlap, move; else stay where you were.

Differs from `projection` in that nothing is pushed: a mover that would overlap keeps its old pose and loses the speed
towards what is in its way. Every body that stays may be in the way of another, so the test is repeated until nobody
new has to stay: at most once per body, usually two or three rounds.
"""

from physics.collision.approach import closing_speed
from physics.jit import kernel
from physics.tables.body import DYNAMIC
from physics.tables.counters import SOLVER_ROWS


@kernel
def stay_behind(
    # write
    bodies_inout,
    contacts_inout,
    work_inout,
):
    """Put the dynamic bodies of every overlap that moved back to their old poses.

    The contact that stopped them is marked as met on the way. Touching (separation 0) stops nobody. Returns the number
    of bodies put back. O(contacts).
    """
    put_back = 0
    for i in range(len(contacts_inout)):
        c = contacts_inout[i]
        if c.separation >= 0.0:
            continue
        work_inout[SOLVER_ROWS] += 1
        for side in range(2):
            b = bodies_inout[c.body_row_a if side == 0 else c.body_row_b]
            if b.kind == DYNAMIC and (b.x != b.previous_x or b.y != b.previous_y or b.angle != b.previous_angle):
                b.center_x += b.previous_x - b.x
                b.center_y += b.previous_y - b.y
                b.x = b.previous_x
                b.y = b.previous_y
                b.angle = b.previous_angle
                c.swept = True
                put_back += 1
    return put_back


@kernel
def stop_approach(bodies_inout, contacts_inout):
    """Take out the closing speed of the contacts that stopped somebody, as an impulse without bounce. O(contacts)."""
    for i in range(len(contacts_inout)):
        c = contacts_inout[i]
        a = bodies_inout[c.body_row_a]
        b = bodies_inout[c.body_row_b]
        inverse_masses = a.inverse_mass + b.inverse_mass
        if not c.swept or c.sensor or inverse_masses == 0.0:
            continue
        impulse = max(closing_speed(bodies_inout, c), 0.0) / inverse_masses
        c.normal_impulse = impulse
        a.vx -= a.inverse_mass * impulse * c.normal_x
        a.vy -= a.inverse_mass * impulse * c.normal_y
        b.vx += b.inverse_mass * impulse * c.normal_x
        b.vy += b.inverse_mass * impulse * c.normal_y
