"""A figure that can be read while it is measured anew in every step: the median of the last ones.

An average lets one slow step, a compiler's or a garbage collection's, stand in the picture for seconds.
"""

from collections import deque

KEPT = 61  # values: a second of steps


class Typical:
    """note(value) once per step; `value` is the median of the last KEPT, 0 before the first."""

    def __init__(self, kept: int = KEPT) -> None:
        self.last: deque[float] = deque(maxlen=kept)

    def note(self, value: float) -> None:
        """Take one more."""
        self.last.append(float(value))

    @property
    def value(self) -> float:
        """What is typical now; of an even number the upper of the middle two."""
        return sorted(self.last)[len(self.last) // 2] if self.last else 0.0
