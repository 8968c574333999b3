"""Framed boxes from the sprite sheet "ui".

A box consists of nine slices. The slices between the corners are stretched.
"""

from functools import lru_cache

import pygame

from game.drawing.canvas import Box, Canvas
from game.drawing.sprites import load_atlas

EDGE = 8  # [px] side of a slice that keeps its size


def draw_box(canvas: Canvas, rect: Box, name: str = "panel_dark") -> None:
    """Draw a framed box. name: "panel", "panel_selected" or "panel_dark"."""
    canvas.surface.blit(_box(name, rect[2], rect[3]), (rect[0], rect[1]))


@lru_cache(maxsize=64)
def _box(name, width, height):
    source = load_atlas("ui")[name]
    side = source.get_width()
    picture = pygame.Surface((width, height), pygame.SRCALPHA)
    for index_y in range(3):
        for index_x in range(3):
            from_x, wide = _place(index_x, side)
            from_y, tall = _place(index_y, side)
            x, out_wide = _place(index_x, width)
            y, out_tall = _place(index_y, height)
            part = source.subsurface((from_x, from_y, wide, tall))
            picture.blit(pygame.transform.scale(part, (out_wide, out_tall)), (x, y))
    return picture


def _place(index, length):
    """Return (start, length) [px] of a slice along one dimension of the box. index: 0 first, 1 middle, 2 last slice.

    length: size of the box in this dimension [px].
    """
    return ((0, EDGE), (EDGE, max(length - 2 * EDGE, 0)), (length - EDGE, EDGE))[index]
