"""A step of a world, run stage by stage. Stages can be replaced, and the processor time of each stage is measured.

`world.profile` uses wall-clock time, which includes the time of other processes.
"""

from collections.abc import Sequence
from typing import Any

from game.measure.timing import clock, undisturbed
from physics import World
from physics.step import begin, finish, plan
from physics.tables.step_state import Stage


def stages_of(world: World, *instead: Stage) -> tuple[Stage, ...]:
    """Return the stages of a step of a world without characters, in order.

    instead: stages that replace the world's stages of the same name.
    """
    others = {stage.stage: stage for stage in instead}
    own = plan(world.effects, world.solver, characters=False).stages
    return tuple(others.get(stage.stage, stage) for stage in own)


def advance(world: World, stages: Sequence[Stage], dt: float, spent: dict[str, Any] | None = None) -> None:
    """Run one step of a world with the given stages, in the same way as `world.step(dt)`.

    spent: {name of a stage: seconds}, to which the times of this step are added; None if they are not measured.
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
    """Return the mean time [s] of the stage `name` over `steps` steps of a world.

    Raises KeyError if the world has no such stage.
    """
    stages, spent = stages_of(world), {}
    with undisturbed():
        for _ in range(steps):
            advance(world, stages, world.dt, spent)
    return spent[name] / steps
