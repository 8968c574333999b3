"""The ground: one static body of all the moon's pixels, into which craters are carved.

The body's own mask holds the pixels that are left, so drawing, flying and colliding use the same pixels.
"""

from math import floor

import numpy as np

from physics import Circle, Material
from scenes.lander.feel import CRUMB, DENSITY, GROUND

ROCK = Material(density=DENSITY, friction=0.75)
TILE = 64  # [px] side of the parts in which pictures are made, and columns in a word of the mask
BITS = np.uint64(63)


class Ground:
    """The ground. `body`: the static mask. `touched`: (column, row) of the tiles that have changed."""

    def __init__(self, world, moon):
        self.moon = moon
        self.body = world.add_body(
            moon.mask, position=(0, 0), kind="static", material=ROCK, filter=GROUND, user="ground"
        )
        self.touched = set()

    def carve(self, x, y, radius):
        """Carve a round crater. Return the bodies of the pieces that came loose."""
        carved = self.body.carve(Circle(radius), (x, y), crumb=CRUMB)
        if carved.removed:
            self._touch(x - radius, y - radius, x + radius, y + radius)
        for piece in carved.fragments:
            self._touch(*piece.bounds)
        return carved.fragments

    def _touch(self, left, top, right, bottom):
        for row in range(floor(top) // TILE, floor(bottom) // TILE + 1):
            self.touched.update((column, row) for column in range(floor(left) // TILE, floor(right) // TILE + 1))

    def around(self, column, row, border):
        """Return the pixels of one tile and `border` px around it, bool [row, column]; None while all are solid."""
        if not any((column + dx, row + dy) in self.touched for dx in (-1, 0, 1) for dy in (-1, 0, 1)):
            return None
        words = self.body.shapes[0].words
        # Beyond the moon's edge the pixels of the edge are repeated.
        lines = np.clip(np.arange(row * TILE - border, (row + 1) * TILE + border), 0, len(words) - 1)
        columns = np.clip(np.arange(column * TILE - border, (column + 1) * TILE + border), 0, self.moon.width - 1)
        first, last = int(columns[0]) // TILE, int(columns[-1]) // TILE
        some = np.ascontiguousarray(words[lines, first : last + 1].astype("<u8")).view(np.uint8)
        return np.unpackbits(some, axis=1, bitorder="little").view(bool)[:, columns - first * TILE]

    def is_solid(self, x, y):
        """Return whether there is ground at a place [px]; beside and below the moon there is."""
        column, row = floor(x), floor(y)
        if not 0 <= column < self.moon.width or row >= self.moon.height:
            return True
        if row < 0 or not self.moon.solid[row, column]:
            return False
        if (column // TILE, row // TILE) not in self.touched:
            return True
        return bool(self.body.shapes[0].words[row, column // TILE] >> (np.uint64(column) & BITS) & np.uint64(1))

    def clear_way(self, x, y, dx, dy, reach):
        """Return the distance [px] along a unit vector to the first ground, at most `reach`."""
        far = 0.0
        while far < reach:
            if self.is_solid(x + dx * far, y + dy * far):
                return far
            far += 1.0
        return reach

    def state(self):
        """Return the state for the digest; the world's state has the pixels."""
        return tuple(value for tile in sorted(self.touched) for value in tile)
