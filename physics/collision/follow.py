"""Contacts that follow their bodies: points, normal and separations of a manifold at any pose, from its anchor.

An anchor keeps the surface points and the normal in the body spaces of its sides; nothing is detected again.
"""

import math

from physics.jit import inlined, kernel
from physics.math2d import heading, length_of, turned, unit
from physics.tables.manifold import CORES, WITH_A, WITH_B


@inlined
def cores_at(a, a_cosine, a_sine, b, b_cosine, b_sine, local_ax, local_ay, local_bx, local_by):
    """The cores of a point at the present poses: A's [px], and B's seen from it. a, b: BODY rows, with their turns;
    local [px]: the cores in the body spaces."""
    ax, ay = turned(local_ax, local_ay, a_cosine, a_sine)
    bx, by = turned(local_bx, local_by, b_cosine, b_sine)
    ax += a.x
    ay += a.y
    return ax, ay, (b.x + bx) - ax, (b.y + by) - ay


@inlined
def carried_gap(gap, dx, dy, other_dx, other_dy, apart_x, apart_y, with_a, nx, ny, wander):
    """(the gap [px] of cores at a point that the end of a face cuts from the edge over it, whether it is another one).

    The edge runs through the other side's cores of both points: as they slide along the face, the cut wanders on it.
    gap: from core to core of the point; dx, dy: B's core of the point seen from A's, other_dx, other_dy those of the
    other point, apart_x, apart_y: the other point's core of A seen from this one's; with_a: the face is A's; wander
    [px]: it stays as it is where the cut makes no more of a difference.
    """
    edge_x = apart_x + (other_dx - dx if with_a else 0.0)
    edge_y = apart_y + (other_dy - dy if with_a else 0.0)
    along = edge_y * nx - edge_x * ny
    across = edge_x * nx + edge_y * ny
    rise = (dy * nx - dx * ny) * across
    # An edge that is too steep is not the one that lies along the face.
    if abs(across) >= abs(along) or along == 0.0 or abs(rise) <= wander * abs(along):
        return gap, False
    return gap - rise / along, True


@inlined
def is_cut(anchor, share):
    """Whether a point of an anchor, with its share, is where a face's end cuts the edge over it."""
    return (anchor.frame == WITH_A and share == 0.0) or (anchor.frame == WITH_B and share == 1.0)


@inlined
def point_of(ax, ay, dx, dy, nx, ny, gap, share, radius_a, radius_b):
    """A point of a manifold [px], x and y, and its separation. ax … dy: see cores_at; gap: from core to core along the
    normal, as the point is told."""
    apart = dx * nx + dy * ny
    middle = 0.5 * (radius_a + (gap - radius_b)) + share * (apart - gap)
    x = ax + share * (dx - apart * nx) + middle * nx
    y = ay + share * (dy - apart * ny) + middle * ny
    return x, y, gap - radius_a - radius_b


@inlined
def follow_anchor(a, a_cosine, a_sine, b, b_cosine, b_sine, anchor, wander, manifold_inout):
    """Write points, normal and separations [px] at the present poses. Returns (how far the points have moved on each
    other since they were detected, along a face or across it [px], how far a core rolled round a corner [px], whether
    what a face's end cuts off was carried along the edge).

    a, b: BODY rows of the sides, with cosine and sine of their angles; anchor: the ANCHOR row; wander [px]: the end's
    cut is carried where that makes more of a difference, which it does only where much has moved; infinite: never.
    """
    m = manifold_inout
    c = anchor
    two = m.count == 2
    m.lead = 0.0
    ax_1, ay_1, dx_1, dy_1 = cores_at(
        a, a_cosine, a_sine, b, b_cosine, b_sine, c.local_ax_1, c.local_ay_1, c.local_bx_1, c.local_by_1
    )
    ax_2, ay_2, dx_2, dy_2 = ax_1, ay_1, dx_1, dy_1
    if two:
        ax_2, ay_2, dx_2, dy_2 = cores_at(
            a, a_cosine, a_sine, b, b_cosine, b_sine, c.local_ax_2, c.local_ay_2, c.local_bx_2, c.local_by_2
        )
    nx = c.local_nx
    ny = c.local_ny
    moved = 0.0
    rolled = 0.0
    if c.frame == CORES:
        nx, ny = unit(dx_1, dy_1, m.normal_x, m.normal_y)
        # Against where it was detected: what rolls round a corner leaves it.
        rolled = length_of(nx - c.local_nx, ny - c.local_ny) * max(c.radius_a, c.radius_b)
    else:
        if c.frame == WITH_A:
            nx, ny = turned(nx, ny, a_cosine, a_sine)
        elif c.frame == WITH_B:
            nx, ny = turned(nx, ny, b_cosine, b_sine)
        moved = max(abs(dy_1 * nx - dx_1 * ny), abs(dy_2 * nx - dx_2 * ny))
    m.normal_x = nx + 0.0
    m.normal_y = ny + 0.0
    gap_1 = dx_1 * nx + dy_1 * ny
    gap_2 = dx_2 * nx + dy_2 * ny
    wandered_1 = False
    wandered_2 = False
    if two and wander < math.inf:
        x = ax_2 - ax_1
        y = ay_2 - ay_1
        with_a = c.frame == WITH_A
        if is_cut(c, c.share_1):
            gap_1, wandered_1 = carried_gap(gap_1, dx_1, dy_1, dx_2, dy_2, x, y, with_a, nx, ny, wander)
        if is_cut(c, c.share_2):
            gap_2, wandered_2 = carried_gap(gap_2, dx_2, dy_2, dx_1, dy_1, -x, -y, with_a, nx, ny, wander)
    m.x_1, m.y_1, m.separation_1 = point_of(ax_1, ay_1, dx_1, dy_1, nx, ny, gap_1, c.share_1, c.radius_a, c.radius_b)
    moved = max(moved, abs(m.separation_1 - c.base_1))
    if two:
        m.x_2, m.y_2, m.separation_2 = point_of(
            ax_2, ay_2, dx_2, dy_2, nx, ny, gap_2, c.share_2, c.radius_a, c.radius_b
        )
        moved = max(moved, abs(m.separation_2 - c.base_2))
    return moved, rolled, wandered_1 or wandered_2


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
            a_cosine, a_sine = heading(a.angle)
        if m.body_row_b != row_b:
            row_b = m.body_row_b
            b_cosine, b_sine = heading(b.angle)
        follow_anchor(a, a_cosine, a_sine, b, b_cosine, b_sine, anchors[i], 0.0, m)
