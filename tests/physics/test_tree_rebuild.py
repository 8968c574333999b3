"""The two trees of DynamicTree after bulk changes: all bodies move or change trees, or most are replaced."""

import math

import numpy as np
import pytest

from physics import JIT, BruteForce, Circle, DynamicTree, Effects, World

COUNT = 400 if JIT else 150


def limit(n):
    return 1.45 * math.log2(max(n, 2)) + 2


@pytest.mark.parametrize("seed", range(3))
def test_bulk_changes_find_what_brute_force_finds_and_stay_balanced(seed):
    rng = np.random.default_rng(seed)
    worlds = [World(Effects(), BruteForce()), World(Effects(), DynamicTree())]
    places = rng.uniform(0, 400, (COUNT, 2))
    ids = [world.add_bodies(Circle(9), places) for world in worlds][0]
    for step in range(24):
        what = rng.integers(0, 4)
        chosen = ids[rng.random(len(ids)) < rng.choice([0.05, 0.6, 1.0])]
        fresh = rng.uniform(0, 400, (len(chosen), 2))
        kind = str(rng.choice(["static", "dynamic", "kinematic"]))
        for world in worlds:
            if what == 0:
                for identity, place in zip(chosen.tolist(), fresh.tolist(), strict=True):
                    world.body(identity).move_to(place)
            elif what == 1:
                for identity in chosen.tolist():
                    world.body(identity).set_kind(kind)
            elif what == 2 and len(chosen) < len(ids):
                world.remove_bodies(chosen)
                added = world.add_bodies(Circle(9), fresh, kind=kind)
        if what == 2 and len(chosen) < len(ids):
            ids = np.concatenate([np.setdiff1d(ids, chosen), added])
        for world in worlds:
            world.step()
        assert np.array_equal(worlds[0].candidates, worlds[1].candidates), f"step {step}"
        assert worlds[1].broadphase.height <= limit(len(ids))
        corner = rng.uniform(-50, 400, 2)
        near = [sorted(body.id for body in world.query_aabb(corner, corner + 60.0)) for world in worlds]
        assert near[0] == near[1], f"step {step}"


def test_all_at_once_is_built_balanced():
    world = World(Effects(), DynamicTree())
    world.add_bodies(Circle(2), np.random.default_rng(9).uniform(0, 900, (COUNT, 2)), kind="static")
    world.add_bodies(Circle(2), np.zeros((COUNT, 2)))
    world.step()
    assert world.broadphase.height <= math.ceil(math.log2(COUNT))
    world.clear()
    world.step()
    assert world.broadphase.height == -1


@pytest.mark.parametrize("count", [0, 1, 2, 3, 40, 700])
def test_the_drawn_boxes_are_those_of_all_nodes_with_their_depths(count):
    rng = np.random.default_rng(count)
    world = World(Effects(), broadphase=DynamicTree())
    for k in range(count):
        world.add_body(Circle(3), position=rng.uniform(0, 900, 2), kind="static" if k % 3 == 0 else "dynamic")
    world.step()
    tree = world.broadphase
    assert isinstance(tree, DynamicTree)
    boxes, depths = tree.boxes()
    assert len(boxes) == len(depths) == sum(2 * n - 1 for n in (-(-count // 3), count - -(-count // 3)) if n)
    expected = []
    for root in tree.state[2:].tolist():
        todo = [(root, 0)] if root >= 0 else []
        while todo:
            at, depth = todo.pop()
            node = tree.nodes[at]
            expected.append((depth, *(float(node[name]) for name in ("lower_x", "lower_y", "upper_x", "upper_y"))))
            if node["height"] > 0:
                todo += [(node["child_a"], depth + 1), (node["child_b"], depth + 1)]
    assert sorted(zip(depths.tolist(), *boxes.T.tolist(), strict=True)) == sorted(expected)
    assert (np.diff(depths) >= 0).all()
