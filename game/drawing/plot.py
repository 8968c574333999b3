"""A plot with two logarithmic axes at window resolution: decades, ticks and points.

A strip below the plot may show the points with y = 0.
"""

from collections.abc import Iterable
from math import ceil, floor, log10

import pygame

from game.drawing.canvas import small_font
from game.drawing.colors import FOG, INK, SLATE, Color, faded
from game.drawing.presenter import Frame

STEPS = (1, 2, 5)  # of a decade
LEAST_SPAN = 0.5  # [decades] least span of an axis
PAD = 0.06  # [decades] beyond the outermost point
GRID = (52, 46, 76)


class Axis:
    """Logarithmic axis that contains all positive `values`. low, high: logarithms to base 10 of its ends.

    The axis extends beyond the values by PAD at each end, and spans at least LEAST_SPAN (both logarithms to base 10).
    """

    def __init__(self, values: Iterable[float]) -> None:
        found = [value for value in values if value > 0.0] or [1.0]
        low, high = log10(min(found)) - PAD, log10(max(found)) + PAD
        spare = max(0.0, LEAST_SPAN - (high - low)) / 2
        self.low, self.high = low - spare, high + spare

    def share(self, value: float) -> float:
        """Return the position of a positive value along the axis: 0 at the low end, 1 at the high end."""
        return (log10(value) - self.low) / (self.high - self.low)

    def ticks(self, most: int) -> list[float]:
        """Return round values within the axis, for about `most` ticks.

        The values are the products of STEPS and the powers of ten. If these are more than `most`, the values are the
        powers of ten alone.
        """
        decades = range(floor(self.low), ceil(self.high) + 1)
        for steps in (STEPS, (1,)):
            found = [step * 10.0**decade for decade in decades for step in steps]
            found = [value for value in found if self.low <= log10(value) <= self.high]
            if len(found) <= most:
                break
        return found


class LogPlot:
    """A logarithmic plot with the axes x and y. zero: whether a strip below the plot shows the points with y = 0."""

    def __init__(self, rect: pygame.Rect, x: Axis, y: Axis, zero: bool, scale: int) -> None:
        self.x, self.y, self.scale = x, y, scale
        self.font, self.line = small_font(scale)
        foot, side = (self.line + 2) * scale, (24 if self.line == 7 else 34) * scale  # room for the numbers
        inner = pygame.Rect(rect.x + side, rect.y + 2 * scale, rect.width - side - 4 * scale, rect.height - foot)
        self.strip = pygame.Rect(inner.x, inner.bottom - 11 * scale, inner.width, 11 * scale) if zero else None
        self.area = inner if not zero else pygame.Rect(inner.x, inner.y, inner.width, inner.height - 13 * scale)

    def place(self, x: float, y: float) -> tuple[float, float]:
        """Return the frame position (x, y) of a data point.

        A point with y = 0 is placed in the strip, if there is one.
        """
        left = self.area.x + self.x.share(x) * self.area.width
        if y <= 0.0 and self.strip is not None:
            return left, self.strip.centery
        return left, self.area.bottom - self.y.share(y) * self.area.height

    @property
    def least_y(self) -> float:
        """The smallest y on the axis."""
        return 10.0**self.y.low

    def draw_ground(self, frame: Frame) -> None:
        """Draw the background, the grid, and the numbers at both axes."""
        surface, scale, area = frame.surface, self.scale, self.area
        bottom = self.strip.bottom if self.strip is not None else area.bottom
        surface.fill(INK, area)
        if self.strip is not None:
            surface.fill(faded(SLATE, 0.75), self.strip)
            frame.text(
                "0",
                self.strip.x - 2 * scale,
                self.strip.centery - self.line // 3 * scale,
                FOG,
                self.font,
                scale,
                "right",
            )
        for value in self.x.ticks(max(2, area.width // ((self.line + 15) * scale))):
            left = round(self.place(value, 1.0)[0])
            pygame.draw.line(surface, GRID, (left, area.top), (left, bottom - 1))
            frame.text_if_free(number(value), left, bottom + 2 * scale, FOG, self.font, scale, "center")
        for value in self.y.ticks(max(2, area.height // ((self.line + 2) * scale))):
            top = round(self.place(1.0, value)[1])
            pygame.draw.line(surface, GRID, (area.left, top), (area.right - 1, top))
            frame.text_if_free(
                number(value), area.x - 2 * scale, top - self.line // 3 * scale, FOG, self.font, scale, "right"
            )
        pygame.draw.rect(surface, SLATE, area, 1)

    def draw_level(self, frame: Frame, value: float, color: Color, name: str) -> None:
        """Draw a dashed horizontal line at y = `value`, with its name.

        Draw nothing if the value is outside the axis.
        """
        if not self.y.low <= log10(value) <= self.y.high:
            return
        top = round(self.place(1.0, value)[1])
        for left in range(self.area.left, self.area.right - 2, 6 * self.scale):
            pygame.draw.line(frame.surface, color, (left, top), (min(left + 3 * self.scale, self.area.right - 1), top))
        frame.text_if_free(
            name, self.area.right - 2 * self.scale, top - self.line * self.scale, color, self.font, self.scale, "right"
        )


def number(value: float) -> str:
    """Return a number as short text: 0.02, 1, 300, 20k."""
    if value >= 1000.0:
        return f"{value / 1000.0:g}k"
    return f"{value:g}"
