"""The nearest two of many convex parts: what the distance of concave shapes comes down to."""

import math

from physics.jit import kernel, subkernel
from physics.math2d import length_of
from physics.proximity.gjk import CAPPED, ROUNDS
from physics.proximity.separation import separate


@subkernel
def box_gap(boxes_a, i, boxes_b, j):
    """Distance [px] of two boxes (min_x, min_y, max_x, max_y), 0 when they overlap."""
    across = max(0.0, max(boxes_a[i, 0] - boxes_b[j, 2], boxes_b[j, 0] - boxes_a[i, 2]))
    down = max(0.0, max(boxes_a[i, 1] - boxes_b[j, 3], boxes_b[j, 1] - boxes_a[i, 3]))
    return length_of(across, down)


@subkernel
def copy_part(corners, part, count, corners_out):
    """Copy the corners of one part to corners_out (16, 2)."""
    for k in range(count):
        corners_out[k, 0] = corners[part, k, 0]
        corners_out[k, 1] = corners[part, k, 1]


@kernel
def separate_parts(
    # read
    a,
    b,
    # write
    corners_a_out,
    corners_b_out,
    workspace,
    totals_out,
):
    """Write separation, normal and points of the nearest two parts to workspace.gap. Returns the separation [px].

    a, b: Parts; corners_a_out, corners_b_out (16, 2): scratch; totals_out (2,): rounds of GJK and EPA, caps hit. Parts
    whose boxes are further apart than the nearest so far are skipped. Infinite when one side has none. O(parts of A ·
    parts of B).
    """
    best = math.inf
    best_i = -1
    best_j = -1
    totals_out[0] = 0.0
    totals_out[1] = 0.0
    for i in range(len(a.counts)):
        copy_part(a.corners, i, a.counts[i], corners_a_out)
        for j in range(len(b.counts)):
            if best_i >= 0 and box_gap(a.boxes, i, b.boxes, j) > max(best, 0.0):
                continue
            copy_part(b.corners, j, b.counts[j], corners_b_out)
            separation = separate(
                corners_a_out, a.counts[i], a.radii[i], corners_b_out, b.counts[j], b.radii[j], 0, 0, workspace
            )
            totals_out[0] += workspace.state[ROUNDS]
            totals_out[1] += workspace.state[CAPPED]
            if separation < best:
                best = separation
                best_i = i
                best_j = j
    if best_i >= 0 and len(a.counts) * len(b.counts) > 1:
        copy_part(a.corners, best_i, a.counts[best_i], corners_a_out)
        copy_part(b.corners, best_j, b.counts[best_j], corners_b_out)
        separate(
            corners_a_out,
            a.counts[best_i],
            a.radii[best_i],
            corners_b_out,
            b.counts[best_j],
            b.radii[best_j],
            0,
            0,
            workspace,
        )
    return best
