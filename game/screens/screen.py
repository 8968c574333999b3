"""What the program asks of the screen on top; every screen answers for itself.

A screen is drawn on the canvas and moved in fixed steps (CanvasScreen), or it shows a scene, keeps its own time and
draws at the window's resolution (SceneScreen).
"""

from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import Any

import pygame

from game.drawing.canvas import Canvas
from game.drawing.presenter import Frame
from game.input.inputs import InputState
from game.run.loop import FixedStep
from game.run.picture import Picture
from game.scene import STEP_SECONDS

Outcome = tuple[str, *tuple[Any, ...]]  # a name in the table of game/screens/stack.py, and what it takes


class Screen:
    """The questions, and the answers of a screen that is nothing special.

    `outcome`: where the screen leads, None while it stays. `cues`: the sounds of its menus since they were last played.
    """

    shows_pointer: bool = True
    tune: str | None = None  # the music; None: what plays, plays on
    quiet: bool = False  # the music is played low: nobody plays
    holds_music: bool = False  # the music stops until another screen is on top
    takes_game_input: bool = False  # keys and buttons mean what the player bound them to, not what menus need
    shows_scene: bool = False  # its files may turn out to be damaged: it is then closed
    shows_result: bool = False  # what came of the game is told here
    wants_screenshot: bool = False  # the picture just drawn is to be saved; the program resets this
    failure: str = ""  # a line for the terminal and exit code 1, where the program ends on this screen

    def __init__(self) -> None:
        self.outcome: Outcome | None = None
        self.cues: list[str] = []

    @property
    def running_clock(self) -> FixedStep | None:
        """The clock by which a scene's steps are due; None where none is shown."""
        return None

    def note_busy(self, seconds: float) -> None:
        """Take note of how long [s] the steps and the picture of this frame took."""
        if self.running_clock is not None:
            self.running_clock.note(seconds)

    @property
    def finished(self) -> bool:
        """True when the run that the command line asked for has made its last step: the program ends."""
        return False

    def feed(self, event: pygame.event.Event) -> bool:
        """Take an event before the devices do; True if it is used up."""
        return False

    def resume(self) -> None:
        """It is seen again: what lay over it was left."""

    def lose_focus(self) -> None:
        """The window is no longer the one that is worked in."""

    def close(self) -> None:
        """It is left for the screen below."""

    def accept(self) -> None:
        """The window closes: take what is being entered as it stands."""

    def tell(self, message: str) -> None:
        """Show one line about what was done from here."""


class CanvasScreen(Screen, ABC):
    """A title, a menu, a table, a message."""

    @abstractmethod
    def step(self, inputs: InputState, dt: float) -> None:
        """One fixed step of dt [s]."""

    @abstractmethod
    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the picture."""

    def turn(self, now: float, steps: Iterable[InputState], picture: Picture) -> Frame | None:
        """One turn of the program's loop: the steps that are due, each with its input, until the screen is left."""
        for inputs in steps:
            self.step(inputs, STEP_SECONDS)
            if self.outcome is not None:
                break
        picture.draw_screen(self)
        return None


class SceneScreen(Screen, ABC):
    """A scene that is played, watched or shown."""

    shows_scene = True

    @abstractmethod
    def advance(self, now: float) -> None:
        """Make the steps that are due at `now` [s]."""

    @abstractmethod
    def draw(self, picture: Picture) -> Frame:
        """Draw the scene and what lies over it; returns the frame."""

    def turn(self, now: float, steps: Iterable[InputState], picture: Picture) -> Frame | None:
        """One turn of the program's loop at `now` [s]. Returns the frame, which the frame time may be written on."""
        self.advance(now)
        return self.draw(picture)
