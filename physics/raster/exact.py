"""Two masks as unions of pixel squares, one turned and moved by any amount: do they share area, and where.

A is the mask whose raster everything is seen in, and which has a halo: its solid pixels and their eight neighbours, as
packed words one pixel larger all round. The square of a pixel of B shares area with a square of A only if its centre
falls on the halo, as no square reaches further than half its diagonal, 0.71 px. So a miss costs one bit for each pixel
of B within A's bounds, and the test of two squares where the outlines are near each other.

u, v [px] is where B's raster starts, seen from A's; cosine, sine: of its angle there. Squares are open: those that
touch, within rounding, share nothing.
"""

import math

from physics.jit import subkernel, word
from physics.raster.bits import bits_from, both, columns_up_to, is_set, lowest_bit, without_lowest
from physics.raster.overlap import first_pixel

ROUNDED = 2.0**-50  # of the size: what coordinates are off by


@subkernel
def slack_of(a, b):
    """[px] by which two squares of these rasters must be in each other to share area: what may be rounding is none."""
    return ROUNDED * (a.width + a.height + b.width + b.height)


@subkernel
def reach_of(cosine, sine):
    """[px] nearer than this along the axes of both lie the centres of two unit squares that share area."""
    return 0.5 + 0.5 * (abs(cosine) + abs(sine))


@subkernel
def do_squares_meet(dx, dy, cosine, sine, near):
    """Whether two unit squares share area, by the separating axis test: B's centre is at dx, dy [px] from A's."""
    return (
        abs(dx) < near
        and abs(dy) < near
        and abs(cosine * dx + sine * dy) < near
        and abs(cosine * dy - sine * dx) < near
    )


@subkernel
def leave_square(dx, dy, cosine, sine, reach, nx, ny):
    """How far [px] B's square moves along a unit direction until it leaves A's: the first axis that parts them."""
    least = math.inf
    for axis in range(4):
        ax = (1.0 if axis == 0 else 0.0) if axis < 2 else (cosine if axis == 2 else -sine)
        ay = (0.0 if axis == 0 else 1.0) if axis < 2 else (sine if axis == 2 else cosine)
        speed = ax * nx + ay * ny
        place = ax * dx + ay * dy
        if speed > 0.0:
            least = min(least, (reach - place) / speed)
        elif speed < 0.0:
            least = min(least, (-reach - place) / speed)
    return least


@subkernel
def box_in_raster(a, b, u, v, cosine, sine):
    """(left, top, right, bottom) of the pixels of B whose squares may meet the solid bounds of A."""
    half_x = 0.5 * (a.set_right - a.set_left)
    half_y = 0.5 * (a.set_bottom - a.set_top)
    dx = a.set_left + half_x - u
    dy = a.set_top + half_y - v
    x = cosine * dx + sine * dy
    y = cosine * dy - sine * dx
    reach_x = abs(cosine) * half_x + abs(sine) * half_y
    reach_y = abs(sine) * half_x + abs(cosine) * half_y
    return (
        int(max(float(b.set_left), math.floor(x - reach_x))),
        int(max(float(b.set_top), math.floor(y - reach_y))),
        int(min(float(b.set_right), math.ceil(x + reach_x))),
        int(min(float(b.set_bottom), math.ceil(y + reach_y))),
    )


@subkernel
def clip_run(low, high, start, step, least, most):
    """The part of low..high in which least <= start + step * t <= most."""
    if step > 0.0:
        return max(low, (least - start) / step), min(high, (most - start) / step)
    if step < 0.0:
        return max(low, (most - start) / step), min(high, (least - start) / step)
    return low, high if least <= start <= most else low - 1.0


@subkernel
def run_near(a, left, right, x, y, cosine, sine, margin):
    """(first, last + 1) of the columns left..right of a row of B whose centres lie within the solid bounds of A, grown
    by a margin [px]. x, y: the centre of column 0."""
    low, high = clip_run(float(left), right - 1.0, x, cosine, a.set_left - margin, a.set_right + margin)
    low, high = clip_run(low, high, y, sine, a.set_top - margin, a.set_bottom + margin)
    # A row that runs past at a shallow angle is met beyond any whole number.
    return math.ceil(min(low, float(right))), math.floor(max(high, left - 1.0)) + 1


@subkernel
def square_under(words, a, x, y, cosine, sine, near):
    """(found, column, row) of the first pixel of A whose square meets that of B with its centre at x, y. O(1)."""
    column = math.floor(x)
    row = math.floor(y)
    for j in range(max(0, row - 1), min(a.height, row + 2)):
        solid = both(bits_from(words, a.offset + j * a.stride, a.stride, column - 1), columns_up_to(3))
        while solid != word(0):
            i = column - 1 + lowest_bit(solid)
            solid = without_lowest(solid)
            if do_squares_meet(x - (i + 0.5), y - (j + 0.5), cosine, sine, near):
                return True, i, j
    return False, 0, 0


@subkernel
def first_upright(rasters, words, mask_a, mask_b, u, v):
    """As first_squares, where both lie alike: a pixel of B covers up to four of A, so up to four ANDs. O(words)."""
    slack = slack_of(rasters[mask_a], rasters[mask_b])
    column = math.floor(u + slack)
    row = math.floor(v + slack)
    for down in range(2 if v - row > slack else 1):
        for across in range(2 if u - column > slack else 1):
            found, x, y = first_pixel(rasters, words, mask_a, mask_b, column + across, row + down)
            if found:
                return True, x, y, x - column - across, y - row - down
    return False, 0, 0, 0, 0


@subkernel
def first_squares(rasters, words, mask_a, mask_b, u, v, cosine, sine):
    """The first two squares found that share area: (found, column and row in A, column and row in B).

    O(pixels of B within A's bounds) at worst; a hit ends it.
    """
    if cosine == 1.0 and sine == 0.0:
        return first_upright(rasters, words, mask_a, mask_b, u, v)
    a = rasters[mask_a]
    b = rasters[mask_b]
    reach = reach_of(cosine, sine)
    near = reach - slack_of(a, b)
    left, top, right, bottom = box_in_raster(a, b, u, v, cosine, sine)
    for row in range(top, bottom):
        x = u + 0.5 * cosine - (row + 0.5) * sine
        y = v + 0.5 * sine + (row + 0.5) * cosine
        start, end = run_near(a, left, right, x, y, cosine, sine, reach - 0.5)
        while start < end:
            solid = both(bits_from(words, b.offset + row * b.stride, b.stride, start), columns_up_to(end - start))
            while solid != word(0):
                column = start + lowest_bit(solid)
                solid = without_lowest(solid)
                px = x + column * cosine
                py = y + column * sine
                if is_set(words, a.halo + (math.floor(py) + 1) * a.halo_stride, math.floor(px) + 1):
                    found, i, j = square_under(words, a, px, py, cosine, sine, near)
                    if found:
                        return True, i, j, column, row
            start += 64
    return False, 0, 0, 0, 0


@subkernel
def squares_way_out(rasters, words, mask_a, mask_b, u, v, cosine, sine, nx, ny, most):
    """The least move [px] of B along a unit direction of A's raster after which no area is shared; > most when none is.

    Two squares share area on one stretch of the move: each pair found is passed by at its end, none comes twice,
    and the end of the last is the move. O(first_squares · pairs passed).
    """
    reach = reach_of(cosine, sine)
    slack = slack_of(rasters[mask_a], rasters[mask_b])
    depth = 0.0
    while depth <= most:
        x = u + depth * nx
        y = v + depth * ny
        found, i, j, column, row = first_squares(rasters, words, mask_a, mask_b, x, y, cosine, sine)
        if not found:
            return depth
        dx = x + cosine * (column + 0.5) - sine * (row + 0.5) - (i + 0.5)
        dy = y + sine * (column + 0.5) + cosine * (row + 0.5) - (j + 0.5)
        depth += max(leave_square(dx, dy, cosine, sine, reach, nx, ny), slack)
    return depth
