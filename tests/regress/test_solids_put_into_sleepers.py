"""A body that comes to overlap a sleeping body by an edit wakes it; one that does not touch it does not.

The edits: it is added, enlarged, made solid, or accepted by a filter.
"""

import numpy as np
import pytest

from physics import Chain, Circle, Filter, PixelMask, Polygon, Segment, TileGrid, World

SOLIDS = {
    "box": Polygon.box(30, 30),
    "circle": Circle(15),
    "tiles": TileGrid(np.ones((2, 2), bool), 16),
    "mask": PixelMask(np.ones((30, 30), bool)),
    "segment": Segment((-20, 3), (20, -3)),
    "chain": Chain([(-20, 1), (20, 0)]),
}


def asleep(height=20):
    world = World()
    world.add_body(Polygon.box(4000, 20), position=(0, 100), kind="static")
    crate = world.add_body(Polygon.box(20, height), position=(0, 90 - height / 2))
    while crate.awake:
        world.step()
    return world, crate


def has_been_pushed(world, crate):
    before = (crate.position, crate.angle)
    world.step()
    woken = crate.awake
    for _ in range(20):
        world.step()
    return woken and (crate.position, crate.angle) != before


@pytest.mark.parametrize("kind", ["static", "kinematic"])
@pytest.mark.parametrize("name", SOLIDS)
def test_a_solid_added_into_a_sleeper_wakes_it(name, kind):
    world, crate = asleep()
    world.add_body(SOLIDS[name], position=(-8, 80), kind=kind)
    assert has_been_pushed(world, crate)


@pytest.mark.parametrize("kind", ["static", "kinematic"])
@pytest.mark.parametrize("name", SOLIDS)
@pytest.mark.parametrize("way", ["set_shapes", "add_shape"])
def test_a_solid_grown_into_a_sleeper_wakes_it(name, kind, way):
    world, crate = asleep()
    grower = world.add_body(Circle(1), position=(-28, 80), kind=kind)
    for _ in range(5):
        world.step()
    assert not crate.awake
    shape = SOLIDS[name]
    if name in ("segment", "chain"):
        shape = type(shape)((0, 3), (40, -3)) if name == "segment" else Chain([(0, 1), (40, 0)])
    if name == "tiles":
        shape = TileGrid(np.ones((2, 3), bool), 16)
    getattr(grower, way)(Polygon.box(50, 30) if name in ("box", "circle", "mask") else shape)
    assert has_been_pushed(world, crate)


@pytest.mark.parametrize("way", ["filter", "sensor", "restore"])
def test_what_becomes_solid_in_a_sleeper_wakes_it(way):
    world, crate = asleep()
    ghost = world.add_body(SOLIDS["box"], position=(-8, 80), kind="static", **{
        "filter": {"filter": Filter(1, 0)}, "sensor": {"sensor": True}, "restore": {"filter": Filter(1, 0)},
    }[way])  # fmt: skip
    for _ in range(5):
        world.step()
    assert not crate.awake
    if way == "sensor":
        ghost.sensor = False
    elif way == "filter":
        ghost.filter = Filter.ALL
    else:
        world.bodies["x"][ghost.id] = np.nan
        world.touch([ghost])
        world.step()
        ghost.filter = Filter.ALL
        world.step()
        ghost.restore()
    assert has_been_pushed(world, crate)


def test_what_stands_beside_or_only_senses_wakes_nobody():
    world, crate = asleep()
    world.add_body(SOLIDS["box"], position=(-30, 75), kind="static")
    world.add_body(SOLIDS["box"], position=(0, 80), kind="static", sensor=True)
    world.add_body(SOLIDS["box"], position=(0, 80), kind="static", filter=Filter(1, 0))
    world.add_body(SOLIDS["box"].with_(sensor=True), position=(0, 80), kind="static")
    for _ in range(5):
        world.step()
        assert not crate.awake


def test_a_shape_added_to_a_body_that_is_awake_is_met():
    """Shapes added to an awake body collide at once, in the same set of awake bodies."""
    for way in ("set_shapes", "add_shape"):
        world = World()
        world.add_body(Polygon.box(4000, 20), position=(0, 200), kind="static")
        faller = world.add_body(Circle(2), position=(0, 100))
        world.step()
        getattr(faller, way)(Polygon.box(40, 40))
        for _ in range(90):
            world.step()
        assert faller.position.y == pytest.approx(170, abs=0.5), way
