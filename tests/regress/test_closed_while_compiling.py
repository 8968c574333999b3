"""Closing the window while kernels compiled was a traceback, except from the menu: at the start, in the tour."""

import pygame
import pytest

from game.app import run_app
from game.command_line import read_options
from game.registry import Registry
from game.screens.arcade import Arcade
from game.screens.loading import LoadingStopped
from game.screens.play import Play
from tests.game.arena import GAMES
from tests.game.test_replay import record


def closed_in_front_of_the_bar(app, *arguments, **more):
    pygame.event.post(pygame.event.Event(pygame.QUIT))
    raise LoadingStopped


@pytest.fixture
def recording(tmp_path):
    record(tmp_path / "run.json", 30)
    return str(tmp_path / "run.json")


@pytest.mark.parametrize("flag", ["--scene", "--replay"])
def test_at_the_start(monkeypatch, recording, flag):
    monkeypatch.setattr(Arcade, "compile_for", closed_in_front_of_the_bar)
    registry = Registry(GAMES)
    options = read_options([flag, "arena" if flag == "--scene" else recording], registry)
    assert run_app(options, registry) == 0


def test_in_the_tour(drive, monkeypatch):
    d = drive()
    d.turns(2)
    monkeypatch.setattr(Arcade, "compile_for", closed_in_front_of_the_bar)
    d.mark("Tour of the overlays")
    d.turns(2)
    assert not d.app.arcade.running


def test_for_another_solver(drive, monkeypatch):
    d = drive("--scene", "arena")
    d.turns(2)
    monkeypatch.setattr(Play, "switch_solver", lambda play, way: play.prepare("projection"))
    monkeypatch.setattr(type(d.screen.scene), "solver_choices", lambda scene: ("projection",))
    monkeypatch.setattr(Arcade, "compile_for", closed_in_front_of_the_bar)
    d.key(pygame.K_v)
    assert not d.app.arcade.running
