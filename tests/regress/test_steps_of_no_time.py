"""step(0) moves nothing and keeps forces and targets for the next step, under every solver."""

import pytest

from physics import SOLVERS, Character, Circle, Polygon, World

FREE = {"gravity": (0, 0)}


@pytest.mark.parametrize("times", [1, 3])
@pytest.mark.parametrize("solver", SOLVERS)
def test_forces_wait_for_a_step_that_takes_time(solver, times):
    waiting, plain = World(solver=solver, **FREE), World(solver=solver, **FREE)
    bodies = [world.add_body(Polygon.box(10, 6), angle=0.3) for world in (waiting, plain)]
    for body in bodies:
        body.apply_force((3000, -1500), body.position + (2, 1))
        body.apply_torque(500)
    for _ in range(times):
        waiting.step(0)
        assert bodies[0].velocity == (0, 0) and bodies[0].position == (0, 0)
    for world in (waiting, plain):
        world.step()
    assert bodies[0].velocity == bodies[1].velocity != (0, 0)
    assert bodies[0].angular_velocity == bodies[1].angular_velocity != 0
    for world in (waiting, plain):
        world.step()
    assert bodies[0].velocity == bodies[1].velocity, "and are spent after it"


def test_forces_wait_in_one_step_of_no_time_between_others():
    world = World(**FREE)
    body = world.add_body(Circle(4))
    body.apply_force((body.mass * 60, 0))
    world.step(0)
    body.apply_force((body.mass * 60, 0))
    world.step()
    assert body.velocity.x == pytest.approx(2.0)


def test_a_character_that_stands_on_a_body_weighs_no_more_after_it():
    found = []
    for idle in (0, 5):
        world = World()
        world.add_body(Polygon.box(400, 20), position=(0, 100), kind="static")
        crate = world.add_body(Polygon.box(40, 20), position=(0, 80))
        hero = Character(world, Polygon.box(10, 20), (0, 60))
        for _ in range(10):
            hero.move(0, 1)
            for _ in range(idle):
                world.step(0)
            world.step()
        found.append(crate.position)
    assert found[0] == pytest.approx(found[1], abs=1e-9)


@pytest.mark.parametrize("solver", SOLVERS)
def test_targets_wait_too(solver):
    world = World(solver=solver, **FREE)
    lift = world.add_body(Polygon.box(40, 8), kind="kinematic")
    lift.set_target((0, -5))
    world.step(0)
    assert lift.position == (0, 0)
    world.step(1 / 30)
    assert lift.position == (0, -5) and lift.velocity == (0, 0)


@pytest.mark.parametrize("solver", SOLVERS)
def test_nothing_moves(solver):
    world = World(solver=solver)
    world.add_body(Polygon.box(100, 20), position=(0, 30), kind="static")
    for k in range(4):
        world.add_body(Circle(8), position=(k, 20 - 11 * k), velocity=(40, 90), angular_velocity=2.0)
    for _ in range(3):
        poses = [(body.position, body.angle) for body in world]
        time = world.time
        world.step(0)
        assert [(body.position, body.angle) for body in world] == poses and world.time == time
        world.step()
