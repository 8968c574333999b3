"""A body is fast if a step moves its centre further than the distance from the centre to its nearest edge.

Half of the least width is the wrong limit, because a triangle's centre is nearer to its base than that. Before the fix
a step of 0.36 sides was not swept, and a triangle passed through one-sided ground.
"""

import math

import numpy as np
import pytest

from physics import Chain, Effects, Polygon, World

SIDE = 10.0
TRIANGLE = [(-SIDE / 2.0, 0.0), (SIDE / 2.0, 0.0), (0.0, -SIDE * math.sqrt(0.75))]


@pytest.mark.parametrize("solver", ["blocking", "projection", "sequential_impulse", "soft_step"])
def test_a_triangle_does_not_fall_through_a_link(solver):
    for gap in np.linspace(0.02, 3.0, 12):
        for share in np.linspace(0.2, 0.5, 13):
            effects = Effects(
                narrowphase=True,
                response=True,
                rotation=True,
                continuous=True,
                stacking=solver in ("sequential_impulse", "soft_step"),
            )
            world = World(effects, solver=solver, substeps=1)
            world.add_body(Chain([(-99, 0), (99, 0)]), kind="static")
            body = world.add_body(Polygon(TRIANGLE), position=(0.0, -gap), velocity=(0.0, share * SIDE / world.dt))
            for _ in range(8):
                world.step()
                assert body.center.y < 0.0, (gap, share)


@pytest.mark.parametrize("offset", [(0.0, 0.0), (300.0, -7.0)])
def test_half_is_measured_from_the_centre_of_mass(offset):
    moved = [(x + offset[0], y + offset[1]) for x, y in TRIANGLE]
    assert Polygon(moved).min_half_extent == pytest.approx(SIDE * math.sqrt(0.75) / 3.0)
    assert Polygon(moved, radius=2.0).min_half_extent > 2.0 + SIDE / 4.0
    assert Polygon.box(8, 6, offset, 0.3).min_half_extent == pytest.approx(3.0)
