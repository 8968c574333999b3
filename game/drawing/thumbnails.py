"""The menu's small picture of each scene. If the picture is missing, the scene's title is drawn in a frame."""

from functools import cache

import pygame

from game.drawing.canvas import Canvas, wrap
from game.drawing.colors import DUSK, INK, SLATE
from game.drawing.sprites import load_image
from game.places import IMAGES

SIZE = (160, 90)


def draw_picture(canvas: Canvas, name: str, title: str, x: int, y: int) -> pygame.Rect:
    """Draw the menu picture of the scene `name` with a thin frame at (x, y), and return the frame's rectangle.

    If there is no picture, draw the scene's title instead.
    """
    rect = pygame.Rect((x, y), SIZE)
    picture = _load(name)
    if picture is not None:
        canvas.surface.blit(picture, rect)
    else:
        canvas.surface.fill(DUSK, rect)
        lines = wrap(title, SIZE[0] - 16)
        for number, line in enumerate(lines):
            canvas.text(line, rect.centerx, rect.centery - 6 * len(lines) + 12 * number + 2, align="center")
    frame = rect.inflate(4, 4)
    pygame.draw.rect(canvas.surface, INK, frame, 2)
    pygame.draw.rect(canvas.surface, SLATE, frame.inflate(2, 2), 1)
    return frame


@cache
def _load(name):
    path = IMAGES / "pictures" / f"{name.replace('/', '_')}.png"
    if not path.exists():
        return None
    picture = load_image(path)
    return picture if picture.get_size() == SIZE else pygame.transform.scale(picture, SIZE)
