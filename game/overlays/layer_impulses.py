"""Impulses: the normal impulse and the friction impulse of each contact, as arrows."""

from math import hypot, log10

import numpy as np
import pygame

from game.drawing.colors import RED, YELLOW, Color
from game.drawing.presenter import Frame, Lens
from game.overlays.layer import Layer, LegendLine
from game.overlays.layer_contacts import seen_points
from physics import World, debug

IMPULSE_BUDGET = 800  # contacts per picture; the note says how many there are
LONGEST = 26.0  # [canvas px] greatest length of an arrow
REFERENCE = 10.0  # [canvas px] length of an arrow for the impulse that the legend names
TYPICAL = 0.9  # quantile of the normal impulses that sets the scale
FADE = 0.95  # factor per picture by which the scale decays after a peak


class Impulses(Layer):
    """Arrows for the impulses of each contact: the normal impulse in red, the friction impulse in yellow.

    The arrows show the impulses on body B, or on body A if B cannot move. The legend shows the scale.
    """

    name, title, key, color = "impulses", "Impulses", "9", RED

    def __init__(self) -> None:
        self.level = 0.0  # the current quantile of the normal impulses, decaying
        self.begin()

    def begin(self, views: int = 1) -> None:
        """Start a new picture with `views` views. The limit on drawn objects is divided evenly among the views."""
        self.drawn = self.total = 0
        self.room = IMPULSE_BUDGET // views
        self.unit = step_of(self.level)
        self.level *= FADE

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the impulses of a world's contacts. lens: maps world to frame coordinates."""
        rows = debug.contact_points(world)
        rows = rows[(rows["normal_impulse"] != 0.0) | (rows["tangent_impulse"] != 0.0)]
        self.total += len(rows)
        if len(rows) == 0:
            return
        self.level = max(self.level, float(np.quantile(np.abs(rows["normal_impulse"]), TYPICAL)))
        self.unit = max(self.unit, step_of(self.level))
        x, y = lens.points(rows["point_x"], rows["point_y"])
        seen = seen_points(lens, x, y)[: self.room]
        self.drawn += len(seen)
        scale = REFERENCE * frame.scale / self.unit if self.unit else 0.0
        scale = scale * np.where(can_move(world.bodies, rows["body_b"][seen]), 1.0, -1.0)
        shown = rows[seen]
        push, rub = shown["normal_impulse"] * scale, shown["tangent_impulse"] * scale
        columns = (x[seen], y[seen], shown["normal_x"], shown["normal_y"], push, rub)
        for at_x, at_y, nx, ny, along, across in zip(*(column.tolist() for column in columns), strict=True):
            arrow(frame, at_x, at_y, nx * along, ny * along, RED)
            arrow(frame, at_x, at_y, -ny * across, nx * across, YELLOW)

    def notes(self) -> list[LegendLine]:
        """Return the lines of the layer for the legend, a list of (color, text)."""
        scale = f", {REFERENCE:.0f} px is {short(self.unit)}" if self.unit else ""
        return [(self.color, f"impulses {self.drawn} of {self.total}{scale}"), (YELLOW, "friction")]


def can_move(bodies: np.ndarray, ids: np.ndarray) -> np.ndarray:
    """Return (n,) bool: whether each body exists and has finite mass.

    bodies: BODY rows; ids: (n,) ids of the bodies.
    """
    known = np.ascontiguousarray(bodies["id"])
    rows = np.minimum(np.searchsorted(known, ids), len(known) - 1)
    return (known[rows] == ids) & (bodies["inverse_mass"][rows] > 0.0)


def arrow(frame: Frame, x: float, y: float, dx: float, dy: float, color: Color) -> None:
    """Draw an arrow from (x, y) to (x + dx, y + dy) [frame px], shortened to at most LONGEST canvas px.

    An arrow shorter than a canvas pixel is not drawn.
    """
    length = hypot(dx, dy)
    if length < frame.scale:
        return
    longest = LONGEST * frame.scale
    if length > longest:
        dx, dy, length = dx * longest / length, dy * longest / length, longest
    width, color = max(1, frame.scale - 1), frame.tone(color)
    end = (x + dx, y + dy)
    pygame.draw.line(frame.surface, color, (x, y), end, width)
    head = min(2.5 * frame.scale, length) / length
    for side in (-0.6, 0.6):
        back = (end[0] - head * (dx - side * dy), end[1] - head * (dy + side * dx))
        pygame.draw.line(frame.surface, color, end, back, width)


def step_of(value: float) -> float:
    """Return the smallest of the numbers ..., 1, 2, 5, 10, 20, ... that is at least `value`.

    Return 0 if `value` is not positive. Such a number is used as a scale that seldom changes.
    """
    if not 0.0 < value < float("inf"):
        return 0.0
    power = 10.0 ** int(np.floor(log10(value)))
    return next(digit * power for digit in (1, 2, 5, 10) if digit * power >= value * 0.999999)


def short(value: float) -> str:
    """Return `value`, which is 1, 2 or 5 times a power of ten, as short text such as "20k"."""
    for limit, divisor, letter in ((1e3, 1, ""), (1e6, 1e3, "k"), (1e9, 1e6, "M")):
        if value < limit:
            return f"{value / divisor:g}{letter}"
    return f"{value:.0e}"
