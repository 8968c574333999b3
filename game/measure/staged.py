"""A world's step run from outside, stage by stage: stages can be replaced, and each is timed by processor time.

`world.profile` uses wall-clock time, which includes the time of other processes.
"""

from collections.abc import Sequence
from typing import Any

from game.measure.timing import clock, undisturbed
from physics import World
from physics.step import begin, finish, plan
from physics.tables.step_state import Stage


def stages_of(world: World, *instead: Stage) -> tuple[Stage, ...]:
    """Return the stages of a world without characters; a stage of `instead` replaces the stage of the same name."""
    others = {stage.stage: stage for stage in instead}
    own = plan(world.effects, world.solver, characters=False).stages
    return tuple(others.get(stage.stage, stage) for stage in own)


def advance(world: World, stages: Sequence[Stage], dt: float, spent: dict[str, Any] | None = None) -> None:
    """Step the world as `world.step(dt)` does, with these stages. The time of each stage [s] is added to spent, if
    given.
    """
    world.profile.begin([stage.stage for stage in stages])
    state = begin(world, dt)
    for stage in stages:
        started = clock()
        stage(state)
        if spent is not None:
            spent[stage.stage] = spent.get(stage.stage, 0.0) + clock() - started
    finish(world, state)


def seconds_of_stage(world: World, name: str, steps: int) -> float:
    """Return the mean time of a stage per step [s]. Raises KeyError if the world has no stage of that name."""
    stages, spent = stages_of(world), {}
    with undisturbed():
        for _ in range(steps):
            advance(world, stages, world.dt, spent)
    return spent[name] / steps
