"""A race on a split screen: the scene at the left, its rival at the right, and a plot of their distance below."""

from collections import deque
from math import log10

import pygame

from game.drawing.canvas import CANVAS_SIZE, SMALL, TEXT, wrap
from game.drawing.colors import FOG, GOLD, INK, NIGHT, ORANGE, PAPER, SKY, SLATE, faded
from game.drawing.presenter import Frame
from game.measure.errors import VISIBLE
from game.overlays.stack import Overlays
from game.run.picture import Picture
from game.screens.parts.race import Race
from game.screens.parts.timeline import BAR_HEIGHT

LEAST, MOST = 1e-3, 1e3  # [px] range of the plot
LINE = 9  # [text px]
NOT_HERE = {"invariants", "disagreement"}  # layers that need each step reported, which the rival does not do


class SplitScreen:
    """Split screen that shows both scenes of a race side by side, over the game's part of a frame."""

    def __init__(self, race: Race) -> None:
        self.race = race
        self.overlays = Overlays()  # of the rival
        self.pictures: list[Picture] = []  # of the two

    def draw(self, frame: Frame, overlays: Overlays, alpha: float) -> None:
        """Draw both scenes in their current state, with the same overlays.

        alpha: position between the last two steps, 0..1.
        """
        area = frame.area.clip(frame.rect)
        size = area.width // 2, area.width // 2 * CANVAS_SIZE[1] // CANVAS_SIZE[0]
        race = self.race
        race.rival.figures, race.rival.accessibility = race.scene.figures, race.scene.accessibility
        self.overlays.on = overlays.on - NOT_HERE
        self._make_pictures(size[0])
        frame.surface.fill(INK, area)
        for number, (scene, layers) in enumerate(((race.scene, overlays), (race.rival, self.overlays))):
            half = self.pictures[number].draw_scene(scene, layers, alpha)
            if number:
                race.draw_gaps(half, race.rival)
            whole = half.surface.get_size() == size
            shown = half.surface if whole else pygame.transform.smoothscale(half.surface, size)
            frame.surface.blit(shown, (area.x + number * size[0], area.y))
        frame.surface.fill(SLATE, (area.x + size[0] - 1, area.y, 2, size[1]))
        frame.fix(pygame.Rect(area.x, area.y, 2 * size[0], size[1]))
        self._draw_below(frame, pygame.Rect(area.x, area.y + size[1], area.width, area.height - size[1]))

    def _make_pictures(self, width):
        """Make the pictures of both scenes, unless they already have the right size.

        The scale of the pictures is the smallest whole number at which a picture is at least `width` frame px wide.
        """
        scale = -(-width // CANVAS_SIZE[0])
        wanted = CANVAS_SIZE[0] * scale, CANVAS_SIZE[1] * scale
        if not self.pictures or self.pictures[0].presenter.frame.surface.get_size() != wanted:
            self.pictures = [Picture(pygame.Surface(wanted)) for _ in range(2)]

    def _draw_below(self, frame, rect):
        scale = frame.text_scale
        seconds = self.race.seconds or (0.0, 0.0)
        y = rect.y + 3 * scale
        lines = self.race.report_lines()
        for number, color in enumerate((GOLD, SKY)):
            left, room = rect.x + number * rect.width // 2 + 4 * scale, rect.width // 2 - 8 * scale
            name, time = lines[number].rsplit(": ", 1)
            text = wrap(name, room - frame.measure(time, SMALL, scale)[0] - 4 * scale, TEXT, scale)[0]
            frame.text(text, left, y, color, TEXT, scale)
            frame.text(time, left + room, y + 2 * scale, PAPER, SMALL, scale, "right")
            share = seconds[number] / max(*seconds, 1e-9)
            frame.surface.fill(faded(color, 0.7), (left, y + 11 * scale, room, 2 * scale))
            frame.surface.fill(frame.tone(color), (left, y + 11 * scale, round(room * share), 2 * scale))
        lines = wrap(lines[2], rect.width - 8 * scale, SMALL, scale)
        y += 16 * scale
        for line in lines:
            frame.text(line, rect.x + 4 * scale, y, ORANGE, SMALL, scale)
            y += 7 * scale
        high = rect.bottom - y - (BAR_HEIGHT + 4) * scale
        if high >= 2 * LINE * scale:
            self._draw_plot(frame, pygame.Rect(rect.x + 4 * scale, y + 2 * scale, rect.width - 8 * scale, high), scale)

    def _draw_plot(self, frame, rect, scale):
        """Draw the distance between the scenes over the last ten seconds, logarithmic, with the newest at the right.

        rect: rectangle of the plot; scale: frame px per text px.
        """
        surface, apart = frame.surface, self.race.apart
        surface.fill(NIGHT, rect)
        for value in (0.01, 0.1, VISIBLE, 10.0, 100.0):
            y = round(_height(value, rect))
            seen = value == VISIBLE
            pygame.draw.line(surface, FOG if seen else faded(SLATE, 0.5), (rect.left, y), (rect.right - 1, y))
            name = f"{value:g} px: seen" if seen else f"{value:g} px"
            frame.text_if_free(name, rect.right - 2 * scale, y - 7 * scale, FOG, SMALL, scale, "right")
        points = _curve(apart, rect)
        if not any(apart):
            same = "no body that both have was apart, not by the last bit"
            frame.text_if_free(same, rect.centerx, rect.bottom - 10 * scale, FOG, SMALL, scale, "center")
        if len(points) > 1:
            pygame.draw.lines(surface, frame.tone(ORANGE), False, points, scale)
        pygame.draw.rect(surface, SLATE, rect, 1)
        frame.reserve(rect)


def _curve(apart: deque[float], rect: pygame.Rect) -> list[tuple[float, float]]:
    """Return the points of the curve of distances in a plot, from the oldest (left) to the newest (right border).

    apart: distances [px], newest last; rect: rectangle of the plot.
    """
    width = rect.width / (apart.maxlen or len(apart))
    first = rect.right - width * len(apart)
    return [(first + width * number, _height(value, rect)) for number, value in enumerate(apart)]


def _height(value, rect):
    """Return the y in the plot `rect` that represents the distance `value` [px] on the logarithmic scale.

    Distances of LEAST or less are at the bottom.
    """
    share = log10(min(max(value, LEAST), MOST) / LEAST) / log10(MOST / LEAST)
    return rect.bottom - 2 - share * (rect.height - 4)
