"""A character placed inside a static solid moves out a little in each move, or stays in place."""

import numpy as np
import pytest

from physics import Bounds, Chain, Character, Circle, Effects, PixelMask, Polygon, TileGrid, World

HERO = Polygon.box(10, 20)
GROUND = np.zeros((8, 12), bool)
GROUND[5:, :] = True  # its surface at y = 80


def room(*solids):
    world = World(Effects(response=True), gravity=(0, 0))
    for shape, place in solids:
        world.add_body(shape, position=place, kind="static")
    return world


def moves(hero, count, dx=0.0, dy=0.0):
    return [hero.move(dx, dy)[:2] for _ in range(count)]


@pytest.mark.parametrize("shape", [HERO, Circle(10), Bounds(Polygon.box(10, 20))])
@pytest.mark.parametrize(
    "solid, place",
    [
        (TileGrid(GROUND, 16), (0, 0)),
        (Polygon.box(192, 60), (96, 110)),
        (PixelMask(np.ones((60, 192), bool), origin=(0, 0)), (0, 80)),
    ],
    ids=["tiles", "box", "mask"],
)
def test_comes_up_out_of_the_ground_by_two_pixels_a_move(shape, solid, place):
    world = room((solid, place))
    hero = Character(world, shape, (96, 70))
    assert moves(hero, 2) == [(0, 0)] * 2, "it stands on the ground: nothing to leave"
    hero.move_to((96, 77))
    assert moves(hero, 5) == [(0, -2)] * 3 + [(0, -1), (0, 0)]
    assert hero.position == (96, 70) and hero.move(0.0, 1.0).grounded


@pytest.mark.parametrize("way", [-1, 1])
def test_leaves_a_wall_by_the_side_that_is_nearer_also_when_told_to_go_deeper(way):
    world = room((Polygon.box(40, 400), (0, 0)))
    hero = Character(world, HERO, (way * 21, 0))
    assert moves(hero, 3, dx=-3.0 * way) == [(2 * way, 0), (2 * way, 0), (0, 0)]
    assert hero.position == (way * 25, 0)


def test_leaves_a_wall_that_is_built_around_it():
    world = room((TileGrid(GROUND, 16), (0, 0)))
    hero = Character(world, HERO, (88, 70))
    assert hero.move(0.0, 1.0).grounded
    world.add_body(Polygon.box(16, 16), position=(86, 72), kind="static")
    way = moves(hero, 8)
    assert hero.position == (99, 70) and way == [(2, 0)] * 5 + [(1, 0), (0, 0), (0, 0)]


def test_stays_where_nothing_is_free_within_its_own_size():
    world = room((Polygon.box(400, 400), (0, 0)))
    hero = Character(world, HERO, (0, 0))
    assert moves(hero, 5, dx=3.0) == [(0, 0)] * 5 and hero.position == (0, 0)
    assert hero.blocked(1.0, 0.0)


def test_does_not_leave_one_solid_for_another_or_for_another_character():
    """A character inside a solid does not move out into another solid or into another character.

    The nearest way out, to the right, is closed by a wall. In the second case another character stands on the way up.
    """
    world = room((Polygon.box(20, 30), (0, 0)), (Polygon.box(20, 400), (26, 0)))
    hero = Character(world, HERO, (9, -14))
    for _ in range(20):
        hero.move(0.0, 0.0)
    assert hero.position == (9, -25)
    other = Character(world, HERO, (9, -25), pushable=True)
    hero.move_to((9, -14))
    for _ in range(20):
        hero.move(0.0, 0.0)
    x, y = hero.position
    ox, oy = other.position
    assert abs(x - ox) >= 10 or abs(y - oy) >= 20
    assert not (abs(x) < 15 and abs(y) < 25) and not (abs(x - 26) < 15)


def test_from_behind_a_chain_and_inside_a_one_way_tile_it_goes_where_it_is_told():
    """A character behind a chain or inside a one-way tile is not moved out; both stop bodies from one side only."""
    world = World(Effects(response=True, one_way=True), gravity=(0, 0))
    world.add_body(Chain([(-100, 0), (100, 0)]), kind="static")
    hero = Character(world, HERO, (0, 12))
    assert moves(hero, 3) == [(0, 0)] * 3
    one_way = np.zeros((3, 3), bool)
    one_way[1, 1] = True
    world.add_body(TileGrid(np.zeros((3, 3), bool), 16, one_way=one_way), position=(400, 0), kind="static")
    hero.move_to((424, 24))
    assert moves(hero, 3) == [(0, 0)] * 3
