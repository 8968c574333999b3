"""The interface between the program and the screen on top.

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

Outcome = tuple[str, *tuple[Any, ...]]  # a name in the table of game/screens/stack.py, and its arguments


class Screen:
    """The interface, with default answers.

    `outcome`: the next screen, None while it stays. `cues`: sounds of its menus since they were last played.
    """

    shows_pointer: bool = True
    tune: str | None = None  # the music; None: the music continues
    quiet: bool = False  # the music is low: a demonstration
    holds_music: bool = False  # the music stops until another screen is on top
    takes_game_input: bool = False  # keys and buttons have the player's bindings, not those of menus
    shows_scene: bool = False  # a scene with damaged files, which is then closed
    shows_result: bool = False  # messages about the game are shown here
    wants_screenshot: bool = False  # the picture just drawn is to be saved; the program resets this
    failure: str = ""  # a line for the terminal, with exit code 1, if the program ends on this screen

    def __init__(self) -> None:
        self.outcome: Outcome | None = None
        self.cues: list[str] = []

    @property
    def running_clock(self) -> FixedStep | None:
        """Clock that schedules a scene's steps; None without a scene."""
        return None

    def note_busy(self, seconds: float) -> None:
        """Record the time [s] that the steps and the picture of this frame took."""
        if self.running_clock is not None:
            self.running_clock.note(seconds)

    @property
    def finished(self) -> bool:
        """True after the last step of the run given on the command line: the program ends."""
        return False

    def feed(self, event: pygame.event.Event) -> bool:
        """Process an event before the devices do; return whether it was used."""
        return False

    def resume(self) -> None:
        """Update when the screen is shown again."""

    def lose_focus(self) -> None:
        """React to the loss of the window's focus."""

    def close(self) -> None:
        """Clean up when it is left for the screen below."""

    def accept(self) -> None:
        """Accept a pending entry, because the window closes."""

    def report(self, message: str) -> None:
        """Show one line about an action of this screen."""


class CanvasScreen(Screen, ABC):
    """A title, a menu, a table, a message."""

    @abstractmethod
    def step(self, inputs: InputState, dt: float) -> None:
        """Make one fixed step of dt [s]."""

    @abstractmethod
    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the picture."""

    def turn(self, now: float, steps: Iterable[InputState], picture: Picture) -> Frame | None:
        """Make one turn of the program's loop: the due steps, each with its input, until the screen is left."""
        for inputs in steps:
            self.step(inputs, STEP_SECONDS)
            if self.outcome is not None:
                break
        picture.draw_screen(self)
        return None


class SceneScreen(Screen, ABC):
    """A scene that is played, watched or demonstrated."""

    shows_scene = True

    @abstractmethod
    def advance(self, now: float) -> None:
        """Make the steps due at `now` [s]."""

    @abstractmethod
    def draw(self, picture: Picture) -> Frame:
        """Draw the scene and the elements over it; return the frame."""

    def turn(self, now: float, steps: Iterable[InputState], picture: Picture) -> Frame | None:
        """Make one turn of the program's loop at `now` [s]. Return the frame, on which the frame time may be
        written.
        """
        self.advance(now)
        return self.draw(picture)
