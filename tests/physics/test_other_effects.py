"""A world whose effects are replaced between two steps continues as a world that was created with them."""

from dataclasses import fields

import numpy as np
import pytest

from physics import JIT, Capsule, Character, Circle, Effects, Material, PixelMask, Polygon, TileGrid, World

EFFECTS = [field.name for field in fields(Effects)]
ALL = Effects.named(EFFECTS)
KINDS = (Circle(6), Polygon.box(12, 12), PixelMask(np.ones((10, 9), bool)), Capsule((-4, 0), (4, 0), 4))
STEPS = 40 if JIT else 15


def yard(effects):
    """Return a world of bodies of many kinds over a conveyor floor; no body rotates yet."""
    wind = (60, 0) if effects.wind else (0, 0)
    world = World(effects, drag=0.4, wind=wind)
    floor = Material(friction=0.5, surface_speed=40)
    world.add_body(Polygon.box(400, 20), position=(0, 100), kind="static", material=floor)
    world.add_body(TileGrid(np.ones((1, 6), bool), 16), position=(-200, 40), kind="static")
    chance = np.random.default_rng(1)
    for number in range(14):
        place = chance.uniform((-100, 0), (100, 80))
        world.add_body(KINDS[number % 4], position=place, material=Material(friction=0.5, restitution=0.4))
    world.add_body(Circle(2), position=(-300, 30), velocity=(3000, 0))
    return world


def poses(world):
    """Return an array (3, n) with x, y and angle of all bodies."""
    return np.stack([world.bodies[name] for name in ("x", "y", "angle")])


@pytest.mark.parametrize("name", EFFECTS)
def test_switched_before_the_first_step_it_is_the_world_made_so(name):
    made, switched = yard(ALL.without(name)), yard(ALL)
    switched.set_effects(ALL.without(name))
    assert switched.stages == made.stages and switched.solver == made.solver
    for _ in range(STEPS):
        made.step()
        switched.step()
        assert np.array_equal(poses(made), poses(switched))
    if name != "response":  # its masks have new ids
        assert made.digest() == switched.digest()


@pytest.mark.parametrize("name", EFFECTS)
def test_an_effect_goes_and_comes_back_in_the_middle(name):
    world, made = yard(ALL), yard(ALL)
    for effects in (ALL, ALL.without(name), ALL):
        world.set_effects(effects)
        for _ in range(STEPS):
            world.step()
        assert world.effects == effects and world.stages == World(effects).stages
        assert np.isfinite(poses(world)).all()
    assert len(world.shapes) == len(made.shapes) and np.array_equal(world.bodies["mass"], made.bodies["mass"])


def test_the_same_effects_again_change_nothing_but_that_all_wake():
    world, untouched = yard(ALL.with_(sleeping=False)), yard(ALL.with_(sleeping=False))
    for _ in range(STEPS):
        world.set_effects(world.effects)
        for each in (world, untouched):
            each.step()
        assert world.digest() == untouched.digest()


def test_what_sleeps_wakes_where_sleep_goes():
    world = World(ALL)
    world.add_body(Polygon.box(400, 20), position=(0, 20), kind="static")
    box = world.add_body(Polygon.box(20, 20))
    for _ in range(120):
        world.step()
    assert not box.awake and not len(world.contacts)
    world.set_effects(ALL.without("sleeping"))
    world.step()
    assert box.awake and len(world.contacts) == 2


def test_a_sprite_keeps_its_tier():
    world = World(Effects())
    sprite = world.add_body(PixelMask(np.ones((9, 9), bool)), tier="obb")
    world.set_effects(Effects(response=True))
    assert sprite.tier == "obb"
    sprite.tier = "mask"
    assert len(world.shapes) > 1, "its outline has parts where it is pushed"
    world.set_effects(Effects())
    assert len(world.shapes) == 1 and sprite.tier == "mask"


def test_what_was_asked_of_a_body_waits_for_its_effect():
    world = World(Effects(rotation=True, gravity=True))
    ball = world.add_body(Circle(4), angular_velocity=2.0)
    world.set_effects(Effects(gravity=True))
    world.step()
    assert ball.angle == 0.0 and ball.angular_velocity == 2.0
    with pytest.raises(ValueError, match="needs the effect rotation"):
        ball.angular_velocity = 3.0
    world.set_effects(Effects(rotation=True, gravity=True))
    world.step()
    assert ball.angle == pytest.approx(2.0 / 60)


def test_characters_need_response():
    world = World(Effects(response=True, gravity=True))
    Character(world, Polygon.box(8, 8), (0, 0))
    with pytest.raises(ValueError, match="response"):
        world.set_effects(Effects(gravity=True))
    assert world.effects.response


def test_an_effect_goes_with_what_needs_it_and_comes_with_what_it_needs():
    assert ALL.without("stacking") == ALL.with_(stacking=False, sleeping=False, joints=False)
    kept = [name for name in EFFECTS if name not in ("response", "friction", "restitution", "stacking", "one_way")]
    assert ALL.without("response").names() == [name for name in kept if name not in ("conveyor", "joints", "sleeping")]
    assert Effects().without("drag") == Effects() and ALL.without("drag") == ALL.with_(drag=False)
    assert Effects().and_needed("sleeping").names() == ["narrowphase", "response", "stacking"]
    assert Effects().and_needed("wind") == Effects()
    with pytest.raises(TypeError, match="no effect magnetism"):
        ALL.without("magnetism")
