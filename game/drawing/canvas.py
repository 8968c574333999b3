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
    """Surface with text. boxes: (rect, text) of each line of text in this picture.

    reserved: rectangles that later text must also avoid. fixed: the reserved rectangles that show an icon, a bar or a
    plot. Overlays cover neither the text nor the fixed rectangles.
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
        """Start a new picture: clear all lists, and fill the surface with `color` if it is given."""
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
        """Return the rectangle that text() would use for a line. align: "left", "center" or "right", the place of x."""
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
        """Draw one line of text with its upper edge at y, and return its rectangle.

        align: as in text_rect(); outline: whether the letters have a dark edge, which lies outside the rectangle. The
        caller must keep the rectangle clear of other text. scale: enlargement of the letters, a whole number.
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

        The arguments are those of text(). This is for labels that follow moving objects. The caller counts the labels
        that were not drawn, and shows the count in a fixed place.
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
        """Reserve a rectangle (a graph, a panel, a life bar), which text_if_free() and free_place() then avoid."""
        self.reserved.append(pygame.Rect(rect))

    def fix(self, rect: Box) -> None:
        """Reserve a rectangle that overlays must not cover."""
        self.reserve(rect)
        self.fixed.append(pygame.Rect(rect))

    def lift(self) -> list[tuple[pygame.Surface, tuple[int, int]]]:
        """Return copies of the text and of the fixed rectangles, a list of (picture, top left corner).

        put_back() draws these copies again, over everything that was drawn since the call of lift().
        """
        rects = [box.inflate(2 * self.edge, 2 * self.edge) for box, _ in self.boxes] + self.fixed
        inside = [rect.clip(self.rect) for rect in rects]
        return [(self.surface.subsurface(rect).copy(), rect.topleft) for rect in inside if rect.width and rect.height]

    def put_back(self, lifted: list[tuple[pygame.Surface, tuple[int, int]]]) -> None:
        """Draw the copies `lifted`, which lift() returned, over the canvas."""
        for picture, place in lifted:
            self.surface.blit(picture, place)

    def free_place(self, size: tuple[int, int], places: Iterable[tuple[float, float]]) -> tuple[int, int] | None:
        """Return the first (x, y) of `places` at which a box of `size` is free, or None."""
        inside, taken = self.rect, self._taken()
        for x, y in places:
            rect = pygame.Rect(whole(x), whole(y), *size)
            if inside.contains(rect) and rect.collidelist(taken) < 0:
                return rect.topleft
        return None


def small_font(scale: int) -> tuple[str, int]:
    """Return (font, distance of two lines [text px]) of small text that is at least 9 px high at this scale."""
    return (SMALL, 7) if scale > 1 else (TEXT, 10)


def wrap(text: str, width: int, font: str = TEXT, scale: int = 1) -> list[str]:
    """Return a text broken into lines of at most `width` pixels. A word that is wider has its own line."""
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
    """Return the text if it fits in `width` pixels, otherwise its longest beginning that fits, followed by two dots."""
    measure = load_font(font).measure
    if measure(text, scale)[0] <= width:
        return text
    while text and measure(text + "..", scale)[0] > width:
        text = text[:-1]
    return text.rstrip() + ".."
