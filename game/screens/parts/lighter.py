"""Less to compute until the physics is compiled, where plain kernels would show fewer than ten pictures a second."""

from typing import Any

from game.input.devices import DeviceSource
from game.scene import Scene
from physics.jit import tiers
from physics.jit.store import store

SLOW = 0.1  # [s] of a frame
FRAMES = 2  # that are slow one after the other before there is less to compute


class Lighter:
    """Applies the changes of Scene.lighter, and undoes them once when all that was called runs compiled.

    They are applied before the first step where no kernel at all is on disk, else when frames are slow after what is on
    disk was loaded. Both ways they go in as input of the next step, so that a recording holds them. What the player has
    changed since stays as it is.
    """

    def __init__(self, scene: Scene, devices: DeviceSource) -> None:
        self.scene, self.devices = scene, devices
        self.slow = 0  # frames in a row
        self.changed: dict[str, tuple[Any, Any]] = {}  # name of a change -> the value before, and the one applied
        self.begun = self.over = False
        if scene.lighter and tiers.background and store().empty:
            self._apply()

    @property
    def line(self) -> str:
        """The line to be shown meanwhile: what there is less of; "" where nothing was changed."""
        if not self.changed:
            return ""
        less = [f"{self.scene.lighter[name]} {name}" for name in self.changed if name == "substeps"]
        if len(less) < len(self.changed):
            less.insert(0, "fewer bodies")
        return f"{' and '.join(less)} until the physics is compiled"

    def note(self, busy: float) -> None:
        """Take note of how long [s] a frame took."""
        if self.over or not self.scene.lighter:
            return
        if self.changed:
            self.begun = self.begun or bool(tiers.wanted)
            if not tiers.background or (self.begun and not tiers.wanted):
                self._undo()
            return
        loaded = tiers.load is not None  # until then kernels that are on disk run plain too
        self.slow = self.slow + 1 if loaded and tiers.wanted and busy > SLOW else 0
        if self.slow >= FRAMES:
            self._apply()

    def _apply(self):
        for name, value in self.scene.lighter.items():
            if self._now(name) != value:
                self.changed[name] = (self._now(name), value)
                self.devices.change(_change(name), value)

    def _undo(self):
        for name, (before, given) in self.changed.items():
            if self._now(name) == given:
                self.devices.change(_change(name), before)
        self.changed.clear()
        self.over = True

    def _now(self, name):
        return self.scene.worlds[0].substeps if name == "substeps" else self.scene.values[name]


def _change(name):
    return name if name == "substeps" else f"slider:{name}"
