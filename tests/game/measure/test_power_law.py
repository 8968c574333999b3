"""Exponents fitted by least squares on logarithms are exact for exact laws, and have the standard error that NumPy
gives.
"""

import numpy as np
import pytest

from game.measure.power_law import fit_power_law
from scenes.lab.growth import in_units


@pytest.mark.parametrize("exponent, factor", [(2.0, 3e-9), (1.0, 5e-7), (0.0, 2e-5)])
def test_an_exact_law_is_found_without_error(exponent, factor):
    law = fit_power_law([(n, factor * n**exponent) for n in (500, 889, 1581, 2812, 5000)])
    assert law.exponent == pytest.approx(exponent, abs=1e-12) and law.factor == pytest.approx(factor)
    assert law.error < 1e-12 and law.at(700.0) == pytest.approx(factor * 700.0**exponent)


def test_the_standard_error_is_that_of_a_straight_line():
    chance = np.random.default_rng(3)
    sizes = np.array([100.0, 300.0, 900.0, 2700.0, 8100.0, 24300.0])
    costs = 1e-7 * sizes**1.4 * np.exp(chance.normal(0.0, 0.2, len(sizes)))
    law = fit_power_law(list(zip(sizes.tolist(), costs.tolist(), strict=True)))
    (slope, start), covariance = np.polyfit(np.log(sizes), np.log(costs), 1, cov=True)
    assert law.exponent == pytest.approx(slope) and law.factor == pytest.approx(np.exp(start))
    assert law.error == pytest.approx(np.sqrt(covariance[0, 0]))


@pytest.mark.parametrize("costs", [{1: 1.0, 2: 2.0}, {1: 1.0, 2: 0.0, 3: 1.0}, {1: 1.0, 2: -1.0, 3: 1.0}])
def test_what_cannot_be_fitted_is_refused(costs):
    with pytest.raises(ValueError, match="needs three sizes"):
        fit_power_law(list(costs.items()))


def test_round_numbers_of_seconds_as_text():
    assert [in_units(10.0**k) for k in range(-9, 1)] == [
        "1 ns", "10 ns", "100 ns", "1 us", "10 us", "100 us", "1 ms", "10 ms", "100 ms", "1 s",
    ]  # fmt: skip
