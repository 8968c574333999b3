"""The loading screen: a bar while kernels compile. A first start compiles; later ones read the cache."""

import pygame

from game.drawing.canvas import SMALL, TEXT, Canvas, shorten
from game.drawing.colors import FOG, GOLD, INK, PAPER, SLATE
from game.drawing.nine_slice import draw_box
from game.drawing.sprites import load_atlas
from game.run.picture import Picture
from game.screens.parts.background import DuskBackground

BAR_WIDTH, BAR_HEIGHT = 260, 8
ANYBODY = (pygame.KEYDOWN, pygame.MOUSEBUTTONDOWN, pygame.CONTROLLERBUTTONDOWN, pygame.JOYBUTTONDOWN)


class LoadingStopped(Exception):
    """The window was closed, or a person came back, while kernels were compiled."""


class Loading:
    """Drawn by hand between two kernels; there is no loop running meanwhile.

    stops_for_anybody: any key stops it, not only the closing of the window.
    """

    def __init__(self, title: str, stops_for_anybody: bool = False) -> None:
        self.title = title
        self.stops_for = (pygame.QUIT, *ANYBODY) if stops_for_anybody else (pygame.QUIT,)
        self.ground = DuskBackground()
        self.logo = load_atlas("ui")["logo"]
        self.share = 0.0
        self.what = ""

    def show(self, picture: Picture, share: float, what: str) -> None:
        """Paint the bar at `share` 0..1 and hand it to the window; keeps the window answering.

        Raises LoadingStopped; the event stays in the queue.
        """
        self.share, self.what = share, what
        picture.draw_screen(self)
        pygame.display.flip()
        pygame.event.pump()
        if pygame.event.peek(self.stops_for, pump=False):
            raise LoadingStopped

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the picture."""
        self.ground.draw(canvas, 0.0)
        middle = canvas.rect.centerx
        canvas.sprite(self.logo, middle, 72)
        box = pygame.Rect(0, 0, BAR_WIDTH + 48, 84)
        box.center = (middle, 168)
        draw_box(canvas, box)
        canvas.text(f"compiling the physics for {self.title}", middle, box.y + 14, PAPER, TEXT, 1, "center")
        bar = pygame.Rect(0, 0, BAR_WIDTH, BAR_HEIGHT)
        bar.center = (middle, box.y + 36)
        canvas.surface.fill(INK, bar)
        canvas.surface.fill(GOLD, (bar.x, bar.y, int(bar.width * self.share), bar.height))
        pygame.draw.rect(canvas.surface, SLATE, bar.inflate(4, 4), 1)
        canvas.text(shorten(self.what, BAR_WIDTH, SMALL), middle, box.y + 48, FOG, SMALL, 1, "center")
        canvas.text("only once: the next start reads them from the cache", middle, box.y + 64, FOG, SMALL, 1, "center")
