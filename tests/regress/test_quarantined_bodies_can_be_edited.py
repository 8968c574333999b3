"""Changes of a disabled body affect no other body: it has no slot in the broad phase."""

import math

import numpy as np
import pytest

from physics import Character, Circle, DynamicTree, Effects, Filter, Polygon, SpatialHashGrid, SweepAndPrune, World

PLAIN = Effects(response=True, gravity=True, rotation=True, friction=True)
STACKING = PLAIN.with_(stacking=True)
EDITS = {
    "filter": lambda body: setattr(body, "filter", Filter(2, 4)),
    "static": lambda body: body.set_kind("static"),
    "kinematic": lambda body: body.set_kind("kinematic"),
    "shapes": lambda body: body.set_shapes(Circle(9.0), Polygon.box(4, 4)),
    "move": lambda body: body.move_to((3.0, 4.0), 0.5),
    "touch": lambda body: body.world.touch([body]),
    "wake": lambda body: body.wake(),
    "velocity": lambda body: setattr(body, "velocity", (5.0, 6.0)),
    "force": lambda body: body.apply_force((1e4, 0.0)),
    "impulse": lambda body: body.apply_impulse((1e4, 0.0)),
}


def crowd(effects, strategy=SpatialHashGrid):
    """Return a world whose shapes fill all slots of the broad phase, including the last."""
    world = World(effects, strategy())
    world.add_body(Polygon.box(600, 20), position=(150, 40), kind="static")
    while len(world.pairs.free) or len(world.bodies) < 2:
        k = len(world.bodies)
        world.add_body(Circle(5.0), position=(9.0 * (k % 32), 20.0 - 9.0 * (k // 32)))
    return world


def state(world, without):
    rows = world.bodies[world.bodies["id"] != without]
    return [rows[name].tobytes() for name in ("x", "y", "angle", "vx", "vy", "angular_velocity", "awake")]


@pytest.mark.parametrize("edit", EDITS)
@pytest.mark.parametrize("effects", [PLAIN, STACKING, Effects.rigid_bodies()], ids=["plain", "stacking", "sleeping"])
def test_nobody_else_notices(effects, edit):
    sick, removed = crowd(effects), crowd(effects)
    sick.bodies["vx"][5] = math.nan
    removed.remove_body(5)
    sick.step(), removed.step()
    at = len(sick.pairs.proxies) - 1
    last = sick.pairs.proxies[at].copy()
    EDITS[edit](sick.body(5))
    for name in ("membership", "mask", "still"):
        assert sick.pairs.proxies[at][name] == last[name]
    for _ in range(6):
        sick.step(), removed.step()
        assert state(sick, 5) == state(removed, 5)
        assert sick.candidates.tolist() == removed.candidates.tolist() or edit == "shapes"


@pytest.mark.parametrize("strategy", [SpatialHashGrid, DynamicTree, SweepAndPrune])
def test_filter_and_kind_set_meanwhile_count_once_it_is_back(strategy):
    world = crowd(PLAIN, strategy)
    world.bodies["vx"][5] = math.nan
    world.step()
    body = world.body(5)
    body.filter = Filter(2, 0)
    body.set_kind("kinematic")
    body.restore()
    world.step()
    assert not (world.candidates == 5).any()
    body.filter = Filter.ALL
    world.step()
    assert (world.candidates == 5).any()


@pytest.mark.parametrize("pushable", [False, True])
@pytest.mark.parametrize("under", ["kinematic", "turning", "belt", "dynamic", "character"])
@pytest.mark.parametrize("effects", [PLAIN, STACKING, Effects.rigid_bodies()], ids=["plain", "stacking", "sleeping"])
def test_character_out_of_the_simulation_is_carried_by_nothing(effects, under, pushable):
    world = World(effects.with_(conveyor=True))
    kind = {"dynamic": "dynamic", "belt": "static"}.get(under, "kinematic")
    floor = world.add_body(Polygon.box(100, 10), position=(0, 10), kind=kind)
    if kind == "kinematic":
        floor.velocity = (90.0, -60.0)
    if under == "turning":
        floor.angular_velocity = 0.3
    if under == "dynamic":
        floor.gravity_scale, floor.velocity = 0.0, (90.0, 0.0)
    if under == "belt":
        world.shapes["surface_speed"] = 120.0
    if under == "character":
        below = Character(world, Polygon.box(10, 20), (0, -5), pushable=True)
        below.move(0, 1)
    hero = Character(world, Polygon.box(10, 20), (0, -25 if under == "character" else -5), pushable=pushable)
    for _ in range(3):
        hero.move(0, 1)
        world.step()
    world.bodies["vx"][world.rows(hero.body.id)] = math.nan
    world.step()
    assert world.events.quarantined["body"].tolist() == [hero.body.id]
    where = hero.body.position
    for _ in range(8):
        assert not any(hero.move(2, 3)[:2])
        world.step()
        assert hero.body.position == where and hero.body.velocity == (0.0, 0.0)
    hero.body.restore()
    hero.move_to((0.0, -200.0))
    world.step()
    assert hero.move(0, 3).y == 3 and np.isfinite(world.bodies["x"]).all()
