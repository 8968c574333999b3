"""Rope bridges. The shape of a bridge is the one-way pixel mask of its picture.

The hero jumps up through a bridge and walks along its curve.
"""

import numpy as np

from game.drawing.sprites import load_atlas
from physics import Filter, PixelMask
from scenes.platformer.level import TILE_FILTER

NEAR = 2  # [px] tolerance between the hero's feet and the highest board below them, because of rounding


class Bridge:
    """A rope bridge. left, top: upper left corner of the picture of its boards [px]."""

    def __init__(self, world, thing):
        self.left, self.top = int(thing.x), int(thing.y)
        mask = PixelMask.from_surface(load_atlas("things")["bridge"], origin=(0, 0), one_way=True)
        self.heights = self.top + np.argmax(mask.solid, axis=0)  # y of the boards [px], by column of pixels
        one_way = world.effects.one_way  # if this effect is off, nothing collides with the bridge
        self.body = world.add_body(
            mask.with_(one_way=one_way),
            position=(self.left, self.top),
            kind="static",
            filter=TILE_FILTER if one_way else Filter(TILE_FILTER.membership, 0),
            user="bridge",
        )

    def height(self, left, right):
        """Return the y [px] of the highest board between x = left and x = right, or None outside the bridge."""
        under = self.heights[max(left - self.left, 0) : max(right - self.left, 0)]
        return int(under.min()) if len(under) else None

    def bears(self, left, right, bottom):
        """Return whether feet from x = left to x = right [px] stand on the bridge. bottom: y of the feet [px]."""
        height = self.height(left, right)
        return height is not None and abs(bottom - height) <= NEAR

    def holds(self, left, right, bottom, reach):
        """Return whether feet from x = left to x = right are inside the boards, at most `reach` px below their top.

        bottom: y of the feet [px].
        """
        height = self.height(left, right)
        return height is not None and 0 < bottom - height <= reach
