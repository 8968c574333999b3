"""Transition between screens: the old picture leaves in strips, or fades if flashing is reduced."""

import pygame

SECONDS = 0.3
STRIPS = 12
SPREAD = 0.5  # of the time: delay of the last strip after the first


class Wipe:
    """The last picture of the previous screen, while a part of it is visible."""

    def __init__(self) -> None:
        self.old = None
        self.started = 0.0

    def begin(self, surface: pygame.Surface, now: float) -> None:
        """Store the surface, for a transition from now [s] on."""
        self.old = surface.copy()
        self.started = now

    def draw(self, surface: pygame.Surface, now: float, fades: bool = False) -> None:
        """Draw the rest of the old picture over the new one."""
        if self.old is None:
            return
        share = (now - self.started) / SECONDS
        if share >= 1.0 or self.old.get_size() != surface.get_size():
            self.old = None
        elif fades:
            self.old.set_alpha(round(255 * (1.0 - share)))
            surface.blit(self.old, (0, 0))
        else:
            self._draw_strips(surface, share)

    def _draw_strips(self, surface, share):
        """Draw the strips, which narrow towards their left edges, the left ones first."""
        width, height = surface.get_size()
        for number in range(STRIPS):
            late = SPREAD * number / (STRIPS - 1)
            gone = max(0.0, min(1.0, (share - late) / (1.0 - SPREAD)))
            gone = gone * gone * (3.0 - 2.0 * gone)
            left, right = width * number // STRIPS, width * (number + 1) // STRIPS
            place = pygame.Rect(left + round((right - left) * gone), 0, 0, height)
            place.width = right - place.x
            surface.blit(self.old, place, place)
