"""Backdrop of dusk, mountains and drifting clouds, used by the title, the menu and scenes."""

from collections.abc import Sequence

import pygame

from game.drawing.canvas import CANVAS_SIZE, Canvas, whole
from game.drawing.sprites import load_backdrop

# (picture, parallax factor of the camera's motion, distance of its bottom below the canvas)
DUSK = (("clouds", 0.06, None), ("mountains_far", 0.1, 0), ("mountains_mid", 0.2, 0), ("mountains_near", 0.45, 0))
CLOUD_TOP = 18


class Backdrop:
    """A sky with parallax layers that repeat horizontally."""

    def __init__(self, layers: Sequence[tuple[str, float, int | None]] = DUSK, sky: str = "sky_dusk") -> None:
        self.sky = load_backdrop(sky)
        self.layers = [(load_backdrop(name), share, low) for name, share, low in layers]

    def draw(self, canvas: Canvas, distance: float, dim: int = 0) -> None:
        """Draw the backdrop for a camera that has moved `distance` px to the right.

        dim: amount 0..255 that is subtracted from each colour channel, so that text is readable.
        """
        canvas.surface.blit(self.sky, (0, 0))
        for picture, share, low in self.layers:
            y = CLOUD_TOP if low is None else CANVAS_SIZE[1] - picture.get_height() + low
            width = picture.get_width()
            x = -whole(distance * share) % width - width
            while x < CANVAS_SIZE[0]:
                canvas.surface.blit(picture, (x, y))
                x += width
        if dim:
            canvas.surface.fill((dim, dim, dim), special_flags=pygame.BLEND_RGB_SUB)
