"""Costs and error rates of every collision tier (kind of collision shape) for two sprites, over random relative poses.

Offsets are drawn uniformly from a disc, and angles uniformly from a full turn. The radius of the disc is chosen so that
about half of the poses are hits, because error rates depend on the share of hits. The reference is the exact test of
pixel squares. Hits and misses are timed separately, each on a batch of real pairs.
"""

from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from game.measure.pair_batch import PairBatch
from game.measure.rates import Rate
from game.measure.timing import LEAST_PAIRS, Cost, timed_in_turns
from physics import TIERS, Fit, PixelMask, fit, measure
from physics.annotations import TierName

POSES = 4000
WANTED = 0.5  # share of the poses that are hits
HALVINGS = 12  # bisection steps for the radius of the disc
REPEATS = 3  # tests of a batch per run: 40 us alone would be short for a clock


class TierFigures(NamedTuple):
    """Cost and error rates of one collision tier (kind of collision shape), measured for two sprites.

    The reference is the exact test of the sprites' masks. Times of tests are in seconds per pair.
    """

    tier: str
    shapes: int  # number of shapes that represent the first sprite
    hit: Cost
    miss: Cost
    wrong: Rate  # false hits, of all reported hits
    missed: Rate  # missed hits, of all true hits
    build: Cost  # seconds to build the shapes of the first sprite from its pixels
    fit: Fit  # quality of the fit


class Poses(NamedTuple):
    """Poses of n pairs of two sprites. first, second: (n, 3) rows of x [px], y [px], angle [rad] of each sprite.

    met: (n,) bool, whether the pixels of the two sprites touch.
    """

    first: np.ndarray
    second: np.ndarray
    met: np.ndarray


def poses_around(first: PixelMask, second: PixelMask, count: int = POSES, seed: int = 0) -> Poses:
    """Return `count` random Poses of two sprites (PixelMasks). In about half of the pairs, the sprites touch.

    Raises ValueError for a sprite without solid pixels.
    """
    exact = [fit(mask, "mask") for mask in (first, second)]
    for name, mask in (("first", first), ("second", second)):
        if not mask.area:
            raise ValueError(f"{name} must have a solid pixel (got {mask})")
    chance = np.random.default_rng(seed)
    share, way = np.sqrt(chance.random(count)), chance.uniform(0.0, 2.0 * np.pi, count)
    turns = chance.uniform(0.0, 2.0 * np.pi, (2, count))
    base = chance.uniform(-500.0, 500.0, (count, 2))

    def at(radius):
        offset = radius * share[:, None] * np.stack([np.cos(way), np.sin(way)], axis=1)
        poses = [np.column_stack([base, turns[0]]), np.column_stack([base + offset, turns[1]])]
        batch = PairBatch(exact[0], poses[0], exact[1], poses[1])
        batch.test()
        return Poses(poses[0], poses[1], batch.met())

    low, high = 0.0, 2.0 * (first.reach(0.0, 0.0) + second.reach(0.0, 0.0))  # where three quarters and more are misses
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        if at(middle).met.mean() > WANTED:
            low = middle
        else:
            high = middle
    return at(high)


def measure_tiers(
    first: PixelMask,
    second: PixelMask,
    report: Callable[[TierFigures], object],
    tiers: Sequence[TierName] = TIERS,
    seed: int = 0,
) -> None:
    """Measure the collision tiers (kinds of collision shape) for two sprites over random relative poses.

    report(TierFigures) is called for each tier. tiers: names of the tiers; seed: seed of the poses and of the order of
    runs. Raises ValueError for a sprite without solid pixels.
    """
    measure_at(first, second, poses_around(first, second, seed=seed), report, tiers, seed)


def measure_at(
    first: PixelMask,
    second: PixelMask,
    poses: Poses,
    report: Callable[[TierFigures], object],
    tiers: Sequence[TierName] = TIERS,
    seed: int = 0,
) -> None:
    """Measure the collision tiers (kinds of collision shape) for two sprites at the given poses.

    report(TierFigures) is called for each tier. poses: Poses that include hits and misses; tiers: names of the tiers;
    seed: seed of the order of the runs.
    """
    shapes = {tier: (fit(first, tier), fit(second, tier)) for tier in tiers}
    verdicts, batches = {tier: np.zeros(len(poses.met), bool) for tier in tiers}, {}
    for tier, (a, b) in shapes.items():
        for kind, chosen in (("hit", poses.met), ("miss", ~poses.met)):
            which = np.resize(np.flatnonzero(chosen), max(LEAST_PAIRS, int(chosen.sum())))
            batch = batches[f"{tier} {kind}"] = PairBatch(a, poses.first[which], b, poses.second[which], seed)
            batch.test()
            verdicts[tier][which] = batch.met()
    # A batch is tested REPEATS times per run, so that a run is long enough for the clock.
    works = {name: partial(_test, batch) for name, batch in batches.items()}
    costs = timed_in_turns(works, {name: REPEATS * len(batch) for name, batch in batches.items()}, seed=seed)
    builds = timed_in_turns({tier: partial(_build, first, tier) for tier in tiers}, dict.fromkeys(tiers, 1), seed=seed)
    for tier in tiers:
        says, is_so = verdicts[tier], poses.met
        wrong = Rate(int((says & ~is_so).sum()), int(says.sum()))
        missed = Rate(int((is_so & ~says).sum()), int(is_so.sum()))
        a, fitted = shapes[tier][0], measure(first, shapes[tier][0])
        hit, miss = costs[f"{tier} hit"], costs[f"{tier} miss"]
        report(TierFigures(tier, len(a), hit, miss, wrong, missed, builds[tier], fitted))


def _build(mask, tier):
    """Return the shapes of a collision tier (kind of collision shape), fitted to a mask without use of the cache.

    A new PixelMask is created for this, because each mask caches its fits.
    """
    return fit(PixelMask(mask.solid, mask.origin), tier)


def _test(batch):
    for _ in range(REPEATS):
        batch.test()
