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
def sum_of_places(value):
    """The sum of the places of all set bits: each binary digit of a place counts the bits that have it (Knuth 4A,
    7.1.3)."""
    return (
        popcount(word(value & word(0xAAAAAAAAAAAAAAAA)))
        + 2 * popcount(word(value & word(0xCCCCCCCCCCCCCCCC)))
        + 4 * popcount(word(value & word(0xF0F0F0F0F0F0F0F0)))
        + 8 * popcount(word(value & word(0xFF00FF00FF00FF00)))
        + 16 * popcount(word(value & word(0xFFFF0000FFFF0000)))
        + 32 * popcount(word(value & word(0xFFFFFFFF00000000)))
    )


@subkernel
def without_lowest(value):
    """The word with its lowest set bit cleared."""
    return word(value & word(value - word(1)))


@subkernel
def both(a, b):
    """Pixels set in both words."""
    return word(a & b)


@subkernel
def either(a, b):
    """Pixels set in one of the words."""
    return word(a | b)


@subkernel
def first_run(value):
    """(start, end) of the lowest row of set bits of a word that is not zero; end is exclusive."""
    start = lowest_bit(value)
    clear = word((value >> word(start)) ^ word(0xFFFFFFFFFFFFFFFF))
    return start, 64 if clear == word(0) else start + lowest_bit(clear)


@subkernel
def run_bits(start, end):
    """A word whose bits from start on are set, up to end, which may be 64."""
    return word(columns_up_to(end) ^ columns_up_to(start))


@subkernel
def minus(a, b):
    """Pixels set in a word and not in the other."""
    return word(a & word(b ^ word(0xFFFFFFFFFFFFFFFF)))


@subkernel
def touch(a, b):
    """Whether a pixel of one word is the neighbour, side or corner, of one in the word of the line beside."""
    return word(word(a | word(a << word(1)) | word(a >> word(1))) & b) != word(0)


@subkernel
def has_bit(value, place):
    """Whether a bit of a word is set."""
    return word(word(value >> word(place)) & word(1)) != word(0)


@subkernel
def is_set(words, row, x):
    """Whether the pixel in column x of a row is set; x must lie within the row."""
    return (word(words[row + (x >> 6)] >> word(x & 63)) & word(1)) != word(0)


@subkernel
def shared_word(words, word_a, shift_a, word_b, shift_b):
    """The pixels that two words share once each is shifted down by 0..63 columns. word_*: unsigned, which spares the
    check for negative ones."""
    return word(word(words[word(word_a)] >> word(shift_a)) & word(words[word(word_b)] >> word(shift_b)))


@subkernel
def shifts_to(columns):
    """(up, down, kept) by which `moved` brings a word by -64 to 64 columns to the right."""
    kept = word(0xFFFFFFFFFFFFFFFF) if abs(columns) < 64 else word(0)
    return word(max(columns, 0) & 63), word(max(-columns, 0) & 63), kept


@subkernel
def moved(value, up, down, kept):
    """A word shifted up, then down, and cut to what is kept."""
    return word(word(word(value << up) >> down) & kept)


@subkernel
def shared_row(words, word_a, shift_a, word_b, shift_b, rows):
    """(row, shared pixels) of the first of `rows` rows of one word each that share a pixel; (rows, 0) when none does.

    word_*: where in the words the rows begin; shift_*: columns on the left that are not looked at. On the right nothing
    has to be cut off: beyond their solid bounds words are clear. O(rows).
    """
    for row in range(rows):
        shared = shared_word(words, word_a + row, shift_a, word_b + row, shift_b)
        if shared != word(0):
            return row, shared
    return rows, word(0)


def packed(solid: np.ndarray) -> np.ndarray:
    """solid[row, col] as (rows, ceil(columns/64)) uint64, lowest bit first."""
    height, width = solid.shape
    padded = np.zeros((height, -(-width // 64) * 64), bool)
    padded[:, :width] = solid
    return np.packbits(padded, axis=1, bitorder="little").view("<u8").astype(np.uint64)


def halo(solid: np.ndarray) -> np.ndarray:
    """The packed pixels that are solid or next to a solid one, side or corner, in a raster larger by one all round."""
    rows, columns = solid.shape
    grown = np.zeros((rows + 2, columns + 2), bool)
    for y in range(3):
        for x in range(3):
            grown[y : y + rows, x : x + columns] |= solid
    return packed(grown)
