"""Reprs of objects that a user prints while debugging: one line with numbers, which never raises an error."""

import copy
import pickle

import numpy as np
import pytest

from physics import (
    Bounds,
    Capsule,
    Chain,
    Character,
    Circle,
    Effects,
    Filter,
    Material,
    PixelMask,
    Polygon,
    Revolute,
    Segment,
    Snapshot,
    TileGrid,
    World,
    collide,
    distance,
    time_of_impact,
)
from physics.broadphase.brute_force import BruteForce

BALL, FLOOR = Circle(5.0), Polygon.box(100, 10)
ALL = Effects(**dict.fromkeys(Effects.__dataclass_fields__, True))


def falling():
    """Return a world with a floor, a ball above it, and a pendulum."""
    world = World(ALL, gravity=(0, 300))
    world.add_body(FLOOR, position=(0, 20), kind="static")
    world.add_body(BALL, position=(0.5, 2), velocity=(0, 100))
    world.add_body(BALL, position=(300, 0))
    world.add_joint(Revolute(None, 2, (300, -50)))
    return world


def line(value):
    """Return the repr of a value, after a check that it is one line and that the value can be formatted."""
    text = repr(value)
    assert text and "\n" not in text and len(text) < 500, text
    assert f"{value}"
    return text


def test_a_filter_shows_its_bits_as_they_are_written():
    shown = {
        Filter.ALL: "Filter.ALL",
        Filter(6): "Filter(membership=0x6)",
        Filter(1, 6): "Filter(membership=0x1, mask=0x6)",
    }
    for value, text in shown.items():
        assert line(value) == text and eval(text) == value


def test_a_world_shows_its_counts_its_time_its_solver_and_its_effects():
    world = falling()
    text = line(world)
    assert text.startswith("World(3 bodies (2 dynamic and awake), 1 joints, 0 contacts, step 0, time=0 s")
    assert "solver='soft_step'" in text and "gravity=True" in text
    for _ in range(12):
        world.step()
    assert f"{len(world.contacts)} contacts" in line(world) and len(world.contacts) > 0 and "step 12" in line(world)
    body = world.body(1)
    body.remove()
    assert "2 bodies (1 dynamic and awake)" in line(world) and f"{len(world.contacts)} contacts" in line(world)
    for _ in range(200):
        world.step(0.5)
    world.clear()
    assert "0 bodies (0 dynamic and awake), 0 contacts" in line(world)
    assert line(World(Effects.detection())).endswith("solver='projection', Effects())")


def test_the_repr_changes_nothing():
    world, plain = falling(), falling()
    for _ in range(30):
        world.step()
        plain.step()
        world.body(1).velocity = plain.body(1).velocity = (3.0, -1.0)
        assert all(map(repr, (world, *world, world.events, world.profile, world.joint(0), world.snapshot())))
    world.add_body(BALL).remove()
    plain.add_body(BALL).remove()
    assert repr(world) and world._removed == plain._removed, "rows of removed bodies are dropped when they are read"
    assert world.digest() == plain.digest()


def test_a_world_that_failed_to_start_or_is_in_its_step_has_a_repr():
    assert line(World.__new__(World)) == "World(unfinished)"
    world, seen = falling(), []

    class Watcher(BruteForce):
        def update(self, arena):
            seen.extend(map(line, (world, world.body(1), world.events, world.profile, world.joint(0))))
            super().update(arena)

        def fresh(self):
            return self

    world.broadphase = Watcher()
    world.step()
    assert len(seen) >= 5

    class Mine(World):
        pass

    assert line(Mine()).startswith("Mine(0 bodies")


def test_a_body_shows_its_id_kind_position_and_velocity_also_after_its_removal():
    world = falling()
    body, floor, hung = (world.body(k) for k in (1, 0, 2))
    assert line(body) == "Body(1, dynamic, position=(0.5, 2), velocity=(0, 100))"
    assert line(floor) == "Body(0, static, position=(0, 20), velocity=(0, 0))"
    for _ in range(600):
        world.step()
    assert line(body).endswith(", asleep)") and "asleep" not in line(floor)
    body.wake()
    world.bodies["x"][world.rows(1)] = np.nan
    world.touch(1)
    world.step()
    assert line(body).endswith(", quarantined)")
    body.remove()
    assert line(body) == "Body(1, removed)" and line([body]) == "[Body(1, removed)]"
    world.remove_bodies([0])
    assert line(floor) == "Body(0, removed)" and line(hung).startswith("Body(2, dynamic")
    world.clear()
    assert line(hung) == "Body(2, removed)"


def test_a_joint_says_that_it_is_gone():
    world = falling()
    joint = world.joint(0)
    assert line(joint) == "Joint(0, Revolute, world, body 2)"
    world.body(2).remove()
    assert line(joint) == "Joint(0, gone)"
    with pytest.raises(KeyError, match="joint 0 is not in this world"):
        _ = joint.angle


def test_events_show_the_number_of_each_kind_and_the_fastest_hit():
    world = falling()
    assert line(world.events).startswith("Events(begin=0, persist=0, end=0, sensor_begin=0, sensor_end=0, hits=0")
    while not len(world.events.hits):
        world.step()
    text = line(world.events)
    assert "begin=1, persist=0, end=0" in text and "hits=1" in text
    assert f"fastest hit {world.events.hits['speed'].max():.4g} px/s" in text


def test_a_row_shows_the_names_of_its_columns():
    world = falling()
    while not len(world.events.hits):
        world.step()
    contact, event, hit = world.contacts[0], world.events.begin[0], world.events.hits[0]
    assert line(contact).startswith("Contact(body_a=0, body_b=1, shape_a=0, shape_b=1, point_x=")
    assert line(event).startswith("Event(body_a=0, body_b=1") and line(hit).startswith("Hit(body_a=0")
    assert "speed=" in line(hit) and "separation=" in line(contact) and str(hit) == repr(hit)
    assert line(world.body(1).contacts[0]).startswith("Contact(")
    for name in contact.dtype.names:
        assert f"{name}=" in line(contact)
    body = world.body(2)
    body.remove()
    world.step()
    assert line(world.events.broken[0]).endswith("reason='removed')")


def test_rows_are_plain_rows_of_plain_arrays():
    world = falling()
    while not len(world.events.hits):
        world.step()
    for rows in (world.contacts, world.events.begin, world.events.hits):
        assert type(rows) is np.ndarray and isinstance(rows[0], np.void)
        plain = np.dtype({name: rows.dtype.fields[name] for name in rows.dtype.names})
        assert rows.dtype == plain and rows.astype(plain).dtype == plain
        assert pickle.loads(pickle.dumps(rows)).tobytes() == copy.deepcopy(rows).tobytes() == rows.tobytes()
        assert np.concatenate([rows, rows]).dtype == rows.dtype
        assert rows[0]["body_a"] == rows["body_a"][0] and len(rows[0].item()) == len(rows.dtype.names)
        assert not np.isnan(np.array(rows.tolist(), dtype=float)).any()


def test_snapshot_profile_and_effects_are_one_line(tmp_path):
    world = falling()
    for _ in range(3):
        world.step()
    taken = world.snapshot()
    assert line(taken).startswith("Snapshot(3 bodies, 1 joints, time=0.05") and "'soft_step'" in line(taken)
    taken.save(tmp_path / "a.npz")
    assert line(Snapshot.load(tmp_path / "a.npz")) == line(taken)
    assert line(Snapshot({}, {})) == "Snapshot()"
    text = line(world.profile)
    assert text.startswith(f"Profile({len(world.stages)} stages in ")
    assert "longest " in text and "bodies_integrated=2" in text
    assert line(World().profile).startswith("Profile(")


@pytest.mark.parametrize("effects", [Effects(), ALL, Effects.rigid_bodies(), Effects(narrowphase=False, drag=True)])
def test_the_repr_of_effects_makes_them_again(effects):
    assert eval(line(effects)) == effects


def test_a_manifold_is_one_line():
    found = collide(BALL, (0, 0), Polygon.box(8, 8), (6, 0))
    assert line(found).startswith("Manifold(normal=(1.0, 0.0), points=[(") and "separations=[" in line(found)
    assert line(collide(BALL, (0, 0), BALL, (90, 0))) == "Manifold(normal=(0.0, 0.0), points=[], separations=[])"
    mask = PixelMask(np.ones((4, 4), bool))
    assert "area=16" in line(collide(mask, (0, 0), mask, (0, 0)))
    assert line(distance(BALL, (0, 0), BALL, (90, 0))) and line(
        time_of_impact(BALL, (0, 0), (9, 0), BALL, (9, 9), (1, 1))
    )


def test_shapes_and_characters_have_reprs():
    mask = PixelMask(np.ones((4, 4), bool))
    shapes = (
        BALL, FLOOR, Capsule((0, 0), (1, 1), 2), Segment((0, 0), (1, 1)), Chain([(0, 0), (1, 1)]), mask, Bounds(mask),
        TileGrid([[True]], 8), Filter(), Material(), Revolute(None, 1, (0, 0)),
    )  # fmt: skip
    for shape in shapes:
        assert type(shape).__name__ in line(shape)
    world = falling()
    hero = Character(world, Polygon.box(8, 8), (50, -50))
    assert line(hero).startswith("Character(Body(3, kinematic, position=(50, -50)")
    hero.remove()
    assert line(hero) == "Character(Body(3, removed))"
    assert line(Character.__new__(Character)) == "Character(unfinished)"
