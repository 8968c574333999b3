"""Bitmap text: measuring and drawing with a sheet of glyphs.

Glyphs are tinted and scaled once per (color, scale, outline). The pictures of recently drawn lines are cached, so that
a panel of names and changing numbers costs one blit per line.
"""

import json
from functools import cache, lru_cache

import pygame

from game.drawing.blit import blit_many
from game.drawing.colors import INK, Color
from game.errors import FileError
from game.places import CURE, FONTS

MEASURED = 4096  # lines of text whose size is cached
KEPT = 1024  # lines of text whose picture is cached
UNKNOWN = "?"  # drawn for a character that the sheet lacks


class Font:
    """A bitmap font that measures and draws lines of text. height: height of a line [font px]."""

    def __init__(self, sheet: pygame.Surface, height: int, glyphs: dict[str, dict[str, int]]) -> None:
        self.height = height
        self.advance = {c: g["w"] for c, g in glyphs.items()}
        self.places = {c: (g["x"], g["y"], g["w"]) for c, g in glyphs.items()}
        self.sheet = sheet
        self.tinted = {}
        self.line = lru_cache(maxsize=KEPT)(self._line)  # names, and figures that recur
        self.measure = lru_cache(maxsize=MEASURED)(self._measure)  # labels measure the same text in every picture

    def _measure(self, text, scale=1):
        """Return (width, height) of one line of text [px], without the gap after the last letter."""
        unknown = self.advance[UNKNOWN]
        width = sum(self.advance.get(c, unknown) for c in text)
        return (max(width - 1, 0) * scale, self.height * scale)

    def draw(
        self, surface: pygame.Surface, text: str, x: int, y: int, color: Color, scale: int = 1, outline: bool = False
    ) -> None:
        """Draw one line of text with its top left corner at (x, y), whole pixels.

        outline: True adds a dark edge to the letters.
        """
        edge = scale if outline else 0
        surface.blit(self.line(text, tuple(color), scale, outline), (x - edge, y - edge))

    def _line(self, text, color, scale, outline):
        """Return a picture of one line of text. outline: True adds a dark edge around the letters."""
        glyphs = self._glyphs(color, scale, outline)
        width, height = self.measure(text, scale)
        edge = 2 * scale if outline else 0
        picture = pygame.Surface((width + edge, height + edge), pygame.SRCALPHA)
        x, pairs = 0, []
        for letter in text:
            image, advance = glyphs.get(letter) or glyphs[UNKNOWN]
            if image is not None:
                pairs.append((image, (x, 0)))
            x += advance
        blit_many(picture, pairs)
        return picture

    def _glyphs(self, color, scale, outline):
        key = (color, scale, outline)
        if key not in self.tinted:
            self.tinted[key] = {c: self._glyph(c, color, scale, outline) for c in self.places}
        return self.tinted[key]

    def _glyph(self, letter, color, scale, outline):
        x, y, width = self.places[letter]
        if letter == " ":
            return None, width * scale
        pixels = self.sheet.subsurface((x, y, width, self.height))
        face = tint(pixels, color)
        if outline:
            image = pygame.Surface((width + 2, self.height + 2), pygame.SRCALPHA)
            edge = tint(pixels, INK)
            for dx in (0, 1, 2):
                for dy in (0, 1, 2):
                    image.blit(edge, (dx, dy))
            image.blit(face, (1, 1))
        else:
            image = face
        size = (image.get_width() * scale, image.get_height() * scale)
        return pygame.transform.scale(image, size), width * scale


def tint(image: pygame.Surface, color: Color) -> pygame.Surface:
    """Return a copy of a white image in the colour `color`, with unchanged alpha."""
    copy = image.copy()
    copy.fill((*color[:3], 255), special_flags=pygame.BLEND_RGBA_MULT)
    return copy


@cache
def load_font(name: str) -> Font:
    """Return the font in the files assets/font/<name>.png and .json.

    Raises FileError if a file is damaged or missing.
    """
    path = FONTS / f"{name}.json"
    try:
        table = json.loads(path.read_text(encoding="utf-8"))
        sheet = pygame.image.load(str(FONTS / f"{name}.png"))
        plain = pygame.Surface(sheet.get_size(), pygame.SRCALPHA)
        plain.blit(sheet, (0, 0))
        return Font(plain, table["height"], table["glyphs"])
    except (OSError, pygame.error, ValueError, KeyError) as error:
        raise FileError(path, "font", f"{error}; {CURE}") from error
