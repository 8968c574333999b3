"""Pictures of fragments: the pixels of a fragment, cut out of the picture of the whole body."""

from math import cos, pi, sin

import numpy as np
import pygame

from game.drawing.canvas import whole
from physics import PixelMask

ANGLES = 64  # pictures cached per full turn: a 40 px piece moves by 2 px at its tips from one to the next


def cut_out(
    source: pygame.Surface, mask: PixelMask, left: int, top: int, edge: tuple[int, int, int], share: float = 0.75
) -> pygame.Surface:
    """Return the part of the picture `source` under the solid pixels of `mask`. All other pixels are transparent.

    left, top: position of the mask in the picture. Edges along which the picture was broken are tinted with the colour
    `edge`. Such an edge is where the picture has opaque pixels just outside the mask. The colour of its outermost
    pixels is mixed with `edge` by the factor `share` (0..1), and that of the next pixels inwards by share / 2.
    """
    width, height = mask.size
    wide = pygame.Surface((width + 2, height + 2), pygame.SRCALPHA)
    wide.blit(source, (0, 0), (left - 1, top - 1, width + 2, height + 2))
    solid = np.pad(mask.solid, 1)
    gone = (pygame.surfarray.array_alpha(wide).T > 127) & ~solid
    first = _beside(gone) & solid
    second = _beside(first) & solid & ~first
    out = wide.subsurface((1, 1, width, height)).copy()
    pixels = pygame.surfarray.pixels3d(out)
    for ring, part in ((first, share), (second, share / 2)):
        there = ring[1:-1, 1:-1].T
        pixels[there] = (pixels[there] * (1.0 - part) + np.array(edge) * part).astype(np.uint8)
    del pixels  # unlocks the surface
    alpha = pygame.surfarray.pixels_alpha(out)
    alpha[:] = np.where(mask.solid.T, 255, 0)
    del alpha
    return out


class FragmentPicture:
    """Picture of a fragment, drawn at any angle. It rotates around the origin of the fragment's body."""

    def __init__(self, image: pygame.Surface, mask: PixelMask) -> None:
        # From the body's origin to the centre of the picture.
        self.off = (mask.size[0] / 2 - mask.origin[0], mask.size[1] / 2 - mask.origin[1])
        self.image, self.kept = image, {0: image}

    def at(self, angle: float) -> pygame.Surface:
        """Return the picture, rotated clockwise by the multiple of 2 pi / ANGLES that is nearest to `angle` [rad].

        Rotated pictures are cached.
        """
        number = round(angle / (2.0 * pi) * ANGLES) % ANGLES
        if number not in self.kept:
            self.kept[number] = pygame.transform.rotate(self.image, -360.0 * number / ANGLES)
        return self.kept[number]

    def middle(self, x: float, y: float, angle: float) -> tuple[float, float]:
        """Return the world position (x, y) of the picture's centre. x, y, angle: pose of the body [px, px, rad]."""
        c, s = cos(angle), sin(angle)
        return x + c * self.off[0] - s * self.off[1], y + s * self.off[0] + c * self.off[1]

    def draw(self, surface: pygame.Surface, x: float, y: float, angle: float) -> None:
        """Draw the fragment, rotated by `angle` [rad], with its body's origin at the point (x, y) of the surface."""
        image = self.at(angle)
        across, down = self.middle(x, y, angle)
        width, height = image.get_size()
        surface.blit(image, (whole(across - width / 2), whole(down - height / 2)))


def _beside(pixels):
    """Return a bool array of the pixels that have at least one neighbour in `pixels`, also a bool array.

    The neighbours are the pixels above, below, left and right.
    """
    padded = np.pad(pixels, 1)
    return padded[:-2, 1:-1] | padded[2:, 1:-1] | padded[1:-1, :-2] | padded[1:-1, 2:]
