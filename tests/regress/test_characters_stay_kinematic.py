"""A character's body cannot be made static; before the fix its ground still carried it (found by random programs)."""

import pytest

from physics import Character, Effects, Polygon, World


@pytest.mark.parametrize("kind", ["static", "dynamic"])
def test_the_body_of_a_character_keeps_its_kind(kind):
    world = World(Effects.rigid_bodies())
    world.add_body(Polygon.box(400, 20), position=(0, 100), kind="kinematic", velocity=(60, 0))
    hero = Character(world, Polygon.box(10, 20), (0, 79))
    hero.move(0, 2)
    for _ in range(10):
        world.step()
    before, body = world.digest(), [*world][-1]
    with pytest.raises(ValueError, match="kinematic.*character"):
        body.set_kind(kind)
    assert world.digest() == before and body.kind == "kinematic"
    body.set_kind("kinematic")
    x = hero.position.x
    world.step()
    assert hero.position.x == x + 1.0, "it rides on"
