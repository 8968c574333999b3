"""A solver without sleeping chosen after a removal works; before the fix the broad phase still
paired removed shapes.
"""

import pytest

from physics import BROADPHASES, Circle, Effects, World


@pytest.mark.parametrize("strategy", BROADPHASES.values())
@pytest.mark.parametrize("solvers", [("soft_step", "projection"), ("projection", "soft_step")])
def test_what_is_gone_is_no_candidate(strategy, solvers):
    effects = Effects(response=True, stacking=True, sleeping=True)
    world = World(effects, strategy(), solvers[0])
    gone = world.add_body(Circle(40.0))
    left = world.add_body(Circle(10.0), position=(0.0, 50.0))
    world.step()
    world.remove_body(gone)
    world.solver = solvers[1]
    for _ in range(3):
        world.step()
        assert len(world.candidates) == 0 and len(world.contacts) == 0
    other = world.add_body(Circle(10.0), position=(0.0, left.position.y + 15.0))
    world.step()
    assert world.candidates.tolist() == [[*left.shape_ids, *other.shape_ids]]
