"""Stages without work are not in the plan, and counters count only tests that are made."""

import copy

import pytest

from physics import Bounds, Character, Circle, Effects, PixelMask, Polygon, World

FOR_CHARACTERS = {"carry", "weigh"}
WORLDS = {
    "projection": (Effects(response=True), None),
    "blocking": (Effects(response=True, gravity=True), "blocking"),
    "soft step": (Effects.rigid_bodies(), None),
    "impulses": (Effects.rigid_bodies(), "sequential_impulse"),
    "piles pushed": (Effects.rigid_bodies(), "projection"),
}


@pytest.mark.parametrize("name", WORLDS)
def test_what_is_done_for_characters_is_there_while_there_is_one(name):
    effects, solver = WORLDS[name]
    wanted = {"carry", "weigh"} if effects.stacking else {"carry"}
    world = World(effects, solver=solver)
    world.add_body(Polygon.box(100, 10), position=(0, 10), kind="static")
    world.add_body(Polygon.box(10, 10), position=(40, 0))
    nobody = world.snapshot()

    def found():
        world.step()
        assert list(world.profile.stages) == world.stages
        return FOR_CHARACTERS & set(world.stages)

    without = list(world.stages)
    assert found() == set()
    hero = Character(world, Polygon.box(10, 20), (0, -5))
    assert found() == wanted
    assert [each for each in world.stages if each not in wanted] == without
    somebody = world.snapshot()
    other = Character(world, Polygon.box(10, 20), (-30, -5))
    hero.remove()
    assert found() == wanted
    other.remove()
    assert found() == set()
    world.restore(somebody)
    assert found() == wanted
    world.restore(nobody)
    assert found() == set()
    Character(world, Polygon.box(10, 20), (0, -5))
    world = copy.deepcopy(world)
    assert found() == wanted
    world.clear()
    assert found() == set()


@pytest.mark.parametrize("stacking", [False, True])
def test_boxes_alone_are_no_narrow_test(stacking):
    """A world without a narrow phase reports overlapping boxes as contacts, or as sensor events.

    No narrow test is counted.
    """
    effects = Effects(narrowphase=False, sensors=True, response=stacking, stacking=stacking)
    world = World(effects, gravity=(0, 0))
    for k, shape in enumerate((Circle(5), Polygon.box(8, 8), Bounds(Circle(5)), PixelMask.from_array([[1] * 9] * 9))):
        world.add_body(shape, position=(7.0 * k, 0.0))
    world.add_body(Circle(9.0), position=(0, 6), kind="static", sensor=True)
    world.step()
    counters = world.profile.counters
    assert counters["narrow_tests"] == counters["mask_tests"] == counters["gjk_iterations"] == 0
    assert counters["sensor_tests"] > 0 and len(world.events.sensor_begin) and len(world.contacts)
    world.set_narrowphase(True)
    world.step()
    assert world.profile.counters["narrow_tests"] > 0
