"""What a step cost: seconds and work per stage. Counters are an int64 array that kernels add to."""

from collections.abc import Sequence

import numpy as np

from physics.tables.counters import COUNTERS


class Profile:
    """Seconds and work of the last step."""

    def __init__(self, names: Sequence[str]) -> None:
        self.work = np.zeros(len(COUNTERS), np.int64)
        self.begin(names)

    def begin(self, names: Sequence[str]) -> list[float]:
        """Start a step with the stages of these names: all to zero. Returns what the seconds of each are to be appended
        to."""
        self.work.fill(0)
        self._names, self._spent = names, []
        return self._spent

    @property
    def stages(self) -> dict[str, float]:
        """{name: seconds} of the last step, in order; 0.0 for what has not run."""
        told = dict.fromkeys(self._names, 0.0)
        for name, seconds in zip(self._names, self._spent, strict=False):
            told[name] += seconds
        return told

    @property
    def counters(self) -> dict[str, int]:
        """{name: int} of the last step, every name always present."""
        return dict(zip(COUNTERS, self.work.tolist(), strict=True))
