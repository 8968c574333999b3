"""Exact overlap of two masks at any pose, as unions of pixel squares: overlap test, shared area and its centroid."""

import math
from typing import NamedTuple

import numpy as np

from physics.jit import inlined, subkernel
from physics.jit.plain import popcount, word
from physics.math2d import clamp
from physics.raster.bits import (
    bits_from,
    both,
    columns_up_to,
    first_pixel,
    first_run,
    has_bit,
    is_set,
    lowest_bit,
    minus,
    run_bits,
    sum_of_places,
    without_lowest,
)

# ---- exact -----------------------------------------------------------------------------------------------------------
# Overlap of two masks as unions of pixel squares, one rotated and moved by any amount.
#
# A is the mask whose raster is the frame of reference; B is the other mask. A has a halo: the pixels that are solid or
# have a solid pixel among their eight neighbours, in a raster one pixel larger on each side. The square of a pixel of B
# shares area with a square of A only if the centre of B's pixel is on the halo, because no square extends further from
# its centre than half its diagonal, 0.71 px. So a miss costs one bit test for each pixel of B within A's bounds.
# Squares are tested only where the outlines are near each other.
#
# u, v [px]: top left corner of B's raster in A's raster; cosine, sine: cosine and sine of B's angle in A's raster.
# Squares that only touch, within rounding errors, share no area.

ROUNDED = 2.0**-50  # rounding error of coordinates, as a fraction of the masks' sizes


class SquaresPair(NamedTuple):
    """Two masks A and B as unions of pixel squares. A is the frame of reference; B has a pose in A's raster."""

    rasters: np.ndarray  # RASTER
    words: np.ndarray  # uint64
    frame: int  # row of RASTER of mask A
    other: int  # row of RASTER of mask B
    u: float  # [px] top left corner of B's raster in A's raster
    v: float
    cosine: float  # cosine and sine of B's angle in A's raster
    sine: float


@subkernel
def slack_of(a, b):
    """Return the depth [px] up to which an overlap of squares counts as a rounding error. a, b: RASTER rows."""
    return ROUNDED * (a.width + a.height + b.width + b.height)


@subkernel
def reach_of(cosine, sine):
    """Return the largest distance [px] along an axis between the centres of two unit squares that touch.

    The axes are the directions of the sides of both squares. The squares share area if their centres are nearer than
    this along every axis. cosine, sine: cosine and sine of the angle between the squares.
    """
    return 0.5 + 0.5 * (abs(cosine) + abs(sine))


@subkernel
def do_squares_meet(dx, dy, cosine, sine, near):
    """Return whether two unit squares share area (separating axis test).

    dx, dy [px]: centre of the second square relative to the first; cosine, sine: cosine and sine of the angle between
    the squares; near [px]: result of reach_of, minus the rounding error.
    """
    return (
        abs(dx) < near
        and abs(dy) < near
        and abs(cosine * dx + sine * dy) < near
        and abs(cosine * dy - sine * dx) < near
    )


@subkernel
def leave_square(dx, dy, cosine, sine, reach, nx, ny):
    """Return the distance [px] that a unit square must move along the unit vector (nx, ny) to leave another one.

    dx, dy [px]: centre of the moving square relative to the other square; cosine, sine: cosine and sine of the moving
    square's angle; reach [px]: result of reach_of.
    """
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
def box_in_raster(a, b, u, v, cosine, sine, margin):
    """Return the box (left, top, right, bottom) of B's pixels that may overlap the bounding box of A's solid pixels.

    The box is in B's raster; right and bottom are exclusive. a, b: RASTER rows; u, v [px]: top left corner of B's
    raster in A's raster; cosine, sine: cosine and sine of B's angle in A's raster; margin [px]: enlargement of A's
    bounding box.
    """
    half_x, half_y = 0.5 * (a.set_right - a.set_left) + margin, 0.5 * (a.set_bottom - a.set_top) + margin
    dx, dy = a.set_left - margin + half_x - u, a.set_top - margin + half_y - v
    x, y = cosine * dx + sine * dy, cosine * dy - sine * dx
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
    """Return the part (low, high) of the interval low <= t <= high in which least <= start + step * t <= most.

    If this part is empty, the returned low is greater than the returned high.
    """
    if step > 0.0:
        return max(low, (least - start) / step), min(high, (most - start) / step)
    if step < 0.0:
        return max(low, (most - start) / step), min(high, (least - start) / step)
    return low, high if least <= start <= most else low - 1.0


@subkernel
def run_near(a, left, right, x, y, cosine, sine, margin):
    """Return (first, last + 1): the columns in a row of mask B whose pixel centres may overlap mask A.

    These are the centres in the bounding box of A's solid pixels, enlarged by `margin` [px]. a: RASTER row of A; left,
    right: range of tested columns, right exclusive; x, y [px]: centre of the pixel in column 0, in A's raster; cosine,
    sine: direction of the row in A's raster.
    """
    low, high = clip_run(float(left), right - 1.0, x, cosine, a.set_left - margin, a.set_right + margin)
    low, high = clip_run(low, high, y, sine, a.set_top - margin, a.set_bottom + margin)
    # A row at a shallow angle may meet the bounds at columns beyond the range of integers, so clamp first.
    return math.ceil(min(low, float(right))), math.floor(max(high, left - 1.0)) + 1


@subkernel
def square_under(words, a, x, y, cosine, sine, near):
    """Return (found, column, row) of the first pixel of mask A that overlaps a rotated pixel square of mask B. O(1).

    words: pixels of all rasters; a: RASTER row of A; x, y [px]: centre of the square in A's raster; cosine, sine:
    cosine and sine of the square's angle; near [px]: see do_squares_meet.
    """
    column, row = math.floor(x), math.floor(y)
    for j in range(max(0, row - 1), min(a.height, row + 2)):
        solid = both(bits_from(words, a.offset + j * a.stride, a.stride, column - 1), columns_up_to(3))
        while solid != word(0):
            i = column - 1 + lowest_bit(solid)
            solid = without_lowest(solid)
            if do_squares_meet(x - (i + 0.5), y - (j + 0.5), cosine, sine, near):
                return True, i, j
    return False, 0, 0


@subkernel
def first_upright(pair, u, v):
    """Return the result of first_squares for two masks at equal angles, by AND of whole words. O(words).

    A pixel of one mask overlaps up to four pixels of the other mask. So up to four offsets in whole pixels are tested.
    pair, u, v: see first_squares.
    """
    slack = slack_of(pair.rasters[pair.frame], pair.rasters[pair.other])
    column, row = math.floor(u + slack), math.floor(v + slack)
    for down in range(2 if v - row > slack else 1):
        for across in range(2 if u - column > slack else 1):
            found, x, y = first_pixel(pair.rasters, pair.words, pair.frame, pair.other, column + across, row + down)
            if found:
                return True, x, y, x - column - across, y - row - down
    return False, 0, 0, 0, 0


@subkernel
def first_squares(pair, u, v, start_row):
    """Find the first pixels of masks A and B that overlap.

    Return (found, column in A, row in A, column in B, row in B). The search ends at the first overlap. pair:
    SquaresPair; u, v [px]: top left corner of B's raster in A's raster, used instead of pair.u, pair.v; start_row: row
    of B at which the search starts; the rows above it are searched last. O(pixels of B within A's bounds) at worst.
    """
    cosine, sine, words = pair.cosine, pair.sine, pair.words
    if cosine == 1.0 and sine == 0.0:
        return first_upright(pair, u, v)
    a, b = pair.rasters[pair.frame], pair.rasters[pair.other]
    reach = reach_of(cosine, sine)
    near = reach - slack_of(a, b)
    left, top, right, bottom = box_in_raster(a, b, u, v, cosine, sine, 0.0)
    start_row = min(max(start_row, top), bottom)
    for k in range(top, bottom):
        row = k + start_row - top
        row = row if row < bottom else row - (bottom - top)
        x, y = u + 0.5 * cosine - (row + 0.5) * sine, v + 0.5 * sine + (row + 0.5) * cosine
        start, end = run_near(a, left, right, x, y, cosine, sine, reach - 0.5)
        while start < end:
            solid = both(bits_from(words, b.offset + row * b.stride, b.stride, start), columns_up_to(end - start))
            while solid != word(0):
                column = start + lowest_bit(solid)
                solid = without_lowest(solid)
                px, py = x + column * cosine, y + column * sine
                if is_set(words, a.halo + (math.floor(py) + 1) * a.halo_stride, math.floor(px) + 1):
                    found, i, j = square_under(words, a, px, py, cosine, sine, near)
                    if found:
                        return True, i, j, column, row
            start += 64
    return False, 0, 0, 0, 0


@subkernel
def squares_way_out(pair, nx, ny, most):
    """Return the distance [px] that mask B must move along the unit vector (nx, ny) to end its overlap with mask A.

    A result above `most` [px] means that no move up to `most` is enough. pair: SquaresPair; nx, ny: direction in A's
    raster. Two pixel squares overlap during one interval of the move. Whenever two overlapping squares are found, the
    move advances to the end of their interval, so no two squares are found twice. O(first_squares · pairs found).
    """
    cosine, sine = pair.cosine, pair.sine
    reach = reach_of(cosine, sine)
    slack = slack_of(pair.rasters[pair.frame], pair.rasters[pair.other])
    depth = 0.0
    row = 0
    while depth <= most:
        x, y = pair.u + depth * nx, pair.v + depth * ny
        found, i, j, column, row = first_squares(pair, x, y, row)  # the next overlap is often in the same row
        if not found:
            return depth
        dx = x + cosine * (column + 0.5) - sine * (row + 0.5) - (i + 0.5)
        dy = y + sine * (column + 0.5) + cosine * (row + 0.5) - (j + 0.5)
        depth += max(leave_square(dx, dy, cosine, sine, reach, nx, ny), slack)
    return depth


# ---- shares ----------------------------------------------------------------------------------------------------------
# Area and moments of the part of a region that lies in an axis-aligned box, in closed form from the region's outline.
#
# By Green's theorem the area is the integral of x dy along the outline, where x is clamped to the box and only the
# parts with y in the box count; the moments likewise. The contribution of one line or arc of the outline to (area,
# moment of x, moment of y) is called its share; the sum of all shares is exact. No polygon is clipped or stored.
# Coordinates are relative to the box's top left corner: the box is 0..width x 0..height. The outline runs clockwise on
# the screen, where y points down.


@subkernel
def line_share(px, py, qx, qy, width, height):
    """Return the contribution of a line to the area and moments of the part of a region inside a box.

    The result is (area [px2], moment of x, moment of y [px3]). The line from p to q [px] is a part of the region's
    outline; the box is 0..width x 0..height. The sides of the box cut the line into up to three pieces. Along each
    piece, x clamped to the box is a linear function.
    """
    area = 0.0
    moment_x, moment_y = 0.0, 0.0
    start = clamp(py, 0.0, height)
    end = clamp(qy, 0.0, height)
    if start == end:
        return area, moment_x, moment_y
    slope = (qx - px) / (qy - py) if qy != py else 0.0
    x0 = px if start == py else px + slope * (start - py)
    x1 = qx if end == qy else qx + slope * (end - qy)
    first, second = 0.0, 1.0
    if x0 != x1:
        at_left = clamp(-x0 / (x1 - x0), 0.0, 1.0)
        at_right = clamp((width - x0) / (x1 - x0), 0.0, 1.0)
        first, second = min(at_left, at_right), max(at_left, at_right)
    for piece in range(3):
        low = 0.0 if piece == 0 else (first if piece == 1 else second)
        high = first if piece == 0 else (second if piece == 1 else 1.0)
        if high <= low:
            continue
        xa = clamp(x0 + low * (x1 - x0), 0.0, width)
        xb = clamp(x0 + high * (x1 - x0), 0.0, width)
        ya = start + low * (end - start)
        yb = start + high * (end - start)
        dy = yb - ya
        area += 0.5 * dy * (xa + xb)
        moment_x += dy * (xa * xa + xa * xb + xb * xb) / 6.0
        moment_y += dy * (xa * (2.0 * ya + yb) + xb * (ya + 2.0 * yb)) / 6.0
    return area, moment_x, moment_y


@subkernel
def arc_primitives(x, y, radius, angle):
    """Return the integrals (x dy, x²/2 dy, x y dy) along a circle, from angle 0 to `angle` [rad].

    x, y, radius [px]: centre and radius of the circle.
    """
    cosine, sine = math.cos(angle), math.sin(angle)
    r2 = radius * radius
    straight = x * radius * sine + r2 * (0.5 * angle + 0.5 * sine * cosine)
    squared = 0.5 * (
        x * x * radius * sine
        + 2.0 * x * r2 * (0.5 * angle + 0.5 * sine * cosine)
        + r2 * radius * (sine - sine * sine * sine / 3.0)
    )
    mixed = y * straight + 0.5 * x * r2 * sine * sine - r2 * radius * cosine * cosine * cosine / 3.0
    return straight, squared, mixed


@subkernel
def next_cut(x, y, radius, width, height, after, until):
    """Return the first angle [rad] after `after` at which a circle crosses the infinite line through a side of a box.

    The result is `until` if there is no crossing before `until`. x, y, radius [px]: centre and radius of the circle;
    the box is 0..width x 0..height.
    """
    best = until
    for side in range(4):
        away = (0.0 - x if side == 0 else width - x) if side < 2 else (0.0 - y if side == 2 else height - y)
        if abs(away) > radius:
            continue
        across = math.sqrt(radius * radius - away * away)
        for end in range(2):
            other = across if end == 0 else -across
            angle = math.atan2(other, away) if side < 2 else math.atan2(away, other)
            angle += math.tau * math.ceil((after - angle) / math.tau)
            if angle <= after:
                angle += math.tau
            best = min(best, angle)
    return best


@subkernel
def arc_share(x, y, radius, start, end, width, height):
    """Return the contribution of an arc to the area and moments of the part of a region inside a box.

    The result is (area [px2], moment of x, moment of y [px3]). The arc is a part of the region's outline. x, y, radius
    [px]: centre and radius of the arc; start, end [rad]: angles of its ends, start < end. The box is 0..width x
    0..height.
    """
    area = 0.0
    moment_x, moment_y = 0.0, 0.0
    low = start
    while low < end:
        high = next_cut(x, y, radius, width, height, low, end)
        # A point at 0.4 of the arc: in the middle, an arc between two cuts may just touch a line.
        within = low + 0.4 * (high - low)
        at_x, at_y = x + radius * math.cos(within), y + radius * math.sin(within)
        if 0.0 < at_y < height and at_x > 0.0:
            if at_x < width:
                a0, x0, y0 = arc_primitives(x, y, radius, low)
                a1, x1, y1 = arc_primitives(x, y, radius, high)
                area += a1 - a0
                moment_x += x1 - x0
                moment_y += y1 - y0
            else:
                ya = y + radius * math.sin(low)
                yb = y + radius * math.sin(high)
                area += width * (yb - ya)
                moment_x += 0.5 * width * width * (yb - ya)
                moment_y += 0.5 * width * (yb * yb - ya * ya)
        low = high
    return area, moment_x, moment_y


# ---- shared squares --------------------------------------------------------------------------------------------------
# Shared area of two masks as unions of pixel squares, and its centroid. A, B, u, v, cosine, sine: see the comment under
# "exact".
#
# A pixel of B with only solid pixels of A around it counts with its whole area. For a pixel of B near A's outline, the
# areas that it shares with the runs of A's solid pixels under it are added. O(pixels of B within A's bounds).


@subkernel
def square_share(x, y, cosine, sine, width, height):
    """Return the area and moments of the part of a rotated unit square inside the box 0..width x 0..height.

    The result is (area [px2], moment of x, moment of y [px3]). x, y [px]: centre of the square; cosine, sine: cosine
    and sine of the square's angle.
    """
    area = 0.0
    moment_x, moment_y = 0.0, 0.0
    ux, uy = 0.5 * (cosine + sine), 0.5 * (sine - cosine)
    for _ in range(4):
        # (ux, uy) points to a corner; a quarter turn leads to the next corner.
        a, mx, my = line_share(x + ux, y + uy, x - uy, y + ux, width, height)
        area += a
        moment_x += mx
        moment_y += my
        ux, uy = -uy, ux
    return area, moment_x, moment_y


@subkernel
def share_under(words, a, x, y, cosine, sine):
    """Return the area and moments of the overlap of mask A and a rotated pixel square of mask B.

    The result is (area [px2], moment of x, moment of y [px3]), in A's raster. words: pixels of all rasters; a: RASTER
    row of A; x, y [px]: centre of the square in A's raster; cosine, sine: cosine and sine of the square's angle.
    """
    column, row = math.floor(x) - 1, math.floor(y) - 1
    area = 0.0
    moment_x, moment_y = 0.0, 0.0
    solid = 0
    for j in range(max(0, row), min(a.height, row + 3)):
        solid += popcount(both(bits_from(words, a.offset + j * a.stride, a.stride, column), columns_up_to(3)))
    if solid == 9:
        return 1.0, x, y
    for j in range(max(0, row), min(a.height, row + 3)):
        start = -1
        for i in range(max(0, column), min(a.width, column + 3) + 1):
            if i < min(a.width, column + 3) and is_set(words, a.offset + j * a.stride, i):
                if start < 0:
                    start = i
            elif start >= 0:
                part, mx, my = square_share(x - start, y - j, cosine, sine, float(i - start), 1.0)
                area += part
                moment_x += mx + start * part
                moment_y += my + j * part
                start = -1
    return area, moment_x, moment_y


@subkernel
def sum_squares(pair):
    """Return the area and moments of the overlap of the two masks of a SquaresPair, summed square by square.

    The result is (area [px2], moment of x, moment of y [px3]), in A's raster.
    """
    u, v, cosine, sine, words = pair.u, pair.v, pair.cosine, pair.sine, pair.words
    a, b = pair.rasters[pair.frame], pair.rasters[pair.other]
    area = 0.0
    moment_x, moment_y = 0.0, 0.0
    margin = reach_of(cosine, sine) - 0.5
    left, top, right, bottom = box_in_raster(a, b, u, v, cosine, sine, 0.0)
    for row in range(top, bottom):
        x, y = u + 0.5 * cosine - (row + 0.5) * sine, v + 0.5 * sine + (row + 0.5) * cosine
        start, end = run_near(a, left, right, x, y, cosine, sine, margin)
        while start < end:
            solid = both(bits_from(words, b.offset + row * b.stride, b.stride, start), columns_up_to(end - start))
            while solid != word(0):
                column = start + lowest_bit(solid)
                solid = without_lowest(solid)
                px, py = x + column * cosine, y + column * sine
                if is_set(words, a.halo + (math.floor(py) + 1) * a.halo_stride, math.floor(px) + 1):
                    part, mx, my = share_under(words, a, px, py, cosine, sine)
                    area += part
                    moment_x += mx
                    moment_y += my
            start += 64
    return area, moment_x, moment_y


# ---- shared outline --------------------------------------------------------------------------------------------------
# Shared area of two masks from the outline of mask B. A, B, u, v, cosine, sine: see the comment under "exact".
#
# By Green's theorem the area is the integral of X dy along the outline of B, where X(x, y) is the length of the solid
# pixels of A to the left of x in the row of y. X is linear within a pixel, so the integral over each piece of the
# outline between two lines of A's pixel grid is exact. The moments are integrals of the same kind. The change of the
# area when B moves by one pixel to each side has the length of the solid pixels within one pixel of (x, y) as its
# integrand. O(outline of B within A's bounds), where square by square it is O(pixels). Rounding errors are relative to
# the size of the masks.


class Shares(NamedTuple):
    """Sums over the outline of mask B: area shared with mask A, moments of this area, and its change when B moves."""

    area: float  # [px2]
    moment_x: float  # [px3] area times the centroid in A's raster
    moment_y: float
    loss_x: float  # [px2] by how much the area with B one pixel to the left exceeds that with B one pixel to the right
    loss_y: float  # [px2] the same with B one pixel above, and below


@subkernel
def solid_before(words, row, stride, column):
    """Return (number, sum of the centres' x [px]) of the solid pixels of a row in the columns before `column`.

    words: pixels of all rasters; row: index of the row's first word; stride: number of words per row.
    """
    count = 0.0
    centers = 0.0
    for k in range(min(stride, (column + 63) >> 6)):
        solid = both(words[row + k], columns_up_to(column - 64 * k))
        found = popcount(solid)
        count += found
        centers += sum_of_places(solid) + (64.0 * k + 0.5) * found
    return count, centers


@subkernel
def length_at(words, a, column, row):
    """Return 1.0 if the pixel of mask A at (column, row) is solid, else 0.0. Pixels outside the raster are not solid.

    words: pixels of all rasters; a: RASTER row of A.
    """
    if 0 <= column < a.width and 0 <= row < a.height and is_set(words, a.offset + row * a.stride, column):
        return 1.0
    return 0.0


@inlined
def share_in_row(words, a, row, px, py, qx, qy):
    """Return the contribution of a line of mask B's outline to the Shares of masks A and B.

    The line is within one pixel row of A. words: pixels of all rasters; a: RASTER row of A; row: index of the pixel
    row; px, py, qx, qy [px]: start and end of the line in A's raster, py <= qy.
    """
    area, moment_x, moment_y = 0.0, 0.0, 0.0
    loss_x, loss_y = 0.0, 0.0
    way = 1.0 if px <= qx else -1.0
    x, y, right, end_y = (px, py, qx, qy) if px <= qx else (qx, qy, px, py)
    rise = (end_y - y) / (right - x) if right > x else 0.0
    if x < a.set_left - 1.0:
        y += rise * (a.set_left - 1.0 - x)
        x = a.set_left - 1.0
    column = math.floor(min(x, a.set_right + 1.0))
    before, centers = 0.0, 0.0
    if a.set_top <= row < a.set_bottom:
        before, centers = solid_before(words, a.offset + row * a.stride, a.stride, column)
    last = length_at(words, a, column - 1, row)
    here = length_at(words, a, column, row)
    while True:
        following = length_at(words, a, column + 1, row)
        ends = column > a.set_right or right <= column + 1.0
        to = right if ends else column + 1.0
        to_y = end_y if ends else y + rise * (to - x)
        dx, dy = way * (to - x), way * (to_y - y)
        at, on = x - column, to - column  # both ends, from the left side of the pixel
        near, far = before + here * at, before + here * on
        area += 0.5 * dy * (near + far)
        moment_x += dy * (centers + here * (0.5 * column * (at + on) + (at * at + at * on + on * on) / 6.0))
        moment_y += dy * (near * (2.0 * y + to_y) + far * (y + 2.0 * to_y)) / 6.0
        if column <= a.set_right:
            middle = 0.5 * (at + on)
            loss_x -= dy * (last + here + middle * (following - last))
            above, below = length_at(words, a, column, row - 1), length_at(words, a, column, row + 1)
            loss_y += dx * (above + here + (0.5 * (y + to_y) - row) * (below - above))
        if ends:
            return Shares(area, moment_x, moment_y, loss_x, loss_y)
        before += here
        centers += here * (column + 0.5)
        last, here = here, following
        x, y = to, to_y
        column += 1


@subkernel
def with_share(shares, part):
    """Return the sum of two Shares, field by field."""
    return Shares(
        shares.area + part.area,
        shares.moment_x + part.moment_x,
        shares.moment_y + part.moment_y,
        shares.loss_x + part.loss_x,
        shares.loss_y + part.loss_y,
    )


@subkernel
def edge_share(words, a, px, py, qx, qy):
    """Return the contribution of a line of mask B's outline to the Shares of masks A and B.

    words: pixels of all rasters; a: RASTER row of A; px, py, qx, qy [px]: start and end of the line in A's raster.
    """
    total = Shares(0.0, 0.0, 0.0, 0.0, 0.0)
    sign = 1.0
    if qy < py:
        px, py, qx, qy = qx, qy, px, py
        sign = -1.0
    y, bottom = max(py, a.set_top - 1.0), min(qy, a.set_bottom + 1.0)
    if y <= bottom and max(px, qx) > a.set_left - 1.0:
        slope = (qx - px) / (qy - py) if qy > py else 0.0
        x = px if y == py else px + slope * (y - py)
        row = math.floor(y)
        while True:
            ends = bottom <= row + 1.0
            end = bottom if ends else row + 1.0
            end_x = qx if end == qy else px + slope * (end - py)
            if max(x, end_x) > a.set_left - 1.0:
                total = with_share(total, share_in_row(words, a, row, x, y, end_x, end))
            if ends:
                break
            x, y = end_x, end
            row += 1
    return Shares(
        sign * total.area, sign * total.moment_x, sign * total.moment_y, sign * total.loss_x, sign * total.loss_y
    )


@subkernel
def outline_shares(pair):
    """Return the Shares of the two masks of a SquaresPair, computed along the outline of B."""
    cosine, sine, words = pair.cosine, pair.sine, pair.words
    a, b = pair.rasters[pair.frame], pair.rasters[pair.other]
    shares = Shares(0.0, 0.0, 0.0, 0.0, 0.0)
    left, top, right, bottom = box_in_raster(a, b, pair.u, pair.v, cosine, sine, 1.0)
    if left >= right or top >= bottom:
        return shares
    for row in range(top, bottom + 1):
        x, y = pair.u - row * sine, pair.v + row * cosine  # the corner (0, row) of B's pixels
        next_x, next_y = pair.u - (row + 1) * sine, pair.v + (row + 1) * cosine
        solid = 0
        for start in range(left, right + 1, 64):
            shown = columns_up_to(right - start)
            above, below = word(0), word(0)
            if row > top:
                above = both(bits_from(words, b.offset + (row - 1) * b.stride, b.stride, start), shown)
            if row < bottom:
                below = both(bits_from(words, b.offset + row * b.stride, b.stride, start), shown)
            for side in range(2):  # upper edges lead to the right, lower edges to the left
                edges = minus(below, above) if side == 0 else minus(above, below)
                while edges != word(0):
                    first, last = first_run(edges)
                    edges = minus(edges, run_bits(first, last))
                    i, j = (start + first, start + last) if side == 0 else (start + last, start + first)
                    part = edge_share(words, a, x + i * cosine, y + i * sine, x + j * cosine, y + j * sine)
                    shares = with_share(shares, part)
            changes = word(below ^ word(word(below << word(1)) | word(solid)))
            while changes != word(0):
                column = lowest_bit(changes)
                changes = without_lowest(changes)
                across, down = (start + column) * cosine, (start + column) * sine
                if has_bit(below, column):  # left edges lead up, right edges lead down
                    part = edge_share(words, a, next_x + across, next_y + down, x + across, y + down)
                else:
                    part = edge_share(words, a, x + across, y + down, next_x + across, next_y + down)
                shares = with_share(shares, part)
            solid = int(has_bit(below, 63))
    return shares


LEAST_OUTLINED = 1.0  # [px2] a smaller area is summed square by square: its rounding errors are relative to the area


@subkernel
def shared_squares(pair):
    """Return the Shares of the two masks of a SquaresPair.

    A small area is summed square by square, because its rounding errors are then relative to the area.
    """
    shares = outline_shares(pair)
    if shares.area >= LEAST_OUTLINED:
        return shares
    area, moment_x, moment_y = sum_squares(pair)
    return Shares(area, moment_x, moment_y, shares.loss_x, shares.loss_y)
