"""A chart of the report: the jobs that measure it, its plots, and the claims that it tests."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

from game.measure.rates import Rate
from game.report.claim import Claim
from game.report.job import Job, ReportScope, Row

Interval = tuple[float, float, float]  # low, middle, high
Reading = Callable[[Row], Interval | None]  # reads a figure of a row; None: the row does not have it

SECOND = {"ns": 1e9, "us": 1e6, "ms": 1e3, "s": 1.0}


class Axis(NamedTuple):
    """One axis of a plot. label: name and unit. read: reads the figure of a row.

    log: whether it is logarithmic if the values span a decade. mark: position of a line, such as the smallest error
    that a player sees. decades: greatest span of a logarithmic axis.
    """

    label: str
    read: Reading
    log: bool = True
    mark: float | None = None
    decades: int = 6


class Curve(NamedTuple):
    """A theoretical line y = at(x) in a plot, such as the limit of floating-point arithmetic."""

    label: str
    at: Callable[[float], float]


class Panel(NamedTuple):
    """One plot of a chart; each row is a dot.

    line: the line to draw. "front": the Pareto front of the dots; "medians": the Pareto front of the series' medians;
    "series": through the dots of each series in the order of x; "": none. shows(row): whether the row is shown;
    series(row): name of the series to which the row belongs.
    """

    title: str
    x: Axis
    y: Axis
    shows: Callable[[Row], bool] = lambda row: True
    line: str = "front"
    series: Callable[[Row], str] = lambda row: str(row["series"])
    curves: tuple[Curve, ...] = ()


class Chart(NamedTuple):
    """One chart of the report, made of plots. Its rows of measured data have the keys "series" and "label".

    key: first part of the names of its jobs; truth: a sentence that names the reference against which errors are
    measured.
    """

    number: int
    key: str
    title: str
    question: str
    truth: str
    panels: tuple[Panel, ...] | Callable[[Sequence[Row]], list[Panel]]  # panels, or a function of the rows
    jobs: Callable[[ReportScope], list[Job]]
    claims: Callable[[Sequence[Row]], list[Claim]] = lambda rows: []
    of: str = ""  # key of another chart whose rows this one shows; "": it has its own rows


def time(key: str, unit: str = "us") -> Reading:
    """Return a reading of a cost in `unit`: a function of a row that returns (least, median, upper quartile).

    key: the cost's key in the row. The function returns None if the row does not have it.
    """

    def read(row):
        cost = row.get(key)
        if cost is None:
            return None
        low, middle, high = (each * SECOND[unit] for each in cost["seconds"])
        return low, middle, high

    return read


def value(key: str, scale: float = 1.0) -> Reading:
    """Return a reading of the number `key` of a row, times `scale`.

    The reading is a function of a row that returns (low, middle, high). A row stores one number, which is used three
    times, or a list of three.
    """

    def read(row):
        found = row.get(key)
        if found is None:
            return None
        low, middle, high = found if isinstance(found, list) else (found, found, found)
        return low * scale, middle * scale, high * scale

    return read


def percent(key: str) -> Reading:
    """Return a reading of the rate `key` of a row in percent: a function of a row that returns (low, middle, high).

    A row stores the rate as [count, total]. low and high are the ends of the confidence interval (Wilson).
    """

    def read(row):
        if row.get(key) is None:
            return None
        rate = Rate(*row[key])
        low, high = rate.interval
        return 100.0 * low, 100.0 * rate.share, 100.0 * high

    return read


def panel_is(name: str) -> Callable[[Row], bool]:
    """Return a function of a row that returns whether the row belongs to the panel with that name."""
    return lambda row: row.get("panel") == name
