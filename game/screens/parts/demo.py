"""A scene that its own bot plays on a screen: for the title's idle minutes and for the tour."""

from game.overlays.stack import Overlays
from game.run.loop import FixedStep
from game.run.session import Session
from game.run.sources import BotSource


class Demo:
    """A scene, its bot, its clock and its overlays; the panel may be shown beside it."""

    def __init__(self, scene, accessibility):
        self.scene = scene
        scene.set_accessibility(accessibility)
        self.session = Session(scene, BotSource())
        self.clock = FixedStep()
        self.overlays = Overlays(())

    def advance(self, now):
        """Make the steps that are due at `now` [s]; how many these were."""
        due = self.clock.advance(now)
        for _ in range(due):
            self.step()
        return due

    def step(self):
        """One fixed step."""
        self.session.step()
        self.overlays.times.note(self.scene)

    def draw(self, picture, panel=None, reserve=None):
        """Draw the scene and return the frame; see Picture.draw_scene."""
        return picture.draw_scene(self.scene, self.overlays, self.clock.alpha, panel, reserve)
