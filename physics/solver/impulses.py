"""Impulses of two motions on each other at a point, and the speeds that they change."""

import math

from physics.jit import subkernel


@subkernel
def relative_speed(a, b, nx, ny, ax, ay, bx, by):
    """Speed [px/s] of B against A along a normal at these arms; negative when they near each other."""
    vx = (b.vx - b.angular_velocity * by) - (a.vx - a.angular_velocity * ay)
    vy = (b.vy + b.angular_velocity * bx) - (a.vy + a.angular_velocity * ax)
    return vx * nx + vy * ny


@subkernel
def push_pair(nx, ny, ax, ay, bx, by, impulse, a_inout, b_inout):
    """Apply an impulse along the normal: to B forwards, to A backwards."""
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
    """Speed [px/s] with which two sides meet that were apart by a separation [px] before the step and neared each other
    at a speed and an acceleration [px/s2]; of those that overlapped, the speed itself."""
    if speed <= 0.0 or separation <= 0.0:
        return speed
    return math.sqrt(max(speed * speed + 2.0 * acceleration * separation, 0.0))
