"""Compiles kernels, or runs them as they are; numba is imported nowhere else.

A kernel is a plain function over tables and scalars. With numba it is compiled on first call and cached on disk.
Without numba the same source runs: structured arrays are handed over as row views, arrays as memoryviews.

Five decorators: `kernel` for functions that a stage calls with arrays, `generic` for those among them that are called
with arrays of several types; `subkernel` for functions that only kernels call, of these `inlined` for those that are
put in where they are called, `separate` for those whose arrays never overlap. Only the first two get a way in from
Python, or have their arguments converted when nothing is compiled.
"""

from collections.abc import Callable
from functools import wraps
from typing import Any

from physics.jit.compiler import JIT, LISTING
from physics.jit.views import view_of
from physics.jit.words import popcount, word

__all__ = [
    "DECORATORS",
    "JIT",
    "LISTING",
    "generic",
    "inlined",
    "kernel",
    "popcount",
    "registry",
    "separate",
    "subkernel",
    "word",
]

DECORATORS = ("generic", "inlined", "kernel", "separate", "subkernel")  # by name, for whoever reads sources
registry: list[Any] = []  # every compiled kernel, in the order of definition: warm-up and tests read it


def _compile(function, **kind):
    from physics.jit.dispatchers import dispatcher_of

    registry.append(dispatcher_of(function, **kind))
    return registry[-1]


def subkernel(function: Callable) -> Callable:
    """A function that kernels call: compiled, or left as it is."""
    return _compile(function, is_part=True) if JIT else function


def inlined(function: Callable) -> Callable:
    """A subkernel that is put in wherever it is called: a loop with a call in it becomes no vector instructions."""
    return _compile(function, is_part=True, is_inlined=True) if JIT else function


def separate(function: Callable) -> Callable:
    """A subkernel none of whose arrays overlap: else a loop that reads one and writes another becomes no vector
    instructions, as what it writes may be what it reads next."""
    function.separate = True
    return subkernel(function)


def kernel(function: Callable) -> Callable:
    """A function that a stage calls with tables, arrays and scalars, in each call of the same types: compiled, or given
    views of its arguments."""
    return _compile(function) if JIT else _viewing(function)


def generic(function: Callable) -> Callable:
    """A kernel that is called with several types: compiled for each, which are looked at in every call."""
    return _compile(function, is_generic=True) if JIT else _viewing(function)


def _viewing(function):
    @wraps(function)
    def run(*arguments):
        return function(*[view_of(each) for each in arguments])

    return run
