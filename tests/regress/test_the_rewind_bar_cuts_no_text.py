"""The rewind bar does not cut a line of text in two."""

import pygame
import pytest

from game.drawing.colors import INK
from game.overlays.stack import Overlays
from game.run.picture import Picture
from game.run.rewind import Rewind
from game.run.session import Session
from game.run.sources import BotSource
from game.screens.parts.timeline import Timeline
from tests.lockstep import make_scene


@pytest.mark.parametrize("size", [(960, 540), (1440, 810)])
def test_a_line_goes_as_a_whole(size):
    session = Session(make_scene("lab/stacks"), BotSource())
    timeline = Timeline(Rewind(session))
    picture = Picture(pygame.Surface(size))
    frame = picture.draw_scene(session.scene, Overlays(()))
    before = [box.copy() for box, _ in frame.boxes]
    timeline.draw(frame)
    bar = timeline._rect(frame)
    cut = [box for box in before if bar.colliderect(box) and box.top < bar.top]
    assert cut, "nothing of this scene reaches above the bar"
    for box in cut:
        above = frame.surface.subsurface((box.x, box.y, box.width, bar.top - box.y))
        assert pygame.transform.average_color(above)[:3] == INK[:3]
