"""Kernels: functions over tables and numbers that are compiled by numba or run as plain Python.

Only this folder imports numba, and only when it is needed. With numba, a kernel is compiled at its first call and
stored on disk. Without numba, the same function is called with views of the tables and arrays (plain.py). A program can
opt in to background compilation (tiers.py): a kernel then runs as plain Python until its compiled form is available.
Compiled and plain kernels return bit-identical results.

There are five decorators: `kernel` for functions that a stage calls with arrays; `generic` for functions that are
called with arrays of several types; `subkernel` for functions that only kernels call; `inlined` for subkernels that are
inlined at every call; `noalias` for subkernels whose arrays never overlap. Python can call compiled forms only of
`kernel` and `generic` functions.
"""

from collections.abc import Callable
from functools import wraps
from typing import Any

from physics.jit.kernels import Part, registry
from physics.jit.plain import JIT, Builtin, copy_head, copy_row, popcount, put_in, view_of, word
from physics.jit.tiers import StageKernel

__all__ = [
    "Builtin", "DECORATORS", "JIT", "copy_head", "copy_row", "generic", "inlined", "kernel", "popcount", "put_in",
    "registry", "noalias", "subkernel", "word",
]  # fmt: skip

DECORATORS = ("generic", "inlined", "kernel", "noalias", "subkernel")  # their names, for tools that read sources


def subkernel(function: Callable) -> Any:
    """Decorate a function that only kernels call. Return a Part, or the function itself if numba is not used."""
    return Part(function) if JIT else function


def inlined(function: Callable) -> Any:
    """Decorate a subkernel that is to be inlined at every call, because a loop with a call is not vectorised."""
    return Part(function, is_inlined=True) if JIT else function


def noalias(function: Callable) -> Any:
    """Decorate a subkernel whose array arguments never overlap in memory, so that loops over them are vectorised."""
    return Part(function, noalias=True) if JIT else function


def kernel(function: Callable) -> Any:
    """Decorate a function that a stage calls with tables, arrays and numbers, always of the same types."""
    return StageKernel(function) if JIT else _viewing(function)


def generic(function: Callable) -> Any:
    """Decorate a function that a stage calls with arguments of several types.

    A compiled form is made for each list of types, and looked up in every call.
    """
    return StageKernel(function, is_generic=True) if JIT else _viewing(function)


def _viewing(function):
    @wraps(function)
    def run(*arguments):
        return function(*[view_of(each) for each in arguments])

    return run
