"""Plain Python forms of kernels: views of tables, 64-bit words, row copies, and plain twins of kernels.

A plain twin is a Python function with the code of a kernel. This module imports numba only when it is needed.
"""

import math
import os
import warnings
from collections.abc import Callable, Iterator
from ctypes import addressof, memmove, sizeof
from functools import cache
from importlib.util import find_spec
from types import CellType, CodeType, FunctionType, SimpleNamespace
from typing import Any
from weakref import ref

import numpy as np

# ---- compiler --------------------------------------------------------------------------------------------------------
# The compiler: whether it is installed, and the only function that imports it.

# Vector maths from SVML rounds differently from libm, but compiled and plain runs must agree to the bit.
if os.environ.get("NUMBA_DISABLE_JIT", "0") in ("", "0"):
    os.environ.setdefault("NUMBA_DISABLE_INTEL_SVML", "1")
    JIT = find_spec("numba") is not None
else:
    JIT = False

_found: list[Any] = []  # numba, or None if it cannot be imported


def compiler() -> Any:
    """Import numba at the first call, and return the module; return None if it cannot be imported.

    A failed import is reported once as a warning.
    """
    if not _found:
        try:
            import numba

            _found.append(numba)
        except ImportError as error:
            warnings.warn(f"numba cannot be imported ({error}): kernels run as Python, slower", stacklevel=2)
            _found.append(None)
    return _found[0]


# ---- views -----------------------------------------------------------------------------------------------------------
# Views of arrays and tables for plain kernels.
#
# Structured arrays are passed as arrays of C structures in the same memory, other arrays as memoryviews: both return
# Python numbers. Reading a number of a row takes 46 ns, against 146 ns with row classes written in Python and more with
# NumPy's rows. Plain steps of the platformer and the lander are 25 % faster.

_kept: dict[int, tuple[ref, "TableView"]] = {}  # id of an array -> the array, and its view


class TableView:
    """A view of a structured array for plain kernels: `view[i].x = 1.0` writes to row i of the array.

    Raises TypeError if a column is not numeric.
    """

    __slots__ = ("rows",)

    def __init__(self, array: np.ndarray) -> None:
        self.rows = (_row_class(array.dtype) * len(array)).from_buffer(array.view(np.uint8))

    def __getitem__(self, index):
        rows = self.rows
        if not 0 <= index < len(rows):
            raise IndexError(f"row {index} of a table of {len(rows)}")
        return rows[index]

    def __len__(self):
        return len(self.rows)


def _table_view(array):
    """Return the TableView of a structured array. The view is cached as long as the array exists.

    The cache saves 10 % of a plain step (three games), because most tables are used in many calls.
    """
    place = id(array)
    kept = _kept.get(place)
    if kept is not None and kept[0]() is array:
        return kept[1]
    view = TableView(array)
    if type(array.base) is np.ndarray:  # the view refers to this object, so the array itself can be freed
        _kept[place] = ref(array, lambda gone: _forget(place, gone)), view
    return view


def _forget(place, gone):
    if place in _kept and _kept[place][0] is gone:
        del _kept[place]


@cache
def _row_class(dtype):
    if any(dtype[name].base.kind not in "biuf" for name in dtype.names):
        raise TypeError(f"a kernel's table must have columns of numbers only (got {dtype})")
    return np.ctypeslib.as_ctypes_type(dtype)


def view_of(argument: Any) -> Any:
    """Convert an argument to its form for plain kernels, and return it.

    A structured array becomes a TableView, any other array a memoryview, a NumPy number a Python number. Tuples are
    converted item by item; other arguments are unchanged.
    """
    kind = type(argument)
    if kind is float or kind is int or kind is bool:
        return argument
    if kind is np.ndarray:
        return memoryview(argument) if argument.dtype.names is None else _table_view(argument)
    if isinstance(argument, tuple):
        views = [view_of(each) for each in argument]
        return kind(*views) if hasattr(argument, "_fields") else tuple(views)
    if isinstance(argument, np.generic):
        return argument.item()
    return argument


# ---- words -----------------------------------------------------------------------------------------------------------
# Words of 64 bits in kernels: the count of their bits, and values as words, compiled and plain.

WORD_MASK = 0xFFFFFFFFFFFFFFFF


class Builtin:
    """A function that kernels call, with separate forms for plain and for compiled kernels.

    plain: the Python function for plain kernels; make: function that returns the form for numba; sources: functions
    whose code is part of the fingerprint of every kernel that calls this Builtin.
    """

    def __init__(self, plain: Callable, make: Callable[[], Any], *sources: Callable) -> None:
        self.plain, self.make, self.sources = plain, make, sources
        self.made: Any = None

    def __call__(self, *values):
        return self.plain(*values)

    @property
    def compiled(self) -> Any:
        """The form for compiled kernels, made at its first use."""
        if self.made is None:
            self.made = self.make()
        return self.made


def _bits_of(word):
    return word.bit_count()


def _masked(value):
    return value & WORD_MASK


def _count_bits(typing_context, word):
    """Return (type, code generator), from which numba.extending.intrinsic makes a count of the set bits of a uint64."""

    def generate(context, builder, signature, args):
        narrow = signature.args[0].bitwidth < 64
        count = builder.ctpop(args[0])
        return builder.zext(count, context.get_value_type(signature.return_type)) if narrow else count

    numba = compiler()
    return numba.types.int64(numba.types.uint64), generate


def _as_word(value):
    """Convert a value to an unsigned 64-bit word, and return it."""
    return np.uint64(value)


def _total(function):
    """Return a version of a `math` function that returns NaN for infinite arguments, as compiled code does.

    The functions of `math` raise ValueError for infinite arguments.
    """

    def total(x):
        return function(x) if abs(x) < math.inf else math.nan

    return total


# Replaces the module `math` in plain twins.
plain_math = SimpleNamespace(**{**vars(math), "cos": _total(math.cos), "sin": _total(math.sin)})


def _make_popcount():
    from numba.extending import intrinsic

    return intrinsic(_count_bits)


def put_in(function: Callable) -> Callable[[], Any]:
    """Return the argument `make` of a Builtin: a function that compiles `function` for inlining at every call."""
    return lambda: compiler().njit(inline="always")(function)


# ---- row copies ------------------------------------------------------------------------------------------------------
# Copies of whole rows of a table, or of their first bytes. An assignment of a row would compile to a move of each byte.


def _copy_row(source, row_out):
    memmove(addressof(row_out), addressof(source), sizeof(source))


def _copy_head(source, row_out, size):
    memmove(addressof(row_out), addressof(source), size)


def _row_copy(typing_context, source, row_out):
    """Return (type, code generator), from which numba.extending.intrinsic makes a function that copies a row."""

    def generate(context, builder, signature, args):
        from numba.core import cgutils

        size = context.get_constant(compiler().types.intp, signature.args[0].size)
        cgutils.raw_memcpy(builder, args[1], args[0], size, 1)
        return context.get_dummy_value()

    return compiler().types.void(source, row_out), generate


def _head_copy(typing_context, source, row_out, size):
    """Return (type, code generator), from which numba.extending.intrinsic makes a function that copies bytes."""

    def generate(context, builder, signature, args):
        from numba.core import cgutils

        cgutils.raw_memcpy(builder, args[1], args[0], args[2], 1)
        return context.get_dummy_value()

    return compiler().types.void(source, row_out, size), generate


def _make_row_copy():
    from numba.extending import intrinsic

    return intrinsic(_row_copy)


def _make_head_copy():
    from numba.extending import intrinsic

    return intrinsic(_head_copy)


popcount: Any = Builtin(_bits_of, _make_popcount, _count_bits) if JIT else _bits_of
word: Any = Builtin(_masked, put_in(_as_word), _as_word) if JIT else _masked
copy_row: Any = Builtin(_copy_row, _make_row_copy, _row_copy) if JIT else _copy_row
copy_head: Any = Builtin(_copy_head, _make_head_copy, _head_copy) if JIT else _copy_head


# ---- twins -----------------------------------------------------------------------------------------------------------
# Copies of a function that call other forms of the kernels to which it refers: plain twins, and copies for the
# compiler.
#
# The source of a kernel refers to Kernel objects. Its plain twin refers to their plain twins, so that no call inside a
# plain kernel goes through a dispatcher. The copy for numba refers to numba's dispatchers.

Replace = Callable[[Any], Any]


def names_in(code: CodeType) -> tuple[str, ...]:
    """Return the sorted names that a code object, or code nested in it, reads as globals or attributes."""
    names = set(code.co_names)
    for each in code.co_consts:
        if isinstance(each, CodeType):
            names.update(names_in(each))
    return tuple(sorted(names))


def globals_of(function: FunctionType) -> Iterator[tuple[str, Any]]:
    """Yield (name, value) of each module global that a function may read, in the order of names."""
    for name in names_in(function.__code__):
        if name in function.__globals__:
            yield name, function.__globals__[name]


def rebound(function: FunctionType, replace: Replace, made: Callable[[FunctionType], Any] = lambda twin: None) -> Any:
    """Return a copy of a function in which every global and closed-over value is replaced by replace(value).

    made(copy) is called before the values are replaced. If the function refers to itself, `replace` can therefore
    return the copy.
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
