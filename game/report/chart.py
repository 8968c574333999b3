"""A chart of the report: its jobs, its panels and its claims."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

from game.measure.rates import Rate
from game.report.claim import Claim
from game.report.job import Job, ReportScope, Row

Interval = tuple[float, float, float]  # low, middle, high
Reading = Callable[[Row], Interval | None]  # None: the row has nothing to show there

SECOND = {"ns": 1e9, "us": 1e6, "ms": 1e3, "s": 1.0}


class Axis(NamedTuple):
    """One axis. label: with its unit; log: if values span a decade; mark: position of a line, such as the limit of what
    a player sees; decades: greatest span of a logarithmic axis.
    """

    label: str
    read: Reading
    log: bool = True
    mark: float | None = None
    decades: int = 6


class Curve(NamedTuple):
    """A line over x that belongs to no row, such as a limit of arithmetic."""

    label: str
    at: Callable[[float], float]


class Panel(NamedTuple):
    """One plot. line: "front" joins the dots that no other dot beats, "medians" the series whose medians none beats,
    "series" the dots of each in the order of x; "" no line. series: the series of a row's dot.
    """

    title: str
    x: Axis
    y: Axis
    shows: Callable[[Row], bool] = lambda row: True
    line: str = "front"
    series: Callable[[Row], str] = lambda row: str(row["series"])
    curves: tuple[Curve, ...] = ()


class Chart(NamedTuple):
    """One chart. Its rows have "series" and "label"; key: the first part of its jobs' names; truth: the reference of
    its errors.
    """

    number: int
    key: str
    title: str
    question: str
    truth: str
    panels: tuple[Panel, ...] | Callable[[Sequence[Row]], list[Panel]]  # of the existing rows
    jobs: Callable[[ReportScope], list[Job]]
    claims: Callable[[Sequence[Row]], list[Claim]] = lambda rows: []
    of: str = ""  # key of the chart whose rows it shows; "" its own


def time(key: str, unit: str = "us") -> Reading:
    """Return a reading of the least, the median and the upper quartile of a cost."""

    def read(row):
        cost = row.get(key)
        if cost is None:
            return None
        low, middle, high = (each * SECOND[unit] for each in cost["seconds"])
        return low, middle, high

    return read


def value(key: str, scale: float = 1.0) -> Reading:
    """Return a reading of a number, or of three: low, middle, high."""

    def read(row):
        found = row.get(key)
        if found is None:
            return None
        low, middle, high = found if isinstance(found, list) else (found, found, found)
        return low * scale, middle * scale, high * scale

    return read


def percent(key: str) -> Reading:
    """Return a reading of a rate, kept as [count, total], in percent, with the interval of the true rate (Wilson)."""

    def read(row):
        if row.get(key) is None:
            return None
        rate = Rate(*row[key])
        low, high = rate.interval
        return 100.0 * low, 100.0 * rate.share, 100.0 * high

    return read


def panel_is(name: str) -> Callable[[Row], bool]:
    """Return a filter of the rows of the panel with that name."""
    return lambda row: row.get("panel") == name
