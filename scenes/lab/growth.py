"""Plot of cost against number of bodies, on logarithmic scales, with a fitted power law for each series."""

from collections.abc import Mapping, Sequence
from math import ceil, floor, log10
from typing import NamedTuple

import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, INK, SLATE, Color
from game.drawing.presenter import Box, Frame
from game.measure.power_law import PowerLaw
from game.measure.timing import Cost

GRID = (52, 46, 76)
LABEL = 54  # [text px] for the exponents at the right
LINE = 8  # [text px] least distance of two exponents
UNITS = ((1.0, "s"), (1e-3, "ms"), (1e-6, "us"), (1e-9, "ns"))


class Series(NamedTuple):
    """One curve of the plot of cost over number of bodies.

    points: list of (number of bodies, Cost), smallest number first; law: power law fitted to the last `fitted` points,
    or None while it is unknown.
    """

    color: Color
    points: Sequence[tuple[int, Cost]]
    law: PowerLaw | None = None
    fitted: int = 0


def draw_growth(frame: Frame, canvas_rect: Box, title: str, series: Mapping[str, Series], here: int) -> None:
    """Draw a plot of cost over number of bodies, with one curve for each Series, into a rectangle of the canvas.

    series: {name: Series}; here: current number of bodies, marked on the lower axis.
    """
    rect, scale, surface = frame.from_canvas(canvas_rect), frame.plot_scale, frame.surface
    surface.fill(INK, rect)
    pygame.draw.rect(surface, SLATE, rect, 1)
    frame.text(title, rect.x + 3 * scale, rect.y + 3 * scale, FOG, SMALL, scale)
    points = [point for each in series.values() for point in each.points]
    plot = pygame.Rect(rect.x + 3 * scale, rect.y + 12 * scale, 0, 0)
    plot.size = rect.right - LABEL * scale - plot.x, rect.bottom - 10 * scale - plot.y
    if points:
        axes = _LogAxes(plot, points)
        _draw_grid(frame, axes, here, scale)
        for each in series.values():
            _draw_series(surface, axes, each, frame)
        _write_laws(frame, axes, series, rect, scale)
    else:
        frame.text("measuring", plot.x, rect.centery, FOG, SMALL, scale)
    frame.fix(rect)


class _LogAxes:
    """Transform of (number of bodies, time [s]) into frame pixels of the plot, on logarithmic scales."""

    def __init__(self, plot, points):
        self.plot = plot
        sizes, costs = [size for size, _ in points], [value for _, cost in points for value in cost[:2]]
        self.left, self.right = log10(min(sizes)) - 0.05, log10(max(sizes)) + 0.05
        self.low, self.high = log10(min(costs)) - 0.1, log10(max(costs)) + 0.1

    def x(self, size):
        return self.plot.left + self.plot.width * (log10(size) - self.left) / (self.right - self.left)

    def y(self, cost):
        return self.plot.bottom - self.plot.height * (log10(cost) - self.low) / (self.high - self.low)


def _draw_grid(frame, axes, here, scale):
    surface, plot = frame.surface, axes.plot
    for power in range(ceil(axes.low), floor(axes.high) + 1):
        y = axes.y(10.0**power)
        pygame.draw.line(surface, GRID, (plot.left, y), (plot.right, y))
    for power in range(ceil(axes.left), floor(axes.right) + 1):
        x = axes.x(10.0**power)
        pygame.draw.line(surface, GRID, (x, plot.top), (x, plot.bottom))
        frame.text(f"{10**power:,}", round(x), plot.bottom + 3 * scale, FOG, SMALL, scale, "center")
    x = min(max(axes.x(here), plot.left), plot.right)
    reach = 2 * scale
    pygame.draw.polygon(
        surface, FOG, [(x, plot.bottom - 2 * reach), (x - reach, plot.bottom), (x + reach, plot.bottom)]
    )


def _draw_series(surface, axes, series, frame):
    if series.law is not None and series.fitted:
        ends = [series.points[-series.fitted][0], series.points[-1][0]]
        start, end = ((axes.x(n), axes.y(series.law.at(n))) for n in ends)
        pygame.draw.line(surface, series.color, start, end)
    for size, cost in series.points:
        x, y = axes.x(size), axes.y(cost.least)
        pygame.draw.line(surface, series.color, (x, y), (x, axes.y(cost.median)))
        pygame.draw.circle(surface, series.color, (x, y), max(2, frame.scale), 0 if series.law else 1)


def _write_laws(frame, axes, series, rect, scale):
    """Write each power law's exponent at the end of its curve, without overlap, and label the powers of ten of the
    time axis.

    series: {name: Series}; rect: frame rectangle of the whole plot; scale: frame pixels of a text pixel.
    """
    ends = sorted((axes.y(each.points[-1][1].least), name) for name, each in series.items() if each.points)
    step, top = LINE * scale, axes.plot.top
    last = rect.bottom - 10 * scale - step * len(ends)
    for number, (y, name) in enumerate(ends):
        y = top = max(top, min(round(y - step / 2), last + step * number))
        law = series[name].law
        text = f"n^{law.exponent:.2f} +-{law.error:.2f}" if law is not None else name
        frame.text(text, axes.plot.right + 3 * scale, y, series[name].color, SMALL, scale)
        top += step
    for power in range(ceil(axes.low), floor(axes.high) + 1):  # over the lines
        y = round(axes.y(10.0**power)) - 6 * scale
        if y > axes.plot.top:
            frame.text_if_free(in_units(10.0**power), axes.plot.left + scale, y, FOG, SMALL, scale, "left", True)


def in_units(seconds: float) -> str:
    """Return a time [s] that is a power of ten as short text: "10 us", "1 ms"."""
    size, unit = next(((size, unit) for size, unit in UNITS if seconds >= 0.999 * size), UNITS[-1])
    return f"{seconds / size:.0f} {unit}"
