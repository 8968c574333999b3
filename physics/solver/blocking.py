"""Blocking: a body that would overlap another keeps its old pose, as in the movement loop of simple arcade games.

Unlike in `projection`, only kinematic bodies push other bodies. A dynamic body that would overlap keeps its old pose
and loses its velocity towards the obstacle. At its old pose it may block other bodies, so the test is repeated until no
further body has to be moved back. Two or three repetitions are usual, and the limit is one per body.
"""

import math

import numpy as np

from physics.ccd.sweep import list_paths, push_stopped
from physics.collision.manifold import closing_speed
from physics.collision.narrow_phase import detect
from physics.contacts.cache import update_contacts, write_caches
from physics.dynamics.integrate import place_shapes
from physics.islands.sleep import in_order
from physics.jit import kernel, subkernel
from physics.math2d import rotate
from physics.shapes.placement import PLACED
from physics.solver.projection import PushSet
from physics.tables.body import DYNAMIC, KINEMATIC
from physics.tables.step_state import SOLVER_ROWS, StepState, stage
from physics.tables.table import joined

# Effects that this solver ignores: contacts do not rotate, rub, bounce or carry bodies, and are not cached. A body
# still rotates by its own angular velocity.
IGNORED = ("rotation", "friction", "restitution", "stacking", "sleeping", "conveyor", "joints")


@kernel
def stay_behind(bodies_inout, manifolds_inout, work_inout):
    """Move overlapping dynamic bodies back to the poses that they had before the step. O(manifolds).

    Return how many bodies were moved back. Manifolds that stopped a body are marked as `swept`. A body that did not
    move in this step is not changed, and a manifold with a separation of 0 stops no body. bodies_inout: BODY table;
    manifolds_inout: CONTACT rows; work_inout: work counters.
    """
    put_back = 0
    for i in range(len(manifolds_inout)):
        m = manifolds_inout[i]
        if m.sensor:
            continue
        overlaps = 0
        if m.separation_1 < 0.0:
            overlaps += 1
        if m.count == 2 and m.separation_2 < 0.0:
            overlaps += 1
        work_inout[SOLVER_ROWS] += overlaps
        if overlaps == 0:
            continue
        for side in range(2):
            b = bodies_inout[m.body_row_a if side == 0 else m.body_row_b]
            if b.kind == DYNAMIC and (b.x != b.previous_x or b.y != b.previous_y or b.angle != b.previous_angle):
                b.x, b.y = b.previous_x, b.previous_y
                b.angle = b.previous_angle
                u, v = rotate(b.local_center_x, b.local_center_y, math.cos(b.angle), math.sin(b.angle))
                b.center_x, b.center_y = b.x + u, b.y + v
                m.swept = True
                put_back += 1
    return put_back


@subkernel
def stop_at_point(x, y, nx, ny, a_inout, b_inout):
    """Remove the approach speed of two bodies at a point (x, y) [px] along the normal (nx, ny). Return the impulse.

    The impulse changes no angular velocity. a_inout, b_inout: BODY rows.
    """
    inverse_masses = a_inout.inverse_mass + b_inout.inverse_mass
    if inverse_masses == 0.0:
        return 0.0
    impulse = max(closing_speed(a_inout, b_inout, x, y, nx, ny, 0.0), 0.0) / inverse_masses
    a_inout.vx -= a_inout.inverse_mass * impulse * nx
    a_inout.vy -= a_inout.inverse_mass * impulse * ny
    b_inout.vx += b_inout.inverse_mass * impulse * nx
    b_inout.vy += b_inout.inverse_mass * impulse * ny
    return impulse


@kernel
def stop_approach(bodies_inout, manifolds_inout):
    """Remove the approach speed at all points of CONTACT rows marked as `swept`, except sensors. O(manifolds).

    bodies_inout: BODY table.
    """
    for i in range(len(manifolds_inout)):
        m = manifolds_inout[i]
        if not m.swept or m.sensor:
            continue
        a, b = bodies_inout[m.body_row_a], bodies_inout[m.body_row_b]
        m.normal_impulse_1 = stop_at_point(m.x_1, m.y_1, m.normal_x, m.normal_y, a, b)
        if m.count == 2:
            m.normal_impulse_2 = stop_at_point(m.x_2, m.y_2, m.normal_x, m.normal_y, a, b)


def _make_way(state, stayed):
    """Let kinematic bodies push away dynamic bodies that overlap them.

    A dynamic body that was moved back to its old pose is also pushed if a kinematic body would overlap it there.
    stayed: CONTACT rows whose dynamic body was moved back.
    """
    bodies, contacts, sweeper = state.bodies, state.contact_rows, state.workspace.sweep
    overlaps = (contacts["separation_1"] < 0.0) | ((contacts["count"] == 2) & (contacts["separation_2"] < 0.0))
    met = joined([contacts[overlaps & ~contacts["sensor"]], stayed])
    rows = np.union1d(met["body_row_a"], met["body_row_b"])
    rows = rows[bodies["kind"][rows] == DYNAMIC]
    moving = state.awake.bodies
    if not len(rows) or not (bodies["kind"][moving] == KINEMATIC).any():
        return
    sweeper.grow(state)
    list_paths(moving, bodies, sweeper.paths)
    bodies["fraction"][rows] = 0.0
    if push_stopped(state, rows):
        place_shapes(state)
        state.contact_rows = detect(state)
    bodies["fraction"][rows] = 1.0


def solve(state: StepState, contacts: PushSet) -> float:
    """Move overlapping bodies back to their old poses, until no body that moved in this step overlaps another body.

    contacts: unused, because this solver works on state.contact_rows. Return the step length [s].
    """
    bodies, stopped = state.bodies, []
    while True:
        found = state.contact_rows
        write_caches(state.library.tables, bodies, state.shapes, found)
        if not stay_behind(bodies, found, state.work):
            break
        stopped.append(found[found["swept"] & ~found["sensor"]])
        place_shapes(state)
        state.contact_rows = detect(state)
    _make_way(state, joined([state.contact_rows[:0], *stopped]))
    stop_approach(bodies, state.contact_rows)
    if stopped:
        met = joined(stopped)
        stop_approach(bodies, met)
        update_contacts(bodies, met)
        others = state.contact_rows[~np.isin(state.contact_rows["candidate"], met["candidate"])]
        state.contact_rows = in_order(joined([others, met]))
    return state.dt


@stage(
    "blocking",
    reads=(
        "effects", "stacks", "tolerances", "dt", "awake", "bodies", "shapes", "library", "pairs", "contact_rows",
        "workspace",
    ),
    writes=(
        "contact_rows", "library", "work", "workspace", *PLACED,
        *(f"bodies.{name}" for name in ("x", "y", "angle", "center_x", "center_y", "vx", "vy", "fraction")),
    ),
)  # fmt: skip
def blocking(state: StepState) -> None:
    """Move bodies that overlap other bodies after the motion back to the poses that they had before it."""
    solve(state, state.workspace.contacts)
