"""Semi-implicit Euler integration: velocities from forces, then poses from velocities.

Implicit drag v / (1 + c h) is stable for any c. Source of both: Catto, Numerical Methods, GDC 2015.
"""

import math
from collections.abc import Callable

import numpy as np

from physics.jit import kernel, subkernel
from physics.math2d import rotate, rotation_of
from physics.shapes.library import add_missing_rasters
from physics.shapes.placement import PLACED, refresh_aabbs
from physics.tables.body import DYNAMIC, STATIC
from physics.tables.step_state import BODIES_INTEGRATED, StepState, stage

BOTH = (False, True)


def make_velocity_pass(gravity: bool, drag: bool, wind: bool, rotation: bool) -> Callable:
    """Return the velocity pass over the dynamic bodies for a world with these effects.

    Wind adds an acceleration drag_rate · wind; with drag too, bodies approach the velocity of the wind.
    """

    @kernel
    def integrate_velocities(rows, gravity_x, gravity_y, drag_rate, wind_x, wind_y, dt, bodies_inout):
        """Add gravity [px/s2], collected forces and drag [1/s] towards the wind [px/s] to the velocities. O(rows)."""
        for k in range(len(rows)):
            b = bodies_inout[rows[k]]
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
            b.forced = b.force_x != 0.0 or b.force_y != 0.0
            b.force_x = 0.0
            b.force_y = 0.0
            b.torque = 0.0

    return integrate_velocities


def make_position_pass(rotation: bool) -> Callable:
    """Return the position pass over the moving bodies; with rotation they rotate about their centres of mass."""

    @kernel
    def integrate_positions(rows, dt, bodies_inout, work_inout):
        """Move bodies by the free fraction of their motion in dt [s], and keep their previous poses. O(rows)."""
        for k in range(len(rows)):
            b = bodies_inout[rows[k]]
            b.previous_x = b.x
            b.previous_y = b.y
            b.previous_angle = b.angle
            if b.kind == STATIC or b.quarantined:
                continue
            work_inout[BODIES_INTEGRATED] += 1
            h = dt * b.fraction
            if rotation and b.angular_velocity != 0.0:
                u, v = rotate(b.local_center_x, b.local_center_y, *rotation_of(b.angle))
                center_x = b.x + u + h * b.vx
                center_y = b.y + v + h * b.vy
                b.angle += h * b.angular_velocity
                u, v = rotate(b.local_center_x, b.local_center_y, *rotation_of(b.angle))
                b.x = center_x - u
                b.y = center_y - v
            else:
                b.x += h * b.vx
                b.y += h * b.vy

    return integrate_positions


@subkernel
def put_center(u, v, body_inout):
    """Write the world centre of mass [px] of a BODY row, offset u, v from its origin, and its last finite pose."""
    b = body_inout
    b.center_x = b.x + u
    b.center_y = b.y + v
    b.has_current_contacts = False
    if abs(b.x) < math.inf and abs(b.y) < math.inf and abs(b.angle) < math.inf:
        b.settled_x = b.x
        b.settled_y = b.y
        b.settled_angle = b.angle


@subkernel
def refresh_center(body_inout):
    """Write the world centre of mass [px] of a BODY row at its present pose; NaN if the angle is not finite."""
    b = body_inout
    u = b.local_center_x
    v = b.local_center_y
    if not abs(b.angle) < math.inf:  # its cosine would be NaN in compiled code, and an error in plain code
        u = math.nan
        v = math.nan
    elif b.angle != 0.0:
        u, v = rotate(u, v, *rotation_of(b.angle))
    put_center(u, v, b)


@kernel
def refresh_centers(rows, bodies_inout):
    """Write the world centres of mass [px] at the present poses. O(rows)."""
    for k in range(len(rows)):
        refresh_center(bodies_inout[rows[k]])


# One pass per combination of the effects it depends on; made here, compiled on first use.
VELOCITIES = {
    (g, d, w, r): make_velocity_pass(gravity=g, drag=d, wind=w, rotation=r)
    for g in BOTH
    for d in BOTH
    for w in BOTH
    for r in BOTH
}
POSITIONS = {r: make_position_pass(rotation=r) for r in BOTH}


@stage(
    "integrate_velocities",
    reads=("effects", "awake", "bodies", "gravity", "drag", "wind", "dt"),
    writes=tuple(f"bodies.{name}" for name in ("vx", "vy", "angular_velocity", "force_x", "force_y", "torque")),
)
def integrate_velocities(state: StepState) -> None:
    """Integrate velocities from forces."""
    e = state.effects
    integrate = VELOCITIES[e.gravity, e.drag, e.wind, e.rotation]
    integrate(state.awake.bodies, *state.gravity, state.drag, *state.wind, state.dt, state.bodies)


@stage(
    "integrate_positions",
    reads=("effects", "awake", "bodies", "shapes", "library", "dt"),
    writes=(
        "work",
        "library",
        *(f"bodies.{name}" for name in ("x", "y", "angle", "previous_x", "previous_y", "previous_angle")),
        *(f"bodies.{name}" for name in ("center_x", "center_y", "has_current_contacts")),
        *(f"bodies.settled_{name}" for name in ("x", "y", "angle")),
        *PLACED,
    ),
)
def integrate_positions(state: StepState) -> None:
    """Integrate poses from velocities, up to the free fraction; update boxes and rasters."""
    rows, bodies = state.awake.bodies, state.bodies
    POSITIONS[state.effects.rotation](rows, state.dt, bodies, state.work)
    refresh_centers(rows, bodies)
    place_shapes(state)


def place_shapes(state: StepState) -> None:
    """Update boxes, and rasters of masks, to the present poses of awake bodies."""
    # A body that was stopped by a sweep, or rotated by the solver, may be at an angle without a raster.
    add_missing_rasters(state.library, state.awake.shapes, state.bodies, state.shapes, 0.0)
    refresh_aabbs(state.awake.shapes, state.library.tables, state.bodies, state.shapes)


def shift_bodies(bodies: np.ndarray, rows: np.ndarray, moves: np.ndarray) -> None:
    """Move the bodies of these rows by (n, 2) [px], without rotation and without an update of their shapes."""
    for column, axis in enumerate("xy"):
        bodies[axis][rows] += moves[:, column]
        bodies[f"center_{axis}"][rows] += moves[:, column]
