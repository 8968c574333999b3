"""Arrays of any number type or memory layout, and lists, give the same world."""

import numpy as np
import pytest

from physics import World
from tests.physics.test_bad_input import ALL, BALL


@pytest.mark.parametrize(
    "make",
    [
        lambda a: a.tolist(),
        lambda a: a.astype(np.float32),
        np.asfortranarray,
        lambda a: np.repeat(a, 2, axis=0)[::2],
        lambda a: a.astype(np.int32),
    ],
)
def test_any_array_of_numbers_gives_the_same_world(make):
    at = np.array([(0, 0), (6, 1), (11, -3), (4, 4)], float)
    worlds = [World(ALL), World(ALL)]
    worlds[0].add_bodies(BALL, at, at * 2, at[:, 0])
    given = make(at)
    given2 = make(at * 2)
    worlds[1].add_bodies(BALL, given, given2, make(at)[:, 0] if not isinstance(given, list) else [r[0] for r in given])
    for world in worlds:
        world.step()
    assert worlds[0].digest() == worlds[1].digest()
