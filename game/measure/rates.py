"""A rate (number of cases out of a total) with its confidence interval."""

from math import sqrt
from typing import NamedTuple

SURE = 1.96  # standard deviations: 95 %


class Rate(NamedTuple):
    """A rate: `count` cases out of `total`."""

    count: int
    total: int

    @property
    def share(self) -> float:
        """The rate as a number 0..1; 0 if `total` is 0."""
        return self.count / self.total if self.total else 0.0

    @property
    def interval(self) -> tuple[float, float]:
        """The 95 % confidence interval (low, high) of the rate (Wilson 1927); (0, 1) if `total` is 0."""
        if not self.total:
            return 0.0, 1.0
        n, p, z = self.total, self.share, SURE
        middle = p + z * z / (2 * n)
        half = z * sqrt(p * (1 - p) / n + z * z / (4 * n * n))
        scale = 1 + z * z / n
        return max(0.0, (middle - half) / scale), min(1.0, (middle + half) / scale)
