"""The demonstration that starts when the title screen is idle: bots play the games and two labs. Any key ends it."""

from collections.abc import Callable, Sequence

import pygame

from game.drawing.colors import GOLD
from game.drawing.presenter import Frame
from game.errors import UsageError
from game.files.accessibility import Accessibility
from game.run.loop import FixedStep
from game.run.picture import Picture
from game.scene import Scene
from game.screens.parts.demo import Demo
from game.screens.parts.status_line import draw_line
from game.screens.screen import SceneScreen

SCENES = ("shooter", "platformer", "lander", "lab/pyramid", "lab/masks")
SECONDS = 25  # for which each scene is shown
STEPS = SECONDS * 60
AFTER_END = 180  # steps for which an ended game stays on screen
LINE = "DEMO - press any key"
ENDS_IT = (pygame.KEYDOWN, pygame.MOUSEBUTTONDOWN, pygame.CONTROLLERBUTTONDOWN, pygame.JOYBUTTONDOWN)


class Attract(SceneScreen):
    """Demonstration of several scenes, one after another. make(name) builds a scene; names: the scenes that exist.

    `outcome`, the request for the next screen, becomes ("back",) at the end. `quiet`: True plays the music at low
    volume.
    """

    shows_pointer = False
    quiet = True

    def __init__(self, make: Callable[[str], Scene], names: Sequence[str], accessibility: Accessibility) -> None:
        super().__init__()
        self.make, self.accessibility = make, accessibility
        self.names = [name for name in SCENES if name in names] or list(names[:1])
        self.at = 0
        self.steps = 0
        self.ended = False  # the bot's game has ended
        self.demo = None

    @property
    def running_clock(self) -> FixedStep | None:
        """Clock that schedules the scene's steps; None before a scene is built."""
        return self.demo.clock if self.demo else None

    @property
    def tune(self) -> str | None:
        """Name of the current scene's music; "title" before a scene is built."""
        return self.demo.scene.music if self.demo else "title"

    def feed(self, event: pygame.event.Event) -> bool:
        """End the demonstration on any key, button or click. Return whether the event was such an input."""
        if event.type in ENDS_IT:
            self.outcome = ("back",)
            return True
        return False

    def advance(self, now: float) -> None:
        """Make the steps due at `now` [s].

        After STEPS steps of a scene, or soon after its game ends, change to the next scene.
        """
        if self.demo is None:
            self._begin()
        if self.demo is not None:
            self.steps += self.demo.advance(now)
            if self.demo.scene.result is not None and not self.ended:
                self.ended, self.steps = True, max(self.steps, STEPS - AFTER_END)
            if self.steps >= STEPS:
                self.at += 1
                self.demo = None

    def _begin(self):
        """Start the next scene. A scene with damaged files is skipped, because the menu shows its error."""
        if self.at >= len(self.names):
            self.outcome = ("back",)
            return
        try:
            scene = self.make(self.names[self.at])
        except UsageError:
            self.at += 1
            return
        self.steps, self.ended = 0, False
        self.demo = Demo(scene, self.accessibility)

    def draw(self, picture: Picture) -> Frame:
        """Draw the scene, and a line of text which says that this is a demonstration. Return the frame."""
        if self.demo is None:
            return picture.presenter.frame
        frame = self.demo.draw(picture)
        draw_line(frame, LINE, GOLD)
        return frame
