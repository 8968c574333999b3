"""Measurement requests of a scene: sprites to compare at every collision tier, or worlds whose steps are timed.

A collision tier is a kind of collision shape. The results are stored in the scene's `figures`, by tier or by name. They
are not part of the scene's state.
"""

from collections.abc import Callable, Hashable, Sequence
from pkgutil import resolve_name
from typing import Any, NamedTuple

from physics import PixelMask, Snapshot, World

STEPS = 60  # least number of steps in a run: one second of play. Five runs give the 300 samples of a cost


class SpriteRequest(NamedTuple):
    """Request to measure two sprites at every collision tier (kind of collision shape).

    The sprites are measured again when either of them changes. The results are {tier: TierFigures}.
    """

    first: PixelMask
    second: PixelMask


class Recipe(NamedTuple):
    """Function and arguments that create a snapshot. The measuring process calls it, so that the game does not wait."""

    maker: str  # "module:function", which returns a Snapshot
    arguments: tuple[Any, ...]  # its arguments: JSON values

    def make(self) -> Snapshot:
        """Call the function, and return the Snapshot that it creates."""
        return resolve_name(self.maker)(*self.arguments)


class Act(NamedTuple):
    """Operation on a world that is timed instead of the world's steps."""

    maker: str  # "module:function": function(world, *arguments) returns a function that is called once per step
    arguments: tuple[Any, ...]  # its arguments: JSON values

    def made_for(self, world: World) -> Callable[[], object]:
        """Return a function without arguments that performs the operation on `world`.

        The calls of this function are timed.
        """
        return resolve_name(self.maker)(world, *self.arguments)


class MeasuredRun(NamedTuple):
    """Run whose time is measured: worlds are restored from snapshots and stepped.

    The result is a RunFigures, which is stored in the scene's `figures` under the name of the run.
    """

    snapshots: Sequence[Snapshot | Recipe]
    broadphase: str  # broad phase of all worlds
    steps: int = STEPS  # steps per run
    stage: str | None = None  # measure only this stage of a step; None: the whole step
    act: Act | None = None  # replaces the steps; the first call of each run is not measured
    judged: tuple[int, int] | None = None  # (first, last) step at which overlap and motion are measured


class RunRequest(NamedTuple):
    """Request for measured runs.

    names: the names of the runs; make(name): function that returns the MeasuredRun of a name. make() is called once per
    name.
    """

    names: Sequence[Hashable]  # numbers, words or tuples of them: runs with the same name cost the same
    make: Callable[[Hashable], MeasuredRun]


MeasurementRequest = SpriteRequest | RunRequest
