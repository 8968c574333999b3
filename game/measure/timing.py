"""Times of named functions, which are warmed up and called in random order.

For each function, the result is the least, the median and the upper quartile of its times in several runs. Other load
on the machine only ever adds time. So the least time is taken as the cost of the function, and the difference between
the median and the least time as the noise. Every round runs all functions, so that load affects them equally.
"""

import gc
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from random import Random
from statistics import median
from typing import NamedTuple, TypeVar

RUNS = 5
LEAST_PAIRS = 1000  # least number of pairs that a cost per pair is measured on
# The one spelling of a difference inside the noise, in sentences, and in cells and verdicts, which are narrow.
UNSURE, UNSURE_CELL = "cannot be told apart", "a tie"
Name = TypeVar("Name")
FINE = 1e-6  # [s] a coarser clock is too coarse for a step

# Processor time excludes other processes; wall-clock time where the system reports it too coarsely (Windows).
clock = time.thread_time if time.get_clock_info("thread_time").resolution <= FINE else time.perf_counter


class Cost(NamedTuple):
    """Time per piece of work (a step, a pair) [s] over several runs: least, median and upper quartile."""

    least: float
    median: float
    upper: float  # upper quartile
    runs: int
    pieces: int  # in each run

    @classmethod
    def of(cls, seconds: list[float], pieces: int) -> "Cost":
        """Return the Cost of several runs.

        seconds: time per piece of work [s] of each run; pieces: pieces of work in a run. Raises ValueError if there are
        no runs or no pieces.
        """
        if not seconds or pieces < 1:
            raise ValueError(f"a cost needs runs and pieces (got {len(seconds)} runs of {pieces} pieces)")
        ordered = sorted(seconds)
        upper = ordered[round(0.75 * (len(ordered) - 1))]
        return cls(ordered[0], median(ordered), upper, len(seconds), pieces)

    @property
    def noise(self) -> float:
        """Median minus least time, divided by the least time."""
        return self.median / self.least - 1.0 if self.least > 0.0 else 0.0


@contextmanager
def undisturbed() -> Iterator[None]:
    """Disable garbage collection within the `with` block, so that its time is not measured."""
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


def seconds_a_step(step: Callable[[], object], steps: int) -> float:
    """Return the mean time [s] of `steps` calls of step(). Each call is timed separately."""
    spent = 0.0
    with undisturbed():
        for _ in range(steps):
            started = clock()
            step()
            spent += clock() - started
    return spent / steps


def timed_steps(steps: Mapping[Name, Callable[[], object]], count: int = 60, runs: int = RUNS) -> dict[Name, Cost]:
    """Return {name: Cost} of the functions in `steps`. The Cost is the time of one call.

    There are `runs` runs. In each run, `count` calls of every function are timed, one function after another.
    """
    spent: dict[Name, list[float]] = {name: [] for name in steps}
    for _ in range(runs):
        for name, step in steps.items():
            spent[name].append(seconds_a_step(step, count))
    return {name: Cost.of(seconds, count) for name, seconds in spent.items()}


def timed_in_turns(
    works: Mapping[str, Callable[[], object]], pieces: Mapping[str, int], runs: int = RUNS, seed: int = 0
) -> dict[str, Cost]:
    """Return {name: Cost} of the functions `works`. Each is called `runs` times, in random order.

    A call of works[name] does pieces[name] pieces of work. One call of each function before the first run is not timed.
    seed: seed of the order.
    """
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
