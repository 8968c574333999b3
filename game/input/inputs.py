"""InputState: what is held in this step, whoever holds it.

Devices, bots, scripts and recordings all produce InputFrames; a scene only ever sees an InputState. So a
replay goes through the same door as a keyboard. Changes (a slider moved, another broad phase) travel in
the frame too, since they change the simulation and a recording must hold them.
"""

from dataclasses import dataclass

ACTIONS = ("left", "right", "up", "down", "fire", "focus", "jump", "bomb", "confirm", "cancel", "pause")
CHANGES = ("broadphase", "solver", "substeps", "tier", "narrowphase", "restart")  # and "slider:<name>", "assist:<name>"


@dataclass(frozen=True)
class InputFrame:
    """The input of one step. `pointer` in canvas pixels; `changes` are (name, value) pairs, in order."""

    actions: frozenset = frozenset()
    pointer: tuple = (0, 0)
    pointer_down: bool = False
    wheel: int = 0
    changes: tuple = ()


NOTHING = InputFrame()


class InputState:
    """Two frames side by side: what is held now, and what was held a step ago."""

    def __init__(self) -> None:
        self.now = self.before = NOTHING

    def set(self, frame: InputFrame) -> None:
        """Take the input of the next step."""
        self.before, self.now = self.now, frame

    def held(self, action: str) -> bool:
        """True while the action is held. An unknown action raises ValueError: a typo never reads as 'not held'."""
        return _known(action) in self.now.actions

    def pressed(self, action: str) -> bool:
        """True in the one step in which the action goes down."""
        return _known(action) in self.now.actions and action not in self.before.actions

    def released(self, action: str) -> bool:
        """True in the one step in which the action comes up."""
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
        """Wheel notches turned in this step; away from the hand is positive."""
        return self.now.wheel


def _known(action):
    if action not in ACTIONS:
        raise ValueError(f"action must be one of {', '.join(ACTIONS)} (got {action!r})")
    return action
