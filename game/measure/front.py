"""Which of many (cost, error) points are worth having."""

from collections.abc import Mapping
from typing import TypeVar

Name = TypeVar("Name")
TIE = 0.1  # costs that differ by less than this share are a tie, whatever their intervals


def pareto(points: Mapping[Name, tuple[float, float]]) -> list[Name]:
    """The names of the points that no other beats in both cost and error, the cheapest first."""
    front, least = [], float("inf")
    for name in sorted(points, key=lambda each: points[each]):
        if points[name][1] < least:
            front.append(name)
            least = points[name][1]
    return front


def cheaper(a: tuple[float, float], b: tuple[float, float]) -> bool:
    """Whether a cost (least, median) is below another for sure: the intervals are apart, and by more than a tie."""
    return a[1] < b[0] and a[1] < (1.0 - TIE) * b[1]
