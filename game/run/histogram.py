"""Histogram of durations in constant memory: bins 1 % wide, with the exact mean and maximum."""

from math import floor, log

SHORTEST, LONGEST = 1e-7, 1e3  # [s] times outside count in the first or the last bin
WIDTH = log(1.01)  # width of a bin in the logarithm of the time: quantiles are exact to half a percent
BINS = floor(log(LONGEST / SHORTEST) / WIDTH) + 1


class Histogram:
    """Histogram of durations [s], which are added one by one."""

    def __init__(self) -> None:
        self.bins = [0] * BINS
        self.count = 0
        self.total = self.largest = 0.0

    def add(self, seconds: float) -> None:
        """Add a duration [s] to the histogram."""
        place = floor(log(max(seconds, SHORTEST) / SHORTEST) / WIDTH)
        self.bins[min(place, BINS - 1)] += 1
        self.count += 1
        self.total += seconds
        self.largest = max(self.largest, seconds)

    @property
    def mean(self) -> float:
        """Exact mean of the durations [s]; 0 if there are none."""
        return self.total / self.count if self.count else 0.0

    def quantile(self, share: float) -> float:
        """Return a quantile of the durations [s], with an error of at most half a percent; 0 if there are none.

        share: the quantile, 0..1, for example 0.5 for the median.
        """
        left = share * (self.count - 1) + 1.0
        for place, count in enumerate(self.bins):
            left -= count
            if count and left < 1.0:
                return min(SHORTEST * 1.01 ** (place + 0.5), self.largest)
        return self.largest
