"""Copying the path of a file whose name is not valid text does not stop the program."""

import pygame

from game.drawing.window import copy_text


def test_the_clipboard_refuses(monkeypatch):
    pygame.display.init()
    pygame.display.set_mode((480, 270))
    assert copy_text("replay-\udcff.json") is False
