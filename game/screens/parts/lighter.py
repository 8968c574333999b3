"""Reduced load of a scene while kernels are not compiled yet, for scenes that would otherwise be too slow.

Too slow means fewer than ten pictures per second.
"""

from typing import Any

from game.input.devices import DeviceSource
from game.scene import Scene
from physics.jit import tiers
from physics.jit.store import store

SLOW = 0.1  # [s] of a frame
FRAMES = 2  # slow frames in a row before the load is reduced


class Lighter:
    """Temporary reduction of a scene's load by the changes in Scene.lighter, until all called kernels are compiled.

    The changes are applied before the first step if no compiled kernel is on disk. Otherwise, they are applied when
    frames are slow after loading. They are part of the next step's input, so that a recording contains them. Values
    that the player has changed in the meantime are not restored.
    """

    def __init__(self, scene: Scene, devices: DeviceSource) -> None:
        self.scene, self.devices = scene, devices
        self.slow = 0  # slow frames in a row
        self.changed: dict[str, tuple[Any, Any]] = {}  # name of a change -> (value before, applied value)
        self.begun = self.over = False
        if scene.lighter and tiers.background and store().empty:
            self._apply()

    @property
    def line(self) -> str:
        """The line of text to show while the load is reduced; "" if the load is not reduced."""
        if not self.changed:
            return ""
        less = [f"{self.scene.lighter[name]} {name}" for name in self.changed if name == "substeps"]
        if len(less) < len(self.changed):
            less.insert(0, "fewer bodies")
        return f"{' and '.join(less)} until the physics is compiled"

    def note(self, busy: float) -> None:
        """Record that a frame took `busy` [s]. Reduce the scene's load if frames are slow.

        Restore the load when all kernels are compiled.
        """
        if self.over or not self.scene.lighter:
            return
        if self.changed:
            self.begun = self.begun or bool(tiers.wanted)
            if not tiers.background or (self.begun and not tiers.wanted):
                self._undo()
            return
        loaded = tiers.load is not None  # until then, kernels on disk run plain, too
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
