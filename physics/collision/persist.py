"""Manifolds that live from step to step: recognised by their features, used again while nothing moved, carried along.

An anchor keeps the surface points and the normal in the body spaces of its sides. From them separations follow at any
pose, without detecting again (Catto, Box2D v3: contact recycling; Coumans, Bullet: persistent manifolds).
"""

import math

from physics.collision.anchors import anchor_manifold, copy_anchor, rest_anchor
from physics.collision.approach import approach
from physics.collision.manifold import GRID_ANY, NOTHING, SURFACE_ANY, copy_manifold
from physics.collision.materials import mixed
from physics.jit import kernel, subkernel
from physics.math2d import length_of, turned, unit
from physics.tables.manifold import CORES, WITH_A, WITH_B
from physics.tables.shape import CIRCLE, MASK

LARGEST_FORCE = 1e100  # beyond, and what is no number, is not what a contact bore: it begins at rest


@subkernel
def is_before(manifold, shape_a, shape_b):
    """Whether a manifold stands before those of a pair, in the order of shape ids."""
    return manifold.shape_a < shape_a or (manifold.shape_a == shape_a and manifold.shape_b < shape_b)


@subkernel
def is_of(manifold, shape_a, shape_b):
    """Whether a manifold is one of a pair's."""
    return manifold.shape_a == shape_a and manifold.shape_b == shape_b


@subkernel
def follow_point(a, a_cosine, a_sine, b, b_cosine, b_sine, anchor, k):
    """The cores of point k at the present poses: A's [px], and B's seen from it. a, b: BODY rows, with their turns."""
    local_ax = anchor.local_ax_1 if k == 0 else anchor.local_ax_2
    local_ay = anchor.local_ay_1 if k == 0 else anchor.local_ay_2
    local_bx = anchor.local_bx_1 if k == 0 else anchor.local_bx_2
    local_by = anchor.local_by_1 if k == 0 else anchor.local_by_2
    ax, ay = turned(local_ax, local_ay, a_cosine, a_sine)
    bx, by = turned(local_bx, local_by, b_cosine, b_sine)
    ax += a.x
    ay += a.y
    return ax, ay, (b.x + bx) - ax, (b.y + by) - ay


@subkernel
def cut_gap(gap, dx, dy, other_dx, other_dy, apart_x, apart_y, with_a, nx, ny):
    """The gap [px] of cores at a point that the end of a face cuts from the edge over it.

    The edge runs through the other side's cores of both points: as they slide along the face, the cut wanders on it.
    gap: from core to core of the point; dx, dy: B's core of the point seen from A's, other_dx, other_dy those of the
    other point, apart_x, apart_y: the other point's core of A seen from this one's; with_a: the face is A's.
    """
    edge_x = apart_x + (other_dx - dx if with_a else 0.0)
    edge_y = apart_y + (other_dy - dy if with_a else 0.0)
    along = edge_y * nx - edge_x * ny
    across = edge_x * nx + edge_y * ny
    if abs(across) >= abs(along) or along == 0.0:
        return gap  # too steep to be the edge that lies along the face
    return gap - (dy * nx - dx * ny) * across / along


@subkernel
def follow(a, a_cosine, a_sine, b, b_cosine, b_sine, anchor, cut, manifold_inout):
    """Write points, normal and separations [px] at the present poses. Returns (how far the points slid on each other
    [px], by how much a separation differs from that at its detection [px]).

    a, b: BODY rows of the sides, with cosine and sine of their angles; anchor: the ANCHOR row; cut: whether what a
    face's end cuts off wanders along the edge, which counts only where much has moved.
    """
    m = manifold_inout
    m.lead = 0.0
    slid = 0.0
    changed = 0.0
    old_x = m.normal_x
    old_y = m.normal_y
    ax_1, ay_1, dx_1, dy_1 = follow_point(a, a_cosine, a_sine, b, b_cosine, b_sine, anchor, 0)
    ax_2 = ax_1
    ay_2 = ay_1
    dx_2 = dx_1
    dy_2 = dy_1
    if m.count == 2:
        ax_2, ay_2, dx_2, dy_2 = follow_point(a, a_cosine, a_sine, b, b_cosine, b_sine, anchor, 1)
    for k in range(m.count):
        ax = ax_1 if k == 0 else ax_2
        ay = ay_1 if k == 0 else ay_2
        dx = dx_1 if k == 0 else dx_2
        dy = dy_1 if k == 0 else dy_2
        share = anchor.share_1 if k == 0 else anchor.share_2
        if anchor.frame == CORES:
            nx, ny = unit(dx, dy, old_x, old_y)
            # Against where it was detected: what rolls round a corner leaves it.
            turn = length_of(nx - anchor.local_nx, ny - anchor.local_ny)
            slid = max(slid, turn * max(anchor.radius_a, anchor.radius_b))
        else:
            nx = anchor.local_nx
            ny = anchor.local_ny
            if anchor.frame == WITH_A:
                nx, ny = turned(nx, ny, a_cosine, a_sine)
            elif anchor.frame == WITH_B:
                nx, ny = turned(nx, ny, b_cosine, b_sine)
            slid = max(slid, abs(dy * nx - dx * ny))
        m.normal_x = nx + 0.0
        m.normal_y = ny + 0.0
        apart = dx * nx + dy * ny
        gap = apart
        if (
            cut
            and m.count == 2
            and ((anchor.frame == WITH_A and share == 0.0) or (anchor.frame == WITH_B and share == 1.0))
        ):
            sign = 1.0 if k == 0 else -1.0
            gap = cut_gap(
                apart,
                dx,
                dy,
                dx_2 if k == 0 else dx_1,
                dy_2 if k == 0 else dy_1,
                sign * (ax_2 - ax_1),
                sign * (ay_2 - ay_1),
                anchor.frame == WITH_A,
                nx,
                ny,
            )
        separation = gap - anchor.radius_a - anchor.radius_b
        middle = 0.5 * (anchor.radius_a + (gap - anchor.radius_b)) + share * (apart - gap)
        x = ax + share * (dx - apart * nx) + middle * nx
        y = ay + share * (dy - apart * ny) + middle * ny
        if k == 0:
            m.x_1, m.y_1, m.separation_1 = x, y, separation
            changed = max(changed, abs(separation - anchor.base_1))
        else:
            m.x_2, m.y_2, m.separation_2 = x, y, separation
            changed = max(changed, abs(separation - anchor.base_2))
    return slid, changed


@subkernel
def is_finite(manifold):
    """Whether a manifold has numbers that are: what is finite is 0 less than itself."""
    m = manifold
    total = m.normal_x + m.normal_y + m.x_1 + m.y_1 + m.separation_1
    if m.count == 2:
        total += m.x_2 + m.y_2 + m.separation_2
    return total - total == 0.0


@kernel
def recycle_manifolds(
    # read
    batch,
    previous,
    anchors,
    distance,
    # write
    kinds_inout,
    counts_inout,
    manifolds_out,
):
    """Use the manifolds of the last step again where no point moved by more than `distance` [px] against its partner.

    previous MANIFOLD rows and their ANCHOR rows, in the order of shape ids as the candidates; a pair that is served is
    marked NOTHING in kinds_inout. Masks are always detected again. Returns the number of manifolds written. O(both).
    """
    bodies = batch.bodies
    shapes = batch.shapes
    candidates = batch.candidates
    found = 0
    j = 0
    row_a, row_b = -1, -1
    p_cosine, p_sine, q_cosine, q_sine = 1.0, 0.0, 1.0, 0.0
    for i in range(batch.count):
        if kinds_inout[i] == NOTHING:
            continue
        a = shapes[candidates[i, 0]]
        b = shapes[candidates[i, 1]]
        while j < len(previous) and is_before(previous[j], a.id, b.id):
            j += 1
        if j >= len(previous):
            return found
        if not is_of(previous[j], a.id, b.id) or a.kind == MASK or b.kind == MASK:
            continue
        p = bodies[a.body_row]
        q = bodies[b.body_row]
        # The manifold lies within both: what a turn moves is no further out than the smaller side.
        reach = min(p.extent, q.extent) if min(p.extent, q.extent) > 0.0 else max(p.extent, q.extent)
        # The pairs of a body stand together.
        if a.body_row != row_a:
            row_a = a.body_row
            p_cosine = math.cos(p.angle)
            p_sine = math.sin(p.angle)
        if b.body_row != row_b:
            row_b = b.body_row
            q_cosine = math.cos(q.angle)
            q_sine = math.sin(q.angle)
        start = found
        fits = True
        last = j
        while last < len(previous) and is_of(previous[last], a.id, b.id):
            if fits and found < len(manifolds_out) and not previous[last].swept:
                copy_manifold(previous, last, found, manifolds_out)
                m = manifolds_out[found]
                m.body_row_a = a.body_row
                m.body_row_b = b.body_row
                m.row_a = candidates[i, 0]
                m.row_b = candidates[i, 1]
                m.candidate = i
                m.previous = last
                m.persisted_1 = True
                m.persisted_2 = True
                slid, changed = follow(p, p_cosine, p_sine, q, q_cosine, q_sine, anchors[last], False, m)
                # What is round on both sides, or on one against a face, may turn as it likes.
                turn = 0.0
                if a.kind != CIRCLE and b.kind != CIRCLE:
                    turn = abs((q.angle - anchors[last].angle_b) - (p.angle - anchors[last].angle_a)) * reach
                fits = slid <= distance and turn <= distance and changed <= distance and is_finite(m)
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
def remember_ground(
    # read
    batch,
    previous,
    # write
    memory_out,
):
    """Write where the previous manifolds of each candidate with a tile grid, or a surface, stand: memory_out (count, 2)
    first, number.

    Both in the order of shape ids. What is open from below asks who stood on it. O(candidates + previous).
    """
    j = 0
    for i in range(batch.count):
        memory_out[i, 0] = 0
        memory_out[i, 1] = 0
        if batch.kinds[i] != GRID_ANY and batch.kinds[i] != SURFACE_ANY:
            continue
        a = batch.shapes[batch.candidates[i, 0]].id
        b = batch.shapes[batch.candidates[i, 1]].id
        while j < len(previous) and is_before(previous[j], a, b):
            j += 1
        last = j
        while last < len(previous) and is_of(previous[last], a, b):
            last += 1
        memory_out[i, 0] = j
        memory_out[i, 1] = last - j


@subkernel
def take_over(previous, anchors, first, manifold_inout, anchor_inout):
    """Give the points of a new manifold the forces of the points with their features, among the previous manifolds of
    its pair, which begin at `first`."""
    m = manifold_inout
    c = anchor_inout
    for point in range(m.count):
        feature = m.feature_1 if point == 0 else m.feature_2
        k = first
        known = False
        while not known and k < len(previous) and is_of(previous[k], m.shape_a, m.shape_b):
            o = previous[k]
            f = anchors[k]
            second = o.count == 2 and o.feature_2 == feature and o.feature_1 != feature
            if o.feature_1 == feature or second:
                known = True
                normal_force = f.normal_force_2 if second else f.normal_force_1
                tangent_force = f.tangent_force_2 if second else f.tangent_force_1
                if point == 0:
                    c.normal_force_1 = normal_force
                    c.tangent_force_1 = tangent_force
                    c.rolling_force = 0.0 if second else f.rolling_force
                    m.persisted_1 = True
                else:
                    c.normal_force_2 = normal_force
                    c.tangent_force_2 = tangent_force
                    m.persisted_2 = True
            k += 1


@kernel
def carry_over(
    # read
    geometry,
    bodies,
    shapes,
    previous,
    previous_anchors,
    # write
    manifolds_inout,
    anchors_out,
):
    """Write the anchor of every manifold: as it was where that is used again; else a new one, with the forces of the
    points of the same pair and feature in the step before; and what is new in every step: what the materials are now,
    and how fast both sides approach. O(both).

    previous and manifolds_inout MANIFOLD rows in the order of shape ids, anchors row by row beside them.
    """
    j = 0
    for i in range(len(manifolds_inout)):
        m = manifolds_inout[i]
        c = anchors_out[i]
        m.normal_impulse_1 = 0.0
        m.tangent_impulse_1 = 0.0
        m.normal_impulse_2 = 0.0
        m.tangent_impulse_2 = 0.0
        if m.previous >= 0:
            copy_anchor(previous_anchors[m.previous], c)
            c.color = -1
        else:
            rest_anchor(c)
            anchor_manifold(geometry, bodies, shapes, m, c)
            while j < len(previous) and is_before(previous[j], m.shape_a, m.shape_b):
                j += 1
            take_over(previous, previous_anchors, j, m, c)
        forces = abs(c.normal_force_1) + abs(c.tangent_force_1) + abs(c.normal_force_2) + abs(c.tangent_force_2)
        if not forces + abs(c.rolling_force) < LARGEST_FORCE:
            rest_anchor(c)
        c.friction, c.restitution, c.rolling_resistance, c.surface_speed = mixed(geometry, shapes, m)
        approach(bodies, m)


@kernel
def follow_bodies(
    # read
    bodies,
    anchors,
    # write
    manifolds_inout,
):
    """Carry separations, points and normals of all manifolds to the final poses. O(manifolds)."""
    row_a = -1
    row_b = -1
    a_cosine = 1.0
    a_sine = 0.0
    b_cosine = 1.0
    b_sine = 0.0
    for i in range(len(manifolds_inout)):
        m = manifolds_inout[i]
        a = bodies[m.body_row_a]
        b = bodies[m.body_row_b]
        # The manifolds of a pair, and often those of a body, stand together.
        if m.body_row_a != row_a:
            row_a = m.body_row_a
            a_cosine = math.cos(a.angle)
            a_sine = math.sin(a.angle)
        if m.body_row_b != row_b:
            row_b = m.body_row_b
            b_cosine = math.cos(b.angle)
            b_sine = math.sin(b.angle)
        follow(a, a_cosine, a_sine, b, b_cosine, b_sine, anchors[i], True, m)
