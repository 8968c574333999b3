"""What every stacking solver starts from and leaves behind: motions of bodies, constraint rows, impulses.

Source of the anchors and effective masses: Catto, Box2D v3, contact_solver.c; the row holds arms from the centres of
mass at the beginning of the step, and a separation that follows from how far both sides have moved since.
"""

import math

from physics.jit import kernel, subkernel
from physics.math2d import turned
from physics.settings import CROWD
from physics.tables.body import DYNAMIC, STATIC
from physics.tables.counters import BODIES_INTEGRATED, SOLVER_ROWS, TANGENT_ROWS


def make_gather(gravity: bool, wind: bool, rotation: bool):
    """The pass from bodies to motions for a world with these effects."""

    @kernel
    def gather_motions(
        # read
        bodies,
        gravity_x,
        gravity_y,
        drag_rate,
        wind_x,
        wind_y,
        # write
        motions_out,
        work_inout,
    ):
        """Write what the substeps need of every body; what is asleep, static or kinematic cannot be pushed. O(bodies)."""
        for i in range(len(bodies)):
            b = bodies[i]
            m = motions_out[i]
            m.vx = b.vx
            m.vy = b.vy
            m.angular_velocity = b.angular_velocity if rotation else 0.0
            m.dx = 0.0
            m.dy = 0.0
            m.cosine = 1.0
            m.sine = 0.0
            m.turn = 0.0
            m.moves = b.kind != STATIC and b.awake and not b.quarantined
            m.pushed = m.moves and b.kind == DYNAMIC
            m.walks = False
            if not m.pushed:
                m.inverse_mass = 0.0
                m.inverse_inertia = 0.0
                m.acceleration_x = 0.0
                m.acceleration_y = 0.0
                m.angular_acceleration = 0.0
                if m.moves:
                    work_inout[BODIES_INTEGRATED] += 1
                continue
            work_inout[BODIES_INTEGRATED] += 1
            m.inverse_mass = b.inverse_mass
            m.inverse_inertia = b.inverse_inertia if rotation else 0.0
            m.acceleration_x = b.inverse_mass * b.force_x
            m.acceleration_y = b.inverse_mass * b.force_y
            m.angular_acceleration = m.inverse_inertia * b.torque
            if gravity:
                m.acceleration_x += b.gravity_scale * gravity_x
                m.acceleration_y += b.gravity_scale * gravity_y
            if wind:
                m.acceleration_x += drag_rate * wind_x
                m.acceleration_y += drag_rate * wind_y

    return gather_motions


def make_substep_velocities(drag: bool, rotation: bool):
    """The pass that speeds bodies up at the start of each substep."""

    @kernel
    def integrate_substep_velocities(
        # read, scalars
        h,
        drag_rate,
        # write
        motions_inout,
    ):
        """Add the accelerations of one substep h [s]; drag [1/s] implicitly, stable for any rate. O(bodies)."""
        keep = 1.0 / (1.0 + drag_rate * h)
        for i in range(len(motions_inout)):
            m = motions_inout[i]
            if not m.pushed:
                continue
            m.vx += h * m.acceleration_x
            m.vy += h * m.acceleration_y
            if rotation:
                m.angular_velocity += h * m.angular_acceleration
            if drag:
                m.vx = keep * m.vx
                m.vy = keep * m.vy
                if rotation:
                    m.angular_velocity = keep * m.angular_velocity

    return integrate_substep_velocities


def make_substep_positions(rotation: bool):
    """The pass that moves bodies at the end of each substep."""

    @kernel
    def integrate_substep_positions(
        # read, scalars
        h,
        # write
        motions_inout,
    ):
        """Move every body by one substep h [s]. O(bodies)."""
        for i in range(len(motions_inout)):
            m = motions_inout[i]
            if not m.moves:
                continue
            m.dx += h * m.vx
            m.dy += h * m.vy
            if rotation and m.angular_velocity != 0.0:
                m.turn += h * m.angular_velocity
                m.cosine = math.cos(m.turn)
                m.sine = math.sin(m.turn)

    return integrate_substep_positions


@kernel
def scatter_motions(
    # read
    motions,
    # write
    bodies_inout,
):
    """Write velocities and poses back to the bodies, keeping the pose of before the step. O(bodies)."""
    for i in range(len(bodies_inout)):
        b = bodies_inout[i]
        m = motions[i]
        b.previous_x = b.x
        b.previous_y = b.y
        b.previous_angle = b.angle
        b.force_x = 0.0
        b.force_y = 0.0
        b.torque = 0.0
        b.fraction = 1.0
        if not m.moves:
            continue
        b.vx = m.vx
        b.vy = m.vy
        b.angular_velocity = m.angular_velocity
        b.center_x += m.dx
        b.center_y += m.dy
        if m.turn == 0.0:
            b.x += m.dx
            b.y += m.dy
        else:
            b.angle += m.turn
            u, v = turned(b.local_center_x, b.local_center_y, math.cos(b.angle), math.sin(b.angle))
            b.x = b.center_x - u
            b.y = b.center_y - v


@subkernel
def effective_mass(a, b, ax, ay, bx, by, x, y):
    """Mass that an impulse along a unit direction (x, y) at these arms feels; 0 where nothing can be pushed."""
    a_arm = ax * y - ay * x
    b_arm = bx * y - by * x
    k = a.inverse_mass + b.inverse_mass + a.inverse_inertia * a_arm * a_arm + b.inverse_inertia * b_arm * b_arm
    return 1.0 / k if k > 0.0 else 0.0


def make_prepare(friction: bool, conveyor: bool):
    """The pass from contacts to constraint rows for a world with these effects."""

    @kernel
    def prepare_constraints(
        # read
        bodies,
        motions,
        degrees,
        ordered,
        count,
        h,
        # write
        contacts_inout,
        constraints_out,
        work_inout,
    ):
        """Fill the constraint rows in their order, with the impulses that the last step found for a substep of h [s].

        degrees (bodies): manifolds of each; ordered (count, 3) int32: first contact, points, colour. Arms go from the centres of mass to the contact point.
        O(count).
        """
        for i in range(count):
            r = constraints_out[i]
            first = ordered[i, 0]
            c = contacts_inout[first]
            a = motions[c.body_row_a]
            b = motions[c.body_row_b]
            r.body_row_a = c.body_row_a
            r.body_row_b = c.body_row_b
            r.first = first
            r.count = ordered[i, 1]
            nx = c.normal_x
            ny = c.normal_y
            r.normal_x = nx
            r.normal_y = ny
            r.friction = c.friction if friction else 0.0
            r.surface_speed = c.surface_speed if conveyor else 0.0
            crowd = max(
                degrees[c.body_row_a] if a.inverse_mass > 0.0 else 0,
                degrees[c.body_row_b] if b.inverse_mass > 0.0 else 0,
            )
            r.push_share = CROWD / crowd if crowd > CROWD else 1.0
            r.still = a.inverse_mass == 0.0 or b.inverse_mass == 0.0
            r.rolling_limit = c.rolling_resistance if friction else 0.0
            turning = a.inverse_inertia + b.inverse_inertia
            r.rolling_mass = 1.0 / turning if turning > 0.0 else 0.0
            r.rolling_impulse = h * c.rolling_force
            r.normal_impulse_2 = 0.0  # the rows are used again: a manifold of one point has no second
            r.tangent_impulse_2 = 0.0
            r.normal_total_2 = 0.0
            r.radius_a = c.radius_a
            r.radius_b = c.radius_b
            core = c.radius_a + c.radius_b
            for k in range(r.count):
                d = contacts_inout[first + k]
                d.color = ordered[i, 2]
                work_inout[SOLVER_ROWS] += 1
                if r.friction > 0.0:
                    work_inout[TANGENT_ROWS] += 1
                ax = d.point_x - bodies[c.body_row_a].center_x
                ay = d.point_y - bodies[c.body_row_a].center_y
                bx = d.point_x - bodies[c.body_row_b].center_x
                by = d.point_y - bodies[c.body_row_b].center_y
                base = d.separation - ((bx - ax) * nx + (by - ay) * ny) - core
                normal_mass = effective_mass(a, b, ax, ay, bx, by, nx, ny)
                tangent_mass = effective_mass(a, b, ax, ay, bx, by, -ny, nx)
                if k == 0:
                    r.ax_1, r.ay_1, r.bx_1, r.by_1, r.base_1 = ax, ay, bx, by, base
                    r.normal_mass_1, r.tangent_mass_1 = normal_mass, tangent_mass
                    r.normal_impulse_1, r.tangent_impulse_1 = h * d.normal_force, h * d.tangent_force
                    r.normal_total_1, r.tangent_total_1 = 0.0, 0.0
                else:
                    r.ax_2, r.ay_2, r.bx_2, r.by_2, r.base_2 = ax, ay, bx, by, base
                    r.normal_mass_2, r.tangent_mass_2 = normal_mass, tangent_mass
                    r.normal_impulse_2, r.tangent_impulse_2 = h * d.normal_force, h * d.tangent_force
                    r.normal_total_2, r.tangent_total_2 = 0.0, 0.0

    return prepare_constraints


def make_warm_start(rotation: bool):
    """The pass that applies the impulses a substep starts from."""

    @kernel
    def warm_start(
        # read
        constraints,
        count,
        # write
        motions_inout,
    ):
        """Apply the impulses that the rows hold already. O(count)."""
        for i in range(count):
            r = constraints[i]
            a = motions_inout[r.body_row_a]
            b = motions_inout[r.body_row_b]
            nx = r.normal_x
            ny = r.normal_y
            x = r.normal_impulse_1 * nx - r.tangent_impulse_1 * ny
            y = r.normal_impulse_1 * ny + r.tangent_impulse_1 * nx
            a_turn = 0.0
            b_turn = 0.0
            if rotation:
                a_turn = r.ax_1 * y - r.ay_1 * x + r.rolling_impulse
                b_turn = r.bx_1 * y - r.by_1 * x + r.rolling_impulse
            if r.count == 2:
                u = r.normal_impulse_2 * nx - r.tangent_impulse_2 * ny
                v = r.normal_impulse_2 * ny + r.tangent_impulse_2 * nx
                if rotation:
                    a_turn += r.ax_2 * v - r.ay_2 * u
                    b_turn += r.bx_2 * v - r.by_2 * u
                x += u
                y += v
            a.vx -= a.inverse_mass * x
            a.vy -= a.inverse_mass * y
            b.vx += b.inverse_mass * x
            b.vy += b.inverse_mass * y
            if rotation:
                a.angular_velocity -= a.inverse_inertia * a_turn
                b.angular_velocity += b.inverse_inertia * b_turn

    return warm_start


@kernel
def store_impulses(
    # read
    constraints,
    count,
    inverse_h,
    # write
    contacts_inout,
):
    """Write the step's impulses, and the forces that the next step starts from, back to the contacts. O(count)."""
    for i in range(count):
        r = constraints[i]
        c = contacts_inout[r.first]
        c.normal_impulse = r.normal_total_1
        c.tangent_impulse = r.tangent_total_1
        c.normal_force = inverse_h * r.normal_impulse_1
        c.tangent_force = inverse_h * r.tangent_impulse_1
        c.rolling_force = inverse_h * r.rolling_impulse
        if r.count == 2:
            d = contacts_inout[r.first + 1]
            d.normal_impulse = r.normal_total_2
            d.tangent_impulse = r.tangent_total_2
            d.normal_force = inverse_h * r.normal_impulse_2
            d.tangent_force = inverse_h * r.tangent_impulse_2
