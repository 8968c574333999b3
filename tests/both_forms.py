"""Comparison of the two forms of each kernel call: the compiled form, and the plain form on copies of the arguments.

A game runs the plain form until the compiled one is ready, so both must return the same values and write the same
bytes. Floats are compared by their bits, except that any NaN equals any NaN. Sign and payload of a NaN depend on the
order of operands, which the compiler chooses, and the physics does not read them.
"""

import ctypes
import math
import traceback
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from physics.jit import compiling
from physics.jit.kernels import key_of
from physics.jit.plain import view_of
from physics.jit.tiers import StageKernel
from physics.solver.lanes import LANES, SIZE, Blocks


class FormsDiffer(AssertionError):
    """Error: the two forms of a kernel differ. Its message names the kernel and the difference."""


class Seen:
    """Record of the comparisons: number of `calls`, names of the `kernels`, and `differences` as {text: count}."""

    def __init__(self):
        self.calls, self.kernels, self.differences = 0, set(), {}

    def note(self, difference):
        self.differences[difference] = self.differences.get(difference, 0) + 1


@contextmanager
def compared(stop: bool = True) -> Iterator[Seen]:
    """Compare both forms of each stage's kernel that is called in the with block, and yield the `Seen`.

    Raises FormsDiffer: at the first difference if `stop` is True, otherwise at the end with all differences.
    """
    seen = Seen()

    def call(kernel, *arguments):
        keys = tuple(map(key_of, arguments))
        form = kernel.forms.get(keys)
        if form is None:
            form = compiling.load_or_compile(kernel, keys)
            kernel.install(keys, form)
        copies = Copies()
        others = tuple(copies.of(each) for each in arguments)
        try:
            plain, error = kernel.plain(*map(view_of, others)), None
        except Exception as raised:  # whatever it is, the compiled form does not raise it
            plain, error = None, raised
        result = form(*arguments)
        copies.take_over_empty_lanes()
        seen.calls += 1
        seen.kernels.add(kernel.name)
        difference = _raised(error) if error is not None else _difference(plain, result, copies)
        if difference:
            difference = f"{kernel.name} {difference}"
            seen.note(difference)
            if stop:
                raise FormsDiffer(difference) from error
        return result

    before = StageKernel.__dict__.get("__call__")
    assert before is None, "an inner comparison would compare what the outer one does"
    StageKernel.__call__ = call
    try:
        yield seen
    finally:
        del StageKernel.__call__
    if seen.differences:
        raise FormsDiffer("\n".join(f"{text} ({times} times)" for text, times in seen.differences.items()))


class Copies:
    """Copies of arrays that share memory as the originals do: two views of one buffer become two views of one copy."""

    def __init__(self):
        self.buffers = {}  # address of a buffer -> (the array that owns it, its copy)
        self.arrays = []  # (array, copy)
        self.blocks = []  # (Blocks, copy)

    def of(self, value):
        """Return a copy of an argument.

        A tuple is copied element by element. A value that is not an array is returned as it is.
        """
        if isinstance(value, tuple):
            copies = [self.of(each) for each in value]
            made = type(value)(*copies) if hasattr(value, "_fields") else tuple(copies)
            if isinstance(value, Blocks):
                self.blocks.append((value, made))
            return made
        if not isinstance(value, np.ndarray):
            return value
        owner = value
        while isinstance(owner.base, np.ndarray):
            owner = owner.base
        address = owner.ctypes.data
        key = address, owner.nbytes
        if key not in self.buffers:
            self.buffers[key] = owner, bytearray(ctypes.string_at(address, owner.nbytes))
        owner, buffer = self.buffers[key]
        offset = value.ctypes.data - address if value.size else 0
        copy = np.ndarray(value.shape, value.dtype, buffer if value.size else None, offset, value.strides)
        copy.flags.writeable = value.flags.writeable
        self.arrays.append((value, copy))
        return copy

    def take_over_empty_lanes(self):
        """Copy from the originals the data that only the compiled form writes, which excludes them from the comparison.

        These are empty lanes, and data gathered within a pass.
        """
        for blocks, copy in self.blocks:
            copy.gathered[:] = blocks.gathered
            empty = np.broadcast_to((blocks.contact < 0)[:, None, :], (len(blocks.contact), SIZE // LANES, LANES))
            lines, others = (each.lines.reshape(empty.shape) for each in (blocks, copy))
            others[empty] = lines[empty]


def _raised(error):
    """Return a text with the error that the plain form raised, and where it was raised."""
    last = traceback.extract_tb(error.__traceback__)[-1]
    return f"raises {error!r} in {last.name} when plain: {last.line}"


def _difference(plain, result, copies):
    """Return a text with the differences of results and written arrays, "" if there are none.

    plain, result: results of the plain and of the compiled form. copies: `Copies` of the arguments.
    """
    if not same_value(plain, result):
        return f"returns {plain!r} when plain, {result!r} when compiled"
    if all(bytes(copy) == ctypes.string_at(owner.ctypes.data, owner.nbytes) for owner, copy in copies.buffers.values()):
        return ""
    for array, copy in copies.arrays:
        for name, one, two in columns(array, copy):
            unlike = ~same_elements(one, two)
            if unlike.any():
                first = tuple(int(place) for place in np.argwhere(unlike)[0])
                return f"writes {two[first].item()!r} when plain, {one[first].item()!r} when compiled, into {name}"
    return ""


def columns(array, copy):
    """Return (name, array, copy) for every column of a table, or for the array itself if it has no columns."""
    if array.dtype.names:
        return [(name, array[name], copy[name]) for name in array.dtype.names]
    return [(f"an array of {array.dtype}", array, copy)]


def same_elements(one, two):
    """Return an array of bool: whether each two elements have the same bits or are both NaN."""
    if one.dtype.kind != "f":
        return one == two
    return ((one == two) & (np.signbit(one) == np.signbit(two))) | (np.isnan(one) & np.isnan(two))


def same_value(one, two):
    """Return whether two results are equal: floats by their bits or both NaN. A bool counts as an integer."""
    if isinstance(one, tuple) and isinstance(two, tuple):
        return len(one) == len(two) and all(map(same_value, one, two))
    if isinstance(one, float) and isinstance(two, float):
        return (one == two and math.copysign(1.0, one) == math.copysign(1.0, two)) or (one != one and two != two)
    return isinstance(one, float) == isinstance(two, float) and one == two
