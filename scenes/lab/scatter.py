"""Scatter plot of error against time: a dot for every setting, on logarithmic scales, at window resolution."""

from collections.abc import Mapping
from math import ceil, floor, log10
from typing import NamedTuple

import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, INK, PAPER, SLATE, Color
from game.drawing.presenter import Box, Frame

GRID = (52, 46, 76)
APART = 3  # [text px] least distance of two names in a row
LEAST_SPAN = 0.3  # [decades] least span of a scale


class Dot(NamedTuple):
    """A dot of the plot: one setting with its cost [us] and error.

    name: label beside the dot; tried: whether the setting has already run in the scene.
    """

    cost: float
    error: float  # 0 lies on the bottom line
    color: Color
    name: str
    tried: bool


def draw_scatter(frame: Frame, canvas_rect: Box, title: str, dots: Mapping[object, Dot], here: object) -> None:
    """Draw a scatter plot of error against cost into a rectangle of the canvas.

    dots: {key of a setting: Dot}; here: key of the current setting, which is marked by a ring. Settings that have not
    run in the scene are hollow dots.
    """
    rect, scale, surface = frame.from_canvas(canvas_rect), frame.plot_scale, frame.surface
    surface.fill(INK, rect)
    pygame.draw.rect(surface, SLATE, rect, 1)
    frame.text(title, rect.x + 3 * scale, rect.y + 3 * scale, FOG, SMALL, scale)
    plot = pygame.Rect(rect.x + 3 * scale, rect.y + 14 * scale, rect.width - 12 * scale, rect.height - 26 * scale)
    if dots:
        places = _place(plot, dots)
        _draw_scale(frame, plot, dots, scale)
        for key, dot in dots.items():
            radius = max(2, 3 * frame.scale // 2)
            pygame.draw.circle(surface, dot.color, places[key], radius, 0 if dot.tried else 1)
        if here in places:
            pygame.draw.circle(surface, PAPER, places[here], 4 * frame.scale, max(1, frame.scale // 2))
        for key in sorted(dots, key=lambda each: each != here):
            x, y = places[key][0] + 4 * scale, places[key][1] - 7 * scale
            room = frame.text_rect(dots[key].name, x, y, SMALL, scale).inflate(2 * APART * scale, 0)
            if frame.is_free(room):  # two numbers side by side would read as one
                frame.text(dots[key].name, x, y, dots[key].color, SMALL, scale)
    else:
        frame.text("measuring", plot.x, rect.centery, FOG, SMALL, scale)
    frame.fix(rect)


def _span(values):
    """Return (low, high), the decimal logarithms of both ends of a scale that contains all values."""
    low, high = log10(min(values)), log10(max(values))
    wider = max(LEAST_SPAN - (high - low), 0.0) / 2
    return low - wider, high + wider


def _spans(dots):
    positive = [dot.error for dot in dots.values() if dot.error > 0.0]
    return _span([dot.cost for dot in dots.values()]), _span(positive or [1.0])


def _place(plot, dots):
    """Return {key: (x, y)}, the position of each dot in the frame. plot: rectangle of the frame between the axes."""
    (left, right), (low, high) = _spans(dots)
    places = {}
    for key, dot in dots.items():
        x = plot.left + plot.width * (log10(dot.cost) - left) / (right - left)
        share = (log10(dot.error) - low) / (high - low) if dot.error > 0.0 else 0.0
        places[key] = x, plot.bottom - plot.height * share
    return places


def _draw_scale(frame, plot, dots, scale):
    """Draw grid lines at the powers of ten of the error, and write the cost at both ends of the cost axis.

    plot: rectangle of the frame between the axes; scale: frame pixels of a text pixel.
    """
    (left, right), (low, high) = _spans(dots)
    for power in range(ceil(low), floor(high) + 1):
        y = plot.bottom - plot.height * (power - low) / (high - low)
        pygame.draw.line(frame.surface, GRID, (plot.left, y), (plot.right, y))
    y = plot.bottom + 5 * scale
    frame.text(f"{10**left:,.0f} us", plot.left, y, FOG, SMALL, scale)
    frame.text(f"{10**right:,.0f} us", plot.right + 6 * scale, y, FOG, SMALL, scale, "right")
