"""Shape ids beyond 2^31 raise an error; before the fix they were negative numbers among the candidates."""

import pytest

from physics import Circle, Polygon, World
from physics.edit import LAST_SHAPE


@pytest.mark.parametrize("solver", ["soft_step", "projection"])
def test_the_last_id_is_given_and_no_further_one(solver):
    world = World(solver=solver)
    ground = world.add_body(Polygon.box(400, 20), position=(0, 10), kind="static")
    world._next_shape = LAST_SHAPE - 2
    bodies = [world.add_body(Circle(5), position=(20 * k, -5)) for k in range(2)]
    world.step()
    assert world.candidates.tolist() == [[0, LAST_SHAPE - 2], [0, LAST_SHAPE - 1]]
    assert bodies[1].contacts["shape_b"].tolist() == [LAST_SHAPE - 1]
    before = world.digest(), len(world), world._next_body
    for add in (
        lambda: world.add_body(Circle(5)),
        lambda: world.add_bodies(Circle(5), [(0, 0)] * 3),
        lambda: ground.add_shape(Circle(5)),
        lambda: ground.set_shapes(Circle(5)),
    ):
        with pytest.raises(ValueError, match=f"shapes must be at most {LAST_SHAPE} in the life of a world"):
            add()
        assert (world.digest(), len(world), world._next_body) == before
    world.step()
