"""Kernels: plain functions over tables and scalars, compiled or run as plain Python.

Only this folder imports numba, and only when it is needed. With numba a kernel is compiled at its first call and stored
on disk. Without numba the same source is called with views of the tables and arrays (plain.py). A program may opt in to
background compilation (tiers.py). Then a kernel runs as plain Python until its compiled form is available. Both forms
give the same bits.

There are five decorators: `kernel` for functions that a stage calls with arrays; `generic` for functions that are
called with arrays of several types; `subkernel` for functions that only kernels call; `inlined` for subkernels that are
inlined at every call; `noalias` for subkernels whose arrays never overlap. Python can call the compiled form only of
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
    """Decorator: make a function that only kernels call. Return a Part, or without numba the function itself."""
    return Part(function) if JIT else function


def inlined(function: Callable) -> Any:
    """Decorator: make a subkernel that is inlined at every call. A loop that contains a call is not vectorised."""
    return Part(function, is_inlined=True) if JIT else function


def noalias(function: Callable) -> Any:
    """Decorator: make a subkernel whose arrays never overlap, so that a loop over two of them is vectorised."""
    return Part(function, noalias=True) if JIT else function


def kernel(function: Callable) -> Any:
    """Decorator: make a kernel, which a stage calls with tables, arrays and scalars, always of the same types."""
    return StageKernel(function) if JIT else _viewing(function)


def generic(function: Callable) -> Any:
    """Decorator: make a kernel that is called with arguments of several types.

    There is one compiled form for each list of types, which is looked up in every call.
    """
    return StageKernel(function, is_generic=True) if JIT else _viewing(function)


def _viewing(function):
    @wraps(function)
    def run(*arguments):
        return function(*[view_of(each) for each in arguments])

    return run
