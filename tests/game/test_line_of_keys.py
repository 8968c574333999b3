"""The line of keys at the start of a scene covers no text at any size of the window."""

import pygame
import pytest

from game.drawing.canvas import SMALL
from game.input.devices import DeviceSource
from game.overlays.stack import Overlays, layer_names
from game.run.picture import Picture
from game.run.sources import BotSource
from game.screens.parts.status_line import HELP_SECONDS
from game.screens.play import Play
from scenes import SCENES
from tests.game.reading import assert_text_is_apart
from tests.game.test_lab_card import Silent
from tests.lockstep import make_scene

pytestmark = pytest.mark.usefixtures("nothing_is_measured")
MOMENTS = (2, 120, 330)  # steps
LAST = "Esc menu"


@pytest.fixture(scope="module")
def plays():
    """Return play_of(name, step), a function that returns the Play of a scene after a number of steps of its bot."""
    kept = {}

    def play_of(name, step):
        if name not in kept:
            kept.clear()
            kept[name] = Play(make_scene(name, few=True), DeviceSource(), Silent())
            kept[name].session.source = BotSource()
        while kept[name].session.report.steps < step:
            kept[name].step()
        return kept[name]

    return play_of


def drawn(play, size, with_keys):
    """Return the frame of a Play with the line of keys or, six seconds later, without it."""
    play.helped_since = 0 if with_keys else -HELP_SECONDS * 60
    return play.draw(Picture(pygame.Surface(size)))


@pytest.mark.parametrize("step", MOMENTS)
@pytest.mark.parametrize("name", SCENES)
def test_the_line_of_keys_hides_no_text(plays, name, step):
    play = plays(name, step)
    offer = f"R {play.scene.offer}"  # a part of the line of keys
    own = play.overlays
    for size, layers in (
        ((640, 360), own),
        ((640, 360), Overlays(layer_names())),
        ((480, 270), own),
        ((960, 540), own),
        ((1280, 720), own),
    ):
        play.overlays = layers
        layers.note(play.scene)
        before, after = drawn(play, size, with_keys=False), drawn(play, size, with_keys=True)
        assert_text_is_apart(after.boxes, after.rect)
        keys = [(rect, text) for rect, text in after.boxes if LAST in text]
        assert len(keys) == 1 and keys[0][0].height == after.measure(LAST, SMALL, after.text_scale)[1]
        hidden = {text for box in before.boxes if box not in after.boxes for text in [box[1]]} - {offer}
        assert not hidden, (size, hidden)
    play.overlays = own


def test_below_the_picture_is_its_first_place(plays):
    play = plays("lab/stacks", 120)
    frame = drawn(play, (640, 360), with_keys=True)
    assert min(rect.top for rect, text in frame.boxes if LAST in text) >= frame.area.bottom
    frame = drawn(play, (960, 540), with_keys=True)
    assert max(rect.bottom for rect, text in frame.boxes if LAST in text) <= frame.area.bottom


@pytest.mark.parametrize("opened", ["panel_open", "costs_open"])
def test_a_panel_that_covers_the_picture_is_covered_by_nothing(opened):
    play = Play(make_scene("lab/stacks"), DeviceSource(), Silent())
    for _ in range(90):
        play.step()
    setattr(play, opened, True)
    running = play.draw(Picture(pygame.Surface((640, 360))))
    pixels = pygame.surfarray.array3d(running.surface)
    play.clock.paused = True
    frozen = play.draw(Picture(pygame.Surface((640, 360))))
    texts = [text for _, text in frozen.boxes]
    assert not any("FROZEN" in text or "-10 s" in text for text in texts)
    assert_text_is_apart(frozen.boxes, frozen.rect)
    changed = (pygame.surfarray.array3d(frozen.surface) != pixels).any(axis=2)
    assert changed.sum() < 200, "nothing but the box of the row Freeze"
    play.close()
