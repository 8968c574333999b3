"""World.touching returns the pairs whose contact has begun and not ended, awake or asleep."""

import numpy as np
import pytest

from physics import Circle, Effects, Filter, PixelMask, Polygon, Segment, TileGrid, World

RIGID = Effects.rigid_bodies()
WORLDS = {
    "detection": Effects.detection().with_(sensors=True),
    "boxes": Effects(narrowphase=False),
    "pushing": Effects(response=True, gravity=True, rotation=True, sensors=True),
    "awake": RIGID.with_(sleeping=False),
    "sleeping": RIGID,
}
RING = PixelMask(np.array([[1, 1, 1], [1, 0, 1], [1, 1, 1]], bool).repeat(5, 0).repeat(5, 1))
EXACT = PixelMask(np.ones((7, 11), bool), snap=False)
SHAPES = (Circle(6.0), Polygon.box(14, 9), RING, EXACT, Polygon.box(8, 8, center=(5, 0)))


def random_world(effects, seed):
    """Return a world of 60 bodies of all kinds and shapes, some of several shapes, some of them sensors."""
    rng, world = np.random.default_rng(seed), World(effects, seed=seed)
    world.add_body(Polygon.box(900, 20), kind="static", position=(0, 100))
    world.add_body(TileGrid(np.ones((2, 3), bool), 16.0), kind="static", position=(40, 20))
    for _ in range(60):
        shapes = [SHAPES[k] for k in rng.integers(0, len(SHAPES), rng.integers(1, 3))]
        if effects.sensors and rng.random() < 0.2:
            shapes.append(Circle(9.0).with_(sensor=True))
        moves = not effects.gravity
        world.add_body(
            *shapes,
            position=tuple(rng.uniform((-90, -70), (90, 85))),
            kind=("dynamic", "dynamic", "dynamic", "kinematic", "static")[rng.integers(5)],
            sensor=bool(effects.sensors and rng.random() < 0.1),
            filter=Filter(1, 1) if rng.random() < 0.9 else Filter(2, 2),
            user=f"user {rng.integers(9)}",
        )
        if moves:
            row = world.bodies[-1:]
            row["vx"], row["vy"] = rng.uniform(-60, 60, 2) if row["kind"][0] else (0.0, 0.0)
    return world, rng


class Book:
    """Pairs of shapes whose contact has begun and not ended, tracked by events only."""

    def __init__(self):
        self.open = {}

    def note(self, events):
        for row in events.end.tolist():
            del self.open[row[2:4]]
        for row in events.begin.tolist():
            assert row[2:4] not in self.open
            self.open[row[2:4]] = tuple(sorted(row[:2]))

    @property
    def pairs(self):
        return sorted(set(self.open.values()))


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("effects", WORLDS)
def test_what_has_begun_and_not_ended(effects, seed):
    """World.touching equals the pairs tracked by events in every step of an edited run, also when most bodies sleep."""
    world, rng = random_world(WORLDS[effects], seed)
    book, most, asleep = Book(), 0, 0
    for step in range(400 if effects == "sleeping" else 90):
        world.step()
        book.note(world.events)
        found = world.touching()
        assert found.dtype == np.int64 and found.shape == (len(found), 2)
        assert [tuple(pair) for pair in found.tolist()] == book.pairs, step
        most, asleep = max(most, len(found)), int((~world.bodies["awake"]).sum())
        if step % 40 == 30 and step < 200:
            some = rng.choice(world.bodies["id"][2:], 4, replace=False)
            world.move(some[:2], rng.uniform(-90, 90, (2, 2)))
            world.remove_body(int(some[2]))
            left = [tuple(pair) for pair in world.touching().tolist()]
            assert left == [pair for pair in book.pairs if some[2] not in pair]
    assert most > 12 and (asleep > 10) == (effects == "sleeping")
    users = world.touching(users=True)
    assert users == [(world.body(a).user, world.body(b).user) for a, b in world.touching().tolist()]


@pytest.mark.parametrize("effects", ["detection", "boxes"])
def test_without_response_they_are_the_contacts(effects):
    world, _ = random_world(WORLDS[effects], 7)
    for _ in range(20):
        world.step()
        contacts = world.contacts
        pairs = {
            tuple(sorted(pair)) for pair in zip(contacts["body_a"].tolist(), contacts["body_b"].tolist(), strict=True)
        }
        assert [tuple(pair) for pair in world.touching().tolist()] == sorted(pairs)


def test_masks_touch_where_they_share_pixels():
    """Masks touch only if they share pixels: adjacent squares do not, and a ball in a ring's gap does not."""
    world = World(Effects.detection())
    square = PixelMask(np.ones((4, 4), bool), origin=(0, 0))
    for x in (0, 4, 7):
        world.add_body(square, position=(x, 0), user=x)
    world.step()
    assert world.touching().tolist() == [[1, 2]] and world.touching(users=True) == [(4, 7)]


def test_sensors_are_left_out():
    for effects in (RIGID, Effects.detection().with_(sensors=True)):
        world = World(effects, gravity=(0, 0) if effects.gravity else None)
        world.add_body(Circle(5), sensor=True)
        world.add_body(Circle(5), position=(3, 0))
        world.add_body(Circle(5), position=(30, 0), sensor=True)
        world.add_body(Circle(5), position=(33, 0), sensor=True)
        world.step()
        assert len(world.events.sensor_begin) >= 1 and not len(world.touching()) and world.touching(users=True) == []


def test_sleeping_pairs_are_listed_and_kept_by_a_snapshot():
    world = World()
    world.add_body(Segment((-90, 8), (90, 8)), kind="static", user="floor")
    for k in range(3):
        world.add_body(Polygon.box(8, 8), position=(0, 4 - 8 * k), user=k)
    while world.bodies["awake"][1:].any():
        world.step()
    expected = [[0, 1], [1, 2], [2, 3]]
    assert world.touching().tolist() == expected and not len(world.contacts)
    other = World()
    other.restore(world.snapshot())
    assert other.touching().tolist() == expected and other.touching(users=True) == [(None, None)] * 3
    world.remove_body(2)
    assert world.touching().tolist() == [[0, 1]] and world.touching(users=True) == [("floor", 0)]


def test_a_set_of_shapes_and_wrong_arguments():
    world = World(Effects.detection())
    assert world.touching().shape == (0, 2) and world.touching(users=True) == []
    one, two = world.add_body(Circle(5), Circle(4)), world.add_body(Circle(5), Circle(4), position=(2, 0))
    world.step()
    assert world.touching().tolist() == [[0, 1]]
    one.set_shapes(Circle(3))
    assert not len(world.touching())
    world.step()
    assert world.touching().tolist() == [[one.id, two.id]]
    with pytest.raises(TypeError, match="users must be True or False"):
        world.touching(users=1)
