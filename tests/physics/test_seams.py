"""Bodies that slide over tiles and chains in a world feel no seam, to 1e-9 of the speed."""

import math

import numpy as np
import pytest

from physics import JIT, Capsule, Chain, Circle, Effects, Material, Polygon, TileGrid, World

ICE = Material(friction=0.0)
TILES = 200 if JIT else 30
SLIDERS = {
    "box": (Polygon.box(12, 12), 6),
    "circle": (Circle(6), 6),
    "capsule": (Capsule((-6, 0), (6, 0), 5), 5),
    "upright capsule": (Capsule((0, -6), (0, 6), 5), 11),
    "rounded": (Polygon(Polygon.box(8, 8).points, 2), 6),
}


def tiles():
    return TileGrid(np.ones((2, TILES), bool), 8.0)


def chain():
    return Chain([(8.0 * k, 0.0) for k in range(TILES + 1)])


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse", "projection"])
@pytest.mark.parametrize("ground", [tiles, chain], ids=["tiles", "chain"])
@pytest.mark.parametrize("name", SLIDERS)
def test_a_slider_keeps_its_speed_over_every_seam(name, ground, solver):
    shape, half = SLIDERS[name]
    world = World(solver=solver)
    world.add_body(ground(), kind="static", material=ICE)
    body = world.add_body(shape, position=(20.0, -half), velocity=(120.0, 0.0), material=ICE)
    grounded = 0
    while body.position[0] < 8.0 * TILES - 20:
        world.step()
        assert abs(body.velocity[0] - 120.0) <= 1e-9 * 120.0
        assert abs(body.position[1] + half) < 0.05 * 8 and abs(body.angle) < (0.02 if solver == "projection" else 1e-3)
        grounded += len(world.contacts) > 0
        assert len(world.contacts) > 0, "it never leaves the ground"
    assert grounded > 100 or not JIT


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
@pytest.mark.parametrize("name", ["box", "circle", "upright capsule"])
def test_a_body_falls_along_a_wall_as_if_it_were_not_there(name, solver):
    shape, _ = SLIDERS[name]
    world = World(solver=solver)
    world.add_body(TileGrid(np.ones((TILES, 3), bool), 8.0), kind="static", material=ICE)
    core, wide = (shape, {"box": 6, "circle": 6, "upright capsule": 5}[name])
    body = world.add_body(core, position=(24.0 + wide - 0.01, 40.0), material=ICE, continuous="off")
    free = World(solver=solver).add_body(core, position=(0.0, 40.0), continuous="off")
    for _ in range(60 if JIT else 30):
        world.step()
        free.world.step()
    assert body.velocity[1] == pytest.approx(free.velocity[1], rel=1e-9)
    assert abs(body.position[0] - 24.0 - wide) < 0.05 and abs(body.angle) < 1e-4


@pytest.mark.parametrize("name", ["box", "circle", "capsule", "rounded"])
def test_a_driven_body_never_goes_back_on_a_bumpless_chain(name):
    """A body driven at 2 m/s along a chain of unit links never moves back or hops (docs/stability.md, E1).

    The distance travelled is right within 5 %.
    """
    shape, half = SLIDERS[name]
    world = World()
    world.add_body(Chain([(32.0 * k, 0.0) for k in range(-2, 39)]), kind="static", material=ICE)
    body = world.add_body(shape, position=(0.0, -half), material=ICE, fixed_rotation=True)
    before, steps = 0.0, 600 if JIT else 60
    for _ in range(steps):
        body.velocity = (64.0, body.velocity[1])
        world.step()
        assert body.position[0] - before >= -1e-6 and abs(body.position[1] + half) < 0.05 * 32
        before = body.position[0]
    assert before == pytest.approx(64.0 * steps / 60, rel=0.05)


def test_a_ball_rolls_through_a_smooth_valley():
    """A ball in a round valley of many short links loses only the energy that the bends take."""
    count, radius = 60, 300.0
    angles = np.linspace(math.pi, 0.0, count + 1)
    valley = Chain(np.stack([radius * np.cos(angles), radius * np.sin(angles)], axis=1).tolist())
    world = World(Effects.rigid_bodies().with_(sleeping=False), substeps=8)
    world.add_body(valley, kind="static", material=ICE)
    # A link spans a thirtieth of a half turn, 3 degrees: each bend takes the square of its sine off the energy.
    ball = world.add_body(Circle(8.0), position=(-radius * 0.7, radius * 0.7 - 10), material=ICE)
    top, right = 1e9, -1e9
    for _ in range(400 if JIT else 0):
        world.step()
        assert math.hypot(*ball.position) < radius - 8.0 + 1.0, "never through the chain"
        if ball.velocity[0] < 0.0 and right > 0.0:
            break
        right, top = max(right, ball.position[0]), ball.position[1]
    drop = (radius - 8.0) - (radius * 0.7 - 10)
    kept = (radius - 8.0 - top) / drop
    assert kept > 0.9 or not JIT
