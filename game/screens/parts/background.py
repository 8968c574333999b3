"""What lies behind a menu: the dusk of the title, or the game that waits, darkened. And the box that menus stand in."""

import pygame

from game.drawing.backdrop import Backdrop
from game.drawing.canvas import SMALL, TEXT, Box, Canvas
from game.drawing.colors import FOG, GOLD, SLATE
from game.drawing.nine_slice import draw_box
from game.scene import Scene

DRIFT = 20.0  # [px/s] of the backdrop
DIMMED = 72  # of 255 that is left of a waiting game's light
MARGIN = 8  # [canvas px] between a page and the edge of the picture


class DuskBackground:
    """Mountains that drift."""

    def __init__(self) -> None:
        self.backdrop = Backdrop()

    def draw(self, canvas: Canvas, time: float) -> None:
        """Draw it, `time` [s] after the start."""
        self.backdrop.draw(canvas, time * DRIFT, dim=24)


class SceneBackground:
    """The scene as it stands, darkened; drawn anew each time, so that a changed setting is seen at once."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene

    def draw(self, canvas: Canvas, time: float) -> None:
        """Draw it. Its text is only scenery now: menus may cover it, and keep away from it."""
        self.scene.draw(canvas, 1.0)
        canvas.surface.fill((DIMMED,) * 3, special_flags=pygame.BLEND_RGB_MULT)
        canvas.boxes.clear()
        canvas.reserved.clear()


Background = DuskBackground | SceneBackground


def draw_page(canvas: Canvas, rect: Box, title: str, foot: str = "") -> pygame.Rect:
    """A box with a title and a line under it; `foot`: what the keys do, in the box's last line. Returns the inside."""
    rect = pygame.Rect(rect)
    draw_box(canvas, rect)
    canvas.text(title, rect.x + 16, rect.y + 9, GOLD, TEXT, 2)
    canvas.surface.fill(SLATE, (rect.x + 16, rect.y + 29, rect.width - 32, 1))
    inside = pygame.Rect(rect.x + 16, rect.y + 36, rect.width - 32, rect.height - 44)
    if foot:
        inside.height -= 10
        canvas.text(foot, rect.centerx, rect.bottom - 13, FOG, SMALL, 1, "center")
    return inside
