"""One step of a scene, taken apart: its worlds stand still after any one of its stages, forwards and back.

The scene makes its step as always, from a key frame: its rules run up to the step of the world, which stops after the
stage that is asked for, and from there the scene is left as it stands. Every place is reached that way, from the start,
so that one that is gone back to is the same to the bit; in the end the key frame is put back.
"""

from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from game.input.inputs import InputFrame, InputState
from game.invariants.watch import WatchedWorld
from game.run.key_frame import KeyFrame
from game.run.rewind import Rewind
from game.run.session import Session
from game.run.sources import BotSource
from game.scene import Scene
from physics.step import staged_step
from physics.tables.step_state import COUNTERS, Stage

TABLES = ("bodies", "shapes", "characters", "contact_rows", "candidates")


class Halted(Exception):
    """A step stands still where it was to."""


class Done(NamedTuple):
    """A stage that has run, and what it did."""

    stage: Stage
    counted: dict[str, int]  # what was added to the counters
    changed: list[tuple[str, int, list[str]]]  # (table, rows, columns) that it wrote other values to
    rows: list[tuple[str, int, int]]  # (table, rows before, rows now) of those that it made longer or shorter


class TakenApart:
    """world: whose steps are taken apart; before: the input of the step before; following(): that of this one.

    `stages`: of all steps that this world makes in this frame, in order, none where it makes no step; `starts`: at
    which of them a step begins; `place`: how many have run, where the scene stands now; `done`: the last of them.
    """

    def __init__(
        self, scene: Scene, world: WatchedWorld, before: InputFrame, following: Callable[[], InputFrame]
    ) -> None:
        self.scene, self.world, self.inputs = scene, world, (before, following)
        self.key = KeyFrame(scene)
        self.stages: list[Stage] = []
        self.starts: list[int] = []
        self.seconds: list[list[float]] = []  # that each stage took, in every run so far
        self.place = self.ran = 0
        self.done: Done | None = None
        self.tables: dict[str, np.ndarray] = {}  # as they were before the last of them
        self.stop: int | None = None  # None: the whole frame is made, to see which stages there are
        self._run()
        self.go(0)

    def go(self, place: int) -> None:
        """Stand where so many stages have run, or at the first or last place that there is."""
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
        """Put the scene back to where it stood before the step."""
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
        """A step of the world, as far as it is to go."""
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
            self.done = compared(stage, self.tables, photographed(world))


def next_input(session: Session, rewind: Rewind) -> tuple[Callable[[], InputFrame], str]:
    """What gives the input of the next step, asked where the scene stands before it, and in words whose it is."""
    recorded, held = rewind.following, replace(session.inputs.now, wheel=0, changes=())
    if recorded is not None:
        return lambda: recorded, "the input is that which was recorded"
    if isinstance(session.source, BotSource):
        return lambda: BotSource().next(session.scene), "the input is the bot's"
    return lambda: held, "the input is what was held in the step before"


def photographed(world: WatchedWorld) -> dict[str, np.ndarray]:
    """Copies of the tables that a stage may write to, and of the counters."""
    found = {name: getattr(world, name).copy() for name in TABLES if name != "characters"}
    return {**found, "characters": world.characters.rows.copy(), "work": world.profile.work.copy()}


def compared(stage: Stage, before: dict[str, np.ndarray], after: dict[str, np.ndarray]) -> Done:
    """What a stage changed. Values are compared as bytes: nan is nan, and -0 is not 0."""
    work = (after["work"] - before["work"]).tolist()
    counted = {name: count for name, count in zip(COUNTERS, work, strict=True) if count}
    changed, rows = [], []
    for name in TABLES:
        old, new = before[name], after[name]
        if len(old) != len(new):
            rows.append((name, len(old), len(new)))
            continue
        by_rows: dict[int, list[str]] = {}
        for column in new.dtype.names or ():
            count = _differing(old[column], new[column])
            if count:
                by_rows.setdefault(count, []).append(column)
        changed += [(name, count, columns) for count, columns in by_rows.items()]
        if new.dtype.names is None and (count := _differing(old, new)):
            changed.append((name, count, []))
    return Done(stage, counted, changed, rows)


def _differing(old, new):
    """In how many rows two columns of one length differ."""
    if not len(new):
        return 0
    old, new = (np.ascontiguousarray(each).view(np.uint8).reshape(len(each), -1) for each in (old, new))
    return int((old != new).any(axis=1).sum())
