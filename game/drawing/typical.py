"""A readable figure for a value that is measured in every step: the median of the recent values.

With a mean, one slow step (compilation, garbage collection) would distort the shown value for seconds.
"""

from collections import deque

KEPT = 61  # values: a second of steps


class Typical:
    """Median of the last KEPT values, read as `value`. Call note(value) once per step."""

    def __init__(self, kept: int = KEPT) -> None:
        self.last: deque[float] = deque(maxlen=kept)

    def note(self, value: float) -> None:
        """Add the value that was measured in this step."""
        self.last.append(float(value))

    @property
    def value(self) -> float:
        """Median of the stored values; 0 before the first value is added.

        For an even number of values, it is the larger of the two middle values.
        """
        return sorted(self.last)[len(self.last) // 2] if self.last else 0.0
