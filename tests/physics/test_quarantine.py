"""A body with a value that is not finite is disabled, without effect on the others (invariant U1)."""

import math

import numpy as np
import pytest

from physics import (
    JIT,
    BruteForce,
    Character,
    Circle,
    DynamicTree,
    Effects,
    PixelMask,
    Polygon,
    SpatialHashGrid,
    SweepAndPrune,
    World,
)
from physics.dynamics.integrate import REASONS
from physics.settings import POSITION_LIMIT
from physics.tables.contact import QUARANTINE

ALL = Effects(
    response=True, gravity=True, rotation=True, friction=True, restitution=True, continuous=True, sensors=True
)
MASK = PixelMask(np.ones((7, 9), bool))  # one object, so that its turned masks are made once
STRATEGIES = [BruteForce, SweepAndPrune, lambda: SweepAndPrune(axes="both"), SpatialHashGrid, DynamicTree]


def pile(strategy, seed=0):
    rng = np.random.default_rng(seed)
    world = World(ALL, strategy())
    world.add_body(Polygon.box(400, 20), position=(100, 120), kind="static")
    for k in range(30 if JIT else 14):
        shape = (Circle(6.0), Polygon.box(10, 8), MASK)[k % 3]
        world.add_body(shape, position=tuple(rng.uniform(0, 110, 2)), velocity=tuple(rng.normal(0, 100, 2)))
    return world


@pytest.mark.parametrize("strategy", STRATEGIES)
@pytest.mark.parametrize(
    "column, value",
    [
        ("x", math.nan),
        ("y", math.inf),
        ("vx", math.nan),
        ("vy", -math.inf),
        ("angle", math.nan),
        ("angular_velocity", math.inf),
        ("vx", 1e300),
    ],
)
def test_neighbours_go_on_as_if_it_had_been_removed(strategy, column, value):
    sick, removed = pile(strategy), pile(strategy)
    for _ in range(20):
        sick.step(), removed.step()
    sick.bodies[column][7] = value
    removed.remove_body(7)
    for step in range(30):
        sick.step(), removed.step()
        if step == 0:
            assert sick.events.quarantined["body"].tolist() == [7] and sick.events.quarantined["reason"][0]
        else:
            assert len(sick.events.quarantined) == 0
        others = sick.bodies["id"] != 7
        for name in ("x", "y", "angle", "vx", "vy", "angular_velocity"):
            assert (sick.bodies[name][others] == removed.bodies[name]).all(), (name, step)
        assert np.isfinite(sick.bodies["x"]).all() and len(sick.contacts) == len(removed.contacts)
        for kind in ("begin", "end", "hits"):
            one, two = getattr(sick.events, kind), getattr(removed.events, kind)
            assert one["body_a"].tolist() == two["body_a"].tolist() and one["body_b"].tolist() == two["body_b"].tolist()


@pytest.mark.parametrize("column", ["x", "vx", "angle", "angular_velocity"])
def test_it_goes_back_to_its_last_finite_pose_at_rest(column):
    world = World(ALL, gravity=(0, 0))
    body = world.add_body(Polygon.box(4, 4), velocity=(60.0, 30.0), angular_velocity=1.0)
    for _ in range(3):
        world.step()
    position, angle = body.position, body.angle
    world.bodies[column] = math.nan
    world.step()
    assert body.position == position and body.angle == angle, "the last pose that was finite, not the one before it"
    assert body.velocity == (0.0, 0.0) and body.angular_velocity == 0.0 and not body.awake
    for _ in range(3):
        world.step()
    assert body.position == position and len(world.candidates) == 0


def test_restore_takes_it_back_in():
    world = World(ALL, gravity=(0, 0))
    body = world.add_body(Circle(5.0), velocity=(60.0, 0.0))
    world.add_body(Circle(5.0), position=(8.0, 0.0), kind="static")
    world.step()
    world.bodies["y"][0] = math.nan
    world.step()
    assert len(world.contacts) == 0 and len(world.events.end) == 1
    body.restore()
    world.step()
    assert body.awake and len(world.contacts) == 1 and len(world.events.begin) == 1
    body.restore()
    world.step()
    assert len(world.candidates) == 1, "restoring twice is restoring once"


def test_quarantined_body_is_in_no_answer_and_can_be_changed_and_removed():
    world = World(ALL, gravity=(0, 0))
    body = world.add_body(Circle(5.0))
    other = world.add_body(Circle(5.0), position=(4.0, 0.0), kind="static")
    world.bodies["x"][0] = math.nan
    world.step()
    assert (
        [b.id for b in world.overlap(Circle(2), (0, 0, 0))]
        == [other.id]
        == [b.id for b in world.query_aabb((-1, -1), (1, 1))]
    )
    assert [h.body.id for h in world.ray_cast_all((-20, 0), (60, 0))] == [other.id]
    body.set_shapes(Circle(60.0)), body.set_kind("static"), body.set_kind("dynamic"), body.move_to((1, 1))
    world.step()
    assert len(world.candidates) == 0 == len(world.contacts)
    body.restore()
    world.step()
    assert len(world.candidates) == 1
    world.remove_body(body)
    for _ in range(3):
        world.step()
    assert len(world.candidates) == 0 and int((world.pairs.proxies["row"] >= 0).sum()) == 1


def test_force_of_infinite_strength_is_caught_in_its_step():
    world = World(ALL, gravity=(0, 0))
    world.add_body(Circle(0.01))
    near = world.add_body(Circle(5.0), position=(9.0, 0.0))
    world.body(0).apply_force((1.7e308, 0.0))
    world.step()
    assert np.isfinite(world.bodies["x"]).all() and world.events.quarantined["body"].tolist() == [0]
    assert near.position == (9.0, 0.0)


@pytest.mark.filterwarnings("ignore:World.step")
def test_angle_that_overflows_within_a_step_is_caught():
    world = World(ALL, gravity=(0, 0))
    world.add_body(Polygon.box(4, 4), angular_velocity=1e308)
    world.add_body(Circle(5.0), position=(5.0, 0.0))
    for _ in range(4):
        world.step(10.0)
        assert np.isfinite(world.bodies["angle"]).all()


@pytest.mark.parametrize("shape", [Circle(5.0), Polygon.box(8, 8), PixelMask(np.ones((8, 8), bool))])
@pytest.mark.parametrize("x", [1e9, 1e12, 1e15])
def test_far_bodies_touch_only_what_is_there(shape, x):
    world = World(Effects())
    for at in (x, 3 * x, x + 2, 0.0):
        world.add_body(shape, position=(at, 0.0))
    for _ in range(2):
        world.step()
        assert list(zip(world.contacts["shape_a"], world.contacts["shape_b"], strict=True))[:1] == [(0, 2)]
        assert set(world.contacts["shape_a"]) == {0}


@pytest.mark.parametrize("x", [1e19, 1e100, -1e300])
def test_positions_without_pixels_are_refused_or_quarantined(x):
    world = World(Effects())
    with pytest.raises(ValueError, match="position"):
        world.add_body(Circle(5.0), position=(x, 0.0))
    ids = world.add_bodies(PixelMask(np.ones((8, 8), bool)), [(0.0, 0.0), (50.0, 0.0), (100.0, 0.0)])
    world.step()
    world.bodies["x"][:2] = x, 3 * x
    world.step()
    assert world.events.quarantined["body"].tolist() == ids[:2].tolist() and len(world.contacts) == 0
    assert world.bodies["x"].tolist() == [0.0, 50.0, 100.0]


def weightless(effects):
    return World(effects, gravity=(0, 0)) if effects.gravity else World(effects)


@pytest.mark.parametrize("effects", [ALL, Effects.rigid_bodies(), Effects.detection()], ids=["all", "rigid", "none"])
@pytest.mark.parametrize("how", ["written", "touched", "asleep"])
@pytest.mark.parametrize(
    "column, value",
    [(column, value) for column in ("x", "y", "angle") for value in (math.nan, math.inf, -1e300, 1e20, 2.0**52)],
)
def test_a_pose_out_of_range_goes_back_to_the_last_one_within_it(effects, how, column, value):
    """Also with touch(), and of a sleeping body: then restore() succeeds, and the body is not quarantined again."""
    world = weightless(effects)
    body = world.add_body(Circle(5.0), position=(10, 20), angle=0.25, kind="static" if how == "asleep" else "dynamic")
    other = world.add_body(Polygon.box(8, 8), position=(100, 20))
    for _ in range(3):
        world.step()
    world.bodies[column][world.rows(body)] = value
    if how != "written":
        world.touch(body)
    world.step()
    assert world.events.quarantined["body"].tolist() == [body.id]
    assert (body.position, body.angle) == ((10, 20), 0.25) and body.velocity == (0, 0)
    assert body.bounds == (5, 15, 15, 25)
    for _ in range(2):
        world.step()
    assert len(world.events.quarantined) == 0 and other.position == (100, 20)
    body.restore()
    for _ in range(3):
        world.step()
        assert len(world.events.quarantined) == 0
    assert (body.position, body.angle) == ((10, 20), 0.25) and world.query_point((10, 20)) == [body]


@pytest.mark.parametrize("column", ["vx", "angular_velocity", "force_x"])
def test_a_step_that_leaves_the_range_ends_at_the_pose_before_it(column):
    """Numbers that are just within their limits may carry a body out of range: it stays where it was."""
    world = World(ALL, gravity=(0, 0))
    body = world.add_body(Polygon.box(4, 4), position=(3, 4), angle=0.5)
    world.step()
    world.bodies[column][0] = 1e18
    for _ in range(3):
        world.step()
        assert abs(body.position.x) < POSITION_LIMIT and abs(body.angle) < POSITION_LIMIT
    assert (body.position, body.angle) == ((3, 4), 0.5)


FAR = 2.0**52
FAR_CALLS = {
    "add_body position": (lambda w, b: w.add_body(Circle(5), position=(FAR, 0)), "position", "px"),
    "add_body angle": (lambda w, b: w.add_body(Circle(5), angle=-FAR), "angle", "rad"),
    "add_body box": (lambda w, b: w.add_body(Polygon.box(5, 5), angle=1e30), "angle", "rad"),
    "add_bodies positions": (lambda w, b: w.add_bodies(Circle(5), [(0, 0), (0, 1e20)]), r"positions\[1\]", "px"),
    "add_bodies angles": (lambda w, b: w.add_bodies(Circle(5), [(0, 0)] * 2, angles=[0, 1e16]), r"angles\[1\]", "rad"),
    "position": (lambda w, b: setattr(b, "position", (0, -FAR)), "position", "px"),
    "angle": (lambda w, b: setattr(b, "angle", 1e30), "angle", "rad"),
    "move_to": (lambda w, b: b.move_to((0, 0), FAR), "angle", "rad"),
    "move positions": (lambda w, b: w.move([b], [(1e16, 0)]), r"positions\[0\]", "px"),
    "move angles": (lambda w, b: w.move([b], [(0, 0)], [FAR]), r"angles\[0\]", "rad"),
    "set_target": (lambda w, b: w.body(1).set_target((0, 0), FAR), "angle", "rad"),
}


@pytest.mark.parametrize("call, name, unit", FAR_CALLS.values(), ids=FAR_CALLS)
def test_calls_refuse_a_pose_out_of_range_and_name_the_limit(call, name, unit):
    world = World(ALL)
    body = world.add_body(Circle(5.0), position=(1, 2), angle=0.5)
    world.add_body(Circle(5.0), position=(50, 2), kind="kinematic")
    before = world.digest()
    with pytest.raises(ValueError, match=rf"^{name} must lie within 4.5036e\+15 {unit} of "):
        call(world, body)
    assert world.digest() == before and len(world) == 2


@pytest.mark.parametrize("value", [0.0, -3, math.nextafter(FAR, 0.0), np.float32(2.0**40)])
def test_poses_within_the_range_are_taken(value):
    world = World(Effects())
    body = world.add_body(Circle(5.0), position=(value, 0), angle=value)
    body.position, body.angle = (0, value), value
    world.move([body], [(value, value)], [value])
    world.step()
    assert (body.position, body.angle) == ((value, value), value) and len(world.events.quarantined) == 0


def test_reasons_fit_their_column():
    assert max(map(len, REASONS)) <= QUARANTINE["reason"].itemsize // 4


def test_many_broken_at_once():
    world = pile(SpatialHashGrid)
    world.step()
    world.bodies["x"][3:12] = math.nan
    world.step()
    assert world.events.quarantined["body"].tolist() == list(range(3, 12))
    taken, digest = world.snapshot(), world.digest()
    world.step()
    world.restore(taken)
    assert world.digest() == digest
    world.step()
    assert len(world.events.quarantined) == 0


def test_broken_character_and_platform_do_not_stop_the_others():
    world = World(ALL)
    platform = world.add_body(Polygon.box(40, 8), position=(0, 20), kind="kinematic", velocity=(60, 0))
    hero = Character(world, Polygon.box(8, 16), (0, 8))
    hero.move(0, 2)
    world.step()
    world.bodies["vx"][0] = math.nan
    world.step()
    hero.move(1, 1)
    assert world.events.quarantined["body"].tolist() == [platform.id] and np.isfinite(world.bodies["x"]).all()
