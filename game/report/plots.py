"""Panels of the report, drawn as SVG by matplotlib, in the page's light or dark colours.

The page can show the data of each dot. The functions raise UsageError if matplotlib is not installed.
"""

import io
import re
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from math import ceil, floor, isfinite, log10
from statistics import median
from typing import Any, NamedTuple

from game import startup
from game.drawing.number_text import plain_name
from game.errors import UsageError
from game.measure.pareto_front import pareto_front
from game.report.chart import Axis, Interval, Panel
from game.report.job import Row

SIZE = (6.4, 4.0)  # [inch]
# Placeholder colours that no plot uses otherwise -> CSS variables of the page that replace them.
INKS = {"#010203": "var(--ink)", "#040506": "var(--paper)", "#070809": "var(--faint)"}
INK, PAPER, FAINT = INKS
# Okabe and Ito's colours, distinguishable under most kinds of colour blindness, dark enough for both grounds.
COLORS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#b8860b", "#56a0d9", "#8064c8", "#7a7a7a", "#c0392b", "#4d8f1f")
MARKERS = "osD^vP*X<>"
CURVES = (":", "-.")


class Dot(NamedTuple):
    """A dot of a panel: its row of data, and its x and y, each as (low, middle, high)."""

    row: Row
    x: Interval
    y: Interval


@cache
def library() -> Any:
    """Return matplotlib's Figure class, which draws without a window.

    Raises UsageError if matplotlib is not installed.
    """
    try:
        import matplotlib
        from matplotlib.figure import Figure
    except ImportError as error:
        raise UsageError(f"--report needs matplotlib; it comes with: {startup.install('bench')}") from error
    matplotlib.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "hitbox", "font.family": "sans-serif"})
    return Figure


def dots_of(panel: Panel, rows: Sequence[Row]) -> list[Dot]:
    """Return the dots of a panel, one for each row that it shows and that has finite x and y."""
    found = []
    for row in rows:
        if not panel.shows(row):
            continue
        x, y = panel.x.read(row), panel.y.read(row)
        if x is not None and y is not None and all(map(isfinite, (*x, *y))):
            found.append(Dot(row, x, y))
    return found


def draw(panel: Panel, rows: Sequence[Row], name: str) -> tuple[str, list[Dot]]:
    """Return (SVG text, dots) of a panel. The SVG text is "" if there are no dots.

    name: name of the panel in the SVG. Dot number k has the id "{name}-{k}".
    """
    figure = library()(figsize=SIZE, layout="constrained")
    dots = dots_of(panel, rows)
    if not dots:
        return "", []
    axes = figure.add_subplot()
    figure.patch.set_alpha(0.0)
    axes.set_facecolor(PAPER)
    for number, (series, members) in enumerate(_series(dots, panel)):
        color, marker = COLORS[number % len(COLORS)], MARKERS[number % len(MARKERS)]
        if panel.line == "series":
            ordered = sorted(members, key=lambda pair: pair[1].x[1])
            axes.plot([d.x[1] for _, d in ordered], [d.y[1] for _, d in ordered], color=color, linewidth=1.2, alpha=0.7)
        for k, dot in members:
            _bars(axes, dot, color)
            failed = any(dot.row.get("failures", {}).values())
            axes.plot(
                [dot.x[1]], [dot.y[1]], marker, color=color, markersize=6, gid=f"{name}-{k}",
                markerfacecolor="none" if failed else color, zorder=3,
            )  # fmt: skip
        axes.plot([], [], marker, color=color, label=series)
    if panel.line in ("front", "medians"):
        points = {str(k): (dot.x[1], dot.y[1]) for k, dot in enumerate(dots)}
        if panel.line == "medians":
            points = {name: _middle([dot for _, dot in members]) for name, members in _series(dots, panel)}
        axes.plot(
            *zip(*(points[each] for each in pareto_front(points)), strict=True), color=INK, linewidth=1.0, zorder=2
        )
    _scale(axes, "x", panel.x, [dot.x for dot in dots])
    _curves(axes, panel, dots)
    _scale(axes, "y", panel.y, [dot.y for dot in dots])
    _dress(axes, panel)
    return _page_colors(figure), dots


def _series(dots, panel) -> Iterator[tuple[str, list[tuple[int, Dot]]]]:
    groups: dict[str, list[tuple[int, Dot]]] = {}
    for k, dot in enumerate(dots):
        groups.setdefault(panel.series(dot.row), []).append((k, dot))
    yield from groups.items()


def _middle(dots):
    return median(dot.x[1] for dot in dots), median(dot.y[1] for dot in dots)


def _bars(axes, dot, color):
    for values, flat in ((dot.x, True), (dot.y, False)):
        low, _, high = values
        if high > low:
            at = (values[0], values[2]), (dot.y[1], dot.y[1])
            if not flat:
                at = (dot.x[1], dot.x[1]), (values[0], values[2])
            axes.plot(*at, color=color, linewidth=1.0, alpha=0.5)


def _curves(axes, panel, dots):
    """Draw the panel's theoretical curves as dotted lines over the measured range of x."""
    at = sorted({dot.x[1] for dot in dots if dot.x[1] > 0.0})
    for curve, style in zip(panel.curves, CURVES, strict=False):
        axes.plot(at, [curve.at(x) for x in at], linestyle=style, color=INK, linewidth=1.0, label=curve.label)


def _scale(axes, which, axis: Axis, values: Sequence[Interval]):
    """Make an axis logarithmic if `axis.log` is set and the values span at least a decade.

    Over a shorter span, tick labels would overlap. which: "x" or "y". Values more than axis.decades below the largest
    value are drawn at the lower end, together with zero. Call this after all dots are drawn.
    """
    positive = [high for _, _, high in values if high > 0.0]
    if not axis.log or not positive or max(positive) < 10.0 * min(low for low, _, _ in values):
        return
    set_scale, set_limits = getattr(axes, f"set_{which}scale"), getattr(axes, f"set_{which}lim")
    foot = max(positive) * 10.0**-axis.decades
    if all(low > foot for low, _, _ in values):
        set_scale("log")
        least, most = min(low for low, _, _ in values), max(positive)
        if most < 100.0 * least:  # matplotlib's own ticks would overlap
            powers = range(ceil(log10(least)) - 1, ceil(log10(most)))
            ticks = [each * 10.0**power for power in powers for each in (1.0, 2.0, 5.0)]
            ticks = [each for each in ticks if least <= each <= most]
            getattr(axes, f"set_{which}ticks")(ticks, labels=[f"{each:g}" for each in ticks])
            getattr(axes, f"{which}axis").set_minor_formatter("")
        return
    least = min(middle for _, middle, _ in values if middle > foot) if any(v[1] > foot for v in values) else foot
    first, last = ceil(log10(least) - 1e-9), floor(log10(max(positive)) + 1e-9)
    if last <= first:
        return
    set_scale("symlog", linthresh=least, linscale=max(0.3, 0.08 * (last - first + 1)))
    getattr(axes, f"set_{which}ticks")(
        [0.0, *(10.0**power for power in range(first, last + 1, 1 + (last - first) // 9))]
    )
    set_limits(-0.1 * least, max(positive) * 1.6)


def _dress(axes, panel):
    axes.set_xlabel(panel.x.label, color=INK)
    axes.set_ylabel(panel.y.label, color=INK)
    axes.tick_params(which="both", color=FAINT, labelcolor=INK, labelsize=8)
    for spine in axes.spines.values():
        spine.set_color(FAINT)
    axes.grid(color=FAINT, linewidth=0.5, alpha=0.5)
    for axis, line in ((panel.x, axes.axvline), (panel.y, axes.axhline)):
        if axis.mark is not None:
            line(axis.mark, color=COLORS[1], linewidth=1.0, linestyle="--")
    legend = axes.legend(
        fontsize=7, labelcolor=INK, facecolor=PAPER, edgecolor=FAINT, loc="upper left", bbox_to_anchor=(1.01, 1.0)
    )
    legend.set_zorder(5)


def _page_colors(figure) -> str:
    file = io.StringIO()
    figure.savefig(file, format="svg", metadata={"Date": None, "Creator": None})
    text = file.getvalue()
    text = text[text.index("<svg") :]
    for ink, name in INKS.items():
        text = text.replace(ink, name)
    # The size in points is dropped: the page sets the width.
    return re.sub(r'<svg ([^>]*?)width="[^"]*" height="[^"]*"', r"<svg \1", text, count=1)


def shown(dot: Dot, panel: Panel) -> Mapping[str, str]:
    """Return the texts of the box that appears when the pointer is over a dot, {label: text}.

    The texts contain the figures of both axes with their intervals, the failures, and the ignored effects.
    """
    reported = {
        "": f"{dot.row['series']}: {dot.row['label']}" if dot.row["label"] != dot.row["series"] else dot.row["label"]
    }
    for axis, (low, middle, high) in ((panel.x, dot.x), (panel.y, dot.y)):
        reported[axis.label] = _number(middle, axis.cap) + (
            f" ({_number(low, axis.cap)} to {_number(high, axis.cap)})" if high > low else ""
        )
    failures = {key: count for key, count in dot.row.get("failures", {}).items() if count}
    if failures:
        reported["failures"] = ", ".join(f"{key} {count}" for key, count in failures.items())
    if dot.row.get("ignored_effects"):
        reported["effects that the solver ignores"] = ", ".join(map(plain_name, dot.row["ignored_effects"]))
    return reported


def _number(value: float, cap: float | None) -> str:
    """Return a number as text: "more than" the cap if it reaches the cap of its axis."""
    return f"more than {cap:.4g}" if cap is not None and value >= cap else f"{value:.4g}"
