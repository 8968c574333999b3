"""The background of the labs with piles (dusk sky, grass or a wooden table), and the height of every lab's
title line.
"""

import pygame

from game.drawing.backdrop import Backdrop
from game.drawing.canvas import CANVAS_SIZE, Canvas
from game.drawing.sprites import load_atlas

TILE = 16
HEAD = 16  # [canvas px] of the dark head line


class Yard:
    """A background picture of the canvas's size, drawn once when the object is made.

    ground: canvas y of the floor, or a tuple of several; dim: darkening of the sky (0..255); table: whether the floor
    is made of boards (True) or grass.
    """

    def __init__(self, ground, dim=40, table=False):
        canvas = Canvas()
        Backdrop().draw(canvas, 60, dim)
        for y in ground if isinstance(ground, tuple) else (ground,):
            (_lay_boards if table else _lay_grass)(canvas.surface, y)
        self.picture = canvas.surface

    def draw(self, canvas):
        """Draw the background."""
        canvas.surface.blit(self.picture, (0, 0))


def plate(canvas, rect, ground=(20, 16, 32, 205)):
    """Draw a dark, transparent rectangle as the background of text. Overlays do not cover it.

    rect: canvas rectangle; ground: colour (r, g, b, alpha) of the plate.
    """
    darken(canvas, rect, ground)
    canvas.fix(rect)


def darken(canvas, rect, ground=(20, 16, 32, 205)):
    """Draw a transparent colour over a rectangle of the canvas. ground: this colour (r, g, b, alpha)."""
    shade = pygame.Surface(pygame.Rect(rect).size, pygame.SRCALPHA)
    shade.fill(ground)
    canvas.surface.blit(shade, rect[:2])


def _lay_grass(surface, y):
    tiles = load_atlas("tiles")
    for x in range(0, CANVAS_SIZE[0], TILE):
        surface.blit(tiles["ground_124"], (x, y))
        for row in range(1, (CANVAS_SIZE[1] - y) // TILE + 1):
            surface.blit(tiles["ground_255"], (x, y + row * TILE))


def _lay_boards(surface, y):
    surface.blit(load_atlas("lab")["floor"], (0, y))
