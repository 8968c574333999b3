"""Moving sprites for chart 14: pygame programs that find the sprites that share a pixel, and worlds that do the same.

Every program plays the same frames. Each sprite moves back and forth by whole pixels, because pygame compares whole
pixels. A frame includes moving the sprites and finding all hits.
"""

from abc import ABC, abstractmethod
from bisect import bisect_left
from collections.abc import Callable, Iterator
from itertools import cycle
from typing import Any, NamedTuple

import numpy as np
import pygame

from game.drawing.sprites import load_atlas
from physics import DynamicTree, Effects, PixelMask, SpatialHashGrid, World
from physics.annotations import TierName

SPRITES = ("player", "saucer_0", "gunship_0")
SPACING = 30.0  # [px] mean distance of sprites: about one overlap each
FASTEST = 3  # [px] greatest motion of a sprite in a frame, on each axis
WAY = 16  # frames in one direction
FRAMES = 2 * WAY  # there and back
DT = 1.0 / 60.0  # [s]

Hits = set[tuple[int, int]]  # pairs of indices of sprites, the lower one first


class Traffic:
    """The moving sprites, equal for every program. count: number of sprites.

    positions: FRAMES lists, one for each frame, of the top left corners (x, y) of all sprites [px]. In frame 0 the
    sprites are at one end of their paths. The paths are closed.
    """

    def __init__(self, count: int) -> None:
        atlas, chance = load_atlas("planes"), np.random.default_rng(6)
        self.count, self.which = count, chance.integers(0, len(SPRITES), count).tolist()
        starts = chance.integers(0, int(SPACING * count**0.5), (count, 2))
        self.motions = chance.integers(-FASTEST, FASTEST + 1, (count, 2))
        steps = [min(frame, FRAMES - frame) for frame in range(FRAMES)]
        self.arrays = [(starts + step * self.motions).astype(float) for step in steps]
        self.positions = [[(int(x), int(y)) for x, y in each] for each in self.arrays]
        self.kinds = [PixelMask(atlas.mask(name).solid, origin=(0, 0)) for name in SPRITES]
        masks = [mask_in_pygame(kind) for kind in self.kinds]
        self.masks = [masks[k] for k in self.which]

    def truth(self, frame: int) -> Hits:
        """Return the pairs of sprites that share a pixel in a frame. All pairs are tested, without rectangles."""
        masks, at = self.masks, self.positions[frame]
        return {
            (k, j)
            for k, (x, y) in enumerate(at)
            for j in range(k + 1, self.count)
            if masks[k].overlap(masks[j], (at[j][0] - x, at[j][1] - y))
        }


def mask_in_pygame(mask: PixelMask) -> pygame.Mask:
    """Return a PixelMask as a pygame Mask."""
    made = pygame.Mask(mask.solid.shape[::-1])
    for y, x in np.argwhere(mask.solid).tolist():
        made.set_at((x, y))
    return made


def hits_after_rects(rects: list[pygame.Rect], masks: list[pygame.Mask]) -> Hits:
    """Return the pairs of sprites that share a pixel: collidelistall for each rectangle, then Mask.overlap."""
    found = set()
    for k, (rect, mask) in enumerate(zip(rects, masks, strict=True)):
        for j in rect.collidelistall(rects):
            if j > k and mask.overlap(masks[j], (rects[j].x - rect.x, rects[j].y - rect.y)):
                found.add((k, j))
    return found


class Sprite(pygame.sprite.Sprite):
    """A sprite with the attributes that pygame's collision functions need. place: index of the sprite."""

    def __init__(self, place: int, mask: pygame.Mask, rect: pygame.Rect) -> None:
        super().__init__()
        self.place, self.mask, self.rect = place, mask, rect


def group_of(rects: list[pygame.Rect], masks: list[pygame.Mask]) -> Any:
    """Return a pygame Group of new Sprites with these rectangles and masks."""
    return pygame.sprite.Group(*(Sprite(k, *each) for k, each in enumerate(zip(masks, rects, strict=True))))


def hits_of_groupcollide(group: Any) -> Hits:
    """Return the pairs of sprites in a group that share a pixel, found with groupcollide and collide_mask.

    Tutorials find hits in this way.
    """
    collide: Any = pygame.sprite.collide_mask  # the stubs ask for a bool; it returns a point or None
    hits: Any = pygame.sprite.groupcollide(group, group, False, False, collide)
    return {(a.place, b.place) for a, others in hits.items() for b in others if a.place < b.place}


# ---- programs --------------------------------------------------------------------------------------------------------


class Program(ABC):
    """Base class of programs that play the frames of a Traffic. Each call of play() plays one frame.

    The first call plays frame 1. hits: the pairs that share a pixel in the last frame, in the program's own form;
    found(): the same pairs as Hits.
    """

    def __init__(self, traffic: Traffic) -> None:
        self.traffic, self.frames = traffic, cycle([*range(1, FRAMES), 0])
        self.hits: Any = set()

    @abstractmethod
    def play(self) -> None:
        """Move the sprites to their positions in the next frame, and find the hits."""

    def found(self) -> Hits:
        """Return the hits of the last frame as Hits, a set of pairs of sprite indices."""
        return self.hits


class Plain(Program):
    """The usual exact pygame program: collidelistall for each rectangle, then Mask.overlap."""

    def __init__(self, traffic: Traffic) -> None:
        super().__init__(traffic)
        self.rects = [
            pygame.Rect(at, mask.get_size()) for at, mask in zip(traffic.positions[0], traffic.masks, strict=True)
        ]

    def play(self) -> None:
        for rect, at in zip(self.rects, self.traffic.positions[next(self.frames)], strict=True):
            rect.topleft = at
        self.hits = self.test()

    def test(self) -> Hits:
        """Return the pairs of sprites that share a pixel at their present positions."""
        return hits_after_rects(self.rects, self.traffic.masks)


class RectsOnly(Plain):
    """The simplest program of many games: each pair of sprites whose rectangles overlap is a hit."""

    def test(self) -> Hits:
        rects = self.rects
        return {(k, j) for k, rect in enumerate(rects) for j in rect.collidelistall(rects) if j > k}


class Sorted(Plain):
    """The best pygame program that we know: sweep and prune in Python.

    The sprites are sorted by their left edges. Each sprite is tested only against those that follow it in this order
    and whose left edge is left of its right edge. Source of the method: Cohen et al., I-COLLIDE, 1995.
    """

    def test(self) -> Hits:
        rects, masks, found = self.rects, self.traffic.masks, set()
        order = sorted(range(len(rects)), key=[rect.left for rect in rects].__getitem__)
        ranked = [rects[k] for k in order]
        lefts = [rect.left for rect in ranked]
        for place, k in enumerate(order, 1):
            rect, mask = rects[k], masks[k]
            end = bisect_left(lefts, rect.right, place)
            if end == place:
                continue
            for hit in rect.collidelistall(ranked[place:end]):
                j = order[place + hit]
                other = rects[j]
                if mask.overlap(masks[j], (other.x - rect.x, other.y - rect.y)):
                    found.add((k, j) if k < j else (j, k))
        return found


class GroupCollide(Plain):
    """The program of tutorials: pygame.sprite.groupcollide with collide_mask."""

    def __init__(self, traffic: Traffic) -> None:
        super().__init__(traffic)
        self.group = group_of(self.rects, traffic.masks)

    def test(self) -> Hits:
        return hits_of_groupcollide(self.group)


# ---- worlds ----------------------------------------------------------------------------------------------------------


class Stepped(Program):
    """A world whose step moves the sprites by their velocities and finds the hits as contacts.

    play() does not read the hits; found() does. tested: pairs that the world's broad phase has tested so far.
    """

    def __init__(self, traffic: Traffic, strategy: Any, tier: TierName) -> None:
        super().__init__(traffic)
        self.tested = 0
        self.world = World(Effects.detection(), strategy)
        self.ids = np.array(
            [
                self.world.add_body(traffic.kinds[k], position=at, kind="kinematic", tier=tier).id
                for k, at in zip(traffic.which, traffic.positions[0], strict=True)
            ]
        )

    def play(self) -> None:
        frame = next(self.frames)
        if frame in (1, WAY + 1):  # the sprites turn
            speeds = self.traffic.motions / DT * (1.0 if frame == 1 else -1.0)
            self.world.bodies["vx"], self.world.bodies["vy"] = speeds.T
        self.world.step(DT)
        self.tested += self.world.profile.counters["pairs_tested"]

    def found(self) -> Hits:
        pairs = self.world.touching() - self.ids[0]
        return set(map(tuple, np.sort(pairs, axis=1).tolist()))


class Moved(Stepped):
    """A world whose sprites are moved by one call with an array of positions. The hits are read as pairs of ids."""

    def play(self) -> None:
        self.world.move(self.ids, self.traffic.arrays[next(self.frames)])
        self.world.step()
        self.hits = self.world.touching()
        self.tested += self.world.profile.counters["pairs_tested"]


class Recipe(Plain):
    """The recipe of docs/physics_alone.md: a rectangle and a body per sprite, and three lines of code per frame."""

    def __init__(self, traffic: Traffic) -> None:
        super().__init__(traffic)
        self.world, self.tested = World(Effects.detection()), 0
        self.bodies = [
            self.world.add_body(traffic.kinds[kind], position=rect.topleft, user=k)
            for k, (kind, rect) in enumerate(zip(traffic.which, self.rects, strict=True))
        ]

    def test(self) -> Hits:
        self.world.move(self.bodies, [rect.topleft for rect in self.rects])
        self.world.step()
        found = set(self.world.touching(users=True))
        self.tested += self.world.profile.counters["pairs_tested"]
        return found


class Way(NamedTuple):
    """A way to find the hits among sprites.

    make(traffic): function that returns a Program for a Traffic. most: greatest number of sprites with which the way is
    measured.
    """

    make: Callable[[Traffic], Program]
    most: int


PLAIN, BEST = "pygame: Rect, then Mask", "pygame: sorted along x"
STEP, BOXES = "ours: step", "ours: step, boxes"
MOVE, RECIPE = "ours: move, step, touching", "ours: the docs' recipe"
MANY, FEW = 10**6, 300
WAYS = {
    "pygame: Rect": Way(RectsOnly, MANY),
    PLAIN: Way(Plain, MANY),
    BEST: Way(Sorted, MANY),
    "pygame: groupcollide": Way(GroupCollide, FEW),  # a second a frame with 2,000 sprites
    STEP: Way(lambda traffic: Stepped(traffic, SpatialHashGrid(), "pixels"), MANY),
    MOVE: Way(lambda traffic: Moved(traffic, SpatialHashGrid(), "pixels"), MANY),
    RECIPE: Way(Recipe, MANY),
    BOXES: Way(lambda traffic: Stepped(traffic, SpatialHashGrid(), "aabb"), MANY),
    "ours: step, tree": Way(lambda traffic: Stepped(traffic, DynamicTree(), "pixels"), MANY),
    "ours: step, outline": Way(lambda traffic: Stepped(traffic, SpatialHashGrid(), "outline"), MANY),
}


def programs(traffic: Traffic) -> Iterator[tuple[str, Program]]:
    """Yield (name of the way, new Program) for each way to find the hits of `traffic`.

    A way that is too slow for this number of sprites is omitted (see Way.most).
    """
    for name, way in WAYS.items():
        if traffic.count <= way.most:
            yield name, way.make(traffic)
