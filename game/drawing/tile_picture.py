"""Cached pictures of a tile layer.

Each picture shows a chunk: a square of CHUNK x CHUNK tiles. Each chunk is drawn into its picture once. Only chunks in
view are blitted, so that the cost does not grow with the level's size.
"""

import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import Canvas
from game.drawing.sprites import load_image
from game.drawing.tilemap import FLIP_DIAGONAL, FLIP_X, FLIP_Y, TileMap, map_picture

CHUNK = 32  # tiles along a side of a chunk: 512 px, so at most four of them are on the screen


class TilePicture:
    """Cached pictures of the chunks of one layer of a TileMap. draw() blits them as seen by a camera."""

    def __init__(self, tilemap: TileMap, layer: str, tiles: pygame.Surface | None = None) -> None:
        self.map, self.layer = tilemap, layer
        self.sheet = tiles if tiles is not None else _sheet(tilemap)
        self.chunks = {}

    def draw(self, canvas: Canvas, camera: Camera, alpha: float = 1.0) -> None:
        """Blit the pictures of the chunks in the camera's view. alpha: position between the last two steps, 0..1."""
        left, top = camera.view(alpha)
        size = CHUNK * self.map.tile_size
        view = camera.viewport
        for column in range(int(left // size), int((left + view.width) // size) + 1):
            for row in range(int(top // size), int((top + view.height) // size) + 1):
                chunk = self._chunk(column, row)
                if chunk is not None:
                    canvas.surface.blit(chunk, (column * size - left + view.x, row * size - top + view.y))

    def _chunk(self, column, row):
        if (column, row) not in self.chunks:
            self.chunks[column, row] = self._paint(column * CHUNK, row * CHUNK)
        return self.chunks[column, row]

    def _paint(self, first_column, first_row):
        """Return the picture of the chunk that begins at the tile (first_column, first_row).

        Return None if the chunk has no tiles.
        """
        numbers, flips = self.map.layers[self.layer], self.map.flips[self.layer]
        if first_column < 0 or first_row < 0:
            return None
        part = numbers[first_row : first_row + CHUNK, first_column : first_column + CHUNK]
        if part.size == 0 or (part < 0).all():
            return None
        size = self.map.tile_size
        picture = pygame.Surface((CHUNK * size, CHUNK * size), pygame.SRCALPHA)
        for row in range(part.shape[0]):
            for column in range(part.shape[1]):
                if part[row, column] >= 0:
                    flip = int(flips[first_row + row, first_column + column])
                    picture.blit(self._tile(int(part[row, column]), flip), (column * size, row * size))
        return picture

    def _tile(self, number, flip):
        size, columns = self.map.tile_size, self.map.image_columns
        place = (number % columns * size, number // columns * size, size, size)
        tile = self.sheet.subsurface(place)
        if flip & FLIP_DIAGONAL:
            tile = pygame.transform.flip(pygame.transform.rotate(tile, 90), False, True)
        return pygame.transform.flip(tile, bool(flip & FLIP_X), bool(flip & FLIP_Y)) if flip else tile


def _sheet(tilemap):
    """Return the picture of the map's tileset. Raises FileError if it is too small to contain every tile of the map."""
    return load_image(map_picture(tilemap))
