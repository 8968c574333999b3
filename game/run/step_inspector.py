"""Step inspector: stop a step of a scene after any of its stages, and move forwards and backwards between stages.

The scene starts from a key frame, and its rules run until they step the world. The world's step is aborted after the
chosen stage, and the scene remains in that state. Every state is reached from the key frame in this way, so that moving
backwards gives bit-identical states. At the end, the key frame is restored.
"""

from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from game.input.inputs import InputFrame, InputState
from game.invariants.watch import WatchedWorld
from game.measure.joint_results import COLUMNS, joint_results
from game.run.key_frame import KeyFrame
from game.run.rewind import Rewind
from game.run.session import Session
from game.run.sources import BotSource
from game.scene import Scene
from physics.step import staged_step
from physics.tables.step_state import COUNTERS, Stage

TABLES = ("bodies", "shapes", "characters", "contact_rows", "candidates", "joints")


class Halted(Exception):
    """Exception that aborts a step after the chosen stage."""


class Done(NamedTuple):
    """A finished stage of a step, and the changes that the stage made."""

    stage: Stage
    counted: dict[str, int]  # increments of the counters
    changed: list[tuple[str, int, list[str]]]  # (table, number of changed rows, names of changed columns)
    rows: list[tuple[str, int, int]]  # (table, rows before, rows now) of tables with another length
    joints: str = ""  # its results for the joints, in words


class StepInspector:
    """Inspector of one step of a world. before: input of the previous step.

    following(): returns the input of the inspected step. stages: stages of all steps that the world makes in this
    frame, in order; empty if there is no step. starts: indices in `stages` at which these steps begin. place: number of
    stages that have run. done: the stage that ran last, with its changes, or None.
    """

    def __init__(
        self, scene: Scene, world: WatchedWorld, before: InputFrame, following: Callable[[], InputFrame]
    ) -> None:
        self.scene, self.world, self.inputs = scene, world, (before, following)
        self.key = KeyFrame(scene)
        self.stages: list[Stage] = []
        self.starts: list[int] = []
        self.seconds: list[list[float]] = []  # [s] for each stage, its duration in every run so far
        self.place = self.ran = 0
        self.done: Done | None = None
        self.tables: dict[str, np.ndarray] = {}  # before the last stage
        self.stop: int | None = None  # None: make the whole frame, to list its stages
        self._run()
        self.go(0)

    def go(self, place: int) -> None:
        """Move to the state after the first `place` stages. `place` is limited to the number of stages."""
        self.key.restore()
        if not self.stages:
            return
        self.stop = self.place = max(0, min(len(self.stages), place))
        self.done = None
        try:
            self._run()
        except Halted:
            self.tables = {}
        else:
            raise RuntimeError(
                f"{self.scene.name} made {self.ran} stages, and {self.stop} when its step was made before"
            )

    def leave(self) -> None:
        """End the inspection, and restore the scene's state before the step."""
        self.key.restore()

    def _run(self):
        before, following = self.inputs
        inputs = InputState()
        inputs.set(before)
        inputs.set(following())
        self.ran = 0
        self.world.stepped_by = self._make
        try:
            self.scene.step(inputs)
        finally:
            self.world.stepped_by = None

    def _make(self, world, dt):
        """Make a step of the world, and abort it after stage number `stop`.

        The scene calls this instead of World.step().
        """
        with closing(staged_step(world, dt)) as steps:
            for stage in steps:
                if stage is None:
                    if self.stop is None:
                        self.starts.append(len(self.stages))
                else:
                    self._note(world, stage)
                if self.ran == self.stop:
                    raise Halted
                if self.stop == self.ran + 1:
                    self.tables = photographed(world)

    def _note(self, world, stage):
        seconds = world.profile.stages[stage.stage]
        if self.stop is None:
            self.stages.append(stage)
            self.seconds.append([])
        self.seconds[self.ran].append(seconds)
        self.ran += 1
        if self.ran == self.stop:
            after = photographed(world)
            joints = joint_results(world, self.tables["joints"], after["joints"], stage.stage)
            self.done = compared(stage, self.tables, after)._replace(joints=str(joints))


def next_input(session: Session, rewind: Rewind) -> tuple[Callable[[], InputFrame], str]:
    """Return (function, sentence): a function that returns the input of a session's next step, and its source in words.

    The function must be called in the state before that step. The source is the recorded steps of `rewind`, the bot, or
    the keys that are held now.
    """
    recorded, held = rewind.following, replace(session.inputs.now, wheel=0, changes=())
    if recorded is not None:
        return lambda: recorded, "the input is that which was recorded"
    if isinstance(session.source, BotSource):
        return lambda: BotSource().next(session.scene), "the input is the bot's"
    return lambda: held, "the input is what was held in the step before"


def photographed(world: WatchedWorld) -> dict[str, np.ndarray]:
    """Return copies of the tables that a stage may write, {name: array}. "work" is the array of the counters."""
    found = {name: getattr(world, name).copy() for name in TABLES if name != "characters"}
    return {**found, "characters": world.characters.rows.copy(), "work": world.profile.work.copy()}


def compared(stage: Stage, before: dict[str, np.ndarray], after: dict[str, np.ndarray]) -> Done:
    """Return the changes that a stage made to the tables, as a Done.

    before, after: results of photographed(). Values are compared as bytes: NaN equals NaN, and -0.0 differs from 0.0.
    The solver's scratch columns of joints are left out.
    """
    work = (after["work"] - before["work"]).tolist()
    counted = {name: count for name, count in zip(COUNTERS, work, strict=True) if count}
    changed, rows = [], []
    for name in TABLES:
        old, new = before[name], after[name]
        if len(old) != len(new):
            rows.append((name, len(old), len(new)))
            continue
        by_rows: dict[int, list[str]] = {}
        for column in COLUMNS if name == "joints" else new.dtype.names or ():
            count = _differing(old[column], new[column])
            if count:
                by_rows.setdefault(count, []).append(column)
        changed += [(name, count, columns) for count, columns in by_rows.items()]
        if new.dtype.names is None and (count := _differing(old, new)):
            changed.append((name, count, []))
    return Done(stage, counted, changed, rows)


def _differing(old, new):
    """Return the number of rows in which two arrays of the same length differ."""
    if not len(new):
        return 0
    old, new = (np.ascontiguousarray(each).view(np.uint8).reshape(len(each), -1) for each in (old, new))
    return int((old != new).any(axis=1).sum())
