"""A file that is no replay, dropped on a running game, does not end the game."""

import pygame as K
import pytest

from tests.game.test_runs import SEEN, Settings


@pytest.mark.parametrize("watching", [False, True])
def test_the_game_goes_on_below_the_message(drive, tmp_path, watching):
    from tests.game.test_replay import record

    d = drive("--scene", "race", settings=Settings(**SEEN))
    d.turns(5)
    play = d.screen
    if watching:
        record(tmp_path / "run.json", 200)
        d.post(K.DROPFILE, file=str(tmp_path / "run.json"))
        d.turns(5)
        assert d.name == "Watch"
    d.post(K.DROPFILE, file=str(tmp_path / "no_such_file.json"))
    d.turns(2)
    assert d.name == "MessageScreen"
    d.key(K.K_RETURN)
    assert d.name == ("Watch" if watching else "Play")
    if watching:
        d.key(K.K_ESCAPE)
    assert d.screen is play and play.recorder is not None
