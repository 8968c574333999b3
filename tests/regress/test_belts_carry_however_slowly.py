"""A body on a moving surface does not sleep, however slow the surface is."""

import pytest

from physics import Chain, Circle, Effects, Material, Polygon, World

BELTS = {
    "box": lambda speed: (Polygon.box(4000, 20), (0, 10), Material(surface_speed=speed)),
    "chain": lambda speed: (Chain([(-2000, 0), (2000, 0)]), (0, 0), Material(surface_speed=speed)),
    "link": lambda speed: (
        Chain([(-2000, 0), (0, 0), (2000, 0)], materials=[Material(surface_speed=speed)] * 2),
        (0, 0),
        Material(),
    ),
}
CRATES = {"box": Polygon.box(20, 20), "disc": Circle(10.0)}


def on_belt(speed, belt="box", effects=None, **options):
    world = World((effects or Effects.rigid_bodies()).with_(conveyor=True), **options)
    shape, place, material = BELTS[belt](speed)
    world.add_body(shape, position=place, kind="static", material=material)
    return world


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
@pytest.mark.parametrize("belt", BELTS)
@pytest.mark.parametrize("speed", [0.01, 0.5, -1.5, 1.7])
def test_a_crate_stays_awake_and_keeps_the_belts_speed(speed, belt, solver):
    world = on_belt(speed, belt, solver=solver)
    crate = world.add_body(Polygon.box(20, 20), position=(0, -10))
    for _ in range(30):
        world.step()
    start = crate.position[0]
    for _ in range(90):
        world.step()
        assert crate.awake
    assert crate.position[0] - start == pytest.approx(1.5 * speed, rel=0.02)


def test_what_is_stacked_on_it_goes_along():
    world = on_belt(1.0)
    pile = [world.add_body(Polygon.box(20, 20), position=(0, -10 - 20 * k)) for k in range(3)]
    for _ in range(150):
        world.step()
    assert all(each.awake and each.position[0] == pytest.approx(2.5, rel=0.05) for each in pile)


def test_what_carries_its_own_belt_goes_on():
    """A body whose own material has a surface speed moves on ground and stays awake."""
    world = World(Effects.rigid_bodies().with_(conveyor=True))
    world.add_body(Polygon.box(4000, 20), position=(0, 10), kind="static")
    crate = world.add_body(Polygon.box(20, 20), position=(0, -10), material=Material(surface_speed=1.0))
    for _ in range(120):
        world.step()
    assert crate.awake and abs(crate.position[0]) == pytest.approx(2.0, rel=0.05)


def test_beside_it_and_without_the_effect_crates_sleep():
    """A belt keeps the bodies on it awake, and no others; without the effect it is inert."""
    world = on_belt(1.0)
    world.add_body(Polygon.box(200, 20), position=(4000, 10), kind="static")
    beside = world.add_body(Polygon.box(20, 20), position=(4000, -10))
    near = world.add_body(Polygon.box(20, 20), position=(2010.4, 20), gravity_scale=0.0)  # its end is near, not met
    inert = World(Effects.rigid_bodies())
    shape, place, material = BELTS["box"](1.0)
    inert.add_body(shape, position=place, kind="static", material=material)
    resting = inert.add_body(Polygon.box(20, 20), position=(0, -10))
    for _ in range(90):
        world.step(), inert.step()
    assert not beside.awake and not near.awake and not resting.awake
