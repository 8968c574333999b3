"""Chart 1, whole steps: cost of a step per candidate pair for each tier, with all tables in the cache and out of it.

A step includes the broad phase, the parts, the narrow phase and the events. The sprites move by whole pixels and stay
upright, where the pixels of the tier "pixels" are exact; the other tiers are compared with it.
"""

from collections.abc import Sequence

import numpy as np

from game.measure.rates import Rate
from game.measure.timing import timed_steps
from game.report.chart import Axis, Panel, panel_is, percent, time
from game.report.claim import Claim, ordering, pair
from game.report.job import Job, ReportScope, Row, counted, spread
from game.report.sprites import SPRITES, mask_of
from physics import TIERS, Effects, PixelMask, SpatialHashGrid, World
from physics.annotations import TierName

EXACT = "pixels"
DT = 1.0 / 60.0  # [s]
WAY = 3  # frames in one direction
SIZES = {"in the cache": (300, 30.0), "out of the cache": (10_000, 20.0)}  # sprites, and their mean distance [px]
RUNS, FRAMES = {"in the cache": 5, "out of the cache": 3}, {"in the cache": 20, "out of the cache": 3}
SLOW = ("parts", "outline")  # tiers of many shapes, whose step out of the cache takes seconds
PANELS = {name: f"whole steps, {count:,} sprites, {name}" for name, (count, _) in SIZES.items()}


class TierWorld:
    """A world of moving sprites of one tier. count: number of sprites; apart: their mean distance [px]."""

    def __init__(self, tier: TierName, count: int, apart: float) -> None:
        chance = np.random.default_rng(14)
        self.frame, self.world = 0, World(Effects.detection(), SpatialHashGrid())
        which = chance.integers(0, 3, count)
        starts = chance.integers(0, int(apart * count**0.5), (count, 2)).astype(float)
        motions = chance.integers(1, 4, (count, 2)) * chance.choice((-1.0, 1.0), (count, 2))
        for kind, (atlas, name) in enumerate(SPRITES[:3]):
            mine = np.flatnonzero(which == kind)
            sprite = PixelMask(mask_of(atlas, name).solid, origin=(0, 0))
            self.world.add_bodies(sprite, starts[mine], motions[mine] / DT, kind="kinematic", tier=tier)

    def step(self) -> None:
        """Make a step. The sprites turn back after every WAY steps."""
        if self.frame and self.frame % WAY == 0:
            self.world.bodies["vx"] *= -1.0
            self.world.bodies["vy"] *= -1.0
        self.frame += 1
        self.world.step(DT)

    def hits(self) -> np.ndarray:
        """Return the touching pairs, (n,) numbers that differ from pair to pair."""
        pairs = self.world.touching().astype(np.int64)
        return pairs[:, 0] * 2**32 + pairs[:, 1]


def measure(name: str) -> list[Row]:
    """Return a row for each tier: the time of a step per candidate pair, false and missed hits. name: key of SIZES.

    Raises RuntimeError for a world that tested no pair, because its time would mean nothing.
    """
    tiers: list[TierName] = [tier for tier in TIERS if name == "in the cache" or tier not in SLOW]
    made = {tier: TierWorld(tier, *SIZES[name]) for tier in tiers}
    hits = {}
    for tier, world in made.items():
        world.step()
        hits[tier] = world.hits()
        if not world.world.profile.counters["candidates"]:
            raise RuntimeError(f"{tier}: the sprites have no pair of boxes")
    boxes = made["aabb"].world.profile.counters["candidates"]
    costs = timed_steps({tier: world.step for tier, world in made.items()}, FRAMES[name], RUNS[name])
    return [
        {
            "series": tier,
            "label": f"{tier}, {SIZES[name][0]:,} sprites",
            "panel": PANELS[name],
            "n": SIZES[name][0],
            "boxes": boxes,
            "wrong": counted(Rate(len(np.setdiff1d(hits[tier], hits[EXACT])), len(hits[tier]))),
            "missed": counted(Rate(len(np.setdiff1d(hits[EXACT], hits[tier])), len(hits[EXACT]))),
            "step_cost": _per_pair(costs[tier], boxes),
        }
        for tier in tiers
    ]


def _per_pair(cost, pairs):
    found = spread(cost)
    return found | {"seconds": [each / pairs for each in found["seconds"]]}


def jobs(scope: ReportScope) -> list[Job]:
    """Return one job for each size; only that of few sprites for a quick report."""
    names = list(SIZES)[: 1 if scope.quick else None]
    return [
        Job(f"tiers/step-{name.replace(' ', '-')}", f"{__name__}:measure", {"name": name}, SIZES[name][0] / 1000 + 2.0)
        for name in names
    ]


def claims(rows: Sequence[Row]) -> list[Claim]:
    """Return the claims about the cheapest tier of a whole step, at each size. rows: rows of the chart."""
    found = []
    for panel in PANELS.values():
        costs = {row["series"]: pair(row["step_cost"]) for row in rows if row["panel"] == panel}
        if costs:
            found.append(ordering(f"{panel}, per candidate pair", costs, 1e9, "ns"))
    return found


STEP_PANELS = tuple(
    Panel(
        f"{word}, {panel}",
        Axis("ns per candidate pair", time("step_cost", "ns")),
        Axis(f"{word} [%]", percent(key), log=False),
        panel_is(panel),
    )
    for panel in PANELS.values()
    for word, key in (("wrong hits", "wrong"), ("missed hits", "missed"))
)
