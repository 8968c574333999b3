"""The Pareto front of (cost, error) points."""

from collections.abc import Mapping
from typing import TypeVar

Name = TypeVar("Name")
TIE = 0.1  # costs that differ by less than this share count as equal, whatever their intervals


def pareto_front(points: Mapping[Name, tuple[float, float]]) -> list[Name]:
    """Return the names of the points on the Pareto front, the cheapest first. points: {name: (cost, error)}.

    No other point has both less cost and less error than a point on the front.
    """
    found, least = [], float("inf")
    for name in sorted(points, key=lambda each: points[each]):
        if points[name][1] < least:
            found.append(name)
            least = points[name][1]
    return found


def cheaper(a: tuple[float, float], b: tuple[float, float]) -> bool:
    """Return whether cost a is certainly below cost b, each given as (least, median).

    The median of a must be below the least of b, and more than TIE below the median of b. An upper bound in place of
    the median of a makes the test stricter.
    """
    return a[1] < b[0] and a[1] < (1.0 - TIE) * b[1]
