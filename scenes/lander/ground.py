"""The ground: one static body with the pixel mask of the whole moon, into which explosions carve craters.

The picture of the ground and the bot also read the body's mask, because it contains the remaining pixels.
"""

from math import floor

import numpy as np

from physics import Circle, Material
from scenes.lander.feel import CRUMB, DENSITY, GROUND

ROCK = Material(density=DENSITY, friction=0.75)
TILE = 64  # [px] side of the tiles in which the ground is drawn; a word of the mask holds as many columns
BITS = np.uint64(63)


class Ground:
    """The rock and ice of the moon, which explosions carve. body: the static body of the ground.

    touched: set of the tiles (column, row) that have changed since the start.
    """

    def __init__(self, world, moon):
        self.moon = moon
        self.body = world.add_body(
            moon.mask, position=(0, 0), kind="static", material=ROCK, filter=GROUND, user="ground"
        )
        self.touched = set()

    def carve(self, x, y, radius):
        """Carve a round crater at (x, y) [px] out of the ground. Return a list of the bodies that came loose.

        radius: radius of the crater [px].
        """
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
        """Return the remaining pixels of a tile and of `border` px around it, a bool array [row, column].

        column, row: numbers of the tile. Return None if the tile and its neighbours have not changed since the start.
        """
        if not any((column + dx, row + dy) in self.touched for dx in (-1, 0, 1) for dy in (-1, 0, 1)):
            return None
        words = self.body.shapes[0].words
        # Beyond the moon's edge, the pixels of the edge are repeated.
        lines = np.clip(np.arange(row * TILE - border, (row + 1) * TILE + border), 0, len(words) - 1)
        columns = np.clip(np.arange(column * TILE - border, (column + 1) * TILE + border), 0, self.moon.width - 1)
        first, last = int(columns[0]) // TILE, int(columns[-1]) // TILE
        some = np.ascontiguousarray(words[lines, first : last + 1].astype("<u8")).view(np.uint8)
        return np.unpackbits(some, axis=1, bitorder="little").view(bool)[:, columns - first * TILE]

    def is_solid(self, x, y):
        """Return whether there is ground at (x, y) [px]. All points beside and below the moon count as ground."""
        column, row = floor(x), floor(y)
        if not 0 <= column < self.moon.width or row >= self.moon.height:
            return True
        if row < 0 or not self.moon.solid[row, column]:
            return False
        if (column // TILE, row // TILE) not in self.touched:
            return True
        return bool(self.body.shapes[0].words[row, column // TILE] >> (np.uint64(column) & BITS) & np.uint64(1))

    def clear_way(self, x, y, dx, dy, reach):
        """Return the distance [px] from (x, y) to the first ground in the direction (dx, dy), at most `reach` px.

        dx, dy: unit vector.
        """
        far = 0.0
        while far < reach:
            if self.is_solid(x + dx * far, y + dy * far):
                return far
            far += 1.0
        return reach

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple. The pixels are part of the world's state."""
        return tuple(value for tile in sorted(self.touched) for value in tile)
