"""A step made stage by stage equals the world's own step, and stage times are processor times."""

import time

import pytest

from game.measure.staged import advance, seconds_of_stage, stages_of
from game.measure.timing import clock
from game.report.piles import pyramid, world_of
from physics.tables.step_state import stage


@pytest.mark.parametrize("solver", ["soft_step", "projection"])
def test_a_step_from_outside_is_the_worlds_own(solver):
    inside, outside, spent = world_of(pyramid(3), solver, 4), world_of(pyramid(3), solver, 4), {}
    for _ in range(5):
        inside.step()
        advance(outside, stages_of(outside), outside.dt, spent)
    assert inside.digest() == outside.digest()
    assert list(spent) == inside.stages and all(seconds > 0.0 for seconds in spent.values())


@pytest.mark.skipif(clock is time.perf_counter, reason="no clock here tells the processor's time finely enough")
def test_who_waits_takes_no_time_and_another_stage_takes_the_place_of_its_name():
    world = world_of(pyramid(3), "soft_step", 4)
    seconds_of_stage(world, "broad_phase", 1)

    @stage("soft_step")
    def waits(state):
        time.sleep(0.05)

    spent = {}
    advance(world, stages_of(world, waits), world.dt, spent)
    assert spent["soft_step"] < 0.04 and world.profile.counters["candidates"] > 0
    assert seconds_of_stage(world, "broad_phase", 3) < 0.05
    with pytest.raises(KeyError):
        seconds_of_stage(world, "nowhere", 1)
