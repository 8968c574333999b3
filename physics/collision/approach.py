"""How fast two bodies close in on each other at a contact: what hits report and bounces are made of."""

from physics.jit import kernel, subkernel


@subkernel
def closing_speed(bodies, contact):
    """Speed [px/s] at which B's surface nears A's along the normal; negative when they part."""
    a = bodies[contact.body_row_a]
    b = bodies[contact.body_row_b]
    ax = contact.point_x - a.center_x
    ay = contact.point_y - a.center_y
    bx = contact.point_x - b.center_x
    by = contact.point_y - b.center_y
    vx = (b.vx - b.angular_velocity * by) - (a.vx - a.angular_velocity * ay)
    vy = (b.vy + b.angular_velocity * bx) - (a.vy + a.angular_velocity * ax)
    return -(contact.normal_x * vx + contact.normal_y * vy)


@kernel
def measure_approach(bodies, contacts_inout):
    """Write the closing speed of every contact before any response. contacts_inout CONTACT rows. O(contacts)."""
    for i in range(len(contacts_inout)):
        contacts_inout[i].speed = closing_speed(bodies, contacts_inout[i])


@kernel
def prepare_contacts(bodies, contacts_inout):
    """Write where B is seen from A: what a response without anchors starts from. O(contacts)."""
    for i in range(len(contacts_inout)):
        c = contacts_inout[i]
        a = bodies[c.body_row_a]
        b = bodies[c.body_row_b]
        c.anchor_x = b.center_x - a.center_x
        c.anchor_y = b.center_y - a.center_y


@kernel
def advance_contacts(bodies, contacts_inout):
    """Carry separations and points from where they were detected to the final poses, without detecting again.

    The displacement of B against A along the normal changes the separation; the point moves with the mean of both.
    """
    for i in range(len(contacts_inout)):
        c = contacts_inout[i]
        a = bodies[c.body_row_a]
        b = bodies[c.body_row_b]
        moved_x = (b.center_x - a.center_x) - c.anchor_x
        moved_y = (b.center_y - a.center_y) - c.anchor_y
        c.separation += c.normal_x * moved_x + c.normal_y * moved_y
        c.anchor_x += moved_x
        c.anchor_y += moved_y
