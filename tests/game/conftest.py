"""Fixtures that give each test of the shell its own data folder, and a driver for the whole program."""

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
    """Yield a function drive(*arguments, **more), which starts the whole program under the dummy video driver
    (`Driver`).
    """
    pygame.display.init()
    yield lambda *arguments, **more: Driver(monkeypatch, *arguments, **more)
    pygame.event.clear()
