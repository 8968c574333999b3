"""Invariants: eleven lights, U1 to U11, green, red or grey, and the message of the last broken one."""

from collections.abc import Iterator

import pygame

from game.drawing.canvas import SMALL, shorten
from game.drawing.colors import FOG, GREEN, INK, NIGHT, PAPER, RED, SLATE, Color, faded
from game.drawing.presenter import Frame
from game.drawing.typical import Typical
from game.invariants import lights as states
from game.invariants.lights import Light, Lights
from game.overlays.layer import Layer, LegendLine

COLORS = {states.GREEN: GREEN, states.RED: RED, states.GREY: FOG}
ROWS = (1, 2, 3, 4, 6, 11)  # row counts of the strip, the widest first
LINE, LAMP, GAP, MARGIN = 8, 5, 5, 3  # [text px] of a row, a lamp, between two lights, inside the frame
COUNTED = 999  # greatest number of breaks that is written


class Invariants(Layer):
    """Strip of lights, each with its id, its word and its number of breaks.

    Below them is the message of the light under the pointer, or of the last broken one.
    """

    name, title, key, color = "invariants", "Invariants", "u", GREEN

    def __init__(self) -> None:
        self.lights = Lights()
        self.cost = Typical()  # [s] cost of the invariants
        self.places: list[tuple[pygame.Rect, Light]] = []  # of the last picture

    def note(self, lights: Lights | None) -> None:
        """Record the cost of a step; call it every step. lights: the scene's, None while invariants are off."""
        if lights is not None:
            self.cost.note(lights.seconds)

    def sizes(self, frame: Frame) -> Iterator[tuple[int, int]]:
        """Yield the possible sizes (width, height) [frame px] of the strip, the widest first."""
        scale = frame.text_scale
        for rows in ROWS:
            columns = -(-len(self.lights.lights) // rows)
            yield columns * self._width(frame) + 2 * MARGIN * scale, ((rows + 1) * LINE + 2 * MARGIN) * scale

    def _width(self, frame):
        """Return the width [frame px] of a light with its gap, the same for all: that of the widest."""
        scale = frame.text_scale
        widest = max(frame.measure(label_of(light), SMALL, scale)[0] for light in self.lights.lights)
        return widest + (LAMP + 2 + GAP) * scale

    def draw_strip(self, frame: Frame, rect: pygame.Rect, pointer: tuple[int, int] = (-1, -1)) -> None:
        """Draw the strip into a frame rect of one of the sizes; `pointer`: position of the mouse."""
        scale = frame.text_scale
        frame.surface.fill(faded(NIGHT, 0.3), rect)
        pygame.draw.rect(frame.surface, SLATE, rect, 1)
        width = self._width(frame)
        columns = max(1, (rect.width - 2 * MARGIN * scale) // width)
        self.places = []
        for number, light in enumerate(self.lights.lights):
            left = rect.x + MARGIN * scale + number % columns * width
            top = rect.y + (MARGIN + number // columns * LINE) * scale
            self._draw_light(frame, light, left, top, scale)
            self.places.append((pygame.Rect(left, top, width - GAP * scale, LINE * scale), light))
        color, told = self.told(pointer)
        line = shorten(told, rect.width - 2 * MARGIN * scale, SMALL, scale)
        frame.text(line, rect.x + MARGIN * scale, rect.bottom - (MARGIN + LINE - 2) * scale, color, SMALL, scale)

    def _draw_light(self, frame, light, left, top, scale):
        lamp = pygame.Rect(left, top, LAMP * scale, LAMP * scale)
        color = frame.tone(COLORS[light.state])
        if light.state == states.GREY:
            pygame.draw.rect(frame.surface, color, lamp, scale)  # hollow: distinguishable without its colour
        else:
            frame.surface.fill(color, lamp)
        if light.state == states.RED:
            frame.surface.fill(INK, lamp.inflate(-3 * scale, -3 * scale))
        tone = {states.GREEN: PAPER, states.RED: color, states.GREY: FOG}[light.state]
        frame.text(label_of(light), lamp.right + 2 * scale, top, tone, SMALL, scale)

    def told(self, pointer: tuple[int, int]) -> tuple[Color, str]:
        """Return colour and text of the line below: of the light under the pointer, else the last broken one, else a
        summary.
        """
        for place, light in self.places:
            if place.collidepoint(pointer):
                return COLORS[light.state], light.sentence
        broken = max(
            (light for light in self.lights.lights if light.last is not None),
            key=lambda light: light.last_frame,
            default=None,
        )
        if broken is not None:
            return (RED if broken.state == states.RED else FOG), broken.last_told
        return FOG, self.summary()

    def summary(self) -> str:
        """Return how many invariants hold, are broken or are off, and the cost per frame."""
        count = [light.state for light in self.lights.lights].count
        return (
            f"{count(states.GREEN)} hold, {count(states.RED)} broken, {count(states.GREY)} not asked, "
            f"{self.cost.value * 1e6:.0f} us a frame"
        )

    def notes(self) -> list[LegendLine]:
        """Return legend lines for the invariants that are off, grouped by reason."""
        reasons: dict[str, list[str]] = {}
        for light in self.lights.lights:
            if light.state == states.GREY:
                reasons.setdefault(light.reason, []).append(light.id)
        return [(FOG, f"{', '.join(ids)} not asked: {reason}") for reason, ids in reasons.items()]


def label_of(light: Light) -> str:
    """Return id and word of a light, and how often it was broken."""
    return f"{light.id} {light.word}" + (f" {min(light.breaks, COUNTED)}" if light.breaks else "")
