"""Changes of gravity, wind or drag wake the bodies that rest under them; a change without effect wakes none."""

import pytest

from physics import Circle, Effects, Polygon, World

WINDY = Effects.rigid_bodies().with_(wind=True, drag=True)


def asleep(effects, **settings):
    world = World(effects, **settings)
    world.add_body(Polygon.box(4000, 20), position=(0, 100), kind="static")
    ball = world.add_body(Circle(8), position=(0, 82))
    for _ in range(200):
        world.step()
    assert not ball.awake
    return world, ball


@pytest.mark.parametrize("name, value", [("wind", (300, 0)), ("gravity", (500, 300))])
def test_a_new_force_moves_what_slept(name, value):
    world, ball = asleep(WINDY, drag=0.5)
    setattr(world, name, value)
    assert ball.awake
    for _ in range(30):
        world.step()
    assert ball.position.x > 1.0


def test_more_drag_lets_the_wind_move_what_slept():
    world, ball = asleep(Effects.rigid_bodies().with_(wind=True, drag=True), drag=0.0, wind=(300, 0))
    world.drag = 2.0
    for _ in range(30):
        world.step()
    assert ball.position.x > 1.0


@pytest.mark.parametrize("name", ["wind", "drag", "gravity"])
def test_the_same_value_wakes_nobody(name):
    world, ball = asleep(WINDY, drag=0.5)
    setattr(world, name, getattr(world, name))
    assert not ball.awake


@pytest.mark.parametrize("name, value", [("wind", (300, 0)), ("drag", 2.0)])
def test_what_is_not_felt_is_refused_and_wakes_nobody(name, value):
    world, ball = asleep(Effects.rigid_bodies())
    with pytest.raises(ValueError, match=f"needs the effect {name}"):
        setattr(world, name, value)
    assert not ball.awake
