"""World.move equals setting each body's properties one after the other; wrong arguments change nothing."""

import math

import numpy as np
import pytest

from physics import BROADPHASES, Circle, Effects, PixelMask, Polygon, TileGrid, World
from physics.settings import POSITION_LIMIT
from tests.physics.test_bad_input import ARRAY, refused, state

NAN, INF = math.nan, math.inf
RIGID = Effects.rigid_bodies()
WORLDS = {
    "detection": Effects.detection(),
    "pushing": Effects(response=True, gravity=True, rotation=True, friction=True, sensors=True),
    "awake": RIGID.with_(sleeping=False),
    "sleeping": RIGID,
}
CROSS = PixelMask(np.array([[0, 1, 0], [1, 1, 1], [0, 1, 0]], bool).repeat(4, 0).repeat(4, 1))
SHAPES = (Circle(5.0), Polygon.box(12, 8), CROSS, Polygon.box(9, 9, center=(3, 1)))
KINDS = ("dynamic", "dynamic", "dynamic", "kinematic", "static")


def crowded(effects, broadphase, seed, steps):
    """Return a world of 40 random bodies of all kinds on a floor and in a heap, after some steps."""
    rng = np.random.default_rng(seed)
    world = World(effects, BROADPHASES[broadphase](), seed=seed)
    world.add_body(Polygon.box(900, 20), kind="static", position=(0, 100))
    world.add_body(TileGrid(np.ones((2, 3), bool), 16.0), kind="static", position=(200, 20))
    for _ in range(40):
        kind = KINDS[rng.integers(len(KINDS))]
        count = int(rng.integers(1, 3))
        body = world.add_body(
            *(SHAPES[k] for k in rng.integers(0, len(SHAPES), count)),
            position=tuple(rng.uniform((-80, -40), (80, 85))),
            kind=kind,
            velocity=(8.0, 0.0) if kind == "kinematic" and rng.random() < 0.3 else (0.0, 0.0),
            mass=float(rng.choice((1.0, 5000.0))) if kind == "dynamic" else None,
        )
        if rng.random() < 0.2:
            body.add_shape(Circle(2.0))
    world.remove_bodies(rng.choice(world.bodies["id"][2:], 4, replace=False))
    for _ in range(steps):
        world.step()
    return world


def wanted(world, rng, with_angles, with_velocities):
    """Return random arguments (ids, positions, angles, velocities) of World.move for some bodies, in any order."""
    ids = rng.permutation(world.bodies["id"])[: rng.integers(1, len(world))]
    bodies = world.bodies[world.rows(ids)]
    near = rng.random(len(ids)) < 0.6  # others go far away
    positions = np.stack([bodies["x"], bodies["y"]], axis=1) + rng.uniform(-3, 3, (len(ids), 2))
    positions[~near] = rng.uniform(-120, 120, (np.count_nonzero(~near), 2))
    grid = ids == 1
    angles = np.where(grid, 0.0, rng.uniform(-3, 3, len(ids))) if with_angles else None
    velocities = rng.uniform(-50, 50, (len(ids), 2)) * (bodies["kind"] != 0)[:, None] if with_velocities else None
    return ids, positions, angles, velocities


def move_one_by_one(world, ids, positions, angles, velocities):
    """Set the values that World.move would set, by the properties of each body."""
    for k, identity in enumerate(ids.tolist()):
        body = world.body(identity)
        body.position = positions[k]
        if angles is not None:
            body.angle = float(angles[k])
        if velocities is not None:
            body.velocity = velocities[k]


def kept(world):
    """Return all state of a world that later steps read, and its events."""
    return (
        world.digest(),
        world.bodies.tobytes(),
        world.contact_rows[["shape_a", "shape_b", "normal_force_1", "tangent_force_1", "normal_force_2"]].tolist(),
        world.events.begin.tolist(),
        world.events.end.tolist(),
        sorted(world.sleeping_set.islands),
    )


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("broadphase", ["hash", "tree", "sweep", "brute"])
@pytest.mark.parametrize("effects", WORLDS)
def test_the_same_as_the_setters(effects, broadphase, seed):
    """World.move gives the same bits as the setters for ten steps: awake or asleep, near or far, with any arguments."""
    rng = np.random.default_rng(seed)
    steps = (3, 300)[seed % 2] if effects == "sleeping" else 12
    one, many = (crowded(WORLDS[effects], broadphase, seed, steps) for _ in range(2))
    assert kept(one) == kept(many)
    asleep = int((~one.bodies["awake"]).sum())
    assert (asleep > 5) == (steps == 300)
    for turn in range(4):
        arguments = wanted(one, rng, turn % 2 == 1, turn >= 2)
        move_one_by_one(one, *arguments)
        many.move(*arguments)
        assert kept(one) == kept(many), turn
        for _ in range(10 if turn == 3 else 2):
            one.step()
            many.step()
            assert kept(one) == kept(many), turn


@pytest.mark.parametrize("seed", range(6))
def test_heavy_loads_are_released_in_turn(seed):
    """Moving heavy loads off light boxes, some asleep, clears the same cached forces as moving them one by one."""
    rng, worlds = np.random.default_rng(seed), [World(RIGID), World(RIGID)]
    for world in worlds:
        world.add_body(Polygon.box(900, 20), kind="static", position=(0, 10))
        for stack in range(6):
            for k in range(4):
                mass = 1.0 if k < 2 else 800.0
                world.add_body(Polygon.box(12, 8), position=(30.0 * stack, -4.0 - 8.0 * k), mass=mass)
        for _ in range(200 if seed % 2 else 8):
            world.step()
    ids = rng.permutation(worlds[0].bodies["id"][1:])[: rng.integers(2, 16)]
    positions = worlds[0].bodies[worlds[0].rows(ids)][["x", "y"]].tolist()
    positions = np.array(positions) - rng.choice((0.0, 2.0, 300.0), (len(ids), 1))
    before = kept(worlds[0])[2]
    move_one_by_one(worlds[0], ids, positions, None, None)
    worlds[1].move(ids, positions)
    assert kept(worlds[0]) == kept(worlds[1]) and kept(worlds[0])[2] != before
    assert seed % 2 or any(row[2] == 0.0 for row in kept(worlds[0])[2])
    for _ in range(10):
        for world in worlds:
            world.step()
        assert kept(worlds[0]) == kept(worlds[1])


def test_bodies_ids_and_lists_name_the_same():
    world = crowded(RIGID, "hash", 0, 2)
    ids = world.bodies["id"][5:9]
    places = [(10 * k, -200) for k in range(4)]
    for names in (
        ids,
        ids.tolist(),
        [world.body(int(k)) for k in ids],
        tuple(ids),
        iter(ids),
        [world.body(int(ids[0])), *ids[1:]],
    ):
        world.move([*names], [(0, 0)] * 4)
        world.move(ids if names is ids else [*ids], places)
        assert [world.body(int(k)).position for k in ids] == places
    world.move(world.body(int(ids[0])), [(1, 2)])
    world.move(int(ids[1]), [(3, 4)], [0.5], [(0, 0)])
    assert world.body(int(ids[0])).position == (1, 2) and world.body(int(ids[1])).angle == 0.5
    world.move([], [])
    world.move(np.zeros(0, np.int64), np.zeros((0, 2)), [], [])


def test_a_target_is_cancelled():
    world = World(RIGID)
    one = world.add_body(Circle(4), kind="kinematic")
    one.set_target((10, 0))
    world.move([one], [(0, 50)], velocities=[(0, 0)])
    world.step()
    assert one.position == (0, 50) and not world._targets


def test_what_lay_on_it_wakes_and_falls():
    world = World(RIGID)
    world.add_body(Polygon.box(400, 20), kind="static", position=(0, 30))
    shelf = world.add_body(Polygon.box(80, 8), kind="static")
    box = world.add_body(Polygon.box(8, 8), position=(0, -8))
    while box.awake:
        world.step()
    world.move([shelf], [(300, 0)])
    assert box.awake
    for _ in range(60):
        world.step()
    assert box.position.y > 10


WRONG = [
    ("ids", lambda w, v: w.move(v, [(0, 0)]), [[1.7], ["x"], "x", [NAN], [True], None, [None], [0, 0], [[0], [0, 1]]]),
    ("positions", lambda w, v: w.move([0], v), [*ARRAY, [(0, 0), (1, 1)], [], (1, 2), [(POSITION_LIMIT, 0)]]),
    ("angles", lambda w, v: w.move([0], [(9, 9)], v), ["a", [NAN], [INF], [1, 2], [[1]], 1.0, [True], [None]]),
    ("velocities", lambda w, v: w.move([0], [(9, 9)], None, v), [*ARRAY, [(0, 0), (1, 1)], [(0, NAN)], [(-INF, 0)]]),
    ("velocities[1]", lambda w, v: w.move([0, 1], [(9, 9)] * 2, None, v), [[(0, 0), (1, 0)], [(5, 5), (0, -1)]]),
    ("angles[1]", lambda w, v: w.move([0, 3], [(9, 9)] * 2, v), [[0.0, 0.1], [1.0, -1.0]]),
]


@pytest.mark.parametrize("effects", ["detection", "sleeping"])
def test_wrong_arguments_change_nothing(effects):
    world = World(WORLDS[effects])
    world.add_body(Circle(3.0), velocity=(5.0, 3.0))
    world.add_body(Polygon.box(4, 4), kind="static", position=(2, 1))
    world.add_body(Circle(2.0), kind="kinematic", position=(40, 0)).set_target((41, 0))
    world.add_body(TileGrid(np.ones((1, 1), bool), 16.0), kind="static", position=(200, 20))
    gone = world.add_body(Circle(1))
    gone.remove()
    world.step()
    before = state(world)
    for name, call, values in WRONG:
        for value in values:
            if value is None and name in ("angles", "velocities"):
                continue
            refused(name, value, lambda v, call=call: call(world, v))
            assert state(world) == before
    for ids in ([gone], [0, gone.id], [0, 99], [-1], 99, np.array([0, 2**40])):
        with pytest.raises(KeyError, match="is not in this world|Body"):
            world.move(ids, [(0, 0)] * (1 if isinstance(ids, int) else len(ids)))
    with pytest.raises(ValueError, match="of this world"):
        world.move([World().add_body()], [(0, 0)])
    with pytest.raises(ValueError, match=r"ids must name each body once"):
        world.move(np.array([0, 2, 0]), [(0, 0)] * 3)
    assert state(world) == before


def test_not_during_a_step():
    world = crowded(RIGID, "hash", 1, 1)
    world._stepping = True
    with pytest.raises(RuntimeError, match="during its step"):
        world.move([3], [(0, 0)])
