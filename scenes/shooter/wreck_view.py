"""Pictures of the pieces of broken planes. Each is cut out of the plane's picture, and becomes smaller as it falls."""

import numpy as np
import pygame

from game.drawing.blit import blit_many
from game.drawing.fragment import FragmentPicture, cut_out

HOT, COLD = (255, 196, 84), (24, 14, 22)  # colours of a fresh edge and of a burnt-out one
COOL = 26  # steps until an edge is dark
LOW = 0.68  # size of a piece on the ground, relative to that in the sky
KEPT = 64  # pictures in the cache


class WreckView:
    """The renderer of wreckage, with a cache of the pictures of its pieces."""

    def __init__(self, view):
        self.view = view
        self.kept = {}  # (body id, hot) -> (mask, FragmentPicture)

    def draw(self, scene, shaded=False):
        """Draw all pieces of wreckage, the lowest first. shaded: True draws their shadows on the ground instead."""
        pieces = scene.wreckage.pieces
        if not pieces:
            return
        order = sorted(pieces, key=lambda identity: pieces[identity].high)
        x, y, angles = self.view.places(scene, order)
        pairs = []
        for identity, *pose in zip(order, x.tolist(), y.tolist(), angles.tolist(), strict=True):
            piece = pieces[identity]
            picture = self._picture(identity, piece)
            image, size = picture.at(pose[2]), LOW + (1.0 - LOW) * piece.high
            width, height = (max(1, round(side * size)) for side in image.get_size())
            image, place = pygame.transform.scale(image, (width, height)), picture.middle(*pose)
            pairs.append(
                self.view.shadow(image, place, piece.high)
                if shaded
                else (image, self.view.at(*place, (width / 2, height / 2)))
            )
        blit_many(self.view.surface, pairs)

    def _picture(self, identity, piece):
        hot, mask = piece.age < COOL, piece.mask
        known = self.kept.get((identity, hot))
        if known is None or known[0] is not mask:
            if len(self.kept) >= KEPT:
                self.kept.clear()
            image = cut_out(self.view.planes[piece.frame], mask, piece.left, piece.top, HOT if hot else COLD, 0.9)
            known = self.kept[identity, hot] = (mask, FragmentPicture(image if hot else sooty(image), mask))
        return known[1]


def sooty(image):
    """Return a copy of an image that looks burnt: every other pixel is darker."""
    out = image.copy()
    pixels = pygame.surfarray.pixels3d(out)
    columns, rows = np.indices(pixels.shape[:2])
    grain = (columns + rows) % 2 == 0
    pixels[grain] = pixels[grain] * 3 // 4
    del pixels  # unlocks the surface
    return out
