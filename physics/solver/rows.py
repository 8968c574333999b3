"""What a contact is to a solver: a CONSTRAINT row.

Source of the arms and effective masses: Catto, Box2D v3, contact_solver.c; the row holds arms from the centres of mass
at the beginning of the step, and a separation that follows from how far both sides have moved since. Where two faces
stick, the arms stay as they were when they were found: arms that turn with a column that leans give its load a torque,
and it buckles (Catto, Box2D v3: contact recycling).
"""

from collections.abc import Callable

from physics.jit import inlined, subkernel
from physics.settings import CROWD, STICKING_TURN
from physics.solver.two_points import split_of
from physics.tables.counters import SOLVER_ROWS, TANGENT_ROWS

BOTH = (False, True)


@subkernel
def effective_mass(a, b, ax, ay, bx, by, x, y):
    """Mass that an impulse along a unit direction (x, y) at these arms feels; 0 where nothing can be pushed."""
    a_arm = ax * y - ay * x
    b_arm = bx * y - by * x
    k = a.inverse_mass + b.inverse_mass + a.inverse_inertia * a_arm * a_arm + b.inverse_inertia * b_arm * b_arm
    return 1.0 / k if k > 0.0 else 0.0


@subkernel
def couple(a, b, row_out):
    """Write how the two points of a CONSTRAINT row feel each other; a, b: its MOTION rows."""
    r = row_out
    r.couple_1 = 0.0
    r.couple_2 = 0.0
    r.split = 0.0
    if r.count == 2:
        a_1 = r.ax_1 * r.normal_y - r.ay_1 * r.normal_x
        b_1 = r.bx_1 * r.normal_y - r.by_1 * r.normal_x
        a_2 = r.ax_2 * r.normal_y - r.ay_2 * r.normal_x
        b_2 = r.bx_2 * r.normal_y - r.by_2 * r.normal_x
        k_12 = a.inverse_mass + b.inverse_mass + a.inverse_inertia * a_1 * a_2 + b.inverse_inertia * b_1 * b_2
        r.couple_1 = r.normal_mass_1 * k_12
        r.couple_2 = r.normal_mass_2 * k_12
        r.split = split_of(r.couple_1, r.couple_2)


@subkernel
def sticks(a, b, anchor, distance):
    """Whether two faces lie on each other nearly as when they were found: normal and arms may stay as they were then.

    They bear a load, neither is round, neither body (BODY rows) turned by more than STICKING_TURN, their centres moved
    against each other by no more than distance [px]. What bears nothing has to find its own way out of an overlap.
    """
    x = b.center_x - a.center_x - anchor.apart_x
    y = b.center_y - a.center_y - anchor.apart_y
    return (
        (anchor.normal_force_1 > 0.0 or anchor.normal_force_2 > 0.0)
        and anchor.radius_a == 0.0
        and anchor.radius_b == 0.0
        and abs(a.angle - anchor.angle_a) <= STICKING_TURN
        and abs(b.angle - anchor.angle_b) <= STICKING_TURN
        and x * x + y * y <= distance * distance
    )


@subkernel
def touches_slowly(separation, speed, limits):
    """Whether a point lies on the other side, or as good as that, too slow to bounce."""
    return separation <= limits.slop and abs(speed) <= limits.bounce_speed


@inlined
def judge_row(m, c, held, a, b, degree_a, degree_b, limits, row_out):
    """Write what a CONSTRAINT row is told by: of a manifold, its anchor, whether its faces are held, the MOTION rows of
    its sides and how many contacts each of them has."""
    r = row_out
    # One contact below, and one above.
    r.alone = held and (a.inverse_mass == 0.0 or degree_a <= 2) and (b.inverse_mass == 0.0 or degree_b <= 2)
    crowd = max(degree_a if a.inverse_mass > 0.0 else 0, degree_b if b.inverse_mass > 0.0 else 0)
    r.push_share = CROWD / crowd if crowd > CROWD else 1.0
    r.calm = m.speed_1 <= limits.calm_speed and (m.count == 1 or m.speed_2 <= limits.calm_speed)
    r.loaded = c.normal_force_1 > 0.0 or (m.count == 2 and c.normal_force_2 > 0.0)
    r.meets = m.speed_1 > limits.bounce_speed or (m.count == 2 and m.speed_2 > limits.bounce_speed)
    r.rests = touches_slowly(m.separation_1, m.speed_1, limits) or (
        m.count == 2 and touches_slowly(m.separation_2, m.speed_2, limits)
    )
    r.still = a.inverse_mass == 0.0 or b.inverse_mass == 0.0


def make_prepare_row(friction: bool, conveyor: bool) -> Callable:
    """What makes a constraint of a contact in a world with these effects."""

    @inlined
    def prepare_row(
        # read
        bodies,
        motions,
        manifolds,
        plan,
        edge,
        h,
        limits,
        # write
        anchors_inout,
        row_out,
        work_inout,
    ):
        """Fill a CONSTRAINT row for an edge of the plan, with the impulses that the last step found for a substep of
        h [s]. plan: see Plan, limits: see settings.Limits. Arms go from the centres of mass to the contact point.
        """
        first = plan.selected[edge]
        m = manifolds[first]
        c = anchors_inout[first]
        r = row_out
        c.color = plan.colors[edge]
        r.motion_a = plan.edges[edge, 0]
        r.motion_b = plan.edges[edge, 1]
        a = motions[r.motion_a]
        b = motions[r.motion_b]
        p = bodies[m.body_row_a]
        q = bodies[m.body_row_b]
        r.manifold = first
        r.count = m.count
        held = m.count == 2 and m.lead == 0.0 and sticks(p, q, c, limits.sticking)
        nx = c.held_nx if held else m.normal_x
        ny = c.held_ny if held else m.normal_y
        r.normal_x = nx
        r.normal_y = ny
        r.friction = c.friction if friction else 0.0
        r.surface_speed = c.surface_speed if conveyor else 0.0
        judge_row(m, c, held, a, b, plan.degrees[r.motion_a], plan.degrees[r.motion_b], limits, r)
        r.rolling_limit = c.rolling_resistance if friction else 0.0
        turning = a.inverse_inertia + b.inverse_inertia
        r.rolling_mass = 1.0 / turning if turning > 0.0 else 0.0
        r.rolling_impulse = h * c.rolling_force
        r.push_impulse_1, r.push_impulse_2 = 0.0, 0.0
        # The rows are used again: a manifold of one point has no second.
        r.ax_2, r.ay_2, r.bx_2, r.by_2 = 0.0, 0.0, 0.0, 0.0
        r.normal_impulse_2, r.tangent_impulse_2 = 0.0, 0.0
        r.normal_total_2, r.tangent_total_2 = 0.0, 0.0
        r.radius_a, r.radius_b = c.radius_a, c.radius_b
        core = c.radius_a + c.radius_b
        for k in range(m.count):
            work_inout[SOLVER_ROWS] += 1
            if r.friction > 0.0:
                work_inout[TANGENT_ROWS] += 1
            x = m.x_1 if k == 0 else m.x_2
            y = m.y_1 if k == 0 else m.y_2
            ax = x - p.center_x
            ay = y - p.center_y
            bx = x - q.center_x + m.lead * ny  # where B's point is now
            by = y - q.center_y - m.lead * nx
            if held:
                ax = c.held_ax_1 if k == 0 else c.held_ax_2
                ay = c.held_ay_1 if k == 0 else c.held_ay_2
                bx = ax - c.apart_x
                by = ay - c.apart_y
            base = (m.separation_1 if k == 0 else m.separation_2) - ((bx - ax) * nx + (by - ay) * ny) - core
            normal_mass = effective_mass(a, b, ax, ay, bx, by, nx, ny)
            tangent_mass = effective_mass(a, b, ax, ay, bx, by, -ny, nx)
            if k == 0:
                r.ax_1, r.ay_1, r.bx_1, r.by_1, r.base_1 = ax, ay, bx, by, base
                r.normal_mass_1, r.tangent_mass_1 = normal_mass, tangent_mass
                r.normal_impulse_1, r.tangent_impulse_1 = h * c.normal_force_1, h * c.tangent_force_1
                r.normal_total_1, r.tangent_total_1 = 0.0, 0.0
            else:
                r.ax_2, r.ay_2, r.bx_2, r.by_2, r.base_2 = ax, ay, bx, by, base
                r.normal_mass_2, r.tangent_mass_2 = normal_mass, tangent_mass
                r.normal_impulse_2, r.tangent_impulse_2 = h * c.normal_force_2, h * c.tangent_force_2
        couple(a, b, r)

    return prepare_row


PREPARE_ROW = {(f, c): make_prepare_row(friction=f, conveyor=c) for f in BOTH for c in BOTH}
