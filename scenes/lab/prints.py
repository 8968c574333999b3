"""Pictures of carved masks. The remaining pixels of a mask are cut out of the picture of the whole body."""

from functools import lru_cache
from math import cos, pi, sin
from typing import NamedTuple

import numpy as np
import pygame

from game.drawing.canvas import whole
from game.drawing.rotated import poses_between

ANGLES = 128  # pictures per full turn
KEPT = 300  # pictures of pieces, each at all its angles
EDGE = (24, 18, 30)  # colour of a new edge


class Print(NamedTuple):
    """The picture from which the pixels of a mask are cut out.

    image: picture of the whole body; left, top: position [px] in it of the mask's upper left corner.
    """

    image: pygame.Surface
    left: int
    top: int


class Prints:
    """Renderer of carved bodies. of: {body id: Print}. A body's picture is cached until its mask changes."""

    def __init__(self):
        self.of = {}
        self.kept = {}  # body id -> (mask, Piece)

    def add(self, body, image):
        """Add a body whose mask covers the whole Surface `image`, its picture. Return the body."""
        self.of[body.id] = Print(image, 0, 0)
        return body

    def add_piece(self, piece, parent):
        """Add a fragment that has just been carved off a body. Call this method before the fragment moves.

        parent: the carved body before the carve, as a tuple (Print, mask, pose). The pose is (x, y, angle).
        """
        (image, left, top), mask, (x, y, angle) = parent
        (own,) = piece.shapes
        dx, dy = piece.position[0] - x, piece.position[1] - y
        c, s = cos(angle), sin(angle)
        u, v = c * dx + s * dy, c * dy - s * dx
        shift = (round(u + mask.origin[0] - own.origin[0]), round(v + mask.origin[1] - own.origin[1]))
        self.of[piece.id] = Print(image, left + shift[0], top + shift[1])

    def forget(self, identity):
        """Remove the body with the id `identity`; an unknown id is ignored."""
        self.of.pop(identity, None)
        self.kept.pop(identity, None)

    def draw(self, canvas, camera, world, alpha):
        """Draw all added bodies. alpha: position (0..1) between the last two steps."""
        bodies = world.bodies
        rows = world.rows(np.array(sorted(self.of), np.int64))
        x, y, angle = (each[rows] for each in poses_between(bodies, alpha))
        x, y = camera.to_canvas(x, y, alpha)
        columns = (bodies["id"][rows].tolist(), x.tolist(), y.tolist(), angle.tolist())
        for identity, *pose in zip(*columns, strict=True):
            self._draw_one(canvas.surface, world.body(identity), *pose)

    def _draw_one(self, surface, body, x, y, angle):
        (mask,) = body.shapes
        kept = self.kept.get(body.id)
        if kept is None or kept[0] is not mask:
            if len(self.kept) >= KEPT:
                self.kept.clear()
            kept = self.kept[body.id] = (mask, Piece(cut_out(self.of[body.id], mask.solid)))
        image = kept[1].at(angle)
        # The picture's centre relative to the body's origin.
        u, v = mask.size[0] / 2 - mask.origin[0], mask.size[1] / 2 - mask.origin[1]
        c, s = cos(angle), sin(angle)
        width, height = image.get_size()
        surface.blit(image, (whole(x + c * u - s * v - width / 2), whole(y + s * u + c * v - height / 2)))


class Piece:
    """The picture of one mask, with a cache of its rotated copies."""

    def __init__(self, image):
        self.image = image
        self.turned = lru_cache(maxsize=ANGLES)(self._turned)

    def __deepcopy__(self, memo):
        """Return itself, so that a copy of a scene shares the cached pictures."""
        return self

    def at(self, angle):
        """Return the picture as a Surface, rotated clockwise by `angle` [rad]. The angle is rounded to one of ANGLES
        per turn.
        """
        return self.turned(round(angle / (2.0 * pi) * ANGLES) % ANGLES)

    def _turned(self, number):
        return self.image if number == 0 else pygame.transform.rotate(self.image, -360.0 * number / ANGLES)


def cut_out(part, solid):
    """Return a Surface with the pixels `solid`, cut out of the Print `part`. Edges made by carving are dark.

    solid: bool array (height, width), which begins at the mask's position in the picture of the whole body.
    """
    height, width = solid.shape
    out = pygame.Surface((width, height), pygame.SRCALPHA, 32)
    out.blit(part.image, (0, 0), (part.left, part.top, width, height))
    alpha = pygame.surfarray.pixels_alpha(out)
    gone = np.pad((alpha > 0).T & ~solid, 1)
    beside = (gone[:-2, 1:-1] | gone[2:, 1:-1] | gone[1:-1, :-2] | gone[1:-1, 2:]) & solid
    alpha[:] = np.where(solid.T, 255, 0)
    del alpha  # unlocks the surface
    pixels = pygame.surfarray.pixels3d(out)
    pixels[beside.T] = EDGE
    del pixels
    return out
