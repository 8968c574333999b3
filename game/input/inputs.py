"""The input of one step, from any source.

Devices, bots, scripts and recordings all produce InputFrames; a scene reads only an InputState. So a replay takes the
same path as a keyboard. Changes (a moved slider, another broad phase) are part of the frame, too, because they change
the simulation and a recording must contain them.
"""

from dataclasses import dataclass

ACTIONS = ("left", "right", "up", "down", "fire", "focus", "jump", "bomb", "confirm", "cancel", "pause")
CHANGES = ("broadphase", "solver", "substeps", "tier", "narrowphase", "restart")  # and "slider:<name>", "assist:<name>"


@dataclass(frozen=True)
class InputFrame:
    """The input of one step. pointer: (x, y) [canvas px]; changes: (name, value) pairs, in order."""

    actions: frozenset = frozenset()
    pointer: tuple = (0, 0)
    pointer_down: bool = False
    wheel: int = 0
    changes: tuple = ()


NOTHING = InputFrame()


class InputState:
    """The input of the current step and of the step before."""

    def __init__(self) -> None:
        self.now = self.before = NOTHING

    def set(self, frame: InputFrame) -> None:
        """Advance by one step, whose input is `frame`."""
        self.before, self.now = self.now, frame

    def held(self, action: str) -> bool:
        """Return whether the action is held.

        Raises ValueError for an unknown action, so that no typo reads as "not held".
        """
        return _known(action) in self.now.actions

    def pressed(self, action: str) -> bool:
        """Return whether the action is held in this step, and was not in the step before."""
        return _known(action) in self.now.actions and action not in self.before.actions

    def released(self, action: str) -> bool:
        """Return whether the action was held in the step before, and is not in this step."""
        return _known(action) not in self.now.actions and action in self.before.actions

    @property
    def pointer(self) -> tuple[int, int]:
        """(x, y) of the pointer in canvas pixels."""
        return self.now.pointer

    @property
    def pointer_down(self) -> bool:
        """True while the pointer's button is held."""
        return self.now.pointer_down

    @property
    def pointer_pressed(self) -> bool:
        """True in the step in which the pointer's button goes down."""
        return self.now.pointer_down and not self.before.pointer_down

    @property
    def wheel(self) -> int:
        """Notches by which the wheel was turned in this step, positive away from the user."""
        return self.now.wheel


def _known(action):
    if action not in ACTIONS:
        raise ValueError(f"action must be one of {', '.join(ACTIONS)} (got {action!r})")
    return action
