"""Scalar vector maths for kernels, and Vec2, a point or vector of the API."""

import math
import numbers
from collections.abc import Iterable
from typing import NamedTuple, cast

import numpy as np

from physics.annotations import Pair
from physics.jit import inlined, subkernel

# ---- math2d ----------------------------------------------------------------------------------------------------------
# Scalar vector maths for kernels. Arguments are scalars and results are tuples, because arrays would be allocated.

RIGHT = 2.0 * 2.0**-52  # relative error of an angle: a rounded quarter turn, or a sum of two

SMALL = 2.0**-6  # [rad] limit of the power series: there the first omitted term is 2 ** -66 of the sum


@subkernel
def unit(x, y, fallback_x, fallback_y):
    """Return the vector (x, y) scaled to length 1, or the vector (fallback_x, fallback_y) for the zero vector."""
    # Scaled first: the squares of tiny vectors would underflow, and the squares of huge vectors overflow.
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
    """Return (cosine, sine) of an angle [rad].

    A small angle, such as the rotation of one substep, uses the terms of the power series that determine the last
    digit: 6 % faster than the library functions (all substeps of 1,035 boxes).
    """
    if abs(angle) < SMALL:
        square = angle * angle
        cosine = 1.0 - square * (0.5 - square * (1.0 / 24.0 - square * (1.0 / 720.0 - square / 40320.0)))
        sine = angle - angle * square * (1.0 / 6.0 - square * (1.0 / 120.0 - square / 5040.0))
        return cosine, sine
    return math.cos(angle), math.sin(angle)


@subkernel
def cosine_and_sine(angle, greatest):
    """Return (cosine, sine) of an angle [rad], exact (0, 1 or -1) near a multiple of a quarter turn.

    Near means within the rounding error of the angle. `angle` may be a difference of angles; greatest [rad]: the
    largest of these, which determines the rounding error.
    """
    cosine, sine = math.cos(angle), math.sin(angle)
    off = RIGHT * max(1.0, abs(greatest))
    if abs(cosine) <= off:
        return 0.0, 1.0 if sine > 0.0 else -1.0
    if abs(sine) <= off:
        return 1.0 if cosine > 0.0 else -1.0, 0.0
    return cosine, sine


# ---- vec2 ------------------------------------------------------------------------------------------------------------
# Vec2: a point or a vector of the API. It is a plain pair except in its arithmetic.

NO_PAIRS = (str, bytes, bytearray, set, frozenset, dict)  # these may have the length 2, but are not pairs of numbers


class Vec2(NamedTuple):
    """A pair (x, y) [px or px/s], y down.

    x, y: coordinates.

    A Vec2 equals a plain pair, and every function that takes a Vec2 also takes a plain pair. It cannot be changed:
    write body.position += (5, 0) in place of body.position.x += 5. + − * / work element by
    element with a pair or a number on either side; with an array of a shape other than (2,) the result is an array.
    Another type raises TypeError, and a division by zero ZeroDivisionError.
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

    def dot(self, v: Pair) -> float:
        """Return the scalar product.

        v: another vector (x, y).

        Raises TypeError for a value that is not a pair of numbers.
        """
        x, y = _named_pair("v", v)
        return self[0] * x + self[1] * y

    def cross(self, v: Pair) -> float:
        """Return x · v.y − y · v.x: positive if v points clockwise from this vector on the screen.

        v: another vector (x, y).

        Raises TypeError for a value that is not a pair of numbers.
        """
        x, y = _named_pair("v", v)
        return self[0] * y - self[1] * x

    def rotated(self, angle: float) -> "Vec2":
        """Return the rotated vector.

        angle: [rad], clockwise on the screen.

        Raises TypeError for a value that is not a number, and ValueError for an angle that is not finite.
        """
        if not _is_number(angle):
            raise TypeError(f"angle must be a number (got {angle!r})")
        if not math.isfinite(angle):
            raise ValueError(f"angle must be finite (got {angle!r})")
        cosine, sine = math.cos(angle), math.sin(angle)
        return Vec2(cosine * self[0] - sine * self[1], sine * self[0] + cosine * self[1])

    def normalized(self) -> "Vec2":
        """Return the vector with the same direction and length 1. Raises ValueError for a zero or non-finite vector."""
        largest = max(abs(self[0]), abs(self[1]))
        if largest == 0.0 or not (math.isfinite(self[0]) and math.isfinite(self[1])):
            raise ValueError(f"a vector must be finite and longer than 0 to be normalized (got {tuple(self)})")
        # Scaled first: the squares of tiny vectors would underflow, and the squares of huge vectors overflow.
        x, y = self[0] / largest, self[1] / largest
        length = math.hypot(x, y)
        return Vec2(x / length, y / length)

    def __neg__(self) -> "Vec2":
        return Vec2(-self[0], -self[1])

    def __pos__(self) -> "Vec2":
        return self

    # For a tuple, + and * concatenate and repeat; for a Vec2 they add and multiply.
    def __add__(self, other: Pair | float) -> "Vec2":  # pyright: ignore[reportIncompatibleMethodOverride]
        return _each(other, lambda x, y: Vec2(self[0] + x, self[1] + y), lambda array: np.add(self, array))

    __radd__ = __add__

    def __sub__(self, other: Pair | float) -> "Vec2":
        return _each(other, lambda x, y: Vec2(self[0] - x, self[1] - y), lambda array: np.subtract(self, array))

    def __rsub__(self, other: Pair | float) -> "Vec2":
        return _each(other, lambda x, y: Vec2(x - self[0], y - self[1]), lambda array: np.subtract(array, self))

    def __mul__(self, other: Pair | float) -> "Vec2":  # pyright: ignore[reportIncompatibleMethodOverride]
        return _each(other, lambda x, y: Vec2(self[0] * x, self[1] * y), lambda array: np.multiply(self, array))

    __rmul__ = __mul__  # pyright: ignore[reportAssignmentType]

    def __truediv__(self, other: Pair | float) -> "Vec2":
        return _each(other, lambda x, y: Vec2(self[0] / x, self[1] / y), lambda array: np.divide(self, array))

    def __rtruediv__(self, other: Pair | float) -> "Vec2":
        return _each(other, lambda x, y: Vec2(x / self[0], y / self[1]), lambda array: np.divide(array, self))

    @property
    def __array_priority__(self) -> float:
        """A number with which NumPy numbers and arrays on the left leave an operation to the Vec2."""
        return 1.0


def _refuse_change(vector, name, value):
    """Raise AttributeError for a coordinate that was set. The message shows how to set the whole pair."""
    if name not in ("x", "y"):
        raise AttributeError(f"Vec2 has no attribute {name}, and cannot be changed")
    x, y = (value, vector[1]) if name == "x" else (vector[0], value)
    raise AttributeError(f"Vec2 cannot be changed: write the whole pair, such as body.position = ({x!r}, {y!r})")


type.__setattr__(Vec2, "__setattr__", _refuse_change)  # in the class, it would tell type checkers that x can be set


def _is_number(value) -> bool:
    return isinstance(value, numbers.Real) and not isinstance(value, bool)


def _is_vector(value) -> bool:
    """Return whether a value of another library, such as a pygame.Vector2, is a vector of two numbers."""
    return hasattr(value, "x") and hasattr(value, "y") and hasattr(value, "__len__") and len(value) == 2


def _named_pair(name, value) -> tuple[float, float]:
    pair = tuple(value) if isinstance(value, Iterable) and not isinstance(value, NO_PAIRS) else ()
    if len(pair) != 2 or not all(map(_is_number, pair)):
        raise TypeError(f"{name} must be a pair (x, y) of numbers (got {value!r})")
    return float(pair[0]), float(pair[1])


def _each(other, combine, combine_array) -> Vec2:
    """Return combine(x, y) for `other`, which is a pair, or a number that stands for both x and y.

    For an array of a shape other than (2,) return combine_array(other), for a value of another type NotImplemented.
    Raises TypeError for a pair of values that are not numbers.
    """
    if _is_number(other):
        return combine(float(other), float(other))
    if isinstance(other, np.ndarray) and other.shape != (2,):
        return combine_array(other)
    if isinstance(other, (tuple, list, np.ndarray)) or _is_vector(other):  # tuple + tuple would concatenate
        return combine(*_named_pair("what a Vec2 is combined with", other))
    return cast(Vec2, NotImplemented)
