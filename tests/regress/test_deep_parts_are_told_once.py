"""The contacts of a sprite deep in another are reported once; before the fix a manifold was added in every step.

A recycled manifold that had rotated by some bits was taken for a new face.
"""

import math

import numpy as np
import pytest

from physics import Effects, World
from tests.stability.test_mask_piles import blob

EFFECTS = Effects(response=True, gravity=True, rotation=True, friction=True, restitution=True, stacking=True)


@pytest.mark.parametrize("seed", range(8))
def test_the_contacts_of_two_that_hardly_move_stay_as_many(seed):
    rng = np.random.default_rng(seed)
    world = World(EFFECTS, gravity=(0, 0), dt=1e-6)
    world.add_body(blob(rng), kind="static", angle=float(rng.uniform(0, 6)))
    way, far = rng.uniform(0, 6), rng.uniform(2, 16)
    world.add_body(blob(rng), position=(far * math.cos(way), far * math.sin(way)), angle=float(rng.uniform(0, 6)))
    world.step()
    before = len(world.contacts)
    for _ in range(40):
        world.step()
    assert 0 < len(world.contacts) <= before + 4, "some may come, not forty"
