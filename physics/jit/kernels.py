"""The class Kernel, and keys that describe the types of a kernel's arguments. This module does not import numba."""

import math
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from operator import attrgetter
from time import perf_counter
from types import FunctionType
from typing import Any

import numpy as np

from physics.jit.plain import Builtin, plain_math, rebound, view_of

# ---- totals ----------------------------------------------------------------------------------------------------------
# Numbers of compiled and loaded kernels of this process, and the time for this, which other measurements leave out.

compiled = 0  # number of compiled kernels of stages
loaded = 0
parts_loaded = 0
seconds = 0.0  # [s] time of compiling
loading = 0.0  # [s] time of loading
_depth = 0


@contextmanager
def compiling() -> Iterator[None]:
    """Return a context manager that adds its time to `seconds` and 1 to `compiled`. Nested contexts count once."""
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
    """Return a context manager that yields a function, which returns the time spent on compiling and loading [s].

    The time is counted from the beginning of the context.
    """
    before = seconds + loading
    yield lambda: seconds + loading - before


# ---- signatures ------------------------------------------------------------------------------------------------------
# Types of a kernel's arguments, as values that can be compared, written to a file name, and sent to a process.
#
# A key names the type of one argument: ("array", dtype, dimensions, layout, writeable), ("scalar", name), ("none",), or
# ("tuple", class, keys). Keys are made without numba, which takes 0.6 ms to type a table of fifty columns.

Key = tuple[Any, ...]
# If True, types are checked in each call: a kernel refuses types other than the types of its first call.
CHECKING = os.environ.get("HITBOX_CHECK_CALLS", "") == "1"
SCALARS = {bool: ("scalar", "bool"), int: ("scalar", "int64"), float: ("scalar", "float64")}


def key_of(value: Any) -> Key:
    """Return the key of one argument of a kernel: a tuple that describes the type of the argument, see Key.

    Raises TypeError for a type that an argument of a kernel cannot have.
    """
    kind = type(value)
    if kind is np.ndarray:
        flags = value.flags
        layout = "C" if flags.c_contiguous else "F" if flags.f_contiguous else "A"
        return "array", value.dtype, value.ndim, layout, flags.writeable
    if kind is int and not -(1 << 63) <= value < 1 << 63:
        return "scalar", "uint64"
    if kind in SCALARS:
        return SCALARS[kind]
    if isinstance(value, tuple):
        return "tuple", kind, tuple(key_of(each) for each in value)
    if isinstance(value, np.generic):
        return "scalar", value.dtype.name
    if value is None:
        return ("none",)
    raise TypeError(f"a kernel takes arrays, numbers, None and tuples of them (got {kind.__name__}: {value!r:.80})")


def text_of(key: Key) -> str:
    """Return a key as text. The text is the same in every process, and different keys have different texts."""
    if key[0] == "array":
        _, dtype, dimensions, layout, writeable = key
        return f"array({_dtype_text(dtype)},{dimensions},{layout},{'writeable' if writeable else 'readonly'})"
    if key[0] == "tuple":
        _, kind, keys = key
        fields = getattr(kind, "_fields", "")
        return f"{kind.__module__}.{kind.__qualname__}{fields}({','.join(text_of(each) for each in keys)})"
    return ":".join(key)


@cache
def _dtype_text(dtype):
    return f"{dtype!r}/{dtype.itemsize}/{dtype.alignment}"


@cache
def type_of(key: Key) -> Any:
    """Return the numba type that corresponds to a key. This function imports numba."""
    from numba import types
    from numba.np.numpy_support import from_dtype

    if key[0] == "array":
        _, dtype, dimensions, layout, writeable = key
        return types.Array(from_dtype(dtype), dimensions, layout, readonly=not writeable)
    if key[0] == "tuple":
        _, kind, keys = key
        return types.BaseTuple.from_types(tuple(type_of(each) for each in keys), kind)
    return types.none if key[0] == "none" else from_dtype(np.dtype(key[1]))


def is_whole(key: Key) -> bool:
    """Return whether a key describes an int or a bool. A kernel raises TypeError if such an argument is a float."""
    return key[0] == "scalar" and not key[1].startswith("float")


# ---- kernels ---------------------------------------------------------------------------------------------------------
# Kernels as objects: a function, its plain twin, and its compiled forms.

Keys = tuple[Key, ...]  # types of the arguments of one call
Form = Callable[..., Any]

registry: "list[Kernel]" = []  # every kernel, in the order of definition; empty without numba


class Kernel:
    """A function over tables that can be compiled by numba or run as plain Python.

    A call of a Kernel calls its attribute `run`, which is a compiled form or the plain Python function.
    """

    is_part = False
    __call__: Any = property(attrgetter("run"))
    run: Form

    def __init__(
        self, function: FunctionType, is_inlined: bool = False, noalias: bool = False, is_generic: bool = False
    ) -> None:
        self.py_func = function
        self.is_inlined, self.noalias, self.is_generic = is_inlined, noalias, is_generic
        self.__name__, self.__qualname__ = function.__name__, function.__qualname__
        self.__doc__, self.__module__ = function.__doc__, function.__module__
        self.__wrapped__ = function
        self.content: str | None = None  # physics.jit.content.content_of
        self.dispatcher: Any = None  # physics.jit.compiling.dispatcher_of
        self.forms: dict[Keys, Form] = {}  # compiled, by the types of the arguments
        self.seconds = 0.0  # [s] time for which its plain twin has run since the last take-over
        self._plain: Form | None = None
        self.reset()
        registry.append(self)

    @property
    def name(self) -> str:
        """The qualified name of the function, with its module."""
        return f"{self.__module__}.{self.__qualname__}"

    @property
    def flags_text(self) -> str:
        """The flags on which the kernel's machine code depends, as text."""
        return f"part={self.is_part} inlined={self.is_inlined} noalias={self.noalias}"

    @property
    def signatures(self) -> list[Keys]:
        """A list with the argument types of each compiled form."""
        return list(self.forms)

    @property
    def plain(self) -> Form:
        """The plain twin of the kernel: a Python function with the same code, which calls plain twins of kernels."""
        if self._plain is None:
            rebound(self.py_func, plain_form_of, self._note_plain)
        assert self._plain is not None
        return self._plain

    def _note_plain(self, twin):
        self._plain = twin

    def __repr__(self) -> str:
        return f"<kernel {self.name}>"

    def reset(self) -> None:
        """Have calls run the kernel as plain Python again."""
        self.run = self.call_plain

    def call_plain(self, *arguments: Any) -> Any:
        """Run the kernel as plain Python, and return its result.

        Arrays are replaced by views whose elements are Python numbers, see plain.view_of.
        """
        return self.plain(*[view_of(each) for each in arguments])

    def install(self, keys: Keys, form: Form) -> None:
        """Store a compiled form for arguments of the types `keys`."""
        self.forms[keys] = form


class Part(Kernel):
    """A kernel that only other kernels call. Python cannot call its compiled form.

    A call from Python runs it as plain Python, with the same result.
    """

    is_part = True


def plain_form_of(value: Any) -> Any:
    """Return the object that replaces a global or closed-over value in the plain twin of a kernel.

    For a Kernel or Builtin it is the plain form, for the module math it is plain_math, for other values the value
    itself.
    """
    if value is math:
        return plain_math
    return value.plain if isinstance(value, (Kernel, Builtin)) else value
