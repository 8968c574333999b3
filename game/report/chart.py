"""A chart of the report: the jobs that measure its data, its plots, and the claims that it tests."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

from game.measure.rates import Rate
from game.report.claim import Claim
from game.report.job import Job, ReportScope, Row

Interval = tuple[float, float, float]  # low, middle, high
Reading = Callable[[Row], Interval | None]  # reads a figure of a row; None: the row does not have it

SECOND = {"ns": 1e9, "us": 1e6, "ms": 1e3, "s": 1.0}


class Axis(NamedTuple):
    """One axis of a plot. label: name and unit; read: function that reads the axis's figure from a row.

    log: whether the axis is logarithmic if the values span a decade. mark: position of a line, such as the smallest
    error that a player can see. decades: greatest span of a logarithmic axis. cap: length of a run, where the figure is
    a time within it; a figure that reaches it is reported as "more than" it. None: there is no such limit.
    """

    label: str
    read: Reading
    log: bool = True
    mark: float | None = None
    decades: int = 6
    cap: float | None = None


class Curve(NamedTuple):
    """A theoretical curve y = at(x) in a plot, such as the limit of floating-point arithmetic."""

    label: str
    at: Callable[[float], float]


class Panel(NamedTuple):
    """One plot of a chart. Each row of data is a dot.

    line: the line to draw. "front" is the Pareto front of the dots, and "medians" the Pareto front of the series'
    medians. "series" joins the dots of each series in the order of x. "" draws no line. shows(row): whether the row is
    shown; series(row): name of the series that the row belongs to.
    """

    title: str
    x: Axis
    y: Axis
    shows: Callable[[Row], bool] = lambda row: True
    line: str = "front"
    series: Callable[[Row], str] = lambda row: str(row["series"])
    curves: tuple[Curve, ...] = ()


class Chart(NamedTuple):
    """One chart of the report. It consists of plots. Its rows of measured data have the keys "series" and "label".

    key: first part of the names of its jobs; truth: a sentence that names the reference for the measured errors.
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
    """Return a function that reads a cost from a row and returns (least, median, upper quartile) in `unit`.

    key: the cost's key in the row. If the row lacks the key, the function returns None.
    """

    def read(row):
        cost = row.get(key)
        if cost is None:
            return None
        low, middle, high = (each * SECOND[unit] for each in cost["seconds"])
        return low, middle, high

    return read


def value(key: str, scale: float = 1.0) -> Reading:
    """Return a function that reads a number from a row, times `scale`, and returns (low, middle, high).

    key: the number's key in the row. The row stores one number, which is used three times, or a list of three. If the
    row lacks the key, the function returns None.
    """

    def read(row):
        found = row.get(key)
        if found is None:
            return None
        low, middle, high = found if isinstance(found, list) else (found, found, found)
        return low * scale, middle * scale, high * scale

    return read


def percent(key: str) -> Reading:
    """Return a function that reads a rate from a row and returns it in percent, (low, middle, high).

    key: the rate's key in the row. The row stores the rate as [count, total]. low and high are the ends of the
    confidence interval (Wilson).
    """

    def read(row):
        if row.get(key) is None:
            return None
        rate = Rate(*row[key])
        low, high = rate.interval
        return 100.0 * low, 100.0 * rate.share, 100.0 * high

    return read


def panel_is(name: str) -> Callable[[Row], bool]:
    """Return a predicate on rows: whether the row belongs to the panel with the given name."""
    return lambda row: row.get("panel") == name
