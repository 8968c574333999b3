"""The solver can be switched while a scene is played, by key and panel, and a recording contains the switch."""

import pygame
import pytest

from game.audio.sound import Sounds
from game.input.devices import DeviceSource
from game.run.headless import start_dummy_display
from game.screens.parts.panel_rows import play_rows
from game.screens.play import Play
from physics import Effects, Polygon
from tests.game.arena import Arena


class Pile(Arena):
    """The scene Arena with two crates on a floor."""

    effects = Effects(response=True, gravity=True, stacking=True)

    def build(self):
        super().build()
        self.world.add_body(Polygon.box(400, 20), position=(200, 200), kind="static")
        for k in range(2):
            self.world.add_body(Polygon.box(20, 20), position=(300, 180 - 20 * k))


class OwnSolvers(Pile):
    """A scene whose worlds have a solver each."""

    solvers = ("soft_step", "projection")


@pytest.fixture(autouse=True)
def display():
    start_dummy_display()


def pressed(play, key):
    play.feed(pygame.event.Event(pygame.KEYDOWN, key=key, mod=0, unicode=""))
    play.step()


def test_key_switches_every_world_to_the_next_solver():
    play = Play(Pile(seed=1), DeviceSource(), Sounds(silent=True))
    seen = []
    for _ in range(5):
        pressed(play, pygame.K_v)
        seen.append(play.scene.world.solver)
    assert seen == ["blocking", "projection", "sequential_impulse", "soft_step", "blocking"]
    play.scene.change("restart", True)
    assert play.scene.world.solver == "blocking", "a restart keeps what was chosen"


def test_panel_has_the_row_where_there_is_a_choice():
    titles = [
        [row.label for row in play_rows(Play(kind(seed=1), DeviceSource(), Sounds(silent=True)))]
        for kind in (Pile, OwnSolvers, Arena)
    ]
    assert ["Solver" in each for each in titles] == [True, False, False]


def test_wrong_solvers_are_refused():
    for scene, name in ((Pile(seed=1), "magic"), (Arena(seed=1), "projection"), (OwnSolvers(seed=1), "soft_step")):
        with pytest.raises(ValueError, match="solver"):
            scene.change("solver", name)
