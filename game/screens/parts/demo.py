"""A scene played by its bot, for the demonstration of the title screen and for the tour."""

from collections.abc import Callable

from game.drawing.presenter import Frame
from game.files.accessibility import Accessibility
from game.overlays.stack import Overlays
from game.run.loop import FixedStep
from game.run.picture import Docked, Picture
from game.run.session import Session
from game.run.sources import BotSource
from game.scene import Scene


class Demo:
    """A scene with its bot, clock and overlays."""

    def __init__(self, scene: Scene, accessibility: Accessibility) -> None:
        self.scene = scene
        scene.set_accessibility(accessibility)
        self.session = Session(scene, BotSource())
        self.clock = FixedStep()
        self.overlays = Overlays(())

    def advance(self, now: float) -> int:
        """Make the steps due at `now` [s]. Return the number of these steps."""
        due = self.clock.advance(now)
        for _ in range(due):
            self.step()
        return due

    def step(self) -> None:
        """Make one fixed step with the bot's input."""
        self.session.step()
        self.overlays.note(self.scene)

    def draw(
        self, picture: Picture, panel: Docked | None = None, reserve: Callable[[Frame], None] | None = None
    ) -> Frame:
        """Draw the scene and return the frame. panel: panel to draw beside the scene, or None.

        reserve: see Picture.draw_scene().
        """
        return picture.draw_scene(self.scene, self.overlays, self.clock.alpha, panel, reserve)
