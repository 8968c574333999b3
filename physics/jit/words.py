"""Words of 64 bits in kernels: counting their bits, and values as words, compiled and as they are."""

from typing import Any

import numpy as np

from physics.jit.compiler import JIT, LISTING, numba

WORD_MASK = 0xFFFFFFFFFFFFFFFF


def _bits_of(word):
    return word.bit_count()


def _masked(value):
    return value & WORD_MASK


def _count_bits(typing_context, word):
    """Number of set bits of a uint64."""

    def generate(context, builder, signature, args):
        narrow = signature.args[0].bitwidth < 64
        count = builder.ctpop(args[0])
        return builder.zext(count, context.get_value_type(signature.return_type)) if narrow else count

    return numba.types.int64(numba.types.uint64), generate


def _as_word(value):
    """The value as an unsigned 64-bit word."""
    return np.uint64(value)


popcount: Any = _bits_of  # Any: called with one argument, and declared with the context's too
word: Any = _masked
if JIT:
    from numba.extending import intrinsic

    popcount, word = intrinsic(_count_bits), numba.njit(inline="always")(_as_word)
if LISTING:
    from physics.jit.dispatchers import Listed

    class _ListedIntrinsic(numba.core.extending._Intrinsic):
        __call__ = staticmethod(_bits_of)

    popcount.__class__, word.__class__ = _ListedIntrinsic, Listed
    word.plain = _masked
