"""Deep-penetration fallback for shapes made of convex parts: finds a single direction that separates all parts."""

import math

import numpy as np

from physics.collision.hulls import clip_edges, edge_normal, least_separation, support_manifold
from physics.collision.manifold import Batch, Workspace, add_points, drop_empty, hull_of
from physics.jit import kernel, subkernel
from physics.tables.body import DYNAMIC
from physics.tables.contact import CONTACT
from physics.tables.table import rows_of

# ---- minimum translation ---------------------------------------------------------------------------------------------
# The shortest translation that leads out of all overlapping parts (minimum translation).
#
# A body that moves along a direction has left a convex part when one axis separates the two. It has left the whole
# outline when it has left every part. The nearest hull edge of a single part may lead into the next part, and so on
# along a rim.

FACES = 32  # greatest number of faces of a pair
# Columns of a face: unit normal, from A to B; depth of the other hull behind the face [px]; 1.0 if it is touchable.
DIRECTION_X, DIRECTION_Y, DEPTH, MAY_PUSH = range(4)
ALONG = 0.5  # least cosine between directions that count as the same


@subkernel
def write_faces(hull, other, sign, first, faces_out):
    """Write one row to faces_out for each edge of a Hull, from row `first` on. Return the row after the last one.

    A disc has no edge. faces_out (any, 4): columns DIRECTION_X, DIRECTION_Y (unit normal from A to B), DEPTH (depth
    [px] of `other` behind the edge), MAY_PUSH (1.0 if the edge is touchable). other: the overlapping Hull; sign: 1.0 if
    `hull` belongs to shape A, -1.0 if it belongs to B.
    """
    if hull.count == 1:
        return first
    radii = hull.radius + other.radius
    corners = hull.corners
    for k in range(hull.count):
        nx, ny = edge_normal(corners, hull.count, k)
        least = math.inf
        for i in range(other.count):
            least = min(least, nx * (other.corners[i, 0] - corners[k, 0]) + ny * (other.corners[i, 1] - corners[k, 1]))
        faces_out[first + k, DIRECTION_X] = sign * nx
        faces_out[first + k, DIRECTION_Y] = sign * ny
        faces_out[first + k, DEPTH] = max(0.0, radii - least)
        faces_out[first + k, MAY_PUSH] = float((hull.edges >> k) & 1)
    return first + hull.count


@subkernel
def translation_along(faces, starts, count, nx, ny):
    """Return the distance [px] that B must move along the unit vector (nx, ny) to leave all overlapping parts of A.

    O(faces). faces (any, 4): rows of write_faces; starts (count + 1,): first row in `faces` of each pair of parts;
    count: number of overlapping pairs of parts.
    """
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
def minimum_translation(faces, starts, count, last_x, last_y):
    """Find the face along whose normal B leaves all parts of A with the shortest move.

    Return (index of the face's pair of parts, row in `faces`), or (-1, -1) if no face may push. Normals within 60
    degrees of the unit vector (last_x, last_y) are preferred; (0, 0) means no preference. faces, starts, count: as in
    translation_along. O(faces²).
    """
    best = -1
    best_part = -1
    best_along = False
    least = math.inf
    for part in range(count):
        for k in range(starts[part], starts[part + 1]):
            if faces[k, MAY_PUSH] == 0.0:
                continue
            nx = faces[k, DIRECTION_X]
            ny = faces[k, DIRECTION_Y]
            along = nx * last_x + ny * last_y > ALONG
            if best_along and not along:
                continue
            distance = translation_along(faces, starts, count, nx, ny)
            if best < 0 or (along and not best_along) or distance < least:
                best = k
                best_part = part
                best_along = along
                least = distance
    return best_part, best


@subkernel
def face_manifold(a, edge, b, flipped, margin, manifold_out):
    """Write the manifold of two overlapping Hulls with an edge of `a` as the reference, for an overlap of any depth.

    edge: index of the edge; flipped: True if `a` is shape B of the pair; margin [px]: points with a larger separation
    are dropped; manifold_out (11,): format in hulls.clip_edges.
    """
    count = 0
    if b.count > 1:
        count = clip_edges(a, edge, b, margin, flipped, manifold_out)
    if count == 0 or least_separation(count, manifold_out) > -a.radius - b.radius:
        support_manifold(a, edge, b, flipped, manifold_out)
    if b.count == 1:
        manifold_out[6] = float(edge)  # the feature of a disc is the number of the edge, see hulls.py


@subkernel
def hulls_of_pair(batch, pair, workspace):
    """Return the (Hull of A, Hull of B) of a candidate pair in the world. pair: index of the candidate."""
    geometry = batch.geometry
    a = hull_of(geometry, batch.bodies, batch.shapes, batch.candidates[pair, 0], workspace.a)
    b = hull_of(geometry, batch.bodies, batch.shapes, batch.candidates[pair, 1], workspace.b)
    return a, b


@kernel
def write_fallback(batch, pairs, last_x, last_y, workspace, starts_out, faces_out, manifolds_out):
    """Write the contact that pushes shape B out of shape A by the shortest translation.

    Return the number of contacts written: 1, or 0 if no face may push. pairs: indices of candidate pairs of overlapping
    parts of the two shapes; last_x, last_y: unit normal of the last step, which is preferred, or (0, 0); starts_out
    (pairs + 1,), faces_out (FACES · pairs, 4): scratch; manifolds_out: CONTACT rows. O(faces²). batch: input of the
    pass, a manifold.Batch; workspace: scratch memory.
    """
    starts_out[0] = 0
    for k in range(len(pairs)):
        a, b = hulls_of_pair(batch, pairs[k], workspace)
        end = write_faces(a, b, 1.0, starts_out[k], faces_out)
        starts_out[k + 1] = write_faces(b, a, -1.0, end, faces_out)
    part, face = minimum_translation(faces_out, starts_out, len(pairs), last_x, last_y)
    if part < 0:
        return 0
    a, b = hulls_of_pair(batch, pairs[part], workspace)
    edge = face - starts_out[part]
    faces_of_a = a.count if a.count > 1 else 0
    if edge < faces_of_a:
        face_manifold(a, edge, b, False, batch.margin, workspace.points)
    else:
        face_manifold(b, edge - faces_of_a, a, True, batch.margin, workspace.points)
    return add_points(batch.shapes, batch.candidates, pairs[part], 1.0, workspace.points, 0, manifolds_out, 0)


# ---- fallback --------------------------------------------------------------------------------------------------------
# The fallback for a body deep inside thin parts if no part reports a contact.
#
# A part reports no contact if the nearest hull edge is covered by a neighbouring part, which is expected to report the
# contact. If a body jumps into a thin rim in one fast step, each part may leave the contact to another part. Then the
# pair gets the hull edge with the shortest translation out of all parts. Tiles have a similar second pass, see
# tiles.py.

OPPOSED = -0.5  # cosine of normals that oppose each other
ALIKE = 0.99  # cosine of normals of two parts that belong to one face


@subkernel
def depth_of(manifold):
    """Return the greatest overlap [px] of the points of a CONTACT row; negative if no point overlaps."""
    if manifold.count == 2:
        return -min(manifold.separation_1, manifold.separation_2)
    return -manifold.separation_1


@kernel
def find_deep(bodies, manifolds, count, deep, flags_out):
    """Write to flags_out whether each contact is of a part, is deeper than `deep` [px], and has a dynamic body.

    A contact is of a part if one of its shapes is a part of a larger shape. Return the number of flagged contacts.
    manifolds: CONTACT rows, of which the first `count` are in use; flags_out (count,) bool.
    """
    found = 0
    for i in range(count):
        m = manifolds[i]
        flags_out[i] = (
            (m.parent_a != m.shape_a or m.parent_b != m.shape_b)
            and depth_of(m) > deep
            and (bodies[m.body_row_a].kind == DYNAMIC or bodies[m.body_row_b].kind == DYNAMIC)
        )
        found += 1 if flags_out[i] else 0
    return found


@kernel
def drop_opposed_rows(order, deep, manifolds_inout):
    """Drop each deep contact if a contact of the same two shapes is no deeper and has an opposite normal.

    The remaining contacts are moved to the front; return their number. order: row numbers of the contacts, sorted by
    the ids of the whole shapes; deep (contacts,) bool: flags written by find_deep. O(contacts · contacts of a pair).
    manifolds_inout: CONTACT rows.
    """
    first = 0
    count = len(order)
    while first < count:
        head = manifolds_inout[order[first]]
        end = first + 1
        while (
            end < count
            and manifolds_inout[order[end]].parent_a == head.parent_a
            and manifolds_inout[order[end]].parent_b == head.parent_b
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
    return drop_empty(count, manifolds_inout)


def drop_opposed(bodies: np.ndarray, count: int, deep: float, flags: np.ndarray, manifolds: np.ndarray) -> int:
    """Drop each contact of parts deeper than `deep` [px] if a shallower one of the same shapes has an opposite normal.

    Return the number of remaining contacts. Without this rule, both walls of a notch would squeeze a body that is wider
    than the notch; with it, the nearer wall pushes the body out. manifolds: CONTACT rows, of which the first `count`
    are in use; flags (count,): scratch.
    """
    if not find_deep(bodies, manifolds, count, deep, flags):
        return count
    used = manifolds[:count]
    return drop_opposed_rows(np.lexsort((used["parent_b"], used["parent_a"])), flags, used)


def fallback_manifolds(batch: Batch, found: np.ndarray, previous: np.ndarray, workspace: Workspace) -> np.ndarray:
    """Return additional CONTACT rows, at most one for each pair of whole shapes that has parts in the fallback queue.

    A pair of shapes gets a row if none of its contacts overlap. A row is also added if an overlap is deeper than
    batch.margin: such contacts may push a body along a wall instead of out of the wall. found: CONTACT rows of this
    step; previous: CONTACT rows of the last step, whose normals are preferred so that the push does not alternate in
    direction; batch: input of the pass; workspace: scratch memory with the queue.
    """
    shapes = batch.shapes
    queued = np.sort(workspace.fallback[1 : 1 + workspace.fallback[0]])
    second = np.where(found["count"] == 2, found["separation_2"], np.inf)
    depths = -np.minimum(found["separation_1"], second)
    over = np.flatnonzero(depths > 0.0)
    parts, touching = (
        _pair_keys(shapes, rows) for rows in (batch.candidates[queued], batch.candidates[found["candidate"][over]])
    )
    pairs, first = np.unique(parts, return_index=True)
    deepest = np.full(len(pairs), -np.inf)
    place = np.searchsorted(pairs, touching)
    known = (place < len(pairs)) & (pairs[np.minimum(place, len(pairs) - 1)] == touching)
    np.maximum.at(deepest, place[known], depths[over][known])
    pushed = (batch.bodies["kind"][shapes["body_row"][batch.candidates[queued[first]]]] == DYNAMIC).any(axis=1)
    due = np.flatnonzero((deepest == -np.inf) | (pushed & (deepest > batch.margin)))
    if not len(due):
        return found[:0]
    before = previous[previous["separation_1"] < 0.0]
    normals = {(a, b): (x, y) for a, b, x, y in before[["parent_a", "parent_b", "normal_x", "normal_y"]].tolist()}
    added, count = np.zeros(len(due), CONTACT), 0
    for pair in pairs[due].tolist():
        candidates, rows = queued[parts == pair], over[touching == pair]
        overlapping = np.unique(np.concatenate([candidates, found["candidate"][rows]])).astype(np.int64)
        starts, faces = np.zeros(len(overlapping) + 1, np.int64), np.zeros((FACES * len(overlapping), 4))
        a, b = shapes["parent"][batch.candidates[candidates[0]]].tolist()
        last_x, last_y = (0.0, 0.0) if len(rows) else normals.get((a, b), (0.0, 0.0))
        if write_fallback(batch, overlapping, last_x, last_y, workspace, starts, faces, added[count:]):
            count += not _is_found(added[count], found[rows])
    return added[:count]


def _pair_keys(shapes, pairs):
    """Return an integer key (n,) for each pair of shapes. Pairs of parts have the key of their whole shapes.

    pairs (n, 2): row numbers in SHAPE. The keys sort like the row numbers of the whole shapes.
    """
    owners = rows_of(shapes, shapes["parent"][pairs].ravel()).reshape(-1, 2)
    return owners[:, 0] * len(shapes) + owners[:, 1]


def _is_found(manifold, found) -> bool:
    """Return whether `found` contains a contact of the same candidate as `manifold`, with nearly the same normal.

    Both arguments are CONTACT rows. The normals may differ slightly, because a contact that is reused from the last
    step has rotated with its body.
    """
    same = found["candidate"] == manifold["candidate"]
    along = found["normal_x"] * manifold["normal_x"] + found["normal_y"] * manifold["normal_y"]
    return bool((same & (along > ALIKE)).any())
