"""Scalar vector maths used by kernels. Scalars in, tuples out: a two-element array would allocate."""

import math

from physics.jit import subkernel


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
