"""Values of a body that can be read and set.

A change takes effect in the next step, as if the body had been added with the new value.
"""

import math

import numpy as np
import pytest

from physics import Body, Circle, Effects, Filter, Material, PixelMask, Polygon, Segment, TileGrid, World

ICE = Material(density=2.0, friction=0.0, restitution=0.5)
BOX = Polygon.box(16, 12)
FALL = {"position": (0, 40), "velocity": (60, 0)}


def ground(world):
    world.add_body(Polygon.box(4000, 20), position=(0, 100), kind="static")


def after(body, steps=90):
    for _ in range(steps):
        body.world.step()
    return (body.position, body.angle, body.velocity, body.angular_velocity, body.mass, body.inertia)


@pytest.mark.parametrize(
    "name, value",
    [
        ("material", ICE), ("filter", Filter(2, 4)), ("sensor", True), ("fixed_rotation", True), ("gravity_scale", 0.5),
        ("bullet", True), ("continuous", "toi"), ("continuous", "off"), ("angle", 0.7), ("position", (33, 21)),
        ("velocity", (-50, 9)), ("angular_velocity", 2.5),
    ],
)  # fmt: skip
def test_set_is_as_good_as_added(name, value):
    first, second = World(), World()
    ground(first), ground(second)
    added = first.add_body(BOX, **{**FALL, name: value})
    changed = second.add_body(BOX, **FALL)
    setattr(changed, name, value)
    assert getattr(changed, name) == getattr(added, name) == value
    assert after(changed) == after(added)
    taken = second.snapshot()
    second.restore(taken)
    assert getattr(changed, name) == getattr(added, name)


@pytest.mark.parametrize("name, value", [("material", ICE), ("sensor", True), ("filter", Filter(2, 0)), ("angle", 0.3)])
def test_setting_wakes_what_sleeps(name, value):
    world = World()
    ground(world)
    lower, upper = (world.add_body(Polygon.box(20, 20), position=(0, y)) for y in (80, 60))
    while lower.awake:
        world.step()
    setattr(lower, name, value)
    assert lower.awake and upper.awake
    if name in ("sensor", "filter"):
        for _ in range(90):
            world.step()
        assert lower.position.y > 100 and upper.position.y == pytest.approx(80, abs=0.5), "it fell through"


def test_a_crate_on_a_slope_slides_when_it_becomes_ice():
    world = World()
    world.add_body(Polygon([(-400, 0), (400, 200), (-400, 200)]), kind="static", material=Material(friction=0.8))
    crate = world.add_body(BOX, position=(0, 92), angle=math.atan2(200, 800), material=Material(friction=0.8))
    for _ in range(120):
        world.step()
    x = crate.position.x
    assert not crate.awake
    crate.material = ICE
    for _ in range(60):
        world.step()
    assert crate.position.x > x + 5


def test_where_its_points_are():
    world = World(gravity=(0, 0))
    body = world.add_body(
        BOX, Circle(3, (20, 0)), position=(100, 50), angle=0.6, velocity=(7, -2), angular_velocity=3.0
    )
    cosine, sine = math.cos(0.6), math.sin(0.6)
    assert body.to_world((20, 5)) == pytest.approx((100 + 20 * cosine - 5 * sine, 50 + 20 * sine + 5 * cosine))
    assert body.to_local(body.to_world((20, 5))) == pytest.approx((20, 5))
    before, point = body.to_world((20, 5)), body.to_world((20, 5))
    speed = body.velocity_at(point)
    world.step(1e-6)
    assert (body.to_world((20, 5)) - before) / 1e-6 == pytest.approx(speed, rel=1e-3)
    assert body.velocity_at(body.center) == body.velocity
    energy = 0.5 * body.mass * body.velocity.length**2 + 0.5 * body.inertia * 9.0
    assert body.kinetic_energy == pytest.approx(energy)
    body.position = (0, 0)
    assert body.velocity == (7, -2) and body.angle == pytest.approx(0.6, abs=1e-4)


@pytest.mark.parametrize("angle", [0.0, 0.5, math.pi / 2, -2.0])
def test_its_bounds_are_those_of_its_shapes_now(angle):
    world = World(gravity=(0, 0))
    body = world.add_body(BOX, Circle(3, (20, 0)), kind="kinematic")
    assert world.add_body().bounds is None
    body.move_to((10, -5), angle)
    corners = np.array([body.to_world(p) for p in BOX.points])
    x, y = body.to_world((20, 0))
    low = np.minimum(corners.min(axis=0), (x - 3, y - 3))
    high = np.maximum(corners.max(axis=0), (x + 3, y + 3))
    assert body.bounds == pytest.approx((*low, *high))
    world.bodies["x"] += 5.0
    assert body.bounds == pytest.approx((low[0] + 5, low[1], high[0] + 5, high[1]))


def test_shapes_come_and_go():
    world = World()
    body = world.add_body(BOX, Circle(3))
    assert body.shape_ids == (0, 1) and body.shapes == (BOX, Circle(3))
    before = body.mass
    third = body.add_shape(Circle(5, (40, 0)))
    assert third == 2 and body.shape_ids == (0, 1, 2) and body.mass == pytest.approx(before + 25 * math.pi)
    assert body.center.x > 0
    body.remove_shape(1)
    assert body.shape_ids == (0, 2) and body.shapes == (BOX, Circle(5, (40, 0)))
    whole = World().add_body(BOX, Circle(5, (40, 0)))
    assert (body.mass, body.inertia, body.center) == (whole.mass, whole.inertia, whole.center)
    for each in body.shape_ids:
        body.remove_shape(each)
    assert body.shapes == () and body.mass == 0.0 and body.add_shape(BOX) == 3
    with pytest.raises(ValueError, match="Segment"):
        World().add_body(BOX).set_shapes(Segment((0, 0), (9, 9)))


def test_the_last_shape_with_mass_stays_where_a_segment_would_be_left():
    world = World()
    body = world.add_body(BOX, Segment((0, 0), (9, 9)))
    with pytest.raises(ValueError, match="Segment"):
        body.remove_shape(body.shape_ids[0])
    assert len(body.shapes) == 2


def test_a_contact_ends_with_the_shape_it_was_of():
    world = World(gravity=(0, 0))
    body = world.add_body(Circle(2), kind="kinematic")
    far = body.add_shape(Circle(4, (50, 0)))
    other = world.add_body(BOX, position=(50, 0), kind="dynamic", fixed_rotation=True)
    world.step()
    assert (
        len(other.contacts) > 0 and set(other.contacts["shape_a"]) == {far} or set(other.contacts["shape_b"]) == {far}
    )
    body.remove_shape(far)
    world.step()
    assert len(other.contacts) == 0 and len(world.events.end) == 1
    body.add_shape(Circle(4, (50, 0)))
    world.step()
    assert len(world.events.begin) == 1


@pytest.mark.parametrize("mass", [0.25, 1000])
def test_a_mass_in_place_of_the_densities(mass):
    world = World()
    plain, heavy = world.add_body(BOX, Circle(3, (9, 0))), world.add_body(BOX, Circle(3, (9, 0)), mass=mass)
    assert heavy.mass == mass and heavy.center == plain.center
    assert heavy.inertia == pytest.approx(plain.inertia * mass / plain.mass)
    heavy.material = Material(density=77.0)
    heavy.add_shape(Circle(4))
    assert heavy.mass == mass, "whatever it is made of"
    heavy.apply_impulse((mass * 3, 0))
    assert heavy.velocity.x == pytest.approx(3)
    assert world.add_body(mass=5).mass == 5 and world.add_body(BOX, kind="static", mass=5).mass == 5
    ids = world.add_bodies(BOX, [(0, 0), (90, 0)], mass=mass)
    assert world.bodies["mass"][world.rows(ids)].tolist() == [mass] * 2
    taken = world.snapshot()
    world.restore(taken)
    heavy.set_shapes(BOX)
    assert heavy.mass == mass


def test_who_is_fixed_stops_turning_and_can_be_let_go():
    world = World(gravity=(0, 0))
    body = world.add_body(BOX, angular_velocity=4.0)
    body.fixed_rotation = True
    assert body.angular_velocity == 0.0
    body.apply_impulse((0, 500), (8, 0))
    world.step()
    assert body.angle == 0.0
    body.fixed_rotation = False
    body.apply_impulse((0, 500), body.position + (8, 0))
    world.step()
    assert body.angle != 0.0


def test_a_sensor_reports_and_counts_in_the_mass():
    world = World()
    ground(world)
    body = world.add_body(BOX, position=(0, 80), sensor=True)
    assert body.mass == pytest.approx(192)
    began = 0
    for _ in range(60):
        world.step()
        began += len(world.events.sensor_begin)
    assert body.position.y > 100 and began == 1
    body.sensor = False
    assert not body.sensor and not world.shapes["sensor"].any()


@pytest.mark.parametrize("effects", [None, Effects(continuous=True)], ids=["response", "without"])
def test_masks_are_swept_in_every_way(effects):
    body = World(effects).add_body(PixelMask(np.ones((4, 4), bool)), bullet=True)
    for way in ("off", "ray", "swept", "toi", "auto"):
        body.continuous = way
        assert body.continuous == way


def test_a_world_is_a_collection_of_its_bodies():
    world, other = World(), World()
    assert len(world) == 0 and list(world) == [] and world, "an empty world is there all the same"
    ids = world.add_bodies(Circle(3), [(k * 20, 0) for k in range(5)])
    bodies = list(world)
    assert bodies == [world.body(each) for each in ids.tolist()] and all(type(each) is Body for each in bodies)
    assert len(world) == 5 and bodies[2] in world and 2 in world and ids[2] in world and np.int32(2) in world
    foreign = other.add_body()
    assert foreign not in world and 5 not in world and -1 not in world and "2" not in world and None not in world
    assert True not in world and 1.0 not in world
    for body in world:
        if body.id == 1:
            world.body(3).remove()
            world.add_body(Circle(1))
        assert body.id not in (3, 5), "gone before its turn, or new"
        if body.id == 2:
            body.remove()
    assert [body.id for body in world] == [0, 1, 4, 5] and 2 not in world and bodies[2] not in world
    assert world.body(bodies[0]) == bodies[0] and world.rows([bodies[4], 5]).tolist() == [2, 3]
    world.touch(bodies[0]), world.touch([0, bodies[1]]), world.touch({4})
    world.remove_bodies([bodies[0], 5])
    world.remove_bodies(bodies[1])
    assert list(world) == [bodies[4]]
    for call in (lambda: world.body(foreign), lambda: world.touch(foreign), lambda: world.rows([foreign])):
        with pytest.raises(ValueError, match="another"):
            call()
    with pytest.raises(KeyError, match="99"):
        world.body(99)
    with pytest.raises(ValueError, match="99"):
        world.touch([99])


def test_a_rect_is_asked_as_pygame_has_it():
    import pygame

    world = World(gravity=(0, 0))
    ids = world.add_bodies(Circle(3), [(k * 20, 0) for k in range(5)], kind="static")
    for rect in (pygame.Rect(18, -5, 24, 10), (18, -5, 24, 10), ((18, -5), (24, 10)), np.array([18.0, -5, 24, 10])):
        assert [body.id for body in world.query_rect(rect)] == ids[1:3].tolist()
    assert world.query_rect((43, -1, 0, 2)) == [world.body(2)], "closed: touching counts"
    assert world.query_rect((43.5, -1, 0, 2)) == []


def test_the_time_of_a_world():
    world = World(dt=0.25)
    assert world.time == 0.0
    world.step(), world.step(0.5), world.step(0)
    assert world.time == 0.75
    taken = world.snapshot()
    world.step()
    world.restore(taken)
    assert world.time == 0.75


def test_effects_that_are_off_leave_poses_settable():
    world = World(Effects())
    body = world.add_body(Circle(3))
    body.position, body.angle = (5, 6), 1.5
    assert body.position == (5, 6) and body.angle == 1.5
    grid = world.add_body(TileGrid([[True]], 8), kind="static")
    with pytest.raises(ValueError, match="TileGrid"):
        grid.angle = 1.0
