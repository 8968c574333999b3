"""A piece of the report's work: a function by name and what it is called with, so that any process can do it.

What it returns are rows: dicts of what JSON has words for. A value whose key ends in "cost" is a time (see `spread`);
all else is a fact, which is the same wherever and how often it is found.
"""

from collections.abc import Iterable, Mapping
from pkgutil import resolve_name
from time import perf_counter
from typing import Any, NamedTuple

from game.measure.rates import Rate
from game.measure.timing import Cost
from physics.jit.kernels import measured as compiling

Row = dict[str, Any]
COST = "cost"  # what the keys of times end in


class Plan(NamedTuple):
    """What is to be measured. scenes: {name: "module:Class"} of all there are."""

    quick: bool
    scenes: Mapping[str, str]


class Job(NamedTuple):
    """name: the chart's key, a slash, and what of it; work: "module:function", which returns rows."""

    name: str
    work: str
    params: Mapping[str, Any]
    seconds: float = 2.0  # about what it takes, for what is told of the time that is left


def run_job(name: str, work: str, params: Mapping[str, Any]) -> Row:
    """{name, rows, spent, compiled [s]}, or {name, failed, spent, compiled}: what went wrong is told, whatever it is.

    compiled: how much of what was spent went into compiling; it is in no cost."""
    started = perf_counter()
    found: Row = {"name": name}
    try:
        with compiling() as seconds:
            found["rows"] = resolve_name(work)(**params)
        found["compiled"] = seconds()
    except Exception as error:  # a job must not take the others with it; the page counts and names it
        found["failed"] = f"{type(error).__name__}: {error}"
    found["spent"] = perf_counter() - started
    return found


def spread(cost: Cost) -> Row:
    """A Cost as a row holds it: seconds a piece, how many runs, of how many pieces each."""
    return {"seconds": [cost.least, cost.median, cost.upper], "runs": cost.runs, "pieces": cost.pieces}


def counted(rate: Rate) -> list[int]:
    """A Rate as a row holds it: [count, total]."""
    return [rate.count, rate.total]


def facts_of(rows: Iterable[Row]) -> list[Row]:
    """The rows without their times."""
    return [{key: value for key, value in row.items() if not key.endswith(COST)} for row in rows]
