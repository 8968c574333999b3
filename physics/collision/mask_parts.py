"""Deep-penetration fallback for outlines made of many parts: one separating direction for all parts at once."""

import math

import numpy as np

from physics.collision.hulls import ALL_EDGES, clip_edges, edge_normal, least_separation, support_manifold
from physics.collision.manifold import Batch, Workspace, add_points, copy_manifold, hull_of
from physics.jit import kernel, subkernel
from physics.tables.body import DYNAMIC
from physics.tables.contact import MANIFOLD
from physics.tables.table import rows_of

# ---- ways out --------------------------------------------------------------------------------------------------------
# Deep-penetration fallback: the shortest direction out of all overlapping parts at once.
#
# Along a direction a body has left a convex part as soon as one axis separates the two. It has left the whole outline
# when it has left every part. The nearest edge of one part may lead into the next part, all along a rim.

FACES = 32  # of a pair, at most
DIRECTION_X, DIRECTION_Y, DEPTH, MAY_PUSH = range(
    4
)  # of a face: unit, from A to B; how deep the other is behind it [px]
ALONG = 0.5  # cosine of directions that go the same way


@subkernel
def write_faces(corners, count, touchable, other, other_count, radii, sign, first, faces_out):
    """Write the faces of a hull as rows from `first` on; a disc has none. Return the row after them.

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
    """Return the distance [px] that B has to move along a direction to leave all parts of A. O(faces)."""
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
    """Return (part, row) of the pushing face along whose direction B leaves all of A soonest; -1, -1 without any.

    Directions within acos(ALONG) of (way_x, way_y), a unit vector or 0, come before others. O(faces · faces).
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
    """Write the manifold of overlapping hulls with edge `edge` of a as reference, at any depth. Return its points."""
    count = 0
    if b_count > 1:
        count = clip_edges(a, a_count, a_radius, edge, b, b_count, b_radius, margin, flipped, manifold_out)
    if count == 0 or least_separation(count, manifold_out) > -a_radius - b_radius:
        count = support_manifold(a, a_count, a_radius, edge, b, b_count, b_radius, flipped, manifold_out)
    if b_count == 1:
        manifold_out[6] = float(edge)  # features of a disc are numbered by the edge alone: see hulls.py
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
    """Write the manifold that moves B out of A in the shortest direction, for candidates `pairs` of parts of these two.

    way_x, way_y: the direction of the last step, or 0. starts_out (pairs + 1,), faces_out (FACES · pairs, 4): scratch.
    Return the number of manifolds, 0 or 1. O(faces · faces).
    """
    shapes = batch.shapes
    candidates = batch.candidates
    a = workspace.a
    b = workspace.b
    starts_out[0] = 0
    for k in range(len(pairs)):
        row_a = candidates[pairs[k], 0]
        row_b = candidates[pairs[k], 1]
        na, a_radius = hull_of(batch.geometry, batch.bodies, batch.shapes, row_a, a)
        nb, b_radius = hull_of(batch.geometry, batch.bodies, batch.shapes, row_b, b)
        radii = a_radius + b_radius
        end = write_faces(a, na, ALL_EDGES ^ shapes[row_a].inner, b, nb, radii, 1.0, starts_out[k], faces_out)
        starts_out[k + 1] = write_faces(b, nb, ALL_EDGES ^ shapes[row_b].inner, a, na, radii, -1.0, end, faces_out)
    part, face = shortest_way(faces_out, starts_out, len(pairs), way_x, way_y)
    if part < 0:
        return 0
    row_a = candidates[pairs[part], 0]
    row_b = candidates[pairs[part], 1]
    na, a_radius = hull_of(batch.geometry, batch.bodies, batch.shapes, row_a, a)
    nb, b_radius = hull_of(batch.geometry, batch.bodies, batch.shapes, row_b, b)
    edge = face - starts_out[part]
    faces_of_a = na if na > 1 else 0
    if edge < faces_of_a:
        push_by_face(a, na, a_radius, edge, b, nb, b_radius, False, batch.margin, workspace.points)
    else:
        edge -= faces_of_a
        push_by_face(b, nb, b_radius, edge, a, na, a_radius, True, batch.margin, workspace.points)
    return add_points(shapes, candidates, pairs[part], 1.0, workspace.points, 0, manifolds_out, 0)


# ---- left over -------------------------------------------------------------------------------------------------------
# Pairs that every part of an outline has left to a neighbour: a body deep among thin parts.
#
# A part reports no contact where a neighbour covers the nearer edge. A body that jumps into a thin rim in one fast step
# may overlap its parts so that each of them does this. Then the pair gets the edge that leads out of all of them
# soonest. Tiles have the same second pass, see tiles.py.

OPPOSED = -0.5  # cosine of normals that oppose each other
ALIKE = 0.99  # cosine of normals of two parts that belong to one face


@subkernel
def depth_of(manifold):
    """Return the depth [px] of the deeper point of a manifold."""
    if manifold.count == 2:
        return -min(manifold.separation_1, manifold.separation_2)
    return -manifold.separation_1


@kernel
def find_deep(
    # read
    bodies,
    manifolds,
    count,
    deep,
    # write
    flags_out,
):
    """Flag (count,) the manifolds of parts deeper than `deep` [px] in which a side is dynamic. Return how many."""
    found = 0
    for i in range(count):
        m = manifolds[i]
        flags_out[i] = (
            (m.owner_a != m.shape_a or m.owner_b != m.shape_b)
            and depth_of(m) > deep
            and (bodies[m.body_row_a].kind == DYNAMIC or bodies[m.body_row_b].kind == DYNAMIC)
        )
        found += 1 if flags_out[i] else 0
    return found


@kernel
def drop_against(
    # read
    order,
    deep,
    # write
    manifolds_inout,
):
    """Drop deep manifolds (flags) that a shallower manifold of the same pair opposes; order: sorted by owners.

    Return how many are left, moved to the front. O(manifolds · those of a pair).
    """
    first = 0
    count = len(order)
    while first < count:
        head = manifolds_inout[order[first]]
        end = first + 1
        while (
            end < count
            and manifolds_inout[order[end]].owner_a == head.owner_a
            and manifolds_inout[order[end]].owner_b == head.owner_b
        ):
            end += 1
        for k in range(first, end):
            if not deep[order[k]]:
                continue
            m = manifolds_inout[order[k]]
            for j in range(first, end):
                o = manifolds_inout[order[j]]
                if j == k or o.count == 0:
                    continue
                if m.normal_x * o.normal_x + m.normal_y * o.normal_y < OPPOSED and depth_of(o) <= depth_of(m):
                    m.count = 0
                    break
        first = end
    kept = 0
    for i in range(count):
        if manifolds_inout[i].count > 0:
            if kept < i:
                copy_manifold(manifolds_inout, i, kept, manifolds_inout)
            kept += 1
    return kept


def drop_opposed(bodies: np.ndarray, count: int, deep: float, flags: np.ndarray, manifolds: np.ndarray) -> int:
    """Drop manifolds of parts deeper than `deep` [px] that a shallower manifold of the same pair opposes.

    A body thrown into a notch narrower than itself would be squeezed there for good. It is pushed out by the nearer
    side, and rests on that. count: manifolds in use; flags (count,): scratch. Return how many are left.
    """
    if not find_deep(bodies, manifolds, count, deep, flags):
        return count
    used = manifolds[:count]
    return drop_against(np.lexsort((used["owner_b"], used["owner_a"])), flags, used)


def settle_left(batch: Batch, told: np.ndarray, previous: np.ndarray, workspace: Workspace) -> np.ndarray:
    """Return at most one MANIFOLD row for each pair of shapes whose parts all left the contact to a neighbour.

    This covers pairs without a manifold, and pairs deeper than the margin, whose manifold may lead along a wall and not
    out of it. told: the present manifolds; those with a gap do not count. previous: the manifolds of the last step.
    They keep the direction of a body on its way out, which would otherwise alternate in the middle of an arm.
    """
    shapes = batch.shapes
    left = np.sort(workspace.left[1 : 1 + workspace.left[0]])
    second = np.where(told["count"] == 2, told["separation_2"], np.inf)
    depths = -np.minimum(told["separation_1"], second)
    over = np.flatnonzero(depths > 0.0)
    parts, touching = (
        _pair_keys(shapes, rows) for rows in (batch.candidates[left], batch.candidates[told["candidate"][over]])
    )
    pairs, first = np.unique(parts, return_index=True)
    deepest = np.full(len(pairs), -np.inf)
    place = np.searchsorted(pairs, touching)
    known = (place < len(pairs)) & (pairs[np.minimum(place, len(pairs) - 1)] == touching)
    np.maximum.at(deepest, place[known], depths[over][known])
    pushed = (batch.bodies["kind"][shapes["body_row"][batch.candidates[left[first]]]] == DYNAMIC).any(axis=1)
    due = np.flatnonzero((deepest == -np.inf) | (pushed & (deepest > batch.margin)))
    if not len(due):
        return told[:0]
    before = previous[previous["separation_1"] < 0.0]
    ways = {(a, b): (x, y) for a, b, x, y in before[["owner_a", "owner_b", "normal_x", "normal_y"]].tolist()}
    found, count = np.zeros(len(due), MANIFOLD), 0
    for pair in pairs[due].tolist():
        candidates, rows = left[parts == pair], over[touching == pair]
        overlapping = np.unique(np.concatenate([candidates, told["candidate"][rows]])).astype(np.int64)
        starts, faces = np.zeros(len(overlapping) + 1, np.int64), np.zeros((FACES * len(overlapping), 4))
        a, b = shapes["owner"][batch.candidates[candidates[0]]].tolist()
        way_x, way_y = (0.0, 0.0) if len(rows) else ways.get((a, b), (0.0, 0.0))
        if lead_out(batch, overlapping, way_x, way_y, workspace, starts, faces, found[count:]):
            count += not _is_told(found[count], told[rows])
    return found[:count]


def _pair_keys(shapes, pairs):
    """Return one number for each pair of owners of two SHAPE rows, increasing in the order of the owners."""
    owners = rows_of(shapes, shapes["owner"][pairs].ravel()).reshape(-1, 2)
    return owners[:, 0] * len(shapes) + owners[:, 1]


def _is_told(manifold, told) -> bool:
    """Return whether a manifold of the same face exists already; a recycled one has turned slightly with its body."""
    same = told["candidate"] == manifold["candidate"]
    along = told["normal_x"] * manifold["normal_x"] + told["normal_y"] * manifold["normal_y"]
    return bool((same & (along > ALIKE)).any())
