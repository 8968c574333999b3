"""Masks as bodies: their outline rests, slides, rolls and collides as a polygon does.

References: the same polygon in place of the mask, closed forms of rolling and sliding, and the paths of thrown bodies.
"""

import itertools
import math

import numpy as np
import pytest

from physics import JIT, Chain, Circle, Effects, Material, PixelMask, Polygon, TileGrid, World

STACKING = ("soft_step", "sequential_impulse")
FLOORS = ("box", "tiles", "chain", "mask")
CRATE = PixelMask(np.ones((32, 32), bool))


def disc_of(radius):
    """Return a pixel disc: the pixels whose centres are within the radius."""
    at = np.arange(2 * radius) + 0.5 - radius
    return PixelMask(at[:, None] ** 2 + at[None, :] ** 2 <= radius * radius)


def add_floor(world, kind, top=50.0, half=320):
    if kind == "box":
        return world.add_body(Polygon.box(2 * half, 20), position=(0.0, top + 10.0), kind="static")
    if kind == "tiles":
        grid = TileGrid(np.ones((1, 2 * half // 16), bool), 16)
        return world.add_body(grid, position=(-half, top), kind="static")
    if kind == "chain":
        return world.add_body(Chain([(-half, top), (half, top)]), kind="static")
    return world.add_body(PixelMask(np.ones((20, 2 * half), bool)), position=(0.0, top + 10.0), kind="static")


def drop(shape, floor, solver, angle=0.0, seconds=3.0):
    """Drop a shape onto a floor. Return (number of begins, number of ends, step at which it
    fell asleep or None, body).
    """
    world = World(solver=solver)
    add_floor(world, floor)
    body = world.add_body(shape, position=(0.3, 20.0), angle=angle)
    begins = ends = 0
    asleep = None
    for step in range(round(seconds / world.dt)):
        world.step()
        begins, ends = begins + len(world.events.begin), ends + len(world.events.end)
        if asleep is None and not body.awake:
            asleep = step
    return begins, ends, asleep, body


@pytest.mark.parametrize("solver", STACKING)
@pytest.mark.parametrize("floor", FLOORS)
def test_a_crate_lands_once_and_sleeps_within_a_second(floor, solver):
    begins, ends, asleep, body = drop(CRATE, floor, solver)
    twin = drop(Polygon.box(32, 32), floor, solver)
    assert (begins, ends) == (1, 0) and asleep is not None and asleep < 60 + 15  # it falls for a quarter of a second
    assert body.position == twin[3].position and asleep == twin[2], "a full rectangle is a box to the bit"


@pytest.mark.parametrize("solver", STACKING)
@pytest.mark.parametrize("floor", FLOORS)
def test_a_turned_crate_does_as_the_box_does(floor, solver):
    begins, ends, asleep, body = drop(CRATE, floor, solver, math.radians(15))
    twin = drop(Polygon.box(32, 32), floor, solver, math.radians(15))
    assert (begins, ends, asleep) == twin[:3] and body.position == twin[3].position


@pytest.mark.parametrize("solver", STACKING)
@pytest.mark.parametrize("floor", FLOORS)
def test_a_disc_lands_once_and_sleeps_within_a_second(floor, solver):
    begins, ends, asleep, body = drop(disc_of(16), floor, solver)
    assert (begins, ends) == (1, 0) and asleep is not None and asleep < 60 + 15
    assert body.position.y == pytest.approx(34.0, abs=0.7)


@pytest.mark.parametrize("floor", FLOORS)
def test_a_disc_that_slips_comes_to_roll(floor):
    """A slipping disc starts to roll, at two thirds of the speed with which it began to slide."""
    world = World(Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True, continuous=True))
    add_floor(world, floor, half=1600)
    body = world.add_body(disc_of(16), position=(-1500.0, 34.0), velocity=(240.0, 0.0), material=Material(friction=0.3))
    start = None
    while body.position.x < -1250.0 + 1000.0:
        world.step()
        if start is None and body.position.x > -1250.0:
            start = body.velocity.x
    assert start == pytest.approx(160.0, rel=0.02)
    assert body.velocity.x == pytest.approx(160.0, rel=0.02)
    assert body.angular_velocity == pytest.approx(body.velocity.x / 16.0, rel=0.03)


def test_a_mask_without_friction_slides_over_mask_tiles():
    world = World(Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True, continuous=True))
    tile = PixelMask(np.ones((16, 16), bool))
    smooth = Material(friction=0.0)
    world.add_bodies(tile, [(16.0 * k + 8.0, 8.0) for k in range(200 if JIT else 20)], kind="static", material=smooth)
    body = world.add_body(CRATE, position=(40.0, -16.0), velocity=(600.0, 0.0), material=smooth)
    end = 16.0 * (200 if JIT else 20) - 40.0
    while body.position.x < end:
        world.step()
    assert body.velocity.x == pytest.approx(600.0, rel=1e-6)
    assert abs(body.angle) < 1e-4


@pytest.mark.parametrize("continuous", [True, False])
def test_thrown_at_thin_walls_of_pixels(continuous):
    rng = np.random.default_rng(3)
    passed = 0
    throws = (400 if continuous else 100) if JIT else 20
    for _ in range(throws):
        effects = Effects(response=True, rotation=True, friction=True, stacking=True, continuous=continuous)
        world = World(effects)
        wall = PixelMask(np.ones((200, int(rng.integers(1, 4))), bool))
        world.add_body(wall, position=(100.0, 0.0), kind="static")
        shape = (
            PixelMask(np.ones(tuple(rng.integers(2, 12, 2)), bool)),
            disc_of(int(rng.integers(2, 6))),
            Circle(3),
            Polygon.box(8, 4),
        )[rng.integers(4)]
        towards, speed = rng.uniform(-0.5, 0.5), rng.uniform(100.0, 3000.0)
        body = world.add_body(
            shape,
            position=(float(rng.uniform(20.0, 60.0)), float(rng.uniform(-20.0, 20.0))),
            angle=float(rng.uniform(0.0, math.tau)),
            velocity=(speed * math.cos(towards), speed * math.sin(towards)),
            angular_velocity=float(rng.uniform(-30.0, 30.0)),
        )
        for _ in range(60):
            world.step()
            if body.center.x > 102.0 or body.velocity.x < 0.0:
                break
        passed += body.center.x > 102.0
    assert passed == 0 if continuous else passed > throws // 3


def test_ids_are_those_of_the_masks_and_not_of_their_parts():
    plus = np.zeros((30, 30), bool)
    plus[10:20] = plus[:, 10:20] = True
    world = World()
    floor = add_floor(world, "mask")
    body = world.add_body(PixelMask(plus), Circle(3, (0, -18)), position=(0.0, 34.0))
    assert len(body.shape_ids) == 2 and len(body.shapes) == 2
    begins = []
    for _ in range(90):
        world.step()
        begins += world.events.begin.tolist()
        assert set(world.contacts["shape_a"].tolist()) | set(world.contacts["shape_b"].tolist()) <= {
            *floor.shape_ids,
            *body.shape_ids,
        }
        pairs = [tuple(each) for each in world.candidates.tolist()]
        assert len(pairs) == len(set(pairs))
    assert [(each[2], each[3]) for each in begins] == [(floor.shape_ids[0], body.shape_ids[0])]
    again = World()
    again.restore(world.snapshot())
    assert again.body(body.id).shape_ids == body.shape_ids and again.digest() == world.digest()
    body.remove_shape(body.shape_ids[0])
    assert len(body.shapes) == 1 and (world.shapes["body"] == body.id).sum() == 1


def test_what_asks_for_pixels_gets_pixels_and_what_asks_for_the_outline_gets_that():
    ring = np.zeros((40, 40), bool)
    at = np.hypot(*np.indices((40, 40)) - 19.5)
    ring[(at < 20) & (at > 12)] = True
    world = World()
    body = world.add_body(PixelMask(ring), kind="static")
    inside = world.add_body(Circle(4), sensor=True, kind="static")
    on_it = world.add_body(Circle(4), sensor=True, kind="static", position=(16.0, 0.0))
    probe = world.add_body(PixelMask(ring), position=(300.0, 0.0), velocity=(1.0, 0.0))
    world.step()
    assert world.query_point((0.0, 0.0), sensors=True) == [inside]
    assert world.query_point((0.0, 16.0)) == [body]
    assert world.overlap(Circle(4), (0.0, 0.0), sensors=True) == [inside]
    hit = world.ray_cast((0.0, 0.0), (30.0, 0.0))
    assert hit.body == body and hit.shape == body.shape_ids[0] and hit.point.x == pytest.approx(12.0, abs=0.8)
    found = world.closest((0.0, 3.0))
    assert found[0] == body and found[2] == pytest.approx(9.0, abs=0.8)
    assert on_it in world.overlap(Circle(2), (16.0, 0.0), sensors=True) and probe.awake


@pytest.mark.parametrize("seed", range(8) if JIT else [4])
def test_pieces_of_one_heap_fall_asleep(seed):
    shapes = (CRATE, disc_of(10), PixelMask(np.ones((10, 24), bool)))
    world = World()
    add_floor(world, "mask", top=200.0)
    for x in (-300.0, 300.0):  # or a disc that comes off the heap rolls off the floor
        world.add_body(Polygon.box(20, 200), position=(x, 100.0), kind="static")
    rng = np.random.default_rng(seed)
    places = itertools.product(range(-3, 4), range(4 if JIT else 1))
    bodies = [
        world.add_body(
            shapes[(i + j) % 3], position=(40.0 * i + float(rng.uniform(-3, 3)), 180.0 - 40.0 * j), angle=0.1 * j
        )
        for i, j in places
    ]
    for _ in range(2400):  # a disc, which is smooth, rolls over a crate at 1 px/s without a loss
        world.step()
        if not any(body.awake for body in bodies):
            break
    assert not any(body.awake for body in bodies)
