"""A power law fitted to (size, cost) points: cost = factor * size ** exponent.

The fit is least squares on the logarithms.
"""

from math import exp, log, sqrt
from typing import NamedTuple


class PowerLaw(NamedTuple):
    """Fitted power law, cost = factor * size ** exponent.

    error: standard error of the exponent; factor: cost at size 1, in the unit of the costs.
    """

    exponent: float
    error: float
    factor: float

    def at(self, size: float) -> float:
        """Return the cost that the fitted law gives for a size."""
        return self.factor * size**self.exponent


def fit_power_law(points: list[tuple[float, float]]) -> PowerLaw:
    """Return the power law fitted to (size, cost) points.

    Raises ValueError for fewer than three different sizes (the standard error needs three), or for a value <= 0.
    """
    if len({size for size, _ in points}) < 3 or min(map(min, points)) <= 0.0:
        raise ValueError(f"a power law needs three sizes and costs above 0 (got {points})")
    n = len(points)
    x, y = [log(size) for size, _ in points], [log(cost) for _, cost in points]
    middle_x, middle_y = sum(x) / n, sum(y) / n
    spread = sum((each - middle_x) ** 2 for each in x)
    exponent = sum((a - middle_x) * (b - middle_y) for a, b in zip(x, y, strict=True)) / spread
    start = middle_y - exponent * middle_x
    rest = sum((b - start - exponent * a) ** 2 for a, b in zip(x, y, strict=True))
    return PowerLaw(exponent, sqrt(rest / (n - 2) / spread), exp(start))
