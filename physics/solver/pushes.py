"""Contacts as the solvers see them that remember nothing: one PUSH row per point that is no sensor's."""

from collections.abc import Callable
from typing import Any

import numpy as np

from physics.collision.anchors import write_anchors
from physics.collision.follow import follow_bodies
from physics.collision.materials import mixed
from physics.jit import kernel
from physics.math2d import length_of
from physics.tables.constraint import PUSH
from physics.tables.manifold import ANCHOR
from physics.tables.step_state import StepState


@kernel
def prepare_pushes(
    # read
    geometry,
    bodies,
    shapes,
    manifolds,
    conveyor,
    # write
    pushes_out,
):
    """Write a row for every point of the manifolds that is no sensor's; conveyor: 1 where surfaces run. Returns their
    number. O(manifolds)."""
    found = 0
    for i in range(len(manifolds)):
        m = manifolds[i]
        if m.sensor:
            continue
        a = bodies[m.body_row_a]
        b = bodies[m.body_row_b]
        friction, restitution, rolling, surface_speed = mixed(geometry, shapes[m.row_a], shapes[m.row_b], m)
        for k in range(m.count):
            r = pushes_out[found]
            r.manifold = i
            r.second = k == 1
            r.swept = m.swept
            r.body_row_a = m.body_row_a
            r.body_row_b = m.body_row_b
            r.x = m.x_1 if k == 0 else m.x_2
            r.y = m.y_1 if k == 0 else m.y_2
            r.normal_x = m.normal_x
            r.normal_y = m.normal_y
            r.separation = m.separation_1 if k == 0 else m.separation_2
            r.anchor_x = b.center_x - a.center_x
            r.anchor_y = b.center_y - a.center_y
            r.speed = m.speed_1 if k == 0 else m.speed_2
            r.friction = friction
            r.restitution = restitution
            r.surface_speed = surface_speed if conveyor == 1 else 0.0
            r.rolling_limit = rolling
            r.normal_impulse = 0.0
            r.tangent_impulse = 0.0
            r.rolling_impulse = 0.0
            found += 1
    return found


@kernel
def limit_pushes(
    # read
    pushes,
    bodies,
    push_speed,
    dt,
    # write
    reach_out,
):
    """Write how far [px] each body that is pushed may be moved in this step: at push_speed [px/s], and as much further
    as it moves itself, or what it meets comes nearer, within dt [s]: that is no old overlap. O(pushes).
    """
    for i in range(len(pushes)):
        r = pushes[i]
        for side in range(2):
            row = r.body_row_a if side == 0 else r.body_row_b
            reach_out[row] = (push_speed + length_of(bodies[row].vx, bodies[row].vy)) * dt
    for i in range(len(pushes)):
        r = pushes[i]
        for side in range(2):
            row = r.body_row_a if side == 0 else r.body_row_b
            reach_out[row] = max(reach_out[row], (push_speed + max(r.speed, 0.0)) * dt)


@kernel
def store_pushes(pushes, manifolds_inout):
    """Write the impulses back to the manifolds; who was pushed apart has met, wherever it is now. O(pushes)."""
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
    """The contacts of one world as PUSH rows; grown and used again. It has no warm start: nothing is remembered."""

    def __init__(self) -> None:
        self.data, self.anchors = np.zeros(16, PUSH), np.zeros(16, ANCHOR)
        self.rows = self.data[:0]
        self.reach = np.zeros(16)  # (body rows) see limit_pushes

    def prepare(self, state: StepState) -> None:
        """Fill the rows, and anchor the manifolds where they were detected."""
        points = 2 * len(state.manifolds)
        if len(self.data) < points:
            self.data, self.anchors = np.zeros(2 * points, PUSH), np.zeros(points, ANCHOR)
        tables, conveyor = state.library.tables, int(state.effects.conveyor)
        found = prepare_pushes(tables, state.bodies, state.shapes, state.manifolds, conveyor, self.data)
        self.rows = self.data[:found]
        if len(self.reach) < len(state.bodies):
            self.reach = np.zeros(2 * len(state.bodies))
        limit_pushes(self.rows, state.bodies, state.tolerances.push_speed, state.dt, self.reach)
        write_anchors(tables, state.bodies, state.shapes, state.manifolds, self.anchors)

    def solve(self, state: StepState, run: Callable, *settings: Any) -> None:
        """One pass of a solver over the rows."""
        run(*settings, state.bodies, self.rows, state.work)

    def store(self, state: StepState) -> None:
        """Write what was found back to the manifolds, and carry these to the final poses."""
        store_pushes(self.rows, state.manifolds)
        follow_bodies(state.bodies, self.anchors, state.manifolds)
