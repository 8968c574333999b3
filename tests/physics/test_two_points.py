"""Block solver for two contact points, compared with the four cases of the complementarity
problem in exact arithmetic.
"""

from fractions import Fraction

import numpy as np
import pytest

from physics.solver.lanes import block_factor, solve_two


def exact(k_11, k_12, k_22, wanted_1, wanted_2, old_1, old_2):
    """Return all solutions (x_1, x_2) of the linear complementarity problem of two contact points, in exact arithmetic.

    Each impulse is at least 0. A point with a positive impulse has exactly its wanted change of speed; a point with
    impulse 0 has at least that change.
    """
    k_11, k_12, k_22, wanted_1, wanted_2, old_1, old_2 = map(
        Fraction, (k_11, k_12, k_22, wanted_1, wanted_2, old_1, old_2)
    )
    b_1 = wanted_1 + k_11 * old_1 + k_12 * old_2
    b_2 = wanted_2 + k_12 * old_1 + k_22 * old_2
    determinant = k_11 * k_22 - k_12 * k_12
    tried = [(Fraction(0), Fraction(0)), (b_1 / k_11, Fraction(0)), (Fraction(0), b_2 / k_22)]
    if determinant > 0:
        tried.append(((k_22 * b_1 - k_12 * b_2) / determinant, (k_11 * b_2 - k_12 * b_1) / determinant))
    found = []
    for x_1, x_2 in tried:
        rest_1, rest_2 = k_11 * x_1 + k_12 * x_2 - b_1, k_12 * x_1 + k_22 * x_2 - b_2
        if min(x_1, x_2, rest_1, rest_2) >= 0 and x_1 * rest_1 == 0 and x_2 * rest_2 == 0:
            found.append((float(x_1), float(x_2)))
    return found


def solved(k_11, k_12, k_22, wanted_1, wanted_2, old_1, old_2):
    couple_1, couple_2 = k_12 / k_11, k_12 / k_22
    split = block_factor(couple_1, couple_2)
    return solve_two(wanted_1 / k_11, wanted_2 / k_22, couple_1, couple_2, split, old_1, old_2)


@pytest.mark.parametrize("seed", range(4))
def test_it_is_the_one_solution(seed):
    """The impulses are within rounding of the only exact solution, for boxes loaded, hit or released at both ends."""
    rng = np.random.default_rng(seed)
    cases = set()
    for _ in range(500):
        arm_1, arm_2 = rng.uniform(-2.0, 2.0, 2)
        if abs(arm_1 - arm_2) < 0.2:
            continue
        mass, inertia = rng.uniform(0.2, 3.0, 2)
        k = (mass + inertia * arm_1**2, mass + inertia * arm_1 * arm_2, mass + inertia * arm_2**2)
        case = (*k, *rng.normal(0.0, 2.0, 2), *rng.uniform(0.0, 2.0, 2))
        expected = exact(*case)
        x = solved(*case)
        scale = 1.0 + max(map(abs, case)) ** 2
        assert min(max(abs(x[0] - e[0]), abs(x[1] - e[1])) for e in expected) <= 1e-12 * scale, case
        cases.add((x[0] > 0.0, x[1] > 0.0))
    assert len(cases) == 4  # both, either, none


def test_points_that_are_one_share_what_one_would_take():
    x = solved(2.0, 2.0, 2.0, 3.0, 3.0, 0.0, 0.0)
    assert sum(x) == pytest.approx(1.5)


def test_a_second_point_that_nothing_pushes_changes_nothing():
    """A second point without effective mass stays at impulse 0 and does not change the first.

    SIMD lanes represent a manifold of one point in this form.
    """
    assert solve_two(0.7, 0.0, 0.0, 0.0, 0.0, 0.2, 0.0) == (pytest.approx(0.9), 0.0)
    assert solve_two(-0.7, 0.0, 0.0, 0.0, 0.0, 0.2, 0.0) == (0.0, 0.0)
