"""What this process has compiled and loaded, and the time that took: it belongs to no measurement of anything else."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from time import perf_counter

compiled = 0  # stages' kernels
loaded = 0
parts_loaded = 0
seconds = 0.0  # [s] of compiling
loading = 0.0  # [s]
_depth = 0


@contextmanager
def compiling() -> Iterator[None]:
    """Count what goes on as compiling; an inner one counts with the outer."""
    global compiled, seconds, _depth
    started = perf_counter()
    _depth += 1
    try:
        yield
    finally:
        _depth -= 1
        if not _depth:
            compiled += 1
            seconds += perf_counter() - started


@contextmanager
def measured() -> Iterator[Callable[[], float]]:
    """Give a function that returns the seconds of compiling and loading since; 0 where nothing is compiled."""
    before = seconds + loading
    yield lambda: seconds + loading - before
