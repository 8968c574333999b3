"""Histogram of times: the mean is exact, quantiles are within half a percent, and the memory does not grow with the
count.
"""

import sys

import numpy as np
import pytest

from game.run.histogram import Histogram


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9, 0.99, 1.0])
def test_quantiles_are_those_of_the_sorted_times(share):
    times = np.random.default_rng(3).lognormal(-6.0, 1.0, 4001)
    histogram = Histogram()
    for each in times.tolist():
        histogram.add(each)
    assert histogram.quantile(share) == pytest.approx(np.quantile(times, share), rel=0.011)
    assert histogram.mean == pytest.approx(times.mean()) and histogram.largest == times.max()


def test_nothing_and_the_ends():
    histogram = Histogram()
    assert (histogram.mean, histogram.quantile(0.99), histogram.largest) == (0.0, 0.0, 0.0)
    for each in (0.0, 1e9):
        histogram.add(each)
    assert histogram.quantile(0.0) <= 1.1e-7 and histogram.largest == 1e9 and histogram.count == 2


def test_it_does_not_grow():
    histogram = Histogram()
    histogram.add(0.001)
    before = sys.getsizeof(histogram.bins)
    for _ in range(20000):
        histogram.add(0.002)
    assert sys.getsizeof(histogram.bins) == before
