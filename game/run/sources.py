"""Sources of input other than devices and recordings: a script, the scene's bot, and empty input."""

from collections.abc import Iterable
from typing import Protocol

from game.input.inputs import NOTHING, InputFrame
from game.scene import Scene


class Source(Protocol):
    """Interface of an object that supplies the input of each step."""

    def next(self, scene: Scene) -> InputFrame:
        """Return the InputFrame of the next step."""
        ...


class ScriptSource:
    """Source that supplies a list of inputs (InputFrames, or sets of actions).

    After its end, it supplies empty input.
    """

    def __init__(self, frames: Iterable[InputFrame | Iterable[str]]) -> None:
        self.frames = [f if isinstance(f, InputFrame) else InputFrame(frozenset(f)) for f in frames]
        self.index = 0

    def next(self, scene: object) -> InputFrame:
        """Return the input of the next step; empty input after the end of the list. scene: not used."""
        self.index += 1
        return self.frames[self.index - 1] if self.index <= len(self.frames) else NOTHING


class BotSource:
    """Source that supplies the input of the scene's bot.

    person: source of a person's input, or None. The person's changes of settings are added to the bot's input. The
    person's other input is ignored.
    """

    def __init__(self, person: Source | None = None) -> None:
        self.person = person

    def next(self, scene: Scene) -> InputFrame:
        """Return the bot's input for the next step, with the person's changes of settings added."""
        played = scene.bot()
        frame = played if isinstance(played, InputFrame) else InputFrame(frozenset(played))
        if self.person is None:
            return frame
        changes = self.person.next(scene).changes
        return InputFrame(frame.actions, frame.pointer, frame.pointer_down, frame.wheel, frame.changes + changes)


class IdleSource:
    """Source of empty input."""

    def next(self, scene: object) -> InputFrame:
        """Return empty input. scene: not used."""
        return NOTHING
