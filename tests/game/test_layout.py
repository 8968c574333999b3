"""In no scene does text overlap text or leave the picture, whatever overlays and panel are on."""

import pygame
import pytest

import physics
from game.audio.sound import Sounds
from game.input.devices import DeviceSource
from game.overlays.layer import LAYER_NAMES
from game.overlays.stack import Overlays
from game.registry import Registry
from game.run.picture import Picture
from game.run.sources import BotSource
from game.screens.play import Play
from scenes import SCENES
from tests.game.reading import Reader, assert_text_is_apart

SIZES = [(1440, 810), (1920, 1080), (960, 540), (480, 270), (1100, 900)]


@pytest.fixture(scope="module", params=SCENES)
def play(request):
    """Each scene after a second and a half of its bot."""
    scene = Registry(SCENES).scene_class(request.param)(seed=1)
    for slider in scene.sliders:
        if slider.name == "bodies":
            scene.change("slider:bodies", 100)
    screen = Play(scene, DeviceSource(), Sounds(silent=True), bot=True)
    screen.session.source = BotSource()
    for _ in range(90):
        screen.step()
    return screen


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("panel", [False, True])
@pytest.mark.parametrize("layers", [(), LAYER_NAMES, None])
def test_play_with_overlays_and_panel(play, size, panel, layers):
    play.overlays = Overlays(play.scene.overlays if layers is None else layers)
    play.overlays.note(play.scene)
    play.panel_open = panel
    frame = play.draw(Picture(pygame.Surface(size)))
    assert_text_is_apart(frame.boxes, frame.rect)


@pytest.mark.skipif(not physics.JIT, reason="12 million pairs a step need compiled kernels")
def test_the_largest_numbers_fit():
    scene = Registry(SCENES).scene_class("lab/broadphases")(seed=1)
    scene.change("slider:bodies", 5000)
    screen = Play(scene, DeviceSource(), Sounds(silent=True))
    for _ in range(3):
        screen.step()
    frame = screen.draw(Picture())
    assert_text_is_apart(frame.boxes, frame.rect)


@pytest.mark.parametrize("paused, speed", [(True, 1.0), (False, 0.25)])
def test_play_while_paused_or_slow(play, paused, speed):
    play.clock.paused, play.clock.speed = paused, speed
    frame = play.draw(Picture())
    play.clock.paused, play.clock.speed = False, 1.0
    assert_text_is_apart(frame.boxes, frame.rect)


@pytest.mark.parametrize("frames", [1, 200, 500])
def test_scenes_at_other_moments(play, frames):
    while play.session.report.steps < frames:
        play.step()
    frame = play.draw(Picture())
    assert_text_is_apart(frame.boxes, frame.rect)


@pytest.mark.parametrize("frames", [1, 90, 200, 400, 600])
def test_scenes_are_readable(play, frames):
    while play.session.report.steps < frames:
        play.step()
    with Reader() as reader:
        play.overlays.on = set()
        play.panel_open = False
        play.draw(Picture())
        reader.assert_readable()
