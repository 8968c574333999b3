"""What the panel and the status line ask of the screen on which a scene is played."""

from typing import Protocol

from game.files.settings import Settings
from game.input.devices import DeviceSource
from game.overlays.stack import Overlays
from game.run.loop import FixedStep
from game.run.session import Session
from game.scene import Scene
from game.screens.parts.first_hint import HintCard


class Played(Protocol):
    """A scene with its clock and overlays; `since_result`: steps since the game has ended."""

    scene: Scene
    session: Session
    devices: DeviceSource
    overlays: Overlays
    clock: FixedStep
    settings: Settings | None
    hint: HintCard | None
    person: bool
    panel_open: bool
    since_result: int
    helped_since: int  # the step from which the keys are shown

    @property
    def news(self) -> str:
        """What was just switched, or ""."""
        ...

    def toggle_pause(self) -> None:
        """Stop or go on."""
        ...

    def single_step(self) -> None:
        """Pause, and make one step."""
        ...

    def wish_restart(self) -> None:
        """Restart, if nothing is lost by it."""
        ...

    def switch_solver(self, way: int) -> None:
        """The next solver, or the one before."""
        ...

    def switch_broadphase(self, way: int) -> None:
        """The next broad phase, or the one before."""
        ...

    def switch_tier(self, way: int) -> None:
        """The next tier, or the one before."""
        ...

    def switch_narrowphase(self) -> None:
        """Stop at boxes, or do not."""
        ...
