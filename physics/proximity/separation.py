"""Signed distance of rounded hulls: GJK where their cores are apart, EPA where they overlap; then the radii."""

from physics.jit import subkernel
from physics.proximity.epa import measure_depth
from physics.proximity.gjk import AX, AY, BX, BY, NX, NY, SEPARATION, TOUCHING, walk_to_nearest


@subkernel
def separate(a, a_count, a_radius, b, b_count, b_radius, i, j, workspace):
    """Write separation, unit normal from A to B and nearest points to workspace.gap. Returns the separation.

    a, b: world corners (n, 2) [px], 1 to 16 of them; radii [px]; i, j: corners to start from. Negative where they
    overlap: -(the move of B along the normal that ends it). workspace.state holds the rounds and how many hit their
    cap.
    """
    if walk_to_nearest(a, a_count, b, b_count, i, j, workspace) == TOUCHING:
        measure_depth(a, a_count, b, b_count, workspace)
    gap = workspace.gap
    gap[AX] += a_radius * gap[NX]
    gap[AY] += a_radius * gap[NY]
    gap[BX] -= b_radius * gap[NX]
    gap[BY] -= b_radius * gap[NY]
    gap[SEPARATION] -= a_radius + b_radius
    return gap[SEPARATION]
