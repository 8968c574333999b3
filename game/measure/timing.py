"""Times of named work: warmed, in shuffled turns, the least and the median of several runs.

Rules: reference/hard_cases.md section 3.4. Other load on the machine only ever adds time, so the least is what the work
takes, and how far the median lies above it is the noise. All works are run in every turn: load meets them alike.
"""

import gc
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from random import Random
from statistics import median
from typing import NamedTuple, TypeVar

RUNS = 5
LEAST_PAIRS = 1000  # what a cost per pair is measured on, at least
Name = TypeVar("Name")
FINE = 1e-6  # [s] a clock that is coarser is no clock for a step

# The processor's time, which is not ours while others have it, where it is told finely enough (not on Windows).
clock = time.thread_time if time.get_clock_info("thread_time").resolution <= FINE else time.perf_counter


class Cost(NamedTuple):
    """Seconds a piece, of so many pieces a run; the spread is told, never hidden in a mean."""

    least: float
    median: float
    upper: float  # quartile
    runs: int
    pieces: int  # in each run

    @classmethod
    def of(cls, seconds: list[float], pieces: int) -> "Cost":
        """Of the seconds a piece that each run took. Raises ValueError for no run, or no piece."""
        if not seconds or pieces < 1:
            raise ValueError(f"a cost needs runs and pieces (got {len(seconds)} runs of {pieces} pieces)")
        ordered = sorted(seconds)
        upper = ordered[round(0.75 * (len(ordered) - 1))]
        return cls(ordered[0], median(ordered), upper, len(seconds), pieces)

    @property
    def noise(self) -> float:
        """How far the median run lies above the least, as a share of it."""
        return self.median / self.least - 1.0 if self.least > 0.0 else 0.0


@contextmanager
def undisturbed() -> Iterator[None]:
    """No collection of garbage in between: it is nobody's cost."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


def seconds_a_step(step: Callable[[], object], steps: int) -> float:
    """The mean of so many, each timed by itself."""
    spent = 0.0
    with undisturbed():
        for _ in range(steps):
            started = clock()
            step()
            spent += clock() - started
    return spent / steps


def timed_steps(steps: Mapping[Name, Callable[[], object]], count: int = 60, runs: int = RUNS) -> dict[Name, Cost]:
    """Seconds a step of worlds by their step, which go on in turns of count: with the usual ones 300 steps each."""
    spent: dict[Name, list[float]] = {name: [] for name in steps}
    for _ in range(runs):
        for name, step in steps.items():
            spent[name].append(seconds_a_step(step, count))
    return {name: Cost.of(seconds, count) for name, seconds in spent.items()}


def timed_in_turns(
    works: Mapping[str, Callable[[], object]], pieces: Mapping[str, int], runs: int = RUNS, seed: int = 0
) -> dict[str, Cost]:
    """{name: Cost} of works that each do `pieces[name]` pieces a call; the first call of each is not counted."""
    order, spent = list(works), {name: [] for name in works}
    chance = Random(seed)
    for work in works.values():
        work()
    with undisturbed():
        for _ in range(runs):
            chance.shuffle(order)
            for name in order:
                started = clock()
                works[name]()
                spent[name].append((clock() - started) / pieces[name])
    return {name: Cost.of(seconds, pieces[name]) for name, seconds in spent.items()}
