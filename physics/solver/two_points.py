"""Both points of a manifold at once: the smallest linear complementarity problem, by trying its four cases.

One point after the other lets a body rock from corner to corner; together they agree. Written in impulses and ratios
that last for the step, so that nothing is divided. Source: Catto, Modeling and Solving Constraints, GDC 2007 (block
solver).
"""

from physics.jit import inlined

FLAT = 1e-3  # share of k_11 · k_22 below which the two points are one: nothing tells them apart


@inlined
def split_of(couple_1, couple_2):
    """What solve_two multiplies by where both points press: 1 / (1 - couple_1 · couple_2); 0 where they are one."""
    apart = 1.0 - couple_1 * couple_2
    return 1.0 / apart if apart > FLAT else 0.0


@inlined
def solve_two(change_1, change_2, couple_1, couple_2, split, old_1, old_2):
    """Impulses x >= 0 of two points such that each gets the change of speed it wants, or lets go and gets more.

    change: of each impulse, were it alone; couple: what an impulse on the other adds to that, k_12 / k_11 and k_12 /
    k_22; split: see split_of; old: impulses so far. One after the other where the two points are nearly one, or no case
    fits for rounding. All cases side by side: no branch stands in the way of vector instructions.
    """
    only_1 = old_1 + change_1 + couple_1 * old_2
    only_2 = old_2 + change_2 + couple_2 * old_1
    both = (split > 0.0) & (only_1 >= couple_1 * only_2) & (only_2 >= couple_2 * only_1)
    first = (only_1 >= 0.0) & (couple_2 * only_1 >= only_2)
    second = (only_2 >= 0.0) & (couple_1 * only_2 >= only_1)
    neither = (only_1 <= 0.0) & (only_2 <= 0.0)
    x_1 = old_1 + change_1
    x_1 = x_1 if x_1 > 0.0 else 0.0
    x_2 = old_2 + change_2 - couple_2 * (x_1 - old_1)
    x_2 = x_2 if x_2 > 0.0 else 0.0
    x_1 = 0.0 if second | neither else x_1
    x_2 = only_2 if second else (0.0 if neither else x_2)
    x_1 = only_1 if first else x_1
    x_2 = 0.0 if first else x_2
    x_1 = split * (only_1 - couple_1 * only_2) if both else x_1
    x_2 = split * (only_2 - couple_2 * only_1) if both else x_2
    return x_1, x_2
