"""With --record, leaving a game by its pause menu writes the recording and ends the program."""

import pygame

from game.run.replay import load_replay


def test_what_was_played_is_written(drive, tmp_path):
    path = tmp_path / "run.json"
    d = drive("--scene", "arena", "--record", str(path))
    d.turns(30)
    d.key(pygame.K_ESCAPE)
    d.mark("Leave")
    assert d.name == "PauseMenu" and not d.app.arcade.running
    d.app.run()
    assert load_replay(path).frames >= 30
