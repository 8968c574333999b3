"""Times in bins: the mean exact, quantiles to half a percent, and no more memory for a million than for one."""

import sys

import numpy as np
import pytest

from game.spread import Spread


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9, 0.99, 1.0])
def test_quantiles_are_those_of_the_sorted_times(share):
    times = np.random.default_rng(3).lognormal(-6.0, 1.0, 4001)
    spread = Spread()
    for each in times.tolist():
        spread.add(each)
    assert spread.quantile(share) == pytest.approx(np.quantile(times, share), rel=0.011)
    assert spread.mean == pytest.approx(times.mean()) and spread.largest == times.max()


def test_nothing_and_the_ends():
    spread = Spread()
    assert (spread.mean, spread.quantile(0.99), spread.largest) == (0.0, 0.0, 0.0)
    for each in (0.0, 1e9):
        spread.add(each)
    assert spread.quantile(0.0) <= 1.1e-7 and spread.largest == 1e9 and spread.count == 2


def test_it_does_not_grow():
    spread = Spread()
    spread.add(0.001)
    before = sys.getsizeof(spread.bins)
    for _ in range(20000):
        spread.add(0.002)
    assert sys.getsizeof(spread.bins) == before
