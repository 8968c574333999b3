"""Columns that no builder set straight, with eight substeps: they stand as high as their contacts are stiff."""

import numpy as np
import pytest

from physics import Material, Polygon
from tests.stability.invariants import Watch, deepest
from tests.stability.piles import floor, metres, needs_speed

SEEDS = range(5)


def crooked(count, seed):
    """Places [m] of boxes above one another, each 2 cm off at most."""
    return np.random.default_rng(seed).uniform(-0.02, 0.02, count).tolist()


def leaning(count, by):
    """Return the places [m] of boxes, each `by` further to the right than the one below."""
    return [by * k for k in range(count)]


def column_at(places, seconds=20, substeps=8, **options):
    """Step a column of unit boxes at these x. Return (world, whether no box left its place by a quarter)."""
    world = metres(substeps=substeps, **options)
    floor(world)
    boxes = [
        world.add_body(Polygon.box(1, 1), position=(x, -0.5 - k), material=Material(friction=0.6))
        for k, x in enumerate(places)
    ]
    Watch(world, passive=True).step(round(60 * seconds))
    return world, all(abs(box.position.x - x) < 0.25 for box, x in zip(boxes, places, strict=True))


@needs_speed
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("count", [20, 40])
def test_crooked_columns_stand(count, seed):
    assert column_at(crooked(count, seed))[1]


@needs_speed
@pytest.mark.parametrize("seed", SEEDS)
def test_with_four_substeps_a_crooked_column_of_forty_stands_and_with_two_it_falls(seed):
    """Contacts are springs of 30 and 15 Hz then, and give way four and sixteen times as far as with eight."""
    assert column_at(crooked(40, seed), substeps=4)[1]
    assert not column_at(crooked(40, seed), substeps=2)[1]


@needs_speed
def test_ten_boxes_each_further_than_the_last_stand_as_far_as_their_weight_lies_over_the_lowest():
    """By 0.1 of a width each they would stand on the edge; at 0.08 they stand, with four substeps they do not."""
    world, stands = column_at(leaning(10, 0.08))
    assert stands and deepest(world) < 0.005
    assert not column_at(leaning(10, 0.08), substeps=4)[1] and not column_at(leaning(10, 0.105))[1]
