"""Chart 14: the same work done by common libraries: pygame's rectangles and masks, pymunk's solver.

Sprites have integer positions, because pygame compares whole pixels. The truth is the set of pairs of masks that share
a pixel, found by testing all pairs.
"""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
import pygame

from game.drawing.sprites import load_atlas
from game.measure.rates import Rate
from game.measure.timing import timed_in_turns, timed_steps
from game.report.chart import Axis, Chart, Panel, panel_is, percent, time, value
from game.report.claim import Claim, at_most, ordering, pair, ratio_of
from game.report.job import Job, ReportScope, Row, counted, spread
from game.report.piles import overlap, pyramid, world_of
from game.report.pymunk_piles import overlap_in, space_of
from physics import DynamicTree, Effects, PixelMask, SpatialHashGrid, World
from physics.annotations import TierName

SPRITES = ("player", "saucer_0", "gunship_0")
SPACING = 30.0  # [px] mean distance of sprites: about one overlap each
RUNS = 5
ITERATIONS = (2, 5, 10, 20, 40)  # of pymunk's solver
SUBSTEPS = (1, 2, 4, 8, "auto")
SETTLE = 120


class Traffic:
    """The same sprites at integer positions, in pygame and in a world of this project."""

    def __init__(self, count: int) -> None:
        atlas, chance = load_atlas("planes"), np.random.default_rng(6)
        self.which = chance.integers(0, len(SPRITES), count).tolist()
        self.corners = chance.integers(0, int(SPACING * count**0.5), (count, 2)).tolist()
        self.kinds = [PixelMask(atlas.mask(name).solid, origin=(0, 0)) for name in SPRITES]
        masks = [_pygame_mask(kind) for kind in self.kinds]
        self.masks = [masks[k] for k in self.which]
        self.rects = [
            pygame.Rect(x, y, *masks[k].get_size()) for k, (x, y) in zip(self.which, self.corners, strict=True)
        ]
        self.group = pygame.sprite.Group(*(_sprite(*each) for each in zip(self.masks, self.rects, strict=True)))

    def rects_only(self) -> set[tuple[int, int]]:
        """Return the pairs (indices k < j) whose rectangles overlap: the usual first version of a game."""
        rects = self.rects
        return {(k, j) for k, rect in enumerate(rects) for j in rect.collidelistall(rects) if j > k}

    def masks_after_rects(self) -> set[tuple[int, int]]:
        """Return the pairs whose masks overlap, tested after their rectangles: the fastest exact way in pygame."""
        rects, masks, found = self.rects, self.masks, set()
        for k, rect in enumerate(rects):
            for j in rect.collidelistall(rects):
                if j > k and masks[k].overlap(masks[j], (rects[j].x - rect.x, rects[j].y - rect.y)):
                    found.add((k, j))
        return found

    def group_collide(self) -> set:
        """Return the result of pygame.sprite.groupcollide, the function that tutorials use."""
        collide = pygame.sprite.collide_mask
        # The stubs ask for a bool; pygame documents this very function, which returns a point or None.
        return set(pygame.sprite.groupcollide(self.group, self.group, False, False, collide))  # pyright: ignore

    def all_pairs(self) -> set[tuple[int, int]]:
        """Return the pairs whose masks overlap, without a rectangle test. This is slow, and used as the truth."""
        return {
            (k, j)
            for k in range(len(self.masks))
            for j in range(k + 1, len(self.masks))
            if self.masks[k].overlap_area(self.masks[j], tuple(np.subtract(self.corners[j], self.corners[k]).tolist()))
        }

    def world(self, strategy: Any, tier: TierName) -> World:
        """Return a world of this project with all sprites. strategy: broad phase; tier: collision tier."""
        world = World(Effects(), strategy)
        for k, (x, y) in zip(self.which, self.corners, strict=True):
            world.add_body(self.kinds[k], position=(x, y), kind="kinematic", tier=tier)
        world.step()
        return world


def _pygame_mask(mask):
    made = pygame.Mask(mask.solid.shape[::-1])
    for y, x in np.argwhere(mask.solid).tolist():
        made.set_at((x, y))
    return made


def _sprite(mask, rect):
    sprite: Any = pygame.sprite.Sprite()
    sprite.mask, sprite.rect = mask, rect
    return sprite


def measure_sprites(count: int) -> list[Row]:
    """Return a row for each method: the time to find all hits among `count` sprites, and its false and missed hits."""
    traffic = Traffic(count)
    truth = traffic.all_pairs()
    ways: dict[str, Callable[[], set]] = {
        "pygame: Rect": traffic.rects_only,
        "pygame: Rect, then Mask": traffic.masks_after_rects,
        "pygame: groupcollide": traffic.group_collide,
    }
    reported: dict[str, set] = {
        "pygame: Rect": traffic.rects_only(),
        "pygame: Rect, then Mask": traffic.masks_after_rects(),
    }
    reported["pygame: groupcollide"] = truth  # it returns sprites, not pairs: the same masks, one by one
    works: dict[str, Callable[[], object]] = dict(ways)
    ours: tuple[tuple[str, type[SpatialHashGrid | DynamicTree], TierName], ...] = (
        ("ours: grid, boxes", SpatialHashGrid, "aabb"),
        ("ours: grid, pixels", SpatialHashGrid, "pixels"),
        ("ours: tree, pixels", DynamicTree, "pixels"),
        ("ours: grid, outline", SpatialHashGrid, "outline"),
    )
    for name, make, tier in ours:
        world = traffic.world(make(), tier)
        rows = {int(identity): k for k, identity in enumerate(world.bodies["id"])}
        found = world.contacts
        hits = found[found["separation"] <= 0.0]
        reported[name] = {
            tuple(sorted((rows[a], rows[b])))
            for a, b in zip(hits["body_a"].tolist(), hits["body_b"].tolist(), strict=True)
        }
        # All move, back and forth, so that all boxes are rebuilt and no cached result is used.
        speeds = np.random.default_rng(7).uniform(-60.0, 60.0, (count, 2))
        works[name] = partial(_step, world, speeds)
    costs = timed_in_turns(works, dict.fromkeys(works, 1), RUNS)
    return [
        {
            "series": name,
            "label": name,
            "panel": "sprites",
            "n": count,
            "wrong": counted(Rate(len(reported[name] - truth), len(reported[name]))),
            "missed": counted(Rate(len(truth - reported[name]), len(truth))),
            "cost": spread(costs[name]),
        }
        for name in works
    ]


def _step(world, speeds):
    speeds *= -1.0
    world.bodies["vx"], world.bodies["vy"] = speeds.T
    world.step()


def measure_piles(rows: int) -> list[Row]:
    """Return a row for each engine and setting: overlap of a pyramid after two seconds, and time of a step.

    rows: number of rows of the pyramid. Raises ModuleNotFoundError if pymunk is missing.
    """
    made, found, steps = pyramid(rows), {}, {}
    for substeps in SUBSTEPS:
        world, label = world_of(made, "soft_step", substeps), f"ours: {substeps} substeps"
        for _ in range(SETTLE):
            world.step()
        steps[label], found[label] = world.step, ("ours", overlap(world))
    for count in ITERATIONS:
        space, label = space_of(made, count), f"pymunk: {count} iterations"
        for _ in range(SETTLE):
            space.step(1 / 60)
        steps[label], found[label] = partial(space.step, 1 / 60), ("pymunk", overlap_in(space))
    costs = timed_steps(steps)
    return [
        {
            "series": engine,
            "label": label,
            "panel": f"pyramid of {len(made.places)}",
            "overlap": deep,
            "cost": spread(costs[label]),
        }
        for label, (engine, deep) in found.items()
    ]


def _jobs(scope: ReportScope) -> list[Job]:
    work = __name__
    counts, rows = ((300,), (10,)) if scope.quick else ((100, 500, 1500), (10, 20, 45))
    return [
        *(Job(f"peers/sprites-{n}", f"{work}:measure_sprites", {"count": n}, n / 150) for n in counts),
        *(Job(f"peers/pyramid-{n}", f"{work}:measure_piles", {"rows": n}, n * n / 50) for n in rows),
    ]


def _claims(rows: Sequence[Row]) -> list[Claim]:
    found = []
    for count in dict.fromkeys(row["n"] for row in rows if row["panel"] == "sprites"):
        exact = {
            row["series"]: pair(row["cost"])
            for row in rows
            if row.get("n") == count and row["wrong"][0] == 0 and row["missed"][0] == 0
        }
        found.append(ordering(f"{count} sprites, every hit right", exact))
    for panel in dict.fromkeys(row["panel"] for row in rows if row["panel"] != "sprites"):
        mine = {row["label"]: row["cost"] for row in rows if row["panel"] == panel}
        ratio = ratio_of(mine["ours: 4 substeps"], mine["pymunk: 10 iterations"])
        found.append(at_most(f"{panel} boxes: ours at 4 substeps is faster than pymunk at 10 iterations", ratio, 0.9))
    return found


def _panels(rows: Sequence[Row]) -> list[Panel]:
    cost = Axis("us, all of them", time("cost"))
    sprites = [
        Panel(
            f"{count} sprites: {word}",
            cost,
            Axis(f"{word} [%]", percent(key), log=False),
            lambda row, n=count: row["panel"] == "sprites" and row["n"] == n,
        )
        for count in dict.fromkeys(row["n"] for row in rows if row["panel"] == "sprites")
        for word, key in (("wrong hits", "wrong"), ("missed hits", "missed"))
    ]
    piles = [
        Panel(panel, Axis("us a step", time("cost")), Axis("overlap [px]", value("overlap"), mark=1.0), panel_is(panel))
        for panel in dict.fromkeys(row["panel"] for row in rows if row["panel"] != "sprites")
    ]
    return [*sprites, *piles]


CHART = Chart(
    14,
    "peers",
    "Beside pygame and pymunk",
    "What does the same work cost with common libraries, and is it as exact?",
    "sprites: which masks share a pixel, asked for every pair; piles: no box overlaps another",
    _panels,
    _jobs,
    _claims,
)
