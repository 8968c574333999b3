"""A new type of convex shape behaves, to the bit, as the built-in shape with the same corners and radius.

With one corner it equals a circle, with two a capsule or a segment.
"""

from dataclasses import dataclass

import numpy as np
import pytest

from physics import (
    Bounds,
    Capsule,
    Character,
    Circle,
    Effects,
    PixelMask,
    Polygon,
    Segment,
    Snapshot,
    World,
    checks,
    collide,
    debug,
    distance,
    mass_of,
    time_of_impact,
)
from physics.shapes.kinds import SHAPES
from physics.shapes.values import Convex

FLOOR = Polygon.box(200.0, 10.0)


@dataclass(frozen=True)
class Coin(Convex):
    """A disc given by its diameter."""

    diameter: float
    center: tuple = (0.0, 0.0)

    def __post_init__(self):
        object.__setattr__(self, "center", checks.vector("center", self.center))

    @property
    def radius(self):
        return self.diameter / 2.0

    @property
    def points(self):
        return (self.center,)


@dataclass(frozen=True)
class Pill(Convex):
    """A capsule given by its length."""

    length: float
    radius: float

    @property
    def points(self):
        return ((-self.length / 2.0, 0.0), (self.length / 2.0, 0.0))


@dataclass(frozen=True)
class Wire(Convex):
    """A segment given by its length."""

    length: float
    _has_mass = False

    @property
    def points(self):
        return ((-self.length / 2.0, 0.0), (self.length / 2.0, 0.0))


TWINS = {
    "coin": (Coin(8.0), Circle(4.0)),
    "coin beside": (Coin(8.0, (3.0, -2.0)), Circle(4.0, (3.0, -2.0))),
    "pill": (Pill(12.0, 3.0), Capsule((-6.0, 0.0), (6.0, 0.0), 3.0)),
    "wire": (Wire(20.0), Segment((-10.0, 0.0), (10.0, 0.0))),
}


@pytest.fixture(params=TWINS)
def twins(request, monkeypatch):
    """Yield (a shape of a new type, an equal shape of a built-in type).

    The list SHAPES contains the new types during the test.
    """
    SHAPES.extend((Coin, Pill, Wire))
    yield TWINS[request.param]
    del SHAPES[-3:]


def test_it_is_weighed_and_measured_as_its_twin(twins):
    new, old = twins
    assert mass_of(new, 3.0) == mass_of(old, 3.0) and new.min_half_extent == old.min_half_extent
    assert new.reach(5.0, 6.0) == old.reach(5.0, 6.0) and new.bounds == old.bounds


def test_it_meets_what_its_twin_meets(twins):
    new, old = twins
    for other in (Circle(5.0), Polygon.box(9.0, 6.0), Capsule((0, 0), (5, 5), 2.0), PixelMask(np.ones((7, 9), bool))):
        for pose in ((6.0, 2.0, 0.3), (40.0, -3.0, 1.0)):
            found, wanted = (collide(each, (0.0, 0.0, 0.2), other, pose) for each in twins)
            assert len(found) == len(wanted) and np.allclose(found.separations, wanted.separations)
            gaps = [distance(each, (0.0, 0.0, 0.2), other, pose).distance for each in twins]
            assert gaps[0] == pytest.approx(gaps[1], abs=1e-12)
        impacts = [time_of_impact(each, (0, 0), (60, 1, 1.0), other, (60, 0), (0, 0, 2.0)) for each in twins]
        assert impacts[0].hit and impacts[0].fraction == pytest.approx(impacts[1].fraction, abs=1e-12)


def test_its_world_is_that_of_its_twin(twins, tmp_path):
    digests = []
    for shape in twins:
        world = World()
        world.add_body(FLOOR, position=(0.0, 40.0), kind="static")
        world.add_body(shape, kind="static", position=(-30.0, 30.0), angle=0.4)
        if shape._has_mass:
            world.add_body(shape, Bounds(shape), position=(3.0, 0.0), velocity=(30.0, 0.0), angular_velocity=2.0)
        world.add_body(Circle(6.0), position=(-30.0, 0.0))
        for _ in range(60):
            world.step()
        world.snapshot().save(tmp_path / "s.npz")
        other = World()
        other.restore(Snapshot.load(tmp_path / "s.npz"))
        assert [body.shapes for body in other] == [body.shapes for body in world]
        assert type(other.body(1).shapes[0]) is type(shape)
        assert (
            len(world.contacts) + len(world.sleeping_contacts)
            and world.ray_cast((-30.0, -99.0), (1.0, 200.0)) is not None
        )
        drawn = [[each[0], *np.ravel(each[1]).tolist()] for each in debug.outlines(world)]
        digests.append((world.digest(), other.digest(), drawn))
    assert digests[0] == digests[1] and digests[0][0] == digests[0][1]


def test_unused_geometry_goes_and_what_is_used_stays(twins):
    new, _ = twins
    world = World(Effects())
    keeps = world.add_body(new, Bounds(new) if new._has_mass else new, kind="static")
    for k in range(120):
        world.remove_body(world.add_body(Polygon.box(4.0 + k, 3.0), kind="static"))
    assert world.library.shape_of(world.shapes[0]) == new and keeps.shapes[0] == new
    assert len(world.library.shapes) < 100, "it was tidied"


def test_a_character_is_one_where_it_has_an_area(twins):
    moves = []
    for shape in twins:
        world = World(Effects(response=True))
        world.add_body(FLOOR, position=(0.0, 40.0), kind="static")
        if not shape._has_mass:
            with pytest.raises(TypeError, match="Circle, Capsule, Coin or Pill"):
                Character(world, shape, (0, 0))
            continue
        hero = Character(world, shape, (0, 0))
        moves.append([(*hero.move(1.0, 3.0)[:3], *hero.position) for _ in range(30)])
    assert not moves or moves[0] == moves[1]


def test_a_line_is_no_dynamic_body_and_no_tool():
    SHAPES.append(Wire)
    try:
        world = World(Effects(response=True, carving=True))
        with pytest.raises(ValueError, match="a Wire has none"):
            world.add_body(Wire(5.0))
        with pytest.raises(TypeError, match="must be a Circle, Capsule, Polygon or PixelMask"):
            Bounds(Wire(5.0))
        with pytest.raises(TypeError, match="one of Circle, Capsule, Polygon, PixelMask to carve"):
            world.add_body(PixelMask(np.ones((4, 4), bool))).carve(Wire(5.0), (0, 0))
    finally:
        SHAPES.remove(Wire)
