"""Rows of the contact table: written by the passes over pairs, then put in the order of the candidates."""

import math
from typing import NamedTuple

import numpy as np

from physics.collision.clipping import MANIFOLD
from physics.jit import kernel, subkernel
from physics.math2d import turned
from physics.shapes.placement import corners_at
from physics.tables.contact import CONTACT

# Kinds of pairs, by which the candidates are dealt to the passes.
CIRCLES, POLYGON_CIRCLE, POLYGONS, MASKS, MASK_CIRCLE, MASK_POLYGON, GRID_ANY, CHAIN_ANY, NOTHING = range(9)


class Scratch(NamedTuple):
    """Room for one pair in flight."""

    a: np.ndarray  # (16, 2) corners [px]
    b: np.ndarray
    manifold: np.ndarray  # (11,), see sat.MANIFOLD
    depths: np.ndarray  # (16,)
    previous: np.ndarray  # CONTACT rows of the step before, and where those of each candidate with a grid stand
    memory: np.ndarray  # (candidates, 2) first row, number


def new_scratch() -> Scratch:
    return Scratch(
        np.zeros((16, 2)),
        np.zeros((16, 2)),
        np.zeros(MANIFOLD),
        np.zeros(16),
        np.zeros(0, CONTACT),
        np.zeros((0, 2), np.int64),
    )


@subkernel
def write_contact(
    # read
    shapes,
    candidates,
    # scalars
    pair,
    found,
    nx,
    ny,
    x,
    y,
    separation,
    area,
    feature,
    # write
    contacts_out,
):
    """Write a contact of a candidate pair when there is room, and return the count, which goes on past the capacity.

    What depends on the bodies' motion is left to solver/approach.
    """
    if found < len(contacts_out):
        row_a = candidates[pair, 0]
        row_b = candidates[pair, 1]
        a = shapes[row_a]
        b = shapes[row_b]
        c = contacts_out[found]
        c.body_a = a.body
        c.body_b = b.body
        c.shape_a = a.id
        c.shape_b = b.id
        c.point_x = x
        c.point_y = y
        c.normal_x = nx + 0.0  # -0.0 would show in what is printed and compared
        c.normal_y = ny + 0.0
        c.separation = separation
        c.normal_impulse = 0.0
        c.tangent_impulse = 0.0
        c.area = area
        c.feature = feature
        c.body_row_a = a.body_row
        c.body_row_b = b.body_row
        c.row_a = row_a
        c.row_b = row_b
        c.candidate = pair
        c.swept = False
        c.sensor = a.sensor or b.sensor
        c.persisted = False
        c.normal_force = 0.0
        c.tangent_force = 0.0
        c.rolling_force = 0.0
        c.color = -1
    return found + 1


@subkernel
def circle_at(bodies, shapes, row):
    """Centre of a CIRCLE in the world [px], and its radius."""
    s = shapes[row]
    b = bodies[s.body_row]
    u, v = turned(s.local_x, s.local_y, math.cos(b.angle), math.sin(b.angle))
    return b.x + u, b.y + v, s.radius


@subkernel
def corners_of(geometry, bodies, shapes, row, corners_out):
    """World corners of a hull of two or more at its body's pose. Returns their number."""
    b = bodies[shapes[row].body_row]
    return corners_at(geometry, shapes, row, b.x, b.y, b.angle, corners_out)


@subkernel
def copy_contact(contacts, source, target, contacts_out):
    """Copy one row field by field: a whole-row assignment is not the same thing compiled and plain."""
    s = contacts[source]
    d = contacts_out[target]
    d.body_a = s.body_a
    d.body_b = s.body_b
    d.shape_a = s.shape_a
    d.shape_b = s.shape_b
    d.point_x = s.point_x
    d.point_y = s.point_y
    d.normal_x = s.normal_x
    d.normal_y = s.normal_y
    d.separation = s.separation
    d.normal_impulse = s.normal_impulse
    d.tangent_impulse = s.tangent_impulse
    d.area = s.area
    d.feature = s.feature
    d.body_row_a = s.body_row_a
    d.body_row_b = s.body_row_b
    d.row_a = s.row_a
    d.row_b = s.row_b
    d.candidate = s.candidate
    d.anchor_x = s.anchor_x
    d.anchor_y = s.anchor_y
    d.friction = s.friction
    d.restitution = s.restitution
    d.speed = s.speed
    d.swept = s.swept
    d.sensor = s.sensor
    d.rolling_resistance = s.rolling_resistance
    d.surface_speed = s.surface_speed
    d.local_ax = s.local_ax
    d.local_ay = s.local_ay
    d.local_bx = s.local_bx
    d.local_by = s.local_by
    d.radius_a = s.radius_a
    d.radius_b = s.radius_b
    d.frame = s.frame
    d.local_nx = s.local_nx
    d.local_ny = s.local_ny
    d.turn = s.turn
    d.base = s.base
    d.normal_force = s.normal_force
    d.tangent_force = s.tangent_force
    d.rolling_force = s.rolling_force
    d.color = s.color
    d.persisted = s.persisted


@kernel
def place_in_order(
    # read
    contacts,
    count,
    candidate_count,
    # write
    starts_out,
    contacts_out,
):
    """Copy contacts to the order of their candidates; those of one candidate keep theirs.

    contacts, contacts_out CONTACT rows; starts_out (candidates + 1): scratch. O(contacts + candidates).
    """
    for i in range(candidate_count + 1):
        starts_out[i] = 0
    for i in range(count):
        starts_out[contacts[i].candidate + 1] += 1
    for i in range(candidate_count):
        starts_out[i + 1] += starts_out[i]
    for i in range(count):
        pair = contacts[i].candidate
        at = starts_out[pair]
        starts_out[pair] = at + 1
        copy_contact(contacts, i, at, contacts_out)


@kernel
def write_impacts(
    # read
    bodies,
    shapes,
    candidates,
    impacts,
    count,
    dt,
    response,
    # write
    contacts_out,
):
    """Write a contact for every impact that is the first of a body on its way, or of a sensor. Returns their number.

    impacts (n, 5): candidate, fraction, normal, stops. The point is the edge, along the normal, of the smaller of the two boxes.
    With response 1 the separation is that at the final poses: what a side went on by after the impact.
    """
    found = 0
    for i in range(count):
        pair = int(impacts[i, 0])
        a = shapes[candidates[pair, 0]]
        b = shapes[candidates[pair, 1]]
        p = bodies[a.body_row]
        q = bodies[b.body_row]
        sensor = a.sensor or b.sensor
        first = min(p.fraction, q.fraction)
        if impacts[i, 1] > first:
            continue
        nx = impacts[i, 2]
        ny = impacts[i, 3]
        small_a = (a.max_x - a.min_x) + (a.max_y - a.min_y) <= (b.max_x - b.min_x) + (b.max_y - b.min_y)
        s = a if small_a else b
        side = 1.0 if small_a else -1.0
        x = 0.5 * (s.min_x + s.max_x) + side * nx * 0.5 * (s.max_x - s.min_x)
        y = 0.5 * (s.min_y + s.max_y) + side * ny * 0.5 * (s.max_y - s.min_y)
        separation = 0.0
        if response == 1:
            after_x = (q.x - q.previous_x) - (p.x - p.previous_x) - impacts[i, 1] * dt * (q.vx - p.vx)
            after_y = (q.y - q.previous_y) - (p.y - p.previous_y) - impacts[i, 1] * dt * (q.vy - p.vy)
            # What it slid on after a graze is no overlap.
            separation = min(0.0, nx * after_x + ny * after_y) if impacts[i, 4] == 1.0 else 0.0
        before = found
        found = write_contact(shapes, candidates, pair, found, nx, ny, x, y, separation, 0.0, -1, contacts_out)
        if found > before and before < len(contacts_out):
            contacts_out[before].swept = True
            contacts_out[before].sensor = sensor
    return found
