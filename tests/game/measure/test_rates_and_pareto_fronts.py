"""Confidence intervals, Pareto fronts and ties, compared with values computed by hand."""

from random import Random

import pytest

from game.measure.pareto_front import cheaper, pareto_front
from game.measure.rates import Rate
from game.measure.timing import Cost, timed_in_turns


@pytest.mark.parametrize("true", (0.02, 0.3, 0.9))
def test_the_interval_holds_the_true_rate_in_95_of_100_counts(true):
    chance, held = Random(5), 0
    for _ in range(1000):
        low, high = Rate(sum(chance.random() < true for _ in range(200)), 200).interval
        held += low <= true <= high
    assert 920 <= held <= 980


def test_the_interval_of_nothing_is_everything():
    assert Rate(0, 0).interval == (0.0, 1.0) and Rate(0, 0).share == 0.0
    low, high = Rate(0, 100).interval
    assert low == 0.0 and 0.03 < high < 0.04  # 3.7 %: Wilson's bound of none in a hundred


def test_the_pareto_front_is_what_no_other_beats():
    chance = Random(2)
    points = {name: (chance.random(), chance.choice((0.0, chance.random()))) for name in range(60)}
    found = pareto_front(points)
    for name, (cost, error) in points.items():
        beaten = any(
            (c <= cost and e <= error) and (c, e) != (cost, error) for other, (c, e) in points.items() if other != name
        )
        assert (name in found) != beaten
    assert [points[name][0] for name in found] == sorted(points[name][0] for name in found)


def test_costs_that_overlap_or_differ_by_less_than_a_tenth_are_a_tie():
    assert cheaper((1.0, 1.1), (1.5, 1.6)) and not cheaper((1.5, 1.6), (1.0, 1.1))
    assert not cheaper((1.0, 1.6), (1.5, 1.9)), "the intervals overlap"
    assert not cheaper((1.0, 1.0), (1.05, 1.06)), "6 % are no difference"


def test_a_cost_needs_runs():
    with pytest.raises(ValueError, match="0 runs of 3 pieces"):
        Cost.of([], 3)
    cost = Cost.of([3.0, 1.0, 2.0, 9.0, 1.5], 10)
    assert (cost.least, cost.median, cost.upper, cost.runs) == (1.0, 2.0, 3.0, 5) and cost.noise == 1.0


def test_works_go_in_turns_and_the_first_call_is_not_counted():
    calls = []
    works = {name: (lambda name=name: calls.append(name)) for name in "abc"}
    costs = timed_in_turns(works, dict.fromkeys("abc", 1), runs=4)
    assert calls[:3] == ["a", "b", "c"] and all(costs[name].runs == 4 for name in "abc")
    rounds = [calls[3 + 3 * k : 6 + 3 * k] for k in range(4)]
    assert all(sorted(each) == ["a", "b", "c"] for each in rounds) and len({tuple(each) for each in rounds}) > 1
