"""A step that stands still after each of its stages, for whoever looks between them. World.step makes it in one go."""

from collections.abc import Generator
from time import perf_counter

import numpy as np

from physics.step import begin, finish, step_length
from physics.tables.step_state import Stage, StepState
from physics.world_state import WorldState


def staged_step(world: WorldState, dt: float | None = None) -> Generator[Stage | None, None, None]:
    """Make the step of World.step(dt): yields None before the first stage, then each stage when it has run.

    Meanwhile the world shows what there is so far: bodies, candidates, manifolds, contacts and events of half a step,
    seconds and counters in `profile`. It cannot be changed. That is no state to go on from: whoever stops in the
    middle, or lets debug or a query look in between, puts the world back afterwards. Raises ValueError as World.step.
    """
    world._unlocked()
    dt = step_length(world, dt)
    stages, names = world._plan_now
    spent = world.profile.begin(names)
    world._stepping = True
    try:
        state = begin(world, dt)
        yield None
        for stage in stages:
            started = perf_counter()
            stage(state)
            spent.append(perf_counter() - started)
            _show(world, state)
            yield stage
        finish(world, state)
    finally:
        world._stepping = False


def _show(world: WorldState, state: StepState) -> None:
    """Let the world tell what the stages have found so far; until they tell of contacts, those that touch by now."""
    world.manifolds, world.anchors, world.sensed = state.manifolds, state.anchors, state.sensed
    world.ghosts, world.events = state.ghosts, state.events
    manifolds, keep = state.told
    world.tell_contacts(*(state.told if keep is not None else (state.manifolds, _touching(state))))


def _touching(state: StepState) -> np.ndarray:
    """Which manifolds touch, sensors apart, as `events` will tell: those that overlap, that touched and are no further
    apart than the slop, bear something, or were met on the way."""
    rows, before = state.manifolds, state.touching.rows
    second = rows["count"] > 1
    gap = np.minimum(rows["separation_1"], np.where(second, rows["separation_2"], np.inf))
    old = np.isin(rows["shape_a"] << 32 | rows["shape_b"], before["shape_a"] << 32 | before["shape_b"])
    pushed = (rows["normal_impulse_1"] > 0.0) | (second & (rows["normal_impulse_2"] > 0.0))
    return ((gap <= np.where(old, state.tolerances.slop, 0.0)) | pushed | rows["swept"]) & ~rows["sensor"]
