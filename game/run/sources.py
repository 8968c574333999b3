"""Sources of input besides devices and recordings: a script, the scene's bot, no input."""

from collections.abc import Iterable
from typing import Protocol

from game.input.inputs import NOTHING, InputFrame
from game.scene import Scene


class Source(Protocol):
    """A source of the input of each step."""

    def next(self, scene: Scene) -> InputFrame:
        """Return the input of the next step."""
        ...


class ScriptSource:
    """A source that plays a list of InputFrames, or of action sets, then nothing."""

    def __init__(self, frames: Iterable[InputFrame | Iterable[str]]) -> None:
        self.frames = [f if isinstance(f, InputFrame) else InputFrame(frozenset(f)) for f in frames]
        self.index = 0

    def next(self, scene: object) -> InputFrame:
        """Return the input of the next step."""
        self.index += 1
        return self.frames[self.index - 1] if self.index <= len(self.frames) else NOTHING


class BotSource:
    """A source that plays the scene's own bot. Changes that a person makes in the panel are added from `person`."""

    def __init__(self, person: Source | None = None) -> None:
        self.person = person

    def next(self, scene: Scene) -> InputFrame:
        """Return the input of the next step."""
        played = scene.bot()
        frame = played if isinstance(played, InputFrame) else InputFrame(frozenset(played))
        if self.person is None:
            return frame
        changes = self.person.next(scene).changes
        return InputFrame(frame.actions, frame.pointer, frame.pointer_down, frame.wheel, frame.changes + changes)


class IdleSource:
    """A source without input."""

    def next(self, scene: object) -> InputFrame:
        """Return an empty frame."""
        return NOTHING
