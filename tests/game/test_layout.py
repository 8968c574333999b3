"""On no screen does text overlap text or leave the picture."""

from itertools import combinations

import pygame
import pytest

import physics

from game.devices import DeviceSource
from game.inputs import BotSource, InputFrame, InputState
from game.loading import Loading
from game.menu import Menu
from game.options import Options
from game.overlays import LAYER_NAMES
from game.overlays.stack import Overlays
from game.picture import Picture
from game.play import Play
from game.registry import Registry
from game.settings import Settings
from game.sound import Sounds
from game.title import Title
from scenes import SCENES

SIZES = [(1440, 810), (1920, 1080), (960, 540), (480, 270), (1100, 900)]


def assert_text_is_apart(boxes, picture):
    """Each box inside the picture, no two of them meeting."""
    for rect, text in boxes:
        assert picture.contains(rect), f"{text!r} at {rect} leaves {picture}"
    for (a, text_a), (b, text_b) in combinations(boxes, 2):
        assert not a.colliderect(b), f"{text_a!r} at {a} overlaps {text_b!r} at {b}"


def settle(screen, steps=3):
    inputs = InputState()
    for _ in range(steps):
        inputs.set(InputFrame())
        screen.step(inputs, 1 / 60)
    return screen


def test_title_options_and_loading():
    message = ("/data/somebody/with/a/long/name/.local/share/hitbox/settings.json: version: must be 1; "
               "defaults are used, the old file is kept as settings.json.damaged-1")
    loading = Loading("Broad phases")
    loading.what = "physics.broadphase.spatial_hash.update_cells_of_moved_proxies_incrementally"
    for screen in (settle(Title()), settle(Title(message)), settle(Options(Settings())), loading):
        frame = Picture().draw_screen(screen)
        assert_text_is_apart(frame.boxes, frame.rect)


def test_every_entry_of_the_menu():
    menu = Menu(Registry(SCENES))
    for mark in range(len(menu.entries)):
        menu.mark = mark
        menu._show_marked()
        frame = Picture().draw_screen(menu)
        assert menu.places[mark] is not None and menu.entries[mark][1] in [text for _, text in frame.boxes]
        assert_text_is_apart(frame.boxes, frame.rect)


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
    play.overlays.times.note(play.scene)
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
