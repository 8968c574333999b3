"""The moon at the start: pictures, pads, winds, positions of cargo and rocks, and the bot's path.

The Moon is constant. Other objects store the changes during a game.
"""

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
import pygame

from game.drawing.sprites import load_backdrop
from game.files.json_file import read_json
from game.places import LEVELS
from physics import PixelMask

LEVEL = LEVELS / "lander.json"


@dataclass(frozen=True)
class Pad:
    """A landing pad. x: x of its centre [px]; y: y of its deck [px]. The first pad of the moon is the base."""

    name: str
    title: str
    hint: str
    more: str
    x: float
    y: float
    width: float

    @property
    def look(self):
        """Name of the pad's picture in the sprite sheet."""
        return f"pad_{self.name}"


@dataclass(frozen=True)
class Wind:
    """The wind in a region of the moon, which ends at x = `until` [px].

    steady: its constant part [px/s]; gust: greatest speed that gusts add [px/s].
    """

    until: float
    steady: float
    gust: float


@dataclass(frozen=True)
class Waypoint:
    """A point of the bot's path.

    at: (x, y) [px]; take: number of the piece of cargo to pick up there, or -1; until: point (x, y) up to which the
    path must be free of ground before the bot continues, or () for no check.
    """

    at: tuple
    until: tuple = ()
    take: int = -1


class Moon:
    """The moon: its ground and mountain, and the contents of its level file.

    mask: the ground as one PixelMask, at the world's origin; solid: bool array [row, column] of the ground's pixels;
    massif: bool array [row, column] of the mountain's pixels, caves included.
    """

    def __init__(self):
        level = read_json(LEVEL)
        self.width, self.height = level["size"]
        self.pads = tuple(
            Pad(pad["name"], pad["title"], pad.get("hint", ""), pad.get("more", ""), pad["x"], pad["y"], pad["width"])
            for pad in level["pads"]
        )
        self.winds = tuple(Wind(**wind) for wind in level["winds"])
        self.cargo = tuple((each["look"], each["x"], each["y"]) for each in level["cargo"])
        self.rocks = tuple((x, y, f"rock_{kind}") for x, y, kind in level["rocks"])
        self.cans = tuple((x, y) for x, y in level["cans"])
        self.flight = tuple(tuple(Waypoint(**each) for each in act) for act in level["flight"])
        self.picture, self.wall = load_backdrop("lander_ground"), load_backdrop("lander_wall")
        self.mask = PixelMask.from_surface(self.picture, origin=(0, 0))
        self.solid = self.mask.solid
        self.tiles = self.mask.tiles  # computed at the start, so that the first shell causes no delay
        self.massif = np.ascontiguousarray((pygame.surfarray.pixels_alpha(self.wall) > 0).T)

    def __deepcopy__(self, memo):
        """Return itself, so that a copy of a scene shares the moon."""
        return self

    def is_inside(self, x, y):
        """Return whether (x, y) [px] is inside the mountain, in rock or in a cave. There is no wind inside."""
        column, row = int(x), int(y)
        return 0 <= column < self.width and 0 <= row < self.height and bool(self.massif[row, column])

    def wind_at(self, x):
        """Return the Wind of the region at x [px]."""
        return next((wind for wind in self.winds if x < wind.until), self.winds[-1])


@lru_cache(maxsize=1)
def the_moon():
    """Return the one Moon, which is created at the first call."""
    return Moon()
