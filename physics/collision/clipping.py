"""Convex polygons by the separating axis theorem, with a manifold of at most two points clipped from the edges.

Corners go clockwise on the screen (y down), so the outward normal of the edge from p to q is (dy, -dx):

        0 ---e0--- 1
        |          |
        e3         e1          normal of e0 = (0, -1): up
        |          |
        3 ---e2--- 2

Source: Gregorius, The Separating Axis Test, GDC 2013; Catto, Contact Manifolds, GDC 2007.
"""

import math

from physics.collision.features import clipped_feature, support_feature
from physics.jit import subkernel
from physics.tables.shape import TURNS

TURN = 1.0 / TURNS  # [rad]
# A manifold in flight is a row of 11 floats: count, normal, and twice (point, separation, feature).
LEFT = -1.0  # in place of the count: they overlap, and a neighbour that covers the nearer edges is to tell it
ALL_EDGES = 0xFFFFFFFF  # 16 bits: edges that may be touched; next 16: corners that may be; beyond: as SHAPE's inner


@subkernel
def edge_normal(corners, count, k):
    """Outward unit normal of edge k."""
    n = k + 1 if k + 1 < count else 0
    dx = corners[n, 0] - corners[k, 0]
    dy = corners[n, 1] - corners[k, 1]
    length = math.sqrt(dx * dx + dy * dy)
    if length == 0.0:
        return 0.0, -1.0
    return dy / length, -dx / length


@subkernel
def meets_corner(corners, count, edges, corner, nx, ny):
    """Whether what lies in the direction (nx, ny), unit, of a corner has it as the nearest point of the outline.

    Of a corner that other parts cover a neighbour tells. At a blunt one the part seems sharper than the outline is: its
    inner side is not the outline's, which turns there only so far from the side that may be touched.
    """
    if (edges >> (16 + corner)) & 1 == 0:
        return False
    if (edges >> (32 + corner)) & 1 == 0:
        return True
    least = math.cos((edges >> 48) * TURN)
    for back in range(2):
        side = corner if back == 0 else (corner - 1 if corner > 0 else count - 1)
        if (edges >> side) & 1:
            own_x, own_y = edge_normal(corners, count, side)
            return nx * own_x + ny * own_y >= least
    return False


@subkernel
def best_edge(corners, count, allowed, other, other_count):
    """The edge of the first polygon that separates most, and its separation [px].

    allowed: bits of the edges that may serve as a reference face. Returns (edge, separation over the allowed edges,
    separation over all edges). O(count · other_count).
    """
    best = -1
    best_separation = -math.inf
    overall = -math.inf
    for k in range(count):
        nx, ny = edge_normal(corners, count, k)
        least = math.inf
        for i in range(other_count):
            least = min(least, nx * (other[i, 0] - corners[k, 0]) + ny * (other[i, 1] - corners[k, 1]))
        overall = max(overall, least)
        if (allowed >> k) & 1 and least > best_separation:
            best = k
            best_separation = least
    return best, best_separation, overall


@subkernel
def clip_edges(
    reference,
    reference_count,
    reference_radius,
    edge,
    incident,
    incident_count,
    incident_radius,
    limit,
    flipped,
    manifold_out,
):
    """Manifold of a reference face and the edge of the other polygon that faces it most, each grown by a radius [px].

    limit [px]: points further apart are dropped; flipped: the reference belongs to B, so the normal is turned round.
    manifold_out: see above. Feature: bits of reference edge, incident corner, side. Returns the number of points.
    """
    following = edge + 1 if edge + 1 < reference_count else 0
    nx, ny = edge_normal(reference, reference_count, edge)
    facing = 0
    most = math.inf
    for k in range(incident_count):
        mx, my = edge_normal(incident, incident_count, k)
        if mx * nx + my * ny < most:
            most = mx * nx + my * ny
            facing = k
    far = facing + 1 if facing + 1 < incident_count else 0
    tx = -ny
    ty = nx
    start = tx * reference[edge, 0] + ty * reference[edge, 1]
    end = tx * reference[following, 0] + ty * reference[following, 1]
    # The incident edge runs against the reference edge.
    px = incident[far, 0]
    py = incident[far, 1]
    qx = incident[facing, 0]
    qy = incident[facing, 1]
    p_along = tx * px + ty * py
    q_along = tx * qx + ty * qy
    span = q_along - p_along
    count = 0
    sign = -1.0 if flipped else 1.0
    for side in range(2):
        along = p_along if side == 0 else q_along
        x = px if side == 0 else qx
        y = py if side == 0 else qy
        if p_along > end or q_along < start:
            break
        clipped = along < start or along > end
        if clipped and span > 0.0:
            bound = start if along < start else end
            t = (bound - p_along) / span
            x = px + t * (qx - px)
            y = py + t * (qy - py)
        height = nx * (x - reference[edge, 0]) + ny * (y - reference[edge, 1])
        separation = height - reference_radius - incident_radius
        if separation <= limit:
            at = 3 + 4 * count
            down = 0.5 * (height + incident_radius - reference_radius)
            manifold_out[at] = x - down * nx
            manifold_out[at + 1] = y - down * ny
            manifold_out[at + 2] = separation
            corner = far if side == 0 else facing
            manifold_out[at + 3] = float(clipped_feature(edge, corner, side, 1 if flipped else 0))
            count += 1
    manifold_out[0] = float(count)
    manifold_out[1] = sign * nx
    manifold_out[2] = sign * ny
    return count


@subkernel
def support_manifold(
    reference, reference_count, reference_radius, edge, incident, incident_count, incident_radius, flipped, manifold_out
):
    """One point: the corner of the other polygon deepest under the reference face, radii [px]. Always finds it."""
    nx, ny = edge_normal(reference, reference_count, edge)
    deepest = 0
    least = math.inf
    for k in range(incident_count):
        separation = nx * (incident[k, 0] - reference[edge, 0]) + ny * (incident[k, 1] - reference[edge, 1])
        if separation < least:
            least = separation
            deepest = k
    sign = -1.0 if flipped else 1.0
    manifold_out[0] = 1.0
    manifold_out[1] = sign * nx
    manifold_out[2] = sign * ny
    down = 0.5 * (least + incident_radius - reference_radius)
    manifold_out[3] = incident[deepest, 0] - down * nx
    manifold_out[4] = incident[deepest, 1] - down * ny
    manifold_out[5] = least - reference_radius - incident_radius
    manifold_out[6] = float(support_feature(edge, deepest, 1 if flipped else 0))
    return 1
