"""Pixels as bits of 64-bit words: bit operations, overlap of two masks, and rotation of a mask to one of 128 angles.

Bit b of word k in a row is the pixel in column 64k + b. Words are uint64. Shift counts are always in 0..63.
"""

import math
from dataclasses import dataclass

import numpy as np

from physics.jit import subkernel
from physics.jit.plain import popcount, word

# ---- bits ------------------------------------------------------------------------------------------------------------


@subkernel
def bits_from(words, row, stride, start):
    """Return the 64 pixels of a row in columns `start` to start + 63 as a word. Pixels outside the row are clear.

    words (n,) uint64: pixels; row: index of the row's first word; stride: number of words per row. O(1).
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
    """Return a word whose lowest `count` bits are set: none for count <= 0, all for count >= 64."""
    if count >= 64:
        return word(0xFFFFFFFFFFFFFFFF)
    if count <= 0:
        return word(0)
    return word((word(1) << word(count)) - word(1))


@subkernel
def lowest_bit(value):
    """Return the index of the lowest set bit of a word that is not zero."""
    # ~value & (value - 1) has exactly the bits below the lowest set one.
    return popcount(word(word(value - word(1)) & word(value ^ word(0xFFFFFFFFFFFFFFFF))))


@subkernel
def sum_of_places(value):
    """Return the sum of the indices of all set bits of a word (Knuth 4A, 7.1.3).

    For each binary digit of the indices, the set bits whose index has this digit are counted, and weighted by its
    value.
    """
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
    """Return a word with its lowest set bit cleared."""
    return word(value & word(value - word(1)))


@subkernel
def both(a, b):
    """Return the pixels set in both words a and b."""
    return word(a & b)


@subkernel
def either(a, b):
    """Return the pixels set in at least one of the words a and b."""
    return word(a | b)


@subkernel
def first_run(value):
    """Return (start, end) of the lowest sequence of set bits of a word that is not zero; end is exclusive."""
    start = lowest_bit(value)
    clear = word((value >> word(start)) ^ word(0xFFFFFFFFFFFFFFFF))
    return start, 64 if clear == word(0) else start + lowest_bit(clear)


@subkernel
def run_bits(start, end):
    """Return a word whose bits start..end - 1 are set; end may be 64."""
    return word(columns_up_to(end) ^ columns_up_to(start))


@subkernel
def minus(a, b):
    """Return the pixels set in word a and not in word b."""
    return word(a & word(b ^ word(0xFFFFFFFFFFFFFFFF)))


@subkernel
def touch(a, b):
    """Return whether a pixel of word a touches a pixel of word b, also diagonally.

    a, b: pixels in the same 64 columns of adjacent rows, or in the same 64 rows of adjacent columns.
    """
    return word(word(a | word(a << word(1)) | word(a >> word(1))) & b) != word(0)


@subkernel
def has_bit(value, place):
    """Return whether the bit with index `place` is set in a word."""
    return word(word(value >> word(place)) & word(1)) != word(0)


@subkernel
def is_set(words, row, x):
    """Return whether the pixel in column x of a row is set.

    words (n,) uint64: pixels; row: index in `words` of the row's first word; x must be inside the row.
    """
    return (word(words[row + (x >> 6)] >> word(x & 63)) & word(1)) != word(0)


@subkernel
def shared_word(words, word_a, shift_a, word_b, shift_b):
    """Return the pixels set in both of two words after shifting each of them to lower columns.

    words (n,) uint64; word_a, word_b: indices of the two words; shift_a, shift_b: number of columns by which each is
    shifted, 0..63. The indices are converted to unsigned, which saves the check for negative values.
    """
    return word(word(words[word(word_a)] >> word(shift_a)) & word(words[word(word_b)] >> word(shift_b)))


@subkernel
def shifts_to(columns):
    """Return the arguments (up, down, kept) with which `moved` shifts a word by -64 to 64 columns to the right."""
    kept = word(0xFFFFFFFFFFFFFFFF) if abs(columns) < 64 else word(0)
    return word(max(columns, 0) & 63), word(max(-columns, 0) & 63), kept


@subkernel
def moved(value, up, down, kept):
    """Return a word after a shift up by `up` bits, a shift down by `down` bits, and an AND with `kept`.

    up, down, kept: result of shifts_to.
    """
    return word(word(word(value << up) >> down) & kept)


@subkernel
def shared_row(words, word_a, shift_a, word_b, shift_b, rows):
    """Return (row, shared pixels) of the first row in which two rasters overlap; (rows, 0) if there is none.

    Both rasters are one word wide, so the shared pixels are a word. The returned row is counted from the first compared
    row. word_a, word_b: index in `words` of each raster's word in the first compared row; shift_a, shift_b: number of
    columns to skip on the left of each raster; rows: number of compared rows. The right end needs no mask, because
    words are clear beyond the solid pixels. O(rows).
    """
    for row in range(rows):
        shared = shared_word(words, word_a + row, shift_a, word_b + row, shift_b)
        if shared != word(0):
            return row, shared
    return rows, word(0)


def packed(solid: np.ndarray) -> np.ndarray:
    """Return the pixels solid[row, col] as packed words, (rows, ceil(columns/64)) uint64.

    The lowest bit of a word is the leftmost pixel.
    """
    height, width = solid.shape
    padded = np.zeros((height, -(-width // 64) * 64), bool)
    padded[:, :width] = solid
    return np.packbits(padded, axis=1, bitorder="little").view("<u8").astype(np.uint64)


def halo(solid: np.ndarray) -> np.ndarray:
    """Return, as packed words, the pixels that are solid or have a solid pixel among their 8 neighbours.

    The raster of the result is larger than solid[row, col] by one pixel on each side.
    """
    rows, columns = solid.shape
    grown = np.zeros((rows + 2, columns + 2), bool)
    for y in range(3):
        for x in range(3):
            grown[y : y + rows, x : x + columns] |= solid
    return packed(grown)


# ---- overlap ---------------------------------------------------------------------------------------------------------
# Overlap of two masks by AND of their words: first shared pixel, number and moments of the shared pixels.
#
# A and B are the two masks; dx, dy [px]: top left corner of B's raster in A's raster. Only words in the intersection of
# the two masks' solid bounds are read.


@subkernel
def shared_rectangle(a, b, dx, dy):
    """Return the box (left, top, right, bottom) in raster a where the bounding boxes of both solid areas overlap.

    a, b: RASTER rows; dx, dy [px]: position of b's top left corner in a.
    """
    return (
        max(a.set_left, b.set_left + dx),
        max(a.set_top, b.set_top + dy),
        min(a.set_right, b.set_right + dx),
        min(a.set_bottom, b.set_bottom + dy),
    )


@subkernel
def first_pixel(rasters, words, mask_a, mask_b, dx, dy):
    """Return (found, x, y) of the first pixel, row by row, that is solid in both masks A and B.

    x, y: column and row of the pixel in A. rasters: RASTER rows; words: uint64; mask_a, mask_b: RASTER row numbers; dx,
    dy [px]: position of B's top left corner in A. O(words) at worst.
    """
    a, b = rasters[mask_a], rasters[mask_b]
    left, top, right, bottom = shared_rectangle(a, b, dx, dy)
    if left >= right or top >= bottom:
        return False, 0, 0
    if a.stride == 1 and b.stride == 1:
        row, shared = shared_row(words, a.offset + top, left, b.offset + top - dy, left - dx, bottom - top)
        return row < bottom - top, left + lowest_bit(shared), top + row
    for y in range(top, bottom):
        row_a, row_b = a.offset + y * a.stride, b.offset + (y - dy) * b.stride
        x = left
        while x < right:
            shared = both(
                both(bits_from(words, row_a, a.stride, x), bits_from(words, row_b, b.stride, x - dx)),
                columns_up_to(right - x),
            )
            if shared != word(0):
                return True, x + lowest_bit(shared), y
            x += 64
    return False, 0, 0


@subkernel
def line_shared(words, row_a, box_a, row_b, box_b, dx, dy, guess):
    """Return a row of raster A that contains a pixel shared with raster B, or -1 if they share none.

    Both rasters are one word wide. row_a, row_b: index in `words` of the first word of each raster; box_a, box_b:
    bounding box (left, top, right, bottom) of each raster's solid pixels; dx, dy [px]: position of B's top left corner
    in A; guess: row of A that is tested first. O(1) if this row contains a shared pixel, else O(rows).
    """
    left, top = max(box_a[0], box_b[0] + dx), max(box_a[1], box_b[1] + dy)
    if left >= min(box_a[2], box_b[2] + dx):
        return -1
    bottom = min(box_a[3], box_b[3] + dy)
    from_b = row_b - dy
    first = guess if top <= guess < bottom else top
    for row in range(first, bottom):
        if shared_word(words, row_a + row, left, from_b + row, left - dx) != word(0):
            return row
    for row in range(top, first):
        if shared_word(words, row_a + row, left, from_b + row, left - dx) != word(0):
            return row
    return -1


@subkernel
def line_moments(words, row_a, box_a, row_b, box_b, dx, dy):
    """Return (area, sum of x, sum of y, difference) over the shared pixels of rasters A and B, each one word wide.

    area: number of shared pixels; x, y: column and row in A; difference [px2]: the area shared with B moved one pixel
    to the left, minus that with B moved one pixel to the right. The bounding boxes of the solid pixels of A and B must
    overlap. Arguments as in line_shared. O(rows).
    """
    up, down, kept = shifts_to(dx)
    left_up, left_down, left_kept = shifts_to(dx - 1)
    right_up, right_down, right_kept = shifts_to(dx + 1)
    from_b = row_b - dy
    area = 0
    sum_x, sum_y = 0, 0
    more = 0
    for row in range(max(box_a[1], box_b[1] + dy), min(box_a[3], box_b[3] + dy)):
        a, b = words[word(row_a + row)], words[word(from_b + row)]
        shared = both(a, moved(b, up, down, kept))
        bits = popcount(shared)
        area += bits
        sum_x += sum_of_places(shared)
        sum_y += bits * row
        more += popcount(both(a, moved(b, left_up, left_down, left_kept)))
        more -= popcount(both(a, moved(b, right_up, right_down, right_kept)))
    return area, sum_x, sum_y, more


@subkernel
def shared_area(rasters, words, mask_a, mask_b, dx, dy):
    """Return the number of pixels that are solid in both masks A and B. Arguments as in first_pixel. O(words)."""
    a, b = rasters[mask_a], rasters[mask_b]
    left, top, right, bottom = shared_rectangle(a, b, dx, dy)
    area = 0
    if left >= right:
        return area
    if a.stride == 1 and b.stride == 1:
        for y in range(top, bottom):
            area += popcount(shared_word(words, a.offset + y, left, b.offset + y - dy, left - dx))
        return area
    for y in range(top, bottom):
        row_a, row_b = a.offset + y * a.stride, b.offset + (y - dy) * b.stride
        x = left
        while x < right:
            area += popcount(
                both(
                    both(bits_from(words, row_a, a.stride, x), bits_from(words, row_b, b.stride, x - dx)),
                    columns_up_to(right - x),
                )
            )
            x += 64
    return area


@subkernel
def shared_moments(rasters, words, mask_a, mask_b, dx, dy):
    """Return (area, sum of x, sum of y) over the pixels that are solid in both masks A and B.

    area: number of these pixels; x, y: column and row in A. Arguments as in first_pixel. O(words).
    """
    a, b = rasters[mask_a], rasters[mask_b]
    left, top, right, bottom = shared_rectangle(a, b, dx, dy)
    area = 0
    sum_x, sum_y = 0, 0
    if left >= right:
        return area, sum_x, sum_y
    for y in range(top, bottom):
        row_a, row_b = a.offset + y * a.stride, b.offset + (y - dy) * b.stride
        x = left
        while x < right:
            shared = both(
                both(bits_from(words, row_a, a.stride, x), bits_from(words, row_b, b.stride, x - dx)),
                columns_up_to(right - x),
            )
            bits = popcount(shared)
            area += bits
            sum_x += bits * x + sum_of_places(shared)
            sum_y += bits * y
            x += 64
    return area, sum_x, sum_y


# ---- rotate ----------------------------------------------------------------------------------------------------------
# Rotation of a mask to an angle bucket, one of 128 angles, always from the unrotated mask (source).
#
# A pixel whose centre falls on a solid source pixel is solid, which keeps thin lines in one piece. Then the number of
# solid pixels is made equal to the source's number: pixels with the most coverage are added, or pixels with the least
# coverage are removed where the removal disconnects nothing. Each pixel stores its source pixel, so that a sprite can
# be drawn from exactly the pixels that collide.

SAMPLES = 5  # sampled points per side of a pixel, one at its centre: coverage in steps of 1/25
OFFSETS = sorted(
    (((i + 0.5) / SAMPLES, (j + 0.5) / SAMPLES) for j in range(SAMPLES) for i in range(SAMPLES)),
    key=lambda at: ((at[0] - 0.5) ** 2 + (at[1] - 0.5) ** 2, at),
)
BAND = 1 << 14  # pixels rotated per pass: temporary arrays stay in the cache and do not fragment the heap


@dataclass(frozen=True)
class Turned:
    """A mask rotated to one angle, returned by PixelMask.turned.

    solid: pixels of the rotated mask, bool [row, col].
    origin: origin of body space (x, y) [px], from the top left corner of `solid`.
    source_x, source_y: column and row in the unrotated mask from which each pixel was sampled, int16 [row, col];
        -1 where clear.
    """

    solid: np.ndarray
    origin: tuple[float, float]
    source_x: np.ndarray  # (rows, columns) int16: column of each pixel's source in the unrotated mask, -1 where clear
    source_y: np.ndarray


def bucket_of(angle: float, buckets: int) -> int:
    """Return the index of the angle bucket nearest to `angle` [rad]. A full turn has `buckets` equal buckets."""
    return int(math.floor(angle * buckets / math.tau + 0.5)) % buckets


def turn(solid: np.ndarray, origin: tuple[float, float], bucket: int, buckets: int) -> Turned:
    """Return the mask solid[row, col] after a rotation about its origin [px] by bucket/buckets of a full turn.

    The rotation is clockwise on the screen.
    """
    rows, columns = np.ogrid[: solid.shape[0], : solid.shape[1]]
    source_x, source_y = (np.where(solid, each, -1).astype(np.int16) for each in (columns, rows))
    if solid.size == 0 or not solid.any():
        return Turned(solid, origin, source_x, source_y)
    if 4 * bucket % buckets == 0:
        return _quarter_turns(solid, origin, source_x, source_y, 4 * bucket // buckets)
    return _any_turn(solid, origin, math.tau * bucket / buckets)


def _quarter_turns(solid, origin, source_x, source_y, turns: int):
    height, width = solid.shape
    x, y = origin
    origins = ((x, y), (height - y, x), (width - x, height - y), (y, width - x))
    turned = [np.ascontiguousarray(np.rot90(each, -turns)) for each in (solid, source_x, source_y)]
    return Turned(turned[0], origins[turns], turned[1], turned[2])


def _any_turn(solid, origin, angle):
    cosine, sine = math.cos(angle), math.sin(angle)
    columns, rows = (np.flatnonzero(solid.any(axis=axis)) for axis in (0, 1))
    left, top, right, bottom = columns[0], rows[0], columns[-1] + 1, rows[-1] + 1
    corner_x = np.array([left, right, right, left]) - origin[0]
    corner_y = np.array([top, top, bottom, bottom]) - origin[1]
    out_x, out_y = cosine * corner_x - sine * corner_y, sine * corner_x + cosine * corner_y
    origin_x, origin_y = -math.floor(out_x.min()), -math.floor(out_y.min())
    width, height = math.ceil(out_x.max()) + origin_x, math.ceil(out_y.max()) + origin_y

    padded = np.pad(solid, 1)  # a clear border for samples outside the source
    mixed = _mixed(padded)
    centered, coverage = np.empty((height, width), bool), np.empty((height, width), np.uint8)
    sources = np.empty((2, height, width), np.int16)
    along = np.arange(float(width)) - origin_x
    deep = max(1, BAND // width)
    for top in range(0, height, deep):
        band = slice(top, top + deep)
        down = np.arange(float(height))[band, None] - origin_y
        base_x = (cosine * along + sine * down + (origin[0] + 1.0)).ravel()
        base_y = (cosine * down - sine * along + (origin[1] + 1.0)).ravel()
        middle, covered, source = _sampled(padded, mixed, base_x, base_y, cosine, sine)
        centered[band], coverage[band] = middle.reshape(-1, width), covered.reshape(-1, width)
        sources[:, band] = np.stack(np.divmod(source, padded.shape[1])).reshape(2, -1, width) - 1
    kept = _as_many(centered, coverage, int(solid.sum()))
    source_y, source_x = np.where(kept, sources, np.int16(-1))
    return Turned(kept, (float(origin_x), float(origin_y)), source_x, source_y)


def _sampled(padded, mixed, base_x, base_y, cosine, sine):
    """Sample a mask at the pixels of its rotated raster. Return (solid, samples, source), arrays over these pixels.

    solid: whether the mask is solid at the pixel's centre; samples: number of the pixel's sample points at which the
    mask is solid; source: flat index in `padded` of the pixel under the first solid sample point, -1 for none. padded:
    pixels of the unrotated mask with a clear border; mixed: result of _mixed; base_x, base_y [px]: first corner of each
    rotated pixel in `padded`; cosine, sine: cosine and sine of the rotation.
    """
    rows, columns = padded.shape

    def at(base_x, base_y, offset):
        x, y = offset
        at_x = np.clip(base_x + (cosine * x + sine * y), 0.0, columns - 1.0).astype(np.intp)
        at_y = np.clip(base_y + (cosine * y - sine * x), 0.0, rows - 1.0).astype(np.intp)
        return at_y * columns + at_x

    middle, *others = OFFSETS
    source = at(base_x, base_y, middle)
    centered = padded.ravel()[source]
    # Samples lie less than a pixel from the centre: where all 3 x 3 source pixels are equal, all samples equal the
    # centre.
    some = np.flatnonzero(mixed.ravel()[source])
    coverage = centered * np.uint8(len(OFFSETS))
    source = np.where(centered, source, -1)  # the centre determines the colour
    covered, found, base_x, base_y = centered[some].astype(np.uint8), source[some], base_x[some], base_y[some]
    for offset in others:
        sample = at(base_x, base_y, offset)
        hit = padded.ravel()[sample]
        found = np.where(hit & (found < 0), sample, found)
        covered += hit
    coverage[some], source[some] = covered, found
    return centered, coverage, source


def _mixed(padded):
    """Return, for each pixel of `padded`, whether the 3 x 3 pixels around it include both solid and clear ones."""
    wide = np.pad(padded, 1).view(np.uint8)
    row = wide[:, :-2] + wide[:, 1:-1] + wide[:, 2:]
    count = row[:-2] + row[1:-1] + row[2:]
    return (count > 0) & (count < 9)


def _as_many(centered, coverage, wanted):
    """Return the solid pixels of a rotated mask, [row, col] bool. If possible, `wanted` pixels are solid.

    The pixels whose centres are solid (`centered`) are solid at first. If these are too few, the most covered other
    pixels are added. If they are too many, the least covered pixels are removed, except pixels whose removal would
    disconnect other pixels. coverage [row, col]: number of solid samples of each pixel.
    """
    kept = centered.copy()
    missing = wanted - int(kept.sum())
    if missing > 0:
        kept.ravel()[_in_order(~kept & (coverage > 0), -coverage.astype(np.int8))[:missing]] = True
        return kept
    padded = np.pad(kept, 1)
    whole = coverage == len(OFFSETS)
    for some in (kept & ~whole, kept & whole):
        for at in _in_order(some, coverage).tolist():
            if missing == 0:
                return padded[1:-1, 1:-1]
            row, column = divmod(at, kept.shape[1])
            if _is_simple(padded[row : row + 3, column : column + 3]):
                padded[row + 1, column + 1] = False
                missing += 1
    return padded[1:-1, 1:-1]


def _in_order(some, key):
    """Return the flat indices of the pixels where `some` is true, sorted by `key`, then by row and column."""
    at = np.flatnonzero(some)
    return at[np.argsort(key.ravel()[at], kind="stable")]


def _is_simple(around):
    """Return whether clearing the middle of 3 x 3 pixels leaves its solid neighbours connected (simple point).

    around (3, 3) bool: the pixels. The result is False if no neighbour is solid, or if all four side neighbours are.
    """
    ring = [bool(around[y, x]) for y, x in ((0, 0), (0, 1), (0, 2), (1, 2), (2, 2), (2, 1), (2, 0), (1, 0))]
    if not any(ring) or all(ring[1::2]):
        return False  # isolated, or interior
    # A corner between two solid sides counts as solid. Count the changes from clear to solid along the ring.
    joined = [solid or (k % 2 == 0 and ring[k - 1] and ring[(k + 1) % 8]) for k, solid in enumerate(ring)]
    return sum(not joined[k - 1] and joined[k] for k in range(8)) == 1
