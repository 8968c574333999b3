"""Fewer bodies while the physics is not compiled, where plain kernels would show fewer than ten pictures a second."""

from game.input.devices import DeviceSource
from game.scene import Scene
from physics.jit import tiers

SLOW = 0.1  # [s] of a frame
FRAMES = 2  # that are slow one after the other before there are fewer bodies
LINE = "fewer bodies until the physics is compiled"


class Lighter:
    """Turns the sliders of Scene.lighter, and turns them back when all that was called runs compiled.

    Both go in as input of the next step, so that a recording holds them. A slider that the player has turned since
    stays where it is.
    """

    def __init__(self, scene: Scene, devices: DeviceSource) -> None:
        self.scene, self.devices = scene, devices
        self.slow = 0  # frames in a row
        self.turned: dict[str, tuple[float, float]] = {}  # slider -> its value before, and the one it was given

    @property
    def line(self) -> str:
        """The line to be shown meanwhile; "" where nothing was turned."""
        return LINE if self.turned else ""

    def note(self, busy: float) -> None:
        """Take note of how long [s] a frame took."""
        if self.turned:
            if not tiers.wanted:
                self._turn_back()
            return
        self.slow = self.slow + 1 if busy > SLOW else 0
        if self.slow >= FRAMES and self.scene.lighter and tiers.wanted:
            for name, value in self.scene.lighter.items():
                if self.scene.values[name] != value:
                    self.turned[name] = (self.scene.values[name], value)
                    self.devices.change(f"slider:{name}", value)

    def _turn_back(self):
        for name, (before, given) in self.turned.items():
            if self.scene.values[name] == given:
                self.devices.change(f"slider:{name}", before)
        self.turned.clear()
