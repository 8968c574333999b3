"""What a player may switch in a running scene, by key or panel, and the line that tells what was switched."""

from collections.abc import Sequence
from typing import Any

from game.drawing.number_text import plain_name
from game.input.devices import DeviceSource
from game.run.outcome import solver_name
from game.scene import SUBSTEPS, Scene
from physics import BROADPHASES

TOLD_SECONDS = 2.5  # how long a line stays about what was switched


class Switches:
    """Every switch goes in as input of the next step, so that a recording holds it.

    way: 1 the next, -1 the one before.
    """

    def __init__(self, scene: Scene, devices: DeviceSource) -> None:
        self.scene, self.devices = scene, devices
        self.now = 0.0  # [s]
        self.told: tuple[str, float] = ("", 0.0)  # what was switched, and when it is no longer told [s]

    def solver(self, way: int) -> None:
        """How overlaps are resolved."""
        choices = self.scene.solver_choices()
        if choices:
            name = following(choices, solver_name(self.scene), way)
            self._switch("solver", "solver", name, solver_name(self.scene))
        elif self.scene.effects.response:
            self.tell("each world here has a solver of its own")
        else:
            self.tell("nothing is pushed here: there is no solver to switch")

    def broadphase(self, way: int) -> None:
        """How pairs that may touch are found."""
        if self.scene.switches_broadphase:
            name = following(tuple(BROADPHASES), self.scene.broadphase, way)
            self._switch("broadphase", "broad phase", name, self.scene.broadphase)
        else:
            self.tell("each world here has a broad phase of its own")

    def substeps(self, way: int) -> None:
        """How often a step looks at its contacts."""
        now = self.scene.worlds[0].substeps
        self._switch("substeps", "substeps", following(SUBSTEPS, now, way), now)

    def tier(self, way: int) -> None:
        """The shape that sprites are tested as."""
        if self.scene.tiers:
            self._switch("tier", "tested as", following(self.scene.tiers, self.scene.tier, way), self.scene.tier)
        else:
            self.tell("no sprites here that could be tested as another shape")

    def narrowphase(self) -> None:
        """Stop at boxes, or do not."""
        on = not self.scene.narrowphase
        self.devices.change("narrowphase", on)
        self.tell("narrow phase: on, was off" if on else "narrow phase: off, was on: boxes that meet are a hit")

    def _switch(self, change, what, new, old):
        self.devices.change(change, new)
        self.tell(f"{what}: {plain_name(str(new))}, was {plain_name(str(old or 'none'))}")

    def tell(self, line: str) -> None:
        """Show a line for a while."""
        self.told = line, self.now + TOLD_SECONDS

    @property
    def news(self) -> str:
        """One line about what was just switched, "" when that is long ago."""
        return self.told[0] if self.now < self.told[1] else ""


def following(names: Sequence[Any], name: Any, way: int) -> Any:
    """The name `way` places on, around the end; the first one where none is chosen yet."""
    return names[(names.index(name) + way) % len(names)] if name in names else names[0]
