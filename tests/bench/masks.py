"""2,000 sprites of 24 to 64 px: pygame's mask collision methods and Hitbox in one run; equal hits are asserted.

All sprites move about a pixel per frame and turn back at the border, so the density stays the same. The time of Hitbox
is that of a whole step: motion, broad phase, masks, contacts and events. It is a mean over many steps, because the
broad phase does not search for pairs in each of them.
"""

from functools import partial
from time import perf_counter

import numpy as np
import pygame

from game.report.charts.peers import measure_sprites
from game.report.pygame_sprites import BEST, MOVE, RECIPE, STEP, group_of, hits_after_rects, hits_of_groupcollide
from physics import BruteForce, DynamicTree, Effects, PixelMask, SpatialHashGrid, SweepAndPrune, World
from tests.bench import mask_bodies, verdicts
from tests.bench.timing import best_in_turns, best_of, table

SPRITES, FIELD, SEED = 2000, 1380, 7
STEPS = 32  # of which a figure of ours is the mean: two rounds of rectangles that reach ahead


def sprite_images(rng, count):
    """Return surfaces of random airplanes (a body, wings and a tail) with alpha."""
    found = []
    for _ in range(count):
        width, height = (int(v) for v in rng.integers(24, 65, 2))
        image = pygame.Surface((width, height), pygame.SRCALPHA)
        pygame.draw.ellipse(image, (200, 200, 220), (width * 0.36, 0, width * 0.28, height))
        pygame.draw.polygon(
            image, (90, 120, 220), [(width / 2, height * 0.3), (0, height * 0.75), (width - 1, height * 0.75)]
        )
        pygame.draw.polygon(
            image, (220, 90, 60), [(width / 2, height * 0.7), (width * 0.2, height - 1), (width * 0.8, height - 1)]
        )
        found.append(image)
    return found


class Field:
    """The same moving sprites for pygame and for Hitbox worlds."""

    def __init__(self, count):
        rng = np.random.default_rng(SEED)
        field = FIELD * (count / SPRITES) ** 0.5
        images = sprite_images(rng, 60)
        masks = [pygame.mask.from_surface(each) for each in images]
        self.shapes = [PixelMask.from_surface(each) for each in images]
        self.which = list(map(int, rng.integers(0, len(images), count).flat))
        self.corners = rng.integers(0, int(field), (count, 2))
        self.velocities = rng.uniform(-90.0, 90.0, (count, 2))
        self.rects = [
            images[kind].get_rect(topleft=(int(x), int(y)))
            for kind, (x, y) in zip(self.which, self.corners, strict=True)
        ]
        self.masks = [masks[kind] for kind in self.which]
        self.group = group_of(self.rects, self.masks)

    def world(self, strategy, effects):
        """Return a world with all sprites at rest."""
        world = World(effects, strategy)
        for kind, (x, y) in zip(self.which, self.corners, strict=True):
            origin = self.shapes[kind].origin
            world.add_body(self.shapes[kind], position=(x + origin[0], y + origin[1]), kind="kinematic")
        return world

    def turn_back(self, world):
        """Reverse the velocity of bodies that have left the field."""
        low, high = self.corners.min(axis=0), self.corners.max(axis=0) + 32.0
        for axis, (place, speed) in enumerate((("x", "vx"), ("y", "vy"))):
            at, towards = world.bodies[place], world.bodies[speed]
            towards[((at < low[axis]) & (towards < 0.0)) | ((at > high[axis]) & (towards > 0.0))] *= -1.0


def ways():
    """Return {name: (broad phase, effects, whether the contacts are read)} of the measured variants."""
    found = {each.name: (each, Effects(), False) for each in (SpatialHashGrid, DynamicTree, SweepAndPrune, BruteForce)}
    found["hash, contacts"] = (SpatialHashGrid, Effects(), True)
    return found | {"hash, contacts of outlines": (SpatialHashGrid, Effects(response=True), True)}


def pairs_of(found):
    """Return the set of (body_a, body_b) of contacts or manifolds."""
    return set(zip(found["body_a"].tolist(), found["body_b"].tolist(), strict=True))


def mean_step(field, world, read):
    """Return the mean time of a step [s] over STEPS steps. read: True reads the contacts of each step."""
    spent = 0.0
    for _ in range(STEPS):
        field.turn_back(world)
        start = perf_counter()
        world.step()
        if read:
            _ = world.contacts
        spent += perf_counter() - start
    return spent / STEPS


def beside_the_best(count):
    """Print the frame times of the sprites of chart 14, which move by whole pixels.

    Return {name: time / time of the best pygame program}. count: number of sprites.
    """
    times = {row["series"]: row["cost"]["seconds"][1] for row in measure_sprites(count)}
    table(
        f"{count} sprites moved by whole pixels: a frame with its motion, every pair that shares a pixel",
        ("per frame", "ms", "x the best pygame program"),
        [(name, f"{spent * 1e3:.2f}", f"{times[BEST] / spent:.2f}") for name, spent in times.items()],
    )
    return {
        f"{count} sprites, {name.removeprefix('ours: ')} / the best pygame program": times[name] / times[BEST]
        for name in (STEP, MOVE, RECIPE)
    }


def run(quick=False):
    """Print the tables. Return {name: time of Hitbox / time of pygame}, and the ratios of two more benchmarks of
    masks.
    """
    pygame.init()
    count = 500 if quick else SPRITES
    field = Field(count)
    truth = hits_after_rects(field.rects, field.masks)
    kept = []
    slow = best_of(2, lambda: kept.append(hits_of_groupcollide(field.group)))
    assert kept[0] == truth, f"groupcollide finds {len(kept[0])} hits, collidelistall {len(truth)}"
    pairs, timed = 0, {"collidelistall": partial(best_of, 1, partial(hits_after_rects, field.rects, field.masks))}
    for name, (strategy, effects, read) in ways().items():
        world = field.world(strategy(), effects)
        world.step()
        if read:
            # Outlines meet who shares no pixel, too; the area is the pixels' verdict.
            assert pairs_of(world.contacts[world.contacts["area"] > 0.0]) == truth, f"{name}: not pygame's {len(truth)}"
        else:
            assert pairs_of(world.reported_rows()) == truth, f"{name}: not pygame's {len(truth)} hits"
            pairs = max(pairs, len(world.candidates))
        world.bodies["vx"], world.bodies["vy"] = field.velocities.T
        timed[name] = partial(mean_step, field, world, read)
    times = best_in_turns(20, timed)
    fair = times.pop("collidelistall")
    table(
        f"{count} sprites of 24-64 px, {pairs} candidate pairs, {len(truth)} mask hits; all moving",
        ("per frame", "ms", "x collidelistall"),
        [
            ("groupcollide(collide_mask)", f"{slow * 1e3:.1f}", f"{fair / slow:.3f}"),
            ("collidelistall + Mask.overlap", f"{fair * 1e3:.2f}", "1.0"),
            *((f"ours, {name}", f"{least * 1e3:.2f}", f"{fair / least:.1f}") for name, least in times.items()),
        ],
    )
    print("Contacts: area, point, normal and depth as well, which pygame does not tell. Outlines: of what pushes.")
    ratios = {f"{count} sprites, {name} / collidelistall": least / fair for name, least in times.items()}
    for number in (300,) if quick else (300, SPRITES):
        ratios |= beside_the_best(number)
    ratios |= {f"{count} sprites, hash / groupcollide": times["hash"] / slow}
    return ratios | verdicts.run(quick) | mask_bodies.run(quick)
