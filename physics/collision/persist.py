"""Contacts that live from step to step: recognised by their features, used again while nothing moved, carried along.

A contact keeps the two surface points and the normal in the body spaces of its sides. From them its separation follows
at any pose, without detecting again (Catto, Box2D v3: contact recycling; Coumans, Bullet: persistent manifolds).
"""

import math

from physics.collision.contacts import GRID_ANY, NOTHING, copy_contact
from physics.jit import kernel, subkernel
from physics.math2d import length_of, turned, unit
from physics.shapes.placement import is_hull
from physics.tables.shape import BOUNDS, CHAIN, CIRCLE, MASK, TILES

WITH_A, WITH_B, CORES = 0, 1, 2  # what a contact's normal turns with


@subkernel
def follow(a, a_cosine, a_sine, b, b_cosine, b_sine, contact_inout):
    """Write point, normal and separation [px] at the present poses. Returns how far the points slid on each other [px].

    a, b: BODY rows of the sides, with cosine and sine of their angles.
    """
    c = contact_inout
    ax, ay = turned(c.local_ax, c.local_ay, a_cosine, a_sine)
    bx, by = turned(c.local_bx, c.local_by, b_cosine, b_sine)
    ax += a.x
    ay += a.y
    dx = (b.x + bx) - ax
    dy = (b.y + by) - ay
    if c.frame == CORES:
        nx, ny = unit(dx, dy, c.normal_x, c.normal_y)
        slid = length_of(nx - c.normal_x, ny - c.normal_y) * max(c.radius_a, c.radius_b)
    else:
        with_a = c.frame == WITH_A
        nx, ny = turned(c.local_nx, c.local_ny, a_cosine if with_a else b_cosine, a_sine if with_a else b_sine)
        slid = abs(dy * nx - dx * ny)
    c.normal_x = nx + 0.0
    c.normal_y = ny + 0.0
    gap = dx * nx + dy * ny
    c.separation = gap - c.radius_a - c.radius_b
    middle = 0.5 * (c.radius_a + (gap - c.radius_b))
    c.point_x = ax + 0.5 * (dx - gap * nx) + middle * nx
    c.point_y = ay + 0.5 * (dy - gap * ny) + middle * ny
    return slid


@subkernel
def anchor(bodies, shapes, contact_inout):
    """Remember a contact that was detected at the present poses in the body spaces of its sides.

    A round side keeps its core, or the point would wander off with its spin; the normal turns with the side that is not.
    """
    c = contact_inout
    a = bodies[c.body_row_a]
    b = bodies[c.body_row_b]
    s = shapes[c.row_a]
    o = shapes[c.row_b]
    c.radius_a = s.radius if is_hull(s.kind) and s.kind != BOUNDS else 0.0
    c.radius_b = o.radius if is_hull(o.kind) and o.kind != BOUNDS else 0.0
    c.frame = WITH_A
    if s.kind == CIRCLE:
        c.frame = CORES if o.kind == CIRCLE else WITH_B
    half = 0.5 * c.separation
    cosine = math.cos(a.angle)
    sine = math.sin(a.angle)
    inside = half + c.radius_a
    c.local_ax, c.local_ay = turned(
        c.point_x - inside * c.normal_x - a.x, c.point_y - inside * c.normal_y - a.y, cosine, -sine
    )
    inside = half + c.radius_b
    if c.frame == WITH_A:
        c.local_nx, c.local_ny = turned(c.normal_x, c.normal_y, cosine, -sine)
    cosine = math.cos(b.angle)
    sine = math.sin(b.angle)
    c.local_bx, c.local_by = turned(
        c.point_x + inside * c.normal_x - b.x, c.point_y + inside * c.normal_y - b.y, cosine, -sine
    )
    if c.frame == WITH_B:
        c.local_nx, c.local_ny = turned(c.normal_x, c.normal_y, cosine, -sine)
    c.turn = b.angle - a.angle
    c.base = c.separation


@kernel
def recycle_contacts(
    # read
    bodies,
    shapes,
    candidates,
    count,
    previous,
    distance,
    # write
    kinds_inout,
    counts_inout,
    contacts_out,
):
    """Use the manifolds of the last step again where no point moved by more than `distance` [px] against its partner.

    candidates (count, 2) shape rows and previous CONTACT rows, both in the order of shape ids; a pair that is served is
    marked NOTHING in kinds_inout. Masks are always detected again. Returns the number of contacts written. O(both).
    """
    found = 0
    j = 0
    for i in range(count):
        if kinds_inout[i] == NOTHING:
            continue
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        while j < len(previous) and (
            previous[j].shape_a < a.id or (previous[j].shape_a == a.id and previous[j].shape_b < b.id)
        ):
            j += 1
        if j >= len(previous):
            return found
        if previous[j].shape_a != a.id or previous[j].shape_b != b.id or a.kind == MASK or b.kind == MASK:
            continue
        p = bodies[a.body_row]
        q = bodies[b.body_row]
        # The manifold lies within both: what a turn moves is no further out than the smaller side.
        reach = min(p.extent, q.extent) if min(p.extent, q.extent) > 0.0 else max(p.extent, q.extent)
        p_cosine = math.cos(p.angle)
        p_sine = math.sin(p.angle)
        q_cosine = math.cos(q.angle)
        q_sine = math.sin(q.angle)
        start = found
        fits = True
        last = j
        while last < len(previous) and previous[last].shape_a == a.id and previous[last].shape_b == b.id:
            if fits and found < len(contacts_out) and not previous[last].swept:
                copy_contact(previous, last, found, contacts_out)
                c = contacts_out[found]
                c.body_row_a = a.body_row
                c.body_row_b = b.body_row
                c.row_a = candidates[i, 0]
                c.row_b = candidates[i, 1]
                c.candidate = i
                c.swept = False
                slid = follow(p, p_cosine, p_sine, q, q_cosine, q_sine, c)
                # What is round on both sides, or on one against a face, may turn as it likes.
                turn = 0.0 if a.kind == CIRCLE or b.kind == CIRCLE else abs((q.angle - p.angle) - c.turn) * reach
                c.persisted = True
                fits = slid <= distance and turn <= distance and abs(c.separation - c.base) <= distance
            else:
                fits = False
            found += 1
            last += 1
        if fits:
            counts_inout[kinds_inout[i]] -= 1
            kinds_inout[i] = NOTHING
        else:
            found = start
    return found


@kernel
def remember_grids(
    # read
    shapes,
    candidates,
    count,
    kinds,
    previous,
    # write
    memory_out,
):
    """Write where the previous contacts of every candidate with a tile grid stand: memory_out (count, 2) first, number.

    Both in the order of shape ids. One-way tiles ask who stood on them. O(candidates + previous).
    """
    j = 0
    for i in range(count):
        memory_out[i, 0] = 0
        memory_out[i, 1] = 0
        if kinds[i] != GRID_ANY:
            continue
        a = shapes[candidates[i, 0]].id
        b = shapes[candidates[i, 1]].id
        while j < len(previous) and (previous[j].shape_a < a or (previous[j].shape_a == a and previous[j].shape_b < b)):
            j += 1
        last = j
        while last < len(previous) and previous[last].shape_a == a and previous[last].shape_b == b:
            last += 1
        memory_out[i, 0] = j
        memory_out[i, 1] = last - j


@kernel
def carry_over(
    # read
    bodies,
    shapes,
    previous,
    # write
    contacts_inout,
):
    """Give every new contact the forces of the contact of the same pair and feature in the step before. O(both).

    previous and contacts_inout CONTACT rows in the order of shape ids.
    """
    j = 0
    for i in range(len(contacts_inout)):
        c = contacts_inout[i]
        c.normal_impulse = 0.0
        c.tangent_impulse = 0.0
        c.color = -1
        if c.persisted:
            continue
        anchor(bodies, shapes, c)
        while j < len(previous) and (
            previous[j].shape_a < c.shape_a or (previous[j].shape_a == c.shape_a and previous[j].shape_b < c.shape_b)
        ):
            j += 1
        k = j
        while k < len(previous) and previous[k].shape_a == c.shape_a and previous[k].shape_b == c.shape_b:
            o = previous[k]
            if o.feature == c.feature:
                c.normal_force = o.normal_force
                c.tangent_force = o.tangent_force
                c.rolling_force = o.rolling_force
                c.persisted = True
                break
            k += 1


@kernel
def follow_bodies(
    # read
    bodies,
    # write
    contacts_inout,
):
    """Carry separations, points and normals of all contacts to the final poses. O(contacts)."""
    row_a = -1
    row_b = -1
    a_cosine = 1.0
    a_sine = 0.0
    b_cosine = 1.0
    b_sine = 0.0
    for i in range(len(contacts_inout)):
        c = contacts_inout[i]
        a = bodies[c.body_row_a]
        b = bodies[c.body_row_b]
        # The contacts of a pair, and often those of a body, stand together.
        if c.body_row_a != row_a:
            row_a = c.body_row_a
            a_cosine = math.cos(a.angle)
            a_sine = math.sin(a.angle)
        if c.body_row_b != row_b:
            row_b = c.body_row_b
            b_cosine = math.cos(b.angle)
            b_sine = math.sin(b.angle)
        follow(a, a_cosine, a_sine, b, b_cosine, b_sine, c)


@kernel
def mix_materials(
    # read
    geometry,
    shapes,
    # write
    contacts_inout,
):
    """Write the mixed materials of every contact that is new; a chain's link has its own. O(contacts).

    Friction is the geometric mean, restitution and rolling resistance the greater, surface speeds add up. Rolling
    resistance is a length here: the coefficient times the greater radius (Catto, Box2D v3.1).
    """
    for i in range(len(contacts_inout)):
        c = contacts_inout[i]
        friction = 1.0
        restitution = 0.0
        rolling = 0.0
        radius = 0.0
        speed = 0.0
        for side in range(2):
            s = shapes[c.row_a if side == 0 else c.row_b]
            own_friction = s.friction
            own_restitution = s.restitution
            own_rolling = s.rolling_resistance
            own_speed = s.surface_speed
            if s.kind == CHAIN:
                link = geometry.links[geometry.chains[s.geometry].offset + c.feature // 4096]
                if link.friction >= 0.0:
                    own_friction = link.friction
                    own_restitution = link.restitution
                    own_rolling = link.rolling_resistance
                    own_speed = link.surface_speed
            friction *= own_friction
            restitution = max(restitution, own_restitution)
            rolling = max(rolling, own_rolling)
            speed += own_speed
            if s.kind != TILES and s.kind != CHAIN and s.kind != MASK:
                radius = max(radius, s.radius)
        c.friction = math.sqrt(friction)
        c.restitution = restitution
        c.rolling_resistance = rolling * radius
        c.surface_speed = speed
