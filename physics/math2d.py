"""Scalar vector maths used by kernels. Scalars in, tuples out: a two-element array would allocate."""

import math

from physics.jit import subkernel

RIGHT = 2.0 * 2.0**-52  # of an angle: what the number nearest to a quarter turn, or a sum of two, is off by


@subkernel
def unit(x, y, fallback_x, fallback_y):
    """The vector at length one, or the fallback where it has no direction."""
    # Scaled first, so that neither tiny nor huge vectors under- or overflow when squared.
    largest = max(abs(x), abs(y))
    if largest == 0.0:
        return fallback_x, fallback_y
    sx = x / largest
    sy = y / largest
    length = math.sqrt(sx * sx + sy * sy)
    return sx / length, sy / length


@subkernel
def length_of(x, y):
    """Length of a vector, without overflow."""
    largest = max(abs(x), abs(y))
    if largest == 0.0:
        return 0.0
    sx = x / largest
    sy = y / largest
    return largest * math.sqrt(sx * sx + sy * sy)


@subkernel
def turned(x, y, cosine, sine):
    """The vector turned by the angle of that cosine and sine."""
    return cosine * x - sine * y, sine * x + cosine * y


@subkernel
def cosine_and_sine(angle, greatest):
    """Cosine and sine of an angle [rad], exactly 0 and 1 or -1 at the numbers nearest to quarter turns.

    greatest [rad]: the greatest of the angles that it was taken from, whose last digits it has.
    """
    cosine = math.cos(angle)
    sine = math.sin(angle)
    off = RIGHT * max(1.0, abs(greatest))
    if abs(cosine) <= off:
        return 0.0, 1.0 if sine > 0.0 else -1.0
    if abs(sine) <= off:
        return 1.0 if cosine > 0.0 else -1.0, 0.0
    return cosine, sine
