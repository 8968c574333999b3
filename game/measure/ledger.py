"""Ledger of a scene's effects: the change that each effect makes in a run of the bot, and the time it adds to a step.

Two copies of the scene run side by side with the same input, one with the effect and one without it. A declared effect
is removed together with all effects that need it. An undeclared effect is added to one copy, after the effects that it
needs were added to both. Both copies then have neutral settings (gravity 0, friction 0 and so on), so that the added
effect does nothing. The run must not change, and the extra time is the price of declaring the effect.
"""

from collections.abc import Callable
from dataclasses import fields
from itertools import pairwise
from math import sqrt
from statistics import median
from typing import Any, NamedTuple

import numpy as np

from game.input.inputs import InputFrame, InputState
from game.scene import Scene
from physics import Effects, World
from physics.tables.body import CONTINUOUS

EFFECTS = tuple(field.name for field in fields(Effects))
AFTER = 120  # frames that a run continues after the two copies differ: two seconds
REPORTED = ("begin", "persist", "end", "hits", "sensor_begin", "sensor_end")
WORK = ("bodies_integrated", "narrow_tests", "solver_rows")  # counters that measure the amount of work
# These effects have no neutral value: adding one may change the run, and the change is reported.
NEVER_NEUTRAL = ("narrowphase", "response", "stacking", "rotation", "sleeping")


class Entry(NamedTuple):
    """Result for one effect of one scene, from a copy with the effect and a copy without it.

    The fields `moved`, `reported`, `ruled` and `parted` are numbers of frames, counted from 1. Each is the first frame
    in which the copies differ: in their bodies, their events, the state of their rules, or their digests. It is None if
    they never differ.
    """

    effect: str
    declared: bool
    changed: tuple[str, ...]  # declared: the effects removed, this one first; undeclared: this effect
    refused: str  # reason why the scene cannot be built or run without it; "" if it can
    moved: int | None  # frame after which poses, velocities or body ids differ
    reported: int | None  # frame after which the events differ
    ruled: int | None  # frame after which the scene's own state differs
    parted: int | None  # frame after which the digests differ
    # [px] root mean square distance of the bodies in both copies, AFTER frames after they differ, or at the end
    apart: float
    worked: int  # bodies moved, pairs tested and rows solved in the run with it …
    worked_without: int  # … and without it
    cost: float  # [s] median over the steps of the extra time with it; negative if it saves time
    worst: float = 0.0  # [px] greatest of the distances whose root mean square is `apart`
    p99: float = 0.0  # [px] 99th percentile of them, over the bodies

    @property
    def matters(self) -> bool:
        """Whether the effect changes the run, or the scene cannot run without it.

        The effect `sleeping` matters if it saves work.
        """
        if self.refused:
            return True
        if self.effect == "sleeping":
            return self.worked < self.worked_without
        return any(frame is not None for frame in (self.moved, self.reported, self.ruled))


def entry(scene_class: type[Scene], effect: str, frames: int, after: int = AFTER, seed: int = 1) -> Entry:
    """Run a scene with and without an effect, for at most `frames` frames. Return the differences as an Entry.

    after: number of further frames after the two copies first differ; seed: seed of the scene. Raises ValueError for a
    scene that cannot be built with all its declared effects.
    """
    declared = getattr(scene_class.effects, effect)
    if declared:
        one = scene_class
        left = scene_class.effects.without(effect)
        changed = (
            effect,
            *(name for name in scene_class.effects.names() if name != effect and not getattr(left, name)),
        )
        other = variant(scene_class, left)
    else:
        needed, changed = scene_class.effects.and_needed(effect), (effect,)
        one = variant(scene_class, needed.with_(**{effect: True}), effect)
        other = variant(scene_class, needed, effect)
    blank = Entry(effect, declared, changed, "", None, None, None, None, 0.0, 0, 0, 0.0)
    return _compared(Side(one, seed), other, blank, frames, after)


def _compared(one, other_class, found, frames, after):
    """Run both copies of the scene frame by frame. Return the Entry `found` with its measured fields filled in.

    one: Side of the first copy; other_class: scene class of the second copy; frames: greatest number of frames; after:
    number of further frames after the two copies first differ.
    """
    try:
        other = Side(other_class, one.scene.seed)
    except ValueError as error:
        return found._replace(refused=str(error))
    firsts: dict[str, int | None] = dict.fromkeys(("moved", "reported", "ruled", "parted"))
    costs, known = [], frames
    for frame in range(1, frames + 1):
        keys = one.bot()
        try:
            for side in (one, other) if frame % 2 else (other, one):  # the first to step finds cold caches
                side.step(keys)
        except ValueError as error:
            if side is one:
                raise
            return found._replace(refused=str(error))
        costs.append(one.seconds - other.seconds)
        for name in [name for name, first in firsts.items() if first is None]:
            if getattr(one, name)() != getattr(other, name)():
                firsts[name] = frame
        now = found._replace(**firsts, worked=one.worked, worked_without=other.worked)
        if now.matters if found.declared else now.parted is not None:
            known = min(known, frame)
        if frame >= known + after:
            break
    apart, p99, worst = distances(one.scene, other.scene)
    cost = median((a + b) / 2 for a, b in pairwise(costs)) if len(costs) > 1 else 0.0
    ran = {"worked": one.worked, "worked_without": other.worked, "cost": cost}
    return found._replace(**firsts, **ran, apart=apart, worst=worst, p99=p99)


class Side:
    """One of the two copies of a scene that run side by side, with an effect or without it.

    seconds: time of the worlds' stages in the last step; worked: sum of the counters WORK over all steps.
    """

    def __init__(self, scene_class: type[Scene], seed: int) -> None:
        self.scene = scene_class(seed)
        self.inputs = InputState()
        self.seconds, self.worked = 0.0, 0

    def bot(self) -> InputFrame:
        """Return the input of the scene's bot for the next step."""
        played = self.scene.bot()
        return played if isinstance(played, InputFrame) else InputFrame(frozenset(played))

    def step(self, keys: InputFrame) -> None:
        """Run one step with the input `keys`. Raises ValueError if the scene uses an effect that is not declared."""
        self.inputs.set(keys)
        self.scene.step(self.inputs)
        self.seconds = sum(sum(world.profile.stages.values()) for world in self.scene.worlds)
        self.worked += sum(world.profile.counters[name] for world in self.scene.worlds for name in WORK)

    def moved(self) -> list[Any]:
        """Return the ids, poses and velocities of all bodies as bytes, to be compared with those of the other copy."""
        return [
            world.bodies[name].tobytes()
            for world in self.scene.worlds
            for name in ("id", "x", "y", "angle", "vx", "vy")
        ]

    def reported(self) -> list[Any]:
        """Return the events of the last step, each table as bytes, to be compared with those of the other copy."""
        return [
            np.ascontiguousarray(getattr(world.events, name)).tobytes()
            for world in self.scene.worlds
            for name in REPORTED
        ]

    def ruled(self) -> tuple[Any, ...]:
        """Return the state of the scene's rules, without the state of its worlds."""
        return self.scene.state()

    def parted(self) -> list[Any]:
        """Return the whole state to compare: digests of the worlds, the scene's own state, and its random numbers."""
        return [*(world.digest() for world in self.scene.worlds), self.scene.state(), self.scene.random.getstate()]


def distances(one: Scene, other: Scene) -> tuple[float, float, float]:
    """Return the distances [px] between the same bodies in two copies of a scene: (root mean square, p99, greatest).

    Only bodies that exist in both copies (same world and id) are compared. The results are 0 if there are none. p99 is
    the 99th percentile over the bodies.
    """
    gaps = []
    for ours, theirs in zip(one.worlds, other.worlds, strict=False):
        a, b = ours.bodies, theirs.bodies
        _, rows_a, rows_b = np.intersect1d(a["id"], b["id"], return_indices=True)
        gaps.append(np.hypot(*(a[name][rows_a] - b[name][rows_b] for name in ("center_x", "center_y"))))
    together = np.concatenate(gaps) if gaps else np.zeros(0)
    if not len(together):
        return 0.0, 0.0, 0.0
    return sqrt(float((together**2).mean())), float(np.percentile(together, 99)), float(together.max())


def variant(scene_class: type[Scene], effects: Effects, idle: str | None = None) -> type[Scene]:
    """Return a subclass of the scene class that declares the effects `effects` instead.

    idle: effect whose settings are made neutral before each step, so that it does nothing; None for no such effect.
    """
    defined: dict[str, Any] = {"effects": effects}
    neutral = NEUTRAL.get(idle or "")
    if neutral is not None:

        def add_world(self, *arguments, **settings):
            world = scene_class.add_world(self, *arguments, **settings)
            step = world.step

            def idle_step(dt=None):
                neutral(world)
                step(dt)

            world.step = idle_step
            return world

        defined["add_world"] = add_world
    return type(scene_class.__name__, (scene_class,), defined)


def _no_gravity(world: World) -> None:
    world.gravity = 0.0, 0.0


def _no_drag(world: World) -> None:
    world.drag = 0.0


def _no_wind(world: World) -> None:
    world.wind = 0.0, 0.0


def _smooth(world: World) -> None:
    world.shapes["friction"] = world.shapes["rolling_resistance"] = 0.0


def _dull(world: World) -> None:
    world.shapes["restitution"] = 0.0


def _standing(world: World) -> None:
    world.shapes["surface_speed"] = 0.0


def _not_swept(world: World) -> None:
    world.bodies["continuous"] = CONTINUOUS.index("off")
    world.bodies["bullet"] = False


# The other effects (sensors, persist, one_way, carving) have nothing to do in a scene that does not declare them.
NEUTRAL: dict[str, Callable[[World], None]] = {
    "gravity": _no_gravity,
    "drag": _no_drag,
    "wind": _no_wind,
    "friction": _smooth,
    "restitution": _dull,
    "conveyor": _standing,
    "continuous": _not_swept,
}
