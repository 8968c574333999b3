"""Every argument of every public function, given a wrong type, a wrong value, NaN and infinity.

The error names the argument and the value, and the world is unchanged, including its tables.
"""

import math
from functools import partial

import numpy as np
import pytest

from physics import (
    BROADPHASES,
    Bounds,
    BruteForce,
    Character,
    Circle,
    DynamicTree,
    Effects,
    Filter,
    Material,
    PixelMask,
    Polygon,
    Snapshot,
    SpatialHashGrid,
    SweepAndPrune,
    TileGrid,
    World,
    collide,
    fit,
    mass_of,
)

NAN, INF = math.nan, math.inf
BOX, BALL = Polygon.box(4, 4), Circle(3.0)
MASK = PixelMask(np.ones((2, 2), bool))
ALL = Effects(
    response=True,
    gravity=True,
    drag=True,
    wind=True,
    rotation=True,
    friction=True,
    restitution=True,
    continuous=True,
    sensors=True,
    persist=True,
    one_way=True,
)
NO_NUMBER = ["1", None, [1], (1, 2), {}, 1j, True]
NOT_FINITE = [NAN, INF, -INF, 10**400]
NUMBER = NO_NUMBER + NOT_FINITE
VECTOR = [1.0, "ab", None, (1,), (1, 2, 3), (NAN, 0), (0, INF), ("1", 2), (1, None), {}, (10**400, 0)]
FLAG = [1, 0, "yes", None, [True]]
ARRAY = ["ab", None, [[1, 2, 3]], [[NAN, 0]], [[0, INF]], [1, 2], [["a", "b"]], [[1j, 0]], [("1", "2")], 5]


def world_of_three():
    """Return a world with three bodies, after one step."""
    world = World(ALL)
    world.add_body(BALL, velocity=(5.0, 3.0))
    world.add_body(BOX, position=(2.0, 1.0), kind="static")
    world.add_body(PixelMask(np.ones((3, 3), bool)), position=(90.0, 1.0), kind="kinematic", tier="circle")
    world.step()
    return world


def state(world):
    """Return a tuple of all state that a refused argument must not change."""
    return (
        world.digest(),
        world.bodies.tobytes(),
        world.shapes.tobytes(),
        world.characters.rows.tobytes(),
        world.gravity,
        world.wind,
        world.solver,
        world.dt,
        world.drag,
        world.broadphase,
        world._next_body,
        world._next_shape,
        world._definitions.rows.tobytes(),
        dict(world._targets),
        world.time,
        str(world.random.bit_generator.state),
        len(world._shapes_of),
        len(world._users),
        len(world._tiers),
    )


def refused(name, value, call):
    """Assert that call(value) raises ValueError or TypeError with the argument's name and the value in its message."""
    with pytest.raises((ValueError, TypeError)) as caught:
        call(value)
    assert not isinstance(caught.value, UnicodeError)
    text = str(caught.value)
    assert name in text, f"{text!r} does not name {name}"
    assert "got" in text and len(text) < 600, text


CONSTRUCTORS = [
    ("radius", lambda v: Circle(v), NUMBER + [0, -1.0]),
    ("center", lambda v: Circle(1.0, v), VECTOR),
    (
        "points",
        lambda v: Polygon(v),
        [
            "ab",
            None,
            5,
            [],
            [(0, 0)],
            [(0, 0), (1, 0), (NAN, 1)],
            [(0, 0), (1, 0), (INF, 1)],
            [(0, 0, 0)] * 3,
            [("0", "0"), ("1", "0"), ("0", "1")],
            [(0, 0), (1, 0), (2, 0)],
        ],
    ),
    ("width", lambda v: Polygon.box(v, 1), NUMBER + [0, -2]),
    ("height", lambda v: Polygon.box(1, v), NUMBER + [0, -2]),
    ("center", lambda v: Polygon.box(1, 1, v), VECTOR),
    ("angle", lambda v: Polygon.box(1, 1, (0, 0), v), NUMBER),
    ("shape", lambda v: Bounds(v), [None, 5, "x", TileGrid(np.ones((1, 1), bool), 8), Bounds(BALL)]),
    ("solid", lambda v: TileGrid(v, 8), [None, "x", [1, 0], 5, [[0.5]], [[1, 0], [1]], [["a"]], [[NAN]]]),
    ("tile_size", lambda v: TileGrid([[True]], v), NUMBER + [0, -8]),
    ("one_way", lambda v: TileGrid([[True]], 8, one_way=v), ["x", [1], [[True, True]], [[0.5]], 5]),
    (
        "slopes",
        lambda v: TileGrid([[False]], 8, slopes=v),
        ["x", [1], [[[0, 2]]], [[[-0.1, 0]]], [[[NAN, 0]]], [[(0, 1, 1)]], 5],
    ),
    ("cell", lambda v: TileGrid([[True]], 8, one_way=v), [[[True]]]),
    ("solid", lambda v: PixelMask(v), [None, "x", [1, 0], 5, [[0.5]], [[1, 0], [1]], [[NAN]], [["a"]]]),
    ("solid", lambda v: PixelMask.from_array(v), [None, [[[1]]], [[0.5]]]),
    ("origin", lambda v: PixelMask(np.ones((2, 2), bool), v), [x for x in VECTOR if x is not None]),
    ("snap", lambda v: PixelMask(np.ones((2, 2), bool), None, v), FLAG),
    ("surface", lambda v: PixelMask.from_surface(v), [None, 5, np.ones((2, 2))]),
    ("mask", lambda v: PixelMask.from_mask(v), [None, 5, np.ones((2, 2)), MASK]),
    ("x", lambda v: MASK.flipped(v), FLAG),
    ("y", lambda v: MASK.flipped(y=v), FLAG),
    ("factor", lambda v: MASK.scaled(v), NUMBER + [0, -1, 1e9]),
    ("material", lambda v: BALL.with_(v), [5, "ice", Filter(), ()]),
    ("filter", lambda v: MASK.with_(filter=v), [5, (1, 2), Material()]),
    ("sensor", lambda v: BOX.with_(sensor=v), [1, 0, "yes", [True]]),
    ("angle", lambda v: PixelMask(np.ones((2, 2), bool)).turned(v), NUMBER),
    ("density", lambda v: Material(v), NUMBER + [0, -1]),
    ("friction", lambda v: Material(friction=v), NUMBER + [-1]),
    ("restitution", lambda v: Material(restitution=v), NUMBER + [-1]),
    ("membership", lambda v: Filter(v), [-1, 1 << 32, 1.0, "1", None, True]),
    ("mask", lambda v: Filter(1, v), [-1, 1 << 32, 1.0, "1", None, True]),
    ("bits", lambda v: Filter.from_packed(v), [-1, 1 << 32, 1.0, "1", None]),
    ("cell", lambda v: SpatialHashGrid(v), [x for x in NUMBER if x is not None] + [0, -1]),
    ("incremental", lambda v: BruteForce(incremental=v), [0, 1, None, "yes", float("nan")]),
    ("width", lambda v: DynamicTree(width=v), [0, 1, 3, 4, 5, 2.0, "2", True, float("nan")]),
    ("margin", lambda v: DynamicTree(margin=v), [x for x in NUMBER if x is not None] + [-1]),
    ("axes", lambda v: SweepAndPrune(v), ["x", None, 3, [], NAN]),
    ("density", lambda v: mass_of(BALL, v), NUMBER + [0, -1]),
    ("shapes", lambda v: mass_of(v, 1.0), [None, 5, "x", [BALL, 5]]),
    ("shape_a", lambda v: collide(v, (0, 0, 0), BALL, (0, 0, 0)), [None, 5, "x", Material()]),
    ("shape_b", lambda v: collide(BALL, (0, 0, 0), v, (0, 0, 0)), [None, 5, "x"]),
    (
        "pose_a",
        lambda v: collide(BALL, v, BALL, (0, 0, 0)),
        [None, 5, (0,), (0, 0, 0, 0), (0, 0, NAN), (INF, 0, 0), ("0", 0, 0), ("0", 0), "abc", "ab"],
    ),
    (
        "pose_b",
        lambda v: collide(BALL, (0, 0, 0), TileGrid([[True]], 8), v),
        [(0, 0, 0.1), (0,), (0, NAN), (0, NAN, 0)],
    ),
    ("margin", lambda v: collide(BALL, (0, 0, 0), BALL, (0, 0, 0), v), NUMBER + [-1]),
    ("mask", lambda v: fit(v, "circle"), [None, BALL, np.ones((2, 2))]),
    ("tier", lambda v: fit(PixelMask(np.ones((2, 2), bool)), v), ["x", None, 5, ""]),
    ("tolerance", lambda v: fit(PixelMask(np.ones((2, 2), bool)), "obb", v), NUMBER + [0, -1]),
    ("effects", lambda v: World(v), [5, "all", {}, True]),
    ("broadphase", lambda v: World(ALL, v), ["octree", 5, BruteForce, object()]),
    ("solver", lambda v: World(ALL, solver=v), ["soft", 5, ""]),
    ("gravity", lambda v: World(ALL, gravity=v), [x for x in VECTOR if x is not None]),
    ("drag", lambda v: World(ALL, drag=v), NUMBER + [-1]),
    ("wind", lambda v: World(ALL, wind=v), VECTOR),
    ("pixels_per_meter", lambda v: World(ALL, pixels_per_meter=v), NUMBER + [0, -1]),
    ("dt", lambda v: World(ALL, dt=v), NUMBER + [0, -1, 16, 60, np.int64(16)]),
    ("seed", lambda v: World(ALL, seed=v), [-1, 1.5, "1", None, NAN, 2**63, True]),
    ("effect gravity", lambda v: Effects(gravity=v), [1, 0, None, "x", np.bool_(True)]),
]


@pytest.mark.parametrize(
    "name, call, values", CONSTRUCTORS, ids=[f"{n}-{i}" for i, (n, _, _) in enumerate(CONSTRUCTORS)]
)
def test_wrong_arguments_of_values_and_functions_are_named(name, call, values):
    for value in values:
        refused(name, value, call)


CHANGES = [
    ("position", lambda w, v: w.add_body(BALL, position=v), VECTOR),
    ("angle", lambda w, v: w.add_body(BALL, angle=v), NUMBER),
    ("kind", lambda w, v: w.add_body(BALL, kind=v), ["moving", None, 2, "Static", ""]),
    ("velocity", lambda w, v: w.add_body(BALL, velocity=v), VECTOR),
    ("velocity", lambda w, v: w.add_body(BALL, velocity=v, kind="static"), [(1, 0)]),
    ("angular_velocity", lambda w, v: w.add_body(BALL, angular_velocity=v), NUMBER),
    ("material", lambda w, v: w.add_body(BALL, material=v), [None, 5, "x", {}]),
    ("filter", lambda w, v: w.add_body(BALL, filter=v), [None, 5, "x", (1, 2)]),
    ("sensor", lambda w, v: w.add_body(BALL, sensor=v), FLAG),
    ("continuous", lambda w, v: w.add_body(BALL, continuous=v), ["on", None, True, 3, "TOI"]),
    ("bullet", lambda w, v: w.add_body(BALL, bullet=v), FLAG),
    ("fixed_rotation", lambda w, v: w.add_body(BALL, fixed_rotation=v), FLAG),
    ("gravity_scale", lambda w, v: w.add_body(BALL, gravity_scale=v), NUMBER),
    ("tier", lambda w, v: w.add_body(BALL, tier=v), ["circle", 5, "x"]),
    ("tier", lambda w, v: w.add_body(PixelMask(np.ones((2, 2), bool)), tier=v), ["x", 5, True]),
    ("shapes", lambda w, v: w.add_body(v), [None, 5, "x", [BALL], Circle]),
    ("shapes", lambda w, v: w.add_body(BALL, v), [None, 5]),
    ("TileGrid", lambda w, v: w.add_body(TileGrid([[True]], 8), kind=v), ["dynamic"]),
    ("angle", lambda w, v: w.add_body(TileGrid([[True]], 8), kind="static", angle=v), [0.5]),
    ("positions", lambda w, v: w.add_bodies(BALL, v), ARRAY),
    (
        "velocities",
        lambda w, v: w.add_bodies(BALL, [(0, 0), (1, 1)], v),
        [a for a in ARRAY if a is not None] + [[(1, 1)]],
    ),
    (
        "angles",
        lambda w, v: w.add_bodies(BALL, [(0, 0), (1, 1)], None, v),
        ["ab", [1], [NAN, 1], [[1], [2]], ["1", "2"], 5],
    ),
    ("kind", lambda w, v: w.add_bodies(BALL, [(0, 0)], kind=v), ["moving", 5]),
    ("shape", lambda w, v: w.add_bodies(v, [(0, 0)]), [None, 5]),
    ("ids", lambda w, v: w.remove_bodies(v), [[1.7], ["x"], "x", [NAN], [True], None, [None]]),
    ("body", lambda w, v: w.remove_body(v), ["x", None, 1.5, True, NAN]),
    ("dt", lambda w, v: w.step(v), [x for x in NUMBER if x is not None] + [-1e-9, 4, 16, np.int32(17)]),
    ("dt", lambda w, v: setattr(w, "dt", v), NUMBER + [0, -1, 16, 60]),
    ("drag", lambda w, v: setattr(w, "drag", v), NUMBER + [-1]),
    ("gravity", lambda w, v: setattr(w, "gravity", v), VECTOR),
    ("wind", lambda w, v: setattr(w, "wind", v), VECTOR),
    ("solver", lambda w, v: setattr(w, "solver", v), ["soft", None, 5]),
    ("broadphase", lambda w, v: setattr(w, "broadphase", v), ["octree", None, 5, BruteForce]),
    ("on must be", lambda w, v: w.set_narrowphase(v), FLAG),
    ("effects", lambda w, v: w.set_effects(v), [None, 5, "gravity", {"gravity": True}]),
    ("velocity", lambda w, v: setattr(w.body(0), "velocity", v), VECTOR),
    ("velocity", lambda w, v: setattr(w.body(1), "velocity", v), [(1, 0)]),
    ("angular_velocity", lambda w, v: setattr(w.body(0), "angular_velocity", v), NUMBER),
    ("angular_velocity", lambda w, v: setattr(w.body(1), "angular_velocity", v), [1.0]),
    ("gravity_scale", lambda w, v: setattr(w.body(0), "gravity_scale", v), NUMBER),
    ("filter", lambda w, v: setattr(w.body(0), "filter", v), [None, 5, (1, 1)]),
    ("tier", lambda w, v: setattr(w.body(0), "tier", v), ["circle", 5]),
    ("tier", lambda w, v: setattr(w.body(2), "tier", v), ["x", 5]),
    ("force", lambda w, v: w.body(0).apply_force(v), VECTOR),
    ("point", lambda w, v: w.body(0).apply_force((1e6, 0), v), [x for x in VECTOR if x is not None]),
    ("impulse", lambda w, v: w.body(0).apply_impulse(v), VECTOR),
    ("point", lambda w, v: w.body(0).apply_impulse((1e6, 0), v), [x for x in VECTOR if x is not None]),
    ("torque", lambda w, v: w.body(0).apply_torque(v), NUMBER),
    ("position", lambda w, v: w.body(0).move_to(v), VECTOR),
    ("angle", lambda w, v: w.body(0).move_to((7, 7), v), [x for x in NUMBER if x is not None]),
    ("shapes", lambda w, v: w.body(0).set_shapes(v), [None, 5, "x"]),
    ("TileGrid", lambda w, v: w.body(0).set_shapes(v), [TileGrid([[True]], 8)]),
    ("kind", lambda w, v: w.body(0).set_kind(v), ["x", None, 1]),
    ("shape", lambda w, v: Character(w, v, (0, 0)), [None, 5, "box", Polygon.box(0.3, 4), TileGrid([[True]], 8)]),
    ("position", lambda w, v: Character(w, BOX, v), VECTOR + [(1e300, 0)]),
    ("filter", lambda w, v: Character(w, BOX, (0, 0), filter=v), [None, 5]),
    ("pushable", lambda w, v: Character(w, BOX, (0, 0), pushable=v), FLAG),
    ("max_slope", lambda w, v: Character(w, BOX, (0, 0), max_slope=v), [*NUMBER, -0.1, 1.6]),
    ("origin", lambda w, v: w.ray_cast(v, (1, 0)), VECTOR),
    ("translation", lambda w, v: w.ray_cast((0, 0), v), VECTOR),
    ("filter", lambda w, v: w.ray_cast_all((0, 0), (1, 0), filter=v), [None, 5]),
    ("sensors", lambda w, v: w.ray_cast((0, 0), (1, 0), sensors=v), FLAG),
    ("shape", lambda w, v: w.overlap(v, (0, 0, 0)), [None, 5, "x"]),
    ("pose", lambda w, v: w.overlap(BALL, v), [None, 5, (0,), (0, NAN), (0, 0, NAN), (INF, 0, 0), "abc"]),
    ("filter", lambda w, v: w.overlap(BALL, (0, 0, 0), filter=v), [None, 5]),
    ("lower", lambda w, v: w.query_aabb(v, (5, 5)), VECTOR + [(6, 0)]),
    ("upper", lambda w, v: w.query_aabb((0, 0), v), VECTOR + [(-1, 0)]),
    ("point", lambda w, v: w.query_point(v), VECTOR),
    ("snapshot", lambda w, v: w.restore(v), [None, 5, {}]),
    ("mass", lambda w, v: w.add_body(BALL, mass=v), [x for x in NUMBER if x is not None] + [0, -1]),
    ("mass", lambda w, v: w.add_bodies(BALL, [(0, 0)], mass=v), ["1", 0, -1, NAN]),
    ("user", lambda w, v: w.add_bodies(BALL, [(0, 0), (9, 9)], user=v), [[], [1], [1, 2, 3], np.arange(5)]),
    ("position", lambda w, v: setattr(w.body(0), "position", v), VECTOR + [(1e300, 0)]),
    ("angle", lambda w, v: setattr(w.body(0), "angle", v), NUMBER),
    ("material", lambda w, v: setattr(w.body(0), "material", v), [None, 5, "ice", Filter()]),
    ("sensor", lambda w, v: setattr(w.body(0), "sensor", v), FLAG),
    ("bullet", lambda w, v: setattr(w.body(0), "bullet", v), FLAG),
    ("continuous", lambda w, v: setattr(w.body(0), "continuous", v), ["on", None, True, 3]),
    ("fixed_rotation", lambda w, v: setattr(w.body(0), "fixed_rotation", v), FLAG),
    ("position", lambda w, v: w.body(2).set_target(v), VECTOR + [(1e300, 0), (1e15, 0)]),
    ("angle", lambda w, v: w.body(2).set_target((1, 1), v), [x for x in NUMBER if x is not None]),
    ("kinematic", lambda w, v: w.body(v).set_target((1, 1)), [0, 1]),
    ("shape", lambda w, v: w.body(0).add_shape(v), [None, 5, "x", (BALL,), Circle]),
    ("TileGrid", lambda w, v: w.body(0).add_shape(v), [TileGrid([[True]], 8)]),
    ("shape_id", lambda w, v: w.body(0).remove_shape(v), [1, 99, -1, 1.0, "0", None, True, BALL]),
    ("point", lambda w, v: w.body(0).to_world(v), VECTOR),
    ("point", lambda w, v: w.body(0).to_local(v), VECTOR),
    ("point", lambda w, v: w.body(0).velocity_at(v), VECTOR),
    ("rect", lambda w, v: w.query_rect(v), [None, 5, "abcd", (1, 2, 3), (0, 0, -1, 5), (0, 0, 5, -1), (NAN, 0, 1, 1)]),
    ("rect", lambda w, v: w.query_rect(v), [((0, 0), 5), ((0, 0), (1, INF)), ("ab", "cd"), (0, 0, 1, None)]),
    ("identity", lambda w, v: w.body(v), [None, "0", 1.0, True, [0]]),
    ("ids", lambda w, v: w.touch(v), [None, "0", 1.5, [True], [0, 0], [None], {"a": 1}]),
    ("ids", lambda w, v: w.remove_bodies(v), [[world_of_three().body(0)], [0, World().add_body()]]),
    ("body", lambda w, v: w.remove_body(v), [world_of_three().body(0)]),
]


@pytest.mark.parametrize("name, call, values", CHANGES, ids=[f"{n}-{i}" for i, (n, _, _) in enumerate(CHANGES)])
def test_wrong_arguments_leave_the_world_as_it_was(name, call, values):
    world = world_of_three()
    before = state(world)
    for value in values:
        refused(name, value, partial(call, world))
        assert state(world) == before, f"{name}={value!r} changed the world"


def test_moves_of_a_character_are_checked():
    world = world_of_three()
    hero = Character(world, BOX, (50, 50))
    before = state(world)
    for value in NUMBER:
        refused("dx", value, lambda dx: hero.move(dx, 0))
        refused("dy", value, lambda dy: hero.move(0, dy))
        refused("dx", value, lambda dx: hero.blocked(dx, 0))
        refused("dy", value, lambda dy: hero.blocked(0, dy))
    for value in FLAG:
        refused("drop", value, lambda drop: hero.move(0, 0, drop=drop))
    for value in VECTOR:
        refused("position", value, hero.move_to)
    assert state(world) == before


UNDECLARED = [
    ("sensors", lambda w: w.add_body(BALL, sensor=True)),
    ("continuous", lambda w: w.add_body(BALL, continuous="swept")),
    ("rotation", lambda w: w.add_body(BALL, angular_velocity=1.0)),
    ("response", lambda w: Character(w, BOX, (0, 0))),
    ("continuous", lambda w: w.add_body(BALL, continuous="ray")),
    ("rotation", lambda w: w.body(0).apply_torque(1.0)),
    ("rotation", lambda w: setattr(w.body(0), "angular_velocity", 1.0)),
    ("response", lambda w: w.body(0).apply_force((1, 0))),
    ("sensors", lambda w: w.add_body(BALL.with_(sensor=True))),
    ("sensors", lambda w: w.body(0).add_shape(BALL.with_(sensor=True))),
    ("sensors", lambda w: setattr(w.body(0), "sensor", True)),
    ("continuous", lambda w: setattr(w.body(0), "bullet", True)),
    ("continuous", lambda w: setattr(w.body(0), "continuous", "toi")),
    ("rotation", lambda w: w.body(1).set_target((1, 1), 0.5)),
]


@pytest.mark.parametrize("effect, call", UNDECLARED, ids=[f"{n}-{i}" for i, (n, _) in enumerate(UNDECLARED)])
def test_what_was_not_declared_is_refused_naming_the_effect(effect, call):
    world = World(Effects())
    world.add_body(BALL)
    world.add_body(BALL, kind="kinematic")
    before = state(world)
    with pytest.raises(ValueError, match=effect):
        call(world)
    assert state(world) == before


@pytest.mark.parametrize("effect", ["friction", "restitution", "one_way"])
def test_effect_without_its_foundation_names_both(effect):
    with pytest.raises(ValueError, match=f"{effect}.*response"):
        Effects(**{effect: True})
    with pytest.raises(TypeError, match="magic"):
        Effects().with_(magic=True)


def test_removed_bodies_and_strange_handles_say_so():
    world, other = world_of_three(), world_of_three()
    body = world.body(0)
    world.remove_body(body)
    for call in (
        lambda: body.position,
        lambda: body.apply_impulse((1, 0)),
        lambda: world.remove_body(body),
        lambda: world.body(0),
        lambda: body.move_to((0, 0)),
        lambda: body.set_shapes(BALL),
        lambda: body.shapes,
        lambda: body.tier,
    ):
        with pytest.raises(KeyError, match="0"):
            call()
    before = state(world)
    with pytest.raises((ValueError, KeyError)):
        world.remove_body(other.body(1))
    assert state(world) == before
    assert world.add_body(BALL).id == 3, "ids are never given twice"


def test_changing_a_world_during_its_step_raises():
    world = world_of_three()
    hero = Character(world, BOX, (50, 50))
    body, taken = world.body(0), world.snapshot()
    calls = [
        lambda: world.add_body(BALL),
        lambda: world.add_bodies(BALL, [(0, 0)]),
        lambda: world.remove_body(1),
        lambda: world.clear(),
        lambda: world.step(),
        lambda: body.move_to((0, 0)),
        lambda: body.apply_impulse((1, 0)),
        lambda: body.apply_force((1, 0)),
        lambda: body.apply_torque(1.0),
        lambda: setattr(body, "velocity", (1, 0)),
        lambda: setattr(body, "angular_velocity", 1.0),
        lambda: setattr(body, "filter", Filter()),
        lambda: body.set_shapes(BALL),
        lambda: body.set_kind("static"),
        lambda: setattr(world, "gravity", (0, 0)),
        lambda: setattr(world, "wind", (0, 0)),
        lambda: setattr(world, "solver", "blocking"),
        lambda: hero.move(1, 0),
        lambda: setattr(world, "broadphase", BruteForce()),
        lambda: world.restore(taken),
        lambda: body.restore(),
        lambda: hero.move_to((0, 0)),
        lambda: hero.remove(),
        lambda: setattr(body, "gravity_scale", 2.0),
        lambda: world.set_narrowphase(False),
        lambda: world.set_effects(Effects.detection()),
        lambda: setattr(world.body(2), "tier", "obb"),
        lambda: setattr(world, "dt", 1.0),
        lambda: setattr(world, "drag", 1.0),
        lambda: setattr(body, "position", (1, 1)),
        lambda: setattr(body, "angle", 1.0),
        lambda: setattr(body, "material", Material()),
        lambda: setattr(body, "sensor", True),
        lambda: setattr(body, "bullet", True),
        lambda: setattr(body, "continuous", "toi"),
        lambda: setattr(body, "fixed_rotation", True),
        lambda: body.add_shape(BALL),
        lambda: body.remove_shape(body.shape_ids[0]),
        lambda: body.remove(),
        lambda: world.body(2).set_target((1, 1)),
        lambda: world.remove_bodies([body]),
        lambda: world.touch(body),
    ]
    raised = []

    class Meddler(BruteForce):
        def update(self, arena):
            before = state(world)
            for call in calls:
                with pytest.raises(RuntimeError, match="during its step"):
                    call()
                raised.append(call)
            assert state(world) == before

        def fresh(self):
            return self

    world.broadphase = Meddler()
    world.step()
    assert len(raised) >= len(calls)
    world.broadphase = BruteForce()
    world.add_body(BALL)


def test_error_inside_a_step_leaves_the_world_usable():
    world = world_of_three()

    class Broken(BruteForce):
        def update(self, arena):
            raise ZeroDivisionError("broken")

        def fresh(self):
            return self

    world.broadphase = Broken()
    with pytest.raises(ZeroDivisionError):
        world.step()
    world.broadphase = BruteForce()
    world.add_body(BALL)
    world.step()


@pytest.mark.parametrize("name", BROADPHASES)
def test_empty_worlds_and_worlds_of_statics_step(name):
    world = World(ALL, BROADPHASES[name]())
    for _ in range(2):
        world.step()
        assert set(world.profile.counters.values()) == {0} and len(world.contacts) == 0
    world.add_bodies(BOX, [(0, 0), (1, 1)], kind="static")
    world.step()
    world.step()
    assert len(world.candidates) == 0 and world.profile.counters["bodies_integrated"] == 0
    world.clear()
    world.step()
    world.add_body()
    world.step()
    assert len(world.bodies) == 1 and world.body(2).mass == 0.0
    assert len(world.add_bodies(BALL, [])) == 0 and len(world.add_bodies(BALL, np.zeros((0, 2)), kind="static")) == 0


def test_missing_snapshot_file_is_the_plain_error():
    with pytest.raises(FileNotFoundError):
        Snapshot.load("/nowhere/at all.npz")


@pytest.mark.parametrize("ids", [1.7, [1.2], np.array([0.5]), [10**300], [True], None, "0", object(), [np.inf]])
def test_rows_are_looked_up_by_whole_numbers(ids):
    """World.rows() refuses ids that are not integers, because a truncated fraction would give
    the row of another body.
    """
    world = World(ALL)
    bodies = [world.add_body(BALL, position=(30 * k, 0)) for k in range(3)]
    with pytest.raises(TypeError, match="ids must be Bodies or ids"):
        world.rows(ids)
    assert world.rows(np.array([[2], [0]], np.int32)).tolist() == [[2], [0]] and world.rows([]).shape == (0,)
    assert world.rows(bodies[1]).tolist() == [1]
