"""What a scene wants to have measured beside the game: two sprites at every tier, or lanes of worlds to be stepped.

What was found comes into its `figures`, by tier or by the name of the lane. It is never part of its state.
"""

from collections.abc import Callable, Hashable, Sequence
from pkgutil import resolve_name
from typing import Any, NamedTuple

from physics import PixelMask, Snapshot, World

STEPS = 60  # of a run, at least: a second of play, five times 60 make the 300 that a cost is measured on


class Sprites(NamedTuple):
    """Every tier of these two; each change of them is measured anew. Figures: {tier: TierFigures}."""

    first: PixelMask
    second: PixelMask


class Recipe(NamedTuple):
    """A snapshot that is made where it is measured, not on the frame of who asks for it."""

    maker: str  # "module:function", which returns a Snapshot
    arguments: tuple[Any, ...]  # of it: what JSON can hold

    def make(self) -> Snapshot:
        """The snapshot."""
        return resolve_name(self.maker)(*self.arguments)


class Act(NamedTuple):
    """What is done to a world in place of its steps."""

    maker: str  # "module:function": function(world, *arguments) returns what is called once for each step
    arguments: tuple[Any, ...]  # of it: what JSON can hold

    def made_for(self, world: World) -> Callable[[], object]:
        """What is to be called, and timed."""
        return resolve_name(self.maker)(world, *self.arguments)


class Lane(NamedTuple):
    """Worlds, as they are at one moment, to be stepped on: what costs `name`. Figures: {name: LaneFigures}."""

    snapshots: Sequence[Snapshot | Recipe]
    broadphase: str  # the strategy of all of them
    steps: int = STEPS  # that each is stepped in a run
    stage: str | None = None  # only this stage of a step is counted; None: the whole step
    act: Act | None = None  # in place of steps; one of each comes first in a run and is not counted
    judged: tuple[int, int] | None = None  # first and last step whose deepest overlap and farthest way are wanted


class Lanes(NamedTuple):
    """make(name): what is to be stepped, asked once of each name that is not known yet; the others are remembered."""

    names: Sequence[Hashable]  # numbers, words, tuples of them: two lanes of one name cost the same
    make: Callable[[Hashable], Lane]
