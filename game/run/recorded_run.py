"""Recorded runs: a scene is played again from its inputs, with its rules, under any setting that it supports.

Advice on a scene is based on three measurements of such a run. The first is the busiest second of the run. The second
is the encounters of its bodies under every collision tier (kind of collision shape). The third is the time of its steps
under a setting.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from importlib import import_module
from itertools import islice, repeat
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from game.drawing.number_text import plain_name
from game.input.inputs import InputFrame, InputState
from game.measure.errors import Verdicts, exact_tier, pairs_of
from game.measure.moment import Moment, here_of
from game.measure.setting import Setting
from game.measure.timing import undisturbed
from game.run.replay import Recorder
from game.scene import SUBSTEPS, Scene
from physics import TIERS

SECOND = 60  # steps
STRATA = 4  # equal parts of a run; a moment is taken in the middle of each
LOOK_EVERY = 6  # steps between two looks at the touching pairs
WORK = ("bodies_integrated", "candidates", "contacts")  # counters that measure the work of a step
Changes = Sequence[tuple[str, Any]]


class RecordedRun(NamedTuple):
    """The inputs of a run, and the arguments with which the scene is created."""

    scene: str  # "module:class"
    arguments: tuple[Any, ...]  # seed, broad phase, solver, tier, path of the level file or None
    inputs: tuple[tuple[int, InputFrame], ...]  # (number of steps, the input of each)

    @classmethod
    def of(cls, scene: Scene, recorder: Recorder) -> "RecordedRun":
        """Return the run of a scene that a recorder has recorded so far."""
        head, level = recorder.head, scene.level_file
        arguments = (head["seed"], head["broadphase"], head["solver"], head["tier"], level and str(level))
        inputs = tuple((count, frame) for count, frame in recorder.runs)
        return cls(f"{type(scene).__module__}:{type(scene).__qualname__}", arguments, inputs)

    @property
    def steps(self) -> int:
        """Number of recorded steps."""
        return sum(count for count, _ in self.inputs)

    def make(self) -> Scene:
        """Return a new scene at the start of the run. Raises ValueError if the scene's class cannot be found."""
        module, name = self.scene.split(":")
        found: Any = import_module(module)
        for part in name.split("."):
            found = getattr(found, part, None)
        if found is None:
            raise ValueError(f"there is no scene {self.scene}")
        *first, level = self.arguments
        return found(*first, level and Path(level))

    def frames(self) -> Iterator[InputFrame]:
        """Yield the input of each recorded step."""
        for count, frame in self.inputs:
            yield from repeat(frame, count)

    def continues(self, other: "RecordedRun", steps: int) -> bool:
        """Return whether the first `steps` steps of this run are the same as those of `other`."""
        pairs = islice(zip(self.frames(), other.frames(), strict=False), steps)
        same = (self.scene, self.arguments) == (other.scene, other.arguments)
        return same and self.steps >= steps and all(a == b for a, b in pairs)

    def play(self, changes: Changes = ()) -> Iterator[Scene]:
        """Play the run, and yield the scene after each step. changes: see Player."""
        player = Player(self, changes)
        for frame in self.frames():
            player.step(frame)
            yield player.scene


class Player:
    """Player of a scene with recorded inputs.

    changes: (name, value) pairs for Scene.change(), applied before the first step. Changes of the same names in the
    recorded inputs are ignored.
    """

    def __init__(self, run: RecordedRun, changes: Changes = ()) -> None:
        self.scene, self.state, self.fixed = run.make(), InputState(), {name for name, _ in changes}
        for name, value in changes:
            self.scene.change(name, value)

    def step(self, frame: InputFrame) -> None:
        """Make one step with the input `frame`."""
        self.state.set(replace(frame, changes=tuple(each for each in frame.changes if each[0] not in self.fixed)))
        self.scene.step(self.state)
        self.scene.observe()


def changes_to(setting: Setting, scene: Scene) -> Changes | str:
    """Return the changes that give a scene the setting `setting`, a list of (name, value).

    If this is impossible, return a sentence with the reason instead.
    """
    changes = []
    for name in setting.differs(here_of(scene.views()[0][0], scene.tier)):
        change = _change(scene, name, getattr(setting, name))
        if isinstance(change, str):
            return change
        changes += change
    return changes


def _change(scene, name, value):
    """Return the changes for one field of a setting, a list of (name, value).

    If the scene cannot be changed in this way, return a sentence with the reason instead.
    """
    if value is None:
        return []
    if name == "broadphase" and not scene.switches_broadphase:
        return "each world here has a broad phase of its own"
    if name == "solver" and value not in scene.solver_choices():
        slider = next((each for each in scene.sliders if each.name == "solver" and value in each.choices), None)
        if slider is None:
            return f"each world here has a solver of its own: {plain_name(value)} is only measured"
        return [("slider:solver", slider.low + slider.choices.index(value))]
    if name == "tier" and value not in scene.tiers:
        return f"this scene does not play with the tier {value}: it is only measured"
    if name == "joint_solver":
        return f"this scene chooses how its joints are solved: {value} is only measured"
    if name == "substeps" and value not in SUBSTEPS:
        return f"{value} substeps are those that the scene began with: restart it"
    return [(name, value)]


class Overview(NamedTuple):
    """Result of look_over(): snapshots to measure from, the busiest second, and the encounters of bodies."""

    moments: list[Moment]  # in the middle of each of STRATA parts, and at the start of the busiest second
    at: list[int]  # the steps after which they were taken
    busiest: int  # the step after which the busiest second begins
    encounters: dict[str, Verdicts]  # by tier, over the whole run; {} for a scene without tiers


class Encounters:
    """The pairs of bodies that have met in a run so far. They are counted for every collision tier.

    A collision tier is a kind of collision shape, so different tiers may report different pairs.
    """

    def __init__(self) -> None:
        self.met: dict[str, set[tuple[int, int]]] = {}
        self.exact = ""  # the tier whose answers are right

    def look(self, scene: Scene) -> None:
        """Add the pairs of bodies that touch now in the scene's first visible world, for every collision tier."""
        moment = moment_of(scene)
        self.exact = exact_tier(moment.here.tier or "")
        for tier in TIERS:
            world = moment.world(moment.here._replace(tier=tier, narrowphase=True))
            world.step(0.0)
            self.met.setdefault(tier, set()).update(pairs_of(world))

    def verdicts(self) -> dict[str, Verdicts]:
        """Return {tier: Verdicts} for every collision tier (kind of collision shape); {} before the first look().

        Verdicts contains the pairs that this tier reported and the pairs that the exact tier reported.
        """
        true = frozenset(self.met.get(self.exact, ()))
        return {tier: Verdicts(frozenset(pairs), true, tier == self.exact) for tier, pairs in self.met.items()}


def moment_of(scene: Scene) -> Moment:
    """Return a snapshot of the scene's first visible world, from which measurements can start, as a Moment."""
    world = scene.views()[0][0]
    return Moment(world.snapshot(), world.broadphase.name)


def look_over(run: RecordedRun) -> Overview:
    """Return the Overview of a run. For this, the run is played twice.

    The first pass finds the busiest second. The second pass takes snapshots and counts the encounters of bodies. Raises
    ValueError for a run without steps.
    """
    if not run.steps:
        raise ValueError("a run must have a step at least (got none)")
    work = np.array([_work_of(scene) for scene in run.play()])
    most = busiest(work)
    wanted = sorted({max(1, (2 * part + 1) * run.steps // (2 * STRATA)) for part in range(STRATA)} | {most})
    moments, encounters = [], Encounters()
    for step, scene in enumerate(run.play(), 1):
        if step in wanted:
            moments.append(moment_of(scene))
        if scene.tier is not None and step % LOOK_EVERY == 0:
            encounters.look(scene)
    return Overview(moments, wanted, most, encounters.verdicts())


def _work_of(scene):
    return sum(int(world.profile.counters[name]) for world in scene.worlds for name in WORK)


def busiest(work: np.ndarray) -> int:
    """Return the number of the step after which the busiest second begins.

    The busiest second is the SECOND consecutive steps with the most work. work: (steps,) work of each step. For a run
    of up to a second, the result is the first step.
    """
    if len(work) <= SECOND:
        return 1
    sums = np.convolve(work, np.ones(SECOND), "valid")
    return max(1, int(np.argmax(sums)))


def seconds_of_steps(run: RecordedRun, changes: Changes) -> np.ndarray:
    """Play a run with the given changes, and return the time [s] of the physics in each step: (steps,)."""
    with undisturbed():
        spent = [sum(sum(w.profile.stages.values()) for w in scene.worlds) for scene in run.play(changes)]
    return np.array(spent)
