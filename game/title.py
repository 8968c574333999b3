"""The title: two planes pass, their boxes meet, and only where pixels meet does it say HIT."""

from math import pi, sin

import pygame

from game.backdrop import Backdrop
from game.colors import FOG, GOLD, GREEN, ORANGE, PAPER, RED
from game.draw import SMALL, TEXT, shorten
from game.sprites import load_atlas

LOOP = 9.0         # [s] one pass of the planes
LOGO_Y, LINE_Y, WORD_Y, START_Y, FOOT_Y = 6, 82, 97, 234, 256


class Title:
    """Waits for any key. `outcome` becomes ("menu",) or ("quit",)."""

    shows_pointer = False

    def __init__(self, message=""):
        self.backdrop = Backdrop()
        planes = load_atlas("planes")
        self.left, self.right = planes["large_plane_a"], planes["large_plane_b"]
        self.masks = [pygame.mask.from_surface(image) for image in (self.left, self.right)]
        self.logo = load_atlas("ui")["logo"]
        self.message = message
        self.time = 0.0
        self.outcome = None

    def step(self, inputs, dt):
        """One fixed step."""
        self.time += dt
        if inputs.pressed("confirm") or inputs.pressed("fire") or inputs.pointer_pressed:
            self.outcome = ("menu",)
        elif inputs.pressed("cancel"):
            self.outcome = ("quit",)

    def draw(self, canvas, alpha):
        """Draw the picture."""
        self.backdrop.draw(canvas, self.time * 40.0)
        self._draw_planes(canvas)
        canvas.sprite(self.logo, canvas.rect.centerx, LOGO_Y + self.logo.get_height() // 2)
        canvas.text("collision you can feel, trust and see", canvas.rect.centerx, LINE_Y, PAPER, TEXT, 1, "center",
                    True)
        if self.time % 1.2 < 0.8:
            canvas.text("PRESS ENTER", canvas.rect.centerx, START_Y, GOLD, TEXT, 1, "center", True)
        foot = self.message or "Enter or click: play    Esc: leave"
        foot = shorten(foot, canvas.rect.width - 16, SMALL)
        canvas.text(foot, canvas.rect.centerx, FOOT_Y, FOG, SMALL, 1, "center", True)

    def _draw_planes(self, canvas):
        """Both planes, their boxes coloured by what pygame's own masks say."""
        phase = self.time % LOOP / LOOP
        sway = sin(phase * 2 * pi)
        a = self.left.get_rect(center=(round(178 + 40 * sway), round(170 + 4 * sin(phase * 4 * pi))))
        b = self.right.get_rect(center=(round(302 - 40 * sway), round(168 - 4 * sin(phase * 4 * pi))))
        canvas.surface.blit(self.left, a)
        canvas.surface.blit(self.right, b)
        offset = (b.x - a.x, b.y - a.y)
        hit = self.masks[0].overlap_mask(self.masks[1], offset)
        color = RED if hit.count() else ORANGE if a.colliderect(b) else GREEN
        for box in (a, b):
            pygame.draw.rect(canvas.surface, color, box, 1)
        if hit.count():
            shared = hit.to_surface(setcolor=(255, 250, 150, 255), unsetcolor=None)
            canvas.surface.blit(shared, a)
        word = {RED: "HIT", ORANGE: "boxes only", GREEN: "apart"}[color]
        canvas.text(word, canvas.rect.centerx, WORD_Y, color, TEXT, 1, "center", True)

