"""Interface of the screen that plays a scene, as used by the panel, the keys and the status line."""

from typing import Protocol

from game.files.settings import Settings
from game.input.devices import DeviceSource
from game.measure.setting import Setting
from game.overlays.stack import Overlays
from game.run.loop import FixedStep
from game.run.session import Session
from game.scene import Scene
from game.screens.parts.cost_panel import CostPanel
from game.screens.parts.first_hint import HintCard
from game.screens.parts.lab_card import LabCard
from game.screens.parts.measuring import Measuring
from game.screens.parts.panel import Panel
from game.screens.parts.step_inspector_view import StepInspectorView
from game.screens.parts.switches import Switches
from game.screens.parts.timeline import Timeline


class Played(Protocol):
    """Screen with a scene, its clock and its overlays. `since_result`: number of steps since the game ended."""

    scene: Scene
    session: Session
    devices: DeviceSource
    overlays: Overlays
    clock: FixedStep
    measuring: Measuring
    switches: Switches
    settings: Settings | None
    timeline: Timeline | None
    step_inspector: StepInspectorView
    hint: HintCard | LabCard | None
    person: bool
    since_result: int
    wants_screenshot: bool
    helped_since: int  # the step from which the help line is shown

    @property
    def open_panel(self) -> Panel | CostPanel | None:
        """The open panel; None if none is open."""
        ...

    @property
    def news(self) -> str:
        """Line of text about the last change of a setting; "" if there is none."""
        ...

    def toggle_pause(self) -> None:
        """Pause the scene, or continue it if it is paused."""
        ...

    def single_step(self) -> None:
        """Pause the scene, and make one step."""
        ...

    def save_figures(self) -> None:
        """Save the numbers that the scene has measured as a CSV file."""
        ...

    def toggle_step_inspector(self) -> None:
        """Start the inspection of the next step, or end a running inspection."""
        ...

    def toggle_split(self) -> None:
        """Switch the split screen of a race on or off. Without a race, start one between pixels and boxes."""
        ...

    def start_race(self, setting: Setting) -> None:
        """Restart the scene in a race against a copy of the scene under the given setting."""
        ...

    def request_restart(self) -> None:
        """Restart the game. If the game has ended, show its result first, so that no score is lost."""
        ...

    def toggle_costs(self) -> None:
        """Open or close the plot of accuracy and cost."""
        ...

    def toggle_panel(self) -> None:
        """Open the side panel. If a panel is open, close it instead."""
        ...

    def switch_solver(self, way: int) -> None:
        """Change to the next solver (`way` 1) or the previous one (-1)."""
        ...

    def stop(self) -> None:
        """Open the pause menu. If the game has ended, show its result instead."""
        ...
