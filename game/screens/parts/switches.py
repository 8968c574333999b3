"""Switches of a running scene, operated with keys or the panel, and the line of text about the last change."""

from collections.abc import Sequence
from typing import Any

from game.drawing.number_text import plain_name
from game.input.devices import DeviceSource
from game.run.outcome import solver_name
from game.scene import SUBSTEPS, Scene
from physics import BROADPHASES

REPORT_SECONDS = 2.5  # duration of the line about a switch


class Switches:
    """Switches for the simulation of a scene. A change is input of the next step, so that a recording contains it.

    The argument `way` is 1 for the next choice, and -1 for the previous one.
    """

    def __init__(self, scene: Scene, devices: DeviceSource) -> None:
        self.scene, self.devices = scene, devices
        self.now = 0.0  # [s]
        self.reported: tuple[str, float] = ("", 0.0)  # last switch, and the end of its line [s]

    def solver(self, way: int) -> None:
        """Change to the next solver (`way` 1) or the previous one (-1)."""
        choices = self.scene.solver_choices()
        if choices:
            name = following(choices, solver_name(self.scene), way)
            self._switch("solver", "solver", name, solver_name(self.scene))
        elif self.scene.effects.response:
            self.report("each world here has a solver of its own")
        else:
            self.report("nothing is pushed here: there is no solver to switch")

    def broadphase(self, way: int) -> None:
        """Change to the next broad phase (`way` 1) or the previous one (-1)."""
        if self.scene.switches_broadphase:
            name = following(tuple(BROADPHASES), self.scene.broadphase, way)
            self._switch("broadphase", "broad phase", name, self.scene.broadphase)
        else:
            self.report("each world here has a broad phase of its own")

    def substeps(self, way: int) -> None:
        """Change to the next number of substeps in SUBSTEPS (`way` 1) or the previous one (-1)."""
        now = self.scene.worlds[0].substeps
        self._switch("substeps", "substeps", following(SUBSTEPS, now, way), now)

    def tier(self, way: int) -> None:
        """Change to the next tier (kind of collision shape) of all sprites (`way` 1) or the previous one (-1)."""
        if self.scene.tiers:
            self._switch("tier", "tested as", following(self.scene.tiers, self.scene.tier, way), self.scene.tier)
        else:
            self.report("no sprites here that could be tested as another shape")

    def narrowphase(self) -> None:
        """Switch the narrow phase on or off. Without a narrow phase, two bounding boxes that overlap count as a hit."""
        on = not self.scene.narrowphase
        self.devices.change("narrowphase", on)
        self.report("narrow phase: on, was off" if on else "narrow phase: off, was on: boxes that meet are a hit")

    def _switch(self, change, what, new, old):
        self.devices.change(change, new)
        self.report(f"{what}: {plain_name(str(new))}, was {plain_name(str(old or 'none'))}")

    def report(self, line: str) -> None:
        """Show a line of text for the next REPORT_SECONDS."""
        self.reported = line, self.now + REPORT_SECONDS

    @property
    def news(self) -> str:
        """Line of text about the last change; "" after REPORT_SECONDS have passed."""
        return self.reported[0] if self.now < self.reported[1] else ""


def following(names: Sequence[Any], name: Any, way: int) -> Any:
    """Return the element `way` places after `name` in `names`, cyclically.

    If `name` is missing, return the first element.
    """
    return names[(names.index(name) + way) % len(names)] if name in names else names[0]
