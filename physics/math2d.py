"""Scalar vector maths of kernels, and Vec2, a point or vector of the API."""

import math
import numbers
from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple, cast

import numpy as np

from physics.jit import inlined, subkernel

# ---- math2d ----------------------------------------------------------------------------------------------------------
# Scalar vector maths used by kernels. Scalars in, tuples out: a two-element array would allocate.

RIGHT = 2.0 * 2.0**-52  # relative error of an angle: of the number nearest to a quarter turn, or of a sum of two

SMALL = 2.0**-6  # [rad] the next term is 2 ** -66 of the sum there


@subkernel
def unit(x, y, fallback_x, fallback_y):
    """Return the vector at length one, or the fallback for the zero vector."""
    # Scaled first, so that neither tiny nor huge vectors under- or overflow when squared.
    largest = max(abs(x), abs(y))
    if largest == 0.0:
        return fallback_x, fallback_y
    sx, sy = x / largest, y / largest
    length = math.sqrt(sx * sx + sy * sy)
    return sx / length, sy / length


@subkernel
def clamp(value, low, high):
    """Return the value clamped to low..high."""
    return max(low, min(high, value))


@subkernel
def norm(x, y):
    """Return the length of a vector, without overflow."""
    largest = max(abs(x), abs(y))
    if largest == 0.0:
        return 0.0
    sx, sy = x / largest, y / largest
    return largest * math.sqrt(sx * sx + sy * sy)


@subkernel
def rotate(x, y, cosine, sine):
    """Return the vector rotated by the angle with this cosine and sine."""
    return cosine * x - sine * y, sine * x + cosine * y


@inlined
def rotation_of(angle):
    """Return cosine and sine of an angle [rad].

    A small angle, such as the rotation of one substep, takes as many terms of the series as determine the last digit: 6
    % faster than the library's (all substeps of 1,035 boxes).
    """
    if abs(angle) < SMALL:
        square = angle * angle
        cosine = 1.0 - square * (0.5 - square * (1.0 / 24.0 - square * (1.0 / 720.0 - square / 40320.0)))
        sine = angle - angle * square * (1.0 / 6.0 - square * (1.0 / 120.0 - square / 5040.0))
        return cosine, sine
    return math.cos(angle), math.sin(angle)


@subkernel
def cosine_and_sine(angle, greatest):
    """Return cosine and sine of an angle [rad], exactly 0 and 1 or -1 at the numbers nearest to quarter turns.

    greatest [rad]: the greatest of the angles from which it was subtracted, which sets its precision.
    """
    cosine, sine = math.cos(angle), math.sin(angle)
    off = RIGHT * max(1.0, abs(greatest))
    if abs(cosine) <= off:
        return 0.0, 1.0 if sine > 0.0 else -1.0
    if abs(sine) <= off:
        return 1.0 if cosine > 0.0 else -1.0, 0.0
    return cosine, sine


# ---- vec2 ------------------------------------------------------------------------------------------------------------
# Vec2: a point or a vector of the API, a plain pair in all but its arithmetic.

NO_PAIRS = (str, bytes, bytearray, set, frozenset, dict)  # a pair by length, but not of numbers


class Vec2(NamedTuple):
    """A pair (x, y) [px, or px/s], y down. It equals a plain pair, and a plain pair is accepted wherever a Vec2 is.

    + − * / work element by element with a pair, or with a number, from either side; an array of other than two numbers
    gives an array. A wrong type raises TypeError, a division by zero ZeroDivisionError.
    """

    x: float
    y: float

    @property
    def length(self) -> float:
        """The length, without overflow."""
        return math.hypot(self[0], self[1])

    @property
    def angle(self) -> float:
        """The angle [rad] from +x, clockwise on the screen, -pi..pi; 0 for the zero vector."""
        return math.atan2(self[1], self[0])

    def dot(self, v: "Vec2 | Sequence[float]") -> float:
        """Return the scalar product. Raises TypeError for a value that is not a pair of numbers."""
        x, y = _named_pair("v", v)
        return self[0] * x + self[1] * y

    def cross(self, v: "Vec2 | Sequence[float]") -> float:
        """Return x · v.y − y · v.x: positive where v lies clockwise on the screen. Raises TypeError."""
        x, y = _named_pair("v", v)
        return self[0] * y - self[1] * x

    def rotated(self, angle: float) -> "Vec2":
        """Return the vector rotated clockwise on the screen by a finite angle [rad]. Raises TypeError, ValueError."""
        if not _is_number(angle):
            raise TypeError(f"angle must be a number (got {angle!r})")
        if not math.isfinite(angle):
            raise ValueError(f"angle must be finite (got {angle!r})")
        cosine, sine = math.cos(angle), math.sin(angle)
        return Vec2(cosine * self[0] - sine * self[1], sine * self[0] + cosine * self[1])

    def normalized(self) -> "Vec2":
        """Return the vector of the same direction and length 1. Raises ValueError for a zero or non-finite one."""
        largest = max(abs(self[0]), abs(self[1]))
        if largest == 0.0 or not (math.isfinite(self[0]) and math.isfinite(self[1])):
            raise ValueError(f"a vector must be finite and longer than 0 to be normalized (got {tuple(self)})")
        # Scaled first: neither tiny nor huge vectors lose digits when squared.
        x, y = self[0] / largest, self[1] / largest
        length = math.hypot(x, y)
        return Vec2(x / length, y / length)

    def __neg__(self) -> "Vec2":
        return Vec2(-self[0], -self[1])

    def __pos__(self) -> "Vec2":
        return self

    # + and * of a tuple concatenate and repeat; a vector adds and scales.
    def __add__(self, other: Any) -> "Vec2":  # pyright: ignore[reportIncompatibleMethodOverride]
        return _each(other, lambda x, y: Vec2(self[0] + x, self[1] + y), lambda array: np.add(self, array))

    __radd__ = __add__

    def __sub__(self, other: Any) -> "Vec2":
        return _each(other, lambda x, y: Vec2(self[0] - x, self[1] - y), lambda array: np.subtract(self, array))

    def __rsub__(self, other: Any) -> "Vec2":
        return _each(other, lambda x, y: Vec2(x - self[0], y - self[1]), lambda array: np.subtract(array, self))

    def __mul__(self, other: Any) -> "Vec2":  # pyright: ignore[reportIncompatibleMethodOverride]
        return _each(other, lambda x, y: Vec2(self[0] * x, self[1] * y), lambda array: np.multiply(self, array))

    __rmul__ = __mul__  # pyright: ignore[reportAssignmentType]

    def __truediv__(self, other: Any) -> "Vec2":
        return _each(other, lambda x, y: Vec2(self[0] / x, self[1] / y), lambda array: np.divide(self, array))

    def __rtruediv__(self, other: Any) -> "Vec2":
        return _each(other, lambda x, y: Vec2(x / self[0], y / self[1]), lambda array: np.divide(array, self))

    @property
    def __array_priority__(self) -> float:
        """Leave the arithmetic of NumPy numbers and arrays on the left to the vector."""
        return 1.0


def _is_number(value) -> bool:
    return isinstance(value, numbers.Real) and not isinstance(value, bool)


def _named_pair(name, value) -> tuple[float, float]:
    pair = tuple(value) if isinstance(value, Iterable) and not isinstance(value, NO_PAIRS) else ()
    if len(pair) != 2 or not all(map(_is_number, pair)):
        raise TypeError(f"{name} must be a pair (x, y) of numbers (got {value!r})")
    return float(pair[0]), float(pair[1])


def _each(other, combine, combine_array) -> Vec2:
    """Return combine(x, y) with a number or a pair of numbers. Raises TypeError for anything else."""
    if _is_number(other):
        return combine(float(other), float(other))
    if isinstance(other, np.ndarray) and other.shape != (2,):
        return combine_array(other)
    if isinstance(other, (tuple, list, np.ndarray)):  # tuple + tuple would concatenate
        return combine(*_named_pair("what a Vec2 is combined with", other))
    return cast(Vec2, NotImplemented)
