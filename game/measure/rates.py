"""A rate that was counted, with the interval that it lies in."""

from math import sqrt
from typing import NamedTuple

SURE = 1.96  # standard deviations: 95 %


class Rate(NamedTuple):
    """`count` of `total`."""

    count: int
    total: int

    @property
    def share(self) -> float:
        """0..1; 0 where nothing was counted."""
        return self.count / self.total if self.total else 0.0

    @property
    def interval(self) -> tuple[float, float]:
        """Where the true rate lies in 95 % of such counts (Wilson 1927); anywhere where nothing was counted."""
        if not self.total:
            return 0.0, 1.0
        n, p, z = self.total, self.share, SURE
        middle = p + z * z / (2 * n)
        half = z * sqrt(p * (1 - p) / n + z * z / (4 * n * n))
        scale = 1 + z * z / n
        return max(0.0, (middle - half) / scale), min(1.0, (middle + half) / scale)
