"""Copies of a function that call other forms of the kernels which it names: plain twins, and copies for the compiler.

A kernel's source names Kernel objects. Its plain twin names the plain twins of these, so that nothing inside a plain
kernel goes through a dispatcher; the copy for numba names numba's dispatchers.
"""

from collections.abc import Callable, Iterator
from types import CellType, CodeType, FunctionType
from typing import Any

Replace = Callable[[Any], Any]


def names_in(code: CodeType) -> tuple[str, ...]:
    """Return the names that code reads from its globals or as attributes, those of nested code too."""
    names = set(code.co_names)
    for each in code.co_consts:
        if isinstance(each, CodeType):
            names.update(names_in(each))
    return tuple(sorted(names))


def globals_of(function: FunctionType) -> Iterator[tuple[str, Any]]:
    """Yield (name, value) of the module globals that a function may read, in the order of their names."""
    for name in names_in(function.__code__):
        if name in function.__globals__:
            yield name, function.__globals__[name]


def rebound(function: FunctionType, replace: Replace, made: Callable[[FunctionType], Any] = lambda twin: None) -> Any:
    """Return a copy of a function in which every global and closed-over value is what replace() gives for it.

    made(copy) is called before anything is replaced, so that a function that names itself can find its own copy.
    """
    names = {"__builtins__": __builtins__, "__name__": function.__module__}
    cells = tuple(CellType() for _ in function.__closure__ or ())
    twin = FunctionType(function.__code__, names, function.__name__, function.__defaults__, cells)
    twin.__qualname__, twin.__doc__, twin.__kwdefaults__ = (
        function.__qualname__,
        function.__doc__,
        function.__kwdefaults__,
    )
    made(twin)
    for name, value in globals_of(function):
        names[name] = replace(value)
    for cell, original in zip(cells, function.__closure__ or (), strict=True):
        cell.cell_contents = replace(original.cell_contents)
    return twin
