"""First time of impact of two rounded hulls that move and turn, by conservative advancement of second order.

At a fraction t of the motion the nearest points give a normal n. Along this fixed n every corner moves by its velocity,
and its path bends by no more than (turn rate)² · arm, so each pair of corners is apart until the root of a quadratic.
The motion is free up to the smallest root; there a new normal is taken. Each stop is before the impact, and near it the
gap shrinks with the square of the step, as in Newton's method: a few rounds, and nothing is stepped over however fast
it turns. Source: Mirtich, Impulse-based Dynamic Simulation, 1996; Catto, Continuous Collision, GDC 2013.
"""

import math
from typing import NamedTuple

import numpy as np

from physics.ccd.closed_form import MISS
from physics.jit import subkernel
from physics.math2d import length_of, turned
from physics.proximity.gjk import AX, AY, CAPPED, FIRST_A, FIRST_B, NX, NY, ROUNDS, GapWorkspace, new_gap_workspace
from physics.proximity.separation import separate

ADVANCE_CAP = 256  # stops; transversal impacts take under ten, grazes some forty
LEAVING_CAP = 1024  # stops of a pair that touches and does not approach, each at least 1 / LEAVING_CAP long
TOLERANCE = 2.0**-43  # 1e-13 of the size of shapes and motion: met
TOUCHING_BAND = 2.0**-30  # 1e-9 of the size: corners this near to the touching one touch too
RESTING = 2.0**-42  # of the speed: a slide, whose approach is but rounding
CENTER_X, CENTER_Y, ANGLE, MOVE_X, MOVE_Y, TURN = range(6)


class AdvanceWorkspace(NamedTuple):
    """Room for one pair on its way."""

    local_a: np.ndarray  # (16, 2) corners from the point that each side turns about [px], at angle 0
    local_b: np.ndarray
    a: np.ndarray  # (16, 2) corners at the present fraction, from where A's point was at the start [px]
    b: np.ndarray
    motion_a: np.ndarray  # (6,) point it turns about and angle at the start; what they change by until the end
    motion_b: np.ndarray
    totals: np.ndarray  # (2,) rounds of GJK and EPA, caps hit
    gap: GapWorkspace


def new_advance_workspace() -> AdvanceWorkspace:
    return AdvanceWorkspace(
        np.zeros((16, 2)),
        np.zeros((16, 2)),
        np.zeros((16, 2)),
        np.zeros((16, 2)),
        np.zeros(6),
        np.zeros(6),
        np.zeros(2),
        new_gap_workspace(),
    )


@subkernel
def place_at(local, count, motion, fraction, x, y, corners_out):
    """Write a hull's corners at a fraction of its motion, seen from (x, y)."""
    angle = motion[ANGLE] + fraction * motion[TURN]
    cosine = math.cos(angle)
    sine = math.sin(angle)
    center_x = (motion[CENTER_X] - x) + fraction * motion[MOVE_X]
    center_y = (motion[CENTER_Y] - y) + fraction * motion[MOVE_Y]
    for k in range(count):
        u, v = turned(local[k, 0], local[k, 1], cosine, sine)
        corners_out[k, 0] = center_x + u
        corners_out[k, 1] = center_y + v


@subkernel
def separate_at(a_count, a_radius, b_count, b_radius, fraction, workspace):
    """Separation [px] at a fraction of the motion; workspace.gap.gap has the normal,
    workspace.a and workspace.b the corners."""
    x = workspace.motion_a[CENTER_X]
    y = workspace.motion_a[CENTER_Y]
    place_at(workspace.local_a, a_count, workspace.motion_a, fraction, x, y, workspace.a)
    place_at(workspace.local_b, b_count, workspace.motion_b, fraction, x, y, workspace.b)
    # At the start nothing is known of the pair: what another one left must not show, not even in the last bit.
    i = min(int(workspace.gap.gap[FIRST_A]), a_count - 1) if fraction > 0.0 else 0
    j = min(int(workspace.gap.gap[FIRST_B]), b_count - 1) if fraction > 0.0 else 0
    separation = separate(workspace.a, a_count, a_radius, workspace.b, b_count, b_radius, i, j, workspace.gap)
    workspace.totals[0] += workspace.gap.state[ROUNDS]
    workspace.totals[1] += workspace.gap.state[CAPPED]
    return separation


@subkernel
def reach_of(local, count):
    """The furthest corner from the point that a hull turns about [px]."""
    reach = 0.0
    for k in range(count):
        reach = max(reach, length_of(local[k, 0], local[k, 1]))
    return reach


@subkernel
def along(corners, motion, fraction, k, x, y, nx, ny):
    """(place along n [px], velocity along n, bend) of corner k at a fraction; x, y: what the corners are seen from."""
    arm_x = corners[k, 0] - ((motion[CENTER_X] - x) + fraction * motion[MOVE_X])
    arm_y = corners[k, 1] - ((motion[CENTER_Y] - y) + fraction * motion[MOVE_Y])
    turn = motion[TURN]
    speed = nx * (motion[MOVE_X] - turn * arm_y) + ny * (motion[MOVE_Y] + turn * arm_x)
    return nx * corners[k, 0] + ny * corners[k, 1], speed, turn * turn * length_of(arm_x, arm_y)


@subkernel
def free_until(gap, speed, bend):
    """The first root of gap + speed · t - bend / 2 · t², for gap >= 0; infinite without one."""
    if bend > 0.0:
        root = math.sqrt(speed * speed + 2.0 * bend * gap)
        if speed < 0.0:
            return 2.0 * gap / (root - speed)
        return (root + speed) / bend
    if speed < 0.0:
        return gap / -speed
    return math.inf


@subkernel
def free_motion(a_count, b_count, radii, fraction, separation, workspace):
    """How much further the motion is free at least: until a pair of corners can meet along the present normal.

    separation [px]: pairs that are nearer than 0 count as touching. O(corners of A · corners of B).
    """
    nx = workspace.gap.gap[NX]
    ny = workspace.gap.gap[NY]
    x = workspace.motion_a[CENTER_X]
    y = workspace.motion_a[CENTER_Y]
    until = math.inf
    for i in range(a_count):
        at_a, speed_a, bend_a = along(workspace.a, workspace.motion_a, fraction, i, x, y, nx, ny)
        for j in range(b_count):
            at_b, speed_b, bend_b = along(workspace.b, workspace.motion_b, fraction, j, x, y, nx, ny)
            # No pair is nearer than the separation; what rounding makes of it must not be.
            gap = max(separation, at_b - at_a - radii)
            until = min(until, free_until(max(0.0, gap), speed_b - speed_a, bend_a + bend_b))
    if separation > 0.0:
        # Far apart and turning fast: no corner leaves its circle.
        center = nx * (
            (workspace.motion_b[CENTER_X] - x)
            + fraction * workspace.motion_b[MOVE_X]
            - fraction * workspace.motion_a[MOVE_X]
        ) + ny * (
            (workspace.motion_b[CENTER_Y] - y)
            + fraction * workspace.motion_b[MOVE_Y]
            - fraction * workspace.motion_a[MOVE_Y]
        )
        gap = center - reach_of(workspace.local_a, a_count) - reach_of(workspace.local_b, b_count) - radii
        if gap > 0.0:
            speed = nx * (workspace.motion_b[MOVE_X] - workspace.motion_a[MOVE_X]) + ny * (
                workspace.motion_b[MOVE_Y] - workspace.motion_a[MOVE_Y]
            )
            until = max(until, free_until(gap, speed, 0.0))
    return until


@subkernel
def speed_of(motion, seen_from, fraction, x, y, nx, ny):
    """Speed along n [px per motion] of the point of a body that is at (x, y),
    seen from where another's motion starts."""
    arm_x = x - ((motion[CENTER_X] - seen_from[CENTER_X]) + fraction * motion[MOVE_X])
    arm_y = y - ((motion[CENTER_Y] - seen_from[CENTER_Y]) + fraction * motion[MOVE_Y])
    return nx * (motion[MOVE_X] - motion[TURN] * arm_y) + ny * (motion[MOVE_Y] + motion[TURN] * arm_x)


@subkernel
def touching_span(corners, count, nx, ny, side, band):
    """(low, high) along the tangent (-ny, nx) of the corners that lie furthest along side · n, within a band [px]."""
    furthest = -math.inf
    for k in range(count):
        furthest = max(furthest, side * (nx * corners[k, 0] + ny * corners[k, 1]))
    low = math.inf
    high = -math.inf
    for k in range(count):
        if side * (nx * corners[k, 0] + ny * corners[k, 1]) >= furthest - band:
            along = nx * corners[k, 1] - ny * corners[k, 0]
            low = min(low, along)
            high = max(high, along)
    return low, high


@subkernel
def approach_at(a_count, b_count, fraction, band, workspace):
    """The greatest speed along the normal [px per motion] at which the two surfaces come nearer where they touch.

    They touch at a point, or along the part of two faces that lie on each other within a band [px]: there the speed is
    greatest at an end.
    """
    nx = workspace.gap.gap[NX]
    ny = workspace.gap.gap[NY]
    a_low, a_high = touching_span(workspace.a, a_count, nx, ny, 1.0, band)
    b_low, b_high = touching_span(workspace.b, b_count, nx, ny, -1.0, band)
    low = max(a_low, b_low)
    high = min(a_high, b_high)
    if low > high:
        low = 0.5 * (low + high)
        high = low
    across = nx * workspace.gap.gap[AX] + ny * workspace.gap.gap[AY]
    most = -math.inf
    for end in range(2):
        at = low if end == 0 else high
        x = across * nx - at * ny
        y = across * ny + at * nx
        most = max(
            most,
            speed_of(workspace.motion_a, workspace.motion_a, fraction, x, y, nx, ny)
            - speed_of(workspace.motion_b, workspace.motion_a, fraction, x, y, nx, ny),
        )
    return most


@subkernel
def advance(a_count, a_radius, b_count, b_radius, workspace):
    """The first fraction at which two hulls meet on their way, or MISS; workspace.gap.gap has normal and points at it.

    workspace: local corners and motions of both are filled in by the caller; radii [px]. Touching or overlapping at the
    start counts only when they approach: 0. When they part they are looked at until they approach again.
    workspace.totals counts GJK's rounds and caps; when ADVANCE_CAP is hit it counts too, and the motion ends there,
    before the impact.
    """
    turn_a = abs(workspace.motion_a[TURN])
    turn_b = abs(workspace.motion_b[TURN])
    reach_a = reach_of(workspace.local_a, a_count)
    reach_b = reach_of(workspace.local_b, b_count)
    path = length_of(
        workspace.motion_b[MOVE_X] - workspace.motion_a[MOVE_X], workspace.motion_b[MOVE_Y] - workspace.motion_a[MOVE_Y]
    )
    size = reach_a + reach_b + a_radius + b_radius
    speed = path + turn_a * reach_a + turn_b * reach_b
    tolerance = TOLERANCE * (size + path)
    radii = a_radius + b_radius
    workspace.gap.gap[FIRST_A] = 0.0
    workspace.gap.gap[FIRST_B] = 0.0
    fraction = 0.0
    stops = 0
    leaving = 0
    was_apart = False
    while stops < ADVANCE_CAP and leaving <= LEAVING_CAP:
        separation = separate_at(a_count, a_radius, b_count, b_radius, fraction, workspace)
        if separation <= tolerance:
            if was_apart:
                return fraction
            if approach_at(a_count, b_count, fraction, TOUCHING_BAND * size, workspace) > RESTING * speed:
                return fraction
            if turn_a * reach_a + turn_b * reach_b == 0.0:
                return MISS  # convex and not turning: they part for good
            leaving += 1
            fraction += max(free_motion(a_count, b_count, radii, fraction, separation, workspace), 1.0 / LEAVING_CAP)
            if fraction >= 1.0:
                return MISS
            continue
        was_apart = True
        stops += 1
        if fraction == 1.0:
            return MISS
        # A rounding beyond the end may still touch at the end.
        fraction += free_motion(a_count, b_count, radii, fraction, separation, workspace)
        if fraction > 1.0 + TOUCHING_BAND:
            return MISS
        fraction = min(fraction, 1.0)
    workspace.totals[1] += 1.0
    return fraction
