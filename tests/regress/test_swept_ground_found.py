"""Regression tests of sweeps, one small world for each defect that hostile tests found."""

import math

import numpy as np
import pytest

from physics import Capsule, Chain, Circle, Effects, Material, Polygon, Segment, TileGrid, World, time_of_impact

BLOCKS = Effects(response=True, rotation=True)


@pytest.mark.parametrize("effects", [Effects.rigid_bodies(), Effects(response=True, rotation=True, continuous=True)])
@pytest.mark.parametrize(
    "velocity, turn", [((0.0, 30.0), 0.0), ((0.0, -200.0), 0.0), ((-300.0, 0.0), 0.0), ((0.0, 0.0), 1.0)]
)
def test_a_fast_body_meets_a_wall_that_moves_by_script(effects, velocity, turn):
    world = World(effects, gravity=(0, 0) if effects.gravity else None)
    wall = world.add_body(
        Polygon.box(4, 100), position=(100, 0), kind="kinematic", velocity=velocity, angular_velocity=turn
    )
    ball = world.add_body(Circle(4), position=(50, 0), velocity=(2400, 0), continuous="toi")
    for _ in range(10):
        world.step()
        assert ball.position[0] < wall.position[0]


@pytest.mark.parametrize("shape", [Circle(3), Polygon.box(5, 5), Capsule((-3, 0), (3, 0), 2)])
@pytest.mark.parametrize("bullet", [False, True])
@pytest.mark.parametrize("rests", [False, True])
def test_a_fast_wall_takes_along_what_rests_in_its_way(shape, bullet, rests):
    world = World(gravity=(0, 0))
    wall = world.add_body(Polygon.box(2, 40), position=(-2000 if rests else 0, 0), kind="kinematic", velocity=(1200, 0))
    body = world.add_body(shape, position=(50, 0), bullet=bullet)
    for _ in range(150 if rests else 20):
        world.step()
        assert body.position[0] > wall.position[0]
    assert body.velocity[0] == pytest.approx(1200.0, rel=0.01)


@pytest.mark.parametrize("y", np.arange(8.0, 20.0, 0.5).tolist())
@pytest.mark.parametrize("mover", [Circle(4), Polygon.box(8, 8)])
def test_the_foot_of_a_slope_at_an_open_edge_is_met(mover, y):
    solid, slopes = np.ones((3, 4), bool), np.zeros((3, 4, 2))
    solid[0, 0], slopes[0, 0], solid[0, 0] = False, (0.0, 1.0), False
    grid = TileGrid(solid, 16.0, slopes=slopes)
    found = time_of_impact(mover, (-50, y, 0), (30, y, 0), grid, (0, 0, 0), (0, 0, 0))
    pieces = [Polygon([(0, 16), (16, 0), (16, 16)]), Polygon.box(48, 16, (40, 8)), Polygon.box(64, 32, (32, 32))]
    wanted = min(time_of_impact(mover, (-50, y, 0), (30, y, 0), each, (0, 0, 0), (0, 0, 0)).fraction for each in pieces)
    assert found.hit and found.fraction == pytest.approx(wanted, abs=1e-9)


@pytest.mark.parametrize("solver", ["projection", "soft_step", "sequential_impulse"])
@pytest.mark.parametrize("velocity", [0.0, -25.0, 25.0])
@pytest.mark.parametrize("tilt", [-0.5, 0.1, 0.3])
def test_a_tilted_crate_does_not_fall_through_a_plank(solver, velocity, tilt):
    stacks = solver != "projection"
    effects = Effects(response=True, gravity=True, rotation=True, friction=True, one_way=True, stacking=stacks)
    world = World(effects, solver=solver)
    planks = TileGrid(np.zeros((1, 10), bool), 16.0, one_way=np.ones((1, 10), bool))
    ground = world.add_body(planks, position=(0, 100), kind="kinematic", velocity=(0, velocity))
    crate = world.add_body(Polygon.box(20, 20), position=(80, 70), angle=tilt)
    for _ in range(180):
        world.step()
        assert crate.position[1] < ground.position[1]


@pytest.mark.parametrize("seed", range(24))
def test_what_slides_along_a_round_room_stays_in(seed):
    rng = np.random.default_rng(seed)
    links, size = int(rng.choice([12, 24, 40, 80, 160])), float(rng.choice([60, 120, 300]))
    world = World(
        gravity=(0, 0) if seed % 2 else None,
        substeps=int(rng.choice([1, 4])),
        solver=str(rng.choice(["soft_step", "sequential_impulse"])),
    )
    angles = np.linspace(0.0, math.tau, links, endpoint=False)
    world.add_body(Chain([(size * math.cos(a), -size * math.sin(a)) for a in angles], loop=True), kind="static")
    r = float(rng.uniform(2.0, size / 8.0))
    shape = (Circle(r), Polygon.box(2 * r, 2 * r), Capsule((-r, 0), (r, 0), r / 2), Polygon.box(3 * r, r))[
        rng.integers(4)
    ]
    body = world.add_body(
        shape,
        position=(0.0, size - 2.2 * r - 1.0),
        velocity=(10.0 ** float(rng.uniform(2.5, 4.0)), 0.0),
        material=Material(friction=float(rng.choice([0.0, 0.3])), restitution=float(rng.choice([0.0, 1.0]))),
        continuous=str(rng.choice(["auto", "toi", "swept"])),
    )
    for _ in range(200):
        world.step()
        # The middle of a link is nearest; no centre gets even there.
        assert math.hypot(*body.center) < size


@pytest.mark.parametrize("y", [-4.0, -1.0, 0.0, 0.5, 4.0])
@pytest.mark.parametrize("angle", [0.0, 0.3, 0.7])
def test_an_acute_corner_of_a_chain_is_met(y, angle):
    wedge = Chain([(-60, -10), (60, 0), (-60, 10)], loop=True)
    found = time_of_impact(Polygon.box(20, 20), (150, y, angle), (0, y, angle), wedge, (0, 0, 0), (0, 0, 0))
    solid = Polygon([(-60, -10), (60, 0), (-60, 10)])
    wanted = time_of_impact(Polygon.box(20, 20), (150, y, angle), (0, y, angle), solid, (0, 0, 0), (0, 0, 0))
    assert found.hit and found.fraction == pytest.approx(wanted.fraction, abs=1e-9)


def test_blocking_puts_a_spinner_back_by_its_angle():
    world = World(BLOCKS, solver="blocking")
    world.add_body(*[Segment(a, b) for a, b in (((-40, -40), (40, -40)), ((40, -40), (40, 40)))], kind="static")
    world.add_body(*[Segment(a, b) for a, b in (((40, 40), (-40, 40)), ((-40, 40), (-40, -40)))], kind="static")
    spinner = world.add_body(Polygon.box(30, 6, (12, 0)), position=(-10, 5), velocity=(90, 70), angular_velocity=9.0)
    for _ in range(300):
        world.step()
        x, y = spinner.to_world((12, 0)) if hasattr(spinner, "to_world") else spinner.center
        assert spinner.center == pytest.approx((x, y), abs=1e-9)
        assert max(abs(x), abs(y)) < 40.0


def test_an_impact_with_a_chain_knows_its_link():
    """An impact with a chain uses the material of the link that was hit.

    Before the fix it used that of a link that does not exist.
    """
    effects = Effects(response=True, friction=True, restitution=True, rotation=True, continuous=True)
    world = World(effects, solver="projection")
    bouncy, dull = Material(restitution=1.0, friction=0.0), Material(restitution=0.0, friction=0.0)
    world.add_body(Chain([(-100, 0), (0, 0), (100, 0)], materials=[dull, bouncy]), kind="static")
    balls = [world.add_body(Circle(2), position=(x, -50), velocity=(0, 6000), material=dull) for x in (-50, 50)]
    for _ in range(4):
        world.step()
    assert balls[0].velocity[1] == pytest.approx(0.0, abs=1e-6) and balls[1].velocity[1] == pytest.approx(-6000.0)
