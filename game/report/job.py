"""A job of the report: the name of a function and its arguments, so that any process can run it.

A job returns rows, which are dicts of JSON values. A value whose key ends in "cost" is a time (see `spread`), which
differs from run to run. All other values are the same in every run.
"""

from collections.abc import Iterable, Mapping
from pkgutil import resolve_name
from time import perf_counter
from typing import Any, NamedTuple

from game.measure.rates import Rate
from game.measure.timing import Cost
from physics.jit.kernels import measured as compiling

Row = dict[str, Any]
COST = "cost"  # the keys of times end in it


class ReportScope(NamedTuple):
    """Extent of the report.

    quick: True makes fewer and smaller measurements; scenes: {name: "module:Class"} of all scenes.
    """

    quick: bool
    scenes: Mapping[str, str]


class Job(NamedTuple):
    """One measurement of the report, made by one process. name: the chart's key, a slash, and the subject.

    work: "module:function", a function that returns rows of measured data; params: its arguments.
    """

    name: str
    work: str
    params: Mapping[str, Any]
    seconds: float = 2.0  # expected duration, for the estimate of the remaining time


def run_job(name: str, work: str, params: Mapping[str, Any]) -> Row:
    """Run a job: call the function `work` ("module:function") with the arguments `params`.

    Return {name, rows, spent, compiled}, or {name, failed, spent} with the text of the error. spent: duration [s];
    compiled: time [s] of compiling kernels within it, which no cost includes.
    """
    started = perf_counter()
    found: Row = {"name": name}
    try:
        with compiling() as seconds:
            found["rows"] = resolve_name(work)(**params)
        found["compiled"] = seconds()
    except Exception as error:  # a failed job must not stop the others; the page counts and names it
        found["failed"] = f"{type(error).__name__}: {error}"
    found["spent"] = perf_counter() - started
    return found


def spread(cost: Cost) -> Row:
    """Return a Cost in the form in which a row stores it, a dict with the keys "seconds", "runs" and "pieces".

    "seconds": [least, median, upper quartile] per piece of work; "pieces": pieces of work per run.
    """
    return {"seconds": [cost.least, cost.median, cost.upper], "runs": cost.runs, "pieces": cost.pieces}


def counted(rate: Rate) -> list[int]:
    """Return a Rate in the form in which a row stores it: [count, total]."""
    return [rate.count, rate.total]


def facts_of(rows: Iterable[Row]) -> list[Row]:
    """Return copies of the rows without the values that are times (keys that end in "cost")."""
    return [{key: value for key, value in row.items() if not key.endswith(COST)} for row in rows]
