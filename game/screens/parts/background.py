"""Backgrounds of menus, and the box around a menu.

A background shows the moving mountains of the title screen, or the darkened paused game.
"""

import pygame

from game.drawing.backdrop import Backdrop
from game.drawing.canvas import SMALL, TEXT, Box, Canvas
from game.drawing.colors import FOG, GOLD, SLATE
from game.drawing.nine_slice import draw_box
from game.scene import Scene

DRIFT = 20.0  # [px/s] of the backdrop
DIMMED = 72  # of 255: brightness of the paused game behind a menu
MARGIN = 8  # [canvas px] between a page and the edge of the picture


class DuskBackground:
    """Background of moving mountains."""

    def __init__(self) -> None:
        self.backdrop = Backdrop()

    def draw(self, canvas: Canvas, time: float) -> None:
        """Draw the mountains at `time` [s] after the start."""
        self.backdrop.draw(canvas, time * DRIFT, dim=24)


class SceneBackground:
    """Background that shows the paused scene, darkened.

    The scene is drawn again for each picture, so that a changed setting is visible at once.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene = scene

    def draw(self, canvas: Canvas, time: float) -> None:
        """Draw the scene, darkened. time: not used. A menu may cover the scene's text and plots."""
        self.scene.draw(canvas, 1.0)
        canvas.surface.fill((DIMMED,) * 3, special_flags=pygame.BLEND_RGB_MULT)
        canvas.boxes.clear()
        canvas.reserved.clear()


Background = DuskBackground | SceneBackground


def draw_page(canvas: Canvas, rect: Box, title: str, foot: str = "") -> pygame.Rect:
    """Draw a box with a title and a line under the title. Return the rectangle inside the box.

    foot: last line of text in the box, which names the keys; "" for none.
    """
    rect = pygame.Rect(rect)
    draw_box(canvas, rect)
    canvas.text(title, rect.x + 16, rect.y + 9, GOLD, TEXT, 2)
    canvas.surface.fill(SLATE, (rect.x + 16, rect.y + 29, rect.width - 32, 1))
    inside = pygame.Rect(rect.x + 16, rect.y + 36, rect.width - 32, rect.height - 44)
    if foot:
        inside.height -= 10
        canvas.text(foot, rect.centerx, rect.bottom - 13, FOG, SMALL, 1, "center")
    return inside
