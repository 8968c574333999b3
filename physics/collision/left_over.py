"""What each part of an outline has left to its neighbours, and none has told: a body deep among thin parts.

A part says nothing where a neighbour covers the nearer edge. Who jumps into a thin rim by a quick step may stand in its
parts so that each of them does so: then the pair is told by the edge that leads out of all of them soonest. The same
second look as at tiles, see tile_pairs.py.
"""

import numpy as np

from physics.collision.manifold import Batch, Workspace, copy_manifold
from physics.collision.ways_out import FACES, lead_out
from physics.jit import kernel, subkernel
from physics.tables.body import DYNAMIC
from physics.tables.manifold import MANIFOLD
from physics.tables.rows import rows_of

OPPOSED = -0.5  # cosine of normals that push against each other
ALIKE = 0.99  # … of normals of two parts that are one face's


@subkernel
def depth_of(manifold):
    """How deep [px] the deeper point of a manifold is."""
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
    """Flag (count,) what parts push by more than `deep` [px], where that moves one of the two. Returns how many."""
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
    """Drop the deep ones (flags) that another manifold of the same pair opposes; order: sorted by owners.

    Returns how many are left, moved to the front. O(manifolds · those of a pair).
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
    """Drop what parts push, deeper than `deep` [px], against a push of the same pair from the other side, less deep.

    What was thrown into a notch narrower than itself would be squeezed there for good; so it is let out by the nearer
    side, and rests against that. count: manifolds in use; flags (count,): scratch. Returns how many are left.
    """
    if not find_deep(bodies, manifolds, count, deep, flags):
        return count
    used = manifolds[:count]
    return drop_against(np.lexsort((used["owner_b"], used["owner_a"])), flags, used)


def settle_left(batch: Batch, told: np.ndarray, previous: np.ndarray, workspace: Workspace) -> np.ndarray:
    """MANIFOLD rows, at most one for each pair of shapes whose parts were left to each other: of those that nobody
    tells, and of those told deeper than the margin, which may lead along a wall and not out of it.

    told: the manifolds that there are; those that are apart tell nothing of it. previous: of the step before: who was
    on the way out goes on that way, or what stands in the middle of an arm would be pushed to and fro.
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
    """One number for each pair of owners of two SHAPE rows each, in the order of the owners."""
    owners = rows_of(shapes, shapes["owner"][pairs].ravel()).reshape(-1, 2)
    return owners[:, 0] * len(shapes) + owners[:, 1]


def _is_told(manifold, told) -> bool:
    """Whether a face pushes already: one that is used again has turned a little with its body since."""
    same = told["candidate"] == manifold["candidate"]
    along = told["normal_x"] * manifold["normal_x"] + told["normal_y"] * manifold["normal_y"]
    return bool((same & (along > ALIKE)).any())
