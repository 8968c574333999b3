"""The ratio of chart 14 (best pygame program to a step of a world) timed again by another program, side by side.

    python -m tests.accuracy.independent_times

Of this project only the public API of `physics` is used, because it is what is timed. The sprites' motions, the pygame
program and the timing loop are written again here. Times differ from run to run and from machine to machine, so they
are printed and not tested; that both programs find the same hits is checked in every frame of the first round.
"""

import json
import sys
import time
from bisect import bisect_left
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
import pygame

from physics import Effects, PixelMask, World
from tests.accuracy.independent import ROOT, SPRITES, pixels

COUNTS = (300, 1000, 2000)  # sprites: the three points
SPACING, FASTEST, HALF = 30.0, 3, 16  # [px] of chart 14; frames in one direction
ROUNDS, DT = 5, 1.0 / 60.0
Hits = set[tuple[int, int]]


class Ratio(NamedTuple):
    """The ratio of one point: (low, middle, high) in docs/accuracy.json, and the ratio of the least times here."""

    count: int
    kept: tuple[float, float, float]
    here: float


def kept_ratio(count: int) -> tuple[float, float, float]:
    """Return the ratio (low, middle, high) of the best pygame program to a step of ours in docs/accuracy.json."""
    rows = json.loads((ROOT / "docs/accuracy.json").read_text(encoding="utf-8"))["rows"]["peers"]
    times = {row["series"]: row["cost"]["seconds"] for row in rows if row["panel"] == "sprites" and row["n"] == count}
    a, b = times["pygame: sorted along x"], times["ours: step"]
    return a[0] / b[2], a[1] / b[1], a[2] / b[0]


class Sky:
    """The moving sprites: `places[frame]` (n, 2) are their whole top left corners [px], in 2 * HALF closed frames."""

    def __init__(self, count: int) -> None:
        chance = np.random.default_rng(99)
        self.which = chance.integers(0, len(SPRITES), count)
        self.speed = chance.integers(-FASTEST, FASTEST + 1, (count, 2))
        start = chance.integers(0, int(SPACING * count**0.5), (count, 2))
        legs = [*range(HALF), *range(HALF, 0, -1)]
        self.places = [start + leg * self.speed for leg in legs]

    def in_pygame(self) -> Callable[[int], Hits]:
        """Return a function of the frame: the pairs that share a pixel, by sorted rectangles and Mask.overlap."""
        kinds = [pygame.Mask(pixels(name).shape[::-1]) for name in SPRITES]
        for mask, name in zip(kinds, SPRITES, strict=True):
            for y, x in np.argwhere(pixels(name)).tolist():
                mask.set_at((x, y))
        masks = [kinds[kind] for kind in self.which]
        places = [list(map(tuple, frame.tolist())) for frame in self.places]
        rects = [pygame.Rect(at, mask.get_size()) for at, mask in zip(places[0], masks, strict=True)]

        def play(frame: int) -> Hits:
            for rect, at in zip(rects, places[frame], strict=True):
                rect.topleft = at
            ranked = sorted(range(len(rects)), key=lambda k: rects[k].x)
            row, found = [rects[k] for k in ranked], set()
            edges = [rect.x for rect in row]
            for i, rect in enumerate(row):
                for hit in rect.collidelistall(row[i + 1 : bisect_left(edges, rect.right, i + 1)]):
                    a, b = ranked[i], ranked[i + 1 + hit]
                    if masks[a].overlap(masks[b], (rects[b].x - rect.x, rects[b].y - rect.y)):
                        found.add((min(a, b), max(a, b)))
            return found

        return play

    def in_a_world(self) -> tuple[Callable[[int], None], Callable[[], Hits]]:
        """Return two functions: step(frame) moves the sprites to a frame and steps a world, hits() reads its pairs."""
        shapes = [PixelMask(pixels(name), origin=(0, 0)) for name in SPRITES]
        world = World(Effects.detection(), "hash")
        for kind, at in zip(self.which.tolist(), self.places[0].tolist(), strict=True):
            world.add_body(shapes[kind], position=at, kind="kinematic", tier="pixels")
        first = int(world.bodies["id"][0])

        def step(frame: int) -> None:
            if frame % HALF == 1:
                forth = 1.0 if frame == 1 else -1.0
                world.bodies["vx"], world.bodies["vy"] = (forth * self.speed / DT).T
            world.step(DT)

        return step, lambda: set(map(tuple, (world.touching() - first).tolist()))


def ratio_here(count: int, rounds: int = ROUNDS) -> float:
    """Return the least time of a round by pygame, divided by that of the world. Raises ValueError for other hits."""
    sky = Sky(count)
    play, (step, hits) = sky.in_pygame(), sky.in_a_world()
    frames = [*range(1, 2 * HALF), 0]
    for frame in frames:
        step(frame)
        if hits() != play(frame):
            raise ValueError(f"frame {frame} of {count} sprites: the world's hits are not those of pygame")
    spent = {play: [], step: []}
    for _ in range(rounds):
        for way, seconds in spent.items():
            began = time.process_time()
            for frame in frames:
                way(frame)
            seconds.append(time.process_time() - began)
    return min(spent[play]) / min(spent[step])


def ratios() -> Iterator[Ratio]:
    """Yield the Ratio of each number of sprites in COUNTS."""
    for count in COUNTS:
        yield Ratio(count, kept_ratio(count), ratio_here(count))


def main() -> None:
    """Print the three ratios."""
    for count, (low, middle, high), here in ratios():
        kept = f"{middle:.2f} x ({low:.2f} to {high:.2f}) in the report"
        sys.stdout.write(f"{count} sprites, best pygame program to a step of ours: {kept}, {here:.2f} x here\n")


if __name__ == "__main__":
    main()
