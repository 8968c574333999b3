"""staged_step pauses after each stage of a step: the result equals a normal step, and each pause shows the state so
far.
"""

import numpy as np
import pytest

from physics import Circle, Effects, Polygon, World, debug
from physics.step import staged_step
from tests.physics.test_stages import WORLDS, busy


@pytest.mark.parametrize("name", WORLDS)
def test_it_is_the_step_of_the_world(name):
    ours, theirs = busy(*WORLDS[name])[0], busy(*WORLDS[name])[0]
    for number in range(12):
        dt = None if number % 3 else number / 600.0
        names = [stage.stage for stage in staged_step(ours, dt) if stage is not None]
        theirs.step(dt)
        assert names == theirs.stages and ours.digest() == theirs.digest()
        assert ours.profile.counters == theirs.profile.counters and min(ours.profile.stages.values()) > 0.0
        assert ours.steps == theirs.steps and ours.time == theirs.time


def pile():
    world = World(Effects(response=True, gravity=True, friction=True, stacking=True), gravity=(0.0, 320.0))
    world.add_body(Polygon.box(80, 8), position=(0.0, 20.0), kind="static")
    world.add_body(Polygon.box(8, 8), position=(0.0, 12.1))
    return world


def test_each_stage_shows_what_it_found():
    world, seen = pile(), {}
    for stage in staged_step(world):
        name = "" if stage is None else stage.stage
        seen[name] = (
            len(world.candidates),
            len(debug.contact_points(world)),
            len(world.contacts),
            world.body(1).position,
        )
    assert seen[""][:3] == seen["motion_rectangles"][:3] == (0, 0, 0)
    assert seen["broad_phase"][:3] == (1, 0, 0)
    assert seen["narrow_phase"][:3] == (1, 2, 2), "they overlap, and nobody has told of it yet"
    assert seen["narrow_phase"][3] == (0.0, 12.1) != seen["soft_step"][3]
    assert seen["events"][:3] == (1, 2, 2)


def test_what_only_might_meet_is_no_contact_yet():
    world = pile()
    world.body(1).position = (0.0, 11.9)  # a tenth of a pixel above: less than the slop
    found = [(len(debug.contact_points(world)), len(world.contacts)) for _ in staged_step(world)]
    assert (2, 0) in found


def test_it_cannot_be_changed_meanwhile_and_can_when_it_was_left():
    world = pile()
    steps = staged_step(world)
    next(steps)
    with pytest.raises(RuntimeError, match="during its step"):
        world.add_body(Circle(4.0))
    with pytest.raises(RuntimeError, match="during its step"):
        next(staged_step(world))
    steps.close()
    world.add_body(Circle(4.0))


@pytest.mark.parametrize("dt", [-1.0, np.nan, np.inf, "1"])
def test_lengths_that_are_none_are_refused_as_by_a_step(dt):
    world = pile()
    with pytest.raises((ValueError, TypeError)) as said:
        next(staged_step(world, dt))
    with pytest.raises(type(said.value), match="dt"):
        world.step(dt)
    assert world.steps == 0
