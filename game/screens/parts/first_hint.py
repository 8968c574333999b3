"""The card shown in the player's first game, which names the keys of the overlays."""

import pygame

from game.drawing.canvas import SMALL, TEXT
from game.drawing.colors import FOG, GOLD, INK, PAPER, SLATE
from game.drawing.presenter import Frame
from game.files.settings import Settings

LINES = (("Tab or Y", "the panel"), ("1 to 9", "see what the physics sees"), ("Esc", "menu: a one-minute tour"))
FOOT = "Enter or a click puts this away"
KEYS = (pygame.K_TAB, pygame.K_RETURN, pygame.K_KP_ENTER, *range(pygame.K_0, pygame.K_9 + 1))
BUTTONS = ("y", "back")
SIZE = (224, 74)  # [text px]


class HintCard:
    """Card that closes after one of the keys named on it, after Enter, or after a click on it."""

    keeps_keys = False  # the keys on the card keep their function

    def __init__(self) -> None:
        self.rect = pygame.Rect(0, 0, 0, 0)

    def dismissed_by(self, event: pygame.event.Event, button: str | None) -> bool:
        """Return whether this event closes the card. button: the pad button that the event presses, or None."""
        if event.type == pygame.KEYDOWN:
            return event.key in KEYS
        if event.type == pygame.MOUSEBUTTONDOWN:
            return self.rect.collidepoint(event.pos)
        return button in BUTTONS

    def remember(self, settings: Settings) -> None:
        """Record in the settings that the card was shown, so that it does not appear again."""
        settings.hint_seen = True

    def draw(self, frame: Frame) -> None:
        """Draw the card at a free place of the picture, at window resolution."""
        scale = frame.text_scale
        area = frame.area.clip(frame.rect)
        size = (SIZE[0] * scale, SIZE[1] * scale)
        x = area.right - size[0] - 8 * scale
        places = [(x, y) for y in range(area.top + 24 * scale, area.bottom - size[1], 8 * scale)]
        place = frame.free_place(size, places)
        if place is None:
            return
        self.rect = pygame.Rect(place, size)
        frame.surface.fill(INK, self.rect)
        pygame.draw.rect(frame.surface, SLATE, self.rect, scale)
        frame.surface.fill(GOLD, (self.rect.x, self.rect.y, 2 * scale, self.rect.height))
        left, top = self.rect.x + 10 * scale, self.rect.y + 8 * scale
        for number, (key, what) in enumerate(LINES):
            y = top + number * 15 * scale
            frame.text(key, left, y, GOLD, TEXT, scale)
            frame.text(what, left + 56 * scale, y, PAPER, TEXT, scale)
        frame.text(FOOT, left, top + 51 * scale, FOG, SMALL, scale)
        frame.reserve(self.rect)
