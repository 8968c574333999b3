"""A body that is pushed through a wall past the middle of the wall has a begin event.

It was pushed out on the far side without an impulse and was separate from the wall at the end of the step. Before the
fix no event reported the contact.
"""

import pytest

from physics import Circle, Effects, Polygon, World


@pytest.mark.parametrize("aside", [11.0 - 0.9 * k for k in range(29)])
def test_every_pair_that_is_pushed_apart_is_told(aside):
    """Every pair that is pushed apart has a begin event.

    At the end of the step rounding leaves some pairs just separate and others just overlapping.
    """
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
