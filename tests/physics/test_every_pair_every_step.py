"""BruteForce(incremental=False) tests every pair in every step and finds the same pairs as the other broad phases."""

import numpy as np
import pytest

from physics import BruteForce, Circle, DynamicTree, Effects, Polygon, World

COUNT = 30


@pytest.mark.parametrize("moving", [0, 3, COUNT])
def test_half_of_n_squared_pairs_are_tested_whatever_moves(moving):
    world = World(Effects(), BruteForce(incremental=False))
    ids = world.add_bodies(Circle(8), np.random.default_rng(1).uniform(0, 200, (COUNT, 2)))
    for step in range(6):
        for identity in ids[:moving].tolist():
            body = world.body(identity)
            body.move_to((body.position.x + 1.0, body.position.y))
        world.step()
        assert world.profile.counters["pairs_tested"] == COUNT * (COUNT - 1) // 2, step


def test_a_heap_that_falls_asleep_and_is_knocked_goes_the_same_way():
    worlds = [World(Effects.rigid_bodies(), each) for each in (BruteForce(incremental=False), DynamicTree())]
    for world in worlds:
        world.add_body(Polygon.box(600, 20), position=(0, 10), kind="static")
        for k in range(6):
            world.add_body(Polygon.box(20, 20), position=(0.3 * k, -10 - 20 * k))
        world.add_body(Circle(6), position=(-280, -6), velocity=(0, 0))
    for step in range(200):
        if step == 120:
            for world in worlds:
                world.bodies["vx"][-1] = 400.0
                world.touch([int(world.bodies["id"][-1])])
        for world in worlds:
            world.step()
        assert worlds[0].digest() == worlds[1].digest(), step
        assert np.array_equal(worlds[0].candidates, worlds[1].candidates), step
