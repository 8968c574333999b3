"""A world's step made from outside, stage by stage: other stages than its own, and each timed by the processor's time.

`world.profile` goes by the clock on the wall, which goes on while others have the processor.
"""

from collections.abc import Sequence
from typing import Any

from game.measure.timing import clock, undisturbed
from physics import World
from physics.step import begin, finish, plan
from physics.tables.step_state import Stage


def stages_of(world: World, *instead: Stage) -> tuple[Stage, ...]:
    """Those of a world without characters, but for others that take the place of who has their name."""
    others = {stage.stage: stage for stage in instead}
    own = plan(world.effects, world.solver, characters=False).stages
    return tuple(others.get(stage.stage, stage) for stage in own)


def advance(world: World, stages: Sequence[Stage], dt: float, spent: dict[str, Any] | None = None) -> None:
    """What `world.step(dt)` does, in these stages; spent [s]: what each takes is added to there, where it is."""
    world.profile.begin([stage.stage for stage in stages])
    state = begin(world, dt)
    for stage in stages:
        started = clock()
        stage(state)
        if spent is not None:
            spent[stage.stage] = spent.get(stage.stage, 0.0) + clock() - started
    finish(world, state)


def seconds_of_stage(world: World, name: str, steps: int) -> float:
    """What a stage takes a step, the mean of so many. Raises KeyError where the world has none of that name."""
    stages, spent = stages_of(world), {}
    with undisturbed():
        for _ in range(steps):
            advance(world, stages, world.dt, spent)
    return spent[name] / steps
