"""What the title shows when nobody is there: the games and two labs, played by their bots. Any key ends it."""

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
SECONDS = 25  # of each
STEPS = SECONDS * 60
AFTER_END = 180  # steps that an ended game is still shown
LINE = "DEMO - press any key"
ENDS_IT = (pygame.KEYDOWN, pygame.MOUSEBUTTONDOWN, pygame.CONTROLLERBUTTONDOWN, pygame.JOYBUTTONDOWN)


class Attract(SceneScreen):
    """`make(name)` builds a scene.

    `outcome` becomes ("back",). `quiet` tells the app to play the music low.
    """

    shows_pointer = False
    quiet = True

    def __init__(self, make: Callable[[str], Scene], names: Sequence[str], accessibility: Accessibility) -> None:
        super().__init__()
        self.make, self.accessibility = make, accessibility
        self.names = [name for name in SCENES if name in names] or list(names[:1])
        self.at = 0
        self.steps = 0
        self.ended = False  # the bot's game is over
        self.demo = None

    @property
    def running_clock(self) -> FixedStep | None:
        """The clock by which the scene's steps are due."""
        return self.demo.clock if self.demo else None

    @property
    def tune(self) -> str | None:
        """The music of the scene that is shown."""
        return self.demo.scene.music if self.demo else "title"

    def feed(self, event: pygame.event.Event) -> bool:
        """Any key, button or click ends it."""
        if event.type in ENDS_IT:
            self.outcome = ("back",)
            return True
        return False

    def advance(self, now: float) -> None:
        """Make the steps that are due at `now` [s]; the next scene when one has had its time."""
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
        """The next scene; one whose files are damaged is left out: the menu says what is wrong with it."""
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
        """Draw the scene, and that it is a demonstration."""
        if self.demo is None:
            return picture.presenter.frame
        frame = self.demo.draw(picture)
        draw_line(frame, LINE, GOLD)
        return frame
