"""copy.copy(): refused where both objects would share arrays, independent or a reference everywhere else."""

import copy
import pickle

import numpy as np
import pytest

from physics import (
    Bounds,
    BruteForce,
    Character,
    Circle,
    Distance,
    DynamicTree,
    Effects,
    Polygon,
    SpatialHashGrid,
    SweepAndPrune,
    World,
)

EFFECTS = Effects.rigid_bodies().with_(joints=True, persist=True)
STRATEGIES = [BruteForce, SweepAndPrune, SpatialHashGrid, DynamicTree]


def made(broadphase="hash"):
    """Return a world with a floor, falling discs, a joint and a character, after some steps, and its handles."""
    world = World(EFFECTS, broadphase)
    world.add_body(Polygon.box(600, 20), position=(150, 110), kind="static")
    bodies = [world.add_body(Circle(6.0), position=(13 * k, 90 - 5 * k), user=[k]) for k in range(12)]
    joint = world.add_joint(Distance(bodies[0], bodies[1], (0, 90), (13, 85)))
    character = Character(world, Bounds(Circle(6.0)), (300, 94))
    for _ in range(5):
        world.step()
    return world, bodies[0], joint, character


class Game(World):
    """A subclass with an attribute of its own."""

    score = 3


@pytest.mark.parametrize("kind", [World, Game])
def test_a_shallow_copy_of_a_world_is_refused(kind):
    world = kind(EFFECTS)
    with pytest.raises(TypeError, match=r"World|Game") as refused:
        copy.copy(world)
    assert "copy.deepcopy(world)" in str(refused.value) and "world.snapshot()" in str(refused.value)


@pytest.mark.parametrize("strategy", STRATEGIES)
def test_a_shallow_copy_of_a_broad_phase_is_refused(strategy):
    with pytest.raises(
        TypeError, match=rf"{strategy.__name__} cannot be copied .* write copy.deepcopy.*{strategy.__name__}"
    ):
        copy.copy(strategy())
    rng = np.random.default_rng(0)
    lower = rng.uniform(0, 100, (60, 2))
    one = strategy()
    pairs = one.find_pairs(lower, lower + 9)
    other = copy.deepcopy(one)
    assert other.find_pairs(lower[:30], lower[:30] + 9).max() < 30
    assert one.find_pairs(lower, lower + 9).tolist() == pairs.tolist()


@pytest.mark.parametrize(
    "way", [copy.deepcopy, lambda world: pickle.loads(pickle.dumps(world))], ids=["deep", "pickle"]
)
@pytest.mark.parametrize("broadphase", ["brute", "sweep", "hash", "tree"])
def test_other_copies_of_a_world_are_independent(way, broadphase):
    world, *_ = made(broadphase)
    before, other = world.digest(), way(world)
    for _ in range(10):
        other.step()
    assert world.digest() == before != other.digest()
    for _ in range(10):
        world.step()
    assert world.digest() == other.digest() and [body.world for body in other] == [other] * len(other)


def test_copies_of_handles_refer_to_the_same_thing():
    world, body, joint, character = made()
    for each in (body, joint):
        found = copy.copy(each)
        assert found == each and hash(found) == hash(each) and found.world is world
    other = copy.copy(character)
    assert other.body == character.body and other.world is world
    other.move(1, 0)
    assert other.position == character.position


@pytest.mark.parametrize("name", ["events", "profile", "contacts"])
def test_copies_of_results_keep_their_values(name):
    """A later step of the world leaves a copy as it is."""
    world, *_ = made()
    taken = copy.copy(getattr(world, name))
    before = repr(taken), pickle.dumps(taken)
    for _ in range(5):
        world.step()
    assert (repr(taken), pickle.dumps(taken)) == before
