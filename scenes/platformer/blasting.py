"""Bombs, which the hero finds, carries and throws, and the walls that they break.

A wall is a pixel mask. An explosion carves a disc out of the mask, and may break the rest along cracks. Loose pieces
become rubble: dynamic bodies with the outline of their pixels. The hero can push rubble and walk on it.
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
ABOVE = 7.0  # [px] from the hero's middle up to the start of a thrown bomb: inside his box, where space is free
THROW, DROPPED = (205.0, -330.0), (36.0, -40.0)  # [px/s] velocity (ahead, y) of a bomb thrown, and of one laid down
LENT = 0.4  # share of the hero's own speed that a thrown bomb keeps
BURNS = 1.25  # [s] from the throw to the burst
BACK = 1.6  # [s] from the burst until a new bomb appears at its stand
LEFT_BEHIND = 420.0  # [px] a bomb carried farther than this is taken back
CRATER, REACH = 27.0, 62.0  # [px] radius of the carved disc, and of the push
SHOVE = 260.0  # [px/s] change of velocity of the nearest bodies
HEAVIEST = 200.0  # [density px2] heavier bodies get less than this change of velocity, in proportion to 1 / mass
DEEP = 260  # number of carved pixels from which the whole wall breaks
CRUMB = 12  # area in pixels: smaller pieces are removed
CRACKS = 5
RUBBLE = Material(0.35, 0.35, rolling_resistance=0.05)  # low enough that all of it can be pushed together
IRON = Material(1.2, 0.6, rolling_resistance=0.08)
WAITING, CARRIED, THROWN, GONE = "waiting", "carried", "thrown", "gone"


class Bomb:
    """A bomb of the platformer.

    phase: WAITING at its stand, CARRIED by the hero, THROWN with a burning fuse, or GONE from its explosion until a
    new bomb appears; count: number of steps in the current phase.
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
        """Return whether the hero's box (left, top, right, bottom) touches the bomb at its stand."""
        x, y = self.home
        return box[0] - RADIUS < x < box[2] + RADIUS and box[1] < y < box[3] + RADIUS

    def take(self):
        """Change the bomb's phase to CARRIED: from now on the hero carries it."""
        self._begin(CARRIED)

    def carry(self, place):
        """Move the carried bomb with the hero, whose position is `place` (x, y) [px].

        Return True if the hero is too far from the bomb's stand; then the bomb is moved back to the stand. Otherwise
        return False.
        """
        self.place = (place[0], place[1] - ABOVE)
        if hypot(place[0] - self.home[0], place[1] - self.home[1]) < LEFT_BEHIND:
            return False
        self.go_home()
        return True

    def throw(self, way, speed, down):
        """Throw the bomb and light its fuse.

        way: -1 to the left, 1 to the right; speed: the hero's speed along x [px/s]; down: True if the bomb is only
        laid down.
        """
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
        """Make one step of the bomb: update its position, fuse and phase.

        lowest: y [px] below which it explodes at once. Return "burst" when the bomb explodes, "back" when a new bomb
        appears at the stand, otherwise None.
        """
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
        """Move the bomb back to its stand."""
        if self.body is not None:
            self.world.remove_body(self.body)
            self.body = None
        self.place = self.home
        self._begin(WAITING)

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return self.phase, self.count, *self.place


def arc(place, way, speed, down):
    """Yield points (x, y) [px] of the free flight of a bomb that the hero throws: one point for every third step.

    place: the hero's position; way: -1 or 1; speed: the hero's speed along x [px/s]; down: whether the bomb is laid
    down. Obstacles are ignored.
    """
    ahead, up = DROPPED if down else THROW
    vx = ahead * way + (0.0 if down else LENT * speed)
    for number in range(3, steps(BURNS), 3):
        time = number / 60
        yield place[0] + vx * time, place[1] - ABOVE + up * time + GRAVITY * time * time / 2


@dataclass(frozen=True)
class Rubble:
    """A loose piece of a wall. left, top: position of its mask's upper left corner in the wall's picture [px]."""

    body: Body
    wall: "BlastWall"
    left: int
    top: int

    @property
    def box(self):
        """Bounding box (left, top, right, bottom) in integer pixels."""
        left, top, right, bottom = cast(tuple[float, float, float, float], self.body.bounds)
        return floor(left), round(top), ceil(right), round(bottom)

    def slides(self, way):
        """Return whether the piece moves towards `way` (-1 left, 1 right).

        While this is so, the hero who pushes it keeps his speed.
        """
        return self.body.velocity.x * way > 0.0


class BlastWall:
    """A wall that bombs can break. Its shape is a pixel mask. body: the part that still stands, or None if no part
    does.
    """

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
        """Box (left, top, right, bottom) [px] of the whole wall; all 0 once no part of it stands."""
        if self.body is None:
            return (0, 0, 0, 0)
        return self.left, self.top, self.left + self.size[0], self.top + self.size[1]

    def blast(self, x, y):
        """Carve the crater of an explosion at (x, y) [px] out of the wall. A deep crater breaks the whole wall.

        Return (list of the Rubble that has come loose, whether the wall was hit).
        """
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
        """Return a PixelMask of cracks that has the size of the wall.

        Some cracks run from (x, y) [px] in several directions; others run across the wall.
        """
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
    """Return a Surface of width x height [px], filled with copies of the wall's image in the atlas."""
    image = load_atlas("things")["blast_wall"]
    out = pygame.Surface((width, height), pygame.SRCALPHA)
    for left in range(0, width, image.get_width()):
        for top in range(0, height, image.get_height()):
            out.blit(image, (left, top))
    return out


def shove(body, x, y):
    """Push a body away from an explosion at (x, y) [px]. Nearer and lighter bodies get a greater change of velocity."""
    dx, dy = body.center.x - x, body.center.y - y
    far = hypot(dx, dy)
    if far >= REACH:
        return
    speed = SHOVE * (1.0 - far / REACH) * min(1.0, HEAVIEST / body.mass)
    body.velocity += (speed * dx / max(far, 1.0), speed * (dy / max(far, 1.0) - 0.5))
