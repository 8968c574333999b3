"""Regression tests of the physics, one small scene for each defect that the first hostile tests found."""

import math

import numpy as np
import pytest

from physics import (
    BROADPHASES,
    Bounds,
    BruteForce,
    Character,
    Circle,
    Effects,
    Material,
    PixelMask,
    Polygon,
    TileGrid,
    World,
    collide,
)

ALL = Effects(
    response=True, gravity=True, rotation=True, friction=True, restitution=True, continuous=True, sensors=True
)


@pytest.mark.parametrize("name", BROADPHASES)
def test_world_that_was_cleared_after_a_new_broad_phase_steps(name):
    world = World(Effects())
    world.add_bodies(Circle(5), [(0, 0), (1, 0)])
    world.step()
    world.broadphase = BROADPHASES[name]()
    world.clear()
    world.step()
    assert len(world.candidates) == 0 and len(world.events.end) == 1
    world.add_bodies(Circle(5), [(0, 0), (1, 0), (2, 0)])
    world.step()
    assert len(world.candidates) == 3


@pytest.mark.parametrize("name", BROADPHASES)
def test_removing_right_after_a_new_broad_phase_frees_the_slot(name):
    world = World(Effects())
    ids = world.add_bodies(Circle(5), [(0, 0), (1, 0), (2, 0)])
    world.step()
    world.broadphase = BROADPHASES[name]()
    world.remove_body(int(ids[1]))
    for _ in range(2):
        world.step()
        assert world.candidates.tolist() == [[0, 2]]
    world.add_body(Circle(5))
    world.step()
    assert world.candidates.tolist() == [[0, 2], [0, 3], [2, 3]]
    assert len(world.pairs.free) + len(world.shapes) == len(world.pairs.proxies)


def test_box_in_the_corner_of_a_room_stays_on_the_floor():
    room = np.array([[1, 0, 0, 0, 1], [1, 0, 0, 0, 1], [1, 1, 1, 1, 1]], bool)
    world = World(ALL.with_(continuous=False))
    world.add_body(TileGrid(room, 16.0), kind="static")
    crate = world.add_body(Polygon.box(40, 20), position=(44.0, 21.9), fixed_rotation=True)
    for _ in range(30):
        world.step()
        assert crate.position[1] <= 22.3


def test_circle_on_the_peak_of_two_slopes_touches_it():
    slopes = np.array([[(0, 0), (0, 0)], [(0, 1), (1, 0.5)]], float)
    found = collide(TileGrid(np.zeros((2, 2), bool), 8, slopes=slopes), (0, 0, 0), Circle(4.8), (9.1, 5.0, 0))
    assert found.separations.min() == pytest.approx(math.hypot(1.1, 3.0) - 4.8)


def test_ball_rolls_over_a_knee_from_a_slope_to_the_flat():
    solid = np.array([[0, 0, 0, 0], [0, 1, 1, 1]], bool)
    slopes = np.zeros((2, 4, 2))
    slopes[1, 0] = (0, 1)
    world = World(Effects(response=True))
    world.add_body(TileGrid(solid, 16.0, slopes=slopes), kind="static")
    ball = world.add_body(Circle(6.0), position=(40.0, 10.0), velocity=(-90.0, 0.0))
    deepest = 0.0
    for _ in range(40):
        world.step()
        found = collide(TileGrid(solid, 16.0, slopes=slopes), (0, 0, 0), Circle(6.0), (*ball.position, 0))
        deepest = min(deepest, float(found.separations.min()) if len(found) else 0.0)
        x, y = ball.position
        assert math.hypot(x - 16, y - 16) >= 6 - 0.5, "the knee is not inside the ball"
    assert deepest > -1.0


@pytest.mark.parametrize("side", [(10, 4), (-2, 4), (4, 10), (4, -2)])
def test_circle_that_touches_a_tile_on_any_side_is_a_contact(side):
    found = collide(TileGrid(np.ones((1, 1), bool), 8), (0, 0, 0), Circle(2.0), (*side, 0))
    assert len(found) == 1 and found.separations[0] == 0.0
    box = collide(TileGrid(np.ones((1, 1), bool), 8), (0, 0, 0), Polygon.box(4, 4), (*side, 0))
    assert len(box) >= 1 and box.separations.max() == 0.0


def test_corner_to_corner_within_the_margin_is_found():
    found = collide(Polygon.box(10, 10), (0, 0, 0), Polygon.box(10, 10), (10.3, 10.4, 0), margin=1.0)
    assert len(found) >= 1


def test_mask_depth_ends_the_overlap_at_any_pose():
    rng = np.random.default_rng(2)
    for number in range(150):
        (wa, ha, wb, hb), exact = rng.integers(3, 40, 4), number % 2
        a, b = PixelMask(rng.random((ha, wa)) < 0.5), PixelMask(rng.random((hb, wb)) < 0.5)
        pose_a, pose_b = ((*(np.round(p) if exact else p), 0.0) for p in rng.uniform(-15, 15, (2, 2)))
        found = collide(a, pose_a, b, pose_b)
        if len(found):
            depth, (nx, ny) = -float(found.separations.min()), found.normal
            assert len(collide(a, pose_a, b, (pose_b[0] + depth * nx, pose_b[1] + depth * ny, 0.0))) == 0


@pytest.mark.parametrize("sensor", [False, True])
def test_sweep_that_ends_just_behind_what_it_crossed_is_told(sensor):
    for end in np.linspace(3.5, 3.9, 9):  # touching at 3.5, the slop ends at 3.66
        world = World(Effects(continuous=True, sensors=True))
        world.add_body(Polygon.box(1, 9), kind="static", sensor=sensor)
        world.add_body(Circle(1.0), position=(end - 42.0, 0.0), velocity=(40.0 * 60, 0.0), continuous="swept")
        told = 0
        for _ in range(3):
            world.step()
            told += len(world.events.begin) + len(world.events.sensor_begin)
        assert told == 1, end


def test_set_shapes_in_quarantine_leaves_no_ghost():
    world = World(ALL, gravity=(0, 0))
    body, _ = world.add_body(Circle(5)), world.add_body(Circle(5), position=(50, 0))
    world.step()
    world.bodies["x"][0] = math.nan
    world.step()
    body.set_shapes(Circle(60))
    world.step()
    assert len(world.candidates) == 0
    body.restore()
    world.remove_body(body)
    world.step()
    assert int((world.pairs.proxies["row"] >= 0).sum()) == len(world.shapes) == 1


def test_tier_is_forgotten_when_the_shapes_are_replaced():
    world = World(Effects())
    body = world.add_body(PixelMask(np.ones((5, 5), bool)), tier="circle")
    body.set_shapes(Polygon.box(3, 3))
    assert body.tier is None
    with pytest.raises(ValueError):
        body.tier = "pixels"


def test_wind_that_does_not_blow_slows_nobody_without_declared_drag():
    world = World(Effects(wind=True), drag=1.0, wind=(0, 0))
    body = world.add_body(Circle(3), velocity=(100, 0))
    world.step()
    assert body.velocity == (100, 0)


def test_normals_have_no_minus_zero():
    world = World(Effects())
    world.add_body(Polygon.box(4, 4), kind="static")
    numbers = [
        *world.ray_cast((-9, 0), (20, 0)).normal,
        *world.ray_cast((0, -9), (0, 20)).normal,
        *collide(Polygon.box(4, 4), (0, 0, 0), Polygon.box(4, 4), (3, 0, 0)).normal,
        *collide(Circle(4), (0, 0, 0), Circle(4), (-3, 0, 0)).normal,
    ]
    assert not any(n == 0.0 and math.copysign(1, n) < 0 for n in numbers)


def test_character_that_is_refused_leaves_nothing_behind():
    world = World(ALL)
    for options in ({"pushable": 3}, {"filter": 5}, {"position": (1e300, 0)}):
        with pytest.raises((TypeError, ValueError)):
            Character(world, Polygon.box(8, 8), **{"position": (0, 0), **options})
        assert len(world.bodies) == len(world.characters.rows) == len(world.shapes) == 0


def test_quarantine_gives_its_whole_reason():
    world = World(Effects())
    world.add_body(Circle(3))
    world.bodies["x"] = math.nan
    world.step()
    (row,) = world.events.quarantined
    assert row["body"] == 0 and not str(row["reason"]).endswith("speed l")


def test_bounds_of_a_turned_mask_follow_its_pixels():
    bar = PixelMask(np.ones((2, 30), bool))
    assert len(collide(Bounds(bar), (0, 0, math.pi / 2), Circle(0.5), (0, 14, 0))) == 1
    assert len(collide(Bounds(bar), (0, 0, math.pi / 2), Circle(0.5), (14, 0, 0))) == 0


def test_zero_step_keeps_bouncing_bodies_as_they_are():
    world = World(ALL, BruteForce(), gravity=(0, 0))
    world.add_body(Circle(5), velocity=(100, 0), material=Material(restitution=1))
    world.add_body(Circle(5), position=(4, 0))
    before = world.bodies[["x", "vx"]].tolist()
    world.step(0)
    assert world.bodies[["x", "vx"]].tolist() == before


def test_motion_rectangles_of_masks_are_where_they_are_drawn_and_no_wider():
    """The swept box of a mask ends at its drawn pixels; an extra pixel added 9 % to the candidate pairs.

    The box of a moving mask may also cover its motion in later steps.
    """
    rng = np.random.default_rng(4)
    solid, speeds = np.ones((7, 9), bool), rng.choice([0.0, 25.0, -90.0, 300.0], (60, 2))
    speeds[:30] = 0.0
    places = rng.uniform(0.0, 120.0, (60, 2))
    for effects in (Effects(), Effects(response=True)):
        world = World(effects)
        world.add_bodies(PixelMask.from_array(solid, origin=(3.0, 2.0)), places, velocities=speeds)
        first, last = (each - (3.0, 2.0) for each in (places, places + speeds * world.dt))
        if not effects.response:  # as drawn; what pushes is the outline at the exact pose
            first, last = np.floor(first + 0.5), np.floor(last + 0.5)
        lower, upper = np.minimum(first, last), np.maximum(first, last) + (9.0, 7.0)
        near = 2.0 * world.tolerances.slop
        apart = np.maximum(lower[:, None] - upper[None], lower[None] - upper[:, None]).max(axis=2)
        wanted = np.unique(world.shapes["parent"])[np.argwhere(np.triu(apart <= near, 1))]
        world.step()
        still = set(np.unique(world.shapes["parent"])[~speeds.any(axis=1)].tolist())
        told, wanted = ([tuple(each) for each in pairs.tolist()] for pairs in (world.candidates, wanted))
        assert set(wanted) <= set(told)
        at_rest = [[each for each in pairs if still.issuperset(each)] for pairs in (told, wanted)]
        assert at_rest[0] == at_rest[1] and at_rest[0]
