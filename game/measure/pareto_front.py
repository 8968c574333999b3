"""The Pareto front of (cost, error) points, and a test whether one cost is certainly lower than another."""

from collections.abc import Mapping
from typing import TypeVar

Name = TypeVar("Name")
TIE = 0.1  # costs that differ by less than this share count as equal, whatever their intervals


def pareto_front(points: Mapping[Name, tuple[float, float]]) -> list[Name]:
    """Return the names of the points on the Pareto front, cheapest first. points: {name: (cost, error)}.

    For a point on the front, no other point has both a lower cost and a lower error.
    """
    found, least = [], float("inf")
    for name in sorted(points, key=lambda each: points[each]):
        if points[name][1] < least:
            found.append(name)
            least = points[name][1]
    return found


def cheaper(a: tuple[float, float], b: tuple[float, float]) -> bool:
    """Return whether cost a is certainly below cost b. Each cost is (least, median) of several runs.

    The median of a must be below the least of b, and more than TIE below the median of b. The caller may pass an upper
    bound instead of the median of a, which makes the test stricter.
    """
    return a[1] < b[0] and a[1] < (1.0 - TIE) * b[1]
