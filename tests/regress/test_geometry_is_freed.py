"""Geometry without shapes is freed: memory follows the current shapes, not past ones."""

import gc
import tracemalloc

import numpy as np
import pytest

from physics import Bounds, Capsule, Chain, Circle, PixelMask, Polygon, Segment, TileGrid, World

SIDE = 200


def ragged(seed, side=SIDE):
    """Return a mask of bars of random lengths, 4 px high; single pixels would give thousands of parts."""
    lengths = np.random.default_rng(seed).integers(4, side, -(-side // 4)).repeat(4)[:side]
    return PixelMask(np.arange(side) < lengths[:, None])


MAKERS = {
    "mask": ragged,
    "bounds of a mask": lambda k: Bounds(ragged(k)),
    "grid": lambda k: TileGrid(np.random.default_rng(k).random((60, 60)) < 0.5, 8),
    "chain": lambda k: Chain([(x, (x * k) % 7) for x in range(400)]),
    "polygon": lambda k: Polygon.box(10 + k / 1000, 10),
    "capsule": lambda k: Capsule((0, 0), (10 + k / 1000, 0), 2),
    "segment": lambda k: Segment((0, 0), (10 + k / 1000, 0)),
}


def size(world):
    return world.library.size, len(world.library.shapes)


@pytest.mark.parametrize("maker", MAKERS)
@pytest.mark.parametrize("way", ["set_shapes", "remove and add", "add_shape and remove_shape"])
def test_a_new_shape_a_step_leaves_no_trace(maker, way):
    world, make = World(gravity=(0, 0)), MAKERS[maker]
    world.add_body(Polygon.box(20, 20), ragged(10**6, 16), position=(500, 0), angular_velocity=1.0)
    body = world.add_body(make(0), kind="kinematic")
    largest = [0, 0]
    for k in range(1, 400):
        if way == "set_shapes":
            body.set_shapes(make(k))
        elif way == "remove and add":
            body.remove()
            body = world.add_body(make(k), kind="kinematic")
        else:
            body.add_shape(make(k))
            body.remove_shape(body.shape_ids[0])
        if k % 10 == 0:
            world.step()
        if k > 100:
            assert size(world) <= tuple(2 * each for each in largest), f"still growing after {k} shapes"
        else:
            largest = [max(pair) for pair in zip(largest, size(world), strict=True)]


def test_memory_does_not_grow_over_hundreds_of_masks():
    world = World(gravity=(0, 0))
    body = world.add_body(ragged(0, 48), angular_velocity=2.0)

    def work(first, last):
        for k in range(first, last):
            body.set_shapes(ragged(k, 48))
            if k % 50 == 0:
                world.step()
                world.closest((300, 0))
        gc.collect()

    work(1, 100)
    tracemalloc.start()
    try:
        work(100, 200)
        before = tracemalloc.get_traced_memory()[0]
        work(200, 600)
        assert tracemalloc.get_traced_memory()[0] < before + 500_000, "hundreds of masks were kept: a megabyte and more"
    finally:
        tracemalloc.stop()


def test_clear_frees_everything():
    world = World()
    world.add_bodies(ragged(1), [(k * 300.0, 0) for k in range(5)], angular_velocity=1.0)
    for make in MAKERS.values():
        world.add_body(make(3), kind="static", position=(0, 900))
    for _ in range(20):
        world.step()
    world.clear()
    assert size(world) == (0, 0)
    ball = world.add_body(Circle(4))
    world.step()
    assert ball.velocity.y > 0


def test_a_value_that_many_share_stands_there_once():
    world, mask = World(gravity=(0, 0)), ragged(1)
    world.add_body(mask, kind="static")
    once = world.library.size
    for k in range(1, 50):
        world.add_body(mask.with_(sensor=bool(k % 2)), position=(300 * k, 0), kind="static")
    world.add_bodies(Bounds(mask), [(0, 300 * k) for k in range(1, 50)], kind="static")
    assert world.library.size == once


@pytest.mark.parametrize("sleeping", [True, False])
def test_nothing_else_changes(sleeping):
    """Freeing unused geometry changes no result: a world that frees shapes and one that keeps all move equally."""
    worlds = []
    for tidy in (True, False):
        world = World() if sleeping else World(solver="projection")
        world.add_body(TileGrid(np.ones((2, 40), bool), 16), position=(-320, 100), kind="static")
        far = world.add_body(kind="static", position=(0, 5000))
        for k in range(12):
            shape = (ragged(k, 20), Polygon.box(14 + k, 12), Capsule((-6, 0), (6, 0), 5))[k % 3]
            world.add_body(shape, position=(-150 + 25 * k, 50), angle=0.3 * k, angular_velocity=1.0)
        for k in range(160):
            shapes = (ragged(1000 + k, 64),) if tidy else tuple(ragged(1000 + j, 64) for j in range(3))
            if k % 20 == 0:
                far.set_shapes(*shapes)
            world.step()
        taken = world.snapshot()
        for _ in range(30):
            world.step()
        after = world.digest()
        world.restore(taken)
        for _ in range(30):
            world.step()
        assert world.digest() == after
        worlds.append([(body.position, body.angle, body.velocity, body.awake) for body in world])
    assert worlds[0] == worlds[1]
