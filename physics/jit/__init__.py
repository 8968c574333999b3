"""Compiles kernels, or runs them as they are; numba is imported nowhere else.

A kernel is a plain function over tables and scalars. With numba it is compiled on first call and cached on disk.
Without numba the same source runs: structured arrays are handed over as row views, arrays as memoryviews.

Three decorators: `kernel` for functions that a stage calls with arrays, `subkernel` for functions that only kernels
call, `inlined` for those among them that are put in where they are called. Only the first gets a way in from Python, or
has its arguments converted when nothing is compiled.
"""

from collections.abc import Callable
from functools import wraps
from typing import Any

from physics.jit.compiler import JIT, LISTING
from physics.jit.views import view_of
from physics.jit.words import popcount, word

__all__ = ["JIT", "LISTING", "inlined", "kernel", "popcount", "registry", "subkernel", "word"]

registry: list[Any] = []  # every compiled kernel, in the order of definition: warm-up and tests read it


def _compile(function, is_part, is_inlined=False):
    from physics.jit.dispatchers import dispatcher_of

    registry.append(dispatcher_of(function, is_part, is_inlined))
    return registry[-1]


def subkernel(function: Callable) -> Callable:
    """A function that kernels call: compiled, or left as it is."""
    return _compile(function, is_part=True) if JIT else function


def inlined(function: Callable) -> Callable:
    """A subkernel that is put in wherever it is called: a loop with a call in it becomes no vector instructions."""
    return _compile(function, is_part=True, is_inlined=True) if JIT else function


def kernel(function: Callable) -> Callable:
    """A function that a stage calls with tables, arrays and scalars: compiled, or given views of its arguments."""
    if JIT:
        return _compile(function, is_part=False)

    @wraps(function)
    def run(*arguments):
        return function(*[view_of(each) for each in arguments])

    return run
