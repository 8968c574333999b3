"""Kernels by reference, so that another process can find or make the same ones: where the code stands, what it closes
over, and the content that must come out."""

import importlib
from collections.abc import Container
from functools import cache
from types import CellType, CodeType, FunctionType
from typing import Any

from physics.jit.calls import StageKernel
from physics.jit.content import content_of
from physics.jit.kernels import Kernel, Part, registry
from physics.jit.twins import globals_of

Spec = tuple[str, str, str, tuple[tuple[bool, Any], ...], dict[str, bool]]


def spec_of(kernel: Kernel) -> Spec:
    """Return what another process needs to find a kernel or to make it: picklable."""
    function = kernel.py_func
    closed = tuple(
        (True, spec_of(cell.cell_contents)) if isinstance(cell.cell_contents, Kernel) else (False, cell.cell_contents)
        for cell in function.__closure__ or ()
    )
    flags = {"is_part": kernel.is_part, "is_inlined": kernel.is_inlined, "noalias": kernel.noalias}
    return (
        function.__module__,
        function.__qualname__,
        content_of(kernel),
        closed,
        {**flags, "is_generic": kernel.is_generic},
    )


def kernel_of(spec: Spec) -> Kernel:
    """Return the kernel that a spec describes. Raises LookupError where the sources here are others."""
    module, qualname, content, closed, flags = spec
    importlib.import_module(module)
    for each in registry:
        if each.__qualname__ == qualname and each.__module__ == module and content_of(each) == content:
            return each
    for code in _codes_of(module, qualname):
        cells = tuple(CellType(kernel_of(value) if is_kernel else value) for is_kernel, value in closed)
        if len(cells) == len(code.co_freevars):
            made = _make(module, code, cells, flags)
            if content_of(made) == content:
                return made
    raise LookupError(f"{module}.{qualname} is another here: its sources have changed")


def _make(module, code, cells, flags):
    function = FunctionType(code, vars(importlib.import_module(module)), code.co_name, None, cells)
    function.__qualname__ = code.co_qualname
    kind = Part if flags["is_part"] else StageKernel
    return kind(function, **{name: value for name, value in flags.items() if name != "is_part"})


def _codes_of(module, qualname):
    """Yield the code objects of a qualified name within a module, from the function that holds them inwards."""
    outer: Any = getattr(importlib.import_module(module), qualname.partition(".")[0], None)
    while hasattr(outer, "__wrapped__"):
        outer = outer.__wrapped__
    todo = [outer.__code__] if isinstance(outer, FunctionType) else []
    while todo:
        code = todo.pop()
        if code.co_qualname == qualname:
            yield code
        todo += [each for each in code.co_consts if isinstance(each, CodeType)]


def code_of(kernel: Kernel, known: Container[Kernel]) -> int:
    """Return how many bytes of code a kernel has with all that it calls, but for those that are known."""
    return sum(size for part, size in parts_of(kernel).items() if part not in known)


@cache
def parts_of(kernel: Kernel) -> dict[Kernel, int]:
    """Return a kernel and all that it calls, whatever the depth, each with the length of its code."""
    found: dict[Any, int] = {}
    todo = [kernel]
    while todo:
        each = todo.pop()
        if each not in found:
            function = each.py_func
            found[each] = len(function.__code__.co_code)
            values = [value for _, value in globals_of(function)]
            values += [cell.cell_contents for cell in function.__closure__ or ()]
            todo += [value for value in values if isinstance(value, Kernel)]
    return found
