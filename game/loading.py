"""The loading screen: a bar while kernels compile. A first start compiles; later ones read the cache."""

import pygame

from game.colors import DUSK, FOG, GOLD, INK, NIGHT, PAPER
from game.draw import SMALL, TEXT

BAR_WIDTH, BAR_HEIGHT = 260, 8


class Loading:
    """Drawn by hand between two kernels; there is no loop running meanwhile."""

    def __init__(self, title):
        self.title = title
        self.share = 0.0
        self.what = ""

    def show(self, picture, share, what):
        """Paint the bar at `share` 0..1 and hand it to the window; keeps the window answering."""
        self.share, self.what = share, what
        picture.draw_screen(self)
        pygame.display.flip()
        pygame.event.pump()

    def draw(self, canvas, alpha):
        """Draw the picture."""
        canvas.surface.fill(NIGHT)
        middle = canvas.rect.centerx
        canvas.text("HITBOX", middle, 92, PAPER, TEXT, 3, "center")
        canvas.text(f"compiling the physics for {self.title}", middle, 132, FOG, TEXT, 1, "center")
        bar = pygame.Rect(0, 0, BAR_WIDTH, BAR_HEIGHT)
        bar.center = (middle, 156)
        canvas.surface.fill(INK, bar)
        canvas.surface.fill(GOLD, (bar.x, bar.y, int(bar.width * self.share), bar.height))
        pygame.draw.rect(canvas.surface, DUSK, bar.inflate(4, 4), 1)
        canvas.text(self.what[:60], middle, 170, FOG, SMALL, 1, "center")
        canvas.text("only once: the next start reads them from the cache", middle, 190, FOG, SMALL, 1, "center")
