"""Bodies that start at one position separate no faster than the push-out speed, whatever the number of contacts."""

import numpy as np
import pytest

from physics import JIT, Circle, Effects, Material, Polygon, World

SOLVERS = ("projection", "sequential_impulse", "soft_step")
CROWDS = {
    "one point": lambda k, rng: (0.0, 0.0),
    "a line": lambda k, rng: (2.0 * k, 0.0),
    "a loose line": lambda k, rng: (8.0 * k, 0.0),
    "a heap": lambda k, rng: tuple(rng.normal(0.0, 4.0, 2)),
}


def still_world(solver, **effects):
    stacking = solver in SOLVERS[1:]
    chosen = Effects(response=True, rotation=True, friction=True, restitution=True).with_(stacking=stacking, **effects)
    return World(chosen, solver=solver, gravity=(0, 0))


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("crowd", CROWDS)
@pytest.mark.parametrize("shape", [Circle(5.0), Polygon.box(10, 10)], ids=["discs", "boxes"])
def test_nobody_is_moved_faster_than_a_push_out(solver, crowd, shape):
    world, rng = still_world(solver), np.random.default_rng(3)
    for k in range(128 if JIT else 24):
        world.add_body(shape, position=CROWDS[crowd](k, rng), material=Material(restitution=0.5))
    cap = world.tolerances.push_speed
    moved = 0.0
    for _ in range(40 if JIT else 8):
        world.step()
        b = world.bodies
        way = np.hypot(b["center_x"] - b["previous_x"], b["center_y"] - b["previous_y"]).max()
        moved = max(moved, way)
        assert way <= cap * world.dt * (1.0 + 1e-9)
        assert np.hypot(b["vx"], b["vy"]).max() <= cap * (1.0 + 1e-9)
    assert moved > 0.0


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_crowd_gets_apart(solver):
    world = still_world(solver)
    rng = np.random.default_rng(5)
    for _ in range(12):
        world.add_body(Circle(5.0), position=tuple(rng.normal(0.0, 1.0, 2)))
    for _ in range(600 if JIT else 300):
        world.step()
    assert min(world.contacts["separation"], default=0.0) >= -world.tolerances.slop


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("speed", [60.0, 200.0, 845.0, 1500.0])
def test_discs_without_bounce_stay_together(solver, speed):
    """Discs without restitution stay together after an impact.

    They may separate at a hundredth of the speed of the impact, or at the speed of four slops in ten steps if that is
    more.
    """
    world = still_world(solver)
    a = world.add_body(Circle(8.0), position=(-40.0, 0.0), velocity=(0.5 * speed, 0.0))
    b = world.add_body(Circle(8.0), position=(40.0, 0.0), velocity=(-0.5 * speed, 0.0))
    for _ in range(120):
        world.step()
    slow = 4.0 * world.tolerances.slop / (10.0 * world.dt)
    assert b.velocity[0] - a.velocity[0] <= max(0.01 * speed, slow) + 1e-9


def test_what_comes_fast_is_pushed_out_at_once_by_projection():
    """Projection pushes a fast body out at once, because the limit on the push-out applies to old overlap only."""
    world = World(Effects(response=True, gravity=True), gravity=(0, 0))
    world.add_body(Polygon.box(400, 100), position=(0, 50), kind="static")
    box = world.add_body(Polygon.box(20, 20), position=(0, -12), velocity=(0.0, 900.0), continuous="off")
    world.step()
    assert box.position[1] == pytest.approx(-10.0, abs=1e-9)


def test_a_column_under_projection_sinks_and_then_no_more():
    """Under projection a column sinks a little, then stops.

    A limit on each push alone let the lowest crates sink into the ground and each other without end.
    """
    world = World(Effects(response=True, gravity=True), solver="projection")
    world.add_body(Polygon.box(400, 40), position=(0, 20), kind="static")
    column = [world.add_body(Polygon.box(16, 16), position=(0, -8 - 16 * k)) for k in range(10)]
    heights = []
    for _ in range(3):
        for _ in range(120):
            world.step()
        heights.append([each.position[1] for each in column])
    assert heights[2] == pytest.approx(heights[1], abs=0.05)
    assert min(world.contacts["separation"]) > -2.0
