"""How fast two bodies close in on each other at a contact: what hits report and bounces are made of."""

from physics.jit import inlined, kernel, subkernel
from physics.math2d import length_of


@subkernel
def velocity_at(body, x, y):
    """Velocity [px/s] of a point of a BODY row."""
    return (
        body.vx - body.angular_velocity * (y - body.center_y),
        body.vy + body.angular_velocity * (x - body.center_x),
    )


@subkernel
def closing(p, q, ax, ay, bx, by):
    """Velocity [px/s] of the point b of body q, seen from the point a of body p."""
    px, py = velocity_at(p, ax, ay)
    qx, qy = velocity_at(q, bx, by)
    return qx - px, qy - py


@subkernel
def nearing(a, b):
    """Velocity [px/s] of B seen from A, BODY rows, at the centre of the smaller, and how fast that is."""
    x = a.center_x if a.extent < b.extent else b.center_x
    y = a.center_y if a.extent < b.extent else b.center_y
    vx, vy = closing(a, b, x, y, x, y)
    return vx, vy, length_of(vx, vy)


@subkernel
def most_nearing(a, b):
    """What neither of two bodies, BODY rows, nor one as `nearing` sees it from the other, is faster than [px/s]."""
    way = abs(b.center_x - a.center_x) + abs(b.center_y - a.center_y)
    turning = abs(a.angular_velocity) + abs(b.angular_velocity)
    return abs(a.vx) + abs(a.vy) + abs(b.vx) + abs(b.vy) + turning * way


@inlined
def closing_speed(a, b, x, y, nx, ny, lead):
    """Speed [px/s] at which B nears A at a point [px] along the normal; negative when they part. a, b: BODY rows;
    lead [px]: see MANIFOLD."""
    ax = x - a.center_x
    ay = y - a.center_y
    bx = x - b.center_x + lead * ny
    by = y - b.center_y - lead * nx
    vx = (b.vx - b.angular_velocity * by) - (a.vx - a.angular_velocity * ay)
    vy = (b.vy + b.angular_velocity * bx) - (a.vy + a.angular_velocity * ax)
    return -(nx * vx + ny * vy)


@inlined
def approach(a, b, manifold_inout):
    """Write the closing speed of both points of a MANIFOLD row of two bodies, BODY rows, before any response."""
    m = manifold_inout
    m.speed_1 = closing_speed(a, b, m.x_1, m.y_1, m.normal_x, m.normal_y, m.lead)
    if m.count == 2:
        m.speed_2 = closing_speed(a, b, m.x_2, m.y_2, m.normal_x, m.normal_y, m.lead)


@kernel
def measure_approach(bodies, manifolds_inout):
    """Write the closing speed of every point before any response. manifolds_inout MANIFOLD rows. O(manifolds)."""
    for i in range(len(manifolds_inout)):
        m = manifolds_inout[i]
        approach(bodies[m.body_row_a], bodies[m.body_row_b], m)
