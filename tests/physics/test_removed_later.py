"""Removed bodies leave the tables only when these are read, which changes no later step."""

import copy

import numpy as np
import pytest

from physics import Circle, Effects, Polygon, Snapshot, World
from tests.oracles.loads import forget_loads
from tests.physics.test_move import RIGID, WORLDS, crowded, kept


def read(world):
    """Read the body table, which drops the rows of removed bodies."""
    assert len(world.bodies) == len(world)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("effects", WORLDS)
def test_the_same_as_if_rows_were_dropped_at_once(effects, seed):
    """Worlds with immediately and lazily dropped rows stay equal through setters, additions, reads and steps.

    In every other run the heap sleeps.
    """
    steps = (3, 300)[seed % 2] if effects == "sleeping" else 12
    lazy, eager = (crowded(WORLDS[effects], "hash", seed, steps) for _ in range(2))
    rng = np.random.default_rng(seed)
    for turn in range(60):
        ids = [each for each in sorted(lazy._shapes_of) if each > 1]
        one, other = (int(each) for each in rng.choice(ids, 2, replace=False))
        kind, place, push = rng.integers(5), tuple(rng.uniform(-90, 90, 2)), tuple(rng.uniform(-9, 9, 2))
        for world in (lazy, eager):
            if kind <= 1 and len(ids) > 12:
                if kind:
                    world.body(one).remove()
                else:
                    world.remove_body(one)
                assert one not in world and len(world) == len(world._shapes_of)
                with pytest.raises(KeyError, match="not in this world"):
                    world.body(one)
            elif kind == 2:
                world.body(other).position = place
            elif kind == 3 and world.body(other).kind == "dynamic":
                body = world.body(other)
                body.velocity = push
                if effects != "detection":
                    body.apply_impulse(push, place)
                    body.apply_force(push)
            elif kind == 4:
                world.add_body(Circle(4.0), position=place)
        read(eager)
        if turn % 7 == 6:
            for world in (lazy, eager):
                world.step()
            assert kept(lazy) == kept(eager), turn
    assert kept(lazy) == kept(eager)


@pytest.mark.parametrize("size", [1, 2, 5])
@pytest.mark.parametrize("seed", range(8))
def test_the_loads_of_bodies_are_released_as_by_a_search(seed, size):
    """The removal of several bodies at once clears exactly the cached forces that a search over all contacts finds."""
    rng, world = np.random.default_rng(seed), World(RIGID)
    world.add_body(Polygon.box(900, 20), kind="static", position=(0, 10))
    for stack in range(5):
        for k in range(5):
            place = (30.0 * stack, -4.0 - 8.0 * k)
            world.add_body(Polygon.box(12, 8), position=place, mass=float(rng.choice((1.0, 900.0))))
    for _ in range(8):
        world.step()
    cleared = 0
    order = rng.permutation(world.bodies["id"])
    for start in range(0, len(order), size):
        other, ids = copy.deepcopy(world), order[start : start + size]
        world.contact_lists.forget_loads(world, world.rows(ids), together=True)
        forget_loads(other, ids)
        assert str(world.contact_rows.tolist()) == str(other.contact_rows.tolist())
        cleared += int((world.contact_rows["normal_force_1"] == 0.0).sum())
    assert cleared


def test_everything_that_reads_a_world_misses_the_removed():
    """Every reader of a world ignores removed bodies, even as the first reader after the removal."""
    readers = [
        lambda w: [body.id for body in w],
        lambda w: w.bodies["id"].tolist(),
        lambda w: sorted(set(w.shapes["body"].tolist())),
        lambda w: sorted({*w.contact_rows["body_a"].tolist(), *w.contact_rows["body_b"].tolist()} | {0, 1, 3}),
        lambda w: [body.id for body in w.query_aabb((-99, -99), (99, 99))],
        lambda w: sorted({*w.touching().ravel().tolist()} | {0, 1, 3}),
        lambda w: w.snapshot().arrays["bodies"]["id"].tolist(),
        lambda w: copy.deepcopy(w).bodies["id"].tolist(),
        lambda w: [int(w.bodies["id"][row]) for row in w.rows([0, 1, 3])],
        lambda w: sorted(w._shapes_of),
        lambda w: (w.step(), w.bodies["id"].tolist())[1],
    ]
    for effects in (RIGID, Effects.detection()):
        for reader in readers:
            world = World(effects)
            for k in range(4):
                world.add_body(Circle(5), position=(8 * k, 0), user=k)
            world.step()
            gone = world.body(2)
            gone.remove()
            assert reader(world) == [0, 1, 3] and len(world) == 3 and gone not in world
            for call in (gone.remove, gone.wake, lambda body=gone: body.position, lambda body=gone: body.user):
                with pytest.raises(KeyError):
                    call()
            assert world.add_body(Circle(5)).id == 4 and isinstance(world.snapshot(), Snapshot)


def test_remove_all_and_begin_again():
    world = World(RIGID)
    for _ in range(3):
        bodies = [world.add_body(Circle(5), position=(20 * k, 0)) for k in range(70)]
        world.step()
        for body in bodies:
            body.remove()
        assert len(world) == 0 and list(world) == []
        world.step()
    assert world.add_body(Circle(1)).id == 210
