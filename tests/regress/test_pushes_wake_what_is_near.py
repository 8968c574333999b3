"""A sleeping body that a character pushes is woken; before the fix it was pushed asleep and jerked when it woke.

A character moves in whole pixels, so the body could be at a small distance.
"""

import pytest

from physics import Character, Effects, Polygon, World

HALF = 8.0  # [px] of a crate


def asleep(place):
    """Return (world, crate) with a sleeping crate at x = place on a floor."""
    world = World(Effects.rigid_bodies())
    world.add_body(Polygon.box(400, 20), position=(0.0, 30.0), kind="static")
    crate = world.add_body(Polygon.box(2 * HALF, 2 * HALF), position=(place, 20.0 - HALF))
    while crate.awake:
        world.step()
    return world, crate


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("gap", [0.0, 0.3, 0.9])
def test_a_push_wakes_what_sleeps_within_the_next_pixel(direction, gap):
    world, crate = asleep(direction * gap)
    hero = Character(world, Polygon.box(8, 16), (-direction * (HALF + 4.0), 12.0))
    before = crate.position.x
    assert not crate.awake
    for _ in range(20):
        hero.move(direction * 1.0, 1.0)
        world.step()
    assert crate.awake and (crate.position.x - before) * direction > 8.0


def test_a_head_wakes_what_sleeps_above_it():
    world, crate = asleep(0.0)
    world.add_body(Polygon.box(40, 4), position=(-24.0, -17.6), kind="static")
    above = world.add_body(Polygon.box(40, 8), position=(-14.0, -23.6))
    while above.awake:
        world.step()
    hero = Character(world, Polygon.box(8, 16), (3.0, -11.0))
    assert not above.awake and not crate.awake
    hero.move(0.0, -6.0)
    world.step()
    assert above.awake and not crate.awake and above.velocity.y < -1.0


def test_what_he_only_stands_beside_sleeps_on_and_is_given_nothing():
    world, crate = asleep(0.3)
    hero = Character(world, Polygon.box(8, 16), (-HALF - 4.0, 12.0))
    for _ in range(20):
        hero.move(0.0, 1.0)
        world.step()
    assert not crate.awake
