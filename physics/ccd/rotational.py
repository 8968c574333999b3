"""The sweep of a hull that moves and turns about its centre of mass: against hulls, tiles, chains.

What touches at the start is in the hands of the solver, and a body that rests or slides must not be held by it. But it
must not pass through either: then a core circle, a quarter of the body's smallest half extent about its centre of mass,
is swept in its place (the rule of Box2D v3), and the hull itself counts again once it is a slop deeper. The same holds
where a tile or link is met from a side that its neighbour covers: no such side exists, but the core must not pass.
"""

import math
from typing import NamedTuple

import numpy as np

from physics.ccd.advance import (
    ANGLE,
    CENTER_X,
    CENTER_Y,
    MOVE_X,
    MOVE_Y,
    TOUCHING_BAND,
    TURN,
    AdvanceWorkspace,
    advance,
    approach_at,
    new_advance_workspace,
    reach_of,
    separate_at,
)
from physics.ccd.closed_form import MISS
from physics.jit import subkernel
from physics.math2d import turned
from physics.shapes.placement import hull_at
from physics.tables.shape import BOUNDS

CORE = 0.25  # of a body's smallest half extent
GRAZE = 2.0**-20  # of the size: motion into ground by less is a slide along it
ON_FACE = 1.0 - 1e-12  # cosine: a normal that is a face's own


class RotationalWorkspace(NamedTuple):
    """Room for one shape on its way."""

    advance: AdvanceWorkspace
    mover: np.ndarray  # (16, 2) its corners from its centre of mass [px], at angle 0


def new_rotational_workspace() -> RotationalWorkspace:
    return RotationalWorkspace(new_advance_workspace(), np.zeros((16, 2)))


@subkernel
def write_motion(motions, body_row, motion_out):
    """Start and change of one body's motion. motions (bodies, 6): centre of mass [px] and angle, at start and end."""
    motion_out[CENTER_X] = motions[body_row, 0]
    motion_out[CENTER_Y] = motions[body_row, 1]
    motion_out[ANGLE] = motions[body_row, 2]
    motion_out[MOVE_X] = motions[body_row, 3] - motions[body_row, 0]
    motion_out[MOVE_Y] = motions[body_row, 4] - motions[body_row, 1]
    motion_out[TURN] = motions[body_row, 5] - motions[body_row, 2]


@subkernel
def write_local(geometry, bodies, shapes, row, motion_inout, corners_out):
    """Corners of a hull from its body's centre of mass [px] at angle 0. Returns their number.

    A BOUNDS does not turn: it keeps the box it has at the start.
    """
    b = bodies[shapes[row].body_row]
    if shapes[row].kind != BOUNDS:
        return hull_at(geometry, shapes, row, -b.local_center_x, -b.local_center_y, 0.0, corners_out)
    angle = motion_inout[ANGLE]
    u, v = turned(b.local_center_x, b.local_center_y, math.cos(angle), math.sin(angle))
    motion_inout[ANGLE] = 0.0
    motion_inout[TURN] = 0.0
    return hull_at(geometry, shapes, row, -u, -v, angle, corners_out)


@subkernel
def sweep_at(count, radius, other_count, other_radius, core_radius, slack, workspace):
    """(fraction or MISS, whether the core circle met it) of the mover against what stands in workspace.advance.local_b.

    slack [px]: apart by no more at the start is in contact. core_radius [px]: 0 sweeps the hull in any case.
    """
    for k in range(count):
        workspace.advance.local_a[k, 0] = workspace.mover[k, 0]
        workspace.advance.local_a[k, 1] = workspace.mover[k, 1]
    start = separate_at(count, radius, other_count, other_radius, 0.0, workspace.advance)
    if core_radius == 0.0 or start > slack:
        return advance(count, radius, other_count, other_radius, workspace.advance), False
    # In contact: what rests or slides stays as deep as it is, what breaks through gets a slop deeper, or its core in.
    core = sweep_core(core_radius, other_count, other_radius, workspace)
    for k in range(count):
        workspace.advance.local_a[k, 0] = workspace.mover[k, 0]
        workspace.advance.local_a[k, 1] = workspace.mover[k, 1]
    deeper = advance(count, radius - slack - max(-start, 0.0), other_count, other_radius, workspace.advance)
    if core < deeper:
        return sweep_core(core_radius, other_count, other_radius, workspace), True
    return deeper, False


@subkernel
def sweep_core(core_radius, other_count, other_radius, workspace):
    """Fraction, or MISS, of the core circle against workspace.advance.local_b; MISS when its centre is in it.

    Where the circle touches already it shrinks to half the distance that is left: the centre never gets across.
    """
    workspace.advance.local_a[0, 0] = 0.0
    workspace.advance.local_a[0, 1] = 0.0
    left = separate_at(1, 0.0, other_count, other_radius, 0.0, workspace.advance)
    if left <= 0.0:
        return MISS
    return advance(1, min(core_radius, 0.5 * left), other_count, other_radius, workspace.advance)


@subkernel
def only_grazes(count, radius, other_count, fraction, slack, workspace):
    """Whether the mover slides along a piece of ground that it meets: goes into it by no more than slack [px]."""
    reach = reach_of(workspace.advance.local_a, count)
    size = reach + radius
    approach = approach_at(count, other_count, fraction, TOUCHING_BAND * size, workspace.advance)
    approach += abs(workspace.advance.motion_a[TURN]) * reach
    return approach * (1.0 - fraction) <= max(slack, GRAZE * size)


@subkernel
def swept_box(reach, motion_a, motion_b):
    """Box (min_x, min_y, max_x, max_y) [px] that holds a body on its way, seen from the other's own moving point."""
    x = motion_a[CENTER_X] - motion_b[CENTER_X]
    y = motion_a[CENTER_Y] - motion_b[CENTER_Y]
    dx = motion_a[MOVE_X] - motion_b[MOVE_X]
    dy = motion_a[MOVE_Y] - motion_b[MOVE_Y]
    return (x + min(0.0, dx) - reach, y + min(0.0, dy) - reach, x + max(0.0, dx) + reach, y + max(0.0, dy) + reach)
