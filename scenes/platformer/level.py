"""The level: its solid tiles as one static body, and fast queries about single tiles."""

from functools import lru_cache
from math import floor
from pathlib import Path

import numpy as np

from game.drawing.tilemap import load_tilemap, map_picture
from game.places import LEVELS
from physics import Filter, TileGrid
from scenes.platformer.level_rules import LARGEST, check_level

# Categories. Two shapes collide if each one's membership is in the other's mask.
TILES, HERO, ENEMY, CRATE, PLATFORM, TRIGGER, DEBRIS, BOMB = 1, 2, 4, 8, 16, 32, 64, 128
FILTER_NAMES = {
    TILES: "ground",
    HERO: "hero",
    ENEMY: "enemy",
    CRATE: "crate",
    PLATFORM: "platform",
    TRIGGER: "trigger",
    DEBRIS: "debris",
    BOMB: "bomb",
}
SOLIDS = TILES | CRATE | PLATFORM
TILE_FILTER = Filter(TILES, HERO | ENEMY | CRATE | DEBRIS | BOMB)
HERO_FILTER = Filter(HERO, SOLIDS | ENEMY | TRIGGER)
ENEMY_FILTER = Filter(ENEMY, SOLIDS | HERO)
CRATE_FILTER = Filter(CRATE, SOLIDS | HERO | ENEMY | TRIGGER | BOMB)
PLATFORM_FILTER = Filter(PLATFORM, HERO | ENEMY | CRATE | BOMB)
TRIGGER_FILTER = Filter(TRIGGER, HERO)
SPRING_FILTER = Filter(TRIGGER, HERO | CRATE)
DEBRIS_FILTER = Filter(DEBRIS, TILES)
BOMB_FILTER = Filter(BOMB, SOLIDS)

EMPTY, SOLID, PLANK, SLOPE = "empty", "solid", "one_way", "slope"
GLOWS = {
    "torch": (0, -3),
    "crystal_0": (0, 0),
    "crystal_1": (0, 0),
    "glowcap": (0, 0),
    "window": (0, 0),
}  # offset of the light from the tile's middle [px]


class Level:
    """A level: its TileMap, and queries about its solid tiles. All lengths are in integer pixels.

    map: the TileMap; picture: the sheet of pictures of its tiles.
    """

    def __init__(self, tilemap, picture=None):
        self.map, self.picture = tilemap, picture
        self.grid = self.map.grid("solid")
        self.size = self.map.size
        self.tile = self.map.tile_size
        kinds = {number: self.map.kind_of(number) for number in self.map.tiles}
        stands = {number: kind for number, kind in kinds.items() if kind in (SOLID, PLANK, SLOPE)}
        self.kinds = [[stands.get(number, EMPTY) for number in row] for row in self.map.layers["solid"].tolist()]
        self.slopes = self.grid.slopes.tolist()
        self.lights = list(self._find_lights())
        self.zones = self.map.things_of("zone")
        self.covers = self.map.things_of("cover")
        self.hints = sorted(self.map.things_of("hint"), key=lambda hint: hint.properties["order"])

    def __deepcopy__(self, memo):
        return self  # a Level never changes, and pictures are cached by its identity

    def _find_lights(self):
        """Yield (x [px], y [px], name) for every glowing tile of the layer "decor": the position of its light, and its
        name.
        """
        names = {number: tile.get("name") for number, tile in self.map.tiles.items() if tile.get("name") in GLOWS}
        layer = self.map.layers.get("decor", np.zeros((0, 0), int))
        for row, line in enumerate(layer.tolist()):
            for column, number in enumerate(line):
                if number in names:
                    dx, dy = GLOWS[names[number]]
                    yield (column + 0.5) * self.tile + dx, (row + 0.5) * self.tile + dy, names[number]

    def zones_at(self, x, y):
        """Return the list of zones that contain the point (x, y) [px], in the order of the map.

        The first zone of the list determines the act.
        """
        return [zone for zone in self.zones if zone.x <= x < zone.x + zone.width and zone.y <= y < zone.y + zone.height]

    def add_to(self, world):
        """Add the solid tiles to a world as one static body, and return the body.

        Planks are left out if the world's effect `one_way` is off.
        """
        grid = self.grid
        if not world.effects.one_way:
            grid = TileGrid(grid.solid, grid.tile_size, slopes=grid.slopes)
        return world.add_body(grid, kind="static", filter=TILE_FILTER, user="tiles")

    def kind(self, column, row):
        """Return the kind of the tile in this column and row: EMPTY, SOLID, PLANK or SLOPE.

        Tiles beside the map are SOLID, tiles above and below it are EMPTY.
        """
        if not 0 <= column < self.map.columns:
            return SOLID
        return self.kinds[row][column] if 0 <= row < self.map.rows else EMPTY

    def kind_at(self, x, y):
        """Return the kind of the tile at the point (x, y) [px]."""
        return self.kind(floor(x / self.tile), floor(y / self.tile))

    def surface(self, column, row, x):
        """Return the y [px] of the ground at `x` [px] in the tile (column, row).

        Return None if the tile is neither solid nor a slope.
        """
        kind = self.kind(column, row)
        if kind == SOLID:
            return row * self.tile
        return self._slope(column, row, x) if kind == SLOPE else None

    def _slope(self, column, row, x):
        low, high = self.slopes[row][column]
        share = min(max((x - column * self.tile) / self.tile, 0.0), 1.0)
        return (row + 1 - low - (high - low) * share) * self.tile

    def blocks(self, left, top, width, height):
        """Return whether a box of the given width and height overlaps solid tiles or slopes.

        left, top: its top left corner [px]. Planks are one-way tiles, so they never block.
        """
        bottom = top + height
        for row in range(floor(top / self.tile), floor((bottom - 1) / self.tile) + 1):
            for column in range(floor(left / self.tile), floor((left + width - 1) / self.tile) + 1):
                kind = self.kind(column, row)
                if kind == SOLID:
                    return True
                if kind == SLOPE:
                    start = max(left, column * self.tile)
                    end = min(left + width, (column + 1) * self.tile)
                    highest = min(self._slope(column, row, start), self._slope(column, row, end))
                    if bottom > highest:
                        return True
        return False

    def on_plank(self, left, bottom, width):
        """Return whether all tiles under the feet are planks or empty, with at least one plank, at the height of the
        feet.

        left, bottom: x and y of the feet's left end [px]; width: width of the feet [px].
        """
        if bottom % self.tile:
            return False
        row = bottom // self.tile
        under = {
            self.kind(column, row)
            for column in range(floor(left / self.tile), floor((left + width - 1) / self.tile) + 1)
        }
        return PLANK in under and under <= {PLANK, EMPTY}

    def plank_within(self, left, right, bottom, reach):
        """Return whether feet from x = left to x = right are inside a plank, at most `reach` px below its top.

        bottom: y of the feet [px].
        """
        row = (bottom - 1) // self.tile
        if not 0 < bottom - row * self.tile <= reach:
            return False
        return any(self.kind(column, row) == PLANK for column in range(left // self.tile, (right - 1) // self.tile + 1))

    def drop_to_ground(self, x, y, most):
        """Return the vertical distance [px] from the point (x, y) down to the ground, but at most `most`.

        Planks do not count as ground.
        """
        row = floor(y / self.tile)
        column = floor(x / self.tile)
        while row * self.tile < y + most:
            top = self.surface(column, row, x)
            if top is not None and top >= y - 1e-9:
                return min(top - y, most)
            row += 1
        return most


@lru_cache(maxsize=4)
def load_level(path=None, stamp=None):
    """Return the Level in a map file, or the game's own level if `path` is None.

    Results are cached by path and `stamp`, the file's time of change [ns]. Raises FileError if the level is not
    playable.
    """
    tilemap = load_tilemap(LEVELS / "platformer.tmj" if path is None else path, LARGEST)
    check_level(tilemap)
    return Level(tilemap, map_picture(tilemap))


def level_of(path=None):
    """Return the Level in a map file, read again if the file has changed; the game's own level if `path` is None.

    Raises FileError if the level is not playable.
    """
    if path is None:
        return load_level()
    path = Path(path)
    try:
        stamp = path.stat().st_mtime_ns
    except (OSError, ValueError):  # load_level() raises an error with the reason
        stamp = None
    return load_level(path, stamp)
