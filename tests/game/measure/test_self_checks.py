"""Error rates that have closed forms, measured by the same code that measures sprites.

A rate is a ratio of two areas. Each is the area of the relative positions at which two shapes touch, a Minkowski sum.
For rotated shapes the kinematic formula of integral geometry gives A + B + P Q / 2 pi (Santalo 1976).
"""

from math import cos, hypot, pi, sin

import numpy as np
import pytest

from game.measure.pair_batch import PairBatch
from game.measure.rates import Rate
from game.measure.tiers import poses_around
from physics import Bounds, Circle, Effects, PixelMask, Polygon, World, fit

COUNT = 40_000


def verdicts(shape, first, second):
    batch = PairBatch((shape,), first, (shape,), second)
    batch.test()
    return batch.met()


def places(half, turned, seed=1):
    """Return two arrays (COUNT, 3) of poses; the second body is anywhere in a square around the first.

    half: half the side of the square. turned: True rotates both bodies at random.
    """
    chance = np.random.default_rng(seed)
    first, second = np.zeros((COUNT, 3)), np.zeros((COUNT, 3))
    second[:, :2] = chance.uniform(-half, half, (COUNT, 2))
    if turned:
        first[:, 2], second[:, 2] = chance.uniform(0.0, 2.0 * pi, (2, COUNT))
    return first, second


def wrong_share(shape, tier, half, turned):
    first, second = places(half, turned)
    true, says = verdicts(shape, first, second), verdicts(tier, first, second)
    assert not (true & ~says).any(), "what holds a shape misses nothing that the shape hits"
    return Rate(int((says & ~true).sum()), int(says.sum()))


UNIT = Polygon.box(1.0, 1.0)


@pytest.mark.parametrize(
    "shape, tier, half, turned, expected",
    [
        (Circle(0.5), Bounds(Circle(0.5)), 1.2, False, 1.0 - pi / 4.0),
        (UNIT, Circle(hypot(0.5, 0.5)), 1.5, False, 1.0 - 4.0 / (2.0 * pi)),
        (UNIT, Circle(hypot(0.5, 0.5)), 1.5, True, 1.0 - (2.0 + 16.0 / (2.0 * pi)) / (2.0 * pi)),
        (UNIT, Bounds(UNIT), 1.5, True, 1.0 - (2.0 + 16.0 / (2.0 * pi)) / (2.0 * (1 + 2 / pi) + 2.0 * (4 / pi) ** 2)),
    ],
    ids=("discs as boxes", "squares as circles", "turned squares as circles", "turned squares as boxes"),
)
def test_wrong_hits_are_as_many_as_geometry_says(shape, tier, half, turned, expected):
    low, high = wrong_share(shape, tier, half, turned).interval
    middle, reach = 0.5 * (low + high), 0.5 * (high - low)
    assert abs(middle - expected) < 1.6 * reach, f"{middle:.4f} is not {expected:.4f} +- {1.6 * reach:.4f}"


def test_whole_pixels_miss_what_geometry_says():
    """Pixel tests on the grid miss 1 - ((2n - 1) / 2n)^2 of the true hits of two squares of n pixels (3.10 % at 32)."""
    n = 32
    mask = PixelMask(np.ones((n, n), bool), origin=(0, 0))
    first, second = places(1.1 * n, False)
    exact, snapped = (verdicts(fit(mask, tier)[0], first, second) for tier in ("mask", "pixels"))
    assert not (snapped & ~exact).any()
    low, high = Rate(int((exact & ~snapped).sum()), int(exact.sum())).interval
    expected = 1.0 - ((2 * n - 1) / (2 * n)) ** 2
    assert low - 0.3 * (high - low) < expected < high + 0.3 * (high - low)


def test_the_mean_chord_of_a_box_is_pi_area_over_perimeter():
    """Random lines through a box of 2 x 1 have a mean chord of pi A / P = 1.0472 (Cauchy, Crofton)."""
    world = World(Effects())
    world.add_body(Polygon.box(2.0, 1.0), kind="static")
    chance, chords = np.random.default_rng(3), []
    for _ in range(6000):
        way, offset = chance.uniform(0.0, 2.0 * pi), chance.uniform(-1.2, 1.2)
        across = (-sin(way) * offset, cos(way) * offset)
        there = world.ray_cast((across[0] - 3 * cos(way), across[1] - 3 * sin(way)), (6 * cos(way), 6 * sin(way)))
        back = world.ray_cast((across[0] + 3 * cos(way), across[1] + 3 * sin(way)), (-6 * cos(way), -6 * sin(way)))
        if there is not None and back is not None:
            chords.append(6.0 * (1.0 - there.fraction - back.fraction))
    error = np.std(chords) / len(chords) ** 0.5
    assert abs(np.mean(chords) - pi * 2.0 / 6.0) < 3.5 * error


@pytest.mark.parametrize("width, radius, speed", ((2.0, 3.0, 40.0), (1.0, 0.5, 6.0), (10.0, 4.0, 15.0)))
def test_who_is_only_looked_at_between_steps_misses_as_often_as_the_formula_says(width, radius, speed):
    """Tests between steps alone miss a wall at the rate max(0, 1 - (w + 2r) / (v dt)).

    The disc starts anywhere within a step of the wall.
    """
    starts, missed = 400, 0
    wall, disc = Polygon.box(width, 100.0), Circle(radius)
    for k in range(starts):
        x = -60.0 - speed * (k + 0.5) / starts
        poses = np.array([(x + speed * step, 0.0, 0.0) for step in range(int(200 / speed) + 2)])
        batch = PairBatch((disc,), poses, (wall,), np.zeros_like(poses))
        batch.test()
        missed += not batch.met().any()
    assert missed / starts == pytest.approx(max(0.0, 1.0 - (width + 2.0 * radius) / speed), abs=1.5 / starts)


def test_tiers_that_are_the_same_shape_never_disagree():
    """For a square sprite the tiers rotated box, hull, outline and exact mask always agree, because all are the same
    square.
    """
    mask = PixelMask(np.ones((12, 12), bool))
    poses = poses_around(mask, mask, 3000)
    by_tier = {}
    for tier in ("obb", "hull", "outline", "mask"):
        batch = PairBatch(fit(mask, tier), poses.first, fit(mask, tier), poses.second)
        batch.test()
        by_tier[tier] = batch.met()
    assert all((met == by_tier["mask"]).all() for met in by_tier.values())
    assert 0.4 < poses.met.mean() < 0.6


def test_a_sprite_without_pixels_is_refused():
    with pytest.raises(ValueError, match="second must have a solid pixel"):
        poses_around(PixelMask(np.ones((2, 2), bool)), PixelMask(np.zeros((2, 2), bool)))
