"""2,000 sprites of 24 to 64 px: pygame's two ways of mask collision and ours, in one run, the same hits asserted.

All sprites move a pixel or so per frame. Ours is a whole step: motion, broad phase, masks, contacts, events.
"""

import numpy as np
import pygame

from physics import BruteForce, DynamicTree, Effects, PixelMask, SpatialHashGrid, SweepAndPrune, World
from tests.bench.timing import best_of, table

SPRITES, FIELD, SEED = 2000, 1380, 7


def sprite_images(rng, count):
    """Ragged planes: a body, wings and a tail, as surfaces with alpha."""
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


def run(quick=False):
    pygame.init()
    rng = np.random.default_rng(SEED)
    count = 500 if quick else SPRITES
    field = FIELD * (count / SPRITES) ** 0.5
    images = sprite_images(rng, 60)
    masks = [pygame.mask.from_surface(each) for each in images]
    shapes = [PixelMask.from_surface(each) for each in images]
    which = rng.integers(0, len(images), count)
    corners = rng.integers(0, int(field), (count, 2))
    velocities = rng.uniform(-90.0, 90.0, (count, 2))

    class Sprite(pygame.sprite.Sprite):
        def __init__(self, kind, corner):
            super().__init__()
            self.mask, self.rect = masks[kind], images[kind].get_rect(topleft=tuple(int(v) for v in corner))

    group = pygame.sprite.Group()
    sprites = [Sprite(kind, corner) for kind, corner in zip(which.tolist(), corners)]
    group.add(*sprites)
    place = {sprite: number for number, sprite in enumerate(sprites)}
    rects = [sprite.rect for sprite in sprites]

    def with_groupcollide():
        hits = pygame.sprite.groupcollide(group, group, False, False, pygame.sprite.collide_mask)
        return {(place[a], place[b]) for a, others in hits.items() for b in others if place[a] < place[b]}

    def with_collidelistall():
        found = set()
        for number, sprite in enumerate(sprites):
            rect, mask = sprite.rect, sprite.mask
            for other in rect.collidelistall(rects):
                if other > number and mask.overlap(
                    sprites[other].mask, (rects[other].x - rect.x, rects[other].y - rect.y)
                ):
                    found.add((number, other))
        return found

    def world_with(strategy, effects):
        world = World(effects, strategy)
        for kind, corner in zip(which.tolist(), corners):
            shape = shapes[kind]
            world.add_body(shape, position=(corner[0] + shape.origin[0], corner[1] + shape.origin[1]), kind="kinematic")
        return world

    truth = with_collidelistall()
    assert truth == with_groupcollide() if quick else True
    slow = best_of(1, with_groupcollide)
    fair = best_of(5, with_collidelistall)
    rows = [
        ["groupcollide(collide_mask)", len(with_groupcollide()), f"{slow * 1e3:.1f}", f"{fair / slow:.3f}", ""],
        ["collidelistall + Mask.overlap", len(truth), f"{fair * 1e3:.1f}", "1.0", ""],
    ]
    pairs = 0
    for strategy in (SpatialHashGrid, DynamicTree, SweepAndPrune, BruteForce):
        times = []
        for effects in (Effects(), Effects(response=True)):
            world = world_with(strategy(), effects)
            world.step()
            hits = set(zip(world.contacts["body_a"].tolist(), world.contacts["body_b"].tolist()))
            assert hits == truth, f"{strategy.name}: {len(hits)} hits, pygame finds {len(truth)}"
            boxes = len(world.candidates)
            pairs = max(pairs, boxes)
            world.bodies["vx"], world.bodies["vy"] = velocities.T

            times.append(best_of(5 if strategy is BruteForce else 60, world.step))
        rows.append(
            [
                f"ours, {strategy.name}",
                len(truth),
                f"{times[0] * 1e3:.2f}",
                f"{fair / times[0]:.1f}",
                f"{times[1] * 1e3:.2f}",
            ]
        )
    table(
        f"{count} sprites of 24-64 px, {pairs} candidate pairs, {len(truth)} mask hits; all moving",
        ("per frame", "hits", "ms", "x collidelistall", "ms with area, point, normal, depth"),
        rows,
    )
