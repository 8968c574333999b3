"""Broad phases reuse the results of the last step.

Their counters show that resting bodies cause no work and that few changes cause little.
"""

import math

import numpy as np
import pytest

from physics import (
    JIT,
    BruteForce,
    Circle,
    DynamicTree,
    Effects,
    Filter,
    Polygon,
    SpatialHashGrid,
    SweepAndPrune,
    World,
)

STRATEGIES = {
    "brute": BruteForce,
    "sweep": SweepAndPrune,
    "both": lambda: SweepAndPrune(axes="both"),
    "hash": SpatialHashGrid,
    "tree": DynamicTree,
}
every_strategy = pytest.mark.parametrize("make", STRATEGIES.values(), ids=STRATEGIES.keys())


def field(make, n, spacing=20.0, radius=8.0, **options):
    """Return (world, ids) of n circles on a square grid that do not touch, after two steps.

    make: function that creates the broad phase.
    """
    world = World(Effects(), make())
    side = math.ceil(math.sqrt(n))
    at = np.array([(spacing * (i % side), spacing * (i // side)) for i in range(n)], float)
    ids = world.add_bodies(Circle(radius), at, **options)
    world.step()
    world.step()
    return world, ids


def counters(world):
    return world.profile.counters


@every_strategy
@pytest.mark.parametrize("spacing", [20.0, 10.0])
def test_nothing_moved_tests_nothing(make, spacing):
    world, _ = field(make, 100, spacing)
    world.step()
    used = counters(world)
    assert (used["pairs_tested"], used["nodes_visited"], used["swaps"], used["reinserts"], used["cells_touched"]) == (
        0,
    ) * 5
    assert used["candidates"] == len(world.candidates) == (0 if spacing == 20.0 else 342)


@every_strategy
def test_moving_one_of_many_tests_few(make):
    n = 1600 if JIT else 225
    world, ids = field(make, n)
    world.body(int(ids[n // 2])).move_to((45.0, 47.0))
    world.step()
    limit = n if make is BruteForce else 6 * math.sqrt(n) + 60
    assert 0 < counters(world)["pairs_tested"] + counters(world)["nodes_visited"] <= limit


@pytest.mark.parametrize(
    "name, counter",
    [
        ("hash", "cells_touched"),
        ("hash", "reinserts"),
        ("tree", "reinserts"),
        ("tree", "nodes_visited"),
        ("sweep", "swaps"),
    ],
)
def test_work_grows_with_the_moved_and_not_with_all(name, counter):
    work = {}
    for n in (400, 1600) if JIT else (64, 256):
        for k in (8, 32):
            world, ids = field(STRATEGIES[name], n)
            rows = world.rows(ids[:: n // k][:k])
            world.bodies["x"][rows] += 23.0
            world.step()
            work[n, k] = counters(world)[counter]
    few, many = sorted({n for n, _ in work})
    # A move by one column passes a column's worth of neighbours in the sweep: sqrt(n), twice as many at four times n.
    growth = {"nodes_visited": 1.8, "swaps": 2.6}.get(counter, 1.3)
    for k in (8, 32):
        assert 0 < work[many, k] <= growth * max(work[few, k], 1), work
    for n in (few, many):
        assert work[n, 32] <= 6.0 * work[n, 8], work


@every_strategy
def test_fast_body_finds_all_in_its_path_and_touches_no_more_than_its_path_is_long(make):
    n = 1600 if JIT else 400
    world, _ = field(make, n, spacing=16.0, radius=4.0, kind="static")
    fast = world.add_body(Circle(4.0), position=(-8.0, 72.0))
    world.step()  # tables have grown: what is counted is the flight alone
    fast.velocity = (50 * 16.0 * 60, 0.0)
    world.step()
    side = math.ceil(math.sqrt(n))
    in_path = {16.0 * column for column in range(side) if column * 16.0 - 4 <= -8 + 800 + 4 + 0.16}
    partners = {pair[0] for pair in world.candidates.tolist() if pair[1] == world.shapes["id"][-1]}
    rows = [r for r in range(side) if abs(16.0 * r - 72.0) <= 8.16]
    assert len(rows) == 2 and len(partners) == 2 * len(in_path)
    if make is not BruteForce and make is not SweepAndPrune:
        assert counters(world)["nodes_visited"] + counters(world)["cells_touched"] <= 30 * 50 + 60
    assert fast.position[0] == pytest.approx(-8.0 + 800.0)


@pytest.mark.parametrize("direction", [(1.0, 0.0), (0.0, 1.0), (0.6, 0.8), (-0.8, 0.6)])
def test_cells_of_a_fast_body_grow_with_its_path(direction):
    seen = []
    for cells in (50, 100, 200):
        world, _ = field(SpatialHashGrid, 400, spacing=16.0, radius=4.0, kind="static")
        reach = cells * 16.0 * 60
        fast = world.add_body(Circle(4.0), position=(150.0, 150.0))
        world.step()
        fast.velocity = (reach * direction[0], reach * direction[1])
        world.step()
        seen.append(
            counters(world)["cells_touched"] + counters(world)["nodes_visited"] + counters(world)["pairs_tested"]
        )
    assert seen[2] <= 4.0 * seen[0] + 400 and seen[0] <= 16 * 50 + 400, seen


@every_strategy
def test_giant_among_small_floods_nothing(make):
    n = 900 if JIT else 225
    world, _ = field(make, n)
    giant = world.add_body(Polygon.box(1e6, 4.0), position=(0.0, -20.0), kind="kinematic")
    world.step()
    assert len(world.candidates) == 0
    giant.move_to((50.0, -20.0))
    world.step()
    assert counters(world)["cells_touched"] <= 16
    if make is not BruteForce:
        assert counters(world)["pairs_tested"] + counters(world)["nodes_visited"] <= 2 * n + 200


def test_tree_stays_low_through_ten_thousand_changes():
    changes = 10_000 if JIT else 1_500
    rng = np.random.default_rng(4)
    world = World(Effects(), DynamicTree())
    ids = []
    for number in range(changes):
        choice = rng.random()
        if choice < 0.5 or len(ids) < 3:
            x = number * 3.0 if number % 3 else rng.uniform(0, 1e4)  # also sorted insertions, the worst for a tree
            ids.append(
                world.add_body(
                    Circle(rng.uniform(0.5, 20.0)),
                    position=(x, rng.uniform(0, 100)),
                    kind="static" if rng.random() < 0.3 else "kinematic",
                ).id
            )
        elif choice < 0.7:
            world.remove_body(ids.pop(int(rng.integers(len(ids)))))
        else:
            world.body(ids[int(rng.integers(len(ids)))]).move_to(tuple(rng.uniform(0, 1e4, 2)))
        if number % 7 == 0:
            world.step()
            assert world.broadphase.height <= 1.45 * math.log2(max(len(ids), 2)) + 2
    world.step()
    assert world.broadphase.height <= 1.45 * math.log2(len(ids)) + 2


def test_tree_stays_low_through_sorted_insertions_and_removals():
    n = 1500 if JIT else 300
    world = World(Effects(), DynamicTree())
    ids = []
    for k in range(n):
        ids.append(world.add_body(Circle(2.0), position=(5.0 * k, 0.0)).id)
        if k % 5 == 0:
            world.step()
    world.step()
    assert world.broadphase.height <= 1.45 * math.log2(n) + 2
    for k in range(n - 10):
        world.remove_body(ids[k])
        if k % 50 == 0:
            world.step()
            assert world.broadphase.height <= 1.45 * math.log2(n - k - 1) + 2
    world.step()
    assert world.broadphase.height <= 1.45 * math.log2(10) + 2


@every_strategy
def test_spawning_and_despawning_for_ever_keeps_the_structure_small(make):
    world = World(Effects(), make())
    rng = np.random.default_rng(1)
    live, sizes = [], []
    for _ in range(400 if JIT else 150):
        live += world.add_bodies(Circle(3.0), rng.uniform(0, 300, (10, 2)), rng.uniform(-50, 50, (10, 2))).tolist()
        if len(live) > 60:
            world.remove_bodies(live[:10])
            live = live[10:]
        world.step()
        arrays = [
            a
            for holder in (world.pairs, world.pairs.arena, world.broadphase)
            for a in vars(holder).values()
            if isinstance(a, np.ndarray)
        ]
        sizes.append(sum(a.nbytes for a in arrays) + 8 * len(world.pairs.free) + 8 * len(world.pairs.freed))
    assert sizes[-1] <= 1.5 * sizes[100]


@every_strategy
def test_slider_on_forty_tiles_makes_events_and_no_errors(make):
    world = World(Effects(response=True, gravity=True), make(), gravity=(0, 10), pixels_per_meter=1.0)
    for k in range(40):
        world.add_body(Polygon.box(1.0, 1.0), position=(float(k), 1.0), kind="static")
    world.add_body(Polygon.box(0.9, 0.9), position=(0.0, 0.04), velocity=(8.0, 0.0))
    changes = 0
    for _ in range(300):
        world.step()
        changes += len(world.events.begin) + len(world.events.end)
    assert changes > 2


@every_strategy
def test_filter_works_both_ways_and_is_counted(make):
    world = World(Effects(), make())
    one_way = Filter(0b01, 0b10), Filter(0b10, 0b00)
    world.add_body(Circle(5.0), filter=one_way[0])
    world.add_body(Circle(5.0), filter=one_way[1])
    world.step()
    assert len(world.candidates) == 0 and counters(world)["filtered"] == 1 and counters(world)["narrow_tests"] == 0
    world.body(1).filter = Filter(0b10, 0b01)
    world.step()
    assert world.candidates.tolist() == [[0, 1]] and counters(world)["filtered"] == 0
    world.body(0).filter = Filter(0, 0xFFFFFFFF)
    world.step()
    assert len(world.candidates) == 0 and world.events.end["shape_a"].tolist() == [0]


@every_strategy
def test_two_statics_and_one_bodys_own_shapes_never_pair(make):
    world = World(Effects(), make())
    world.add_body(Circle(5.0), kind="static")
    world.add_body(Circle(5.0), kind="static")
    world.add_body(Circle(5.0), Polygon.box(4, 4), position=(500.0, 0.0))
    world.step()
    assert len(world.candidates) == 0
