"""Without stacking, the boxes of moving bodies extend ahead to cover the motion of several steps.

Bodies are then searched for less often, and no pair is missed.
"""

import numpy as np
import pytest

from physics import BROADPHASES, Circle, Effects, World
from physics.settings import STEPS_AHEAD

STEPS, COUNT, RADIUS, FIELD = 60, 120, 6.0, 260.0


def flock(strategy, rng, speed=90.0):
    """Return a world of discs of one size at random positions in a field, with random velocities."""
    world = World(Effects(), BROADPHASES[strategy]())
    world.add_bodies(Circle(RADIUS), rng.uniform(0.0, FIELD, (COUNT, 2)), rng.uniform(-speed, speed, (COUNT, 2)))
    return world


def pairs_within(world, gap):
    """Return the pairs {(id of A, id of B)} whose surfaces are at most `gap` [px] apart, found by a test of all pairs.

    A comes before B in the table of bodies.
    """
    ids, at = world.bodies["id"], np.stack([world.bodies["x"], world.bodies["y"]], axis=1)
    apart = ((at[:, None] - at[None]) ** 2).sum(axis=2)
    return {(int(ids[a]), int(ids[b])) for a, b in np.argwhere(np.triu(apart <= (2.0 * RADIUS + gap) ** 2, k=1))}


def told(world):
    found = world.reported_rows()
    return set(zip(found["body_a"].tolist(), found["body_b"].tolist(), strict=True))


@pytest.mark.parametrize("strategy", sorted(BROADPHASES))
def test_who_flies_stops_and_turns_meets_whom_it_meets(strategy):
    rng = np.random.default_rng(4)
    world, met = flock(strategy, rng), 0
    for step in range(STEPS):
        some = rng.random(COUNT) < 0.1  # what happens to them no rectangle has foreseen
        world.bodies["vx"][some] *= rng.choice([-1.0, 0.0, 1.0, 40.0])
        world.bodies["vy"][some] += rng.uniform(-90.0, 90.0)
        if step % 7 == 3:
            world.body(int(world.bodies["id"][step])).move_to(rng.uniform(0.0, FIELD, 2))
        world.step()
        # Who touched goes on touching up to the slop.
        assert pairs_within(world, 0.0) <= told(world) <= pairs_within(world, world.tolerances.slop), step
        met += len(told(world))
    assert met > STEPS * 10


def test_who_flies_on_is_looked_for_once_in_some_steps():
    """The broad phase searches for the pairs of a body in steady motion only in about every sixteenth step.

    These steps differ from body to body. The brute-force broad phase counts the tests: it compares each searched body
    with all others.
    """
    world = flock("brute", np.random.default_rng(4), speed=10.0)
    world.step()
    tested = []
    for _ in range(64):
        world.step()
        tested.append(world.profile.counters["pairs_tested"])
    assert 0.03 < np.mean(tested) / COUNT**2 < 0.1, "one in sixteen, or a little more"
    assert max(tested) / COUNT**2 < 0.25


@pytest.mark.parametrize("one_by_one", [False, True])
@pytest.mark.parametrize("kind", ["dynamic", "kinematic"])
@pytest.mark.parametrize("strategy", sorted(BROADPHASES))
def test_bodies_moved_by_the_caller_meet_whom_they_meet(strategy, kind, one_by_one):
    """No pair is missed or added for bodies that the caller moves, compared with a test of all pairs.

    The bodies walk, stop, turn and jump.
    """
    rng = np.random.default_rng(5)
    world = World(Effects(), BROADPHASES[strategy]())
    places = rng.uniform(0.0, FIELD, (COUNT, 2))
    ids = world.add_bodies(Circle(RADIUS), places, kind=kind)
    paces = rng.uniform(-3.0, 3.0, (COUNT, 2))
    for step in range(STEPS):
        some = rng.random(COUNT) < 0.1
        paces[some] = rng.uniform(-3.0, 3.0, (int(some.sum()), 2)) * rng.choice([0.0, 1.0])
        places = places + paces * (step % 3 != 2)
        if step % 7 == 3:
            places[step] = rng.uniform(0.0, FIELD, 2)
        if one_by_one:
            for identity, place in zip(ids.tolist(), places.tolist(), strict=True):
                world.body(identity).position = place
        else:
            world.move(ids, places)
        world.step()
        assert pairs_within(world, 0.0) <= told(world) <= pairs_within(world, world.tolerances.slop), step


@pytest.mark.parametrize("often", [1, 2, 3])
def test_who_is_moved_on_is_looked_for_once_in_some_steps(often):
    """The broad phase searches for the pairs of a sprite that the caller moves only in some steps.

    This holds also for a sprite that stands still in some steps, as in motion by whole pixels.
    """
    rng = np.random.default_rng(4)
    world = World(Effects(), BROADPHASES["brute"]())
    places, paces = rng.uniform(0.0, FIELD, (COUNT, 2)), rng.uniform(-0.3, 0.3, (COUNT, 2))
    ids = world.add_bodies(Circle(RADIUS), places, kind="kinematic")
    tested = []
    for step in range(96):
        places = places + paces * (step % often == 0)
        world.move(ids, places)
        world.step()
        tested.append(world.profile.counters["pairs_tested"])
    assert np.mean(tested[32:]) / COUNT**2 < 0.15


@pytest.mark.parametrize("way", ["velocity", "move"])
def test_no_rectangle_is_left_behind_by_who_has_stopped(way):
    """Sixteen steps after a body has stopped, its box no longer extends ahead.

    In the first steps the stop may be part of a motion by whole pixels, so the box is kept.
    """
    world = flock("hash", np.random.default_rng(4), speed=900.0)
    world.step()
    if way == "move":
        ids, at = world.bodies["id"], np.stack([world.bodies["x"], world.bodies["y"]], axis=1)
        world.move(ids, at + world.dt * np.stack([world.bodies["vx"], world.bodies["vy"]], axis=1))
    world.bodies["vx"] = world.bodies["vy"] = 0.0
    for _ in range(int(STEPS_AHEAD) + 3):
        world.step()
    low, high = (np.stack([world.shapes[f"{end}_{axis}"] for axis in "xy"], axis=1) for end in ("min", "max"))
    slack = 2.0 * world.tolerances.slop
    meet = (low[:, None] <= high[None] + slack).all(axis=2)
    near = np.argwhere(np.triu(meet & meet.T, k=1))
    assert world.candidates.tolist() == near.tolist()
