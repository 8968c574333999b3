"""The sweep of a hull that moves and turns about its centre of mass: one rule for whatever it may meet.

Nothing is gone into deeper than the mover stands in it already, and a slop more: then it is put back to where it was no
deeper than at the start. So what rests or slides is never held, no seam between two pieces of ground is felt (a piece
that lies flush is no deeper under the mover than the whole), and what breaks through is stopped, wherever it was at
the start. What stands so deep that its core, a quarter of its smallest half extent about its centre of mass, would
go in too, has this core swept instead: a centre never gets across (Box2D v3's core circle). One-sided ground is met
only while the mover is in front of it.
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
    TOLERANCE,
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
from physics.math2d import length_of, turned
from physics.proximity.gjk import FIRST_A, FIRST_B, NX, NY
from physics.shapes.placement import hull_at
from physics.tables.shape import BOUNDS

BEFORE = 2.0**-20  # of the way
BACKWARDS = 6  # rounds of Newton's method: two or three do
CORE_LEFT = 0.9  # of the distance of a centre that is nearer than its core
CORE = 0.25  # of a body's smallest half extent


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
def place_mover(count, workspace):
    """Have the mover swept, with nothing of what the last pair left behind. Returns its reach [px]."""
    for k in range(count):
        workspace.advance.local_a[k, 0] = workspace.mover[k, 0]
        workspace.advance.local_a[k, 1] = workspace.mover[k, 1]
    workspace.advance.gap.gap[FIRST_A] = 0.0
    workspace.advance.gap.gap[FIRST_B] = 0.0
    return reach_of(workspace.mover, count)


@subkernel
def depth_at_start(count, radius, other_count, other_radius, workspace):
    """How deep [px] the mover stands in workspace.advance.local_b before it moves; 0: not at all."""
    place_mover(count, workspace)
    return max(0.0, -separate_at(count, radius, other_count, other_radius, 0.0, workspace.advance))


@subkernel
def sweep_core(core_radius, other_count, other_radius, workspace):
    """Fraction, or MISS, of the core circle against workspace.advance.local_b; MISS when its centre is in it.

    Where the circle touches already it shrinks to most of the distance that is left: the centre never gets across.
    Measured, moving rooms: with half of it three of 768 lost a body whose centre had come to the wall step by step.
    """
    workspace.advance.local_a[0, 0] = 0.0
    workspace.advance.local_a[0, 1] = 0.0
    workspace.advance.gap.gap[FIRST_A] = 0.0
    workspace.advance.gap.gap[FIRST_B] = 0.0
    left = separate_at(1, 0.0, other_count, other_radius, 0.0, workspace.advance)
    if left <= 0.0:
        return MISS
    return advance(1, min(core_radius, CORE_LEFT * left), other_count, other_radius, workspace.advance)


@subkernel
def back_to(count, radius, other_count, other_radius, depth, fraction, size, workspace):
    """The fraction, before one at which the mover is deeper than `depth` [px], at which it was that deep.

    Newton's method from there: an earlier touch with a side of the piece that the ground goes on behind is not met.
    """
    gap = workspace.advance.gap.gap
    nx = gap[NX]
    ny = gap[NY]
    most = fraction
    separation = separate_at(count, radius, other_count, other_radius, fraction, workspace.advance)
    for _ in range(BACKWARDS):
        approach = approach_at(count, other_count, fraction, TOUCHING_BAND * size, workspace.advance)
        if approach <= 0.0 or abs(separation + depth) <= TOLERANCE * size:
            break
        fraction = min(max(0.0, fraction + (separation + depth) / approach), most)
        separation = separate_at(count, radius, other_count, other_radius, fraction, workspace.advance)
    if nx * gap[NX] + ny * gap[NY] < 0.5:
        gap[NX] = nx  # another side is nearer there, which it did not come through
        gap[NY] = ny
    return fraction


@subkernel
def sweep_part(count, radius, other_count, other_radius, half, depth, slack, workspace):
    """(fraction or MISS, whether the core met it) of the mover against a convex piece, workspace.advance.local_b.

    half [px]: the mover's smallest half extent, 0: it has no core; depth [px]: how deep it may be in any case, as it
    stands in the whole that the piece belongs to; slack [px]: how much deeper it may get, 0: by no more than rounding.
    """
    reach = place_mover(count, workspace)
    if count == 1 and radius == 0.0:  # a ray's point has no depth: it meets what it touches
        fraction = advance(1, 0.0, other_count, other_radius, workspace.advance)
        if fraction <= 1.0:  # where it touches it has no normal: that of just before
            separate_at(1, 0.0, other_count, other_radius, max(0.0, fraction - BEFORE), workspace.advance)
        return fraction, False
    motion = workspace.advance.motion_a
    other = workspace.advance.motion_b
    size = reach + radius + reach_of(workspace.advance.local_b, other_count) + other_radius
    path = length_of(other[MOVE_X] - motion[MOVE_X], other[MOVE_Y] - motion[MOVE_Y])
    sink = max(slack, TOUCHING_BAND * (size + path))
    if half > 0.0:
        sink = min(sink, 0.5 * half)
        if sink + depth > (1.0 - CORE) * half:
            return sweep_core(CORE * half, other_count, other_radius, workspace), True
    fraction = advance(count, radius - sink - depth, other_count, other_radius, workspace.advance)
    if fraction > 1.0:
        return MISS, False
    return back_to(count, radius, other_count, other_radius, depth, fraction, size, workspace), False


@subkernel
def swept_box(reach, motion_a, motion_b):
    """Box (min_x, min_y, max_x, max_y) [px] that holds a body on its way, seen from the other's own moving point."""
    x = motion_a[CENTER_X] - motion_b[CENTER_X]
    y = motion_a[CENTER_Y] - motion_b[CENTER_Y]
    dx = motion_a[MOVE_X] - motion_b[MOVE_X]
    dy = motion_a[MOVE_Y] - motion_b[MOVE_Y]
    return (x + min(0.0, dx) - reach, y + min(0.0, dy) - reach, x + max(0.0, dx) + reach, y + max(0.0, dy) + reach)
