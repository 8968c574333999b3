"""Integration of velocities from forces and of poses from velocities; quarantine of bodies with invalid numbers."""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from physics.islands.sleep import disturb
from physics.jit import kernel, subkernel
from physics.math2d import rotate, rotation_of
from physics.settings import POSITION_LIMIT
from physics.shapes.placement import PLACED, add_missing_rasters, refresh_aabbs
from physics.tables.body import DYNAMIC, STATIC
from physics.tables.contact import QUARANTINE
from physics.tables.shape import TILES
from physics.tables.step_state import BODIES_INTEGRATED, StepState, stage
from physics.tables.table import Table

BOTH = (False, True)

# ---- integration -----------------------------------------------------------------------------------------------------
# Semi-implicit Euler integration.
#
# Implicit drag v / (1 + c h) is stable for any c. Source: Catto, Numerical Methods, GDC 2015.


def make_velocity_pass(gravity: bool, drag: bool, wind: bool, rotation: bool) -> Callable:
    """Return the kernel that integrates the velocities of dynamic bodies.

    gravity, drag, wind, rotation: whether the world has these effects. Wind adds the acceleration drag_rate · wind.
    With both wind and drag, bodies approach the velocity of the wind.
    """

    @kernel
    def integrate_velocities(rows, gravity_x, gravity_y, drag_rate, wind_x, wind_y, dt, bodies_inout):
        """Integrate velocities over dt [s], and clear the accumulated forces. O(rows).

        rows: row numbers in BODY; gravity_x, gravity_y [px/s2]; drag_rate [1/s]; wind_x, wind_y [px/s].
        """
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
                b.vx, b.vy = keep * b.vx, keep * b.vy
                if rotation:
                    b.angular_velocity = keep * b.angular_velocity
            b.forced = b.force_x != 0.0 or b.force_y != 0.0
            b.force_x, b.force_y, b.torque = 0.0, 0.0, 0.0

    return integrate_velocities


def make_position_pass(rotation: bool) -> Callable:
    """Return the kernel that integrates the poses of bodies. rotation: whether bodies rotate about their centres."""

    @kernel
    def integrate_positions(rows, dt, bodies_inout, work_inout):
        """Move bodies by their velocities over dt [s], up to their first impact, and store the old poses. O(rows).

        rows: row numbers in BODY. The fraction of the motion before the impact is BODY.fraction. work_inout: counters,
        see COUNTERS.
        """
        for k in range(len(rows)):
            b = bodies_inout[rows[k]]
            b.previous_x, b.previous_y = b.x, b.y
            b.previous_angle = b.angle
            if b.kind == STATIC or b.quarantined:
                continue
            work_inout[BODIES_INTEGRATED] += 1
            h = dt * b.fraction
            if rotation and b.angular_velocity != 0.0:
                u, v = rotate(b.local_center_x, b.local_center_y, *rotation_of(b.angle))
                center_x, center_y = b.x + u + h * b.vx, b.y + v + h * b.vy
                b.angle += h * b.angular_velocity
                u, v = rotate(b.local_center_x, b.local_center_y, *rotation_of(b.angle))
                b.x, b.y = center_x - u, center_y - v
            else:
                b.x += h * b.vx
                b.y += h * b.vy

    return integrate_positions


@subkernel
def is_within_limits(body):
    """Return whether position and angle of a body are within POSITION_LIMIT, where a double still resolves them."""
    return abs(body.x) < POSITION_LIMIT and abs(body.y) < POSITION_LIMIT and abs(body.angle) < POSITION_LIMIT


@subkernel
def put_center(u, v, body_inout):
    """Write the world centre of mass of a BODY row: its origin plus the offset (u, v) [px].

    If the pose is within POSITION_LIMIT, it is also stored as the last one that was (settled_x, settled_y,
    settled_angle). has_current_contacts is cleared.
    """
    b = body_inout
    b.center_x, b.center_y = b.x + u, b.y + v
    b.has_current_contacts = False
    if is_within_limits(b):
        b.settled_x, b.settled_y = b.x, b.y
        b.settled_angle = b.angle


@subkernel
def refresh_center(body_inout):
    """Write the world centre of mass [px] of a BODY row at its present pose; NaN if the angle is not finite.

    Other fields: see put_center.
    """
    b = body_inout
    u, v = b.local_center_x, b.local_center_y
    if not abs(b.angle) < math.inf:  # its cosine would be NaN in compiled code, and an error in plain code
        u, v = math.nan, math.nan
    elif b.angle != 0.0:
        u, v = rotate(u, v, *rotation_of(b.angle))
    put_center(u, v, b)


@kernel
def refresh_centers(rows, bodies_inout):
    """Write the world centres of mass [px] of the bodies in `rows` (row numbers) at their present poses. O(rows).

    bodies_inout: BODY table.
    """
    for k in range(len(rows)):
        refresh_center(bodies_inout[rows[k]])


def write_center(bodies: Table, at: int) -> None:
    """Write the world centre of mass [px] of one body at its present pose, faster than refresh_centers.

    at: row number in BODY. Memory views read and write single numbers faster, so the kernel is called only if the angle
    of the body is not 0.
    """
    columns = bodies.columns
    x, y, angle = columns["x"][at], columns["y"][at], columns["angle"][at]
    if angle != 0.0:
        refresh_centers(np.array([at]), bodies.rows)
        return
    columns["center_x"][at], columns["center_y"][at] = (
        x + columns["local_center_x"][at],
        y + columns["local_center_y"][at],
    )
    columns["has_current_contacts"][at] = False
    if abs(x) < POSITION_LIMIT and abs(y) < POSITION_LIMIT:
        columns["settled_x"][at], columns["settled_y"][at], columns["settled_angle"][at] = x, y, angle


# One pass for each combination of the effects on which it depends. Passes are compiled on first use.
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
    """Integrate the velocities of awake bodies from forces, gravity, drag and wind."""
    e = state.effects
    integrate = VELOCITIES[e.gravity, e.drag, e.wind, e.rotation]
    integrate(state.awake.bodies, *state.gravity, state.drag, *state.wind, state.dt, state.bodies)


@stage(
    "integrate_positions",
    reads=("effects", "awake", "bodies", "shapes", "library", "dt"),
    writes=(
        "work", "library", *PLACED, *(f"bodies.{name}" for name in ("center_x", "center_y", "has_current_contacts")),
        *(f"bodies.{state}{name}" for state in ("", "previous_", "settled_") for name in ("x", "y", "angle")),
    ),
)  # fmt: skip
def integrate_positions(state: StepState) -> None:
    """Integrate the poses of awake bodies up to their first impacts, and update AABBs and rasters of masks."""
    rows, bodies = state.awake.bodies, state.bodies
    POSITIONS[state.effects.rotation](rows, state.dt, bodies, state.work)
    refresh_centers(rows, bodies)
    place_shapes(state)


def place_shapes(state: StepState) -> None:
    """Update the AABBs and mask rasters of awake bodies to their present poses."""
    # A body that a sweep stopped, or that a solver rotated, may be at an angle without a raster.
    add_missing_rasters(state.library, state.awake.shapes, state.bodies, state.shapes, 0.0)
    refresh_aabbs(state.awake.shapes, state.library.tables, state.bodies, state.shapes)


def shift_bodies(bodies: np.ndarray, rows: np.ndarray, moves: np.ndarray) -> None:
    """Translate the bodies of rows (n,) by moves (n, 2) [px]. The AABBs of their shapes are not updated."""
    for column, axis in enumerate("xy"):
        bodies[axis][rows] += moves[:, column]
        bodies[f"center_{axis}"][rows] += moves[:, column]


# ---- quarantine ------------------------------------------------------------------------------------------------------
# The quarantine stage: bodies with numbers that a step cannot use are disabled before they affect other bodies, and are
# reported by id.
#
# A number that is not finite spreads through contacts to neighbours, and so to a whole heap. So every number of a body,
# shape or character that a step reads is checked before the first stage that reads it.

NOT_FINITE, BAD_SHAPE, TURNED, BAD_WALK = range(4)
REASONS = (
    "a number of the body is not finite, beyond what a double resolves, or wrongly below 0",
    "a number of one of its shapes is not finite, too large, or below 0 where it may not be",
    "a TileGrid cannot turn: its angle and angular velocity must be 0",
    "a number of its character is not finite",
)
NO_ROWS = np.zeros(0, np.int64)
LARGEST = 1e100  # bound of inverse masses and surface values: products of larger values may overflow a double
REST = ("previous_x", "previous_y", "previous_angle", "vx", "vy", "angular_velocity", "force_x", "force_y", "torque")
READS = (
    "bodies", "shapes", "awake", "sleeping_set", "pairs", "contact_rows", "touching_pairs", "sensing_pairs",
    "tolerances", "library", "effects", "gravity", "characters", "dt",
)  # fmt: skip
WRITES = (
    "events", "pairs", "awake", "sleeping_set", "contact_rows", "touching_pairs", "sensing_pairs", "shapes.proxy",
    "bodies.sleep_time", "bodies.island",
    *(f"bodies.{name}" for name in ("x", "y", "angle", "center_x", "center_y", "awake", "active", "quarantined")),
    *(f"bodies.settled_{name}" for name in ("x", "y", "angle")), "bodies.has_current_contacts",
    *(f"bodies.{name}" for name in REST),
)  # fmt: skip


@subkernel
def disable_body(body_inout):
    """Quarantine a body at its present pose, and clear its velocity and forces. body_inout: BODY row."""
    b = body_inout
    b.previous_x, b.previous_y = b.x, b.y
    b.previous_angle = b.angle
    b.vx, b.vy, b.angular_velocity = 0.0, 0.0, 0.0
    b.force_x, b.force_y, b.torque = 0.0, 0.0, 0.0
    b.awake = False
    b.quarantined = True


@subkernel
def is_finite_in_step(body, gravity_x, gravity_y, speed_limit, dt):
    """Return whether all numbers of a body that a step reads are finite and in range, now and after the body's motion.

    gravity_x, gravity_y [px/s2]; speed_limit [px/s]; dt [s]: length of the step.
    """
    b = body
    vx = b.vx + dt * (b.inverse_mass * b.force_x + b.gravity_scale * gravity_x)
    vy = b.vy + dt * (b.inverse_mass * b.force_y + b.gravity_scale * gravity_y)
    spin = b.angular_velocity + dt * b.inverse_inertia * b.torque
    # x - x == 0 only for finite x.
    sizes = b.mass + b.inertia + b.min_half_extent + b.inradius + b.fraction
    return (
        abs(b.vx) < speed_limit
        and abs(b.vy) < speed_limit
        and abs(vx) < speed_limit
        and abs(vy) < speed_limit
        and abs(spin) * b.extent < speed_limit
        and abs(b.x + dt * vx) < POSITION_LIMIT
        and abs(b.y + dt * vy) < POSITION_LIMIT
        and abs(b.angle + dt * spin) < POSITION_LIMIT
        and abs(b.local_center_x) < POSITION_LIMIT
        and abs(b.local_center_y) < POSITION_LIMIT
        and abs(b.center_x) < 2.0 * POSITION_LIMIT
        and abs(b.center_y) < 2.0 * POSITION_LIMIT
        and 0.0 <= b.inverse_mass < LARGEST
        and 0.0 <= b.inverse_inertia < LARGEST
        and 0.0 <= b.extent < POSITION_LIMIT
        and sizes - sizes == 0.0
    )


@subkernel
def is_finite_character(character):
    """Return whether the numbers of a CHARACTER row are finite, and their sum is below POSITION_LIMIT in size."""
    c = character
    total = c.offset_x + c.offset_y + c.climb + c.remainder_x + c.remainder_y + c.slope + c.mass + c.push
    total += c.foot_x + c.foot_y + c.carry_x + c.carry_y + c.belt + c.belt_x + c.push_vx + c.push_vy + c.deep
    return total - total == 0.0 and abs(total) < POSITION_LIMIT


class Course(NamedTuple):
    """Parameters for predicting the motion of bodies in a step without contacts."""

    gravity_x: float  # [px/s2]
    gravity_y: float
    speed_limit: float  # [px/s]
    dt: float  # [s]


@subkernel
def take_body(row, reason, found, bodies_inout, broken_out):
    """Quarantine a body, and write its row number and the reason to row `found` of broken_out. Return found + 1.

    reason: index of REASONS. bodies_inout: BODY table.
    """
    disable_body(bodies_inout[row])
    broken_out[found, 0] = row
    broken_out[found, 1] = reason
    return found + 1


@subkernel
def take_broken_bodies(rows, course, bodies_inout, broken_out):
    """Quarantine bodies with numbers that are out of range or not finite, and list them. Return their number.

    A body whose pose is out of range is moved back to its last pose within range. rows: row numbers in BODY; broken_out
    (bodies, 2): row number and reason (index of REASONS); course: see Course.
    """
    found = 0
    for k in range(len(rows)):
        b = bodies_inout[rows[k]]
        if b.quarantined:
            continue
        there = is_within_limits(b)
        if not there or not is_finite_in_step(b, course.gravity_x, course.gravity_y, course.speed_limit, course.dt):
            if not there:
                b.x, b.y = b.settled_x, b.settled_y
                b.angle = b.settled_angle
            found = take_body(rows[k], NOT_FINITE, found, bodies_inout, broken_out)
    return found


@subkernel
def is_finite_shape(shape):
    """Return whether the numbers of a SHAPE row are finite and in range."""
    s = shape
    place = abs(s.local_x) + abs(s.local_y) + s.radius
    surface = s.friction + abs(s.restitution) + abs(s.rolling_resistance) + abs(s.surface_speed)
    return place < POSITION_LIMIT and surface < LARGEST and s.radius >= 0.0 and s.friction >= 0.0


@kernel
def take_broken(rows, shape_rows, grid_rows, shapes, characters, course, bodies_inout, broken_out):
    """Quarantine bodies for invalid numbers of the body, its shapes or its character. Return the number of bodies.

    Also quarantine rotated or rotating bodies with a TileGrid; only a direct write to the table can rotate them. rows:
    row numbers in BODY; shape_rows: row numbers in SHAPE; grid_rows: row numbers in SHAPE to test for TileGrids.
    broken_out (bodies, 2): row number of the body and reason (index of REASONS), each body once. O(rows + shape_rows +
    grid_rows + characters). course: see Course.
    """
    found = take_broken_bodies(rows, course, bodies_inout, broken_out)
    for k in range(len(shape_rows)):
        s = shapes[shape_rows[k]]
        if not (is_finite_shape(s) or bodies_inout[s.body_row].quarantined):
            found = take_body(s.body_row, BAD_SHAPE, found, bodies_inout, broken_out)
    for k in range(len(grid_rows)):
        s = shapes[grid_rows[k]]
        b = bodies_inout[s.body_row]
        if s.kind == TILES and not (b.quarantined or (b.angle == 0.0 and b.angular_velocity == 0.0)):
            b.angle = 0.0
            found = take_body(s.body_row, TURNED, found, bodies_inout, broken_out)
    for k in range(len(characters)):
        row = characters[k].body_row
        if not (bodies_inout[row].quarantined or is_finite_character(characters[k])):
            found = take_body(row, BAD_WALK, found, bodies_inout, broken_out)
    return found


@kernel
def take_broken_by_solver(rows, course, bodies_inout, broken_out):
    """Quarantine bodies that have invalid numbers after a solver, and list them in broken_out. Return their number.

    Arguments: see take_broken.
    """
    return take_broken_bodies(rows, course, bodies_inout, broken_out)


@stage("quarantine", reads=(*READS, "joints", "workspace"), writes=(*WRITES, "workspace"))
def quarantine(state: StepState) -> None:
    """Disable and report bodies with numbers that are out of range or not finite, before they affect other bodies."""
    awake, bodies, workspace = state.awake, state.bodies, state.workspace
    gravity = state.gravity if state.effects.gravity else (0.0, 0.0)
    course = Course(*gravity, state.tolerances.speed_limit, state.dt)
    if len(workspace.broken) < len(bodies):
        workspace.broken = np.zeros((2 * len(bodies), 2), np.int64)
    grids = awake.shapes if state.library.grids.count else NO_ROWS
    found = take_broken(
        awake.bodies, awake.shapes, grids, state.shapes, state.characters, course, bodies, workspace.broken
    )
    if found:
        _take_out(state, workspace.broken[:found])


@stage("quarantine_solved", reads=(*READS, "joints", "non_finite_count", "workspace"), writes=(*WRITES, "workspace"))
def quarantine_solved(state: StepState) -> None:
    """Disable bodies that have invalid numbers after the solver, and drop their contacts, before sweeps and reports."""
    if not state.non_finite_count:
        return
    broken, course = np.zeros((len(state.bodies), 2), np.int64), Course(0.0, 0.0, state.tolerances.speed_limit, 0.0)
    ids = _take_out(state, broken[: take_broken_by_solver(state.awake.bodies, course, state.bodies, broken)])
    kept = ~(np.isin(state.contact_rows["body_a"], ids) | np.isin(state.contact_rows["body_b"], ids))
    state.contact_rows = state.contact_rows[kept]


def _take_out(state, broken):
    """Remove quarantined bodies from the broad phase and the awake rows, and report them. Return their ids.

    broken (n, 2): row number in BODY and reason (index of REASONS).
    """
    bodies, shapes = state.bodies, state.shapes
    rows, reasons = broken[np.argsort(broken[:, 0])].T
    ids = bodies["id"][rows]
    reported = np.array([(ids[k], REASONS[reason]) for k, reason in enumerate(reasons)], QUARANTINE)
    state.events.quarantined = np.sort(np.concatenate([state.events.quarantined, reported]))
    own = np.isin(shapes["body"], ids)
    state.pairs.free_proxies(shapes["proxy"][own])
    shapes["proxy"][own] = -1
    refresh_centers(np.ascontiguousarray(rows), bodies)
    disturb(state, ids)
    state.awake.start_over()
    return ids
