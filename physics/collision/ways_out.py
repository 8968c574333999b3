"""The way out of all the parts that a body stands in at once.

Along a direction a body has left a convex part as soon as one axis of the two parts them, and has left the whole when
it has left every part. What is nearest to one part's edge may lead into the next, all along a rim.
"""

import math

from physics.collision.clipping import ALL_EDGES, clip_edges, edge_normal, support_manifold
from physics.collision.hulls import least_separation
from physics.collision.manifold import add_points, circle_at, corners_of
from physics.jit import kernel, subkernel
from physics.shapes.placement import rounding
from physics.tables.shape import CIRCLE

FACES = 32  # of a pair at most
DIRECTION_X, DIRECTION_Y, DEPTH, MAY_PUSH = range(
    4
)  # of a face: unit, from A to B; how deep the other is behind it [px]
ALONG = 0.5  # cosine of directions that go the same way


@subkernel
def world_hull(batch, row, corners_out):
    """World corners of a hull [px]; of a disc, its centre. Returns (their number, rounding radius [px])."""
    if batch.shapes[row].kind == CIRCLE:
        x, y, radius = circle_at(batch.bodies, batch.shapes, row)
        corners_out[0, 0] = x
        corners_out[0, 1] = y
        return 1, radius
    return corners_of(batch.geometry, batch.bodies, batch.shapes, row, corners_out), rounding(batch.shapes, row)


@subkernel
def write_faces(corners, count, touchable, other, other_count, radii, sign, first, faces_out):
    """Write the faces of a hull as rows from `first` on; a disc has none. Returns the row after them.

    touchable: bits of the edges that may push; sign: 1.0 of A, -1.0 of B.
    """
    if count == 1:
        return first
    for k in range(count):
        nx, ny = edge_normal(corners, count, k)
        least = math.inf
        for i in range(other_count):
            least = min(least, nx * (other[i, 0] - corners[k, 0]) + ny * (other[i, 1] - corners[k, 1]))
        faces_out[first + k, DIRECTION_X] = sign * nx
        faces_out[first + k, DIRECTION_Y] = sign * ny
        faces_out[first + k, DEPTH] = max(0.0, radii - least)
        faces_out[first + k, MAY_PUSH] = float((touchable >> k) & 1)
    return first + count


@subkernel
def way_along(faces, starts, count, nx, ny):
    """How far [px] B has to go along a direction until it has left all of A: O(faces)."""
    longest = 0.0
    for part in range(count):
        shortest = math.inf
        for k in range(starts[part], starts[part + 1]):
            cosine = nx * faces[k, DIRECTION_X] + ny * faces[k, DIRECTION_Y]
            if cosine > 0.0:
                shortest = min(shortest, faces[k, DEPTH] / cosine)
        longest = max(longest, shortest)
    return longest


@subkernel
def shortest_way(faces, starts, count, way_x, way_y):
    """(part, row) of the face that may push along whose direction B leaves all of A soonest; -1, -1 without any.

    Directions that go along (way_x, way_y), a unit vector or 0, come before others. O(faces · faces).
    """
    best = -1
    best_part = -1
    best_along = False
    best_way = math.inf
    for part in range(count):
        for k in range(starts[part], starts[part + 1]):
            if faces[k, MAY_PUSH] == 0.0:
                continue
            nx = faces[k, DIRECTION_X]
            ny = faces[k, DIRECTION_Y]
            along = nx * way_x + ny * way_y > ALONG
            if best_along and not along:
                continue
            way = way_along(faces, starts, count, nx, ny)
            if best < 0 or (along and not best_along) or way < best_way:
                best = k
                best_part = part
                best_along = along
                best_way = way
    return best_part, best


@subkernel
def push_by_face(a, a_count, a_radius, edge, b, b_count, b_radius, flipped, margin, manifold_out):
    """Manifold of hulls that overlap, by edge `edge` of a, however deep. Returns the number of points."""
    count = 0
    if b_count > 1:
        count = clip_edges(a, a_count, a_radius, edge, b, b_count, b_radius, margin, flipped, manifold_out)
    if count == 0 or least_separation(count, manifold_out) > -a_radius - b_radius:
        count = support_manifold(a, a_count, a_radius, edge, b, b_count, b_radius, flipped, manifold_out)
    if b_count == 1:
        manifold_out[6] = float(edge)  # a disc is known by the edge: see features
    return count


@kernel
def lead_out(
    # read
    batch,
    pairs,
    way_x,
    way_y,
    # write
    workspace,
    starts_out,
    faces_out,
    manifolds_out,
):
    """Write the manifold that leads B out of A on the shortest way, of candidates `pairs` of parts of the same two.

    way_x, way_y: the way it has begun to take, or 0. starts_out (pairs + 1,), faces_out (FACES · pairs, 4): scratch.
    Returns the number of manifolds, 0 or 1. O(faces · faces).
    """
    shapes = batch.shapes
    candidates = batch.candidates
    a = workspace.a
    b = workspace.b
    starts_out[0] = 0
    for k in range(len(pairs)):
        row_a = candidates[pairs[k], 0]
        row_b = candidates[pairs[k], 1]
        na, a_radius = world_hull(batch, row_a, a)
        nb, b_radius = world_hull(batch, row_b, b)
        radii = a_radius + b_radius
        end = write_faces(a, na, ALL_EDGES ^ shapes[row_a].inner, b, nb, radii, 1.0, starts_out[k], faces_out)
        starts_out[k + 1] = write_faces(b, nb, ALL_EDGES ^ shapes[row_b].inner, a, na, radii, -1.0, end, faces_out)
    part, face = shortest_way(faces_out, starts_out, len(pairs), way_x, way_y)
    if part < 0:
        return 0
    row_a = candidates[pairs[part], 0]
    row_b = candidates[pairs[part], 1]
    na, a_radius = world_hull(batch, row_a, a)
    nb, b_radius = world_hull(batch, row_b, b)
    edge = face - starts_out[part]
    faces_of_a = na if na > 1 else 0
    if edge < faces_of_a:
        points = push_by_face(a, na, a_radius, edge, b, nb, b_radius, False, batch.margin, workspace.points)
    else:
        edge -= faces_of_a
        points = push_by_face(b, nb, b_radius, edge, a, na, a_radius, True, batch.margin, workspace.points)
    return add_points(shapes, candidates, pairs[part], 0, 1.0, workspace.points, points, 0, manifolds_out)
