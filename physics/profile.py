"""What a step cost: seconds and work per stage. Counters are an int64 array that kernels add to."""

from collections.abc import Iterable

import numpy as np

from physics.tables.counters import COUNTERS


class Profile:
    """Seconds and work of the last step."""

    def __init__(self, stages: Iterable[str]) -> None:
        self.work = np.zeros(len(COUNTERS), np.int64)
        self.begin(stages)

    def begin(self, stages: Iterable[str]) -> dict[str, float]:
        """Start a step with these stages: all to zero. Returns {name: seconds}, to be added to."""
        self.work.fill(0)
        self.stages = dict.fromkeys(stages, 0.0)
        return self.stages

    @property
    def counters(self) -> dict[str, int]:
        """{name: int} of the last step, every name always present."""
        return dict(zip(COUNTERS, self.work.tolist(), strict=True))
