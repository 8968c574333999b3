"""Rarer cases of characters on moving bodies, on each other, and on one-way ground."""

import math

import numpy as np
import pytest

from physics import Character, Circle, Effects, Filter, Polygon, TileGrid, World

EFFECTS = Effects(response=True, one_way=True, sensors=True)
BOX = Polygon.box(10, 20)


def overlaps(a, b):
    """Return whether two character boxes share pixels."""
    (ax, ay), (bx, by) = a.position, b.position
    aw, bw = (a.world.characters.rows[a._row]["width"], b.world.characters.rows[b._row]["width"])
    ah, bh = (a.world.characters.rows[a._row]["height"], b.world.characters.rows[b._row]["height"])
    return abs(ax - bx) * 2 < aw + bw and abs(ay - by) * 2 < ah + bh


@pytest.mark.parametrize("velocity", [(60.0, 0.0), (0.0, -45.0), (37.0, 22.0), (-50.0, -31.0)])
def test_hero_on_a_crate_on_a_platform_is_carried_along(velocity):
    world = World(EFFECTS)
    platform = world.add_body(Polygon.box(64, 16), position=(32, 72), kind="kinematic", velocity=velocity)
    crate = Character(world, Polygon.box(16, 16), (32, 56), pushable=True)
    hero = Character(world, BOX, (32, 38))
    for _ in range(60):
        crate.move(0, 1)
        hero.move(0, 1)
        world.step()
        assert not overlaps(hero, crate)
    crate.move(0, 1)
    moved = hero.move(0, 1)
    assert moved.grounded and moved.riding == crate.body
    assert abs(crate.position[0] - platform.position[0]) <= 1.5
    assert abs(hero.position[0] - crate.position[0]) <= 2.0


def test_crates_in_a_row_are_not_pushed_into_each_other():
    world = World(EFFECTS)
    world.add_body(TileGrid(np.ones((1, 20), bool), 16), position=(0, 48), kind="static")
    crates = [Character(world, Polygon.box(16, 16), (80 + 16 * k, 40), pushable=True) for k in range(2)]
    hero = Character(world, BOX, (40, 38))
    for _ in range(80):
        hero.move(1.3, 1)
        for crate in crates:
            crate.move(0, 2)
        assert not overlaps(*crates) and not any(overlaps(hero, crate) for crate in crates)


def test_falling_crate_lands_on_a_head_and_not_inside_it():
    world = World(EFFECTS)
    world.add_body(TileGrid(np.ones((1, 20), bool), 16), position=(0, 48), kind="static")
    hero = Character(world, BOX, (40, 38), pushable=True)
    crate = Character(world, Polygon.box(16, 16), (40, -40), pushable=True)
    for _ in range(60):
        crate.move(0, 3)
    assert crate.position == (40, 20) and not overlaps(hero, crate)


def test_platform_through_a_one_way_plank_takes_its_rider_along():
    world = World(EFFECTS)
    plank = np.ones((1, 10), bool)
    world.add_body(TileGrid(np.zeros((1, 10), bool), 16, one_way=plank), position=(0, 0), kind="static")
    world.add_body(Polygon.box(64, 16), position=(80, 100), kind="kinematic", velocity=(0.0, -60.0))
    hero = Character(world, BOX, (80, 82))
    hero.move(0, 1)
    for _ in range(90):
        world.step()
        assert hero.move(0, 1).grounded
    assert hero.position[1] == 100 - 90 - 8 - 10


def test_rider_is_scraped_off_by_a_wall_and_stays_out_of_it():
    world = World(EFFECTS)
    world.add_body(TileGrid(np.ones((4, 1), bool), 16), position=(100, 0), kind="static")
    world.add_body(Polygon.box(64, 16), position=(40, 72), kind="kinematic", velocity=(60.0, 0.0))
    hero = Character(world, BOX, (60, 54))
    hero.move(0, 1)
    for _ in range(60):
        world.step()
        hero.move(0, 1)
        assert hero.position[0] + 5 <= 100
    assert hero.position[0] == 95


def test_riders_remainder_is_its_own():
    world = World(EFFECTS)
    platform = world.add_body(Polygon.box(400, 16), position=(0, 72), kind="kinematic", velocity=(18.0, 0.0))
    hero = Character(world, BOX, (0, 54))
    hero.move(0, 1)
    walked = 0
    for _ in range(200):
        world.step()
        walked += hero.move(0.25, 1).x
    assert walked == 50 and abs(hero.position[0] - (50 + platform.position[0])) <= 1.0


@pytest.mark.parametrize("speed", [600.0, 3000.0])
def test_fast_piston_does_not_jump_over_a_character(speed):
    world = World(EFFECTS)
    piston = world.add_body(Polygon.box(8, 60), position=(0, 0), kind="kinematic", velocity=(speed, 0.0))
    hero = Character(world, BOX, (60, 0))
    for _ in range(30):
        world.step()
        hero.move(0, 0)
        assert hero.position[0] > piston.position[0]


def test_filter_lets_characters_pass_what_they_do_not_meet():
    world = World(EFFECTS)
    world.add_body(Polygon.box(16, 200), position=(40, 0), kind="static", filter=Filter(2, 2))
    ghost = Character(world, BOX, (0, 0), filter=Filter(1, 1))
    solid = Character(world, BOX, (0, 50), filter=Filter(2, 2))
    assert ghost.move(80, 0).x == 80 and solid.move(80, 0).x == 27


def test_carried_character_is_seen_by_a_sensor_in_the_same_step():
    world = World(EFFECTS)
    world.add_body(Polygon.box(64, 16), position=(0, 18), kind="kinematic", velocity=(600.0, 0.0))
    world.add_body(Circle(2), position=(30, 0), kind="static", sensor=True)
    hero = Character(world, BOX, (0, 0))
    hero.move(0, 1)
    seen = None
    for _ in range(6):
        world.step()
        if len(world.events.sensor_begin) and seen is None:
            seen = hero.position[0]
        hero.move(0, 1)
    assert seen is not None and 23 <= seen <= 37, "contacts describe the final poses of the step"


def test_round_and_turned_solids_stop_a_character_within_a_pixel():
    for shape, angle, reach in ((Circle(20), 0.0, 20.0), (Polygon.box(28, 28), math.pi / 4, 14 * math.sqrt(2))):
        world = World(EFFECTS)
        world.add_body(shape, position=(0, 0), angle=angle, kind="static")
        hero = Character(world, BOX, (0, -60))
        moved = hero.move(0, 100)
        bottom = hero.position[1] + 10
        assert moved.grounded and -reach - 1 <= bottom <= 0
        assert (
            not world.overlap(Polygon.box(9, 19), (*hero.position, 0), filter=Filter.ALL)[:-1] or bottom <= -reach + 6
        )
