"""Jointed bodies do not collide with each other, after every kind of change of joints and of the broad phase."""

import pytest

import physics.step
from physics import BROADPHASES, Circle, Effects, Revolute, Snapshot, World

JOINTED = Effects.rigid_bodies().with_(joints=True)


def overlapping(broadphase="hash", count=6):
    """Return (world, discs, joints) of a row of overlapping discs without gravity, each pinned to the next."""
    world = World(JOINTED, broadphase, gravity=(0, 0))
    discs = [world.add_body(Circle(8.0), position=(10.0 * k, 0.0)) for k in range(count)]
    pairs = zip(discs, discs[1:], strict=False)
    joints = [world.add_joint(Revolute(a, b, at=(10.0 * k + 5.0, 0.0))) for k, (a, b) in enumerate(pairs)]
    return world, discs, joints


def touching(world):
    world.step()
    return [tuple(pair) for pair in world.touching().tolist()]


@pytest.mark.parametrize("broadphase", BROADPHASES)
def test_each_change_counts_in_the_next_step(broadphase):
    world, discs, joints = overlapping(broadphase)
    assert touching(world) == []
    joints[2].contacts = True
    assert touching(world) == [(2, 3)]
    joints[2].contacts = False
    assert touching(world) == []
    joints[0].enabled = False
    joints[4].remove()
    assert touching(world) == [(0, 1), (4, 5)]
    again = world.add_joint(Revolute(discs[4], discs[5], at=(45, 0)))
    joints[0].enabled = True
    assert touching(world) == []
    discs[2].remove()
    late = world.add_body(Circle(8.0), position=(20.0, 0.0))
    assert touching(world) == [(1, late.id), (3, late.id)] and again in world


@pytest.mark.parametrize(
    "change",
    [
        lambda world, folder: world.restore(world.snapshot()),
        lambda world, folder: (world.snapshot().save(folder / "a.npz"), world.restore(Snapshot.load(folder / "a.npz"))),
        lambda world, folder: world.set_effects(JOINTED.with_(persist=True)),
        lambda world, folder: setattr(world, "broadphase", "tree"),
        lambda world, folder: setattr(world, "solver", "sequential_impulse"),
    ],
    ids=["restored", "loaded", "effects", "broad phase", "solver"],
)
def test_a_broad_phase_made_anew_keeps_them_apart(change, tmp_path):
    world, _, joints = overlapping()
    assert touching(world) == []
    change(world, tmp_path)
    assert touching(world) == []
    fresh, _, _ = overlapping()
    change(fresh, tmp_path)  # before the first step
    assert touching(fresh) == []


def test_many_joints_added_one_by_one_are_looked_at_once(monkeypatch):
    calls = []
    look = physics.step.keep_apart
    monkeypatch.setattr(physics.step, "keep_apart", lambda world: (calls.append(len(world.joints)), look(world)))
    world, _, _ = overlapping(count=40)
    assert calls == []
    world.step()
    world.step()
    assert calls == [39]
