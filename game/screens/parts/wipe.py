"""Transition between two screens: the old picture disappears in strips. If flashing is reduced, it fades instead."""

import pygame

SECONDS = 0.3
STRIPS = 12
SPREAD = 0.5  # delay of the last strip after the first, as a share of SECONDS


class Wipe:
    """Transition from the last picture of the previous screen to the current picture."""

    def __init__(self) -> None:
        self.old = None
        self.started = 0.0

    def begin(self, surface: pygame.Surface, now: float) -> None:
        """Store a copy of the surface, and start the transition at `now` [s]."""
        self.old = surface.copy()
        self.started = now

    def draw(self, surface: pygame.Surface, now: float, fades: bool = False) -> None:
        """Draw the remaining part of the old picture over the new one, at `now` [s].

        fades: True fades the old picture, False removes it in strips.
        """
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
        """Draw the strips of the old picture. share: elapsed part of the transition, 0..1.

        Each strip becomes narrower from the left. Strips further to the left start earlier.
        """
        width, height = surface.get_size()
        for number in range(STRIPS):
            late = SPREAD * number / (STRIPS - 1)
            gone = max(0.0, min(1.0, (share - late) / (1.0 - SPREAD)))
            gone = gone * gone * (3.0 - 2.0 * gone)
            left, right = width * number // STRIPS, width * (number + 1) // STRIPS
            place = pygame.Rect(left + round((right - left) * gone), 0, 0, height)
            place.width = right - place.x
            surface.blit(self.old, place, place)
