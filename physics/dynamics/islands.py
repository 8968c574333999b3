"""Islands: bodies that touch, directly or over others, and fall asleep and wake as one.

Union-find over the contacts in their canonical order, the lower row as the root, so islands are the same whatever
found the contacts. Source: Catto, Box2D v3, Simulation Islands, 2023; sleeping by the larger of velocity and half the
real displacement: Box2D v3.2, solver.c.
"""

import math

from physics.dynamics.awake import is_active
from physics.jit import kernel, subkernel
from physics.math2d import length_of
from physics.tables.body import DYNAMIC


@subkernel
def root_of(row, parents_inout):
    """The root of a row's island, halving the path to it."""
    while parents_inout[row] != row:
        parents_inout[row] = parents_inout[parents_inout[row]]
        row = parents_inout[row]
    return row


@kernel
def link_islands(
    # read
    bodies,
    contacts,
    # write
    parents_out,
):
    """Join the awake dynamic bodies that touch. parents_out (bodies) int64: row of the root of each. O(contacts).

    Returns the number of islands of dynamic bodies that are awake.
    """
    for i in range(len(bodies)):
        parents_out[i] = i
    for i in range(len(contacts)):
        c = contacts[i]
        a = bodies[c.body_row_a]
        b = bodies[c.body_row_b]
        if c.sensor or a.kind != DYNAMIC or b.kind != DYNAMIC or not (c.separation <= 0.0 or c.normal_force > 0.0):
            continue
        if not (a.awake and b.awake):
            continue
        first = root_of(c.body_row_a, parents_out)
        second = root_of(c.body_row_b, parents_out)
        if first < second:
            parents_out[second] = first
        elif second < first:
            parents_out[first] = second
    islands = 0
    for i in range(len(bodies)):
        parents_out[i] = root_of(i, parents_out)
        if bodies[i].kind == DYNAMIC and bodies[i].awake and parents_out[i] == i:
            islands += 1
    return islands


@kernel
def fall_asleep(
    # read
    contacts,
    parents,
    dt,
    slow,
    patience,
    # write
    least_out,
    bodies_inout,
):
    """Put the islands to sleep of which every body has been slow [px/s] for `patience` [s]. Returns the bodies that slept in.

    What touches a kinematic body on its way stays awake. parents: roots from link_islands; least_out (bodies): scratch.
    O(bodies + contacts).
    """
    for i in range(len(bodies_inout)):
        b = bodies_inout[i]
        least_out[i] = math.inf
        if b.kind != DYNAMIC or not b.awake or b.quarantined:
            continue
        speed = length_of(b.vx, b.vy) + abs(b.angular_velocity) * b.extent
        if dt > 0.0:
            moved = length_of(b.x - b.previous_x, b.y - b.previous_y) + abs(b.angle - b.previous_angle) * b.extent
            speed = max(speed, 0.5 * moved / dt)
        b.sleep_time = b.sleep_time + dt if speed <= slow else 0.0
        b.island = bodies_inout[parents[i]].id
    for i in range(len(contacts)):
        c = contacts[i]
        a = bodies_inout[c.body_row_a]
        b = bodies_inout[c.body_row_b]
        if c.sensor:
            continue
        if a.kind != DYNAMIC and is_active(a):
            b.sleep_time = 0.0
        if b.kind != DYNAMIC and is_active(b):
            a.sleep_time = 0.0
    for i in range(len(bodies_inout)):
        b = bodies_inout[i]
        if b.kind == DYNAMIC and b.awake and not b.quarantined:
            least_out[parents[i]] = min(least_out[parents[i]], b.sleep_time)
    slept = 0
    for i in range(len(bodies_inout)):
        b = bodies_inout[i]
        if b.kind == DYNAMIC and b.awake and not b.quarantined and least_out[parents[i]] >= patience:
            b.awake = False
            b.vx = 0.0
            b.vy = 0.0
            b.angular_velocity = 0.0
            b.previous_x = b.x  # or it would seem to have been moved, and wake
            b.previous_y = b.y
            b.previous_angle = b.angle
            slept += 1
    return slept


@kernel
def find_sleepers_to_wake(
    # read
    bodies,
    contacts,
    parked,
    dt,
    # write
    wake_out,
):
    """Flag the sleeping bodies that something disturbs. Returns their number. O(bodies + contacts).

    Their own velocity or force; a support, in the parked contacts, that is on its way; a body on its way that touches
    them, or will within dt [s]. wake_out (bodies) bool.
    """
    found = 0
    for i in range(len(bodies)):
        b = bodies[i]
        wake_out[i] = False
        if (
            b.kind == DYNAMIC
            and not b.awake
            and not b.quarantined
            and (
                b.vx != 0.0
                or b.vy != 0.0
                or b.angular_velocity != 0.0
                or b.force_x != 0.0
                or b.force_y != 0.0
                or b.torque != 0.0
                or b.x != b.previous_x
                or b.y != b.previous_y
                or b.angle != b.previous_angle
            )
        ):
            wake_out[i] = True
            found += 1
    for i in range(len(parked)):
        c = parked[i]
        if is_active(bodies[c.body_row_a]) or is_active(bodies[c.body_row_b]):
            for side in range(2):
                row = c.body_row_a if side == 0 else c.body_row_b
                if bodies[row].kind == DYNAMIC and not bodies[row].awake and not wake_out[row]:
                    wake_out[row] = True
                    found += 1
    for i in range(len(contacts)):
        c = contacts[i]
        if c.sensor or c.separation > max(0.0, c.speed * dt):
            continue
        a = bodies[c.body_row_a]
        b = bodies[c.body_row_b]
        if is_active(a) and b.kind == DYNAMIC and not b.awake and not wake_out[c.body_row_b]:
            wake_out[c.body_row_b] = True
            found += 1
        if is_active(b) and a.kind == DYNAMIC and not a.awake and not wake_out[c.body_row_a]:
            wake_out[c.body_row_a] = True
            found += 1
    return found
