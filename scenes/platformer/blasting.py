"""A bomb, which the hero finds, carries and throws, and the walls of pixels that it blows open.

A wall is a mask: the burst carves its disc out of it, and cracks through what is left. What comes loose is rubble: it
falls, comes to rest, is pushed and walked on, each piece by the outline of its own pixels.
"""

from dataclasses import dataclass
from functools import lru_cache
from math import ceil, floor, hypot, pi
from typing import cast

import numpy as np
import pygame

from game.drawing.crack import draw_crack
from game.drawing.sprites import load_atlas
from physics import Body, Circle, Material, PixelMask
from scenes.platformer.feel import GRAVITY, steps
from scenes.platformer.level import BOMB_FILTER, CRATE_FILTER, TILE_FILTER

RADIUS = 5.0  # [px] of the bomb
ABOVE = 7.0  # [px] from the hero's middle up to where a bomb leaves his hands: inside him, where nothing else is
THROW, DROPPED = (205.0, -330.0), (36.0, -40.0)  # [px/s] ahead and up, and with down held: just laid before the feet
LENT = 0.4  # of the hero's own speed that a thrown bomb takes along
BURNS = 1.25  # [s] from the throw to the burst
BACK = 1.6  # [s] until another one waits where it was
LEFT_BEHIND = 420.0  # [px] carried farther than this it is taken back: it is of no use there
CRATER, REACH = 27.0, 62.0  # [px] what the burst carves, and how far it throws
SHOVE = 260.0  # [px/s] what lies nearest is thrown at
HEAVIEST = 200.0  # [density px2] from which on things are shoved less
DEEP = 260  # [px] taken of a wall: it gives way all through
CRUMB = 12  # [px] smaller pieces are dust
CRACKS = 5
RUBBLE = Material(0.35, 0.35, rolling_resistance=0.05)  # light enough to be pushed all together
IRON = Material(1.2, 0.6, rolling_resistance=0.08)
WAITING, CARRIED, THROWN, GONE = "waiting", "carried", "thrown", "gone"


class Bomb:
    """`phase`: it waits at its place, is carried, flies and rolls with its fuse lit, or is gone for a moment."""

    kind = "bomb"

    def __init__(self, world, thing):
        self.world, self.thing = world, thing
        self.home = (thing.x + thing.width / 2, thing.y + thing.height - RADIUS)
        self.place = self.home
        self.body: Body | None = None
        self.phase, self.count = WAITING, 0

    def _begin(self, phase):
        self.phase, self.count = phase, 0

    def is_reached(self, box):
        """Whether the hero's box is where it waits."""
        x, y = self.home
        return box[0] - RADIUS < x < box[2] + RADIUS and box[1] < y < box[3] + RADIUS

    def take(self):
        """In the hero's hands from now on."""
        self._begin(CARRIED)

    def carry(self, place):
        """The hero is at a place [px]. Returns whether it was carried too far and is back."""
        self.place = (place[0], place[1] - ABOVE)
        if hypot(place[0] - self.home[0], place[1] - self.home[1]) < LEFT_BEHIND:
            return False
        self.go_home()
        return True

    def throw(self, way, speed, down):
        """It leaves the hero's hands, its fuse lit. way: -1, 1; speed: the hero's along x; down: it is only laid."""
        ahead, up = DROPPED if down else THROW
        self.body = self.world.add_body(
            Circle(RADIUS),
            position=self.place,
            velocity=(ahead * way + (0.0 if down else LENT * speed), up),
            angular_velocity=6.0 * way,
            filter=BOMB_FILTER,
            material=IRON,
            continuous="toi",
            user="bomb",
        )
        self._begin(THROWN)

    def step(self, lowest):
        """One step. lowest [px]: below it nothing is seen. Returns "burst", "back" or None."""
        self.count += 1
        if self.phase == THROWN and self.body is not None:
            self.place = tuple(self.body.position)
            if self.count >= steps(BURNS) or self.place[1] > lowest:
                self.world.remove_body(self.body)
                self.body = None
                self._begin(GONE)
                return "burst"
        elif self.phase == GONE and self.count >= steps(BACK):
            self.go_home()
            return "back"
        return None

    def go_home(self):
        """It waits at its place again."""
        if self.body is not None:
            self.world.remove_body(self.body)
            self.body = None
        self.place = self.home
        self._begin(WAITING)

    def state(self):
        """What the world does not hold of it."""
        return self.phase, self.count, *self.place


def arc(place, way, speed, down):
    """Where a bomb thrown now would be, every third step [px], until anything is in its way."""
    ahead, up = DROPPED if down else THROW
    vx = ahead * way + (0.0 if down else LENT * speed)
    for number in range(3, steps(BURNS), 3):
        time = number / 60
        yield place[0] + vx * time, place[1] - ABOVE + up * time + GRAVITY * time * time / 2


@dataclass(frozen=True)
class Rubble:
    """A loose piece of a wall; `left`, `top` [px]: where its raster begins in the wall's picture."""

    body: Body
    wall: "BlastWall"
    left: int
    top: int

    @property
    def box(self):
        """Left, top, right, bottom in whole pixels around it."""
        left, top, right, bottom = cast(tuple[float, float, float, float], self.body.bounds)
        return floor(left), round(top), ceil(right), round(bottom)

    def slides(self, way):
        """Whether it moved that way (-1, 1) in the last step: the hero who pushes it goes on."""
        return self.body.velocity.x * way > 0.0


class BlastWall:
    """`body`: the mask that still stands, or None."""

    def __init__(self, world, thing):
        self.world, self.left, self.top = world, int(thing.x), int(thing.y)
        self.size = (int(thing.width), int(thing.height))
        self.body: Body | None = world.add_body(
            PixelMask.from_surface(built(*self.size), origin=(0, 0)),
            position=(self.left, self.top),
            kind="static",
            filter=TILE_FILTER,
            material=RUBBLE,
            user="blast_wall",
        )

    @property
    def box(self):
        """Left, top, right, bottom of what stands; nothing once it is down."""
        if self.body is None:
            return (0, 0, 0, 0)
        return self.left, self.top, self.left + self.size[0], self.top + self.size[1]

    def blast(self, x, y):
        """A bomb bursts at a place [px]. Returns the Rubble that comes loose, and whether anything was hit."""
        if self.body is None:
            return [], False
        hit = self.body.carve(Circle(CRATER), (x, y), CRUMB)
        loose = list(hit.fragments)
        if hit.removed >= DEEP and self.body in self.world:
            loose += self.body.carve(self._cracks(x, y), (self.left, self.top), CRUMB).fragments
            if self.body in self.world:
                self.body.set_kind("dynamic")
                loose.append(self.body)
            self.body = None
        elif self.body not in self.world:
            self.body = None
        return [self._rubble(body) for body in loose], hit.removed > 0

    def _rubble(self, body):
        (mask,), (x, y) = body.shapes, body.position
        body.filter, body.user = CRATE_FILTER, "rubble"
        return Rubble(body, self, round(x - mask.origin[0]) - self.left, round(y - mask.origin[1]) - self.top)

    def _cracks(self, x, y):
        """Lines that fan out from the burst, and some across them."""
        random, (width, height) = self.world.random, self.size
        solid = np.zeros((height, width), bool)
        at = (min(max(x - self.left, 0.0), width), min(max(y - self.top, 0.0), height))
        for number in range(CRACKS):
            draw_crack(solid, at, pi * (number + random.uniform(0.2, 0.8)) / CRACKS, random)
        for share in np.arange(16.0, height, 18.0).tolist():
            draw_crack(solid, (width / 2, share + random.uniform(-4.0, 4.0)), random.uniform(-0.4, 0.4), random)
        return PixelMask(solid, (0, 0))


@lru_cache(maxsize=8)
def built(width, height):
    """The picture of a wall of a size, laid of the drawn one."""
    image = load_atlas("things")["blast_wall"]
    out = pygame.Surface((width, height), pygame.SRCALPHA)
    for left in range(0, width, image.get_width()):
        for top in range(0, height, image.get_height()):
            out.blit(image, (left, top))
    return out


def shove(body, x, y):
    """What a burst at a place [px] does to a body: the nearer and the lighter, the harder it is thrown."""
    dx, dy = body.center.x - x, body.center.y - y
    far = hypot(dx, dy)
    if far >= REACH:
        return
    speed = SHOVE * (1.0 - far / REACH) * min(1.0, HEAVIEST / body.mass)
    body.velocity += (speed * dx / max(far, 1.0), speed * (dy / max(far, 1.0) - 0.5))
