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

from physics.jit import subkernel
from physics.math2d import length_of, unit

# A manifold in flight is a row of 11 floats: count, normal, and twice (point, separation, feature).
MANIFOLD = 11
LEFT_OUT = -1.0            # as the count: they overlap, but a neighbouring tile is expected to tell
ALL_EDGES = 0xFFFFFFFF       # low 16 bits: edges that may be touched; high 16: edges whose corners may be


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
def clip_edges(reference, reference_count, edge, incident, incident_count, limit, flipped, manifold_out):
    """Manifold of a reference face and the edge of the other polygon that faces it most.

    limit [px]: points further apart are dropped; flipped: the reference belongs to B, so the normal is turned round.
    manifold_out: see MANIFOLD. Feature: bits of reference edge, incident corner, side. Returns the number of points.
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
        separation = nx * (x - reference[edge, 0]) + ny * (y - reference[edge, 1])
        if separation <= limit:
            at = 3 + 4 * count
            manifold_out[at] = x - 0.5 * separation * nx
            manifold_out[at + 1] = y - 0.5 * separation * ny
            manifold_out[at + 2] = separation
            manifold_out[at + 3] = float(((edge * 16 + (far if side == 0 else facing)) * 2 + side) * 2
                                         + (1 if flipped else 0))
            count += 1
    manifold_out[0] = float(count)
    manifold_out[1] = sign * nx
    manifold_out[2] = sign * ny
    return count


@subkernel
def support_manifold(reference, reference_count, edge, incident, incident_count, flipped, manifold_out):
    """One point: the corner of the other polygon deepest under the reference face. Always finds it."""
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
    manifold_out[3] = incident[deepest, 0] - 0.5 * least * nx
    manifold_out[4] = incident[deepest, 1] - 0.5 * least * ny
    manifold_out[5] = least
    manifold_out[6] = float((edge * 16 + deepest) * 4 + (1 if flipped else 0))
    return 1


@subkernel
def corner_manifold(a, a_count, b, b_count, limit, manifold_out):
    """One point between the two nearest corners of polygons that are apart, when they are within the limit [px]."""
    best = math.inf
    best_i = 0
    best_j = 0
    for i in range(a_count):
        for j in range(b_count):
            distance = length_of(b[j, 0] - a[i, 0], b[j, 1] - a[i, 1])
            if distance < best:
                best = distance
                best_i = i
                best_j = j
    if best > limit:
        manifold_out[0] = 0.0
        return 0
    nx, ny = unit(b[best_j, 0] - a[best_i, 0], b[best_j, 1] - a[best_i, 1], 0.0, -1.0)
    manifold_out[0] = 1.0
    manifold_out[1] = nx
    manifold_out[2] = ny
    manifold_out[3] = 0.5 * (a[best_i, 0] + b[best_j, 0])
    manifold_out[4] = 0.5 * (a[best_i, 1] + b[best_j, 1])
    manifold_out[5] = best
    manifold_out[6] = float(2048 + best_i * 16 + best_j)
    return 1


@subkernel
def collide_polygons(a, a_count, a_edges, b, b_count, b_edges, margin, bias, deepest, manifold_out):
    """Manifold of two convex polygons, normal from A to B. Returns the number of points, 0 when apart by > margin.

    a, b: world corners (n, 2) [px]; a_edges, b_edges: bits of the edges that may be touched; bias [px]: how much
    better B's face must separate to be the reference, so that it does not flip between equal faces; deepest [px]: what
    is deeper than that behind every edge that may be touched, and less deep behind one that may not, is left to the
    neighbour that covers it.
    """
    a_edge, a_separation, a_all = best_edge(a, a_count, a_edges, b, b_count)
    if a_all > margin:
        manifold_out[0] = 0.0
        return 0
    b_edge, b_separation, b_all = best_edge(b, b_count, b_edges, a, a_count)
    if b_all > margin or (a_edge < 0 and b_edge < 0):
        manifold_out[0] = 0.0
        return 0
    apart = max(a_all, b_all) > 0.0
    allowed = max(a_separation, b_separation)
    if -allowed > deepest and max(a_all, b_all) > allowed:
        manifold_out[0] = LEFT_OUT
        return 0
    if b_edge >= 0 and b_separation > a_separation + bias:
        count = clip_edges(b, b_count, b_edge, a, a_count, margin, True, manifold_out)
        if not apart and (count == 0 or min(manifold_out[5], manifold_out[9] if count > 1 else math.inf) > 0.0):
            count = support_manifold(b, b_count, b_edge, a, a_count, True, manifold_out)
        if apart and count == 0:
            count = corner_manifold(a, a_count, b, b_count, margin, manifold_out)
        return count
    count = clip_edges(a, a_count, a_edge, b, b_count, margin, False, manifold_out)
    if not apart and (count == 0 or min(manifold_out[5], manifold_out[9] if count > 1 else math.inf) > 0.0):
        count = support_manifold(a, a_count, a_edge, b, b_count, False, manifold_out)
    if apart and count == 0:
        count = corner_manifold(a, a_count, b, b_count, margin, manifold_out)
    return count
