"""What arcade games do: push overlapping bodies apart by their inverse masses, reflect what approaches.

Differs from `blocking` in that a body which meets something goes on along it instead of staying where it was. No warm
starting, no memory: piles are soft. Cost: PROJECTION_PASSES passes over the contacts, two loops over none.
"""

from collections.abc import Callable

import numpy as np

from physics.ccd.rotational import CORE
from physics.ccd.sweep import shift_freely
from physics.collision.approach import closing_speed
from physics.dynamics.integrate import place_shapes, shift_bodies
from physics.jit import kernel, subkernel
from physics.settings import PROJECTION_PASSES
from physics.solver.pushes import PushSet
from physics.tables.body import DYNAMIC, OFF
from physics.tables.counters import RESTITUTION_ROWS, SOLVER_ROWS, TANGENT_ROWS
from physics.tables.step_state import StepState, stage

IGNORED = ("stacking", "sleeping")  # effects that it makes nothing of, as no contact is remembered


@subkernel
def push(x, y, anchor_x, anchor_y, rotation, body_inout):
    """Change a body's velocity by an impulse (x, y) at an arm from its centre of mass [px]."""
    body_inout.vx += body_inout.inverse_mass * x
    body_inout.vy += body_inout.inverse_mass * y
    if rotation:
        body_inout.angular_velocity += body_inout.inverse_inertia * (anchor_x * y - anchor_y * x)


@subkernel
def resist_rolling(push_inout, a_inout, b_inout):
    """Slow down how two bodies turn against each other, by no more torque than a PUSH row's normal impulse allows."""
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
    """One pass over the contacts of a world with these effects."""

    @kernel
    def project(
        # read, scalars
        bounce_speed,
        first,
        # write
        bodies_inout,
        pushes_inout,
        work_inout,
    ):
        """Push apart what overlaps and take out, or reflect, the approach; with friction along the tangent.

        bounce_speed [px/s]: slower approaches do not bounce; first: 1 in the first pass of a step. Impulses add up in
        the contacts. O(contacts).
        """
        for i in range(len(pushes_inout)):
            c = pushes_inout[i]
            a = bodies_inout[c.body_row_a]
            b = bodies_inout[c.body_row_b]
            inverse_masses = a.inverse_mass + b.inverse_mass
            if inverse_masses == 0.0:
                continue
            nx = c.normal_x
            ny = c.normal_y
            separation = (
                c.separation
                + nx * ((b.center_x - a.center_x) - c.anchor_x)
                + ny * ((b.center_y - a.center_y) - c.anchor_y)
            )
            if separation > 0.0 and not c.swept and c.normal_impulse == 0.0:
                continue
            work_inout[SOLVER_ROWS] += 1
            ax = c.x - a.center_x
            ay = c.y - a.center_y
            bx = c.x - b.center_x
            by = c.y - b.center_y
            wanted = 0.0
            if restitution and c.speed > bounce_speed:
                wanted = c.restitution * c.speed
                work_inout[RESTITUTION_ROWS] += first
            effective = inverse_masses
            if rotation:
                a_arm = ax * ny - ay * nx
                b_arm = bx * ny - by * nx
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
                tx = -ny
                ty = nx
                vx = b.vx - a.vx
                vy = b.vy - a.vy
                effective = inverse_masses
                if rotation:
                    vx += a.angular_velocity * ay - b.angular_velocity * by
                    vy += b.angular_velocity * bx - a.angular_velocity * ax
                    a_arm = ax * ty - ay * tx
                    b_arm = bx * ty - by * tx
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
                x = share * nx
                y = share * ny
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
    """Push everything apart. Returns the step [s]."""
    effects = state.effects
    run = PASSES[effects.rotation, effects.friction, effects.restitution]
    bodies, rows = state.bodies, state.awake.bodies
    before = np.column_stack([bodies["x"][rows], bodies["y"][rows]])
    contacts.prepare(state)
    for number in range(PROJECTION_PASSES):
        contacts.solve(state, run, state.tolerances.restitution_speed, int(number == 0))
    _slow_down(bodies, rows, before, contacts.reach[rows])
    if effects.continuous:
        _hold_back(state, rows, before)
    contacts.store(state)
    return state.dt


def _moves(bodies, rows, before):
    """(n, 2) [px] from where the bodies of these rows were, and how far that is."""
    moves = np.column_stack([bodies["x"][rows], bodies["y"][rows]]) - before
    return moves, np.hypot(moves[:, 0], moves[:, 1])


def _slow_down(bodies, rows, before, reach):
    """Let nobody be pushed further in this step than its reach [px], however many push it.

    In the end only: what is lifted by one contact and pressed down by the next has hardly moved.
    """
    moves, ways = _moves(bodies, rows, before)
    far = ways > reach
    if not far.any():
        return
    shift_bodies(bodies, rows[far], moves[far] * (reach[far] / ways[far] - 1.0)[:, None])


def _hold_back(state, rows, before):
    """Let nobody be pushed through a wall by somebody else. before (n, 2) [px]: where the bodies of these rows were."""
    bodies = state.bodies
    moves, ways = _moves(bodies, rows, before)
    far = ways > CORE * bodies["smallest_half"][rows]
    far &= (bodies["kind"][rows] == DYNAMIC) & (bodies["continuous"][rows] != OFF)
    if not far.any():
        return
    rows, moves = rows[far], moves[far]
    shift_bodies(bodies, rows, -moves)
    shift_freely(state, rows, moves, arrived=True)


@stage(
    "projection",
    reads=(
        *("effects", "stacks", "tolerances", "dt", "awake", "bodies", "shapes", "library", "pairs", "manifolds"),
        "workspace",
    ),
    writes=(
        "manifolds",
        "library",
        "work",
        "workspace",
        *(f"bodies.{name}" for name in ("x", "y", "center_x", "center_y", "vx", "vy", "angular_velocity", "fraction")),
        *(f"shapes.{name}" for name in ("min_x", "min_y", "max_x", "max_y", "raster", "left", "top")),
    ),
)
def projection(state: StepState) -> None:
    """Push the bodies apart where they ended. Without time nothing moves: contacts are reported, nothing is pushed."""
    if state.dt > 0.0:
        solve(state, state.workspace.contacts)
        place_shapes(state)
