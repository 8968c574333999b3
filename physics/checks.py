"""Checks of arguments. Each error message contains the argument's name, its value and the allowed values."""

import math
import numbers
from collections.abc import Callable, Iterable, Sequence
from typing import Any, Never, TypeVar

import numpy as np

from physics import hints
from physics.hints import brief, near, shown
from physics.math2d import NO_PAIRS, Vec2
from physics.settings import MILLISECONDS, POSITION_LIMIT

PLAIN_PAIRS, PLAIN = (tuple, Vec2, list), (float, int)  # types that need no further checks
EXACT = 2**53  # all whole numbers below it have an exact float


def number(
    name: str, value: Any, low: float | None = None, above: float | None = None, high: float | None = None
) -> float:
    """Convert a value to a float, and return it. It must be finite, >= low, > above and <= high.

    A limit of None is not tested. name: the argument's name, for messages. Raises TypeError for a value that is not a
    real number or is a bool, and ValueError for a number outside the limits.
    """
    if type(value) is float and value - value == 0.0 and low is above is high is None:
        return value
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        raise TypeError(f"{name} must be a number (got {shown(value)}){hints.in_place_of_number(name, value)}")
    try:
        value = float(value)
    except OverflowError:
        value = -math.inf if value < 0 else math.inf
    allowed = "finite"
    if above is not None:
        allowed = f"finite and > {above}"
    if low is not None:
        allowed = f"finite and >= {low}"
    if high is not None:
        allowed += f" and <= {high}"
    if (
        not math.isfinite(value)
        or (above is not None and not value > above)
        or (low is not None and value < low)
        or (high is not None and value > high)
    ):
        raise ValueError(f"{name} must be {allowed} (got {shown(value)})")
    return value


def seconds(name: str, value: Any, low: float | None = None, above: float | None = None) -> float:
    """Convert a duration [s] to a float, and return it. It must be finite, >= low and > above (None: not tested).

    An int of at least MILLISECONDS, such as 16 from pygame's Clock.tick(), raises ValueError, because it is probably in
    milliseconds. name: the argument's name, for messages. Raises TypeError for a value that is not a number, ValueError
    for a number outside the limits.
    """
    found = number(name, value, low, above)
    if isinstance(value, numbers.Integral) and found >= MILLISECONDS:
        raise ValueError(
            f"{name} must be in seconds, from {MILLISECONDS} s on as a float (got {shown(value)}): write "
            f"{value} / 1000 for milliseconds, 1 / {value} for steps per second, {found} for seconds"
        )
    return found


def known_attribute(thing: Any, name: str, value: Any, strict: bool) -> None:
    """Raise AttributeError if the missing attribute `name` is similar to an existing attribute, and suggest that one.

    thing: the object; value: the value that was to be set. strict: True raises the error for every missing name; the
    suggestion is then the most similar name among the existing attributes and those in hints.ASSIGNED.
    """
    public = {each for each in {*dir(type(thing)), *getattr(thing, "__dict__", ())} if not each.startswith("_")}
    foreign = hints.assigned_to(thing) if strict else {}
    similar = name if name in foreign else near(name, sorted(public | foreign.keys()))
    if similar or strict:
        hint = "" if similar in public else hints.in_place_of_attribute(thing, similar, value)
        hint = hint or (f": did you mean {similar}?" if similar else "")
        raise AttributeError(f"{type(thing).__name__} has no attribute {name}{hint}")


def settable_attribute(thing: Any, name: str, value: Any) -> None:
    """Raise AttributeError if an attribute is a property without a setter. Otherwise do nothing.

    The message suggests the replacement in hints.ASSIGNED. thing: the object; name: the attribute; value: the value
    that was to be set.
    """
    found = getattr(type(thing), name, None)
    if isinstance(found, property) and found.fset is None:
        hint = hints.in_place_of_attribute(thing, name, value)
        raise AttributeError(f"{type(thing).__name__}.{name} cannot be set{hint}") from None


def set_known(thing: Any, name: str, value: Any) -> None:
    """Set the attribute `name` of an object with slots.

    Raises AttributeError for an unknown or read-only attribute; the message suggests a replacement.
    """
    try:
        object.__setattr__(thing, name, value)
    except AttributeError:
        if not hasattr(type(thing), name):
            known_attribute(thing, name, value, strict=True)
        settable_attribute(thing, name, value)
        raise


Word = TypeVar("Word", bound=str)
Made = TypeVar("Made", bound=type)


def setting_by(set_attribute: Callable[[Any, str, Any], None]) -> Callable[[Made], Made]:
    """Return a class decorator that sets the function `set_attribute` as the `__setattr__` of the class.

    With a `__setattr__` in the class body, type checkers would accept the assignment of any attribute.
    """

    def decorate(made: Made) -> Made:
        type.__setattr__(made, "__setattr__", set_attribute)
        return made

    return decorate


class NoSuchId(KeyError, ValueError):
    """An error for an id that no body, shape or joint has. It is both a KeyError and a ValueError."""

    def __str__(self) -> str:
        return str(self.args[0])  # str() of a KeyError puts its message in quotes


def vector(name: str, value: Any) -> Vec2:
    """Convert a pair of numbers to a Vec2 of finite floats, and return it.

    Raises TypeError for a value that is not a pair of numbers, and ValueError for a number that is not finite. name:
    name of the argument, for messages.
    """
    if type(value) in PLAIN_PAIRS and len(value) == 2:
        x, y = value
        if type(x) is type(y) is float or (type(x) in PLAIN and type(y) in PLAIN and max(abs(x), abs(y)) < EXACT):
            found = Vec2(float(x), float(y))
            if x - x == 0.0 and y - y == 0.0:
                return found
    x = y = None
    if not isinstance(value, NO_PAIRS):
        try:
            x, y = value
        except (TypeError, ValueError):
            x = None
    if x is None:
        hint = hints.in_place_of_vector(name, value)
        raise TypeError(f"{name} must be a pair (x, y) of numbers (got {shown(value)}){hint}")
    return Vec2(number(f"{name}[0]", x), number(f"{name}[1]", y))


def two(value: Any) -> tuple[Any, Any] | None:
    """Return the two entries of a pair of any values; None for a set, a text, and anything else that is not a pair."""
    if isinstance(value, NO_PAIRS):
        return None
    try:
        first, second = value
    except (TypeError, ValueError):
        return None
    return first, second


def listed(value: Any) -> list[Any] | None:
    """Return the entries of an iterable as a list; None for a text, an array of no dimension, or another value."""
    if isinstance(value, (str, bytes, bytearray)) or not isinstance(value, Iterable):
        return None
    return None if isinstance(value, np.ndarray) and value.ndim == 0 else [*value]


def position(name: str, value: Any) -> Vec2:
    """Convert a pair of coordinates [px] to a Vec2, and return it. Both must be below POSITION_LIMIT in magnitude.

    Below this limit, adjacent doubles differ by less than a pixel. Raises TypeError for a value that is not a pair of
    numbers, and ValueError for a coordinate at or beyond the limit. name: name of the argument, for messages.
    """
    found = vector(name, value)
    if max(abs(found[0]), abs(found[1])) >= POSITION_LIMIT:
        raise ValueError(f"{name} must lie within {POSITION_LIMIT:g} px of the origin (got {shown(value)})")
    return found


def angle(name: str, value: Any) -> float:
    """Convert the angle of a body [rad] to a float, and return it. It must be below POSITION_LIMIT in magnitude.

    Above this limit, adjacent doubles differ by 1 rad and more. Raises TypeError for a value that is not a number, and
    ValueError for an angle at or beyond the limit. name: name of the argument, for messages.
    """
    found = number(name, value)
    if abs(found) >= POSITION_LIMIT:
        raise ValueError(f"{name} must lie within {POSITION_LIMIT:g} rad of 0 (got {shown(value)})")
    return found


def ids(name: str, value: Any, repeats: bool = False) -> np.ndarray:
    """Convert ids to a one-dimensional int64 array, and return it.

    repeats: whether an id may occur more than once. Raises TypeError for values that are not whole numbers, and
    ValueError for a repeated id if `repeats` is False. name: name of the argument, for messages.
    """
    array = np.asarray(value)
    if array.size and array.dtype.kind not in "iu":
        raise TypeError(f"{name} must be whole numbers (got {shown(value)})")
    array = array.astype(np.int64).ravel()
    if not repeats and not (array[1:] > array[:-1]).all() and len(np.unique(array)) != len(array):
        raise ValueError(f"{name} must name each body once (got {array.tolist()})")
    return array


def in_order(name: str, value: Any, other: str) -> None:
    """Raise TypeError for a set, whose order is arbitrary, as an argument that is paired with another one by order.

    name, other: names of the two arguments, for the message.
    """
    if isinstance(value, (set, frozenset)):
        raise TypeError(
            f"{name} must be a list, tuple or array, in the order of {other} (got {shown(value)}): write a list, "
            "because a set has no order"
        )


def independent(advice: str) -> Callable[[Any], Never]:
    """Return a method `__copy__` that raises TypeError, because a shallow copy would share arrays with the original.

    advice: the code that the message suggests instead of copy.copy().
    """

    def __copy__(thing: Any) -> Never:
        raise TypeError(
            f"a {type(thing).__name__} cannot be copied by copy.copy(), as both would share its arrays: write {advice}"
        )

    return __copy__


def whole(name: str, value: Any, low: int, high: int) -> int:
    """Convert a whole number to an int, and return it. It must be from low to high, both included.

    Raises TypeError for a value that is not a whole number or is a bool, and ValueError for a number outside the
    limits. name: name of the argument, for messages.
    """
    if isinstance(value, bool) or not isinstance(value, numbers.Integral):
        hint = f": write {int(value)}" if isinstance(value, float) and value.is_integer() else ""
        raise TypeError(f"{name} must be a whole number (got {shown(value)}){hint}")
    value = int(value)
    if not low <= value <= high:
        raise ValueError(f"{name} must be {low if low == high else f'{low}..{high}'} (got {value})")
    return value


def flag(name: str, value: Any) -> bool:
    """Convert True or False, as a bool or np.bool_, to a bool, and return it.

    Raises TypeError for any other value. name: name of the argument, for messages.
    """
    if not isinstance(value, (bool, np.bool_)):
        hint = f": write {bool(value)}" if type(value) is int and value in (0, 1) else ""
        raise TypeError(f"{name} must be True or False (got {shown(value)}){hint}")
    return bool(value)


def choice(name: str, value: Any, allowed: Sequence[Word]) -> Word:
    """Return the value if it is one of the strings `allowed`.

    Raises TypeError for a value that is not a string, and ValueError for any other string. name: name of the argument,
    for messages.
    """
    for word in allowed:
        if isinstance(value, str) and value == word:
            return word
    wrong, hint = ValueError if isinstance(value, str) else TypeError, hints.in_place_of_word(name, value, allowed)
    raise wrong(f"{name} must be one of {', '.join(allowed)} (got {shown(value)}){hint}")


def columns(
    name: str, value: Any, count: int | None = None, width: int = 2, like: str = "positions", of: str = ""
) -> np.ndarray:
    """Copy finite numbers to a C-ordered float64 array of shape (n, width), or (n,) for width 1, and return it.

    count: the required n; None: any n. like: name of the argument that has `count` rows, for messages; name: name of
    this argument; of: name of the shape or function that takes it, for hints. Raises TypeError for a value that is not
    an array of numbers, and ValueError for another shape or a number that is not finite.
    """
    try:
        array = np.array(value)
    except ValueError:
        raise TypeError(f"{name} must be an array of numbers (got rows of different lengths)") from None
    shape = f"(n, {width})" if width > 1 else "(n,)"
    if array.ndim == 0 or (array.size and array.dtype.kind not in "iuf"):
        got = f"an array of {array.dtype}" if isinstance(value, np.ndarray) else shown(value)
        hint = hints.in_place_of_points(name, value, count, of)
        raise TypeError(f"{name} must be an array of numbers {shape} (got {got}){hint}")
    array = np.array(array, dtype=np.float64, order="C")
    if width > 1 and array.size == 0:
        array = array.reshape(0, width)
    if array.ndim != (2 if width > 1 else 1) or (width > 1 and array.shape[1] != width):
        hint = hints.in_place_of_points(name, value, count, of)
        raise ValueError(f"{name} must have shape {shape} (got {array.shape}){hint}")
    if count is not None and len(array) != count:
        raise ValueError(f"{name} must have {count} rows, as {like} has (got {len(array)})")
    bad = ~np.isfinite(array)
    if bad.any():
        row = int(np.argwhere(bad)[0][0])
        raise ValueError(f"{name}[{row}] must be finite (got {array[row]!r})")
    return array


def users(value: Any, count: int) -> Iterable[Any]:
    """Return the `user` values of `count` bodies or joints that are added in one call.

    A list or one-dimensional array must contain one value for each body or joint; any other value is repeated for all.
    Raises ValueError for a list or array of another length.
    """
    if not isinstance(value, list) and not (isinstance(value, np.ndarray) and value.ndim == 1):
        return [value] * count
    if len(value) != count:
        raise ValueError(
            f"user must be one value, or a list of {count}, one for each (got {len(value)} in {shown(value)}): "
            f"write [{brief(value)}] * {count} for the same list in all"
        )
    return value


def positions(name: str, value: Any) -> np.ndarray:
    """Copy positions [px] to a C-ordered float64 array (n, 2), and return it. They must be within POSITION_LIMIT.

    Raises TypeError for a value that is not an array of numbers; ValueError for another shape, a number that is not
    finite, and a coordinate at or beyond the limit. name: name of the argument, for messages.
    """
    return _limited(name, columns(name, value), "px of the origin")


def angles(name: str, value: Any, count: int | None = None, like: str = "positions") -> np.ndarray:
    """Copy angles of bodies [rad] to a float64 array (n,), and return it. They must be within POSITION_LIMIT.

    count, like: see columns. Raises TypeError for a value that is not an array of numbers; ValueError for another
    shape, a number that is not finite, and an angle at or beyond the limit. name: name of the argument, for messages.
    """
    return _limited(name, columns(name, value, count, width=1, like=like), "rad of 0")


def _limited(name, array, place):
    far = np.abs(array) >= POSITION_LIMIT
    if far.any():
        row = int(np.argwhere(far)[0][0])
        raise ValueError(f"{name}[{row}] must lie within {POSITION_LIMIT:g} {place} (got {array[row].tolist()!r})")
    return array


def pose(name: str, value: Any) -> tuple[float, float, float]:
    """Convert a pose, (x, y) [px] or (x, y, angle) [px, rad], to three floats (x, y, angle). An omitted angle is 0.

    Raises TypeError for a value that is not a pose, and ValueError for a number that is not finite or a position beyond
    POSITION_LIMIT. name: name of the argument, for messages.
    """
    try:
        given: Any = () if isinstance(value, NO_PAIRS) else value
        x, y, angle = given if len(given) == 3 else (*given, 0.0)
    except (TypeError, ValueError):
        hint = hints.in_place_of_vector(name, value)
        raise TypeError(f"{name} must be (x, y) or (x, y, angle) (got {shown(value)}){hint}") from None
    x, y = position(name, (x, y))
    return x, y, number(f"{name}[2]", angle)
