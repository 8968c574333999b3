"""An unreadable level gives a message from which the player gets back to the menu."""

from pathlib import Path

import pygame as K
import pytest

from tests.game.test_runs import make_level


@pytest.fixture
def unreadable(monkeypatch):
    read = Path.read_bytes

    def refuse(path):
        if path.parent.name == "levels":
            raise PermissionError(13, "Permission denied", str(path))
        return read(path)

    monkeypatch.setattr(Path, "read_bytes", refuse)


def test_the_menu_goes_on(drive, tmp_path, unreadable):
    make_level(tmp_path, "fine")
    d = drive()
    d.turns(2)
    d.key(K.K_RETURN)
    for _ in range(8):
        d.key(K.K_DOWN)
        assert d.name == "Menu"
    d.mark("mine")
    assert d.name == "MessageScreen" and dict(d.screen.parts)["reason"] == "Permission denied"
    d.key(K.K_RETURN)
    assert d.name == "Menu"
