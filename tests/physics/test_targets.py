"""A kinematic body with set_target reaches its target exactly at the end of the next step, then rests.

It carries the bodies on it.
"""

import copy
import math

import numpy as np
import pytest

from physics import SOLVERS, Character, Circle, Polygon, Snapshot, TileGrid, World

PLANK = Polygon.box(80, 10)


@pytest.mark.parametrize("dt", [1 / 60, 1 / 7, 1 / 1000])
@pytest.mark.parametrize("solver", SOLVERS)
def test_it_arrives_exactly_and_stands(solver, dt):
    rng = np.random.default_rng(7)
    world = World(solver=solver)
    off_centre = world.add_body(PLANK, Circle(9, (60, 3)), kind="kinematic", position=(3, 4), angle=0.2)
    still = world.add_body(PLANK, kind="kinematic", position=(500, 0))
    for _ in range(40):
        x, y, angle = (float(each) for each in rng.uniform(-200, 200, 3))
        off_centre.set_target((x, y), angle / 50)
        world.step(dt)
        assert off_centre.position == (x, y) and off_centre.angle == angle / 50
        assert off_centre.velocity == (0, 0) and off_centre.angular_velocity == 0.0
        u = off_centre.to_world(still.world.bodies[["local_center_x", "local_center_y"]][0].item())
        assert off_centre.center == pytest.approx(u)
    for _ in range(3):
        world.step(dt)
        assert off_centre.position == (x, y) and still.position == (500, 0)


def test_the_velocity_is_that_which_leads_there():
    world = World(gravity=(0, 0), dt=0.1)
    lift = world.add_body(PLANK, kind="kinematic")
    lift.set_target((6, -3), 0.5)
    assert lift.velocity == pytest.approx((60, -30)) and lift.angular_velocity == pytest.approx(5)
    lift.set_target((12, 0))
    assert lift.velocity == pytest.approx((120, 0)) and lift.angular_velocity == 0.0, "the angle it has"
    world.step()
    assert lift.position == (12, 0) and lift.angle == 0.0


@pytest.mark.parametrize(
    "change",
    [
        lambda b: setattr(b, "velocity", (30, 0)), lambda b: setattr(b, "angular_velocity", 0.0),
        lambda b: b.move_to((0, 0)), lambda b: setattr(b, "position", (0, 0)), lambda b: b.set_kind("static"),
        lambda b: b.set_kind("dynamic"),
    ],
)  # fmt: skip
def test_another_order_takes_it_back(change):
    world = World(gravity=(0, 0))
    lift = world.add_body(PLANK, kind="kinematic")
    lift.set_target((600, 0))
    change(lift)
    lift.velocity = (0, 0)
    world.step()
    assert lift.position == (0, 0)


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
def test_who_rides_comes_along(solver):
    world = World(solver=solver)
    lift = world.add_body(PLANK, kind="kinematic", position=(0, 100))
    crate = world.add_body(Polygon.box(16, 16), position=(-20, 87))
    hero = Character(world, Polygon.box(10, 20), (20, 85))
    for _ in range(60):
        hero.move(0, 1)
        world.step()
    for k in range(1, 121):
        lift.set_target((k / 10, 100 - k / 20))
        hero.move(0, 1)
        world.step()
    assert crate.position == pytest.approx((-8, 81), abs=0.7)
    assert hero.position == pytest.approx((32, 79), abs=1.5)
    for _ in range(200):
        hero.move(0, 1)
        world.step()
    assert not crate.awake and crate.position.x == pytest.approx(-8, abs=0.7)
    lift.set_target((30, 90))
    world.step()
    assert crate.awake


def test_what_is_in_the_way_is_pushed_with_its_speed():
    world = World(gravity=(0, 0))
    hammer = world.add_body(PLANK, kind="kinematic")
    ball = world.add_body(Circle(5), position=(45.1, 0))
    hammer.set_target((3, 0))
    world.step()
    assert ball.velocity.x == pytest.approx(180, rel=0.05)


@pytest.mark.parametrize("way", ["copy", "snapshot", "file"])
def test_it_is_state(way, tmp_path):
    world = World()
    lift = world.add_body(PLANK, kind="kinematic")
    without = world.digest()
    lift.set_target((5, 5), 0.25)
    with_one = world.digest()
    assert with_one != without
    lift.set_target((5, 5), 0.5)
    assert world.digest() not in (without, with_one)
    lift.set_target((5, 5), 0.25)
    assert world.digest() == with_one
    if way == "copy":
        other = copy.deepcopy(world)
    else:
        other, taken = World(), world.snapshot()
        if way == "file":
            taken.save(tmp_path / "s.npz")
            taken = Snapshot.load(tmp_path / "s.npz")
        other.restore(taken)
    assert other.digest() == with_one
    for each in (world, other):
        each.step()
    assert other.body(0).position == (5, 5) and other.body(0).angle == 0.25 and other.digest() == world.digest()
    world.restore(world.snapshot())
    world.step()
    assert lift.position == (5, 5)


def test_the_digest_holds_what_waits_for_the_next_step():
    plain, aimed, pushed = (World() for _ in range(3))
    lifts = [world.add_body(PLANK, kind="kinematic") for world in (plain, aimed, pushed)]
    for world in (plain, aimed, pushed):
        world.add_body(Circle(4), position=(300, 0))
    lifts[1].set_target((5, 5), 0.25)
    lifts[0].velocity, lifts[0].angular_velocity = lifts[1].velocity, lifts[1].angular_velocity
    assert plain.digest() != aimed.digest(), "one will stop there, the other goes on"
    before = pushed.digest()
    pushed.body(1).apply_force((10, 0))
    assert pushed.digest() != before
    pushed.body(1).apply_force((-10, 0))
    assert pushed.digest() == before


def test_a_body_that_goes_takes_its_target_with_it():
    world = World()
    first, second = (world.add_body(PLANK, kind="kinematic", position=(k * 200, 0)) for k in range(2))
    first.set_target((5, 5)), second.set_target((205, 5))
    first.remove()
    world.step()
    assert second.position == (205, 5)
    second.set_target((7, 7))
    world.bodies["y"] = math.nan
    world.step()
    assert world.events.quarantined["body"].tolist() == [second.id] and second.position == (205, 5)
    second.restore()
    world.step()
    assert second.position == (205, 5), "that target is past"


def test_tiles_are_moved_upright():
    world = World()
    grid = world.add_body(TileGrid(np.ones((2, 2), bool), 16), kind="kinematic")
    grid.set_target((3, 4), 0.0)
    world.step()
    assert grid.position == (3, 4)
    with pytest.raises(ValueError, match="TileGrid"):
        grid.set_target((3, 4), 0.1)
