"""Rumble: vibration of the controllers when a scene plays certain sounds."""

from game.files.settings import Settings
from game.input.pads import Pads
from game.scene import Scene

RUMBLES = {"hurt": (0.5, 0.8, 200), "big_explosion": (0.4, 0.4, 150), "bomb": (0.8, 0.5, 300)}  # low, high 0..1, [ms]


def rumble(scene: Scene, pads: Pads | None, settings: Settings | None) -> None:
    """Make the controllers vibrate if a sound cue of the last step is in RUMBLES and the settings allow it.

    pads, settings: None disables the vibration.
    """
    if pads is None or settings is None or not settings.rumble:
        return
    for name, _, _ in scene.cues:
        if name in RUMBLES:
            pads.rumble(*RUMBLES[name])
