"""Shapes are immutable values: setting, deleting and writing into arrays is refused; equality and hash are by value."""

import copy
import dataclasses
import pickle
import subprocess
import sys

import numpy as np
import pytest

import physics
from physics import (
    Bounds,
    Capsule,
    Chain,
    Circle,
    Effects,
    Filter,
    Material,
    PixelMask,
    Polygon,
    Segment,
    TileGrid,
    World,
)
from physics.raster.bits import Turned
from physics.shapes.kinds import SHAPES
from physics.shapes.shape import Shape

SOLID = np.array([[0, 1, 1], [1, 1, 0]], bool).repeat(20, 0).repeat(30, 1)
SLOPES = np.zeros((*SOLID.shape, 2))
SLOPES[0, 0] = 0.0, 1.0
CARVED = PixelMask(SOLID).with_tiles(PixelMask(SOLID).tiles)
MAKERS = {
    "Circle": lambda: Circle(5, (1, 2)),
    "Capsule": lambda: Capsule((0, 0), (9, 1), 3),
    "Polygon": lambda: Polygon([(0, 0), (9, 0), (0, 7)], 1),
    "box": lambda: Polygon.box(9, 7),
    "Segment": lambda: Segment((0, 0), (9, 1)),
    "Chain": lambda: Chain([(0, 0), (9, 1), (20, 1)], ghosts=((-1, 0), None), materials=(Material(), Material(2.0))),
    "TileGrid": lambda: TileGrid(SOLID, 8, slopes=SLOPES),
    "PixelMask": lambda: PixelMask(SOLID, (3, 4)),
    "PixelMask with values": lambda: PixelMask(SOLID, snap=False, smooth=0.2).with_(Material(), Filter(2), True, True),
    "carved": lambda: CARVED.with_(sensor=True),
    "Bounds": lambda: Bounds(PixelMask(SOLID)),
    "Bounds with values": lambda: Bounds(Circle(3).with_(sensor=True)),
}
OTHERS = {
    "Circle": [lambda: Circle(5), lambda: Circle(5, (1, 2)).with_(sensor=True)],
    "TileGrid": [
        lambda: TileGrid(SOLID, 8),
        lambda: TileGrid(SOLID, 9, slopes=SLOPES),
        lambda: TileGrid(~SOLID, 8),
        lambda: TileGrid(SOLID[1:], 8, slopes=SLOPES[1:]),
        lambda: TileGrid(SOLID, 8, one_way=(SLOPES > 0).any(axis=2)),
        lambda: TileGrid(SOLID, 8, slopes=SLOPES).with_(Material(2.0)),
    ],
    "PixelMask": [
        lambda: PixelMask(~SOLID, (3, 4)),
        lambda: PixelMask(SOLID, (3, 5)),
        lambda: PixelMask(SOLID, (3, 4), snap=False),
        lambda: PixelMask(SOLID, (3, 4), smooth=0.25),
        lambda: PixelMask(SOLID, (3, 4), one_way=True),
        lambda: PixelMask(SOLID, (3, 4)).with_(filter=Filter(2)),
        lambda: PixelMask(np.pad(SOLID, ((0, 0), (0, 1))), (3, 4)),
        lambda: PixelMask(SOLID.ravel()[None], (3, 4)),
    ],
    "Bounds": [lambda: Bounds(PixelMask(~SOLID)), lambda: Bounds(PixelMask(SOLID, (3, 4)))],
}


def attributes(shape):
    """Return the names of all attributes that can be read of a shape, with the private ones."""
    return sorted(name for name in {*dir(shape), *vars(shape)} if not name.startswith("__"))


def test_every_shape_is_swept():
    made = {type(make()) for make in MAKERS.values()}
    public = {each for each in vars(physics).values() if isinstance(each, type) and issubclass(each, Shape)}
    assert made == set(SHAPES) == public - {Shape}


@pytest.mark.parametrize("make", MAKERS.values(), ids=MAKERS)
def test_every_attribute_refuses_to_be_set_and_deleted(make):
    shape, before = make(), repr(make())
    for name in (*attributes(shape), "colour", "_other", "__dict__", "x"):
        for change in (lambda n=name: setattr(shape, n, 3), lambda n=name: delattr(shape, n)):
            with pytest.raises(dataclasses.FrozenInstanceError, match="shapes are immutable") as refused:
                change()
            text = str(refused.value)
            assert text.startswith(type(shape).__name__) and ": write " in text, text
    assert repr(shape) == before and shape == make()


@pytest.mark.parametrize(
    "kind, name, words",
    [
        ("Circle", "radius", "body.set_shapes(Circle(…)), with a new Circle"),
        ("Circle", "sensor", "shape.with_(sensor=3)"),
        ("Bounds", "shape", "body.set_shapes(Bounds(…)), with a new Bounds"),
        ("TileGrid", "tile_size", "body.set_shapes(TileGrid(…)), with a new TileGrid"),
        ("TileGrid", "solid", "body.set_cells(cells, solid)"),
        ("TileGrid", "material", "shape.with_(material=3)"),
        ("PixelMask", "origin", "body.set_shapes(PixelMask(…)), with a new PixelMask"),
        ("PixelMask", "words", "body.carve(…)"),
        ("PixelMask", "one_way", "mask.with_(one_way=3)"),
        ("PixelMask", "filter", "shape.with_(filter=3)"),
    ],
)
def test_the_message_names_the_call_that_makes_a_changed_shape(kind, name, words):
    with pytest.raises(AttributeError) as refused:
        setattr(MAKERS[kind](), name, 3)
    assert words in str(refused.value), str(refused.value)


def arrays_of(value):
    """Return the arrays in a value, and in tuples and named tuples of it."""
    if isinstance(value, np.ndarray):
        return [value]
    if isinstance(value, tuple):
        return [array for each in value for array in arrays_of(each)]
    if isinstance(value, Turned):
        return [value.solid, value.source_x, value.source_y]
    return []


@pytest.mark.parametrize("make", MAKERS.values(), ids=MAKERS)
def test_every_public_array_is_read_only(make):
    shape = make()
    values = [getattr(shape, name) for name in attributes(shape) if not name.startswith("_")]
    found = [array for each in values if not callable(each) for array in arrays_of(each)]
    if isinstance(shape, PixelMask):
        found += [array for angle in (0.0, 0.3, np.pi / 2) for array in arrays_of(shape.turned(angle))]
    assert len(found) == {TileGrid: 3, PixelMask: 11}.get(type(shape), 0)
    for array in found:
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0


@pytest.mark.parametrize("kind", MAKERS)
def test_equal_values_are_equal_shapes(kind):
    shape, same = MAKERS[kind](), MAKERS[kind]()
    assert shape is not same
    for other in (same, copy.copy(shape), copy.deepcopy(shape), pickle.loads(pickle.dumps(shape))):
        assert shape == other and not (shape != other) and hash(shape) == hash(other)
        assert {shape: 1}[other] == 1 and len({shape, other}) == 1
    assert shape.with_(sensor=False) == same.with_(sensor=False) != shape
    assert not any(shape == make() for other, make in MAKERS.items() if other != kind)
    assert all(shape != other for other in (None, 3, (), repr(shape), object(), SOLID.tolist()))


@pytest.mark.parametrize("kind, k", [(kind, k) for kind, others in OTHERS.items() for k in range(len(others))])
def test_other_values_are_other_shapes(kind, k):
    shape, other = MAKERS[kind](), OTHERS[kind][k]()
    assert shape != other and other != shape and not (shape == other)


def test_a_carved_mask_equals_a_new_one_of_the_same_pixels():
    assert PixelMask(SOLID) == CARVED and hash(PixelMask(SOLID)) == hash(CARVED)


def test_the_hash_of_pixels_is_the_same_in_every_process():
    """A pickled mask keeps its stored hash, which must be that of an equal mask in the process that loads it."""
    mask = PixelMask(SOLID)
    assert hash(mask)
    program = "import pickle, sys; mask = pickle.load(sys.stdin.buffer); again = mask.like(mask.solid, mask.origin); "
    program += "assert mask == again and hash(mask) == hash(again)"
    subprocess.run([sys.executable, "-c", program], input=pickle.dumps(mask), check=True, timeout=60)


@pytest.mark.parametrize("kind", ["dynamic", "static"])
def test_equal_masks_are_carved_apart(kind):
    """Bodies with equal masks stay independent: each cut changes one body only, as with unequal masks."""
    effects = Effects.rigid_bodies().with_(carving=True)
    solid = np.ones((40, 400), bool)
    solid[0, 0] = False  # not full, so that its outline is stored in tiles
    world, shared = World(effects), PixelMask(solid)
    bodies = [world.add_body(PixelMask(solid), position=(0, 500 * k), kind=kind) for k in range(3)]
    bodies += [world.add_body(shared, position=(0, 2000 + 500 * k), kind=kind) for k in range(2)]
    for k, body in enumerate(bodies):
        body.carve(Circle(4 + k), body.position)
        areas = [each.shapes[0].area for each in bodies]
        assert len(set(areas[: k + 1])) == k + 1 and areas[k + 1 :] == [shared.area] * (len(bodies) - k - 1)
        world.step()
    for body in bodies:
        assert body not in world.query_point(body.position)
        assert body in world.query_point(body.position + (30, 0))
    pickled = pickle.loads(pickle.dumps(world))
    for each in (world, pickled):
        for body in [*each][:5]:
            body.carve(Circle(3), body.position + (50, 0))
            each.step()
    assert world.digest() == pickled.digest()


def test_equal_grids_change_apart():
    world = World()
    one, other = (world.add_body(TileGrid(np.ones((3, 3)) > 0, 8), position=(0, 90 * k), kind="static") for k in (0, 1))
    assert one.shapes == other.shapes
    one.set_cells([(1, 1)], False)
    assert one.shapes != other.shapes and world.query_point((12, 12)) == [] and world.query_point((12, 102)) == [other]
    one.set_cells([(1, 1)], True)
    assert one.shapes == other.shapes
