"""Velocities from forces, poses from velocities: semi-implicit Euler, velocities first.

Source of the order and of the implicit drag v / (1 + c h), which is stable for any c: Catto, Numerical Methods, GDC 2015.
"""

import math

from physics.jit import kernel
from physics.math2d import turned
from physics.tables.body import DYNAMIC, STATIC
from physics.tables.counters import BODIES_INTEGRATED


def make_velocity_pass(gravity: bool, drag: bool, wind: bool, rotation: bool):
    """The pass over the dynamic bodies for a world with these effects.

    Wind pushes by drag_rate · wind; with drag too, bodies tend to the velocity of the wind.
    """

    @kernel
    def integrate_velocities(
        # read, scalars
        gravity_x,
        gravity_y,
        drag_rate,
        wind_x,
        wind_y,
        dt,
        # write
        bodies_inout,
    ):
        """Add gravity [px/s2], collected forces and drag [1/s] towards the wind [px/s] to the velocities; O(bodies)."""
        for i in range(len(bodies_inout)):
            b = bodies_inout[i]
            if b.kind != DYNAMIC or b.quarantined:
                continue
            b.vx += dt * b.inverse_mass * b.force_x
            b.vy += dt * b.inverse_mass * b.force_y
            if gravity:
                b.vx += dt * b.gravity_scale * gravity_x
                b.vy += dt * b.gravity_scale * gravity_y
            if rotation:
                b.angular_velocity += dt * b.inverse_inertia * b.torque
            if wind:
                b.vx += drag_rate * dt * wind_x
                b.vy += drag_rate * dt * wind_y
            if drag:
                keep = 1.0 / (1.0 + drag_rate * dt)
                b.vx = keep * b.vx
                b.vy = keep * b.vy
                if rotation:
                    b.angular_velocity = keep * b.angular_velocity
            b.force_x = 0.0
            b.force_y = 0.0
            b.torque = 0.0

    return integrate_velocities


def make_position_pass(rotation: bool):
    """The pass over the moving bodies; with rotation they turn about their centres of mass."""

    @kernel
    def integrate_positions(
        # read, scalars
        dt,
        # write
        bodies_inout,
        work_inout,
    ):
        """Move every body by the free fraction of its motion in dt [s], keeping the pose it came from; O(bodies)."""
        for i in range(len(bodies_inout)):
            b = bodies_inout[i]
            b.previous_x = b.x
            b.previous_y = b.y
            b.previous_angle = b.angle
            if b.kind == STATIC or b.quarantined:
                continue
            work_inout[BODIES_INTEGRATED] += 1
            h = dt * b.fraction
            if rotation and b.angular_velocity != 0.0:
                u, v = turned(b.local_center_x, b.local_center_y, math.cos(b.angle), math.sin(b.angle))
                center_x = b.x + u + h * b.vx
                center_y = b.y + v + h * b.vy
                b.angle += h * b.angular_velocity
                u, v = turned(b.local_center_x, b.local_center_y, math.cos(b.angle), math.sin(b.angle))
                b.x = center_x - u
                b.y = center_y - v
            else:
                b.x += h * b.vx
                b.y += h * b.vy

    return integrate_positions


@kernel
def refresh_centers(bodies_inout):
    """Write the world centres of mass [px] at the present poses. O(bodies)."""
    for i in range(len(bodies_inout)):
        b = bodies_inout[i]
        u = b.local_center_x
        v = b.local_center_y
        if b.angle != 0.0:
            u, v = turned(u, v, math.cos(b.angle), math.sin(b.angle))
        b.center_x = b.x + u
        b.center_y = b.y + v
        if abs(b.x) < math.inf and abs(b.y) < math.inf and abs(b.angle) < math.inf:
            b.settled_x = b.x
            b.settled_y = b.y
            b.settled_angle = b.angle


@kernel
def find_broken(
    # read, scalars
    speed_limit,
    position_limit,
    dt,
    # write
    bodies_inout,
    broken_out,
):
    """List the rows of bodies that are not finite, too fast [px/s] or too far out [px], and put them to rest.

    Each goes back to the last finite pose and is marked quarantined. Returns the number. broken_out (bodies) rows.
    """
    found = 0
    for i in range(len(bodies_inout)):
        b = bodies_inout[i]
        if b.quarantined:
            continue
        there = abs(b.x) < position_limit and abs(b.y) < position_limit and abs(b.angle) < math.inf
        finite = (
            there
            and abs(b.vx) < speed_limit
            and abs(b.vy) < speed_limit
            and abs(b.x + dt * b.vx) < position_limit
            and abs(b.y + dt * b.vy) < position_limit
            and abs(b.angle + dt * b.angular_velocity) < math.inf
        )
        if not finite:
            broken_out[found] = i
            found += 1
            if not there:
                b.x = b.settled_x
                b.y = b.settled_y
                b.angle = b.settled_angle
            b.previous_x = b.x
            b.previous_y = b.y
            b.previous_angle = b.angle
            b.vx = 0.0
            b.vy = 0.0
            b.angular_velocity = 0.0
            b.force_x = 0.0
            b.force_y = 0.0
            b.torque = 0.0
            b.quarantined = True
    return found
