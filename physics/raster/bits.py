"""Packed pixels: bit b of word k in a row is x = 64k + b. Words are uint64, shift counts are kept in 0..63."""

import numpy as np

from physics.jit import popcount, subkernel, word


@subkernel
def bits_from(words, row, stride, start):
    """The 64 pixels of a row from column `start` on, which may lie left or right of the raster: clear there.

    words: uint64 pixels; row: first word of the row; stride: words per row. O(1).
    """
    index = start >> 6
    shift = start & 63
    low = word(0)
    if 0 <= index < stride:
        low = word(words[row + index] >> word(shift))
    if shift > 0 and -1 <= index < stride - 1:
        low = word(low | word(words[row + index + 1] << word(64 - shift)))
    return low


@subkernel
def columns_up_to(count):
    """A word whose lowest `count` bits are set; all of them from 64 on."""
    if count >= 64:
        return word(0xFFFFFFFFFFFFFFFF)
    if count <= 0:
        return word(0)
    return word((word(1) << word(count)) - word(1))


@subkernel
def lowest_bit(value):
    """Place of the lowest set bit of a word that is not zero."""
    # The bits below the lowest set one are exactly those of (value - 1) that value has not.
    return popcount(word(word(value - word(1)) & word(value ^ word(0xFFFFFFFFFFFFFFFF))))


@subkernel
def count_bits(value):
    """Number of set bits."""
    return popcount(value)


@subkernel
def without_lowest(value):
    """The word with its lowest set bit cleared."""
    return word(value & word(value - word(1)))


@subkernel
def both(a, b):
    """Pixels set in both words."""
    return word(a & b)


@subkernel
def is_set(words, row, x):
    """Whether the pixel in column x of a row is set; x must lie within the row."""
    return (word(words[row + (x >> 6)] >> word(x & 63)) & word(1)) != word(0)


@subkernel
def shared_word(words, word_a, shift_a, word_b, shift_b, keep):
    """The kept pixels that two words share once each is shifted down by 0..63 columns."""
    return word(word(words[word_a] >> word(shift_a)) & word(words[word_b] >> word(shift_b)) & keep)


@subkernel
def first_shared_row(words, word_a, shift_a, word_b, shift_b, rows, keep):
    """(row, shared pixels) of the first of `rows` rows of one word each that share a kept pixel;
    (rows, 0) when none does.

    Looks at all rows: without a branch the loop is vectorised, and beats one that stops at the first hit, whose place
    no processor predicts. Unsigned indices spare the check for negative ones. O(rows).
    """
    from_a = word(word_a)
    from_b = word(word_b)
    down_a = word(shift_a)
    down_b = word(shift_b)
    last = word(rows)
    first = last
    for y in range(last):
        shared = word(words[from_a + y] >> down_a) & word(words[from_b + y] >> down_b) & keep
        first = min(first, y if shared != word(0) else last)
    if first == last:
        return rows, word(0)
    return int(first), word(words[from_a + first] >> down_a) & word(words[from_b + first] >> down_b) & keep


def packed(solid: np.ndarray) -> np.ndarray:
    """solid[row, col] as (rows, ceil(columns/64)) uint64, lowest bit first."""
    height, width = solid.shape
    padded = np.zeros((height, -(-width // 64) * 64), bool)
    padded[:, :width] = solid
    return np.packbits(padded, axis=1, bitorder="little").view("<u8").astype(np.uint64)
