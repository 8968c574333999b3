"""Time of one overlap test of two masks without the rest of the step. Sprites of 32 px: a disc, a plane, random pixels.

Snapped masks are tested by an AND of words, others by the exact test. Hits and misses are timed separately.
"""

from time import perf_counter

import numpy as np
import pygame

from physics import PixelMask
from physics.collision.manifold import MASKS, MASKS_EXACT, Batch, new_workspace
from physics.collision.masks import collide_mask_pairs_hit
from physics.collision.masks_exact import collide_exact_mask_pairs_full, collide_exact_mask_pairs_hit
from physics.collision.narrow_phase import no_work
from physics.shapes.library import Library, place
from physics.shapes.placement import refresh_aabbs
from physics.tables.body import BODY
from physics.tables.contact import CONTACT
from physics.tables.shape import SHAPE
from tests.bench.timing import table

SIZE, RUNS, SEED = 32, 5, 11
NEAR = 2.0  # [px] a miss that is nearer is measured apart


def sprites():
    """Return {name: pixels solid[row, col]} of three sprites of 32 px."""
    y, x = np.mgrid[0:SIZE, 0:SIZE] + 0.5 - SIZE / 2
    plane = (abs(x) < 3) | (abs(y - 1) < 3) | ((y > 10) & (abs(x) < 8))
    return {
        "disc": x * x + y * y <= SIZE * SIZE / 4,
        "plane": plane,
        "ragged": np.random.default_rng(SEED).random((SIZE, SIZE)) < 0.6,
    }


class Pairs:
    """Pairs of a sprite with itself, in random order as in a world.

    solid: pixels of the sprite; where: poses (x, y, angle) of the second sprite relative to the first; snap: True for
    masks that are snapped to whole pixels. Their poses must have whole offsets and no rotation.
    """

    def __init__(self, solid, where, snap):
        rng, count = np.random.default_rng(SEED), len(where)
        self.library, self.bodies = Library(), np.zeros(2 * count, BODY)
        self.shapes, order = np.zeros(2 * count, SHAPE), rng.permutation(2 * count)
        masks = [PixelMask(solid, snap=snap), PixelMask(solid, snap=snap)]
        for number, pose in enumerate(where.tolist()):
            first = rng.uniform(-1000.0, 1000.0, 2)
            turn = 0.0 if snap else rng.uniform(0.0, 6.0)
            c, s = np.cos(turn), np.sin(turn)
            away = (first[0] + c * pose[0] - s * pose[1], first[1] + s * pose[0] + c * pose[1], turn + pose[2])
            for which, at in enumerate(((*first, turn), away)):
                place(self.library, masks[which], self.bodies, self.shapes, order[2 * number + which], at)
        refresh_aabbs(np.arange(2 * count), self.library.tables, self.bodies, self.shapes)
        self.candidates, self.found = order.reshape(-1, 2).astype(np.int64), np.zeros(count, CONTACT)
        self.kind = MASKS if snap else MASKS_EXACT

    def hits(self, run):
        """Test all pairs several times. Return (whether each pair overlaps, least, median time per pair [s]).

        run: function that tests a batch of pairs.
        """
        count, seconds = len(self.candidates), []
        kinds = np.full(count + 1, self.kind, np.int64)
        tables = self.library.tables
        batch = Batch(tables, self.bodies, self.shapes, self.candidates, kinds, count, 0.0, 0.0)
        workspace, work = new_workspace(), no_work()
        for _ in range(RUNS + 1):  # the first compiles
            start = perf_counter()
            found = run(batch, workspace, self.found, 0, work)
            seconds.append((perf_counter() - start) / count)
        met = np.zeros(count, bool)
        met[self.found["candidate"][:found]] = True
        return met, min(seconds[1:]), float(np.median(seconds[1:]))


def poses_around(rng, count):
    """Return (count, 3) poses (x, y, angle) at which two sprites of 32 px overlap, nearly overlap, or do not."""
    away, way = rng.uniform(8.0, 46.0, count), rng.uniform(0.0, 7.0, count)
    return np.stack([away * np.cos(way), away * np.sin(way), rng.uniform(0.0, 7.0, count)], axis=1)


def half_over(rng, count):
    """Return (count, 3) poses in whole pixels, without rotation, at which the boxes of two sprites overlap by about
    half.
    """
    return np.concatenate(
        [rng.choice([-1.0, 1.0], (count, 2)) * rng.integers(6, 14, (count, 2)), np.zeros((count, 1))], 1
    )


def is_near(solid, where):
    """Return for each pose whether the sprites overlap after a small move of the second one.

    It is moved by 1 and by 2 px in 16 directions.
    """
    near = np.zeros(len(where), bool)
    for way in np.arange(16) * np.pi / 8:
        for step in (0.5 * NEAR, NEAR):
            moved = where + (step * np.cos(way), step * np.sin(way), 0.0)
            near |= Pairs(solid, moved, snap=False).hits(collide_exact_mask_pairs_hit)[0]
    return near


def time_overlap(solid, where):
    """Return the least time of one call of pygame's Mask.overlap [s].

    where: poses of the second sprite; only their offsets are used, in whole pixels.
    """
    mask = pygame.mask.from_surface(pygame.Surface((SIZE, SIZE)), 255)
    for y, x in zip(*np.nonzero(solid), strict=True):
        mask.set_at((int(x), int(y)))
    offsets, least = [tuple(each) for each in where[:, :2].astype(int).tolist()], np.inf
    for _ in range(RUNS):
        start = perf_counter()
        for offset in offsets:
            mask.overlap(mask, offset)
        least = min(least, (perf_counter() - start) / len(offsets))
    return least


def run(quick=False):
    """Print the table. Return {name: time of a test / time of pygame's Mask.overlap for the same sprites}."""
    rng, count, rows, ratios = np.random.default_rng(SEED), 1000 if quick else 4000, [], {}
    for name, solid in sprites().items():
        half = half_over(rng, count)
        peer = time_overlap(solid, half)
        _, least, middle = Pairs(solid, half, snap=True).hits(collide_mask_pairs_hit)
        rows.append((f"{name}: AND, half over each other", count, f"{least * 1e6:.3f}", f"{middle * 1e6:.3f}"))
        ratios[f"AND of 32 px {name}s / Mask.overlap"] = least / peer
        where = poses_around(rng, count)
        met, _, _ = Pairs(solid, where, snap=False).hits(collide_exact_mask_pairs_hit)
        near = ~met & is_near(solid, where)
        for words, chosen in (("hit", met), ("miss within 2 px", near), ("miss", ~met & ~near)):
            some = np.resize(where[chosen], (count, 3))
            _, least, middle = Pairs(solid, some, snap=False).hits(collide_exact_mask_pairs_hit)
            rows.append((f"{name}: exact, {words}", chosen.sum(), f"{least * 1e6:.3f}", f"{middle * 1e6:.3f}"))
            ratios[f"exact {words} of 32 px {name}s / Mask.overlap"] = least / peer
        _, least, middle = Pairs(solid, np.resize(where[met], (count, 3)), False).hits(collide_exact_mask_pairs_full)
        rows.append((f"{name}: exact contact", met.sum(), f"{least * 1e6:.3f}", f"{middle * 1e6:.3f}"))
    table(f"One verdict of {SIZE} px sprites, {count} pairs", ("us", "poses", "least", "median"), rows)
    print("Exact: any angle, parts of pixels. A contact has area, point, normal and depth as well.")
    return ratios
