"""Words of 64 bits in kernels: the count of their bits, and values as words, compiled and plain."""

import math
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np

from physics.jit.compiler import JIT, compiler

WORD_MASK = 0xFFFFFFFFFFFFFFFF


class Builtin:
    """A function that kernels call and that has a form of its own for the compiler.

    plain: the Python function; make: returns the function as numba knows it; sources: functions it is made of.
    """

    def __init__(self, plain: Callable, make: Callable[[], Any], *sources: Callable) -> None:
        self.plain, self.make, self.sources = plain, make, sources
        self.made: Any = None

    def __call__(self, value):
        return self.plain(value)

    @property
    def compiled(self) -> Any:
        """The function as numba knows it, made at the first use."""
        if self.made is None:
            self.made = self.make()
        return self.made


def _bits_of(word):
    return word.bit_count()


def _masked(value):
    return value & WORD_MASK


def _count_bits(typing_context, word):
    """Type and generate the number of set bits of a uint64 (numba.extending.intrinsic)."""

    def generate(context, builder, signature, args):
        narrow = signature.args[0].bitwidth < 64
        count = builder.ctpop(args[0])
        return builder.zext(count, context.get_value_type(signature.return_type)) if narrow else count

    numba = compiler()
    return numba.types.int64(numba.types.uint64), generate


def _as_word(value):
    """Return the value as an unsigned 64-bit word."""
    return np.uint64(value)


def _total(function):
    """Return a function of one number that gives NaN where math's raises: at infinity, as the compiled one does."""

    def total(x):
        return function(x) if abs(x) < math.inf else math.nan

    return total


# What plain twins find under the name math.
plain_math = SimpleNamespace(**{**vars(math), "cos": _total(math.cos), "sin": _total(math.sin)})


def _make_popcount():
    from numba.extending import intrinsic

    return intrinsic(_count_bits)


def put_in(function: Callable) -> Callable[[], Any]:
    """Return what makes the function as numba puts it in wherever it is called."""
    return lambda: compiler().njit(inline="always")(function)


popcount: Any = Builtin(_bits_of, _make_popcount, _count_bits) if JIT else _bits_of
word: Any = Builtin(_masked, put_in(_as_word), _as_word) if JIT else _masked
