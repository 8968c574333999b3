"""Two lines in the cost panel, below the finding: the advised setting, and the state of the tuner.

The tuner is the part of the program that applies advice automatically.
"""

from collections.abc import Callable

import pygame

from game.drawing.canvas import small_font, wrap
from game.drawing.colors import DUSK, FOG, GREEN, PAPER, SKY
from game.drawing.presenter import Frame
from game.measure.setting import Setting
from game.measure.survey import LEAST_HITS
from game.screens.parts.measuring import Measuring

TAKE, TUNE = pygame.K_PAGEUP, pygame.K_PAGEDOWN


class AdviceRows:
    """Two lines of the cost panel: the advised setting, and whether advice is applied automatically.

    measuring: the measurements of the played scene; apply(setting): function that applies a setting to the scene.
    """

    def __init__(self, measuring: Measuring, apply: Callable[[Setting], None]) -> None:
        self.measuring, self.tuner, self.apply = measuring, measuring.tuner, apply
        self.rects = [pygame.Rect(0, 0, 0, 0), pygame.Rect(0, 0, 0, 0)]

    def stamp(self) -> tuple:
        """Return a value that changes whenever the text of the lines changes. The panel is then repainted."""
        return self.tuner.on, len(self.tuner.decisions), self.measuring.advice

    def key(self, key: int) -> bool:
        """Process a key: Page Up applies the advice, and Page Down switches the tuner on or off.

        Return whether the key was one of these.
        """
        if key == TAKE:
            self.take()
        elif key == TUNE:
            self.tuner.on = not self.tuner.on
        return key in (TAKE, TUNE)

    def click(self, position: tuple[int, int]) -> bool:
        """Process a click at a window position. A click on a line has the function of its key.

        Return whether a line was clicked.
        """
        for rect, key in zip(self.rects, (TAKE, TUNE), strict=True):
            if rect.collidepoint(position):
                return self.key(key)
        return False

    def take(self) -> None:
        """Apply the advised setting, if there is one and its test on the recorded run succeeded."""
        advice = self.measuring.advice
        if advice is not None and isinstance(advice[1], float):
            self.apply(advice[0])

    def draw(self, frame: Frame, left: int, y: int, width: int, scale: int) -> int:
        """Draw both lines with their top left corner at (left, y) and the given width [frame px].

        Return the y below them. scale: frame px per text px.
        """
        texts = ((self._advice(), GREEN), (self._tuning(), SKY if self.tuner.on else FOG))
        font, line = small_font(scale)
        for row, (text, color) in enumerate(texts):
            lines = wrap(text, width - 4 * scale, font, scale)
            self.rects[row] = rect = pygame.Rect(left, y, width, (line * len(lines) + 1) * scale)
            frame.surface.fill(DUSK, rect)
            ink = color if row or "PgUp" in text else PAPER
            for number, words in enumerate(lines):
                frame.text(words, left + 2 * scale, y + (1 + line * number) * scale, ink, font, scale)
            y = rect.bottom + scale
        return y + scale

    def _advice(self):
        survey, here, advice = self.tuner.survey, self.measuring.now(), self.measuring.advice
        if advice is None:
            known = here in survey.dots and survey.dots[here].cost is not None
            if not known:
                return "advice: measuring"
            if not survey.can_judge_tiers():
                return f"advice: {survey.hits_seen()} of {LEAST_HITS} hits seen"
            return "leave it: nothing is surely cheaper"
        best, proof = advice
        if proof is None:
            return f"trying it on the run so far: {best.label(here)}"
        if isinstance(proof, str):
            return f"leave it; {best.label(here)}: {proof}"
        return f"PgUp: {best.label(here)}, {proof:.2f} x the time over the run"

    def _tuning(self):
        if not self.tuner.on:
            return "PgDn: let it tune itself"
        done = [each for each in self.tuner.decisions if not each.refused]
        if not done:
            return "PgDn: tunes itself, nothing changed yet"
        last = done[-1]
        return f"PgDn: tunes itself, {len(done)} changes, the last: {last.after.label(last.before)}, {last.share:.2f} x"
