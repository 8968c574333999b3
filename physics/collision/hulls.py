"""Rounded convex hulls against each other: corners by separating axes and clipping, the radii added afterwards.

A hull of two corners (capsule, segment) is a polygon with two edges back to back. While the cores overlap, the least
way out leads across a face and both radii. While they are apart the nearest features decide: a face and what stands
over it, or, where nothing stands over the faces, two corners, whose distance less the radii is exact.

Degenerate cases have one answer each: among faces that push equally the first of A wins; cores that cross without depth
(a segment on a segment's line) push along that face's normal; coincident corners push along (0, -1).
"""

import math

from physics.collision.circles import collide_polygon_circle
from physics.collision.clipping import (
    ALL_EDGES,
    LEFT,
    best_edge,
    clip_edges,
    edge_normal,
    meets_corner,
    support_manifold,
)
from physics.collision.features import CIRCLE_CORNER, corners_feature
from physics.jit import subkernel
from physics.math2d import length_of, unit
from physics.proximity.gjk import support


@subkernel
def nearest_on_edge(ax, ay, bx, by, x, y):
    """How far along from a to b, as a fraction 0..1, the point of the edge that is nearest to (x, y) lies."""
    ex = bx - ax
    ey = by - ay
    along = ex * (x - ax) + ey * (y - ay)
    square = ex * ex + ey * ey
    if along <= 0.0 or square == 0.0:
        return 0.0
    return min(1.0, along / square)


@subkernel
def edge_gap(ax, ay, bx, by, x, y):
    """Distance [px] of a point from an edge."""
    t = nearest_on_edge(ax, ay, bx, by, x, y)
    return length_of(x - ax - t * (bx - ax), y - ay - t * (by - ay))


@subkernel
def sides_of(a, b):
    """On which sides of the line through b[0], b[1] the ends of a lie: negative when on opposite ones, 0 when on it."""
    ex = b[1, 0] - b[0, 0]
    ey = b[1, 1] - b[0, 1]
    first = ex * (a[0, 1] - b[0, 1]) - ey * (a[0, 0] - b[0, 0])
    second = ex * (a[1, 1] - b[0, 1]) - ey * (a[1, 0] - b[0, 0])
    if first == 0.0 or second == 0.0:
        return 0.0
    return 1.0 if (first > 0.0) == (second > 0.0) else -1.0


@subkernel
def segments_gap(a, b):
    """Distance [px] of two hulls of two corners, 0 when they cross: their normals do not part them along their line."""
    if sides_of(a, b) < 0.0 and sides_of(b, a) < 0.0:
        return 0.0
    gap = min(
        edge_gap(a[0, 0], a[0, 1], a[1, 0], a[1, 1], b[0, 0], b[0, 1]),
        edge_gap(a[0, 0], a[0, 1], a[1, 0], a[1, 1], b[1, 0], b[1, 1]),
    )
    return min(
        gap,
        min(
            edge_gap(b[0, 0], b[0, 1], b[1, 0], b[1, 1], a[0, 0], a[0, 1]),
            edge_gap(b[0, 0], b[0, 1], b[1, 0], b[1, 1], a[1, 0], a[1, 1]),
        ),
    )


@subkernel
def nearest_corners(a, a_count, b, b_count):
    """(corner of A, corner of B, distance [px]) of the two nearest corners. O(a_count · b_count)."""
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
    return best_i, best_j, best


@subkernel
def corner_manifold(a, i, a_radius, b, j, b_radius, limit, manifold_out):
    """One point between rounded corners of A and B, when within the limit [px]. Returns the number."""
    dx = b[j, 0] - a[i, 0]
    dy = b[j, 1] - a[i, 1]
    nx, ny = unit(dx, dy, 0.0, -1.0)
    distance = length_of(dx, dy)
    manifold_out[0] = 0.0
    if distance - a_radius - b_radius > limit:
        return 0
    along = 0.5 * (distance + a_radius - b_radius)
    manifold_out[0] = 1.0
    manifold_out[1] = nx
    manifold_out[2] = ny
    manifold_out[3] = a[i, 0] + along * nx
    manifold_out[4] = a[i, 1] + along * ny
    manifold_out[5] = distance - a_radius - b_radius
    manifold_out[6] = float(corners_feature(i, j))
    return 1


@subkernel
def faces_of(a, count, b, b_count, b_edges):
    """The edges of A that may push it out of B: those that meet a corner of B that sticks out.

    b_edges: bits as in collide_hulls. The others meet a corner behind which B's neighbour goes on: it has the surface.
    """
    if b_edges == ALL_EDGES:
        return ALL_EDGES
    found = 0xFFFF0000
    for k in range(count):
        nx, ny = edge_normal(a, count, k)
        if meets_corner(b, b_count, b_edges, support(b, b_count, -nx, -ny), -nx, -ny):
            found |= 1 << k
    return found


@subkernel
def lies_along(corners, count, edge, other, other_count):
    """Whether another polygon lies over an edge: their extents along the edge share more than a point."""
    following = edge + 1 if edge + 1 < count else 0
    x = corners[edge, 0]
    y = corners[edge, 1]
    dx = corners[following, 0] - x
    dy = corners[following, 1] - y
    low = math.inf
    high = -math.inf
    for k in range(other_count):
        along = dx * (other[k, 0] - x) + dy * (other[k, 1] - y)
        low = min(low, along)
        high = max(high, along)
    return high > 0.0 and low < dx * dx + dy * dy


@subkernel
def slack_of(corners, count, edge):
    """By how much [px] rounding may move what is clipped against an edge."""
    n = edge + 1 if edge + 1 < count else 0
    ex = abs(corners[n, 0] - corners[edge, 0]) + abs(corners[n, 1] - corners[edge, 1])
    return 1e-9 * ex + 1e-15 * (abs(corners[edge, 0]) + abs(corners[edge, 1]))


@subkernel
def least_separation(count, manifold):
    """Separation [px] of the deeper point of a manifold; infinite without any."""
    if count == 0:
        return math.inf
    return min(manifold[5], manifold[9]) if count > 1 else manifold[5]


@subkernel
def passes_by(a, a_count, b, b_count, rounding, vx, vy):
    """Whether B, moved along a velocity, never meets A: across its way the two lie apart by more than the radii [px].

    A corner near a corner has one normal for the whole step; what flies past would be turned aside by it.
    """
    nx, ny = unit(-vy, vx, 0.0, 0.0)
    low = math.inf
    high = -math.inf
    for k in range(a_count):
        low = min(low, nx * a[k, 0] + ny * a[k, 1])
        high = max(high, nx * a[k, 0] + ny * a[k, 1])
    least = math.inf
    most = -math.inf
    for k in range(b_count):
        least = min(least, nx * b[k, 0] + ny * b[k, 1])
        most = max(most, nx * b[k, 0] + ny * b[k, 1])
    return least - high > rounding or low - most > rounding


@subkernel
def collide_hulls(a, a_count, a_radius, a_edges, b, b_count, b_radius, b_edges, margin, bias, deepest, manifold_out):
    """Manifold of two hulls of two or more corners, normal from A to B.
    Returns the number of points, 0 when apart by > margin.

    a, b: world corners (n, 2) [px], grown by the radii [px]; a_edges, b_edges: bits of the edges that may be touched;
    bias [px]: how much better B's face must separate to be the reference, so that it does not flip between equal faces;
    deepest [px]: what is deeper than that behind every edge that may be touched, and less deep behind one that may not,
    is left to the neighbour that covers it: then manifold_out[0] is LEFT. O(a_count · b_count).
    """
    rounding = a_radius + b_radius
    manifold_out[0] = 0.0
    a_edge, a_separation, a_all = best_edge(a, a_count, a_edges, b, b_count)
    if a_all > margin + rounding:
        return 0
    b_edge, b_separation, b_all = best_edge(b, b_count, b_edges, a, a_count)
    if b_all > margin + rounding:
        return 0
    if a_edge < 0 and b_edge < 0:
        manifold_out[0] = LEFT if max(a_all, b_all) < 0.0 else 0.0
        return 0
    apart = max(a_all, b_all) > 0.0
    if a_count == 2 and b_count == 2 and not apart:
        apart = segments_gap(a, b) > 0.0
    allowed = max(a_separation, b_separation)
    if -allowed > deepest and max(a_all, b_all) > allowed:
        manifold_out[0] = LEFT if max(a_all, b_all) < 0.0 else 0.0
        return 0
    from_b = b_edge >= 0 and (a_edge < 0 or b_separation > a_separation + bias)
    if (
        not apart
        and max(a_all, b_all) > allowed
        and not (lies_along(b, b_count, b_edge, a, a_count) if from_b else lies_along(a, a_count, a_edge, b, b_count))
    ):
        # A nearer face is a neighbour's, and this one is somewhere else.
        manifold_out[0] = LEFT if max(a_all, b_all) < 0.0 else 0.0
        return 0
    for attempt in range(2):
        flipped = from_b if attempt == 0 else not from_b
        if (b_edge if flipped else a_edge) < 0:
            continue
        if flipped:
            count = clip_edges(b, b_count, b_radius, b_edge, a, a_count, a_radius, margin, True, manifold_out)
            own = b_separation
            slack = slack_of(b, b_count, b_edge)
        else:
            count = clip_edges(a, a_count, a_radius, a_edge, b, b_count, b_radius, margin, False, manifold_out)
            own = a_separation
            slack = slack_of(a, a_count, a_edge)
        least = least_separation(count, manifold_out)
        if apart and own < -slack:
            continue  # parted by a face that may not be touched: nothing stands over this one
        if not apart:
            if least > -rounding:
                if flipped:
                    return support_manifold(b, b_count, b_radius, b_edge, a, a_count, a_radius, True, manifold_out)
                return support_manifold(a, a_count, a_radius, a_edge, b, b_count, b_radius, False, manifold_out)
            return count
        # Something stands over this face: nothing is nearer. Of sharp faces that lie along each other either does.
        if rounding == 0.0 and abs(a_separation - b_separation) <= bias:
            slack = max(bias, slack)
        if count > 0 and least <= own - rounding + slack:
            return count
    i, j, _ = nearest_corners(a, a_count, b, b_count)
    manifold_out[0] = 0.0
    nx, ny = unit(b[j, 0] - a[i, 0], b[j, 1] - a[i, 1], 0.0, -1.0)
    if not meets_corner(a, a_count, a_edges, i, nx, ny) or not meets_corner(b, b_count, b_edges, j, -nx, -ny):
        return 0
    return corner_manifold(a, i, a_radius, b, j, b_radius, margin, manifold_out)


@subkernel
def collide_line_circle(ax, ay, bx, by, x, y, radius):
    """The line from a to b against a disc [px]: (normal to the disc, point of the line, separation, feature).

    Feature: 0 or 1, the side; 32 or 33, the end. A centre on the line takes the normal of its first side.
    """
    t = nearest_on_edge(ax, ay, bx, by, x, y)
    px = ax + t * (bx - ax)
    py = ay + t * (by - ay)
    if t == 1.0:
        px = bx
        py = by
    side_x, side_y = unit(by - ay, ax - bx, 0.0, -1.0)
    height = side_x * (x - ax) + side_y * (y - ay)
    if 0.0 < t < 1.0:
        # Along the line's normal, so that rounding in the nearest point does not turn it.
        sign = -1.0 if height < 0.0 else 1.0
        return (
            sign * side_x,
            sign * side_y,
            x - height * side_x,
            y - height * side_y,
            abs(height) - radius,
            1 if height < 0.0 else 0,
        )
    nx, ny = unit(x - px, y - py, side_x, side_y)
    return nx, ny, px, py, length_of(x - px, y - py) - radius, CIRCLE_CORNER if t == 0.0 else CIRCLE_CORNER + 1


@subkernel
def collide_hull_circle(corners, count, edges, hull_radius, x, y, radius):
    """A hull of two or more corners against a disc [px]: (found, normal from the hull to the disc, point midway,
    separation, feature). See circles.collide_polygon_circle for the edges and for what lies inside."""
    if count == 2:
        nx, ny, px, py, separation, feature = collide_line_circle(
            corners[0, 0], corners[0, 1], corners[1, 0], corners[1, 1], x, y, hull_radius + radius
        )
        along = hull_radius + 0.5 * separation
        return True, nx, ny, px + along * nx, py + along * ny, separation, feature
    hit, nx, ny, px, py, separation, feature = collide_polygon_circle(corners, count, edges, x, y, hull_radius + radius)
    return hit, nx, ny, px + hull_radius * nx, py + hull_radius * ny, separation, feature
