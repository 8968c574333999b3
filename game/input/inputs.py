"""The input of one step, from any source.

Devices, bots, scripts and recordings all produce InputFrames, and a scene reads only an InputState. So a replay uses
the same code as a keyboard. Changes (a moved slider, another broad phase) are also part of an InputFrame, because they
change the simulation, and a recording must contain them.
"""

from dataclasses import dataclass

ACTIONS = ("left", "right", "up", "down", "fire", "focus", "jump", "bomb", "confirm", "cancel", "pause")
CHANGES = ("broadphase", "solver", "substeps", "tier", "narrowphase", "restart")  # and "slider:<name>", "assist:<name>"


@dataclass(frozen=True)
class InputFrame:
    """The input of one step.

    actions: the held actions; pointer: (x, y) [canvas px]; changes: (name, value) pairs, in order.
    """

    actions: frozenset = frozenset()
    pointer: tuple = (0, 0)
    pointer_down: bool = False
    wheel: int = 0
    changes: tuple = ()


NOTHING = InputFrame()


class InputState:
    """The input of the current step and of the previous step."""

    def __init__(self) -> None:
        self.now = self.before = NOTHING

    def set(self, frame: InputFrame) -> None:
        """Advance by one step. `frame` becomes the input of the current step."""
        self.before, self.now = self.now, frame

    def held(self, action: str) -> bool:
        """Return whether the action is held in the current step.

        Raises ValueError for an unknown action, so that a typo is not read as "not held".
        """
        return _known(action) in self.now.actions

    def pressed(self, action: str) -> bool:
        """Return whether the action is held in the current step and was not held in the previous step."""
        return _known(action) in self.now.actions and action not in self.before.actions

    def released(self, action: str) -> bool:
        """Return whether the action was held in the previous step and is not held in the current step."""
        return _known(action) not in self.now.actions and action in self.before.actions

    @property
    def pointer(self) -> tuple[int, int]:
        """Position (x, y) of the pointer [canvas px]."""
        return self.now.pointer

    @property
    def pointer_down(self) -> bool:
        """Whether the pointer's button is held."""
        return self.now.pointer_down

    @property
    def pointer_pressed(self) -> bool:
        """Whether the pointer's button was pressed in the current step."""
        return self.now.pointer_down and not self.before.pointer_down

    @property
    def wheel(self) -> int:
        """Notches by which the mouse wheel was turned in the current step; positive away from the user."""
        return self.now.wheel


def _known(action):
    if action not in ACTIONS:
        raise ValueError(f"action must be one of {', '.join(ACTIONS)} (got {action!r})")
    return action
