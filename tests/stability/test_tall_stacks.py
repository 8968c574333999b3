"""Columns that no builder set straight: they stand as high as their contacts are stiff."""

import numpy as np
import pytest

from physics import Material, Polygon
from tests.stability.invariants import Watch
from tests.stability.piles import floor, metres, needs_speed

SEEDS = range(5)


def stack(world, places):
    """Unit boxes on each other, at these x. Returns the bodies, lowest first."""
    floor(world)
    return [
        world.add_body(Polygon.box(1, 1), position=(x, -0.5 - k), material=Material(friction=0.6))
        for k, x in enumerate(places)
    ]


def crooked(count, seed):
    """Places that are 2 cm off at most."""
    return np.random.default_rng(seed).uniform(-0.02, 0.02, count).tolist()


def stands(places, seconds=20, substeps=4, **options):
    """Whether boxes at these x stand after so long: none has left its place by a quarter of its width."""
    world = metres(substeps=substeps, **options)
    boxes = stack(world, places)
    Watch(world, passive=True).step(round(60 * seconds))
    return all(abs(box.position.x - x) < 0.25 for box, x in zip(boxes, places, strict=True))


@needs_speed
@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("count", [15, 20])
def test_crooked_columns_stand(count, seed):
    """With arms that turn with the boxes fourteen stand, as self-weight buckles springs of 30 Hz, and twenty never."""
    assert stands(crooked(count, seed))
