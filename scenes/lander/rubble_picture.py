"""Pictures of rubble: each piece is cut out of its original picture, and drawn at any angle."""

from functools import lru_cache
from math import cos, pi, sin

import numpy as np
import pygame

from game.drawing.canvas import whole
from game.drawing.sprites import load_atlas

ANGLES = 128  # pictures per full turn
KEPT = 300  # pieces in the cache


class RubblePictures:
    """Renderer of rubble, with a cache of pictures. A carve replaces a piece's mask, so it also replaces
    the picture.
    """

    def __init__(self, moon):
        self.moon = moon
        self.kept = {}  # body id -> (mask, Cut)

    def draw(self, surface, piece, body, x, y, angle):
        """Draw a piece with its body's origin at (x, y) on the surface, rotated by `angle` [rad]."""
        (mask,) = body.shapes
        kept = self.kept.get(body.id)
        if kept is None or kept[0] is not mask:
            if len(self.kept) >= KEPT:
                self.kept.clear()
            kept = self.kept[body.id] = (mask, Cut(self._cut_out(piece, mask)))
        image = kept[1].at(angle)
        # The picture's centre relative to the body's origin.
        u, v = mask.size[0] / 2 - mask.origin[0], mask.size[1] / 2 - mask.origin[1]
        c, s = cos(angle), sin(angle)
        width, height = image.get_size()
        surface.blit(image, (whole(x + c * u - s * v - width / 2), whole(y + s * u + c * v - height / 2)))

    def _cut_out(self, piece, mask):
        """Return a Surface with the pixels of a piece, dark along its fractures and light where a fracture faces up.

        mask: the piece's PixelMask.
        """
        width, height = mask.size
        source = self.moon.picture if piece.look == "ground" else load_atlas("lander")[piece.look]
        wide = pygame.Surface((width + 2, height + 2), pygame.SRCALPHA)
        left, top = piece.source
        wide.blit(source, (0, 0), (left - 1, top - 1, width + 2, height + 2))
        out = wide.subsurface((1, 1, width, height)).copy()
        whole_before = pygame.surfarray.array_alpha(wide).T > 0
        solid, gone = np.pad(mask.solid, 1), whole_before & ~np.pad(mask.solid, 1)
        broken = (_beside(gone) & solid)[1:-1, 1:-1]
        lit = gone[:-2, 1:-1] & solid[1:-1, 1:-1]
        pixels = pygame.surfarray.pixels3d(out)
        pixels[broken.T] = pixels[broken.T] // 2
        pixels[lit.T] = np.minimum(pixels[lit.T].astype(np.uint16) * 2 + 40, 225).astype(np.uint8)
        del pixels
        alpha = pygame.surfarray.pixels_alpha(out)
        alpha[:] = np.where(mask.solid.T, 255, 0)
        del alpha
        return out


class Cut:
    """The picture of one piece, with a cache of its rotated copies."""

    def __init__(self, image):
        self.image = image
        self.turned = lru_cache(maxsize=ANGLES)(self._turned)

    def at(self, angle):
        """Return the picture as a Surface, rotated clockwise by `angle` [rad]. The angle is rounded to one of ANGLES
        per turn.
        """
        return self.turned(round(angle / (2.0 * pi) * ANGLES) % ANGLES)

    def _turned(self, number):
        return self.image if number == 0 else pygame.transform.rotate(self.image, -360.0 * number / ANGLES)


def _beside(gone):
    """Return a bool array of the pixels that have at least one neighbour in `gone`.

    The neighbours are the pixels above, below, left and right. gone: bool array (height, width); the result has the
    same shape.
    """
    padded = np.pad(gone, 1)
    return padded[:-2, 1:-1] | padded[2:, 1:-1] | padded[1:-1, :-2] | padded[1:-1, 2:]
