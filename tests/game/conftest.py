"""The shell's tests have a data folder of their own."""

import pygame
import pytest

from tests.game.driving import Driver


@pytest.fixture(autouse=True)
def data_folder_of_the_test(tmp_path, monkeypatch):
    """Give each test a data folder of its own, so that it neither reads nor writes the user's files."""
    monkeypatch.setenv("HITBOX_DATA", str(tmp_path))
    monkeypatch.setenv("SDL_VIDEODRIVER", "dummy")
    monkeypatch.setenv("SDL_AUDIODRIVER", "dummy")


@pytest.fixture
def drive(monkeypatch):
    """Return drive(*arguments), which starts the whole program under the dummy driver."""
    pygame.display.init()
    yield lambda *arguments, **more: Driver(monkeypatch, *arguments, **more)
    pygame.event.clear()
