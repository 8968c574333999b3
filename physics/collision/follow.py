"""Contacts that follow their bodies: points, normal and separations of a manifold at any pose, from its anchor.

An anchor keeps the surface points and the normal in the body spaces of its sides; nothing is detected again.
"""

import math

from physics.jit import kernel, subkernel
from physics.math2d import length_of, turned, unit
from physics.tables.manifold import CORES, WITH_A, WITH_B


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
