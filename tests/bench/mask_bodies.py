"""Masks that collide, compared with boxes: pairs of crates at rest and new pairs, and a crater in a large terrain."""

import gc
from time import perf_counter

import numpy as np
import pygame

from physics import Circle, Effects, PixelMask, Polygon, World
from physics.collision.narrow_phase import no_work
from tests.bench.timing import best_of, table

SIDE, GAP = 32, 80  # [px] of a crate; from crate to crate
WIDTH, HEIGHT, DEPTH = 4096, 1024, 420.0  # [px] of the terrain, and where its surface is
RADIUS, CARVES, SEED = 24.0, 150, 5
PILE = Effects.rigid_bodies().with_(sleeping=False)


def crates(shape, count):
    """Return a world of `count` crates, each at rest on a slab of the same shape."""
    world = World(PILE)
    for k in range(count):
        world.add_body(shape, position=(GAP * k, SIDE), kind="static")
        world.add_body(shape, position=(GAP * k, 0.0))
    for _ in range(120):
        world.step()
    return world


def pair_times(shape, count):
    """Return the times of a pair of crates [s], each divided by the number of pairs.

    They are (narrow phase at rest, narrow phase of a new pair, whole step at rest).
    """
    world = crates(shape, count)

    def narrow():
        world.step()
        return world.profile.stages["narrow_phase"]

    resting = min(narrow() for _ in range(60))
    step = best_of(60, world.step)
    candidates = world.pairs.rows.astype(np.int64)
    library, collide = world.library, world.workspace.narrow.collide
    margin, work = 4.0 * world.tolerances.slop, no_work()
    new = best_of(60, lambda: collide(library, world.bodies, world.shapes, candidates, margin, work))
    return resting / count, new / count, step / count


def hills():
    """Return the pixels solid[row, col] of ground with caves."""
    x, y = np.arange(WIDTH), np.arange(HEIGHT)[:, None]
    solid = y > DEPTH + 90.0 * np.sin(x / 210.0) + 40.0 * np.sin(x / 47.0) + 6.0 * np.sin(x / 5.0)
    for left, top, radius in ((500, 700, 60), (1500, 800, 90), (2500, 650, 70)):
        solid &= (x - left) ** 2 + (y - top) ** 2 > radius * radius
    return solid


def carve_times(count):
    """Return the time of making the ground [s], and two lists of times of a carve [s].

    Discs are carved along the surface of the ground. The first list has the carves that leave it in one piece, the
    second the carves that split it.
    """
    world, rng = World(Effects.rigid_bodies().with_(carving=True)), np.random.default_rng(SEED)
    solid = hills()
    start = perf_counter()
    ground = world.add_body(PixelMask(solid, (0, 0)), kind="static")
    made = perf_counter() - start
    whole, split = [], []
    gc.collect()
    gc.freeze()  # as games do once they are loaded
    try:
        for k in range(count + 20):
            x = int(rng.integers(100, WIDTH - 100))
            (mask,) = ground.shapes
            assert isinstance(mask, PixelMask)
            y = int(np.argmax(mask.solid[:, x]))
            start = perf_counter()
            carved = ground.carve(Circle(RADIUS), (float(x), float(y)))
            taken = perf_counter() - start
            if k >= 20:
                (split if carved.fragments else whole).append(taken)
            world.step()
    finally:
        gc.unfreeze()
    return made, whole, split


def pygame_carve_time(count):
    """Return the median time in which pygame erases a disc from a Mask and finds its connected pieces [s]."""
    rng = np.random.default_rng(SEED)
    side = int(2.0 * RADIUS)
    surface = pygame.Surface((side, side), pygame.SRCALPHA)
    pygame.draw.circle(surface, "white", (RADIUS, RADIUS), RADIUS)
    disc, solid = pygame.mask.from_surface(surface), hills()
    opaque = np.repeat(np.where(solid, 255, 0).astype(np.uint8)[:, :, None], 4, axis=2)
    ground = pygame.mask.from_surface(pygame.image.frombytes(opaque.tobytes(), (WIDTH, HEIGHT), "RGBA"))
    assert ground.count() == int(solid.sum()), "not the same ground"
    taken = []
    for _ in range(count):
        x = int(rng.integers(100, WIDTH - 100))
        start = perf_counter()
        ground.erase(disc, (x - side // 2, int(np.argmax(solid[:, x])) - side // 2))
        ground.connected_components()
        taken.append(perf_counter() - start)
    return float(np.median(taken))


def run(quick=False):
    """Print the tables. Return {name: ratio of two times}.

    The names say which two: masks and boxes, a carve and making the ground, or a carve and the same in pygame.
    """
    count = 50 if quick else 200
    times = {
        name: pair_times(shape, count)
        for name, shape in (("boxes", Polygon.box(SIDE, SIDE)), ("masks", PixelMask(np.ones((SIDE, SIDE), bool))))
    }
    rows = [(name, *(f"{each * 1e6:.2f}" for each in found)) for name, found in times.items()]
    table(f"{count} pairs of {SIDE} px crates, one on the other", ("us a pair", "at rest", "new", "whole step"), rows)
    made, whole, split = carve_times(30 if quick else CARVES)
    rows = [
        (name, len(some), *(f"{np.quantile(some, share) * 1e3:.2f}" for share in (0.0, 0.5, 0.9)))
        for name, some in (("no split", whole), ("with pieces", split))
        if some
    ]
    title = f"A disc of radius {RADIUS:.0f} px carved out of {WIDTH} x {HEIGHT} px (made in {made * 1e3:.0f} ms)"
    table(title, ("ms", "carves", "least", "median", "9 of 10"), rows)
    ratios = {
        f"pair of mask crates {name} / of boxes": mask / box
        for name, mask, box in zip(("at rest", "new", "in a step"), times["masks"], times["boxes"], strict=True)
    }
    theirs = pygame_carve_time(10 if quick else 40)
    print(f"pygame's Mask.erase and connected_components: {theirs * 1e3:.2f} ms")
    carve = float(np.median(whole))
    return ratios | {
        "carve of a terrain / making it": carve / made,
        "carve of a terrain / pygame's erase": carve / theirs,
    }
