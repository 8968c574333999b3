"""A covering array contains every pair of values, is not much longer than necessary, and is reproducible."""

from itertools import combinations, product

import pytest

from tests.pairwise import pairwise, the_others

SIZES = [(3,), (2, 2), (5, 4), (2, 2, 2), (3, 3, 3, 3), (28, 5, 2, 3), (3, 6, 4, 3, 3), (1, 7, 1), (2,) * 10, (9, 8, 7)]


@pytest.mark.parametrize("sizes", SIZES, ids=str)
def test_every_two_values_meet_in_few_cases(sizes):
    values = [[f"{place}{value}" for value in range(size)] for place, size in enumerate(sizes)]
    cases = pairwise(*values)
    for a, b in combinations(range(len(sizes)), 2):
        assert {(case[a], case[b]) for case in cases} == set(product(values[a], values[b]))
    least = max((x * y for x, y in combinations(sizes, 2)), default=sizes[0])
    assert least <= len(cases) == len(set(cases)) <= 1.5 * least + 8
    assert cases == pairwise(*values)


@pytest.mark.parametrize("sizes", SIZES[:6], ids=str)
def test_the_others_are_the_rest_of_the_product(sizes):
    values = [range(size) for size in sizes]
    taken, left = pairwise(*values), the_others(*values)
    assert sorted(taken + left) == list(product(*values)) and not set(taken) & set(left)


def test_values_need_not_be_hashable():
    assert pairwise([[1], [2]], [{}]) == [([1], {}), ([2], {})] and the_others([[1], [2]], [{}]) == []
