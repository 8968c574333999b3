"""The headline of a lab (a scene for an experiment), in the title line.

A headline consists of a sentence about a fault that the lab shows, and a large number that measures the fault.
"""

from typing import NamedTuple

import pygame

from game.drawing.canvas import CANVAS_SIZE, SMALL, TEXT, Canvas, wrap
from game.drawing.colors import FOG, GOLD, GREEN, INK, PAPER, RED, SKY

ROW = 7  # [canvas px] from one line of small text to the next
GAP = 6  # [canvas px] between title, sentence, number and unit
LARGE = 2  # scale of the number
ENOUGH = 10  # least number of counted cases for which a share is shown
ROWS = 2  # lines of small text that the title line holds


class Headline(NamedTuple):
    """One sentence and one live number in the title line of a lab (a scene for an experiment).

    sentence: at most 14 words; mend: the key that changes the number, and its effect; number: the number as text,
    measured in this run; unit: unit of the number, in words.

    The number is shown once `needed` data are collected; `seen` are collected so far. of: name of these data, such as
    "hits". good: True if the fault that the lab shows does not occur now.
    """

    sentence: str
    mend: str
    number: str
    unit: str
    seen: int
    needed: int
    of: str
    good: bool = False

    def asks(self, question: str) -> "Headline":
        """Return this headline. Its sentence is replaced by `question`, unless the number is known and shows the fault.

        So the sentence states the fault only beside a number that shows it.
        """
        return self if self.known and not self.good else self._replace(sentence=question)

    @property
    def known(self) -> bool:
        """Whether there are enough data to show the number."""
        return self.seen >= self.needed

    @property
    def waiting(self) -> str:
        """The text that replaces the number while there are too few data."""
        return f"measuring, {self.seen} of {self.needed} {self.of}"


def draw_headline(canvas: Canvas, title: str, headline: Headline, height: int) -> None:
    """Draw the title line of a lab over the top `height` canvas px: title, sentence, key, number and unit.

    The whole line is reserved with Canvas.fix(), so that overlays and other text do not cover it.
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
    """Draw the number and its unit at the right of the title line. Return the x of their left end.

    If there are too few data, draw their count instead. band: rectangle of the title line [canvas px].
    """
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
    """Return a text in at most two lines of small letters. The break is chosen so that the longer line is shortest."""
    words = text.split()
    ways = [[" ".join(words[:at]), " ".join(words[at:])] for at in range(1, len(words))] or [[text]]
    return min(ways, key=lambda lines: max(canvas.measure(line, SMALL)[0] for line in lines))
