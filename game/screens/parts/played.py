"""What the panel and the status line ask of the screen on which a scene is played."""

from typing import Protocol

from game.files.settings import Settings
from game.input.devices import DeviceSource
from game.measure.setting import Setting
from game.overlays.stack import Overlays
from game.run.loop import FixedStep
from game.run.session import Session
from game.scene import Scene
from game.screens.parts.apart import Apart
from game.screens.parts.cost_panel import CostPanel
from game.screens.parts.first_hint import HintCard
from game.screens.parts.lab_card import LabCard
from game.screens.parts.measuring import Measuring
from game.screens.parts.panel import Panel
from game.screens.parts.scrub import Scrub
from game.screens.parts.switches import Switches


class Played(Protocol):
    """A scene with its clock and overlays; `since_result`: steps since the game has ended."""

    scene: Scene
    session: Session
    devices: DeviceSource
    overlays: Overlays
    clock: FixedStep
    measuring: Measuring
    switches: Switches
    settings: Settings | None
    scrub: Scrub | None
    apart: Apart
    hint: HintCard | LabCard | None
    person: bool
    since_result: int
    wants_screenshot: bool
    helped_since: int  # the step from which the keys are shown

    @property
    def open_panel(self) -> Panel | CostPanel | None:
        """The panel that is open, else None."""
        ...

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

    def take_apart(self) -> None:
        """Go into the next step, or out of it."""
        ...

    def start_race(self, setting: Setting) -> None:
        """From the start, against the same scene under another setting."""
        ...

    def wish_restart(self) -> None:
        """Restart, if nothing is lost by it."""
        ...

    def toggle_costs(self) -> None:
        """Open or close the plot of what accuracy costs."""
        ...

    def toggle_panel(self) -> None:
        """Open the panel, or close what is open."""
        ...

    def switch_solver(self, way: int) -> None:
        """The next solver, or the one before."""
        ...

    def stop(self) -> None:
        """To the pause menu, or to where a run ends."""
        ...
