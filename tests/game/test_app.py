"""The program with its window, driven from start to end by posted events of keyboard, controller and mouse."""

import json

import pygame
import pytest

from game.files.records import load_records
from game.files.settings import Settings, load_settings
from game.run.replay import load_replay
from game.run.replay_shelf import recent_folder, replays_folder

K = pygame


def test_by_keyboard_from_title_to_replay(drive):
    d = drive()
    d.turns(2)
    assert d.name == "Title"
    d.key(K.K_RETURN)
    assert d.name == "Menu"
    d.mark("Race")
    assert d.name == "Play" and d.screen.scene.name == "race"
    d.key(K.K_1, K.K_TAB)
    assert d.screen.overlays.on == {"bounds"} and d.screen.panel_open
    d.key(K.K_TAB, K.K_ESCAPE)
    assert d.name == "PauseMenu"
    before = d.screen.scene.frame
    d.turns(10)
    assert d.screen.scene.frame == before, "the game waits"
    d.mark("Keys")
    assert d.name == "SettingsScreen" and d.screen.page == "Keyboard"
    d.mark("Right")
    d.key(K.K_k)
    assert d.settings.keys["right"] == ["k", "d"]
    d.key(K.K_ESCAPE, K.K_ESCAPE)
    assert d.name == "PauseMenu" and load_settings()[0].keys["right"] == ["k", "d"]
    d.mark("Resume")
    assert d.name == "Play"
    d.hold(K.K_k, 60)
    assert d.screen.scene.result is not None and d.screen.scene.result.won, "the new key steers"
    d.key(K.K_SPACE)
    assert d.name == "Play", "not skipped by who holds fire"
    d.turns(70)
    d.key(K.K_SPACE)
    assert d.name == "ResultScreen" and d.screen.entering and d.screen.place == 1
    d.key(K.K_e, K.K_v, K.K_a, K.K_RETURN)
    assert not d.screen.entering
    assert [entry.name for entry in load_records()[0].entries("race")] == ["EVA"]
    d.mark("High scores")
    assert d.name == "ScoresScreen"
    d.key(K.K_ESCAPE)
    d.mark("Menu")
    assert d.name == "Menu"
    d.key(K.K_ESCAPE)
    d.mark("Replays")
    d.turns(5)
    assert d.name == "ReplaysScreen" and d.screen.chosen is not None
    d.key(K.K_RETURN, K.K_RETURN)
    assert d.name == "Watch"
    d.turns(400)
    assert d.screen.tape.ended and d.screen.tape.scene.result.won and not d.screen.tape.diverged
    d.key(K.K_ESCAPE)
    assert d.name == "ReplaysScreen"
    d.key(K.K_ESCAPE, K.K_ESCAPE)
    assert d.name == "Title" and d.screen.list.marked.label == "Leave", "Esc marks Leave first"
    d.key(K.K_ESCAPE)
    assert not d.app.arcade.running


def test_by_controller_from_title_to_replay(drive):
    d = drive()
    d.turns(2)
    d.pad("a")
    d.by_pad("Race")
    assert d.name == "Play"
    d.pad("y")
    assert d.screen.panel_open
    d.pad("down", "down", "a", "b")
    assert not d.screen.panel_open
    d.pad("start")
    assert d.name == "PauseMenu"
    d.by_pad("Settings")
    d.pad("down", "down", "down", "down", "a")
    assert d.screen.page == "Controller" and d.screen.inside
    d.by_pad("Right")
    d.pad("rb")
    assert d.settings.buttons["right"] == ["right shoulder"] and "dpad right" in d.settings.buttons["focus"]
    d.pad("b", "b")
    assert d.name == "PauseMenu"
    d.pad("b")
    assert d.name == "Play"
    d.hold_pad("rb", 120)
    assert d.screen.scene.result.won
    d.turns(70)
    d.pad("a")
    assert d.name == "ResultScreen"
    d.pad("down", "a", "up", "a", "a", "a")
    assert [entry.name for entry in load_records()[0].entries("race")] == ["B-A"]
    d.by_pad("High scores")
    d.pad("a")
    d.by_pad("Menu")
    d.pad("b")
    d.by_pad("Replays")
    d.turns(5)
    d.pad("a", "a")
    assert d.name == "Watch"
    d.pad("a", turns=5)
    at = d.screen.tape.position
    d.turns(5)
    assert d.screen.clock.paused and d.screen.tape.position == at
    d.pad("b")
    assert d.name == "ReplaysScreen"


def test_by_mouse_from_title_to_replay(drive):
    d = drive()
    d.turns(2)
    d.click_row("Play")
    d.click_row("Race")
    assert d.name == "Play"
    d.turns(5)
    d.press(d.screen.hint.rect.center)
    assert d.screen.hint is None and load_settings()[0].hint_seen
    d.key(K.K_ESCAPE)
    d.click_row("Settings")
    d.click_row("Keyboard", d.screen.pages)
    d.click_row("Fire")
    d.key(K.K_m)
    assert d.settings.keys["fire"][0] == "m"
    d.click_row("Sound", d.screen.pages)
    bar = d.screen.list.bar_place(d.screen.list.place(1))
    d.click((bar.x + 2, bar.centery))
    assert d.settings.music < 0.1 and d.app.arcade.sounds.music < 0.1
    d.click_row("Comfort", d.screen.pages)
    number = next(i for i, row in enumerate(d.screen.list.rows()) if row.label == "Colours")
    value = d.screen.list.value_place(d.screen.list.place(number))
    d.click((value.right - 10, value.centery))
    assert d.settings.palette == "safe"
    d.click((value.x + 10, value.centery))
    assert d.settings.palette == "standard", "the left half of a value goes back"
    d.click_row("Back", d.screen.pages)
    d.click_row("Resume")
    d.hold(K.K_RIGHT, 120)
    d.turns(70)
    d.press((200, 200))
    assert d.name == "ResultScreen"
    cells = d.screen.initials.cells
    d.click((cells[0].centerx, cells[0].bottom - 4))
    d.click(cells[3].center)
    assert [entry.name for entry in load_records()[0].entries("race")] == ["BAA"]
    d.click_row("Save replay")
    assert list(replays_folder().glob("race-*.json"))
    d.click_row("Menu")
    d.click_row("Back")
    d.click_row("Replays")
    d.turns(5)
    place = d.screen.list.place(0)
    d.click(place.center)
    d.click_row("Watch", d.screen.card)
    assert d.name == "Watch"
    d.turns(3)
    bar = d.screen.bar
    d.press((bar.x + bar.width // 2, bar.centery))
    d.turns(30)
    assert abs(d.screen.tape.position - d.screen.tape.length // 2) < 60


def test_a_run_left_early_is_a_recent_replay(drive):
    d = drive("--scene", "arena")
    d.hold(K.K_RIGHT, 150)
    d.key(K.K_ESCAPE)
    d.mark("Leave")
    assert d.name == "Menu"
    (path,) = recent_folder().glob("*.json")
    replay = load_replay(path)
    assert replay.scene == "arena" and replay.result is None and replay.frames >= 150


def test_a_lost_focus_pauses_nothing_that_nobody_plays(drive):
    d = drive("--scene", "arena", "--bot")
    d.turns(3)
    before = d.screen.scene.frame
    d.post(K.WINDOWFOCUSLOST)
    d.turns(3)
    assert d.name == "Play" and d.screen.scene.frame > before


def test_focus_and_pad_lost_pause(drive):
    d = drive("--scene", "arena")
    d.turns(3)
    d.post(K.WINDOWFOCUSLOST)
    d.turns(2)
    assert d.name == "PauseMenu"
    d.key(K.K_ESCAPE)
    d.post(K.CONTROLLERBUTTONDOWN, instance_id=5, button=K.CONTROLLER_BUTTON_X)
    d.turns(1)
    d.post(K.CONTROLLERDEVICEREMOVED, instance_id=5)
    d.turns(2)
    assert d.name == "PauseMenu" and "controller is gone" in d.screen.message


def test_a_scene_with_frames_ends_by_itself(drive, tmp_path, capsys):
    d = drive(
        "--scene",
        "arena",
        "--bot",
        "--frames",
        "20",
        "--json",
        "--record",
        str(tmp_path / "run.json"),
        "--screenshot",
        str(tmp_path / "shot.png"),
    )
    d.app.turn = lambda turn=d.app.turn: (setattr(d, "now", d.now + 1.0001 / 60), turn())
    assert d.app.run() == 0
    report = json.loads(capsys.readouterr().out)
    assert report["frames"] == 20
    assert (tmp_path / "run.json").exists() and (tmp_path / "shot.png").exists()
    assert not recent_folder().exists(), "a run that nobody plays leaves no replay behind"


def test_screenshot_key_writes_into_the_player_s_folder(drive, tmp_path):
    d = drive("--scene", "arena")
    d.key(K.K_F12)
    assert list((tmp_path / "screenshots").glob("arena-*.png"))


def test_closing_the_window_ends_and_keeps_the_run(drive):
    d = drive("--scene", "arena")
    d.turns(150)
    d.post(K.QUIT)
    d.turns(1)
    assert not d.app.arcade.running
    d.app.run()
    assert list(recent_folder().glob("*.json"))


def test_settings_change_a_game_at_once(drive):
    d = drive("--scene", "race", settings=Settings(window_scale=1, hint_seen=True))
    d.turns(3)
    d.settings.invincible, d.settings.shake, d.settings.speed = True, 0.5, 0.5
    d.key(K.K_ESCAPE, K.K_ESCAPE)
    d.turns(2)
    scene = d.screen.scene
    assert scene.assist == {"invincible": True, "hit_stop": True} and scene.camera.shake_share == 0.5
    before = scene.frame
    d.turns(20)
    assert scene.frame - before == pytest.approx(10, abs=1)
    assert d.screen.assisted


def test_attract_mode_comes_and_goes(drive):
    d = drive()
    d.turns(620)
    assert d.name == "Attract"
    d.turns(30)
    assert d.screen.demo.scene.frame > 20
    d.key(K.K_x)
    assert d.name == "Title" and d.screen.idle < 1.0


def test_every_row_of_the_title_leads_somewhere(drive):
    for label, name in (
        ("Replays", "ReplaysScreen"),
        ("High scores", "ScoresScreen"),
        ("Settings", "SettingsScreen"),
        ("Tour of the overlays", "Tour"),
    ):
        d = drive()
        d.turns(2)
        d.mark(label)
        d.turns(2)
        assert d.name == name
        d.key(K.K_ESCAPE)
        d.turns(2)
        assert d.name == "Title"


def test_a_recent_run_is_kept_and_its_path_copied(drive, monkeypatch):
    d = drive("--scene", "arena", settings=Settings(window_scale=1, hint_seen=True))
    d.hold(K.K_RIGHT, 150)
    d.key(K.K_ESCAPE)
    d.mark("Leave")
    d.key(K.K_ESCAPE)
    d.mark("Replays")
    d.turns(5)
    copied = []
    d.screen.copy = lambda text: copied.append(text) or True
    d.key(K.K_RETURN, K.K_DOWN, K.K_DOWN, K.K_RETURN)
    (path,) = recent_folder().glob("*.json")
    assert copied == [str(path)] and "clipboard" in d.screen.message
    d.key(K.K_UP, K.K_RETURN)
    (kept,) = replays_folder().glob("*.json")
    assert kept.read_text() == path.read_text() and "Kept as" in d.screen.message
    assert len(d.screen.entries) == 2


def test_the_tour_is_a_minute_and_can_be_walked(drive):
    d = drive(settings=Settings(window_scale=1, hint_seen=True))
    d.turns(2)
    d.mark("Tour of the overlays")
    d.turns(60)
    assert d.name == "Tour"
    d.key(K.K_RIGHT, K.K_RIGHT, K.K_RIGHT)
    assert d.screen.at == 3 and d.screen.demo.overlays.on == {d.screen.stops[3][1]}
    d.key(K.K_LEFT)
    d.pad("rb")
    assert d.screen.at == 3
    place = next(rect for rect, does in d.screen.places if does == "next")
    d.post(K.MOUSEBUTTONDOWN, button=1, pos=place.center)
    d.turns(2)
    assert d.screen.at == 4
    left, stops = 0, len(d.screen.stops) - d.screen.at
    while d.name == "Tour":
        d.turns(1)
        left += 1
    assert left / 60 == pytest.approx(5 * stops, abs=2), "the stops that are left, five seconds each"


def test_the_tour_from_a_game_comes_back_to_it(drive):
    d = drive("--scene", "race", settings=Settings(window_scale=1, hint_seen=True))
    d.turns(10)
    d.key(K.K_ESCAPE)
    d.mark("Tour of the overlays")
    d.turns(3)
    d.key(K.K_ESCAPE)
    assert d.name == "PauseMenu"
    d.key(K.K_ESCAPE)
    assert d.name == "Play" and d.screen.scene.frame < 20


@pytest.mark.parametrize("driver_refuses", [True, False])
def test_the_window_opens_with_and_without_vsync(monkeypatch, driver_refuses):
    from game.drawing import window

    asked = []

    def set_mode(size, flags, **more):
        asked.append(more)
        if more and driver_refuses:
            raise pygame.error("no vsync here")
        return size

    monkeypatch.setattr(pygame.display, "set_mode", set_mode)
    monkeypatch.setattr(pygame.display, "get_driver", lambda: "x11")
    pygame.display.init()
    assert window.set_mode(Settings(window_scale=2)) == (960, 540)
    assert asked == [{"vsync": 1}, {}][: 1 + driver_refuses]
    asked.clear()
    assert window.set_mode(Settings(window_scale=2, vsync=False)) == (960, 540) and asked == [{}]
