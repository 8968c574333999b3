"""Sleeping bodies are skipped by all loops, are still reported, and wake when they are changed."""

import numpy as np
import pytest

from physics import BROADPHASES, Circle, Effects, Polygon, World

BOX = Polygon.box(16, 16)


def floor(world, kind="static", **arguments):
    return world.add_body(Polygon.box(400, 20), position=(0, 10), kind=kind, **arguments)


def pile(high=3, **arguments):
    """Return (world, ground, boxes) of a stack that has fallen asleep."""
    world = World(**arguments)
    ground = floor(world)
    boxes = [world.add_body(BOX, position=(0, -8 - 16 * k)) for k in range(high)]
    fall_asleep(world, boxes)
    return world, ground, boxes


def fall_asleep(world, boxes, most=300):
    for _ in range(most):
        world.step()
        if not any(box.awake for box in boxes):
            return
    raise AssertionError("the pile stays awake")


def test_nothing_of_a_sleeping_pile_is_in_a_step():
    world, _, _ = pile()
    world.step()
    assert len(world.awake.bodies) == len(world.awake.shapes) == len(world.pairs.rows) == len(world.contacts) == 0
    counters = world.profile.counters
    for name in ("bodies_integrated", "pairs_tested", "narrow_tests", "solver_rows", "islands"):
        assert counters[name] == 0


def test_who_moves_beside_them_is_all_that_is_looked_at():
    world, _, _ = pile()
    world.add_body(Circle(4), position=(-150, -100), velocity=(20, 0), gravity_scale=0.0)
    for _ in range(5):
        world.step()
        assert len(world.awake.bodies) == 1 and world.profile.counters["bodies_integrated"] == 1
        assert world.profile.counters["narrow_tests"] == 0


def test_contacts_that_sleep_are_told_as_they_were():
    world, ground, boxes = pile(dt=1 / 60)
    rows = world.sleeping_contacts
    assert rows.dtype == world.contacts.dtype and len(world.contacts) == 0
    assert (np.diff(rows["shape_a"] << 32 | rows["shape_b"]) >= 0).all()
    weight = boxes[0].mass * 9.8 * 32 / 60
    lowest = rows[rows["body_a"] == ground.id]
    assert len(lowest) == 2 and lowest["normal_impulse"].sum() == pytest.approx(3 * weight, rel=0.02)


def test_a_body_shows_its_contacts_awake_or_asleep():
    world, ground, boxes = pile()
    for body, points in ((ground, 2), (boxes[0], 4), (boxes[1], 4), (boxes[2], 2)):
        rows = body.contacts
        assert len(rows) == points and ((rows["body_a"] == body.id) | (rows["body_b"] == body.id)).all()
    boxes[1].wake()
    world.step()
    assert len(world.sleeping_contacts) == 0 and len(boxes[1].contacts) == 4
    lonely = world.add_body(Circle(3), position=(150, -100))
    assert len(lonely.contacts) == 0
    rows = boxes[0].contacts
    rows["separation"] = 99.0
    assert (boxes[0].contacts["separation"] < 1.0).all(), "a copy"


def test_columns_of_sleepers_count_after_a_touch():
    world, _, boxes = pile()
    row = world.rows([boxes[2].id])[0]
    world.bodies["vx"][row] = 60.0
    x = boxes[2].position[0]
    world.step()
    assert not boxes[2].awake and boxes[2].position[0] == x
    world.touch(boxes[2].id)
    assert all(box.awake for box in boxes), "an island wakes as one"
    world.step()
    assert boxes[2].position[0] > x + 0.5


def test_columns_of_what_stands_count_after_a_touch():
    world, ground, boxes = pile()
    row = world.rows([ground.id])[0]
    world.bodies["y"][row] += 40.0
    world.touch([ground])
    assert all(box.awake for box in boxes)
    assert len(world.query_aabb((-5, 41), (5, 42))) == 1
    for _ in range(120):
        world.step()
    assert boxes[0].position[1] == pytest.approx(32.0, abs=0.5)


def test_without_sleeping_columns_count_at_once():
    world = World(Effects.rigid_bodies().with_(sleeping=False))
    ground = floor(world)
    box = world.add_body(BOX, position=(0, -8))
    for _ in range(60):
        world.step()
    world.bodies["y"][world.rows([ground.id])[0]] += 40.0
    for _ in range(120):
        world.step()
    assert box.position[1] == pytest.approx(32.0, abs=0.5)


@pytest.mark.parametrize("ids", [99, [0, 99], [0, 0]])
def test_a_touch_of_what_is_not_there_touches_nothing(ids):
    world, _, boxes = pile()
    with pytest.raises((KeyError, ValueError)):
        world.touch(ids)
    assert not any(box.awake for box in boxes)


@pytest.mark.parametrize("by", ["body", "columns"])
def test_a_lift_that_starts_takes_sleepers_along(by):
    world = World()
    lift = floor(world, "kinematic")
    boxes = [world.add_body(BOX, position=(0, -8 - 16 * k)) for k in range(2)]
    fall_asleep(world, boxes)
    if by == "body":
        lift.velocity = (0.0, -30.0)
    else:
        world.bodies["vy"][world.rows([lift.id])[0]] = -30.0
    y = boxes[1].position[1]
    for _ in range(60):
        world.step()
    assert all(box.awake for box in boxes) and boxes[1].position[1] == pytest.approx(y - 30.0, abs=1.0)
    lift.velocity = (0.0, 0.0)
    fall_asleep(world, boxes)


def test_taking_the_ground_away_wakes_and_ends_each_pair_once():
    world, ground, boxes = pile()
    world.remove_body(ground)
    world.step()
    ended = [(int(a), int(b)) for a, b in zip(world.events.end["body_a"], world.events.end["body_b"], strict=True)]
    assert ended == [(ground.id, boxes[0].id)] and all(box.awake for box in boxes)
    for _ in range(30):
        world.step()
    assert boxes[0].position[1] > 0.0


def test_a_sleeper_in_a_zone_neither_leaves_nor_comes_again():
    world = World()
    floor(world)
    zone = world.add_body(Polygon.box(60, 60), position=(0, -20), kind="static", sensor=True)
    box = world.add_body(BOX, position=(0, -8))
    told = []

    def step():
        world.step()
        for name, rows in (("in", world.events.sensor_begin), ("out", world.events.sensor_end)):
            told.extend(name for row in rows if zone.id in (row["body_a"], row["body_b"]))

    for _ in range(120):
        step()
    assert not box.awake and told == ["in"]
    box.wake()
    for _ in range(120):
        step()
    assert not box.awake and told == ["in"]
    zone.move_to((0, -20))
    for _ in range(5):
        step()
    assert told == ["in"]
    world.remove_body(box)
    step()
    assert told == ["in", "out"]


def test_islands_that_nearly_touch_wake_together():
    world = World()
    floor(world)
    left, right = (world.add_body(BOX, position=(x, -8)) for x in (-8.05, 8.05))
    fall_asleep(world, [left, right])
    assert left.contacts["body_b"].tolist().count(right.id) in (0, 2)
    left.wake()
    world.step()
    assert left.awake


def test_a_snapshot_keeps_what_sleeps():
    world, _, boxes = pile()
    other = pile()[0]
    taken = world.snapshot()
    other.step()
    other.restore(taken)
    assert len(other.sleeping_contacts) == len(world.sleeping_contacts) == 6
    for each in (world, other):
        each.body(boxes[2].id).velocity = (80.0, 0.0)
        for _ in range(200):
            each.step()
    assert world.digest() == other.digest()


def test_gravity_wakes_everything():
    world, _, boxes = pile()
    world.gravity = (60.0, 313.6)
    assert all(box.awake for box in boxes) and len(world.sleeping_contacts) == 0


def test_many_islands_fall_asleep_in_one_step():
    world = World()
    world.add_body(Polygon.box(20000, 20), position=(0, 10), kind="static")
    ids = world.add_bodies(BOX, [(30.0 * k - 4500.0, -8.0) for k in range(300)])
    for _ in range(60):
        world.step()
    assert len(world.sleeping_set.islands) == 300 and not world.bodies["awake"][world.rows(ids)].any()
    assert len(world.sleeping_contacts) == 600
    world.body(int(ids[7])).apply_impulse((1e5, 0.0))
    world.step()
    assert len(world.sleeping_set.islands) == 299 and len(world.awake.dynamic) == 1


def test_what_was_in_an_island_and_now_stands_is_ground():
    """A body that becomes static while its island sleeps counts as ground for the other bodies.

    Its row must no longer contain the island's number. Otherwise the bodies that rest on it would seem to belong to
    that island.
    """
    world, _, boxes = pile()
    boxes[2].wake()
    world.step()
    boxes[2].set_kind("static")
    fall_asleep(world, boxes[:2])
    assert boxes[2].id in world.sleeping_set.links
    boxes[0].wake()
    world.step()
    fall_asleep(world, boxes[:2])
    boxes[2].move_to((0.0, -60.0))
    assert boxes[0].awake and boxes[1].awake


@pytest.mark.parametrize("strategy", BROADPHASES)
def test_falling_asleep_leaves_each_pair_once(strategy):
    """No candidate pair is listed twice while bodies fall asleep, with every broad phase.

    Falling asleep changes the set of awake bodies, but no box of the broad phase.
    """
    world = World(broadphase=BROADPHASES[strategy]())
    floor(world)
    boxes = [world.add_body(BOX, position=(40.0 * k - 60, -8 - 16 * j)) for k in range(3) for j in range(2)]
    rolling = world.add_body(Circle(5), position=(-190, -5), velocity=(30, 0), angular_velocity=6.0)
    for step in range(200):
        world.step()
        if step % 7 == 0:
            boxes[step % 6].wake()
        pairs = world.candidates
        assert len(np.unique(pairs, axis=0)) == len(pairs)
    assert rolling.position[0] > -150
