"""The window's program, driven by posted events under the dummy driver."""

import json

import pygame
import pytest

from game.app import App, open_window
from game.command_line import read_options
from game.menu import Menu
from game.options import Options
from game.play import Play
from game.registry import Registry
from game.settings import Settings, load_settings
from game.title import Title
from tests.game.arena import LISTING


@pytest.fixture
def start(tmp_path, monkeypatch):
    monkeypatch.setenv("HITBOX_DATA", str(tmp_path))
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    monkeypatch.setenv("SDL_AUDIODRIVER", "dummy")
    pygame.display.init()

    def make(*arguments):
        settings = Settings(window_scale=1)
        registry = Registry(LISTING)
        pygame.event.clear()
        return App(read_options(list(arguments), registry), registry, settings, open_window(settings))

    yield make
    pygame.event.clear()


def tap(app, *keys):
    for key in keys:
        pygame.event.post(pygame.event.Event(pygame.KEYDOWN, key=key))
        pygame.event.post(pygame.event.Event(pygame.KEYUP, key=key))
        turns(app, 3)


def turns(app, count):
    for _ in range(count):
        app.turn()


def test_title_menu_scene_and_back(start):
    app = start()
    turns(app, 2)
    assert isinstance(app.screen, Title)
    tap(app, pygame.K_RETURN)
    assert isinstance(app.screen, Menu)
    tap(app, pygame.K_RETURN)
    assert isinstance(app.screen, Play) and app.screen.scene.name == "arena"
    tap(app, pygame.K_1, pygame.K_TAB)
    assert app.screen.overlays.on == {"bounds"} and app.screen.panel_open
    tap(app, pygame.K_TAB, pygame.K_ESCAPE)
    assert isinstance(app.screen, Menu)
    tap(app, pygame.K_ESCAPE, pygame.K_ESCAPE)
    assert not app.running


def test_menu_by_mouse(start):
    app = start()
    tap(app, pygame.K_RETURN)
    place = app.screen.places[0].center
    pygame.event.post(pygame.event.Event(pygame.MOUSEMOTION, pos=place, rel=(0, 0), buttons=(0, 0, 0)))
    pygame.event.post(pygame.event.Event(pygame.MOUSEBUTTONDOWN, button=1, pos=place))
    pygame.event.post(pygame.event.Event(pygame.MOUSEBUTTONUP, button=1, pos=place))
    turns(app, 4)
    assert isinstance(app.screen, Play)


def test_menu_by_controller(start):
    app = start()
    button = {"instance_id": 5, "button": pygame.CONTROLLER_BUTTON_A}
    for _ in range(2):
        pygame.event.post(pygame.event.Event(pygame.CONTROLLERBUTTONDOWN, **button))
        pygame.event.post(pygame.event.Event(pygame.CONTROLLERBUTTONUP, **button))
        turns(app, 4)
    assert isinstance(app.screen, Play)


def test_options_are_saved_and_keys_rebound(start):
    app = start()
    tap(app, pygame.K_RETURN, pygame.K_UP, pygame.K_RETURN)
    assert isinstance(app.screen, Options)
    app.screen.mark = next(i for i, row in enumerate(app.screen.rows()) if row[0] == "Key: fire")
    tap(app, pygame.K_RETURN, pygame.K_k, pygame.K_ESCAPE)
    assert isinstance(app.screen, Menu)
    assert load_settings()[0].keys["fire"][0] == "k"
    app.devices.feed(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_k))
    assert "fire" in app.devices.next().actions


def test_a_taken_key_is_swapped():
    options = Options(Settings())
    options.waiting_for = "left"
    options.feed(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_RIGHT))
    assert options.settings.keys["left"][0] == "right" and options.settings.keys["right"][0] == "left"


def test_a_scene_with_frames_ends_by_itself(start, tmp_path, capsys):
    app = start("--scene", "arena", "--bot", "--frames", "20", "--json", "--record", str(tmp_path / "run.json"),
                "--screenshot", str(tmp_path / "shot.png"))
    assert app.run() == 0
    report = json.loads(capsys.readouterr().out)
    assert report["frames"] == 20
    assert (tmp_path / "run.json").exists() and (tmp_path / "shot.png").exists()


def test_screenshot_key_writes_into_the_player_s_folder(start, tmp_path):
    app = start("--scene", "arena")
    tap(app, pygame.K_F12)
    assert list((tmp_path / "screenshots").glob("arena-*.png"))


def test_closing_the_window_ends(start):
    app = start()
    pygame.event.post(pygame.event.Event(pygame.QUIT))
    turns(app, 1)
    assert not app.running
