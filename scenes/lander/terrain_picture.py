"""The picture of the ground: rock, the wall behind it, and the edges of craters, drawn in cached tiles.

A tile is drawn from its current pixels alone, so that its picture is also right after a restart or a rewind. Beside
carved pixels the rock is scorched, and its edge is light or dark like the painted edges.
"""

import numpy as np
import pygame

from game.drawing.blit import blit_many
from game.drawing.canvas import CANVAS_SIZE
from scenes.lander.ground import TILE

SCORCH = ((22, 16, 26), (52, 36, 40), (30, 24, 36))  # colours of the first three px beside a hole
SCORCH_SHARE = (0.75, 0.62, 0.40)
LIT, SHADED = (186, 196, 222), (20, 18, 34)  # colours of an edge towards the light, and away from it
KEPT = 420  # tiles in the cache: a screen shows fifty
BORDER = 3  # [px] width of the surroundings on which the picture of a tile depends


class TerrainPicture:
    """Renderer of the ground, with a cache of its tiles. All games on one moon share the renderer."""

    def __init__(self, moon):
        self.moon = moon
        self.kept = {}  # (column, row) -> (pixels it was drawn from, surface or None if empty)
        self.columns, self.rows = moon.width // TILE, moon.height // TILE
        self.plain = {}

    def draw(self, surface, ground, left, top):
        """Draw the ground for a view whose top left corner is the world point (left, top) [px]."""
        pairs = []
        for row in range(max(top // TILE, 0), min((top + CANVAS_SIZE[1]) // TILE + 1, self.rows)):
            for column in range(max(left // TILE, 0), min((left + CANVAS_SIZE[0]) // TILE + 1, self.columns)):
                picture = self.tile(ground, column, row)
                if picture is not None:
                    pairs.append((picture, (column * TILE - left, row * TILE - top)))
        blit_many(surface, pairs)

    def tile(self, ground, column, row):
        """Return the picture of a tile with its current pixels in `ground`, a Surface, or None if the tile is empty."""
        around = ground.around(column, row, BORDER)
        version = None if around is None else around.tobytes()
        kept = self.kept.get((column, row))
        if kept is None or kept[0] != version:
            if len(self.kept) >= KEPT:
                self.kept.clear()
            kept = self.kept[column, row] = (version, self._drawn(column, row, around))
        return kept[1]

    def _drawn(self, column, row, around):
        area = (column * TILE, row * TILE, TILE, TILE)
        wall, rock = self.moon.wall.subsurface(area), self.moon.picture.subsurface(area)
        out = pygame.Surface((TILE, TILE), pygame.SRCALPHA)
        out.blit(wall, (0, 0))
        if around is None:
            out.blit(rock, (0, 0))
        else:
            out.blit(self._holed(rock, column, row, around), (0, 0))
        covered = pygame.mask.from_surface(out).count()
        if not covered:
            return None
        return out.convert() if covered == TILE * TILE and pygame.display.get_surface() else out

    def _holed(self, rock, column, row, around):
        """Return a Surface with a tile's remaining rock, scorched and lit along the edges of craters.

        rock: picture of the whole tile; column, row: numbers of the tile; around: bool array of the remaining pixels
        of the tile and of BORDER px around it.
        """
        before = padded(self.moon.solid, column, row)
        hole = before & ~around
        inner = np.s_[BORDER:-BORDER, BORDER:-BORDER]
        picture = rock.copy()
        pixels = pygame.surfarray.pixels3d(picture)
        view = pixels.swapaxes(0, 1)
        burnt, left = hole.copy(), around.copy()
        for color, share in zip(SCORCH, SCORCH_SHARE, strict=True):
            grown = burnt.copy()
            for step in ((0, 1), (0, -1), (1, 0), (-1, 0)):
                grown |= np.roll(burnt, step, (0, 1))
            ring = (grown & left)[inner]
            view[ring] = (view[ring] * (1.0 - share) + np.array(color) * share).astype(np.uint8)
            left &= ~grown
            burnt = grown
        open_above, open_left = np.roll(hole, 1, 0), np.roll(hole, 1, 1)
        lit = ((open_above | open_left) & around)[inner]
        view[lit] = (view[lit] * 0.45 + np.array(LIT) * 0.55).astype(np.uint8)
        dark = (np.roll(hole, -1, 0) & around)[inner] & ~lit
        view[dark] = SHADED
        del pixels, view
        alpha = pygame.surfarray.pixels_alpha(picture)
        alpha[:] = np.where(around[inner].T, alpha, 0)
        del alpha
        return picture


def padded(solid, column, row):
    """Return the original pixels of a tile and of BORDER px around it, a bool array [row, column].

    solid: bool array of the whole moon. Beyond the moon's edge, the pixels of the edge are repeated.
    """
    rows = np.clip(np.arange(row * TILE - BORDER, (row + 1) * TILE + BORDER), 0, solid.shape[0] - 1)
    columns = np.clip(np.arange(column * TILE - BORDER, (column + 1) * TILE + BORDER), 0, solid.shape[1] - 1)
    return solid[np.ix_(rows, columns)]
