"""Crooked columns with eight substeps stand, up to the height that the stiffness of their contacts allows."""

import numpy as np
import pytest

from physics import Material, Polygon
from tests.stability.invariants import Watch, deepest
from tests.stability.piles import floor, metres, needs_speed

SEEDS = range(5)


def crooked(count, seed):
    """Return `count` random x positions [m] for a column of boxes, each at most 2 cm from 0."""
    return np.random.default_rng(seed).uniform(-0.02, 0.02, count).tolist()


def leaning(count, by):
    """Return the x positions [m] of a column of boxes, each `by` further to the right than the box below."""
    return [by * k for k in range(count)]


def column_at(places, seconds=20, substeps=8, **options):
    """Simulate a column of unit boxes at these x positions. Return (world, whether each box stayed within 0.25 m of its
    x).
    """
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
    """A crooked column of forty boxes stands with four substeps and falls with two.

    Their contacts are springs of 30 and 15 Hz. The deflection is four and sixteen times that with eight substeps.
    """
    assert column_at(crooked(40, seed), substeps=4)[1]
    assert not column_at(crooked(40, seed), substeps=2)[1]


@needs_speed
def test_ten_boxes_each_further_than_the_last_stand_as_far_as_their_weight_lies_over_the_lowest():
    """Ten boxes, each shifted by 0.08 of a width, stand with eight substeps and fall with four.

    Shifted by 0.1 they would be exactly at the limit; at 0.105 they fall.
    """
    world, stands = column_at(leaning(10, 0.08))
    assert stands and deepest(world) < 0.005
    assert not column_at(leaning(10, 0.08), substeps=4)[1] and not column_at(leaning(10, 0.105))[1]
