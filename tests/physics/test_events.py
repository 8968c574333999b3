"""Begin, persist, end, hit and sensor events: each begin has exactly one end, whatever happens between them."""

import numpy as np
import pytest

from physics import (
    JIT,
    BruteForce,
    Circle,
    DynamicTree,
    Effects,
    Filter,
    Polygon,
    SpatialHashGrid,
    SweepAndPrune,
    World,
)

WATCH = Effects(response=True, sensors=True, persist=True, continuous=True, restitution=True)


def keys(events):
    return list(zip(events["shape_a"].tolist(), events["shape_b"].tolist(), strict=True))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("effects", [Effects(sensors=True, persist=True), WATCH], ids=["detection", "response"])
def test_every_begin_has_exactly_one_end(effects, seed):
    rng = np.random.default_rng(seed)
    world = World(effects, gravity=(0, 0))
    touching, sensing, begun = set(), set(), 0
    for step in range(150 if JIT else 40):
        if len(world.bodies) < 25:
            shape = Circle(float(rng.uniform(2, 9))) if rng.random() < 0.5 else Polygon.box(*rng.uniform(3, 16, 2))
            world.add_body(
                shape,
                position=tuple(rng.uniform(0, 70, 2)),
                velocity=tuple(rng.normal(0, 200, 2)),
                sensor=bool(rng.random() < 0.3),
                kind="kinematic" if rng.random() < 0.2 else "dynamic",
            )
        if rng.random() < 0.3 and len(world.bodies) > 5:
            world.remove_body(int(rng.choice(world.bodies["id"])))
        if rng.random() < 0.2:
            world.body(int(rng.choice(world.bodies["id"]))).set_shapes(Circle(6.0))
        if rng.random() < 0.2:
            world.body(int(rng.choice(world.bodies["id"]))).filter = Filter(
                int(rng.integers(0, 4)), int(rng.integers(1, 4))
            )
        if step == 60:
            world.restore(world.snapshot())
        world.step()
        for kept, begin, end in (
            (touching, world.events.begin, world.events.end),
            (sensing, world.events.sensor_begin, world.events.sensor_end),
        ):
            begin, end = keys(begin), keys(end)
            assert len(set(begin)) == len(begin) and len(set(end)) == len(end) and not set(begin) & set(end)
            assert begin == sorted(begin) and end == sorted(end) and all(a < b for a, b in begin)
            assert not set(begin) & kept and set(end) <= kept
            kept -= set(end)
            persisted = set(keys(world.events.persist)) if kept is touching else set()
            assert kept is sensing or persisted == kept
            kept |= set(begin)
            begun += len(begin)
        assert {(int(c["shape_a"]), int(c["shape_b"])) for c in world.contacts} == touching
    world.clear()
    world.step()
    assert set(keys(world.events.end)) == touching and set(keys(world.events.sensor_end)) == sensing
    world.step()
    assert len(world.events.end) == len(world.events.sensor_end) == 0 and begun > (20 if JIT else 5)


@pytest.mark.parametrize("make", [BruteForce, SweepAndPrune, SpatialHashGrid, DynamicTree])
def test_removal_while_touching_ends_once(make):
    world = World(Effects(sensors=True), make())
    a, b = world.add_body(Circle(5)), world.add_body(Circle(5), position=(4, 0))
    sensor = world.add_body(Circle(5), position=(2, 3), sensor=True)
    world.step()
    assert keys(world.events.begin) == [(0, 1)] and keys(world.events.sensor_begin) == [(0, 2), (1, 2)]
    world.remove_body(a)
    world.step()
    assert keys(world.events.end) == [(0, 1)] and keys(world.events.sensor_end) == [(0, 2)]
    world.step()
    assert len(world.events.end) == len(world.events.sensor_end) == 0
    world.remove_body(sensor)
    world.remove_body(b)
    world.step()
    assert keys(world.events.sensor_end) == [(1, 2)] and len(world.candidates) == 0


def test_end_waits_until_they_are_apart_by_more_than_the_slop():
    world = World(Effects())
    world.add_body(Circle(5))
    other = world.add_body(Circle(5), position=(9, 0))
    world.step()
    for x, ended in ((10.1, 0), (10.15, 0), (10.2, 1), (10.1, 0)):
        other.move_to((x, 0))
        world.step()
        assert (len(world.events.end), len(world.events.begin)) == (ended, 0), x
    other.move_to((10.0, 0))
    world.step()
    assert len(world.events.begin) == 1, "closed: touching begins"


def test_a_hit_tells_the_speed_before_the_solver_and_the_impulse():
    world = World(WATCH, gravity=(0, 0))
    a = world.add_body(Circle(5), velocity=(300, 0))
    world.add_body(Polygon.box(10, 100), position=(20, 0), kind="static")
    for _ in range(5):
        world.step()
        if len(world.events.hits):
            break
    (hit,) = world.events.hits
    assert hit["speed"] == pytest.approx(300) and hit["normal_impulse"] == pytest.approx(300 * a.mass)
    assert (hit["normal_x"], hit["body_a"], hit["body_b"]) == (1.0, 0, 1)
    assert hit["point_x"] == pytest.approx(15, abs=0.5)
    world.step()
    assert len(world.events.hits) == 0


def test_resting_bodies_report_no_hits():
    world = World(Effects.rigid_bodies().with_(sleeping=False))
    world.add_body(Polygon.box(300, 20), position=(0, 10), kind="static")
    for k in range(5):
        world.add_body(Polygon.box(10, 10), position=(20.0 * k, -5.0))
    for _ in range(60):
        world.step()
        assert len(world.events.hits) == 0
    assert len({int(b) for b in world.contacts["body_b"]}) == 5


def test_sensors_see_and_do_not_push():
    world = World(WATCH, gravity=(0, 0))
    gate = world.add_body(Polygon.box(10, 10), position=(30, 0), sensor=True)
    ball = world.add_body(Circle(3), velocity=(120, 0))
    log = []
    for _ in range(40):
        world.step()
        log.append((len(world.events.sensor_begin), len(world.events.sensor_end)))
        assert len(world.events.begin) == len(world.events.hits) == len(world.contacts) == 0
    assert np.sum(log, axis=0).tolist() == [1, 1] and ball.velocity == (120, 0) and gate.position == (30, 0)
    assert world.events.sensor_begin.dtype == world.events.begin.dtype


def test_sensors_ignore_the_margin_of_contacts():
    world = World(WATCH, gravity=(0, 0))
    world.add_body(Circle(5), sensor=True)
    world.add_body(Circle(5), position=(10.05, 0))
    world.step()
    assert len(world.events.sensor_begin) == 0 and len(world.candidates) == 1


def test_two_bodies_of_two_shapes_touch_shape_by_shape():
    world = World(Effects())
    pair = (Circle(5, (-10, 0)), Circle(5, (10, 0)))
    world.add_body(*pair)
    world.add_body(*pair, position=(0, 9))
    world.step()
    assert keys(world.events.begin) == [(0, 2), (1, 3)]


def test_events_name_a_as_the_smaller_shape_id_with_the_normal_from_a_to_b():
    rng = np.random.default_rng(0)
    world = World(Effects())
    world.add_bodies(Circle(6), rng.uniform(0, 60, (30, 2)))
    world.step()
    at = {int(b["id"]): (b["x"], b["y"]) for b in world.bodies}
    for table in (world.events.begin, world.contacts):
        assert (table["shape_a"] < table["shape_b"]).all()
        for row in table:
            (ax, ay), (bx, by) = at[int(row["body_a"])], at[int(row["body_b"])]
            assert row["normal_x"] * (bx - ax) + row["normal_y"] * (by - ay) >= 0.0


def test_undeclared_events_are_empty_arrays_of_their_type():
    world = World(Effects())
    world.add_bodies(Circle(6), [(0, 0), (3, 0)])
    world.step()
    world.step()
    for name in ("persist", "sensor_begin", "sensor_end", "end", "begin"):
        assert len(getattr(world.events, name)) == 0 and "point_x" in getattr(world.events, name).dtype.names
    assert {"speed", "normal_impulse"} <= set(world.events.hits.dtype.names)
    assert {"body", "reason"} <= set(world.events.quarantined.dtype.names)


def test_contacts_describe_the_final_poses():
    from physics import collide

    world = World(Effects())
    world.add_body(Circle(5), velocity=(60, 0))
    world.add_body(Polygon.box(10, 10), position=(11, 1), angle=0.4)
    world.step()
    found = collide(Circle(5), (1, 0, 0), Polygon.box(10, 10), (11, 1, 0.4))
    (contact,) = world.contacts
    assert contact["separation"] == found.separations[0] and (contact["point_x"], contact["point_y"]) == tuple(
        found.points[0]
    )


def test_reading_events_later_does_not_change_them():
    world = World(Effects())
    world.add_bodies(Circle(6), [(0, 0), (3, 0)])
    world.step()
    begin, contacts = world.events.begin, world.contacts
    kept = begin.copy(), contacts.copy()
    assert len(begin) == 1
    again = world.events.begin
    assert again is begin and (begin == kept[0]).all() and (contacts == kept[1]).all()
