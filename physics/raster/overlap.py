"""Two masks by AND of their words: the first pixel they share, how many, and where they lie.

dx, dy [px] is where B's raster starts, seen from A's. Only the rectangle that both solid bounds share is read.
"""

from physics.jit import subkernel, word
from physics.raster.bits import (
    bits_from,
    both,
    columns_up_to,
    count_bits,
    lowest_bit,
    moved,
    shared_row,
    shared_word,
    shifts_to,
    sum_of_places,
)


@subkernel
def shared_rectangle(a, b, dx, dy):
    """(left, top, right, bottom) of the solid bounds that two rasters share, in A's columns and rows."""
    return (
        max(a.set_left, b.set_left + dx),
        max(a.set_top, b.set_top + dy),
        min(a.set_right, b.set_right + dx),
        min(a.set_bottom, b.set_bottom + dy),
    )


@subkernel
def first_pixel(rasters, words, mask_a, mask_b, dx, dy):
    """The first shared pixel in reading order: (found, x, y) in A's columns and rows. O(words) at worst."""
    a = rasters[mask_a]
    b = rasters[mask_b]
    left, top, right, bottom = shared_rectangle(a, b, dx, dy)
    if left >= right or top >= bottom:
        return False, 0, 0
    if a.stride == 1 and b.stride == 1:
        row, shared = shared_row(words, a.offset + top, left, b.offset + top - dy, left - dx, bottom - top)
        return row < bottom - top, left + lowest_bit(shared), top + row
    for y in range(top, bottom):
        row_a = a.offset + y * a.stride
        row_b = b.offset + (y - dy) * b.stride
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
    """A row of A in which rasters of one word per row share a pixel, looked for from the guessed one on; -1: none.

    row_*: their first words; box_*: their solid bounds (left, top, right, bottom). O(1) where the guess is right, else
    O(rows).
    """
    left = max(box_a[0], box_b[0] + dx)
    top = max(box_a[1], box_b[1] + dy)
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
    """(area, sum of x, sum of y, how much more is shared one pixel to the left than to the right) of rasters of one
    word per row whose bounds meet; see line_shared and shared_moments. O(rows)."""
    up, down, kept = shifts_to(dx)
    left_up, left_down, left_kept = shifts_to(dx - 1)
    right_up, right_down, right_kept = shifts_to(dx + 1)
    from_b = row_b - dy
    area = 0
    sum_x = 0
    sum_y = 0
    more = 0
    for row in range(max(box_a[1], box_b[1] + dy), min(box_a[3], box_b[3] + dy)):
        a = words[word(row_a + row)]
        b = words[word(from_b + row)]
        shared = both(a, moved(b, up, down, kept))
        bits = count_bits(shared)
        area += bits
        sum_x += sum_of_places(shared)
        sum_y += bits * row
        more += count_bits(both(a, moved(b, left_up, left_down, left_kept)))
        more -= count_bits(both(a, moved(b, right_up, right_down, right_kept)))
    return area, sum_x, sum_y, more


@subkernel
def shared_area(rasters, words, mask_a, mask_b, dx, dy):
    """The number of shared pixels. O(words)."""
    a = rasters[mask_a]
    b = rasters[mask_b]
    left, top, right, bottom = shared_rectangle(a, b, dx, dy)
    area = 0
    if left >= right:
        return area
    if a.stride == 1 and b.stride == 1:
        for y in range(top, bottom):
            area += count_bits(shared_word(words, a.offset + y, left, b.offset + y - dy, left - dx))
        return area
    for y in range(top, bottom):
        row_a = a.offset + y * a.stride
        row_b = b.offset + (y - dy) * b.stride
        x = left
        while x < right:
            area += count_bits(
                both(
                    both(bits_from(words, row_a, a.stride, x), bits_from(words, row_b, b.stride, x - dx)),
                    columns_up_to(right - x),
                )
            )
            x += 64
    return area


@subkernel
def shared_moments(rasters, words, mask_a, mask_b, dx, dy):
    """(area, sum of x, sum of y) over the shared pixels, in A's columns and rows. O(words)."""
    a = rasters[mask_a]
    b = rasters[mask_b]
    left, top, right, bottom = shared_rectangle(a, b, dx, dy)
    area = 0
    sum_x = 0
    sum_y = 0
    if left >= right:
        return area, sum_x, sum_y
    for y in range(top, bottom):
        row_a = a.offset + y * a.stride
        row_b = b.offset + (y - dy) * b.stride
        x = left
        while x < right:
            shared = both(
                both(bits_from(words, row_a, a.stride, x), bits_from(words, row_b, b.stride, x - dx)),
                columns_up_to(right - x),
            )
            bits = count_bits(shared)
            area += bits
            sum_x += bits * x + sum_of_places(shared)
            sum_y += bits * y
            x += 64
    return area, sum_x, sum_y
