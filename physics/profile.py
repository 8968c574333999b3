"""What a step cost: seconds and work per stage. Counters are an int64 array that kernels add to."""

from contextlib import contextmanager
from time import perf_counter

import numpy as np

COUNTERS = (
    "bodies_integrated",
    "nodes_visited",
    "pairs_tested",
    "candidates",
    "filtered",
    "narrow_tests",
    "mask_tests",
    "contacts",
    "toi_calls",
    "solver_rows",
    "tangent_rows",
    "restitution_rows",
    "gjk_iterations",
    "cap_hits",
    "sensor_tests",
    "joints_solved",
    "islands",
    "carved_pixels",
    "swaps",
    "reinserts",
    "cells_touched",
)
(
    BODIES_INTEGRATED,
    NODES_VISITED,
    PAIRS_TESTED,
    CANDIDATES,
    FILTERED,
    NARROW_TESTS,
    MASK_TESTS,
    CONTACTS,
    TOI_CALLS,
    SOLVER_ROWS,
    TANGENT_ROWS,
    RESTITUTION_ROWS,
    GJK_ITERATIONS,
    CAP_HITS,
    SENSOR_TESTS,
    JOINTS_SOLVED,
    ISLANDS,
    CARVED_PIXELS,
    SWAPS,
    REINSERTS,
    CELLS_TOUCHED,
) = range(len(COUNTERS))


class Profile:
    """Seconds and work of the last step."""

    def __init__(self, stages):
        self.work = np.zeros(len(COUNTERS), np.int64)
        self.stages = dict.fromkeys(stages, 0.0)

    def begin(self):
        """Start a step: all to zero."""
        self.work[:] = 0
        for name in self.stages:
            self.stages[name] = 0.0

    @contextmanager
    def time(self, stage):
        """Add the seconds spent inside to a stage."""
        start = perf_counter()
        try:
            yield
        finally:
            self.stages[stage] += perf_counter() - start

    @property
    def counters(self) -> dict[str, int]:
        """{name: int} of the last step, every name always present."""
        return dict(zip(COUNTERS, self.work.tolist()))
