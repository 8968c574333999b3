"""Flashes of the whole picture. All flashes are in this module, so that they can be limited and switched off.

At most two flashes begin within a second, and a flash adds at most a third of white. The limit of WCAG 2.3.1 is three
general flashes per second.
"""

import pygame

from game.drawing.colors import Color

MOST = 2  # number of flashes that may begin within SPAN
SPAN = 60  # [steps] one second
BRIGHTEST = 85  # [0..255] added to each colour channel at full strength
FADE = 0.88  # factor on the light per step
FAINTEST = 0.02  # of the full light; less counts as none


class Flash:
    """Light that flashes add to the whole picture.

    light: current strength, 0..1; begun: steps in which recent flashes began.
    """

    def __init__(self) -> None:
        self.now = 0
        self.light = 0.0
        self.color = (255, 255, 255)
        self.begun = []

    def start(self, strength: float = 1.0, color: Color = (255, 255, 255)) -> bool:
        """Start a flash, and return whether it was started. strength: 0..1.

        A flash is not started if MOST flashes began within the last SPAN steps.
        """
        self.begun = [step for step in self.begun if self.now - step < SPAN]
        if len(self.begun) >= MOST:
            return False
        self.begun.append(self.now)
        self.light, self.color = min(max(self.light, strength), 1.0), color
        return True

    def step(self) -> None:
        """Reduce the strength of the light. Call this once per step."""
        self.now += 1
        self.light = self.light * FADE if self.light > FAINTEST else 0.0

    def draw(self, surface: pygame.Surface) -> None:
        """Add the light of the current flash to the whole surface."""
        if self.light > 0.0:
            part = BRIGHTEST * self.light / 255
            surface.fill([int(c * part) for c in self.color], special_flags=pygame.BLEND_RGB_ADD)
