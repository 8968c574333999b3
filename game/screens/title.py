"""The title: two planes pass each other. HIT appears only when their pixels overlap, not when only their boxes do.

After IDLE seconds without input, the demonstration starts.
"""

from math import pi, sin

import pygame

from game.drawing.backdrop import Backdrop
from game.drawing.canvas import SMALL, TEXT, Canvas, shorten
from game.drawing.colors import FOG, GREEN, ORANGE, PAPER, RED
from game.drawing.nine_slice import draw_box
from game.drawing.sprites import load_atlas
from game.input.inputs import InputState
from game.screens.parts.rows import LINE, Row, RowList
from game.screens.screen import CanvasScreen

LOOP = 9.0  # [s] one pass of the planes
IDLE = 10.0  # [s] without input before the demonstration
LOGO_Y, LINE_Y, WORD_Y, FOOT_Y = 6, 82, 104, 256
MENU = pygame.Rect(24, 112, 136, 8 * LINE)
ENTRIES = (
    ("Play", ("menu",)),
    ("What accuracy costs", ("costs",)),
    ("Only what is needed", ("effects",)),
    ("Replays", ("replays",)),
    ("High scores", ("scores",)),
    ("Tour of the overlays", ("tour",)),
    ("Settings", ("settings",)),
    ("Leave", ("quit",)),
)


class Title(CanvasScreen):
    """The first screen of the program, with the logo and the main menu.

    `outcome`, the request for the next screen, becomes that of the chosen entry in ENTRIES. After IDLE seconds, it
    becomes ("attract",).
    """

    tune = "title"

    def __init__(self, message: str = "") -> None:
        super().__init__()
        self.backdrop = Backdrop()
        planes = load_atlas("planes")
        self.left, self.right = planes["large_plane_a"], planes["large_plane_b"]
        self.masks = [pygame.mask.from_surface(image) for image in (self.left, self.right)]
        self.logo = load_atlas("ui")["logo"]
        self.message = message
        self.list = RowList(self._rows, MENU, self.cues)
        self.time = self.idle = 0.0

    def _rows(self):
        return [Row(label, press=lambda outcome=outcome: self._leave(outcome)) for label, outcome in ENTRIES]

    def _leave(self, outcome):
        self.outcome = outcome

    def resume(self) -> None:
        """Restart the idle time when the screen is shown again."""
        self.idle = 0.0

    def step(self, inputs: InputState, dt: float) -> None:
        """Process the player's input of a step of `dt` [s], and advance the animation and the idle time."""
        self.time += dt
        busy = (
            inputs.now.actions or inputs.now.pointer_down or inputs.now.wheel or inputs.pointer != inputs.before.pointer
        )
        self.idle = 0.0 if busy else self.idle + dt
        if inputs.pressed("cancel"):
            self.cues.append("back")
            if self.list.mark == len(ENTRIES) - 1:  # Esc marks Leave, and a second one leaves
                self.outcome = ("quit",)
            self.list.mark = len(ENTRIES) - 1
        self.list.step(inputs, dt)
        if self.idle >= IDLE:
            self.outcome = ("attract",)

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the planes, the logo and the menu."""
        self.backdrop.draw(canvas, self.time * 40.0)
        self._draw_planes(canvas)
        canvas.sprite(self.logo, canvas.rect.centerx, LOGO_Y + self.logo.get_height() // 2)
        canvas.text(
            "collision you can feel, trust and see", canvas.rect.centerx, LINE_Y, PAPER, TEXT, 1, "center", True
        )
        draw_box(canvas, MENU.inflate(16, 16))
        self.list.draw(canvas)
        foot = self.message or "\u2191 \u2193 choose   Enter goes   or the mouse, or a controller"
        foot = shorten(foot, canvas.rect.width - 16, SMALL)
        canvas.text(foot, canvas.rect.centerx, FOOT_Y, FOG, SMALL, 1, "center", True)

    def _draw_planes(self, canvas):
        """Draw the two planes with their boxes.

        The colour of the boxes shows whether pixels, only boxes, or nothing overlaps.
        """
        phase = self.time % LOOP / LOOP
        sway = sin(phase * 2 * pi)
        a = self.left.get_rect(center=(round(262 + 40 * sway), round(180 + 4 * sin(phase * 4 * pi))))
        b = self.right.get_rect(center=(round(372 - 34 * sway), round(178 - 4 * sin(phase * 4 * pi))))
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
        canvas.text(word, 316, WORD_Y, color, TEXT, 1, "center", True)
