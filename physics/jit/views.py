"""Arrays and tables as kernels see them that are not compiled.

Structured arrays are handed over as row views, arrays as memoryviews, which return Python numbers and are several times
faster to index than NumPy arrays.
"""

from functools import cache
from typing import Any

import numpy as np


def _buffer(array: Any) -> memoryview:
    """Any, as arrays are typed as buffers only from Python 3.12 on."""
    return memoryview(array)


class TableView:
    """A structured array as a sequence of row objects; `view[i].x = 1.0` writes the array."""

    __slots__ = ("make", "columns", "length")

    def __init__(self, array: np.ndarray) -> None:
        self.make = _row_class(array.dtype)
        self.columns = tuple(_buffer(array[name]) for name in array.dtype.names or ())
        self.length = len(array)

    def __getitem__(self, index):
        if not 0 <= index < self.length:
            raise IndexError(f"row {index} of a table of {self.length}")
        return self.make(self.columns, index)

    def __len__(self):
        return self.length


@cache
def _row_class(dtype):
    members: dict[str, Any] = {"__slots__": ("_columns", "_index")}

    def __init__(self, columns, index):
        self._columns = columns
        self._index = index

    members["__init__"] = __init__
    for number, name in enumerate(dtype.names):

        def read(self, number=number):
            return self._columns[number][self._index]

        def write(self, value, number=number):
            self._columns[number][self._index] = value

        members[name] = property(read, write)
    return type("Row", (), members)


def view_of(argument: Any) -> Any:
    """What a kernel gets for an argument: rows of a table, a memoryview of an array, Python's own numbers."""
    if type(argument) is np.ndarray:
        if argument.dtype.names:
            return TableView(argument)
        return _buffer(argument)
    if isinstance(argument, tuple):
        views = [view_of(each) for each in argument]
        return type(argument)(*views) if hasattr(argument, "_fields") else tuple(views)
    if isinstance(argument, np.generic):
        return argument.item()
    return argument
