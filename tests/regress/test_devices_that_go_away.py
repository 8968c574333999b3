"""A sound device, display or window mode lost during play does not end the game; before the fix it ended in a
traceback.
"""

import pygame as K
import pytest

from game.audio.sound import Sounds
from game.errors import UsageError
from game.files.settings import Settings


def test_sounds_are_silent_from_then_on():
    said = []
    sounds = Sounds(report=said.append)
    K.mixer.quit()
    for _ in range(3):
        assert not sounds.play("laser")
        sounds.tune("title")
        sounds.step(1 / 60)
    assert said == ["the sound device is gone (mixer not initialized); the game goes on in silence"]


def test_a_mode_that_is_refused_leaves_the_window(drive, monkeypatch, capsys):
    d = drive("--scene", "race", settings=Settings(hint_seen=True, window_scale=1))
    monkeypatch.setattr("pygame.display.set_mode", lambda *a, **b: (_ for _ in ()).throw(K.error("no such mode")))
    window = d.app.window
    d.key(K.K_F11)
    assert d.app.window is window and "the window stays as it is: no such mode" in capsys.readouterr().err


def test_a_display_that_is_gone_is_one_line(drive):
    d = drive("--scene", "race", settings=Settings(hint_seen=True, window_scale=1))
    d.turns(2)
    K.display.quit()
    with pytest.raises(UsageError, match="the display is gone"):
        d.app.run()
    K.display.init()
