"""Types of a kernel's arguments, as values that can be compared, written to a file name, and sent to a process.

A key names the type of one argument: ("array", dtype, dimensions, layout, writeable), ("scalar", name), ("none",), or
("tuple", class, keys). It is made without numba, which takes 0.6 ms to type a table of fifty columns.
"""

import os
from functools import cache
from typing import Any

import numpy as np

Key = tuple[Any, ...]
# Types are looked at in each call: a kernel that is called with others than in its first call is refused.
CHECKING = os.environ.get("HITBOX_CHECK_CALLS", "") == "1"
SCALARS = {bool: ("scalar", "bool"), int: ("scalar", "int64"), float: ("scalar", "float64")}


def key_of(value: Any) -> Key:
    """Return the key of one argument. Raises TypeError for a kind that kernels do not take."""
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
    """Return the key as text: equal in every process, and different for different types."""
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
    """Return numba's type for a key; imports numba."""
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
    """Return whether the argument is a whole number or a bool, for which a fraction is refused."""
    return key[0] == "scalar" and not key[1].startswith("float")
