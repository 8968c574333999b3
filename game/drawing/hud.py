"""Score, lives, bars and banners on the canvas. Each function returns the rectangle in which it has drawn."""

from collections.abc import Sequence

import pygame

from game.drawing.canvas import TEXT, Box, Canvas
from game.drawing.colors import GOLD, INK, PAPER, SLATE, Color

MARGIN = 6  # [canvas px] between the HUD and the edge of the picture
BANNER_GROUND = (20, 16, 32, 150)


def label(
    canvas: Canvas, text: str, x: float, y: float, value: str = "", align: str = "left", color: Color = PAPER
) -> pygame.Rect:
    """Draw `text` in gold, and `value` beside it in `color`. Return the rectangle around both texts.

    align: as in Canvas.text_rect().
    """
    if align == "right":
        right = canvas.text(value, x, y, color, TEXT, align="right", outline=True)
        left = canvas.text(text, right.left - 4, y, GOLD, TEXT, align="right", outline=True)
    else:
        left = canvas.text(text, x, y, GOLD, TEXT, outline=True)
        right = canvas.text(value, left.right + 4, y, color, TEXT, outline=True)
    return left.union(right)


def icons(
    canvas: Canvas, image: pygame.Surface, count: int, x: int, y: int, gap: int = 2, most: int = 8
) -> pygame.Rect:
    """Draw a row of `count` copies of an image, for example one per life, and return the rectangle of the row.

    If `count` exceeds `most`, only `most` copies are drawn, with the count as text beside them. gap: distance between
    two copies [px].
    """
    width, height = image.get_size()
    shown = min(count, most)
    for number in range(shown):
        canvas.surface.blit(image, (x + number * (width + gap), y))
    rect = pygame.Rect(x, y, max(shown * (width + gap) - gap, 0), height)
    canvas.fix(rect)
    if count > most:
        text = canvas.text(f"x{count}", rect.right + 3, y + height // 2 - 4, PAPER, TEXT, outline=True)
        return rect.union(text)
    return rect


def bar(canvas: Canvas, rect: Box, share: float, color: Color, ground: Color = INK) -> pygame.Rect:
    """Draw a bar in the colour `ground`, and fill its `share` (0..1) with `color`. Return the bar's rectangle."""
    rect = pygame.Rect(rect)
    canvas.surface.fill(ground, rect)
    canvas.surface.fill(
        color, (rect.x + 1, rect.y + 1, round((rect.width - 2) * max(0.0, min(1.0, share))), rect.height - 2)
    )
    pygame.draw.rect(canvas.surface, SLATE, rect, 1)
    canvas.fix(rect)
    return rect


def banner(
    canvas: Canvas,
    title: str,
    lines: Sequence[str] = (),
    color: Color = GOLD,
    y: int | None = None,
    field: pygame.Rect | None = None,
) -> pygame.Rect:
    """Draw a large title over a dark band in the middle of the picture, with small lines under the title.

    Return the rectangle of the text. field: the part of the picture that shows the game; None for the whole picture. y:
    upper edge of the text; None centres the text vertically.
    """
    field = canvas.rect if field is None else field
    width, height = canvas.measure(title, TEXT, 3)
    total = height + 6 + 13 * len(lines)
    top = field.top + (field.height - total) // 2 if y is None else y
    shade = pygame.Surface((field.width, total + 20), pygame.SRCALPHA)
    shade.fill(BANNER_GROUND)
    canvas.surface.blit(shade, (field.left, top - 10))
    rect = canvas.text(title, field.centerx, top, color, TEXT, 3, "center", True)
    for number, line in enumerate(lines):
        text = canvas.text(line, field.centerx, top + height + 8 + 13 * number, PAPER, TEXT, 1, "center", True)
        rect = rect.union(text)
    return rect
