"""Canvas: the surface that scenes draw on. It records every text box, so that later text can avoid them.

Positions are canvas pixels. The position of a sprite is rounded once, as floor(x + 0.5), so that a sprite and the
ground under it always move together.
"""

from collections.abc import Iterable
from math import floor
from typing import TypeVar

import numpy as np
import pygame

from game.drawing.colors import PAPER, Color, toned
from game.drawing.font import load_font

Number = TypeVar("Number", float, np.ndarray)  # one coordinate, or a column of them
Box = pygame.Rect | tuple[int, int, int, int]  # left, top, width, height

CANVAS_SIZE = (480, 270)
TEXT, SMALL = "font5x7", "font3x5"


def whole(value: float) -> int:
    """Return a coordinate rounded for drawing: floor(value + 0.5). All drawing uses this rule."""
    return floor(value + 0.5)


class Canvas:
    """Surface with text. boxes: list of (rect, text), one for each line of text in the current picture.

    reserved: rectangles that later text must also avoid. fixed: those of the reserved rectangles that show an icon, a
    bar or a plot. Overlays cover neither text nor fixed rectangles.
    """

    edge = 1  # [px] by which an outline extends over its text's box

    def __init__(self, surface: pygame.Surface | None = None) -> None:
        self.surface = surface if surface is not None else pygame.Surface(CANVAS_SIZE)
        self.boxes = []
        self.reserved = []
        self.fixed = []
        self.palette = "standard"  # name of the overlays' palette, from the player's settings

    def tone(self, color: Color) -> Color:
        """Return the colour that an overlay's `color` has in this picture's palette."""
        return toned(color, self.palette)

    @property
    def rect(self) -> pygame.Rect:
        """The whole canvas as a Rect at (0, 0)."""
        return self.surface.get_rect()

    def begin(self, color: Color | None = None) -> None:
        """Start a new picture: clear all lists of rectangles, and fill the surface with `color`, unless it is None."""
        self.boxes.clear()
        self.reserved.clear()
        self.fixed.clear()
        if color is not None:
            self.surface.fill(color)

    def sprite(self, image: pygame.Surface, x: float, y: float) -> None:
        """Draw an image centred on the canvas point (x, y)."""
        width, height = image.get_size()
        self.surface.blit(image, (whole(x) - width // 2, whole(y) - height // 2))

    def measure(self, text: str, font: str = TEXT, scale: int = 1) -> tuple[int, int]:
        """Return (width, height) of a line of text [px]. scale: enlargement of the letters, a whole number."""
        return load_font(font).measure(text, scale)

    def text_rect(
        self, text: str, x: float, y: float, font: str = TEXT, scale: int = 1, align: str = "left"
    ) -> pygame.Rect:
        """Return the rectangle that text() would use for a line of text.

        align: "left", "center" or "right": the part of the line that is at x.
        """
        width, height = load_font(font).measure(text, scale)
        left = {"left": x, "center": x - width / 2, "right": x - width}[align]
        return pygame.Rect(whole(left), whole(y), width, height)

    def text(
        self,
        text: str,
        x: float,
        y: float,
        color: Color = PAPER,
        font: str = TEXT,
        scale: int = 1,
        align: str = "left",
        outline: bool = False,
    ) -> pygame.Rect:
        """Draw one line of text with its upper edge at y, and return the line's rectangle.

        align: as in text_rect(); scale: enlargement of the letters, a whole number. outline: True draws a dark edge
        around the letters, outside the rectangle. The caller must keep the rectangle clear of other text.
        """
        rect = self.text_rect(text, x, y, font, scale, align)
        load_font(font).draw(self.surface, text, rect.x, rect.y, color, scale, outline)
        self.boxes.append((rect, text))
        return rect

    def text_if_free(
        self,
        text: str,
        x: float,
        y: float,
        color: Color = PAPER,
        font: str = TEXT,
        scale: int = 1,
        align: str = "left",
        outline: bool = False,
    ) -> bool:
        """Draw a line of text only if it is on the canvas and touches no other text. Return whether it was drawn.

        The arguments are those of text(). The method is meant for labels of moving objects. The caller counts the
        labels that were not drawn, and shows the count at a fixed position. outline: as in text().
        """
        rect = self.text_rect(text, x, y, font, scale, align)
        if not self.is_free(rect.inflate(2 * scale, 2 * scale) if outline else rect):
            return False
        load_font(font).draw(self.surface, text, rect.x, rect.y, color, scale, outline)
        self.boxes.append((rect, text))
        return True

    def is_free(self, rect: pygame.Rect) -> bool:
        """Return whether a rectangle is on the canvas and touches no text box and no reserved rectangle."""
        return self.rect.contains(rect) and rect.collidelist(self._taken()) < 0

    def _taken(self):
        return [box for box, _ in self.boxes] + self.reserved

    def reserve(self, rect: Box) -> None:
        """Reserve a rectangle (a graph, a panel, a life bar). text_if_free() and free_place() then avoid it."""
        self.reserved.append(pygame.Rect(rect))

    def fix(self, rect: Box) -> None:
        """Reserve a rectangle that overlays must not cover."""
        self.reserve(rect)
        self.fixed.append(pygame.Rect(rect))

    def lift(self) -> list[tuple[pygame.Surface, tuple[int, int]]]:
        """Return copies of all text and fixed rectangles, as a list of (picture, top left corner).

        put_back() later draws these copies over everything that was drawn after the call of lift().
        """
        rects = [box.inflate(2 * self.edge, 2 * self.edge) for box, _ in self.boxes] + self.fixed
        inside = [rect.clip(self.rect) for rect in rects]
        return [(self.surface.subsurface(rect).copy(), rect.topleft) for rect in inside if rect.width and rect.height]

    def put_back(self, lifted: list[tuple[pygame.Surface, tuple[int, int]]]) -> None:
        """Draw the copies that lift() returned over the canvas."""
        for picture, place in lifted:
            self.surface.blit(picture, place)

    def free_place(self, size: tuple[int, int], places: Iterable[tuple[float, float]]) -> tuple[int, int] | None:
        """Return the first (x, y) of `places` at which a box of `size` is free, or None if there is none."""
        inside, taken = self.rect, self._taken()
        for x, y in places:
            rect = pygame.Rect(whole(x), whole(y), *size)
            if inside.contains(rect) and rect.collidelist(taken) < 0:
                return rect.topleft
        return None


def small_font(scale: int) -> tuple[str, int]:
    """Return (font, line spacing [text px]) of the small text, which is at least 9 px high at this scale."""
    return (SMALL, 7) if scale > 1 else (TEXT, 10)


def wrap(text: str, width: int, font: str = TEXT, scale: int = 1) -> list[str]:
    """Return `text` broken into lines of at most `width` pixels. A word that is wider than `width` has its own line."""
    measure = load_font(font).measure
    lines, line = [], ""
    for word in text.split():
        longer = f"{line} {word}" if line else word
        if line and measure(longer, scale)[0] > width:
            lines.append(line)
            line = word
        else:
            line = longer
    return [*lines, line] if line else lines


def shorten(text: str, width: int, font: str = TEXT, scale: int = 1) -> str:
    """Return `text` if it fits in `width` pixels.

    Otherwise, return its longest beginning that fits, with two dots added.
    """
    measure = load_font(font).measure
    if measure(text, scale)[0] <= width:
        return text
    while text and measure(text + "..", scale)[0] > width:
        text = text[:-1]
    return text.rstrip() + ".."
