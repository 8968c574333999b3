"""Depth of two hulls that overlap: the edge of their difference A - B that is nearest to the origin.

A polygon inside the difference grows through its edge nearest to the origin until that edge is one of the difference
itself: no corner lies further out. In the plane that is exact and takes at most as many rounds as the difference has
corners. The polygon starts as two corners, so that nothing depends on how the origin lies in a thin triangle, and a
depth may be slightly negative: hulls that are a hair apart get their face's normal as well. Source: van den Bergen
2001.
"""

from physics.jit import subkernel
from physics.math2d import unit
from physics.proximity.gjk import CAPPED, ROUNDING, ROUNDS, difference_edge, support, write_edge_gap

EPA_CAP = 60  # rounds, below the room of the polytope


@subkernel
def write_polytope_corner(i, j, k, polytope_out):
    """Put corner a[i] - b[j] in place k."""
    polytope_out[k, 0] = float(i)
    polytope_out[k, 1] = float(j)


@subkernel
def measure_edge(a, b, k, count, polytope_inout):
    """Write the outward normal of the edge that starts in place k, and how deep the origin lies behind it [px]."""
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
    """Two corners of the difference, furthest apart along x, or along y when it has no width. Returns their number.

    One corner alone: the difference is a point.
    """
    for axis in range(2):
        x = 1.0 - axis
        y = float(axis)
        i = support(a, a_count, x, y)
        j = support(b, b_count, -x, -y)
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
    """The edge nearest to the origin; the first of equal ones."""
    best = 0
    for k in range(1, count):
        if polytope[k, 4] < polytope[best, 4]:
            best = k
    return best


@subkernel
def grow_polytope(a, a_count, b, b_count, count, polytope_inout):
    """Push the shallowest edge out to the corner of the difference beyond it. Returns the new number of corners.

    The same number: no corner lies beyond, the edge is the difference's own. O(corners).
    """
    k = shallowest_edge(polytope_inout, count)
    n = k + 1 if k + 1 < count else 0
    nx = polytope_inout[k, 2]
    ny = polytope_inout[k, 3]
    i = support(a, a_count, nx, ny)
    j = support(b, b_count, -nx, -ny)
    # Against both ends: a corner next to one of them in line with the edge is no progress.
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
    """Separation (the negative depth), normal and points of the shallowest edge. A lone point: the normal is (1, 0)."""
    if count < 2:
        i = int(polytope[0, 0])
        j = int(polytope[0, 1])
        write_edge_gap(a, b, i, j, i, j, 1.0, 0.0, gap_out)
        return
    k = shallowest_edge(polytope, count)
    n = k + 1 if k + 1 < count else 0
    write_edge_gap(
        a,
        b,
        int(polytope[k, 0]),
        int(polytope[k, 1]),
        int(polytope[n, 0]),
        int(polytope[n, 1]),
        polytope[k, 2],
        polytope[k, 3],
        gap_out,
    )


@subkernel
def measure_depth(a, a_count, b, b_count, workspace):
    """Write to workspace.gap how far, and along which normal, B has to move to touch A. O(corners squared).

    Rounds are added to workspace.state, and whether they hit EPA_CAP.
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
