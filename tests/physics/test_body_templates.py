"""A body whose shapes and values equal those of an earlier body gets copies of that body's table rows.

The copies equal the rows that would be computed.
"""

import copy

import numpy as np
import pytest

from physics import Chain, Circle, Effects, Filter, Material, PixelMask, Polygon, TileGrid, World

RIGID = Effects.rigid_bodies().with_(carving=True)
WORLDS = {"detection": Effects.detection().with_(sensors=True), "sleeping": RIGID, "awake": RIGID.with_(sleeping=False)}
MASK = PixelMask(np.array([[1, 1, 0], [0, 1, 1], [1, 1, 1]], bool).repeat(4, 0).repeat(4, 1))
BOX, GRID = Polygon.box(8, 6), TileGrid(np.ones((2, 2), bool), 8.0)


def random_body(rng, effects):
    """Return random (shapes, keyword arguments) for add_body; there are so few choices that they repeat."""
    kind = ("dynamic", "kinematic", "static")[rng.integers(3)]
    shapes = [(BOX,), (Circle(4.0),), (MASK,), (BOX, Circle(3.0, (5, 0))), (BOX.with_(filter=Filter(2, 2)), MASK), ()]
    if kind != "dynamic":
        shapes += [(GRID,), (Chain([(0, 0), (20, 0)]), Circle(2.0))]
    used = shapes[rng.integers(len(shapes))]
    moving = kind != "static"
    spin = float(rng.choice((0.0, 1.5))) if moving and effects.rotation and GRID not in used else 0.0
    return used, {
        "kind": kind,
        "position": tuple(rng.uniform(-90, 90, 2)),
        "angle": float(rng.choice((0.0, 0.7))) if GRID not in used else 0,
        "velocity": tuple(rng.uniform(-9, 9, 2)) if moving and rng.random() < 0.5 else (0, 0),
        "angular_velocity": spin,
        "mass": (None, 3, 2.5)[rng.integers(3)],
        "material": (Material(), Material(2.0, 0.1))[rng.integers(2)],
        "filter": (Filter.ALL, Filter(1, 5))[rng.integers(2)],
        "sensor": bool(rng.random() < 0.2),
        "user": (None, "name")[rng.integers(2)],
    }


def tables(world):
    """Return all rows of a world, and the used proxies of its broad phase."""
    slots = world.shapes["proxy"]
    proxies = world.pairs.proxies[slots[slots >= 0]]
    return (
        world.digest(),
        *(table.rows.tobytes() for table in (world._bodies, world._definitions, world._shapes, world._runs)),
        proxies[[name for name in proxies.dtype.names if name != "changed"]].tolist(),
        world.pairs.sensors,
        world._users,
        repr(world._shapes_of),  # carved masks are equal to themselves alone
    )


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("effects", WORLDS)
def test_the_same_rows_as_computed(effects, seed):
    """Copied rows equal computed ones, also when removals, carving and steps reuse slots and move rows."""
    rng = np.random.default_rng(seed)
    one, other = World(WORLDS[effects]), World(WORLDS[effects])
    known = 0
    for turn in range(160):
        shapes, values = random_body(rng, one.effects)
        known += len(one._templates)
        one.add_body(*shapes, **values)
        other._templates.clear()
        other.add_body(*shapes, **values)
        if rng.random() < 0.3:
            gone = int(rng.choice(one.bodies["id"]))
            for world in (one, other):
                world.remove_body(gone)
        if effects != "detection" and turn % 40 == 30:
            mine = [body.id for body in one if body.shapes == (MASK,)][:1]
            for world in (one, other):
                for identity in mine:
                    body = world.body(identity)
                    body.carve(Circle(3), body.position)
        assert tables(one) == tables(other)
        if turn % 9 == 8:
            for world in (one, other):
                world.step()
            assert tables(one) == tables(other)
    assert known > 1000


def test_wrong_values_are_refused_though_their_equals_are_known():
    """A value of the wrong type is refused even if an earlier body had an equal value of the right type.

    For example, True equals 1.0 but is no valid mass.
    """
    world = World(RIGID)
    for _ in range(3):
        world.add_body(BOX)
    assert len(world._templates) == 1
    for name, value in [
        ("sensor", 0), ("bullet", 0), ("fixed_rotation", 0), ("allow_sleep", 1), ("gravity_scale", True),
        ("mass", True), ("mass", 0.0), ("kind", 2), ("kind", ["dynamic"]), ("continuous", 3), ("material", None),
        ("filter", 1), ("position", (float("nan"), 0)), ("angle", True), ("velocity", 0), ("angular_velocity", "0"),
    ]:  # fmt: skip
        with pytest.raises((TypeError, ValueError), match=name):
            world.add_body(BOX, **{name: value})
    for shape in (5, [BOX], None, np.zeros(3)):
        with pytest.raises(TypeError, match="shapes must be shapes"):
            world.add_body(shape)
    world.add_body(BOX, kind="static")
    for value in ({"velocity": (1, 0)}, {"angular_velocity": 1.0}):
        with pytest.raises(ValueError, match="must be 0 for a static body"):
            world.add_body(BOX, kind="static", **value)
    world._stepping = True
    with pytest.raises(RuntimeError, match="during its step"):
        world.add_body(BOX)
    world._stepping = False
    assert len(world) == 4


def test_other_effects_and_copies():
    world = World(RIGID)
    world.add_body(BOX, sensor=True)
    world.set_effects(RIGID.with_(sensors=False))
    with pytest.raises(ValueError, match="needs the effect sensors"):
        world.add_body(BOX, sensor=True)
    other = copy.deepcopy(world)
    for each in (world, other):
        each.add_body(BOX)
        each.restore(each.snapshot())
        each.add_body(BOX)
        each.step()
    assert tables(world) == tables(other) and len(world) == 3
