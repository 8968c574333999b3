"""Invariants of the simulation, shown by eleven indicators, U1 to U11.

An indicator is green if its invariant holds, red if it is broken, and grey if it is not checked.
"""

from collections.abc import Iterator

import pygame

from game.drawing.canvas import SMALL, shorten
from game.drawing.colors import FOG, GREEN, INK, NIGHT, PAPER, RED, SLATE, Color, faded
from game.drawing.presenter import Frame
from game.drawing.typical import Typical
from game.invariants import monitor as states
from game.invariants.monitor import InvariantMonitor, InvariantStatus
from game.overlays.layer import Layer, LegendLine

COLORS = {states.GREEN: GREEN, states.RED: RED, states.GREY: FOG}
ROWS = (1, 2, 3, 4, 6, 11)  # possible numbers of rows of the strip, the widest strip first
LINE, LAMP, GAP, MARGIN = 8, 5, 5, 3  # [text px] of a row, a lamp, between two indicators, inside the frame
COUNTED = 999  # greatest number of breaks that is written


class Invariants(Layer):
    """Strip of indicators. Each shows an invariant's id, a word, and the number of times the invariant was broken.

    Below them is a message about the indicator under the pointer. If the pointer is elsewhere, the message is about the
    invariant that was broken last.
    """

    name, title, key, color = "invariants", "Invariants", "u", GREEN

    def __init__(self) -> None:
        self.monitor = InvariantMonitor()
        self.cost = Typical()  # [s] cost of the invariants
        self.places: list[tuple[pygame.Rect, InvariantStatus]] = []  # of the last picture

    def note(self, monitor: InvariantMonitor | None) -> None:
        """Record the time that the checks of the invariants took in the last step. Call this after every step.

        monitor: the scene's monitor; None while the invariants are not checked.
        """
        if monitor is not None:
            self.cost.note(monitor.seconds)

    def sizes(self, frame: Frame) -> Iterator[tuple[int, int]]:
        """Yield the possible sizes (width, height) [frame px] of the strip, widest first."""
        scale = frame.text_scale
        for rows in ROWS:
            columns = -(-len(self.monitor.statuses) // rows)
            yield columns * self._width(frame) + 2 * MARGIN * scale, ((rows + 1) * LINE + 2 * MARGIN) * scale

    def _width(self, frame):
        """Return the width [frame px] of one indicator, including the gap beside it.

        All indicators have the same width.
        """
        scale = frame.text_scale
        widest = max(frame.measure(label_of(status), SMALL, scale)[0] for status in self.monitor.statuses)
        return widest + (LAMP + 2 + GAP) * scale

    def draw_strip(self, frame: Frame, rect: pygame.Rect, pointer: tuple[int, int] = (-1, -1)) -> None:
        """Draw the strip into the frame rectangle `rect`, which has one of the sizes().

        pointer: mouse position [frame px].
        """
        scale = frame.text_scale
        frame.surface.fill(faded(NIGHT, 0.3), rect)
        pygame.draw.rect(frame.surface, SLATE, rect, 1)
        width = self._width(frame)
        columns = max(1, (rect.width - 2 * MARGIN * scale) // width)
        self.places = []
        for number, status in enumerate(self.monitor.statuses):
            left = rect.x + MARGIN * scale + number % columns * width
            top = rect.y + (MARGIN + number // columns * LINE) * scale
            self._draw_status(frame, status, left, top, scale)
            self.places.append((pygame.Rect(left, top, width - GAP * scale, LINE * scale), status))
        color, message = self.message_at(pointer)
        line = shorten(message, rect.width - 2 * MARGIN * scale, SMALL, scale)
        frame.text(line, rect.x + MARGIN * scale, rect.bottom - (MARGIN + LINE - 2) * scale, color, SMALL, scale)

    def _draw_status(self, frame, status, left, top, scale):
        lamp = pygame.Rect(left, top, LAMP * scale, LAMP * scale)
        color = frame.tone(COLORS[status.state])
        if status.state == states.GREY:
            pygame.draw.rect(frame.surface, color, lamp, scale)  # hollow: distinguishable without its colour
        else:
            frame.surface.fill(color, lamp)
        if status.state == states.RED:
            frame.surface.fill(INK, lamp.inflate(-3 * scale, -3 * scale))
        tone = {states.GREEN: PAPER, states.RED: color, states.GREY: FOG}[status.state]
        frame.text(label_of(status), lamp.right + 2 * scale, top, tone, SMALL, scale)

    def message_at(self, pointer: tuple[int, int]) -> tuple[Color, str]:
        """Return (colour, text) of the message below the indicators.

        The message is about the invariant whose indicator is at `pointer`. If there is no indicator, the message is
        about the invariant that was broken last. If no invariant was broken, it is a summary.
        """
        for place, status in self.places:
            if place.collidepoint(pointer):
                return COLORS[status.state], status.sentence
        broken = max(
            (status for status in self.monitor.statuses if status.last is not None),
            key=lambda status: status.last_frame,
            default=None,
        )
        if broken is not None:
            return (RED if broken.state == states.RED else FOG), broken.last_report
        return FOG, self.summary()

    def summary(self) -> str:
        """Return text with the numbers of invariants that hold, are broken and are not checked.

        The text also contains the time of the checks per frame.
        """
        count = [status.state for status in self.monitor.statuses].count
        return (
            f"{count(states.GREEN)} hold, {count(states.RED)} broken, {count(states.GREY)} not asked, "
            f"{self.cost.value * 1e6:.0f} us a frame"
        )

    def notes(self) -> list[LegendLine]:
        """Return legend lines, a list of (color, text), for the invariants that are not checked, grouped by reason."""
        reasons: dict[str, list[str]] = {}
        for status in self.monitor.statuses:
            if status.state == states.GREY:
                reasons.setdefault(status.reason, []).append(status.id)
        return [(FOG, f"{', '.join(ids)} not asked: {reason}") for reason, ids in reasons.items()]


def label_of(status: InvariantStatus) -> str:
    """Return the label of an indicator: the id, a word, and the number of times the invariant was broken.

    status: the InvariantStatus that the indicator shows.
    """
    return f"{status.id} {status.word}" + (f" {min(status.breaks, COUNTED)}" if status.breaks else "")
