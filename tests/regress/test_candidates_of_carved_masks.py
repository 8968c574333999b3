"""A pair with a carved mask is a candidate once; before the fix it was listed twice.

Carving adds rows for the new parts of the mask behind the rows of shapes that were added later.
"""

import numpy as np

from physics import Circle, Effects, PixelMask, Polygon, World


def test_pair_is_a_candidate_once_after_a_carve():
    world = World(Effects(response=True, carving=True))
    mask = world.add_body(PixelMask(np.ones((40, 40), bool)), kind="static")
    box = world.add_body(Polygon.box(60.0, 60.0), kind="kinematic")
    world.step()
    pair = [[*mask.shape_ids, *box.shape_ids]]
    assert world.candidates.tolist() == pair
    mask.carve(Circle(8.0), (0.0, 0.0))
    world.step()
    assert world.candidates.tolist() == pair
