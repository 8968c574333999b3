"""Collision of convex hulls, rounded or not, and circles: separating axis test, clipping, feature ids."""

import math
from typing import NamedTuple

import numpy as np

from physics.distance.gjk import support
from physics.jit import subkernel
from physics.math2d import clamp, norm, unit
from physics.shapes.placement import box_corners
from physics.tables.shape import TURNS

# ---- features --------------------------------------------------------------------------------------------------------
# Feature ids: they identify a manifold point in the next step.
#
# A feature is an integer that encodes the hull edge, corner, tile, link or pixel of a point. It is the same in the next
# step as long as the same parts touch, independent of the poses. A point starts with the impulses of the point that had
# the same feature in the last step (warm start). "Support" is the deepest corner under a face. All collision functions
# use the same numbers:
#
#     hulls, a face     ((edge * 16 + corner) * 2 + side) * 2 + flipped           0 .. 1023
#     hulls, a support  (edge * 16 + corner) * 4 + flipped                        0 .. 1023
#     hulls, corners    CORNERS + corner of A * 16 + corner of B               2048 .. 2303
#     a link's open end OPEN_END + end                                         3000 .. 3001
#     a disc            the edge, or CIRCLE_CORNER + corner                       0 .. 47
#     tiles, links      first cell of the run, or link * PART + one of the above
#     masks             the pixel: row * width + column

CIRCLE_CORNER = 32  # a disc on a corner, + the corner's number
CORNERS = 2048  # two corners of hulls, + i * 16 + j
OPEN_END = 3000  # the face across an open end of a chain, + 0 at a or 1 at b
FLAT = math.cos(math.radians(6.0))  # least cosine between the normals of two hull edges that may lie on each other
PART = 4096  # number of feature ids of one tile run or one link


@subkernel
def clipped_feature(edge, corner, side, flipped):
    """Return the feature id of a point of the incident edge after clipping to the reference edge.

    edge: index of the reference edge; corner: index of the incident edge's corner; side: end of the incident edge, 0 or
    1; flipped: 1 if the reference polygon is B, else 0.
    """
    return ((edge * 16 + corner) * 2 + side) * 2 + flipped


@subkernel
def support_feature(edge, corner, flipped):
    """Return the feature id of the corner deepest under a reference edge. flipped: 1 if the edge is of B, else 0."""
    return (edge * 16 + corner) * 4 + flipped


@subkernel
def corners_feature(i, j):
    """Return the feature id of a contact between corner i of A and corner j of B."""
    return CORNERS + i * 16 + j


@subkernel
def part_feature(part, feature):
    """Return the feature id of a contact with one part of a tile grid or chain.

    part: index of a link, or of the first cell of a run of tiles; feature: feature id within this part.
    """
    return part * PART + feature


@subkernel
def part_of(feature):
    """Return the part that a feature id names: index of a link, or of a run's first cell (inverse of part_feature)."""
    return feature // PART


@subkernel
def pixel_feature(row, column, width):
    """Return the feature id of the mask pixel at (row, column). width [px]: width of the mask."""
    return row * width + column


# ---- clipping --------------------------------------------------------------------------------------------------------
# Separating axis test of convex polygons, with a manifold of at most two points by clipping.
#
# Corners go clockwise on the screen (y down), so the outward normal of the edge from p to q is (dy, -dx):
#
#         0 ---e0--- 1
#         |          |
#         e3         e1          normal of e0 = (0, -1): up
#         |          |
#         3 ---e2--- 2
#
# Source: Gregorius, The Separating Axis Test, GDC 2013; Catto, Contact Manifolds, GDC 2007.

ANGLE_STEP = 1.0 / TURNS  # [rad]
# Before a manifold is stored as a CONTACT row, it is an array of 11 floats: number of points, normal x and y, then for
# each of two points x, y, separation, feature.
COVERED_OVERLAP = -1.0  # in place of the number of points: the hulls overlap, and a neighbour covers the nearer edges
# Hull edges and corners are touchable if no neighbouring part or tile covers them. Bits: low 16, touchable edges; next
# 16, touchable corners; higher bits, as in `inner` of SHAPE.
ALL_EDGES = 0xFFFFFFFF


class Hull(NamedTuple):
    """A convex hull with rounded corners: a disc if it has one corner, a line segment or capsule if it has two."""

    corners: np.ndarray  # (16, 4) corners [px], clockwise on the screen, and edge normals: see write_normals
    count: int  # number of corners
    radius: float  # [px] rounding: the surface is this far outside the polygon of the corners
    edges: int  # bits of the touchable edges and corners, see ALL_EDGES


@subkernel
def edge_normal(corners, count, k):
    """Return the outward unit normal of hull edge k; (0, -1) if the edge has no length. count: number of corners."""
    n = k + 1 if k + 1 < count else 0
    dx = corners[n, 0] - corners[k, 0]
    dy = corners[n, 1] - corners[k, 1]
    length = math.sqrt(dx * dx + dy * dy)
    if length == 0.0:
        return 0.0, -1.0
    return dy / length, -dx / length


@subkernel
def write_normals(count, corners_inout):
    """Write the outward unit normal of each hull edge to the row of the edge's first corner. O(count).

    count: number of corners; corners_inout (16, 4): columns 0 and 1 are the corners [px], columns 2 and 3 receive the
    normals. Tests of many edges read them from there, because a square root and two divisions take longer than the
    test.
    """
    for k in range(count):
        nx, ny = edge_normal(corners_inout, count, k)
        corners_inout[k, 2] = nx
        corners_inout[k, 3] = ny


@subkernel
def middle_of(corners, count):
    """Return the mean (x, y) [px] of the first `count` corners."""
    x, y = 0.0, 0.0
    for k in range(count):
        x += corners[k, 0] / count
        y += corners[k, 1] / count
    return x, y


@subkernel
def is_normal_at_corner(corners, count, edges, corner, nx, ny):
    """Return whether the unit direction (nx, ny) is a valid contact normal at a corner of a hull.

    No normal is valid at a corner that is not touchable (covered by a neighbouring part of the same shape). Some
    corners have only one edge on the outline of the whole shape. There, the normal must be near the normal of this
    edge; the largest angle is stored in `edges`. At other corners every normal is valid. corner: index of the corner;
    edges: bits, see ALL_EDGES; count: number of corners.
    """
    if (edges >> (16 + corner)) & 1 == 0:
        return False
    if (edges >> (32 + corner)) & 1 == 0:
        return True
    least = math.cos((edges >> 48) * ANGLE_STEP)
    for back in range(2):
        side = corner if back == 0 else (corner - 1 if corner > 0 else count - 1)
        if (edges >> side) & 1:
            own_x, own_y = edge_normal(corners, count, side)
            return nx * own_x + ny * own_y >= least
    return False


@subkernel
def find_max_separation(corners, count, allowed, other, other_count):
    """Find the edge of a polygon along whose normal another polygon is farthest away (separating axis test).

    Return (edge or -1, greatest separation over the allowed edges, greatest separation over all edges) [px]. The edge
    is the allowed one with the greatest separation; -1 if none is allowed. corners (16, 4) [px]: with normals, see
    write_normals; other (16, any) [px]: corners of the other polygon; count, other_count: numbers of corners; allowed:
    bit k is set if edge k may be returned. O(count · other_count).
    """
    best = -1
    best_separation = -math.inf
    overall = -math.inf
    for k in range(count):
        x, y, nx, ny = corners[k, 0], corners[k, 1], corners[k, 2], corners[k, 3]
        least = math.inf
        for i in range(other_count):
            least = min(least, nx * (other[i, 0] - x) + ny * (other[i, 1] - y))
        overall = max(overall, least)
        if (allowed >> k) & 1 and least > best_separation:
            best = k
            best_separation = least
    return best, best_separation, overall


@subkernel
def clip_edges(reference, edge, incident, limit, flipped, manifold_out):
    """Write the manifold of an edge of the Hull `reference` and the opposite edge of the Hull `incident`.

    The opposite edge is clipped to the reference edge. Return the number of points. Both Hulls need edge normals, see
    write_normals. edge: index of the reference edge; limit [px]: points with a larger separation are dropped; flipped:
    True if `reference` is B, so that the normal is inverted. manifold_out (11,) float64: number of points, normal x and
    y from A to B, then x, y, separation [px] and feature id of each of two points.
    """
    corners, count, radius, _ = reference
    others, other_count, other_radius, _ = incident
    following = edge + 1 if edge + 1 < count else 0
    nx, ny = corners[edge, 2], corners[edge, 3]
    facing = 0
    most = math.inf
    for k in range(other_count):
        along = others[k, 2] * nx + others[k, 3] * ny
        if along < most:
            most = along
            facing = k
    far = facing + 1 if facing + 1 < other_count else 0
    tx, ty = -ny, nx
    start = tx * corners[edge, 0] + ty * corners[edge, 1]
    end = tx * corners[following, 0] + ty * corners[following, 1]
    # The direction of the incident edge is opposite to the direction of the reference edge.
    px = others[far, 0]
    py = others[far, 1]
    qx = others[facing, 0]
    qy = others[facing, 1]
    p_along, q_along = tx * px + ty * py, tx * qx + ty * qy
    span = q_along - p_along
    found = 0
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
            x, y = px + t * (qx - px), py + t * (qy - py)
        height = nx * (x - corners[edge, 0]) + ny * (y - corners[edge, 1])
        separation = height - radius - other_radius
        if separation <= limit:
            at = 3 + 4 * found
            down = 0.5 * (height + other_radius - radius)
            manifold_out[at] = x - down * nx
            manifold_out[at + 1] = y - down * ny
            manifold_out[at + 2] = separation
            corner = far if side == 0 else facing
            manifold_out[at + 3] = float(clipped_feature(edge, corner, side, 1 if flipped else 0))
            found += 1
    manifold_out[0] = float(found)
    manifold_out[1] = sign * nx
    manifold_out[2] = sign * ny
    return found


@subkernel
def support_manifold(reference, edge, incident, flipped, manifold_out):
    """Write a manifold of one point: the corner of the Hull `incident` that is deepest under an edge of `reference`.

    Return 1, the number of points. edge: index of this edge; flipped, manifold_out: as in clip_edges.
    """
    corners, _, radius, _ = reference
    others, other_count, other_radius, _ = incident
    nx, ny = corners[edge, 2], corners[edge, 3]
    deepest = 0
    least = math.inf
    for k in range(other_count):
        separation = nx * (others[k, 0] - corners[edge, 0]) + ny * (others[k, 1] - corners[edge, 1])
        if separation < least:
            least = separation
            deepest = k
    sign = -1.0 if flipped else 1.0
    manifold_out[0] = 1.0
    manifold_out[1] = sign * nx
    manifold_out[2] = sign * ny
    down = 0.5 * (least + other_radius - radius)
    manifold_out[3] = others[deepest, 0] - down * nx
    manifold_out[4] = others[deepest, 1] - down * ny
    manifold_out[5] = least - radius - other_radius
    manifold_out[6] = float(support_feature(edge, deepest, 1 if flipped else 0))
    return 1


# ---- circles ---------------------------------------------------------------------------------------------------------
# Circles against convex polygons, in closed form.

COVERED = -1  # in place of a feature id: the centre of the disc is inside, and no edge is touchable


@subkernel
def collide_polygon_circle(corners, count, edges, x, y, radius):
    """Collide a convex polygon with a disc. Return (found, nx, ny, px, py, separation, feature); lengths in px.

    found: whether there is a contact; nx, ny: unit normal to the disc; px, py: contact point, midway between the
    surfaces. edges: bits of the edges and corners that are touchable (not covered by a neighbouring part), see
    ALL_EDGES. If the nearest edge or corner is not touchable, nothing is found, because the neighbouring part reports
    the contact. If the centre of the disc is inside, the nearest touchable edge is used; without such an edge, feature
    is COVERED. O(count).
    """
    best = -1
    inner = -1
    best_separation = -math.inf
    inner_separation = -math.inf
    for k in range(count):
        nx, ny = edge_normal(corners, count, k)
        separation = nx * (x - corners[k, 0]) + ny * (y - corners[k, 1])
        if separation > best_separation:
            best_separation = separation
            best = k
        if (edges >> k) & 1 and separation > inner_separation:
            inner_separation = separation
            inner = k
    if best_separation <= 0.0:
        best = inner
        best_separation = inner_separation
        if best < 0:
            return False, 0.0, -1.0, x, y, 0.0, COVERED
    nx, ny = edge_normal(corners, count, best)
    if best_separation > 0.0:
        following = best + 1 if best + 1 < count else 0
        ex = corners[following, 0] - corners[best, 0]
        ey = corners[following, 1] - corners[best, 1]
        from_start = ex * (x - corners[best, 0]) + ey * (y - corners[best, 1])
        from_end = ex * (x - corners[following, 0]) + ey * (y - corners[following, 1])
        # Exactly over a corner the face is used, because one of two tiles that share a covered corner must report it.
        if from_start < 0.0 or from_end > 0.0:
            corner = best if from_start < 0.0 else following
            dx = x - corners[corner, 0]
            dy = y - corners[corner, 1]
            distance = norm(dx, dy)
            nx, ny = unit(dx, dy, nx, ny)
            if not is_normal_at_corner(corners, count, edges, corner, nx, ny):
                return False, 0.0, -1.0, x, y, 0.0, 0
            separation = distance - radius
            along = 0.5 * separation
            return (
                True,
                nx,
                ny,
                corners[corner, 0] + along * nx,
                corners[corner, 1] + along * ny,
                separation,
                CIRCLE_CORNER + corner,
            )
        if not (edges >> best) & 1:
            return False, 0.0, -1.0, x, y, 0.0, 0
    separation = best_separation - radius
    along = best_separation - 0.5 * separation
    return True, nx, ny, x - along * nx, y - along * ny, separation, best


# ---- aabbs -----------------------------------------------------------------------------------------------------------
# Collision of axis-aligned boxes that never rotate (shapes of kind BOUNDS), from the AABBs in the shape table.
#
# Points, separations and features are equal to the results of collide_hulls for the same boxes.


@subkernel
def aabb_corners(shape, corners_out):
    """Write the 4 corners [px] of a SHAPE row's AABB, clockwise on the screen from the top left. Return 4."""
    return box_corners(shape.min_x, shape.min_y, shape.max_x, shape.max_y, corners_out)


@subkernel
def move_corners(count, x, y, corners_inout):
    """Translate the first `count` corners by (x, y) [px]."""
    for k in range(count):
        corners_inout[k, 0] += x
        corners_inout[k, 1] += y


@subkernel
def collide_aabb_corners(a, b, margin, manifold_out):
    """Write a manifold of one point between the nearest corners of two AABBs that are separated along both axes.

    Return the number of points; 0 if the corners are farther apart than `margin` [px]. a, b: SHAPE rows; manifold_out
    (11,): format in clip_edges.
    """
    right = b.min_x > a.max_x
    below = b.min_y > a.max_y
    ax = a.max_x if right else a.min_x
    ay = a.max_y if below else a.min_y
    dx = (b.min_x if right else b.max_x) - ax
    dy = (b.min_y if below else b.max_y) - ay
    distance = norm(dx, dy)
    if distance > margin:
        return 0
    nx, ny = unit(dx, dy, 0.0, -1.0)
    i = (2 if right else 3) if below else (1 if right else 0)
    manifold_out[0] = 1.0
    manifold_out[1] = nx
    manifold_out[2] = ny
    manifold_out[3] = ax + 0.5 * distance * nx
    manifold_out[4] = ay + 0.5 * distance * ny
    manifold_out[5] = distance
    manifold_out[6] = float(corners_feature(i, (i + 2) % 4))
    return 1


@subkernel
def collide_aabbs(a, b, margin, manifold_out):
    """Write the manifold of the AABBs of two SHAPE rows. Return the number of points.

    The number is 0 if the separation exceeds `margin` [px]. manifold_out (11,): format in clip_edges.
    """
    up = a.min_y - b.max_y
    right = b.min_x - a.max_x
    down = b.min_y - a.max_y
    left = a.min_x - b.max_x
    manifold_out[0] = 0.0
    edge = 0
    separation = up
    if right > separation:
        edge = 1
        separation = right
    if down > separation:
        edge = 2
        separation = down
    if left > separation:
        edge = 3
        separation = left
    if separation > margin:
        return 0
    if max(up, down) > 0.0 and max(left, right) > 0.0:
        return collide_aabb_corners(a, b, margin, manifold_out)
    manifold_out[0] = 2.0
    manifold_out[5] = separation
    manifold_out[9] = separation
    half = 0.5 * separation
    if edge == 0 or edge == 2:
        y = a.min_y - half if edge == 0 else a.max_y + half
        manifold_out[1] = 0.0
        manifold_out[2] = -1.0 if edge == 0 else 1.0
        manifold_out[3] = clamp(b.min_x if edge == 0 else b.max_x, a.min_x, a.max_x)
        manifold_out[4] = y
        manifold_out[7] = clamp(b.max_x if edge == 0 else b.min_x, a.min_x, a.max_x)
        manifold_out[8] = y
    else:
        x = a.min_x - half if edge == 3 else a.max_x + half
        manifold_out[1] = -1.0 if edge == 3 else 1.0
        manifold_out[2] = 0.0
        manifold_out[3] = x
        manifold_out[4] = clamp(b.min_y if edge == 1 else b.max_y, a.min_y, a.max_y)
        manifold_out[7] = x
        manifold_out[8] = clamp(b.max_y if edge == 1 else b.min_y, a.min_y, a.max_y)
    manifold_out[6] = float(clipped_feature(edge, (edge + 3) % 4, 0, 0))
    manifold_out[10] = float(clipped_feature(edge, (edge + 2) % 4, 1, 0))
    return 2


# ---- hulls -----------------------------------------------------------------------------------------------------------
# Collision of rounded convex hulls: separating axis test and clipping of the cores, the polygons without rounding. The
# radii are added afterwards.
#
# A hull of two corners (capsule, segment) is a polygon with two opposite edges. While the cores overlap, the axis of
# least penetration is a face normal, and both radii are added. While the cores are apart, the nearest features
# determine the contact: a face and the corners over it or, if nothing is over the faces, two corners. Then the distance
# of the corners minus the radii is exact.
#
# Degenerate cases have one result each. Of faces with equal separation the first face of A is used. Cores that cross
# without depth (a segment on another segment's line) push along this face's normal. Coincident corners push along (0,
# -1).


@subkernel
def nearest_on_edge(ax, ay, bx, by, x, y):
    """Return the parameter t, 0 to 1, of the point of the line segment from a to b that is nearest to (x, y).

    The point is a + t (b - a). ax, ay, bx, by: ends of the segment.
    """
    ex, ey = bx - ax, by - ay
    along = ex * (x - ax) + ey * (y - ay)
    square = ex * ex + ey * ey
    if along <= 0.0 or square == 0.0:
        return 0.0
    return min(1.0, along / square)


@subkernel
def distance_to_edge(ax, ay, bx, by, x, y):
    """Return the distance [px] of the point (x, y) from the line segment from (ax, ay) to (bx, by)."""
    t = nearest_on_edge(ax, ay, bx, by, x, y)
    return norm(x - ax - t * (bx - ax), y - ay - t * (by - ay))


@subkernel
def same_side(a, b):
    """Return 1.0 if both ends of segment a are on the same side of the line through segment b.

    Return -1.0 if the ends are on opposite sides, and 0.0 if an end is on the line. a, b (2, 2) [px]: ends of the
    segments.
    """
    ex = b[1, 0] - b[0, 0]
    ey = b[1, 1] - b[0, 1]
    first = ex * (a[0, 1] - b[0, 1]) - ey * (a[0, 0] - b[0, 0])
    second = ex * (a[1, 1] - b[0, 1]) - ey * (a[1, 0] - b[0, 0])
    if first == 0.0 or second == 0.0:
        return 0.0
    return 1.0 if (first > 0.0) == (second > 0.0) else -1.0


@subkernel
def segment_distance(a, b):
    """Return the distance [px] of two line segments; 0 if they cross. a, b (2, 2) [px]: ends of the segments.

    It supplements the separating axis test, whose face normals cannot separate two segments on one line.
    """
    if same_side(a, b) < 0.0 and same_side(b, a) < 0.0:
        return 0.0
    gap = min(
        distance_to_edge(a[0, 0], a[0, 1], a[1, 0], a[1, 1], b[0, 0], b[0, 1]),
        distance_to_edge(a[0, 0], a[0, 1], a[1, 0], a[1, 1], b[1, 0], b[1, 1]),
    )
    return min(
        gap,
        min(
            distance_to_edge(b[0, 0], b[0, 1], b[1, 0], b[1, 1], a[0, 0], a[0, 1]),
            distance_to_edge(b[0, 0], b[0, 1], b[1, 0], b[1, 1], a[1, 0], a[1, 1]),
        ),
    )


@subkernel
def nearest_corners(a, a_count, b, b_count):
    """Return (corner of A, corner of B, distance [px]) for the two nearest corners of polygons A and B.

    The corners are returned as indices. a, b: corner arrays; a_count, b_count: numbers of corners. O(a_count ·
    b_count).
    """
    best = math.inf
    best_i, best_j = 0, 0
    for i in range(a_count):
        for j in range(b_count):
            distance = norm(b[j, 0] - a[i, 0], b[j, 1] - a[i, 1])
            if distance < best:
                best = distance
                best_i, best_j = i, j
    return best_i, best_j, best


@subkernel
def corner_manifold(a, i, b, j, limit, manifold_out):
    """Write a manifold of one point between corner i of Hull A and corner j of Hull B. Return the number of points.

    The number is 0 if the separation exceeds `limit` [px]. manifold_out (11,): format in clip_edges.
    """
    x = a.corners[i, 0]
    y = a.corners[i, 1]
    dx = b.corners[j, 0] - x
    dy = b.corners[j, 1] - y
    nx, ny = unit(dx, dy, 0.0, -1.0)
    distance = norm(dx, dy)
    manifold_out[0] = 0.0
    if distance - a.radius - b.radius > limit:
        return 0
    along = 0.5 * (distance + a.radius - b.radius)
    manifold_out[0] = 1.0
    manifold_out[1] = nx
    manifold_out[2] = ny
    manifold_out[3] = x + along * nx
    manifold_out[4] = y + along * ny
    manifold_out[5] = distance - a.radius - b.radius
    manifold_out[6] = float(corners_feature(i, j))
    return 1


@subkernel
def ends_face(corners, count, edges, corner, nx, ny):
    """Return whether a corner is an end of a touchable edge whose normal is within 6 degrees of (nx, ny).

    corners, count: the polygon; corner: index of the corner; edges: bits of the edges and corners that are touchable
    (not covered by a neighbouring part), see ALL_EDGES; nx, ny: unit vector.
    """
    for back in range(2):
        side = corner if back == 0 else (corner - 1 if corner > 0 else count - 1)
        if (edges >> side) & 1:
            own_x, own_y = edge_normal(corners, count, side)
            if nx * own_x + ny * own_y >= FLAT:
                return True
    return False


@subkernel
def is_over(corners, count, edge, x, y):
    """Return whether the projection of the point (x, y) onto an edge of a polygon is between the edge's ends."""
    following = edge + 1 if edge + 1 < count else 0
    dx = corners[following, 0] - corners[edge, 0]
    dy = corners[following, 1] - corners[edge, 1]
    along = dx * (x - corners[edge, 0]) + dy * (y - corners[edge, 1])
    return 0.0 <= along <= dx * dx + dy * dy


@subkernel
def pushing_edges(a, b, over_ends):
    """Return bits of the edges of Hull A whose normals may push A out of Hull B. B is a part of a larger outline.

    An edge may push if its inverted normal is valid at the corner of B that faces it, see is_normal_at_corner.
    over_ends: True to include also edges of A that are nearly parallel to a touchable edge of B and over one of its
    ends. All bits of corners are set in the result, see ALL_EDGES.
    """
    if b.edges == ALL_EDGES:
        return ALL_EDGES
    found = 0xFFFF0000
    for k in range(a.count):
        nx, ny = edge_normal(a.corners, a.count, k)
        corner = support(b.corners, b.count, -nx, -ny)
        if is_normal_at_corner(b.corners, b.count, b.edges, corner, -nx, -ny):
            found |= 1 << k
        elif over_ends and is_over(a.corners, a.count, k, b.corners[corner, 0], b.corners[corner, 1]):
            if ends_face(b.corners, b.count, b.edges, corner, -nx, -ny):
                found |= 1 << k
    return found


@subkernel
def overlaps_edge(hull, edge, other):
    """Return whether an edge (index) of `hull` and the Hull `other` overlap if projected onto the edge's line."""
    corners = hull.corners
    others = other.corners
    following = edge + 1 if edge + 1 < hull.count else 0
    x = corners[edge, 0]
    y = corners[edge, 1]
    dx = corners[following, 0] - x
    dy = corners[following, 1] - y
    low, high = math.inf, -math.inf
    for k in range(other.count):
        along = dx * (others[k, 0] - x) + dy * (others[k, 1] - y)
        low, high = min(low, along), max(high, along)
    return high > 0.0 and low < dx * dx + dy * dy


@subkernel
def clip_tolerance(corners, count, edge):
    """Return the allowed rounding error [px] of a point that was clipped to edge number `edge` of a hull."""
    n = edge + 1 if edge + 1 < count else 0
    ex = abs(corners[n, 0] - corners[edge, 0]) + abs(corners[n, 1] - corners[edge, 1])
    return 1e-9 * ex + 1e-15 * (abs(corners[edge, 0]) + abs(corners[edge, 1]))


@subkernel
def least_separation(count, manifold):
    """Return the least separation [px] of a manifold's points; infinite without points.

    count: number of points; manifold (11,): format in clip_edges.
    """
    if count == 0:
        return math.inf
    return min(manifold[5], manifold[9]) if count > 1 else manifold[5]


@subkernel
def extent_along(corners, count, nx, ny):
    """Return (least, greatest) projection [px] of the first `count` corners onto the unit vector (nx, ny)."""
    low, high = math.inf, -math.inf
    for k in range(count):
        low = min(low, nx * corners[k, 0] + ny * corners[k, 1])
        high = max(high, nx * corners[k, 0] + ny * corners[k, 1])
    return low, high


@subkernel
def path_misses(a, b, allowed, vx, vy):
    """Return whether Hull B, moving in the direction (vx, vy), never overlaps Hull A by more than `allowed` [px].

    If so, the caller drops the predicted contact: its normal, fixed for the whole step, would deflect B.
    """
    nx, ny = unit(-vy, vx, 0.0, 0.0)
    low, high = extent_along(a.corners, a.count, nx, ny)
    least, most = extent_along(b.corners, b.count, nx, ny)
    gap = a.radius + b.radius - allowed
    return least - high > gap or low - most > gap


@subkernel
def collide_hulls(a, b, margin, bias, deepest, manifold_out):
    """Write the manifold of two Hulls of two or more corners each (SAT, clipping). Return the number of points.

    margin [px]: a larger separation gives no points. bias [px]: B has the reference face only if its greatest face
    separation exceeds A's greatest face separation by more than `bias`. So the reference does not alternate between
    equal faces. deepest [px]: an overlap deeper than this gives no points if a neighbouring part covers an edge behind
    which the overlap is less deep. Then manifold_out[0] is COVERED_OVERLAP. Both Hulls need edge normals, see
    write_normals. manifold_out (11,): format in clip_edges. O(corners of A · corners of B).
    """
    a_corners, a_count, a_radius, a_edges = a
    b_corners, b_count, b_radius, b_edges = b
    rounding = a_radius + b_radius
    manifold_out[0] = 0.0
    a_edge, a_separation, a_all = find_max_separation(a_corners, a_count, a_edges, b_corners, b_count)
    if a_all > margin + rounding:
        return 0
    b_edge, b_separation, b_all = find_max_separation(b_corners, b_count, b_edges, a_corners, a_count)
    if b_all > margin + rounding:
        return 0
    covered = COVERED_OVERLAP if max(a_all, b_all) < 0.0 else 0.0
    if a_edge < 0 and b_edge < 0:
        manifold_out[0] = covered
        return 0
    apart = max(a_all, b_all) > 0.0
    if a_count == 2 and b_count == 2 and not apart:
        apart = segment_distance(a_corners, b_corners) > 0.0
    allowed = max(a_separation, b_separation)
    if -allowed > deepest and max(a_all, b_all) > allowed:
        manifold_out[0] = covered
        return 0
    from_b = b_edge >= 0 and (a_edge < 0 or b_separation > a_separation + bias)
    if (
        not apart
        and max(a_all, b_all) > allowed
        and not (overlaps_edge(b, b_edge, a) if from_b else overlaps_edge(a, a_edge, b))
    ):
        # A neighbour covers the nearer face, and the other hull is not over the touchable face.
        manifold_out[0] = covered
        return 0
    for attempt in range(2):
        flipped = from_b if attempt == 0 else not from_b
        if (b_edge if flipped else a_edge) < 0:
            continue
        if flipped:
            count = clip_edges(b, b_edge, a, margin, True, manifold_out)
            own = b_separation
            slack = clip_tolerance(b_corners, b_count, b_edge)
        else:
            count = clip_edges(a, a_edge, b, margin, False, manifold_out)
            own = a_separation
            slack = clip_tolerance(a_corners, a_count, a_edge)
        least = least_separation(count, manifold_out)
        if apart and own < -slack:
            continue  # an edge that is not touchable separates the hulls: nothing is over this face
        if not apart:
            if least > -rounding:
                if flipped:
                    return support_manifold(b, b_edge, a, True, manifold_out)
                return support_manifold(a, a_edge, b, False, manifold_out)
            return count
        # If a point is over this face, no feature is nearer. If two sharp faces lie on each other, both are valid.
        if rounding == 0.0 and abs(a_separation - b_separation) <= bias:
            slack = max(bias, slack)
        if count > 0 and least <= own - rounding + slack:
            return count
    i, j, _ = nearest_corners(a_corners, a_count, b_corners, b_count)
    manifold_out[0] = 0.0
    nx, ny = unit(b_corners[j, 0] - a_corners[i, 0], b_corners[j, 1] - a_corners[i, 1], 0.0, -1.0)
    if not is_normal_at_corner(a_corners, a_count, a_edges, i, nx, ny):
        return 0
    if not is_normal_at_corner(b_corners, b_count, b_edges, j, -nx, -ny):
        return 0
    return corner_manifold(a, i, b, j, margin, manifold_out)


@subkernel
def collide_line_circle(ax, ay, bx, by, x, y, radius):
    """Collide a line segment with a disc. Return (nx, ny, px, py, separation, feature); lengths in px.

    nx, ny: unit normal to the disc; px, py: nearest point of the segment. The segment leads from (ax, ay) to (bx, by).
    feature: 0 or 1 for a side of the segment, CIRCLE_CORNER for its start, CIRCLE_CORNER + 1 for its end. If the centre
    of the disc is on the segment, the normal of side 0 is used.
    """
    t = nearest_on_edge(ax, ay, bx, by, x, y)
    px, py = ax + t * (bx - ax), ay + t * (by - ay)
    if t == 1.0:
        px, py = bx, by
    side_x, side_y = unit(by - ay, ax - bx, 0.0, -1.0)
    height = side_x * (x - ax) + side_y * (y - ay)
    if 0.0 < t < 1.0:
        # The line's own normal is used, so that rounding of the nearest point does not rotate the result.
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
    return nx, ny, px, py, norm(x - px, y - py) - radius, CIRCLE_CORNER if t == 0.0 else CIRCLE_CORNER + 1


@subkernel
def collide_hull_circle(hull, x, y, radius):
    """Collide a Hull of two or more corners with a disc. Return (found, nx, ny, px, py, separation, feature).

    found: whether there is a contact; nx, ny: unit normal from hull to disc; px, py [px]: contact point, midway between
    the surfaces. x, y, radius [px]: centre and radius of the disc. If the disc's centre is inside the Hull, or the
    nearest edge or corner is covered by a neighbouring part, the result is as in collide_polygon_circle.
    """
    corners = hull.corners
    rounding = hull.radius
    if hull.count == 2:
        nx, ny, px, py, separation, feature = collide_line_circle(
            corners[0, 0], corners[0, 1], corners[1, 0], corners[1, 1], x, y, rounding + radius
        )
        along = rounding + 0.5 * separation
        return True, nx, ny, px + along * nx, py + along * ny, separation, feature
    hit, nx, ny, px, py, separation, feature = collide_polygon_circle(
        corners, hull.count, hull.edges, x, y, rounding + radius
    )
    return hit, nx, ny, px + rounding * nx, py + rounding * ny, separation, feature
