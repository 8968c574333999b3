"""A body that stepped into a wall past its middle was pushed out on the far side, with nothing to slow it: moved by a
contact that no event reported, because at the end of the step they were apart and no impulse had acted.
"""

import pytest

from physics import Circle, Effects, Polygon, World


@pytest.mark.parametrize("aside", [11.0 - 0.9 * k for k in range(29)])
def test_every_pair_that_is_pushed_apart_is_told(aside):
    """Its end is rounded: apart by a bit, or in by one, depending on the coordinates."""
    world, y = World(Effects(response=True)), 960.0 + aside
    wall = world.add_body(Polygon.box(1.0, 22.0), position=(0.0, 960.0), kind="static")
    disc = world.add_body(Circle(5.0), position=(-8.0, y), velocity=(600.0, 0.0))
    world.step()
    assert disc.position.x > 2.01 or abs(disc.position.y - y) > 0.01, "it was pushed"
    told = world.events.begin
    assert [(int(e["body_a"]), int(e["body_b"])) for e in told] == [(wall.id, disc.id)]
    world.step()
    assert len(world.events.begin) == 0 and len(world.events.end) == 1


def test_who_only_flies_past_is_not_told():
    world = World(Effects(response=True))
    world.add_body(Polygon.box(1.0, 22.0), kind="static")
    world.add_body(Circle(5.0), position=(-8.0, 16.5), velocity=(600.0, 0.0))
    for _ in range(3):
        world.step()
        assert not len(world.events.begin)
