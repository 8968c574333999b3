"""Distance of convex hulls by GJK, penetration depth by EPA, and the nearest pair of parts of two concave shapes."""

import math
from typing import NamedTuple

import numpy as np

from physics.jit import kernel, subkernel
from physics.math2d import norm, unit

# ---- gjk -------------------------------------------------------------------------------------------------------------
# Distance of two convex hulls by the algorithm of Gilbert, Johnson and Keerthi (GJK) in two dimensions.
#
# The Minkowski difference A - B has a point a - b for each pair of points; its distance from the origin is the distance
# between A and B. The simplex consists of up to three corners of the difference. The search ends when the support point
# towards the origin is already in the simplex, or is nearer to the origin by no more than rounding: no tolerance is a
# length. Source: Gilbert, Johnson and Keerthi 1988; Catto, Computing Distance, GDC 2010.
#
# A normal points from A to B: out of the difference, towards the origin.

SEARCHING, APART, TOUCHING = 0, 1, 2
GJK_CAP = 48  # rounds: a difference of two hulls of 16 corners has at most 32 corners
ROUNDING = 2.0**-50  # four units in the last place: the rounding error of a scalar product of differences
COUNT, NORMAL_X, NORMAL_Y, ROUNDS, CAPPED = range(5)  # indices into the state of a search
SEPARATION, NX, NY, AX, AY, BX, BY, FIRST_A, FIRST_B, SECOND_A, SECOND_B = range(11)  # indices into GapWorkspace.gap


class GapWorkspace(NamedTuple):
    """Scratch memory for GJK and EPA, for one pair of hulls at a time. It refers to corners of A and B by index."""

    state: np.ndarray  # (5,) number of corners in the simplex, search direction, rounds, times the cap was hit
    simplex: np.ndarray  # (3, 4) corner of A, corner of B, their difference [px]
    polytope: np.ndarray  # (64, 5) corner of A, corner of B; normal and depth of the polytope edge that starts there
    gap: np.ndarray  # (11,) separation, normal, nearest points, and the corners between which the points lie


def new_gap_workspace() -> GapWorkspace:
    return GapWorkspace(np.zeros(5), np.zeros((3, 4)), np.zeros((64, 5)), np.zeros(11))


@subkernel
def support(corners, count, x, y):
    """Return the index of the corner farthest along the direction (x, y), the first of equal corners. O(count)."""
    best = 0
    most = 0.0
    for k in range(1, count):
        along = x * (corners[k, 0] - corners[0, 0]) + y * (corners[k, 1] - corners[0, 1])
        if along > most:
            most = along
            best = k
    return best


@subkernel
def difference_edge(a, b, i, j, k, m):
    """Return the vector [px] from corner a[i] - b[j] of the Minkowski difference to corner a[k] - b[m].

    The vector is rounded only once if i == k or j == m.
    """
    return (a[k, 0] - a[i, 0]) - (b[m, 0] - b[j, 0]), (a[k, 1] - a[i, 1]) - (b[m, 1] - b[j, 1])


@subkernel
def write_corner(a, b, i, j, k, simplex_out):
    """Write the corner a[i] - b[j] of the Minkowski difference to row k of the simplex. a, b (n, 2) [px]: corners.

    simplex_out: array of a GapWorkspace.
    """
    simplex_out[k, 0] = float(i)
    simplex_out[k, 1] = float(j)
    simplex_out[k, 2] = a[i, 0] - b[j, 0]
    simplex_out[k, 3] = a[i, 1] - b[j, 1]


@subkernel
def copy_corner(source, target, simplex_inout):
    """Copy the corner in row `source` of the simplex to row `target`. simplex_inout: array of a GapWorkspace."""
    for k in range(4):
        simplex_inout[target, k] = simplex_inout[source, k]


@subkernel
def edge_of(a, b, p, q, simplex):
    """Return the vector [px] from the corner in row p of the simplex to the corner in row q.

    a, b (n, 2) [px]: corners of the hulls.
    """
    return difference_edge(a, b, int(simplex[p, 0]), int(simplex[p, 1]), int(simplex[q, 0]), int(simplex[q, 1]))


@subkernel
def region_of(x, y, ex, ey):
    """Return where the origin projects onto a line segment: -1 before its start, 0 on it, 1 beyond its end.

    The segment starts at (x, y) and has the vector (ex, ey). A projection that is past an end only by rounding counts
    as on the segment. With this rule, parallel faces with flush ends get the face normal.
    """
    along = -(x * ex + y * ey)
    length2 = ex * ex + ey * ey
    if length2 == 0.0 or along < -ROUNDING * length2:
        return -1
    if along > length2 + ROUNDING * length2:
        return 1
    return 0


@subkernel
def edge_distance(a, b, p, q, simplex):
    """Return the distance [px] of the origin from the line segment between rows p and q of the simplex.

    a, b (n, 2) [px]: corners of the hulls.
    """
    ex, ey = edge_of(a, b, p, q, simplex)
    x = simplex[p, 2]
    y = simplex[p, 3]
    region = region_of(x, y, ex, ey)
    if region < 0:
        return norm(x, y)
    if region > 0:
        return norm(simplex[q, 2], simplex[q, 3])
    length = norm(ex, ey)
    return abs(ex * y - ey * x) / length


@subkernel
def drop_corner(a, b, simplex_inout):
    """Reduce a triangle to one of the two edges at its newest corner (row 2), the edge nearer to the origin.

    Return False, without a change, if the origin lies in the triangle, else True. The third edge is not tested, because
    the search has just crossed this edge. a, b (n, 2) [px]: corners of the hulls. simplex_inout: array of a
    GapWorkspace.
    """
    ex, ey = edge_of(a, b, 0, 1, simplex_inout)
    fx, fy = edge_of(a, b, 0, 2, simplex_inout)
    gx, gy = edge_of(a, b, 1, 2, simplex_inout)
    area = ex * fy - ey * fx
    across_f = fy * simplex_inout[0, 2] - fx * simplex_inout[0, 3]
    across_g = gy * simplex_inout[1, 2] - gx * simplex_inout[1, 3]
    beyond_f = (area <= 0.0 and across_f < 0.0) or (area >= 0.0 and across_f > 0.0)
    beyond_g = (area <= 0.0 and across_g > 0.0) or (area >= 0.0 and across_g < 0.0)
    if not (beyond_f or beyond_g):
        return area == 0.0
    if beyond_f and beyond_g:
        beyond_g = edge_distance(a, b, 1, 2, simplex_inout) < edge_distance(a, b, 0, 2, simplex_inout)
    if beyond_g:
        copy_corner(1, 0, simplex_inout)
    copy_corner(2, 1, simplex_inout)
    return True


@subkernel
def reduce_simplex(a, b, state_inout, simplex_inout):
    """Reduce the simplex to its corner or edge nearest to the origin, and write the direction from it to the origin.

    Return TOUCHING if the origin lies in or on the simplex, else SEARCHING. a, b (n, 2) [px]: corners of the hulls;
    state_inout, simplex_inout: arrays of a GapWorkspace.
    """
    count = int(state_inout[COUNT])
    if count == 3:
        if not drop_corner(a, b, simplex_inout):
            return TOUCHING
        count = 2
    if count == 2:
        ex, ey = edge_of(a, b, 0, 1, simplex_inout)
        region = region_of(simplex_inout[0, 2], simplex_inout[0, 3], ex, ey)
        if region > 0:
            copy_corner(1, 0, simplex_inout)
        if region != 0:
            count = 1
        else:
            nx, ny = unit(ey, -ex, 1.0, 0.0)
            along = -(nx * simplex_inout[0, 2] + ny * simplex_inout[0, 3])
            side = -1.0 if along < 0.0 else 1.0
            state_inout[NORMAL_X] = side * nx
            state_inout[NORMAL_Y] = side * ny
            state_inout[COUNT] = 2.0
            return TOUCHING if along == 0.0 else SEARCHING
    state_inout[COUNT] = 1.0
    x = simplex_inout[0, 2]
    y = simplex_inout[0, 3]
    if x == 0.0 and y == 0.0:
        return TOUCHING
    nx, ny = unit(-x, -y, 1.0, 0.0)
    state_inout[NORMAL_X] = nx
    state_inout[NORMAL_Y] = ny
    return SEARCHING


@subkernel
def start_walk(a, b, i, j, state_out, simplex_out):
    """Start a GJK search for two hulls, at the corner a[i] - b[j] of their Minkowski difference.

    Any i and j are valid, but a corner near the result of the previous search saves rounds. state_out, simplex_out:
    arrays of a GapWorkspace.
    """
    write_corner(a, b, i, j, 0, simplex_out)
    state_out[COUNT] = 1.0
    state_out[NORMAL_X] = 1.0
    state_out[NORMAL_Y] = 0.0
    state_out[ROUNDS] = 0.0
    state_out[CAPPED] = 0.0


@subkernel
def walk_on(a, a_count, b, b_count, state_inout, simplex_inout):
    """Run one round of GJK: reduce the simplex to its feature nearest to the origin, then add the support point.

    Return SEARCHING if a support point was added. Return APART if no support point is nearer to the origin than the
    feature, and TOUCHING if the origin lies in the simplex. O(corners). a, b (n, 2) [px]: corners of the hulls;
    a_count, b_count: numbers of corners in use; state_inout, simplex_inout: arrays of a GapWorkspace.
    """
    state_inout[ROUNDS] += 1.0
    if reduce_simplex(a, b, state_inout, simplex_inout) == TOUCHING:
        return TOUCHING
    nx, ny = state_inout[NORMAL_X], state_inout[NORMAL_Y]
    i, j = support(a, a_count, nx, ny), support(b, b_count, -nx, -ny)
    count = int(state_inout[COUNT])
    for k in range(count):
        if int(simplex_inout[k, 0]) == i and int(simplex_inout[k, 1]) == j:
            return APART
    ex, ey = difference_edge(a, b, int(simplex_inout[0, 0]), int(simplex_inout[0, 1]), i, j)
    if nx * ex + ny * ey <= ROUNDING * (abs(ex) + abs(ey)):
        return APART
    write_corner(a, b, i, j, count, simplex_inout)
    state_inout[COUNT] = float(count + 1)
    return SEARCHING


@subkernel
def write_edge_gap(a, b, places, p, q, nx, ny, gap_out):
    """Write separation, normal and nearest points of two hulls from an edge of their Minkowski difference.

    The edge leads from row p to row q of `places`, which is the simplex or the polytope. Each row of `places` begins
    with the indices of a corner of A and a corner of B. nx, ny: unit normal of the edge; gap_out: GapWorkspace.gap.
    """
    i = int(places[p, 0])
    j = int(places[p, 1])
    k = int(places[q, 0])
    m = int(places[q, 1])
    ex, ey = difference_edge(a, b, i, j, k, m)
    length2 = ex * ex + ey * ey
    t = 0.0
    if length2 > 0.0:
        t = min(1.0, max(0.0, -((a[i, 0] - b[j, 0]) * ex + (a[i, 1] - b[j, 1]) * ey) / length2))
    gap_out[SEPARATION] = nx * (b[j, 0] - a[i, 0]) + ny * (b[j, 1] - a[i, 1])
    gap_out[NX] = nx
    gap_out[NY] = ny
    gap_out[AX] = a[i, 0] + t * (a[k, 0] - a[i, 0])
    gap_out[AY] = a[i, 1] + t * (a[k, 1] - a[i, 1])
    gap_out[BX] = b[j, 0] + t * (b[m, 0] - b[j, 0])
    gap_out[BY] = b[j, 1] + t * (b[m, 1] - b[j, 1])
    gap_out[FIRST_A] = float(i)
    gap_out[FIRST_B] = float(j)
    gap_out[SECOND_A] = float(k)
    gap_out[SECOND_B] = float(m)


@subkernel
def write_nearest(a, b, state, simplex, gap_out):
    """Write separation, normal and nearest points of two hulls to gap_out, from the final simplex of GJK.

    The simplex is an edge or a single corner. gap_out: GapWorkspace.gap.
    """
    q = 1 if state[COUNT] == 2.0 else 0
    write_edge_gap(a, b, simplex, 0, q, state[NORMAL_X], state[NORMAL_Y], gap_out)
    if q == 0:
        gap_out[SEPARATION] = norm(simplex[0, 2], simplex[0, 3])


@subkernel
def walk_to_nearest(a, a_count, b, b_count, i, j, workspace):
    """Run GJK for two hulls. Return APART and write workspace.gap, or return TOUCHING. At most GJK_CAP rounds.

    a, b (n, 2) [px]: world corners; a_count, b_count: their numbers, 1 to 16; i, j: indices of the corners of A and B
    at which the search starts. If the rounds do not suffice, the result so far is used and workspace.state[CAPPED] is
    increased.
    """
    start_walk(a, b, i, j, workspace.state, workspace.simplex)
    status = SEARCHING
    while status == SEARCHING and workspace.state[ROUNDS] < GJK_CAP:
        status = walk_on(a, a_count, b, b_count, workspace.state, workspace.simplex)
    if status == SEARCHING:
        workspace.state[CAPPED] += 1.0
        status = reduce_simplex(a, b, workspace.state, workspace.simplex)
    if status != TOUCHING:
        write_nearest(a, b, workspace.state, workspace.simplex, workspace.gap)
        if workspace.gap[SEPARATION] <= 0.0:
            return TOUCHING
        return APART
    return TOUCHING


# ---- epa -------------------------------------------------------------------------------------------------------------
# Penetration depth of two overlapping hulls by the expanding polytope algorithm (EPA).
#
# A polygon inside the Minkowski difference grows at its edge nearest to the origin until this edge is also an edge of
# the difference. In two dimensions this is exact, and takes at most as many rounds as the difference has corners. The
# polygon starts as two corners, so that the result does not depend on the position of the origin in a thin triangle. A
# depth may be slightly negative: hulls that are barely apart also get a face normal. Source: van den Bergen 2001.

EPA_CAP = 60  # rounds; less than the capacity of the polytope


@subkernel
def write_polytope_corner(i, j, k, polytope_out):
    """Write the indices i, j of a corner a[i] - b[j] of the Minkowski difference to row k of the polytope.

    polytope_out: array of a GapWorkspace.
    """
    polytope_out[k, 0] = float(i)
    polytope_out[k, 1] = float(j)


@subkernel
def measure_edge(a, b, k, count, polytope_inout):
    """Write the outward normal of the polytope edge that starts in row k, and the origin's depth [px] behind it.

    count: number of corners of the polytope. polytope_inout: array of a GapWorkspace.
    """
    n = k + 1 if k + 1 < count else 0
    i = int(polytope_inout[k, 0])
    j = int(polytope_inout[k, 1])
    ex, ey = difference_edge(a, b, i, j, int(polytope_inout[n, 0]), int(polytope_inout[n, 1]))
    nx, ny = unit(ey, -ex, 1.0, 0.0)
    polytope_inout[k, 2] = nx
    polytope_inout[k, 3] = ny
    polytope_inout[k, 4] = nx * (a[i, 0] - b[j, 0]) + ny * (a[i, 1] - b[j, 1])


@subkernel
def start_polytope(a, a_count, b, b_count, polytope_out):
    """Start the polytope with the two corners of the Minkowski difference that are farthest apart along x.

    If the difference has no width, the corners farthest apart along y are used. Return the number of corners: 2, or 1
    if the difference is a point. a, b (n, 2) [px]: corners of the hulls; a_count, b_count: numbers of corners in use;
    polytope_out: array of a GapWorkspace.
    """
    for axis in range(2):
        x, y = 1.0 - axis, float(axis)
        i, j = support(a, a_count, x, y), support(b, b_count, -x, -y)
        k = support(a, a_count, -x, -y)
        m = support(b, b_count, x, y)
        write_polytope_corner(i, j, 0, polytope_out)
        write_polytope_corner(k, m, 1, polytope_out)
        ex, ey = difference_edge(a, b, i, j, k, m)
        if ex != 0.0 or ey != 0.0:
            measure_edge(a, b, 0, 2, polytope_out)
            measure_edge(a, b, 1, 2, polytope_out)
            return 2
    return 1


@subkernel
def shallowest_edge(polytope, count):
    """Return the row of the polytope in which the edge nearest to the origin starts, the first of equal edges.

    count: number of corners of the polytope.
    """
    best = 0
    for k in range(1, count):
        if polytope[k, 4] < polytope[best, 4]:
            best = k
    return best


@subkernel
def grow_polytope(a, a_count, b, b_count, count, polytope_inout):
    """Replace the polytope edge nearest to the origin by two edges that meet in the support point beyond it.

    Return the new number of corners. The number is unchanged if no corner of the Minkowski difference lies beyond the
    edge, which is then an edge of the difference. a_count, b_count, count: numbers of corners of A, B and the polytope.
    O(corners). polytope_inout: array of a GapWorkspace.
    """
    k = shallowest_edge(polytope_inout, count)
    n = k + 1 if k + 1 < count else 0
    nx = polytope_inout[k, 2]
    ny = polytope_inout[k, 3]
    i, j = support(a, a_count, nx, ny), support(b, b_count, -nx, -ny)
    # Tested at both ends, because a corner collinear with the edge is not progress.
    for end in range(2):
        at = k if end == 0 else n
        p = int(polytope_inout[at, 0])
        q = int(polytope_inout[at, 1])
        ex, ey = difference_edge(a, b, p, q, i, j)
        if nx * ex + ny * ey <= ROUNDING * (abs(ex) + abs(ey)):
            return count
    for place in range(count, k + 1, -1):
        for column in range(5):
            polytope_inout[place, column] = polytope_inout[place - 1, column]
    write_polytope_corner(i, j, k + 1, polytope_inout)
    measure_edge(a, b, k, count + 1, polytope_inout)
    measure_edge(a, b, k + 1, count + 1, polytope_inout)
    return count + 1


@subkernel
def write_depth(a, b, count, polytope, gap_out):
    """Write separation, normal and points for the polytope edge nearest to the origin.

    The separation is minus the depth. count: number of corners of the polytope; for a single point, the normal is (1,
    0). gap_out: GapWorkspace.gap.
    """
    if count < 2:
        write_edge_gap(a, b, polytope, 0, 0, 1.0, 0.0, gap_out)
        return
    k = shallowest_edge(polytope, count)
    n = k + 1 if k + 1 < count else 0
    write_edge_gap(a, b, polytope, k, n, polytope[k, 2], polytope[k, 3], gap_out)


@subkernel
def measure_depth(a, a_count, b, b_count, workspace):
    """Find the shortest move of B that ends its overlap with A (EPA).

    Separation, normal and points are written to workspace.gap. The move is along the normal, and the separation is
    minus the length of the move. a, b (n, 2) [px]: corners of the hulls; a_count, b_count: numbers of corners in use.
    The rounds are added to workspace.state[ROUNDS]; if they reach EPA_CAP, 1 is added to workspace.state[CAPPED].
    O(corners squared).
    """
    count = start_polytope(a, a_count, b, b_count, workspace.polytope)
    if count > 1:
        capped = True
        for _ in range(EPA_CAP):
            workspace.state[ROUNDS] += 1.0
            grown = grow_polytope(a, a_count, b, b_count, count, workspace.polytope)
            if grown == count:
                capped = False
                break
            count = grown
        if capped:
            workspace.state[CAPPED] += 1.0
    write_depth(a, b, count, workspace.polytope, workspace.gap)


# ---- separation ------------------------------------------------------------------------------------------------------
# Signed distance of rounded hulls. A core is the hull without its radius. GJK measures cores that are apart, EPA cores
# that overlap; then the radii are subtracted.


@subkernel
def shape_separation(a, a_count, a_radius, b, b_count, b_radius, first, workspace):
    """Write separation, unit normal from A to B and nearest points to workspace.gap. Return the separation [px].

    If the hulls overlap, the separation is negative: minus the distance that B must move along the normal to end the
    overlap. a, b (n, 2) [px]: world corners; a_count, b_count: their numbers, 1 to 16; a_radius, b_radius [px]:
    roundings; first: (index of a corner of A, index of a corner of B) at which the search starts. After the call,
    workspace.state holds the number of rounds, and how many searches ended at their greatest number of rounds.
    """
    if walk_to_nearest(a, a_count, b, b_count, first[0], first[1], workspace) == TOUCHING:
        measure_depth(a, a_count, b, b_count, workspace)
    gap = workspace.gap
    gap[AX] += a_radius * gap[NX]
    gap[AY] += a_radius * gap[NY]
    gap[BX] -= b_radius * gap[NX]
    gap[BY] -= b_radius * gap[NY]
    gap[SEPARATION] -= a_radius + b_radius
    return gap[SEPARATION]


# ---- witness ---------------------------------------------------------------------------------------------------------
# The nearest two of many convex parts: the distance of concave shapes.


@subkernel
def box_gap(boxes_a, i, boxes_b, j):
    """Return the distance [px] between boxes_a[i] and boxes_b[j] (min_x, min_y, max_x, max_y); 0 if they overlap."""
    across = max(0.0, max(boxes_a[i, 0] - boxes_b[j, 2], boxes_b[j, 0] - boxes_a[i, 2]))
    down = max(0.0, max(boxes_a[i, 1] - boxes_b[j, 3], boxes_b[j, 1] - boxes_a[i, 3]))
    return norm(across, down)


@subkernel
def copy_part(corners, part, count, corners_out):
    """Copy the `count` corners of part number `part` to corners_out (16, 2). corners (n, 16, 2): see Parts."""
    for k in range(count):
        corners_out[k, 0] = corners[part, k, 0]
        corners_out[k, 1] = corners[part, k, 1]


@kernel
def separate_parts(a, b, corners_a_out, corners_b_out, workspace, totals_out):
    """Find the nearest two convex parts of A and B. Write separation, normal and points to workspace.gap.

    Return the separation [px]; infinite if A or B has no parts. a, b: Parts; corners_a_out, corners_b_out (16, 2):
    scratch; totals_out (2,): rounds of GJK and EPA, number of caps hit. Parts whose boxes are farther apart than the
    nearest two parts found before are skipped. O(parts of A · parts of B).
    """
    best = math.inf
    best_i, best_j = -1, -1
    totals_out[0] = 0.0
    totals_out[1] = 0.0
    for i in range(len(a.counts)):
        copy_part(a.corners, i, a.counts[i], corners_a_out)
        for j in range(len(b.counts)):
            if best_i >= 0 and box_gap(a.boxes, i, b.boxes, j) > max(best, 0.0):
                continue
            copy_part(b.corners, j, b.counts[j], corners_b_out)
            separation = shape_separation(
                corners_a_out, a.counts[i], a.radii[i], corners_b_out, b.counts[j], b.radii[j], (0, 0), workspace
            )
            totals_out[0] += workspace.state[ROUNDS]
            totals_out[1] += workspace.state[CAPPED]
            if separation < best:
                best = separation
                best_i, best_j = i, j
    if best_i >= 0 and len(a.counts) * len(b.counts) > 1:
        copy_part(a.corners, best_i, a.counts[best_i], corners_a_out)
        copy_part(b.corners, best_j, b.counts[best_j], corners_b_out)
        shape_separation(
            corners_a_out,
            a.counts[best_i],
            a.radii[best_i],
            corners_b_out,
            b.counts[best_j],
            b.radii[best_j],
            (0, 0),
            workspace,
        )
    return best
