"""Contacts as the solvers see them that remember nothing: one PUSH row per point that is no sensor's."""

from collections.abc import Callable
from typing import Any

import numpy as np

from physics.collision.materials import mixed
from physics.jit import kernel
from physics.tables.constraint import PUSH
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
        friction, restitution, rolling, surface_speed = mixed(geometry, shapes, m)
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
            r.normal_impulse = 0.0
            r.tangent_impulse = 0.0
            found += 1
    return found


@kernel
def store_pushes(
    # read
    bodies,
    pushes,
    # write
    manifolds_inout,
):
    """Write impulses, and separations at the final poses, back to the manifolds; nothing is detected. O(pushes).

    The displacement of B against A along the normal changes the separation.
    """
    for i in range(len(pushes)):
        r = pushes[i]
        a = bodies[r.body_row_a]
        b = bodies[r.body_row_b]
        moved_x = (b.center_x - a.center_x) - r.anchor_x
        moved_y = (b.center_y - a.center_y) - r.anchor_y
        separation = r.separation + (r.normal_x * moved_x + r.normal_y * moved_y)
        m = manifolds_inout[r.manifold]
        if r.second:
            m.separation_2 = separation
            m.normal_impulse_2 = r.normal_impulse
            m.tangent_impulse_2 = r.tangent_impulse
        else:
            m.separation_1 = separation
            m.normal_impulse_1 = r.normal_impulse
            m.tangent_impulse_1 = r.tangent_impulse


class PushSet:
    """The contacts of one world as PUSH rows; grown and used again. It has no warm start: nothing is remembered."""

    name = "contacts"

    def __init__(self) -> None:
        self.data = np.zeros(16, PUSH)
        self.rows = self.data[:0]

    def prepare(self, state: StepState) -> None:
        """Fill the rows."""
        points = 2 * len(state.manifolds)
        if len(self.data) < points:
            self.data = np.zeros(2 * points, PUSH)
        tables, conveyor = state.library.tables, int(state.effects.conveyor)
        found = prepare_pushes(tables, state.bodies, state.shapes, state.manifolds, conveyor, self.data)
        self.rows = self.data[:found]

    def solve(self, state: StepState, run: Callable, *settings: Any) -> None:
        """One pass of a solver over the rows."""
        run(*settings, state.bodies, self.rows, state.work)

    def store(self, state: StepState) -> None:
        """Write what was found back to the manifolds."""
        store_pushes(state.bodies, self.rows, state.manifolds)
