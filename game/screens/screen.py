"""Interface between the program and the top screen of the stack.

A CanvasScreen (a menu or message) is drawn on the canvas and stepped by the program. A SceneScreen shows a scene, makes
the scene's steps itself, and draws at window resolution.
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
    """Interface of a screen, with default behaviour.

    outcome: (name, *arguments) of the next screen or action, see Screens.follow; None while the screen remains. cues:
    names of the menu sounds to play next.
    """

    shows_pointer: bool = True
    tune: str | None = None  # the music; None: the music continues
    quiet: bool = False  # the music is played low, as in the demonstration
    holds_music: bool = False  # the music stops until another screen is on top
    takes_game_input: bool = False  # keys and buttons have the player's bindings, not those of menus
    shows_scene: bool = False  # the screen shows a scene, and is closed if the scene's files turn out damaged
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
        """Whether the program should end because the run given on the command line is complete."""
        return False

    def feed(self, event: pygame.event.Event) -> bool:
        """Process an event before it becomes input of a game or menu. Return whether the event was used."""
        return False

    def resume(self) -> None:
        """Update the screen when it is shown again after another screen."""

    def lose_focus(self) -> None:
        """Handle the window's loss of focus."""

    def close(self) -> None:
        """Release the resources of the screen when the player returns to the screen below it."""

    def accept(self) -> None:
        """Accept a pending entry, such as initials. This is called when the window closes."""

    def report(self, message: str) -> None:
        """Show one line of text about the result of an action that this screen requested."""


class CanvasScreen(Screen, ABC):
    """A screen drawn on the canvas: title, menu, table or message."""

    @abstractmethod
    def step(self, inputs: InputState, dt: float) -> None:
        """Process the player's input of a step of `dt` [s], and advance the screen's animations."""

    @abstractmethod
    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the screen. alpha: position between the last two steps, 0..1."""

    def turn(self, now: float, steps: Iterable[InputState], picture: Picture) -> Frame | None:
        """Make the due steps, each with its input from `steps`. Then draw the screen, and return None.

        If a step leaves the screen, the remaining steps are not made. now: not used.
        """
        for inputs in steps:
            self.step(inputs, STEP_SECONDS)
            if self.outcome is not None:
                break
        picture.draw_screen(self)
        return None


class SceneScreen(Screen, ABC):
    """A screen that plays, replays or demonstrates a scene."""

    shows_scene = True

    @abstractmethod
    def advance(self, now: float) -> None:
        """Make the steps due at `now` [s]."""

    @abstractmethod
    def draw(self, picture: Picture) -> Frame:
        """Draw the scene and the elements over it. Return the frame."""

    def turn(self, now: float, steps: Iterable[InputState], picture: Picture) -> Frame | None:
        """Make the steps due at `now` [s], draw the scene, and return the frame, which is not None.

        This is called once per picture. The program writes the frame time onto the returned frame. steps: not used.
        """
        self.advance(now)
        return self.draw(picture)
