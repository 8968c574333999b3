"""Flashes of the whole picture: one place that makes them, so that they can be limited and left out.

At most two begin within a second, and none adds more than a third of white: half of what WCAG 2.3.1 allows (three
general flashes a second).
"""

import pygame

from game.drawing.colors import Color

MOST = 2  # flashes that may begin within SPAN
SPAN = 60  # [steps] one second
BRIGHTEST = 85  # [0..255] added at full strength
FADE = 0.88  # of the light that is left a step later
FAINTEST = 0.02  # of the full light; less is none


class Flash:
    """`light` 0..1 now; `begun` holds the steps at which the last ones began."""

    def __init__(self) -> None:
        self.now = 0
        self.light = 0.0
        self.color = (255, 255, 255)
        self.begun = []

    def start(self, strength: float = 1.0, color: Color = (255, 255, 255)) -> bool:
        """Light up the picture, unless it just did so too often. Returns True if it does."""
        self.begun = [step for step in self.begun if self.now - step < SPAN]
        if len(self.begun) >= MOST:
            return False
        self.begun.append(self.now)
        self.light, self.color = min(max(self.light, strength), 1.0), color
        return True

    def step(self) -> None:
        """It fades. Once per step."""
        self.now += 1
        self.light = self.light * FADE if self.light > FAINTEST else 0.0

    def draw(self, surface: pygame.Surface) -> None:
        """Add the light to a picture."""
        if self.light > 0.0:
            part = BRIGHTEST * self.light / 255
            surface.fill([int(c * part) for c in self.color], special_flags=pygame.BLEND_RGB_ADD)
