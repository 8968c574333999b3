"""A rope bridge: its picture is its shape, one-way from below. The hero jumps up through it and walks along its
curve.
"""

import numpy as np

from game.drawing.sprites import load_atlas
from physics import Filter, PixelMask
from scenes.platformer.level import TILE_FILTER

NEAR = 2  # [px] tolerance of the highest point under his box, by rounding to whole pixels


class Bridge:
    """A rope bridge. `left`, `top` [px]: top left of its boards' upper side."""

    def __init__(self, world, thing):
        self.left, self.top = int(thing.x), int(thing.y)
        mask = PixelMask.from_surface(load_atlas("things")["bridge"], origin=(0, 0), one_way=True)
        self.heights = self.top + np.argmax(mask.solid, axis=0)  # [px] of the boards, by column
        one_way = world.effects.one_way  # without it the bridge is a picture that nothing meets
        self.body = world.add_body(
            mask.with_(one_way=one_way),
            position=(self.left, self.top),
            kind="static",
            filter=TILE_FILTER if one_way else Filter(TILE_FILTER.membership, 0),
            user="bridge",
        )

    def height(self, left, right):
        """Return the height [px] of the highest board within some columns, or None beside the bridge."""
        under = self.heights[max(left - self.left, 0) : max(right - self.left, 0)]
        return int(under.min()) if len(under) else None

    def bears(self, left, right, bottom):
        """Return whether feet at the height `bottom` stand on it."""
        height = self.height(left, right)
        return height is not None and abs(bottom - height) <= NEAR

    def holds(self, left, right, bottom, reach):
        """Return whether feet at the height `bottom` are in it, by at most `reach` px."""
        height = self.height(left, right)
        return height is not None and 0 < bottom - height <= reach
