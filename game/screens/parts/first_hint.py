"""The strip that names the keys of the overlays, shown in the player's first game."""

import pygame

from game.drawing.canvas import SMALL, TEXT
from game.drawing.colors import FOG, GOLD, INK, PAPER, SLATE
from game.drawing.presenter import Frame
from game.files.settings import Settings

PARTS = (("1 to 9", "see what the physics sees"),)  # the help line of the game names the other keys
FOOT = "any key closes"
KEYS = (pygame.K_TAB, pygame.K_RETURN, pygame.K_KP_ENTER, *range(pygame.K_0, pygame.K_9 + 1))
BUTTONS = ("y", "back")
READ = 120  # pictures after which any other key closes it, too: two seconds to read it
GAP, HEIGHT = 10, 17  # [text px] between two parts; of the strip


class HintCard:
    """Strip of text that names keys. One of these keys, Enter, or a click on the strip closes it.

    After READ pictures, any key closes the strip.
    """

    keeps_keys = False  # every key keeps its function

    def __init__(self) -> None:
        self.rect = pygame.Rect(0, 0, 0, 0)
        self.drawn = 0  # pictures

    def dismissed_by(self, event: pygame.event.Event, button: str | None) -> bool:
        """Return whether this event closes the strip. button: the pad button that the event presses, or None."""
        read = self.drawn >= READ
        if event.type == pygame.KEYDOWN:
            return read or event.key in KEYS
        if event.type == pygame.MOUSEBUTTONDOWN:
            return self.rect.collidepoint(event.pos)
        return button in BUTTONS or (read and button is not None)

    def remember(self, settings: Settings) -> None:
        """Record in the settings that the strip was shown, so that it is not shown again."""
        settings.hint_seen = True

    def draw(self, frame: Frame) -> None:
        """Draw the strip near the upper border of the picture, or near the lower one if text is in the way."""
        self.drawn += 1
        area = frame.area.clip(frame.rect)
        scale = frame.text_scale
        while scale > 1 and self._width(frame, scale) > area.width - 8 * scale:
            scale -= 1
        size = (self._width(frame, scale), HEIGHT * scale)
        x = area.centerx - size[0] // 2
        high, low = area.top + area.height // 4, area.bottom - size[1] - 2 * scale
        rows = (*range(area.top + 2 * scale, high, 4 * scale), *range(low, high, -4 * scale))
        place = frame.free_place(size, [(x, y) for y in rows])
        if place is None:
            return
        self.rect = pygame.Rect(place, size)
        frame.surface.fill(INK, self.rect)
        pygame.draw.rect(frame.surface, SLATE, self.rect, scale)
        frame.surface.fill(GOLD, (self.rect.x, self.rect.y, 2 * scale, self.rect.height))
        left, top = self.rect.x + GAP * scale, self.rect.y + 4 * scale
        for key, what in PARTS:
            left = frame.text(key, left, top, GOLD, TEXT, scale).right + 4 * scale
            left = frame.text(what, left, top, PAPER, TEXT, scale).right + GAP * scale
        if self.drawn > READ:
            frame.text(FOOT, left, top + 2 * scale, FOG, SMALL, scale)
        frame.reserve(self.rect)

    def _width(self, frame, scale):
        """Return the width [frame px] of the strip at a scale. scale: frame px per text px."""
        words = sum(frame.measure(key, TEXT, scale)[0] + frame.measure(what, TEXT, scale)[0] for key, what in PARTS)
        return words + frame.measure(FOOT, SMALL, scale)[0] + (len(PARTS) * (4 + GAP) + 2 * GAP) * scale
