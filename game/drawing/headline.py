"""The headline of a lab: one sentence on what goes wrong, and one large number that shows it, in the title line."""

from typing import NamedTuple

import pygame

from game.drawing.canvas import CANVAS_SIZE, SMALL, TEXT, Canvas, wrap
from game.drawing.colors import FOG, GOLD, GREEN, INK, PAPER, RED, SKY

ROW = 7  # [canvas px] from one line of small text to the next
GAP = 6  # [canvas px] between title, sentence, number and unit
LARGE = 2  # scale of the number
ENOUGH = 10  # counted cases from which on a share of them is shown: one case is a tenth
ROWS = 2  # lines of small text that the title line holds


class Headline(NamedTuple):
    """One sentence and one live number of a lab.

    sentence: at most 14 words; mend: the key that changes the number, and its effect; number: measured in this run,
    as text; unit: unit of the number, in words; seen: count of the data so far; needed: count from which on the number
    is shown; of: name of the data; good: whether nothing goes wrong now.
    """

    sentence: str
    mend: str
    number: str
    unit: str
    seen: int
    needed: int
    of: str
    good: bool = False

    @property
    def known(self) -> bool:
        """Return whether there are enough data for the number."""
        return self.seen >= self.needed

    @property
    def waiting(self) -> str:
        """Return the text that replaces the number while there are too few data."""
        return f"measuring, {self.seen} of {self.needed} {self.of}"


def draw_headline(canvas: Canvas, title: str, headline: Headline, height: int) -> None:
    """Draw the title line of a lab over the top `height` canvas pixels: title, sentence, key, number and unit.

    Overlays do not cover it, and the line of keys leaves the number free: both rectangles are reserved with fix().
    """
    band = pygame.Rect(0, 0, CANVAS_SIZE[0], height)
    canvas.boxes[:] = [each for each in canvas.boxes if not band.colliderect(each[0])]  # hidden by the line
    canvas.surface.fill(INK, band)
    canvas.fix(band)
    left = canvas.text(title.upper(), 4, 4, GOLD).right + GAP
    right = _draw_number(canvas, headline, band)
    lines = wrap(headline.sentence, right - GAP - left, SMALL)
    end = left
    for row, line in enumerate(lines):
        end = canvas.text(line, left, 2 + ROW * row, PAPER, SMALL).right
    if len(lines) < ROWS:
        canvas.text(headline.mend, left, 2 + ROW, SKY, SMALL)
    else:
        canvas.text(headline.mend, end + GAP, 2 + ROW * (len(lines) - 1), SKY, SMALL)


def _draw_number(canvas, headline, band):
    """Draw the number, or what is missing for it, and its unit at the right. Return the x at which they begin."""
    if not headline.known:
        rect = canvas.text(headline.waiting, band.right - 4, 2, FOG, SMALL, align="right")
        canvas.fix(pygame.Rect(rect.x, 0, band.right - rect.x, band.height))
        return rect.x
    words = two_lines(canvas, headline.unit)
    unit = band.right - 4 - max(canvas.measure(line, SMALL)[0] for line in words)
    for row, line in enumerate(words):
        canvas.text(line, unit, 2 + ROW * row, FOG, SMALL)
    color = GREEN if headline.good else RED
    canvas.surface.set_clip(band)  # digits have no descenders: the rows below the baseline are empty
    number = canvas.text(headline.number, unit - GAP, 1, color, TEXT, LARGE, align="right").clip(band)
    canvas.surface.set_clip(None)
    canvas.boxes[-1] = (number, headline.number)
    canvas.fix(pygame.Rect(number.x, 0, band.right - number.x, band.height))
    return number.x


def two_lines(canvas: Canvas, text: str) -> list[str]:
    """Return a text in at most two lines of small letters, broken where the longer line is shortest."""
    words = text.split()
    ways = [[" ".join(words[:at]), " ".join(words[at:])] for at in range(1, len(words))] or [[text]]
    return min(ways, key=lambda lines: max(canvas.measure(line, SMALL)[0] for line in lines))
