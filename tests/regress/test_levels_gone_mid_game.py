"""If a level is deleted while it is played, Restart gives a message, and a finished run still
enters the high scores.
"""

import pygame as K

from game.files.records import load_records
from tests.game.test_runs import SEEN, Settings, finish_race, make_level


def play_mine(drive, tmp_path):
    path = make_level(tmp_path, "{}")
    d = drive(settings=Settings(**SEEN))
    d.turns(2)
    d.key(K.K_RETURN)
    d.mark("mine")
    assert d.name == "Play"
    return d, path


def test_a_restart_is_a_message_and_the_menu_goes_on(drive, tmp_path):
    d, path = play_mine(drive, tmp_path)
    d.turns(5)
    path.unlink()
    d.key(K.K_r)
    assert d.name == "MessageScreen" and dict(d.screen.parts)["file"] == str(path)
    assert d.app.arcade.devices.menus
    d.key(K.K_RETURN)
    assert d.name == "Menu"


def test_the_run_has_its_place(drive, tmp_path):
    d, path = play_mine(drive, tmp_path)
    d.turns(5)
    path.unlink()
    finish_race(d)
    d.key(K.K_ESCAPE)
    (table,) = load_records()[0].tables
    assert table.startswith("race@")
