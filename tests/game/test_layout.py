"""No text overlaps other text or leaves the picture in any scene, with any overlays and panels."""

import pygame
import pytest

import physics
from game.audio.sound import Sounds
from game.input.devices import DeviceSource
from game.overlays.stack import Overlays, layer_names
from game.registry import Registry
from game.run.picture import Picture
from game.run.sources import BotSource
from game.screens.play import Play
from scenes import SCENES
from tests.game.reading import Reader, assert_text_is_apart
from tests.pairwise import pairwise, the_others

pytestmark = pytest.mark.usefixtures("nothing_is_measured")
SIZES = [(1440, 810), (1920, 1080), (960, 540), (480, 270), (1100, 900), (640, 360)]
PANEL = [False, True]
LAYERS = {"none": lambda scene: (), "all": lambda scene: layer_names(), "its own": lambda scene: scene.overlays}


@pytest.fixture(scope="module")
def plays():
    """Return play_of(name), a function that returns the Play of a scene after its bot has played for 1.5 s.

    Only the last Play is cached; it is made when a test first requests it.
    """
    kept = {}

    def play_of(name):
        if name not in kept:
            kept.clear()
            kept[name] = made(name)
        return kept[name]

    return play_of


def made(name):
    scene = Registry(SCENES).scene_class(name)(seed=1)
    for slider in scene.sliders:
        if slider.name == "bodies":
            scene.change("slider:bodies", 100)
    screen = Play(scene, DeviceSource(), Sounds(silent=True), bot=True)
    screen.session.source = BotSource()
    for _ in range(90):
        screen.step()
    return screen


def assert_text_is_apart_with(play, size, panel, layers):
    play.overlays = Overlays(LAYERS[layers](play.scene))
    play.overlays.note(play.scene)
    play.panel_open = panel
    frame = assert_text_of_is_apart(play, Picture(pygame.Surface(size)))
    head = frame.from_canvas((0, 0, 1, play.scene.head))  # painted last, with the line of the keys
    assert not any(place.top < head.bottom for place, _ in play.overlays.invariants.places)


def assert_text_of_is_apart(play, picture):
    frame = play.draw(picture)
    assert_text_is_apart(frame.boxes, frame.rect)
    return frame


@pytest.mark.parametrize("name, size, panel, layers", pairwise(SCENES, SIZES, PANEL, LAYERS))
def test_play_with_overlays_and_panel(plays, name, size, panel, layers):
    assert_text_is_apart_with(plays(name), size, panel, layers)


@pytest.mark.nightly
@pytest.mark.parametrize("name", SCENES)
def test_play_with_overlays_and_panel_in_every_case(plays, name):
    for other, *case in the_others(SCENES, SIZES, PANEL, LAYERS):
        if other == name:
            assert_text_is_apart_with(plays(name), *case)


@pytest.mark.skipif(not physics.JIT, reason="12 million pairs a step need compiled kernels")
def test_the_largest_numbers_fit():
    scene = Registry(SCENES).scene_class("lab/broadphases")(seed=1)
    scene.change("slider:bodies", 5000)
    screen = Play(scene, DeviceSource(), Sounds(silent=True))
    for _ in range(3):
        screen.step()
    assert_text_of_is_apart(screen, Picture())


@pytest.mark.parametrize("name", SCENES)
def test_text_is_apart_and_readable_while_it_goes_on(plays, name):
    """Text does not overlap while a scene plays, plays slowly or is paused.

    This holds with all overlays, and with the scene's own overlays and the open panel. Without overlays and panel the
    text is readable, too.
    """
    play = plays(name)
    assert_text_is_apart_with(play, SIZES[0], False, "all")
    own = Overlays(play.scene.overlays)
    play.overlays, play.panel_open = own, True
    for paused, speed in ((True, 1.0), (False, 0.25)):
        play.clock.paused, play.clock.speed = paused, speed
        assert_text_of_is_apart(play, Picture())
    play.clock.paused, play.clock.speed = False, 1.0
    for frames in (90, 200, 400, 500, 600):
        while play.session.report.steps < frames:
            play.step()
        play.overlays, play.panel_open = own, True
        assert_text_of_is_apart(play, Picture())
        play.overlays, play.panel_open = Overlays(()), False
        with Reader() as reader:
            play.draw(Picture())
            reader.assert_readable()
