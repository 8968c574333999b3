"""A bomb, which the hero finds, carries and throws, and the walls of pixels that it blows open.

A wall is a mask: the burst carves its disc out of it, and cracks through the rest. Loose pieces are rubble, each with
the outline of its own pixels: it falls, comes to rest, and can be pushed and walked on.
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
ABOVE = 7.0  # [px] from the hero's middle up to where a bomb leaves his hands: inside him, where the space is free
THROW, DROPPED = (205.0, -330.0), (36.0, -40.0)  # [px/s] ahead and up; with down held the bomb is laid down
LENT = 0.4  # share of the hero's own speed that a thrown bomb keeps
BURNS = 1.25  # [s] from the throw to the burst
BACK = 1.6  # [s] until another one appears at its place
LEFT_BEHIND = 420.0  # [px] a bomb carried farther than this is taken back
CRATER, REACH = 27.0, 62.0  # [px] radius of the carved disc, and of the push
SHOVE = 260.0  # [px/s] change of velocity of the nearest bodies
HEAVIEST = 200.0  # [density px2] from which on bodies are pushed less
DEEP = 260  # pixels removed from a wall from which all of it gives way
CRUMB = 12  # [px] smaller pieces are dust
CRACKS = 5
RUBBLE = Material(0.35, 0.35, rolling_resistance=0.05)  # low enough that all of it can be pushed together
IRON = Material(1.2, 0.6, rolling_resistance=0.08)
WAITING, CARRIED, THROWN, GONE = "waiting", "carried", "thrown", "gone"


class Bomb:
    """A bomb. `phase`: it waits at its place, is carried, flies and rolls with its fuse lit, or is gone for a
    moment.
    """

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
        """Return whether the hero's box touches its place."""
        x, y = self.home
        return box[0] - RADIUS < x < box[2] + RADIUS and box[1] < y < box[3] + RADIUS

    def take(self):
        """Put it into the hero's hands."""
        self._begin(CARRIED)

    def carry(self, place):
        """Move it with the hero to a place [px]. Return whether it was carried too far and went back."""
        self.place = (place[0], place[1] - ABOVE)
        if hypot(place[0] - self.home[0], place[1] - self.home[1]) < LEFT_BEHIND:
            return False
        self.go_home()
        return True

    def throw(self, way, speed, down):
        """Throw it with its fuse lit. way: -1, 1; speed: the hero's along x; down: it is only laid down."""
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
        """Make one step. lowest [px]: the lowest visible place. Return "burst", "back" or None."""
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
        """Put it back to its place."""
        if self.body is not None:
            self.world.remove_body(self.body)
            self.body = None
        self.place = self.home
        self._begin(WAITING)

    def state(self):
        """Return the state outside the world."""
        return self.phase, self.count, *self.place


def arc(place, way, speed, down):
    """Return the path of a bomb thrown now, every third step [px], up to the first obstacle."""
    ahead, up = DROPPED if down else THROW
    vx = ahead * way + (0.0 if down else LENT * speed)
    for number in range(3, steps(BURNS), 3):
        time = number / 60
        yield place[0] + vx * time, place[1] - ABOVE + up * time + GRAVITY * time * time / 2


@dataclass(frozen=True)
class Rubble:
    """A loose piece of a wall; `left`, `top` [px]: place of its raster in the wall's picture."""

    body: Body
    wall: "BlastWall"
    left: int
    top: int

    @property
    def box(self):
        """Left, top, right, bottom of its bounding box in whole pixels."""
        left, top, right, bottom = cast(tuple[float, float, float, float], self.body.bounds)
        return floor(left), round(top), ceil(right), round(bottom)

    def slides(self, way):
        """Return whether it moved that way (-1, 1) in the last step, so that the hero keeps pushing it."""
        return self.body.velocity.x * way > 0.0


class BlastWall:
    """A wall of pixels. `body`: the remaining mask, or None."""

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
        """Left, top, right, bottom of the remaining wall; all 0 once it is gone."""
        if self.body is None:
            return (0, 0, 0, 0)
        return self.left, self.top, self.left + self.size[0], self.top + self.size[1]

    def blast(self, x, y):
        """Carve a burst at a place [px]. Return the Rubble that comes loose, and whether the wall was hit."""
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
        """Return cracks that fan out from the burst, and some across them."""
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
    """Return the picture of a wall of a size, tiled from the drawn one."""
    image = load_atlas("things")["blast_wall"]
    out = pygame.Surface((width, height), pygame.SRCALPHA)
    for left in range(0, width, image.get_width()):
        for top in range(0, height, image.get_height()):
            out.blit(image, (left, top))
    return out


def shove(body, x, y):
    """Push a body by a burst at a place [px], the more the nearer and lighter it is."""
    dx, dy = body.center.x - x, body.center.y - y
    far = hypot(dx, dy)
    if far >= REACH:
        return
    speed = SHOVE * (1.0 - far / REACH) * min(1.0, HEAVIEST / body.mass)
    body.velocity += (speed * dx / max(far, 1.0), speed * (dy / max(far, 1.0) - 0.5))
