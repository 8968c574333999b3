"""Characters on one-way masks: they walk the curve, jump up through the mask, drop through it, and are carried."""

import numpy as np
import pytest

from physics import Capsule, Character, Effects, Polygon
from tests.physics.test_one_way_masks import TOP, arched, plank, surface_y, world_with

HERO = Effects(response=True, one_way=True)


def hero_on(world, shape, x, y):
    hero = Character(world, shape, (x, y))
    for _ in range(200):
        if hero.move(0, 1).grounded:
            return hero
    raise AssertionError("it never arrived")


HEROES = {"box": Polygon.box(10, 20), "capsule": Capsule((0, -5), (0, 5), 5)}


@pytest.mark.parametrize("name", HEROES)
def test_a_character_walks_its_curve(name):
    mask = arched()
    world, body = world_with(mask, HERO)
    hero = hero_on(world, HEROES[name], 20.0, TOP - 40)
    for _ in range(60):
        moved = hero.move(2, 1)
        assert moved.grounded and moved.x == 2 and moved.wall == 0
        x, y = hero.position
        under = [surface_y(mask, u) for u in np.linspace(max(x - 5, 0), min(x + 5, 160), 21)]
        feet = y + 10.0 - TOP
        # It stands on some point under its feet, as pixels go.
        assert min(under) - 2.0 <= feet <= max(under) + 1.5
    assert hero.position[0] == 140.0


@pytest.mark.parametrize("name", HEROES)
def test_a_character_jumps_through_it_stands_and_drops(name):
    world, body = world_with(plank(), HERO)
    hero = Character(world, HEROES[name], (32, TOP + 40))
    for _ in range(40):
        assert hero.move(0, -1).y == -1  # nothing is in its way
    # Half through, its middle is above the line by now: it falls back.
    hero_back = hero.position
    for _ in range(8):
        hero.move(0, -1)
    for _ in range(60):
        assert hero.move(0, 1).y == 1
    assert hero.position[1] > hero_back[1]
    for _ in range(90):
        hero.move(0, -1)
    while not hero.move(0, 1).grounded:
        assert hero.position[1] < TOP
    assert hero.position[1] + 10 == pytest.approx(TOP, abs=1.0)
    for _ in range(20):
        assert hero.move(1, 1).x == 1
    hero.move(0, 1, drop=True)
    for _ in range(20):
        assert hero.move(0, 2).y == 2


@pytest.mark.parametrize("name", HEROES)
def test_a_character_comes_in_from_a_side(name):
    """A character that walks into the end of a one-way plank from the side is not stopped; its feet are below the
    surface.
    """
    world, _ = world_with(plank(), HERO)
    hero = Character(world, HEROES[name], (-20, TOP - 5))
    for _ in range(60):
        moved = hero.move(2, 0)
        assert moved.x == 2 and moved.wall == 0 and not moved.grounded


@pytest.mark.parametrize("name", HEROES)
def test_a_character_is_carried(name):
    mask = arched()
    world, lift = world_with(mask, HERO, kind="kinematic")
    hero = hero_on(world, HEROES[name], 80.0, TOP - 40)
    start = hero.position
    lift.velocity = (30, -45)
    for _ in range(60):
        world.step()
        hero.move(0, 1)
    assert hero.position[0] - start[0] == pytest.approx(30, abs=1.0)
    assert hero.position[1] - start[1] == pytest.approx(-45, abs=1.5)
    below = Character(world, HEROES[name], (lift.position.x + 40, lift.position.y + 90))
    lift.velocity = (0, 60)
    place = below.position
    for _ in range(140):
        world.step()
        hero.move(0, 1)
        assert not below.move(0, 0).squeezed
        if lift.position.y + surface_y(mask, place[0] - lift.position.x) < place[1] + 10 - 4:
            assert below.position == place  # until it is at its feet
    assert hero.move(0, 1).grounded


@pytest.mark.parametrize("name", HEROES)
@pytest.mark.parametrize("x", [20.0, 47.0, 80.0, 131.0])
def test_one_pixel_is_enough_to_drop_through_its_curve(name, x):
    world, _ = world_with(arched(), HERO)
    hero = hero_on(world, HEROES[name], x, TOP - 40)
    height = hero.position[1]
    assert hero.move(0, 1).y == 0
    hero.move(0, 1, drop=True)
    for _ in range(20):
        assert hero.move(0, 1).y == 1
    assert hero.position[1] == height + 21
