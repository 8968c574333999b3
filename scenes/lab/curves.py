"""Live curves at window resolution: one line for each series of values, on a logarithmic scale."""

from collections import deque
from math import log10

import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, INK, SLATE
from game.drawing.typical import Typical

HISTORY = 150  # default number of steps: 2.5 seconds


class Curves:
    """A plot of several series over the last `kept` steps.

    names: {series: colour}. Call note() once per step, and draw() to paint the plot.
    """

    def __init__(self, title, names, kept=HISTORY):
        self.title, self.names, self.kept = title, names, kept
        self.history = {name: deque(maxlen=kept) for name in names}
        self.figures = {name: Typical() for name in names}

    def note(self, values):
        """Append the values of a step, {series: value}. Negative values are drawn as 0."""
        for name, value in values.items():
            self.history[name].append(max(float(value), 0.0))
            self.figures[name].note(value)

    def typical(self, name):
        """Return the median of the series `name` over the last second, to be written beside its curve."""
        return self.figures[name].value

    def draw(self, frame, canvas_rect):
        """Draw the plot over `canvas_rect`, a rectangle of the canvas.

        Powers of ten are labelled where there is room.
        """
        rect = frame.from_canvas(canvas_rect)
        scale = frame.plot_scale
        surface = frame.surface
        surface.fill(INK, rect)
        pygame.draw.rect(surface, SLATE, rect, 1)
        frame.text(self.title, rect.x + 3 * scale, rect.y + 3 * scale, FOG, SMALL, scale)
        plot = pygame.Rect(rect.x + 2, rect.y + 11 * scale, rect.width - 4, rect.height - 13 * scale)
        top = max((max(values, default=0.0) for values in self.history.values()), default=0.0)
        decades = max(1.0, log10(top + 1.0) * 1.08)
        for decade in range(1, int(decades) + 1):
            y = plot.bottom - plot.height * decade / decades
            pygame.draw.line(surface, (52, 46, 76), (plot.left, y), (plot.right, y))
        for name, color in self.names.items():
            values = self.history[name]
            if len(values) < 2:
                continue
            step = plot.width / (self.kept - 1)
            x = plot.right - step * (len(values) - 1)
            points = [
                (x + i * step, plot.bottom - plot.height * log10(value + 1.0) / decades)
                for i, value in enumerate(values)
            ]
            pygame.draw.lines(surface, color, False, points, max(1, frame.scale - 1))
        for decade in range(1, int(decades) + 1):  # over the curves
            y = plot.bottom - plot.height * decade / decades
            if y + 7 * scale <= rect.bottom:
                frame.text_if_free(_power(decade), plot.left + 2 * scale, y + scale, FOG, SMALL, scale, "left", True)
        frame.fix(rect)


def _power(decade):
    """Return 10 to the power `decade` as text: 10, 100, 1k, 10k, 100k, 1M ..."""
    digits = 10 ** (decade % 3)
    return f"{digits}{('', 'k', 'M', 'G')[decade // 3]}"
