"""Pictures of the static bodies of lab/joints: earth in the shape of a polygon, with grass along its upper edges."""

from math import ceil, hypot

import pygame

from game.drawing.colors import INK
from game.drawing.sprites import load_atlas
from scenes.lab.pieces import placed
from scenes.lab.yard import TILE

GRASS = ((126, 200, 80), (78, 146, 70))  # blades, and the line below them
STEEP = 0.75  # of an edge's normal that must point up for grass on it


def earth_picture(shape, place):
    """Return (picture, (left, top)): a Surface with a static polygon's earth and grass, and its position on the
    canvas.

    place: (x, y) of the polygon's body on the canvas. The earth's tiles are aligned to the canvas's corner, so that
    the pictures of neighbouring polygons match.
    """
    points = placed(shape, 1.0, (*place, 0.0))
    left, top = int(min(x for x, _ in points)) - 2, int(min(y for _, y in points)) - 4
    width = ceil(max(x for x, _ in points)) - left + 3
    height = ceil(max(y for _, y in points)) - top + 3
    picture, tile = pygame.Surface((width, height), pygame.SRCALPHA), load_atlas("tiles")["ground_255"]
    for x in range(-(left % TILE), width, TILE):
        for y in range(-(top % TILE), height, TILE):
            picture.blit(tile, (x, y))
    local = [(x - left, y - top) for x, y in points]
    stencil = pygame.Surface((width, height), pygame.SRCALPHA)
    pygame.draw.polygon(stencil, (255, 255, 255, 255), local)
    picture.blit(stencil, (0, 0), special_flags=pygame.BLEND_RGBA_MULT)
    pygame.draw.polygon(picture, INK, local, 1)
    for (ax, ay), (bx, by) in zip(local, local[1:] + local[:1], strict=True):
        if (bx - ax) / hypot(bx - ax, by - ay) > STEEP:  # clockwise on the screen: an upper edge runs to the right
            for number, color in enumerate((INK, *GRASS, GRASS[1])):
                pygame.draw.line(picture, color, (ax, ay + number - 1), (bx, by + number - 1))
    return picture, (left, top)
