"""The sound device, the window or the display fails or disappears while the game runs."""

import pygame as K
import pytest

from game.audio.sound import Sounds
from game.errors import UsageError
from game.files.records import load_records
from game.files.settings import Settings, load_settings
from game.run.replay import load_replay
from game.run.replay_shelf import shelf


class Report(list):
    """List that collects the reported lines."""

    def __call__(self, line):
        self.append(line)


@pytest.fixture
def sounds():
    yield Sounds(report=Report())
    K.mixer.quit()


def everything(sounds):
    """Make all sound calls that a game makes in a few frames."""
    sounds.play("laser", 100.0)
    sounds.play_cues([("hit", 10.0, 1.0), ("coin", None, 0.5)])
    sounds.tune("title")
    sounds.step(1 / 60)
    sounds.jingle("victory")
    sounds.pause()
    sounds.step(1 / 60)
    sounds.resume()
    sounds.step(1 / 60)


@pytest.mark.parametrize("playing", [True, False])
def test_a_sound_device_that_goes_away_is_silence_and_one_line(sounds, playing):
    assert not sounds.silent_because
    if playing:
        everything(sounds)
    K.mixer.quit()
    for _ in range(3):
        everything(sounds)
    assert len(sounds.report) == 1 and "sound device is gone" in sounds.report[0]
    assert "gone" in sounds.silent_because and not sounds.play("laser")


@pytest.mark.parametrize("call", ["Channel.play", "Channel.get_busy", "music.set_volume", "Sound"])
def test_a_mixer_that_refuses_is_a_device_that_went_away(sounds, monkeypatch, call):
    def refuse(*arguments, **more):
        raise K.error("Device unplugged")

    if call.startswith("Channel"):

        class Unplugged:
            play = get_busy = set_volume = refuse

        for voice in sounds.voices:
            voice.channel = Unplugged()
    else:
        monkeypatch.setattr(f"pygame.mixer.{call}", refuse)
    for _ in range(3):
        everything(sounds)
    assert sounds.report == ["the sound device is gone (Device unplugged); the game goes on in silence"]


def test_a_game_goes_on_when_its_sound_is_lost(drive, capsys):
    d = drive("--scene", "race", settings=Settings(hint_seen=True))
    d.turns(10)
    K.mixer.quit()
    d.turns(60)
    d.key(K.K_ESCAPE)
    assert d.name == "PauseMenu" and capsys.readouterr().err.count("sound device is gone") == 1


@pytest.mark.parametrize("size", [(1, 1), (2, 700), (700, 2), (33, 21)])
@pytest.mark.parametrize("overlays", ["", "all"])
def test_a_window_of_a_few_pixels_is_drawn_into(drive, size, overlays):
    """A window of a few pixels causes no error, and after a return to the old size everything is drawn again."""
    arguments = ("--overlay", overlays) if overlays else ()
    d = drive("--scene", "race", *arguments, settings=Settings(hint_seen=True))
    d.turns(3)
    before = K.display.get_window_size()
    for way in (size, before):
        K.display.set_mode(way, K.RESIZABLE)
        d.post(K.VIDEORESIZE, size=way, w=way[0], h=way[1])
        d.turns(5)
        assert d.app.window.get_size() == way
        for key in (K.K_TAB, K.K_ESCAPE, K.K_ESCAPE, K.K_F12):
            d.key(key)
    assert d.app.arcade.running


def test_a_window_that_cannot_be_changed_stays_as_it_is(drive, monkeypatch, capsys):
    d = drive("--scene", "race", settings=Settings(hint_seen=True, window_scale=1))
    d.turns(3)
    window = d.app.window

    def refuse(*arguments, **more):
        raise K.error("Couldn't find matching render driver")

    monkeypatch.setattr("pygame.display.set_mode", refuse)
    d.key(K.K_F11)
    d.turns(5)
    assert d.app.window is window and d.app.arcade.running
    assert "the window stays as it is: Couldn't find matching render driver" in capsys.readouterr().err


def test_a_display_that_goes_away_ends_with_one_line_and_keeps_the_run(drive, monkeypatch):
    d = drive("--scene", "race", settings=Settings(hint_seen=True, master=0.3))
    d.turns(150)
    turns, turn = iter(range(20)), d.app.turn

    def counted():
        if next(turns) == 5:
            K.display.quit()
        d.now += 1.0001 / 60
        turn()

    monkeypatch.setattr(d.app, "turn", counted)
    d.app.options.scene = None
    with pytest.raises(UsageError, match="the display is gone .*what was played and chosen is kept"):
        d.app.run()
    K.display.init()
    assert load_settings()[0].master == 0.3
    (kept,) = shelf()
    assert load_replay(kept[0]).frames >= 150 and load_records()[1] == ""
