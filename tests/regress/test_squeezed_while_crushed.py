"""`squeezed` is reported in every move in which a kinematic body overlaps the character, whether the body moves or
rests.
"""

import math

import numpy as np
import pytest

from physics import JIT, Capsule, Character, Circle, Effects, PixelMask, Polygon, TileGrid, World, collide

EFFECTS = {"plain": Effects(response=True, gravity=True), "stacking": Effects.rigid_bodies()}
HEROES = {"box": Polygon.box(10, 20), "capsule": Capsule((0, -5), (0, 5), 5.0)}
CRUSHERS = {
    "box": (Polygon.box(30, 10), 0.0, 0.0),
    "turned box": (Polygon.box(30, 10), 0.0, 0.2),
    "disc": (Circle(8.0), 0.0, 0.0),
    "tiles": (TileGrid(np.ones((1, 3), bool), 10.0), -15.0, 0.0),
    "mask": (PixelMask.from_array(np.ones((10, 30), bool)), 0.0, 0.0),
}
TOUCHES = 3.0  # [px] in a body that is no box, a character may be by its feet and a little more


def crushed(effects, hero, crusher, speed, down, stop, up, times=1):
    """Move a crusher onto a character. Return a list of (all moves report squeezed, no move does, depth, head).

    Each step gives one entry. The crusher moves at `speed` for `down` steps, rests for `stop` steps and moves back for
    `up` steps. times: number of moves of the character in each step. depth: overlap of the two [px]. head: height of
    the character's centre above the lower side of a box crusher, negative if it is below [px].
    """
    world = World(effects)
    world.add_body(Polygon.box(200, 20), position=(0, 10), kind="static")
    who = Character(world, HEROES[hero], (0, -10))
    shape, x, angle = CRUSHERS[crusher]
    body = world.add_body(shape, position=(x, -36), angle=angle, kind="kinematic", velocity=(0, speed))
    found = []
    for step in range(down + stop + up):
        if step == down:
            body.velocity = (0.0, 0.0)
        if step == down + stop:
            body.velocity = (0.0, -4.0 * speed)
        world.step()
        told = [who.move(0, 0).squeezed for _ in range(times)]
        where = collide(who.body.shapes[0], (*who.position, 0.0), shape, (*body.position, body.angle))
        found.append(
            (all(told), not any(told), -min(where.separations, default=0.0), body.position[1] + 5.0 - who.position[1])
        )
    return found


@pytest.mark.parametrize("crusher", CRUSHERS)
@pytest.mark.parametrize("hero", HEROES)
@pytest.mark.parametrize("effects", EFFECTS)
def test_it_is_told_without_a_gap(effects, hero, crusher):
    found = crushed(EFFECTS[effects], hero, crusher, 10.0, 120, 20, 0, times=3)
    first = next(k for k, each in enumerate(found) if each[0])
    assert all(each[1] for each in found[:first]) and all(each[0] for each in found[first:])
    assert found[first][2] <= TOUCHES and found[-1][2] > TOUCHES


@pytest.mark.parametrize("hero", HEROES)
@pytest.mark.parametrize("speed", [2.0, 10.0, 47.0])
def test_a_box_squeezes_as_long_as_it_shares_a_pixel(speed, hero):
    """A box crusher squeezes the character exactly while the two share a pixel.

    They do while the lower side of the box is below the upper side of the character, whose position is in whole pixels.
    """
    down = round(16.0 / speed * 60)
    found = crushed(EFFECTS["plain"], hero, "box", speed, down, 10, down // 2)
    assert any(each[0] for each in found) and found[-1][1]
    before = False
    for always, never, _, head in found[: down + 10]:  # later it takes him along
        inside = math.floor(head + 10.0 + 0.5) > 0
        if always:
            assert inside or before or hero == "capsule"  # it was in it after the move before
        before = inside
        if hero == "box" and inside:
            assert always
        assert always != never


def test_it_is_told_once_more_after_it_left_between_two_moves():
    """A crusher that left the character before a move is still reported by this move, and by no later one."""
    world = World(EFFECTS["plain"])
    world.add_body(Polygon.box(200, 20), position=(0, 10), kind="static")
    hero = Character(world, HEROES["box"], (0, -10))
    crusher = world.add_body(Polygon.box(30, 10), position=(0, -28), kind="kinematic", velocity=(0, 300))
    world.step()
    crusher.velocity = (0.0, -3000.0)
    world.step()
    assert hero.move(0, 0).squeezed and not hero.move(0, 0).squeezed


def test_it_goes_on_after_a_snapshot():
    world = World(EFFECTS["stacking"])
    world.add_body(Polygon.box(200, 20), position=(0, 10), kind="static")
    hero = Character(world, HEROES["box"], (0, -10))
    world.add_body(Polygon.box(30, 10), position=(0, -28), kind="kinematic", velocity=(0, 20))
    for _ in range(60 if JIT else 30):
        world.step()
        hero.move(0, 0)
    assert hero.move(0, 0).squeezed
    taken, digest = world.snapshot(), world.digest()
    hero.move_to((80.0, -10.0))
    assert not hero.move(0, 0).squeezed
    world.restore(taken)
    assert world.digest() == digest and hero.move(0, 0).squeezed
