"""Both points of a manifold at once: the smallest linear complementarity problem, by trying its four cases.

One point after the other lets a body rock from corner to corner; together they agree. Source: Catto, Modeling and
Solving Constraints, GDC 2007 (block solver).
"""

from physics.jit import subkernel

FLAT = 1e-3  # share of k_11 · k_22 below which the two points are one: nothing tells them apart


@subkernel
def solve_two(k_11, k_12, k_22, wanted_1, wanted_2, old_1, old_2):
    """Impulses x >= 0 of two points such that each gets the change of speed it wants, or lets go and gets more.

    k: speed of one point per impulse on another; wanted [px/s]: change of speed along the normal; old: impulses so far.
    Returns (solved, x_1, x_2). Not solved where the two points are nearly one, or no case fits for rounding.
    """
    b_1 = wanted_1 + k_11 * old_1 + k_12 * old_2
    b_2 = wanted_2 + k_12 * old_1 + k_22 * old_2
    determinant = k_11 * k_22 - k_12 * k_12
    if determinant > FLAT * k_11 * k_22:
        x_1 = (k_22 * b_1 - k_12 * b_2) / determinant
        x_2 = (k_11 * b_2 - k_12 * b_1) / determinant
        if x_1 >= 0.0 and x_2 >= 0.0:
            return True, x_1, x_2
    elif determinant <= 0.0 or k_11 <= 0.0 or k_22 <= 0.0:
        return False, old_1, old_2
    x_1 = b_1 / k_11
    if x_1 >= 0.0 and k_12 * x_1 >= b_2:
        return True, x_1, 0.0
    x_2 = b_2 / k_22
    if x_2 >= 0.0 and k_12 * x_2 >= b_1:
        return True, 0.0, x_2
    if b_1 <= 0.0 and b_2 <= 0.0:
        return True, 0.0, 0.0
    return False, old_1, old_2
