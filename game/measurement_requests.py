"""Measurement requests of a scene: two sprites at every tier, or worlds to step.

The results go to the scene's `figures`, by tier or by name. They are never part of its state.
"""

from collections.abc import Callable, Hashable, Sequence
from pkgutil import resolve_name
from typing import Any, NamedTuple

from physics import PixelMask, Snapshot, World

STEPS = 60  # minimum per run: one second of play. Five runs of 60 give the 300 samples of a cost


class SpriteRequest(NamedTuple):
    """Request to measure two sprites at every tier, again after each change. Figures: {tier: TierFigures}."""

    first: PixelMask
    second: PixelMask


class Recipe(NamedTuple):
    """Snapshot that is made in the measuring process, so that it costs no time in the game's frame."""

    maker: str  # "module:function", which returns a Snapshot
    arguments: tuple[Any, ...]  # its arguments: JSON values

    def make(self) -> Snapshot:
        """Make and return the snapshot."""
        return resolve_name(self.maker)(*self.arguments)


class Act(NamedTuple):
    """Operation that is timed on a world instead of its steps."""

    maker: str  # "module:function": function(world, *arguments) returns a function that is called once per step
    arguments: tuple[Any, ...]  # its arguments: JSON values

    def made_for(self, world: World) -> Callable[[], object]:
        """Return the function to call and time."""
        return resolve_name(self.maker)(world, *self.arguments)


class MeasuredRun(NamedTuple):
    """Measured run: worlds in a given state, to be stepped. It measures the cost of `name`.

    Figures: {name: RunFigures}.
    """

    snapshots: Sequence[Snapshot | Recipe]
    broadphase: str  # broad phase of all of them
    steps: int = STEPS  # steps per run
    stage: str | None = None  # measure only this stage of a step; None: the whole step
    act: Act | None = None  # replaces the steps; the first call of each run is not measured
    judged: tuple[int, int] | None = None  # steps first, last: report deepest overlap and farthest way


class RunRequest(NamedTuple):
    """Request for measured runs. make(name) returns a run; it is called once per name, and the results are cached."""

    names: Sequence[Hashable]  # numbers, words or tuples of them: runs with the same name cost the same
    make: Callable[[Hashable], MeasuredRun]


MeasurementRequest = SpriteRequest | RunRequest
