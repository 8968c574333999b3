"""Projection solver: overlapping bodies are moved apart in proportion to their inverse masses, without warm start.

A PUSH row holds one contact point, in the order in which the solver works on the points.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from physics.ccd.rotational import CORE
from physics.ccd.sweep import shift_freely
from physics.collision.manifold import closing_speed, mixed
from physics.contacts.cache import update_contacts, write_caches
from physics.dynamics.integrate import place_shapes, shift_bodies
from physics.jit import kernel, subkernel
from physics.math2d import norm
from physics.settings import PROJECTION_PASSES
from physics.shapes.placement import PLACED
from physics.tables.body import DYNAMIC, OFF
from physics.tables.contact import PUSH
from physics.tables.step_state import RESTITUTION_ROWS, SOLVER_ROWS, TANGENT_ROWS, StepState, stage

ROUNDING = 1e-9  # share of an acceleration below which its component along a normal is a rounding error

# ---- pushes ----------------------------------------------------------------------------------------------------------
# Contacts of the solvers without warm start: one PUSH row for each contact point. Contacts of sensors have none.


class Press(NamedTuple):
    """Constants of a world, for computing which accelerations press two bodies together."""

    dt: float  # [s]
    gravity_x: float  # [px/s2] before the gravity scale of a body
    gravity_y: float
    wind_x: float  # [px/s2] drag times the velocity of the wind
    wind_y: float
    restitution_speed: float  # [px/s]


@subkernel
def press_of(press, body, nx, ny):
    """Return the acceleration [px/s2] that gravity and wind give a body along a normal (nx, ny).

    The result is 0 for a body that is not dynamic, and infinite if a force acted on the body in this step. press: see
    Press; body: BODY row.
    """
    if body.kind != DYNAMIC:
        return 0.0
    if body.forced:
        return math.inf
    x = press.wind_x + body.gravity_scale * press.gravity_x
    y = press.wind_y + body.gravity_scale * press.gravity_y
    return x * nx + y * ny if abs(x * nx + y * ny) > ROUNDING * (abs(x) + abs(y)) else 0.0


@subkernel
def restitution_threshold(press, a, b, nx, ny):
    """Return the approach speed [px/s] up to which two bodies do not bounce off each other along a normal (nx, ny).

    The speed is 0 if no acceleration presses the bodies together; see step_context.restitution_threshold. press: see
    Press; a, b: BODY rows.
    """
    into = max(press_of(press, a, nx, ny), 0.0) + max(press_of(press, b, -nx, -ny), 0.0)
    if into == 0.0:
        return 0.0
    return max(press.restitution_speed, 2.0 * press.dt * into) if into < math.inf else press.restitution_speed


@kernel
def prepare_pushes(geometry, bodies, shapes, manifolds, conveyor, press, pushes_out):
    """Write a PUSH row for every contact point, except for contacts of sensors. Return the number of rows.

    geometry: tables of the shape library; manifolds: CONTACT rows; conveyor: 1 to use surface speeds, 0 to ignore them;
    press: see Press. O(manifolds).
    """
    found = 0
    for i in range(len(manifolds)):
        m = manifolds[i]
        if m.sensor:
            continue
        a, b = bodies[m.body_row_a], bodies[m.body_row_b]
        friction, restitution, rolling, surface_speed = mixed(geometry, shapes[m.row_a], shapes[m.row_b], m)
        for k in range(m.count):
            r = pushes_out[found]
            r.manifold = i
            r.second = k == 1
            r.swept = m.swept
            r.body_row_a, r.body_row_b = m.body_row_a, m.body_row_b
            r.x = m.x_1 if k == 0 else m.x_2
            r.y = m.y_1 if k == 0 else m.y_2
            r.normal_x, r.normal_y = m.normal_x, m.normal_y
            r.separation = m.separation_1 if k == 0 else m.separation_2
            r.anchor_x, r.anchor_y = b.center_x - a.center_x, b.center_y - a.center_y
            r.speed = m.speed_1 if k == 0 else m.speed_2
            r.threshold = restitution_threshold(press, a, b, m.normal_x, m.normal_y)
            r.friction = friction
            r.restitution = restitution
            r.surface_speed = surface_speed if conveyor == 1 else 0.0
            r.rolling_limit = rolling
            r.normal_impulse, r.tangent_impulse, r.rolling_impulse = 0.0, 0.0, 0.0
            found += 1
    return found


@kernel
def limit_pushes(pushes, bodies, push_speed, dt, reach_out):
    """Write the greatest displacement [px] by which contacts may push each body in this step. O(pushes).

    The displacement is dt · (push_speed + v). v is the greatest of the body's speed and the approach speeds of its
    contacts. push_speed [px/s]: speed at which overlaps are removed; dt [s]: step length; reach_out (bodies) [px]:
    result, written only for the bodies of PUSH rows.
    """
    for i in range(len(pushes)):
        r = pushes[i]
        for side in range(2):
            row = r.body_row_a if side == 0 else r.body_row_b
            reach_out[row] = (push_speed + norm(bodies[row].vx, bodies[row].vy)) * dt
    for i in range(len(pushes)):
        r = pushes[i]
        for side in range(2):
            row = r.body_row_a if side == 0 else r.body_row_b
            reach_out[row] = max(reach_out[row], (push_speed + max(r.speed, 0.0)) * dt)


@kernel
def store_pushes(pushes, manifolds_inout):
    """Write the impulses of PUSH rows back to the CONTACT rows. O(pushes).

    Contacts that overlapped at detection are marked as `swept`. They then count as touching even if the pass has
    separated the bodies.
    """
    for i in range(len(pushes)):
        r = pushes[i]
        m = manifolds_inout[r.manifold]
        if r.separation < 0.0:
            m.swept = True
        if r.second:
            m.normal_impulse_2 = r.normal_impulse
            m.tangent_impulse_2 = r.tangent_impulse
        else:
            m.normal_impulse_1 = r.normal_impulse
            m.tangent_impulse_1 = r.tangent_impulse


class PushSet:
    """The contact points of one world as PUSH rows. The arrays grow when needed and are reused."""

    def __init__(self) -> None:
        self.data = np.zeros(16, PUSH)
        self.rows = self.data[:0]
        self.reach = np.zeros(16)  # (body rows) see limit_pushes

    def prepare(self, state: StepState) -> None:
        """Write the PUSH rows of all contact points, and the contact caches at the present poses."""
        points = 2 * len(state.contact_rows)
        if len(self.data) < points:
            self.data = np.zeros(2 * points, PUSH)
        tables, effects, wind = state.library.tables, state.effects, state.drag if state.effects.wind else 0.0
        gravity = state.gravity if effects.gravity else (0.0, 0.0)
        press = Press(
            state.dt, *gravity, wind * state.wind[0], wind * state.wind[1], state.tolerances.restitution_speed
        )
        contacts, conveyor = state.contact_rows, int(effects.conveyor)
        found = prepare_pushes(tables, state.bodies, state.shapes, contacts, conveyor, press, self.data)
        self.rows = self.data[:found]
        if len(self.reach) < len(state.bodies):
            self.reach = np.zeros(2 * len(state.bodies))
        limit_pushes(self.rows, state.bodies, state.tolerances.push_speed, state.dt, self.reach)
        write_caches(tables, state.bodies, state.shapes, state.contact_rows)

    def solve(self, state: StepState, run: Callable, *settings: Any) -> None:
        """Run one solver pass over the PUSH rows. run: kernel of the pass; settings: first arguments of this kernel."""
        run(*settings, state.bodies, self.rows, state.work)

    def store(self, state: StepState) -> None:
        """Write the impulses of the PUSH rows to the contacts, and update the contacts to the present poses."""
        store_pushes(self.rows, state.contact_rows)
        update_contacts(state.bodies, state.contact_rows)


# ---- projection ------------------------------------------------------------------------------------------------------
# Projection, as arcade games do it: separate overlapping bodies by their inverse masses, and reflect the approach.
#
# Unlike `blocking`, a body slides along an obstacle instead of keeping its old pose. Contacts are not cached, so stacks
# are soft. Cost: PROJECTION_PASSES passes over the contacts.

IGNORED = ("stacking", "sleeping", "joints")  # effects that this solver ignores, because impulses are not cached


@subkernel
def push(x, y, anchor_x, anchor_y, rotation, body_inout):
    """Apply an impulse (x, y) to a body at a point. body_inout: BODY row.

    anchor_x, anchor_y [px]: the point relative to the centre of mass; rotation: whether bodies rotate in this world.
    """
    body_inout.vx += body_inout.inverse_mass * x
    body_inout.vy += body_inout.inverse_mass * y
    if rotation:
        body_inout.angular_velocity += body_inout.inverse_inertia * (anchor_x * y - anchor_y * x)


@subkernel
def resist_rolling(push_inout, a_inout, b_inout):
    """Slow down the relative rotation of two bodies (BODY rows) by the rolling resistance of a PUSH row."""
    turning = a_inout.inverse_inertia + b_inout.inverse_inertia
    if turning <= 0.0:
        return
    limit = push_inout.rolling_limit * push_inout.normal_impulse
    old = push_inout.rolling_impulse
    turns = b_inout.angular_velocity - a_inout.angular_velocity
    impulse = max(-limit, min(limit, old - turns / turning))
    push_inout.rolling_impulse = impulse
    a_inout.angular_velocity -= a_inout.inverse_inertia * (impulse - old)
    b_inout.angular_velocity += b_inout.inverse_inertia * (impulse - old)


def make_projection_pass(rotation: bool, friction: bool, restitution: bool) -> Callable:
    """Return the kernel of one pass over the contacts. rotation, friction, restitution: effects that the world has."""

    @kernel
    def project(
        # read, scalars
        first,
        # write
        bodies_inout,
        pushes_inout,
        work_inout,
    ):
        """Separate overlapping bodies, stop or reflect their approach, and apply friction. O(contacts).

        first: 1 in the first pass of a step, else 0. Impulses accumulate in the PUSH rows. bodies_inout: BODY table;
        work_inout: counters, see COUNTERS.
        """
        for i in range(len(pushes_inout)):
            c = pushes_inout[i]
            a, b = bodies_inout[c.body_row_a], bodies_inout[c.body_row_b]
            inverse_masses = a.inverse_mass + b.inverse_mass
            if inverse_masses == 0.0:
                continue
            nx, ny = c.normal_x, c.normal_y
            separation = (
                c.separation
                + nx * ((b.center_x - a.center_x) - c.anchor_x)
                + ny * ((b.center_y - a.center_y) - c.anchor_y)
            )
            if separation > 0.0 and not c.swept and c.normal_impulse == 0.0:
                continue
            work_inout[SOLVER_ROWS] += 1
            ax, ay = c.x - a.center_x, c.y - a.center_y
            bx, by = c.x - b.center_x, c.y - b.center_y
            wanted = 0.0
            if restitution and c.speed > c.threshold:
                wanted = c.restitution * c.speed
                work_inout[RESTITUTION_ROWS] += first
            effective = inverse_masses
            if rotation:
                a_arm, b_arm = ax * ny - ay * nx, bx * ny - by * nx
                effective += a.inverse_inertia * a_arm * a_arm + b.inverse_inertia * b_arm * b_arm
            change = (wanted + closing_speed(a, b, c.x, c.y, nx, ny, 0.0)) / effective
            impulse = max(c.normal_impulse + change, 0.0)
            change = impulse - c.normal_impulse
            c.normal_impulse = impulse
            push(-change * nx, -change * ny, ax, ay, rotation, a)
            push(change * nx, change * ny, bx, by, rotation, b)
            if friction and rotation and c.rolling_limit > 0.0:
                resist_rolling(c, a, b)
            if friction and c.friction > 0.0:
                work_inout[TANGENT_ROWS] += 1
                tx, ty = -ny, nx
                vx, vy = b.vx - a.vx, b.vy - a.vy
                effective = inverse_masses
                if rotation:
                    vx += a.angular_velocity * ay - b.angular_velocity * by
                    vy += b.angular_velocity * bx - a.angular_velocity * ax
                    a_arm, b_arm = ax * ty - ay * tx, bx * ty - by * tx
                    effective += a.inverse_inertia * a_arm * a_arm + b.inverse_inertia * b_arm * b_arm
                change = -(vx * tx + vy * ty - c.surface_speed) / effective
                limit = c.friction * c.normal_impulse
                impulse = max(-limit, min(limit, c.tangent_impulse + change))
                change = impulse - c.tangent_impulse
                c.tangent_impulse = impulse
                push(-change * tx, -change * ty, ax, ay, rotation, a)
                push(change * tx, change * ty, bx, by, rotation, b)
            if separation < 0.0:
                share = -separation / inverse_masses
                x, y = share * nx, share * ny
                a.x -= a.inverse_mass * x
                a.y -= a.inverse_mass * y
                a.center_x -= a.inverse_mass * x
                a.center_y -= a.inverse_mass * y
                b.x += b.inverse_mass * x
                b.y += b.inverse_mass * y
                b.center_x += b.inverse_mass * x
                b.center_y += b.inverse_mass * y

    return project


PASSES = {
    (r, f, b): make_projection_pass(rotation=r, friction=f, restitution=b)
    for r in (False, True)
    for f in (False, True)
    for b in (False, True)
}


def solve(state: StepState, contacts: PushSet) -> float:
    """Separate overlapping bodies in PROJECTION_PASSES passes.

    Return the step length [s]. contacts: PushSet of the world.
    """
    effects = state.effects
    run = PASSES[effects.rotation, effects.friction, effects.restitution]
    bodies, rows = state.bodies, state.awake.bodies
    before = np.column_stack([bodies["x"][rows], bodies["y"][rows]])
    contacts.prepare(state)
    for number in range(PROJECTION_PASSES):
        contacts.solve(state, run, int(number == 0))
    _slow_down(bodies, rows, before, contacts.reach[rows])
    if effects.continuous:
        _hold_back(state, rows, before)
    contacts.store(state)
    return state.dt


def _moves(bodies, rows, before):
    """Return how bodies have moved: (displacements (n, 2) [px], their lengths (n,) [px]).

    rows: indices of the BODY rows; before (n, 2) [px]: former positions.
    """
    moves = np.column_stack([bodies["x"][rows], bodies["y"][rows]]) - before
    return moves, np.hypot(moves[:, 0], moves[:, 1])


def _slow_down(bodies, rows, before, reach):
    """Limit how far contacts have displaced each body in this step, independent of the number of contacts.

    Only the sum over all passes is limited, because pushes in opposite directions cancel. rows: indices of the BODY
    rows; before (n, 2) [px]: their positions before the passes; reach (n,) [px]: greatest displacements.
    """
    moves, ways = _moves(bodies, rows, before)
    far = ways > reach
    if not far.any():
        return
    shift_bodies(bodies, rows[far], moves[far] * (reach[far] / ways[far] - 1.0)[:, None])


def _hold_back(state, rows, before):
    """Move bodies back that contacts pushed through a wall, and then forward until a resting body blocks them.

    Only bodies that were pushed by more than CORE times their least half extent are tested. rows: indices of the BODY
    rows; before (n, 2) [px]: their positions before the passes.
    """
    bodies = state.bodies
    moves, ways = _moves(bodies, rows, before)
    far = ways > CORE * bodies["min_half_extent"][rows]
    far &= (bodies["kind"][rows] == DYNAMIC) & (bodies["continuous"][rows] != OFF)
    if not far.any():
        return
    rows, moves = rows[far], moves[far]
    shift_bodies(bodies, rows, -moves)
    shift_freely(state, rows, moves, arrived=True)


@stage(
    "projection",
    reads=(
        "effects", "stacks", "tolerances", "gravity", "drag", "wind", "dt", "awake", "bodies", "shapes", "library",
        "pairs", "contact_rows", "workspace",
    ),
    writes=(
        "contact_rows", "library", "work", "workspace", *PLACED,
        *(f"bodies.{name}" for name in ("x", "y", "center_x", "center_y", "vx", "vy", "angular_velocity", "fraction")),
    ),
)  # fmt: skip
def projection(state: StepState) -> None:
    """Move apart the bodies that overlap after their motion. A step of length 0 changes nothing."""
    if state.dt > 0.0:
        solve(state, state.workspace.contacts)
        place_shapes(state)
