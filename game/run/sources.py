"""Who plays a scene: a script, its own bot, nobody. Devices and recordings are sources of input too."""

from collections.abc import Iterable
from typing import Protocol

from game.input.inputs import NOTHING, InputFrame
from game.scene import Scene


class Source(Protocol):
    """Whatever gives the input of a step."""

    def next(self, scene: Scene) -> InputFrame:
        """The input of the next step."""
        ...


class ScriptSource:
    """Plays a list of InputFrames, or of action sets, then nothing."""

    def __init__(self, frames: Iterable[InputFrame | Iterable[str]]) -> None:
        self.frames = [f if isinstance(f, InputFrame) else InputFrame(frozenset(f)) for f in frames]
        self.index = 0

    def next(self, scene: object) -> InputFrame:
        """The input of the next step."""
        self.index += 1
        return self.frames[self.index - 1] if self.index <= len(self.frames) else NOTHING


class BotSource:
    """Asks the scene's own bot. What people change in the panel meanwhile comes along from `person`."""

    def __init__(self, person: Source | None = None) -> None:
        self.person = person

    def next(self, scene: Scene) -> InputFrame:
        """The input of the next step."""
        played = scene.bot()
        frame = played if isinstance(played, InputFrame) else InputFrame(frozenset(played))
        if self.person is None:
            return frame
        changes = self.person.next(scene).changes
        return InputFrame(frame.actions, frame.pointer, frame.pointer_down, frame.wheel, frame.changes + changes)


class IdleSource:
    """Nobody plays."""

    def next(self, scene: object) -> InputFrame:
        """Nothing held."""
        return NOTHING
