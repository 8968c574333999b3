"""Free motion: how far a body would move in a minute if no friction held it.

A body that friction holds may sleep where it is slow. Any other body goes on: nothing stops a slow drift in space, a
fall under a low gravity, or a slide on ice. Such a body may sleep only if its free motion stays under the slop.

Bodies that friction links move as one, a group. A group with friction on a body that stands still is anchored. The
others move freely, but for the surfaces that they press on without friction: the projection of their acceleration onto
the directions that these surfaces leave open. In the plane, only the surface that the acceleration presses most can
remain a face of this projection; any other surface that it meets along that face blocks it.
"""

import math
from typing import NamedTuple

import numpy as np

from physics.jit import inlined, kernel, subkernel
from physics.math2d import norm
from physics.tables.body import DYNAMIC
from physics.tables.table import join_trees, root_of

FREE_TIME = 60.0  # [s] for which the motion of a sleeping body would have stayed under the slop


class Groups(NamedTuple):
    """The groups of bodies that friction links: arrays by row of BODY, whose values count at the root of each group."""

    parents: np.ndarray  # int32, see join_trees
    anchored: np.ndarray  # bool friction holds it on a body that stands still
    blocked: np.ndarray  # bool the surfaces that it presses on leave it no way
    faces: np.ndarray  # bool of each body: two loaded points of one contact keep it from rotating
    masses: np.ndarray
    ax: np.ndarray  # [px/s2] acceleration, times mass while it is summed; then along the surface
    ay: np.ndarray
    press: np.ndarray  # [px/s2] acceleration into the surface that it presses on most; 0: on none
    nx: np.ndarray  # normal of that surface, towards the group
    ny: np.ndarray


class FreeFall(NamedTuple):
    """The acceleration of free bodies, and how far motion reaches in FREE_TIME."""

    gravity_x: float  # [px/s2] times gravity_scale
    gravity_y: float
    ax: float  # [px/s2] of the wind
    ay: float
    velocity_reach: float  # [s] distance per initial speed
    acceleration_reach: float  # [s2] distance per acceleration
    slop: float  # [px]


def new_groups(room: int) -> Groups:
    """Return room for that many bodies."""
    flags, numbers = [np.zeros(room, np.bool_) for _ in range(3)], [np.zeros(room) for _ in range(6)]
    return Groups(np.zeros(room, np.int32), *flags, *numbers)


def free_fall(
    gravity: tuple[float, float], drag: float, wind: tuple[float, float], damped: bool, slop: float
) -> FreeFall:
    """Return the FreeFall of a world.

    gravity [px/s2], wind [px/s]: (0, 0) where undeclared. drag [1/s]. damped: whether drag slows bodies down.
    """
    decay = drag * FREE_TIME if damped else 0.0
    if decay < 1e-4:  # where the closed forms would lose their digits
        first, second = 1.0 - 0.5 * decay, 0.5 - decay / 6.0
    else:
        first = -math.expm1(-decay) / decay
        second = (1.0 - first) / decay
    return FreeFall(*gravity, drag * wind[0], drag * wind[1], first * FREE_TIME, second * FREE_TIME * FREE_TIME, slop)


@inlined
def is_loaded(contact):
    """Return whether a contact bore a force in the last substep, or an impulse in the step."""
    c = contact
    if c.normal_force_1 > 0.0 or c.normal_impulse_1 > 0.0:
        return True
    return c.count == 2 and (c.normal_force_2 > 0.0 or c.normal_impulse_2 > 0.0)


@inlined
def is_free(body):
    """Return whether a body moves by forces: dynamic, awake and finite."""
    return body.kind == DYNAMIC and body.awake and not body.quarantined


@kernel
def start_groups(
    # read
    rows,
    bodies,
    fall,
    # write
    groups_out,
):
    """Make each body a group of its own, with the acceleration of its free fall times its mass. O(rows).

    fall: see FreeFall; groups_out: see Groups.
    """
    g = groups_out
    for k in range(len(rows)):
        i = rows[k]
        b = bodies[i]
        g.parents[i] = i
        g.anchored[i] = False
        g.blocked[i] = False
        g.faces[i] = False
        g.masses[i] = b.mass
        g.ax[i] = b.mass * (b.gravity_scale * fall.gravity_x + fall.ax)
        g.ay[i] = b.mass * (b.gravity_scale * fall.gravity_y + fall.ay)
        g.press[i] = 0.0
        g.nx[i] = 0.0
        g.ny[i] = 0.0


@kernel
def join_groups(
    # read
    bodies,
    contacts,
    friction,
    # write
    groups_inout,
):
    """Join the bodies of loaded contacts with friction, and mark the bodies that they hold on what stands still.

    friction 1: the effect is declared. O(contacts).
    """
    g = groups_inout
    for i in range(len(contacts)):
        c = contacts[i]
        if c.sensor or not is_loaded(c):
            continue
        a = is_free(bodies[c.body_row_a])
        b = is_free(bodies[c.body_row_b])
        if c.count == 2 and min(c.normal_force_1, c.normal_force_2) > 0.0:
            if a:
                g.faces[c.body_row_a] = True
            if b:
                g.faces[c.body_row_b] = True
        if friction == 0 or c.friction <= 0.0:
            continue
        if a and b:
            join_trees(c.body_row_a, c.body_row_b, g.parents)
        elif a:
            g.anchored[c.body_row_a] = True
        elif b:
            g.anchored[c.body_row_b] = True


@kernel
def sum_groups(
    # read
    rows,
    bodies,
    fall,
    # write
    groups_inout,
):
    """Write the mean acceleration of each group, weighted by mass, and whether it is anchored, to its root. O(rows)."""
    g = groups_inout
    for k in range(len(rows)):
        i = rows[k]
        root = root_of(i, g.parents)
        g.parents[i] = root
        if root != i:
            g.anchored[root] = g.anchored[root] or g.anchored[i]
            g.masses[root] += g.masses[i]
            g.ax[root] += g.ax[i]
            g.ay[root] += g.ay[i]
    for k in range(len(rows)):
        i = rows[k]
        if g.parents[i] != i:
            continue
        if g.masses[i] > 0.0:
            g.ax[i] /= g.masses[i]
            g.ay[i] /= g.masses[i]
        else:
            g.ax[i] = bodies[i].gravity_scale * fall.gravity_x + fall.ax
            g.ay[i] = bodies[i].gravity_scale * fall.gravity_y + fall.ay


@subkernel
def choose_surface(root, nx, ny, groups_inout):
    """Take the surface with a normal towards a group as its own if the group presses on it more than on the others."""
    g = groups_inout
    into = -(g.ax[root] * nx + g.ay[root] * ny)
    if into > g.press[root]:
        g.press[root] = into
        g.nx[root] = nx
        g.ny[root] = ny


@subkernel
def mark_blocked(root, nx, ny, fall, groups_inout):
    """Mark a group as blocked if its motion along its surface would enter another surface by more than the slop."""
    g = groups_inout
    into = -(g.ax[root] * nx + g.ay[root] * ny)
    if g.press[root] > 0.0 and into * fall.acceleration_reach > fall.slop:
        g.blocked[root] = True


@kernel
def find_surfaces(
    # read
    rows,
    bodies,
    contacts,
    fall,
    # write
    groups_inout,
):
    """Turn the acceleration of each group along the surface that it presses on most, and find the blocked groups.

    O(rows + contacts).
    """
    g = groups_inout
    for turn in range(2):
        for i in range(len(contacts)):
            c = contacts[i]
            if c.sensor or not (is_loaded(c) or c.separation_1 <= 0.0 or (c.count == 2 and c.separation_2 <= 0.0)):
                continue
            a = g.parents[c.body_row_a] if is_free(bodies[c.body_row_a]) else -1
            b = g.parents[c.body_row_b] if is_free(bodies[c.body_row_b]) else -1
            if a == b:
                continue
            if a >= 0 and turn == 0:
                choose_surface(a, -c.normal_x, -c.normal_y, g)
            elif a >= 0:
                mark_blocked(a, -c.normal_x, -c.normal_y, fall, g)
            if b >= 0 and turn == 0:
                choose_surface(b, c.normal_x, c.normal_y, g)
            elif b >= 0:
                mark_blocked(b, c.normal_x, c.normal_y, fall, g)
        if turn == 1:
            break
        for k in range(len(rows)):
            i = rows[k]
            if g.parents[i] == i:
                g.ax[i] += g.press[i] * g.nx[i]
                g.ay[i] += g.press[i] * g.ny[i]


@kernel
def keep_free_awake(
    # read
    rows,
    bodies,
    groups,
    fall,
    islands,
    # write
    least_out,
):
    """Write a sleep time of 0 for the islands of bodies whose free motion exceeds the slop. O(rows).

    islands (bodies) int32: the root of each body's island; least_out (bodies): its least sleep time [s].
    """
    g = groups
    for k in range(len(rows)):
        i = rows[k]
        b = bodies[i]
        root = g.parents[i]
        if not is_free(b) or g.anchored[root]:
            continue
        way = 0.0 if g.faces[i] else abs(b.angular_velocity) * b.extent * fall.velocity_reach
        if not g.blocked[root]:
            vx = b.vx
            vy = b.vy
            away = vx * g.nx[root] + vy * g.ny[root]
            # Pressed on its surface, a body leaves it by no more than the height of this throw.
            if away * away < 2.0 * g.press[root] * fall.slop:
                vx -= away * g.nx[root]
                vy -= away * g.ny[root]
            way += norm(vx, vy) * fall.velocity_reach
            way += norm(g.ax[root], g.ay[root]) * fall.acceleration_reach
        if way > fall.slop:
            least_out[islands[i]] = 0.0


def keep_awake_what_moves_freely(
    rows: np.ndarray,
    bodies: np.ndarray,
    contacts: np.ndarray,
    friction: bool,
    fall: FreeFall,
    groups: Groups,
    islands: np.ndarray,
    least_out: np.ndarray,
) -> None:
    """Keep awake the islands of bodies that no friction holds and whose free motion exceeds the slop.

    rows: the awake bodies; groups: room for all bodies; islands, least_out: see keep_free_awake.
    """
    start_groups(rows, bodies, fall, groups)
    join_groups(bodies, contacts, int(friction), groups)
    sum_groups(rows, bodies, fall, groups)
    find_surfaces(rows, bodies, contacts, fall, groups)
    keep_free_awake(rows, bodies, groups, fall, islands, least_out)
