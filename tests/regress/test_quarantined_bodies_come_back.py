"""restore() makes a quarantined body active again: it falls, lands and collides, in sleeping worlds too."""

import math

import pytest

from physics import Circle, Effects, Polygon, World

GROUND = Polygon.box(400, 20)


@pytest.mark.parametrize("steps_out", [1, 2, 120])
@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse", "projection", "blocking"])
def test_a_restored_body_takes_part_again(solver, steps_out):
    world = World(solver=solver)
    world.add_body(GROUND, position=(0, 100), kind="static")
    ball = world.add_body(Circle(8), position=(0, 40))
    world.step()
    world.bodies["vx"] = [0.0, math.nan]
    world.step()
    assert len(world.events.quarantined) == 1 and not ball.awake
    for _ in range(steps_out):
        world.step()
    held = ball.position
    ball.restore()
    assert ball.awake and ball.position == held and ball.velocity == (0, 0)
    world.step()
    assert ball.awake and ball.velocity.y > 0, "gravity is felt in the first step"
    for _ in range(120):
        world.step()
    assert ball.position.y == pytest.approx(82, abs=0.5), "it lies on the ground"


def test_what_slept_when_it_broke_wakes_with_its_neighbours():
    world = World()
    world.add_body(GROUND, position=(0, 100), kind="static")
    lower = world.add_body(Polygon.box(20, 20), position=(0, 80))
    upper = world.add_body(Polygon.box(20, 20), position=(0, 60))
    while lower.awake:
        world.step()
    world.bodies["x"][lower.id] = math.nan
    world.touch([lower])
    world.step()
    assert list(world.events.quarantined["body"]) == [lower.id]
    assert upper.awake, "what stood on it falls"
    lower.restore()
    for _ in range(40):
        world.step()
    assert lower.awake or lower.velocity == (0, 0)
    lower.apply_impulse((0, -50 * lower.mass))
    y = lower.position.y
    world.step()
    assert lower.position.y != y


def test_static_ground_that_broke_bears_again():
    world = World(Effects.rigid_bodies())
    ground = world.add_body(GROUND, position=(0, 100), kind="static")
    ball = world.add_body(Circle(8), position=(0, 80))
    world.bodies["y"][ground.id] = math.inf
    world.touch([ground])
    world.step()
    assert list(world.events.quarantined["body"]) == [ground.id]
    ground.restore()
    for _ in range(120):
        world.step()
    assert ball.position.y == pytest.approx(82, abs=0.5)
