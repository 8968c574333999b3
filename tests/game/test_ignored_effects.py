"""Effects that a solver ignores are reported where it runs: in the HUD, in --json, in the panel and in the report."""

import json

import pygame
import pytest

from game.audio.sound import Sounds
from game.command_line import run
from game.input.devices import DeviceSource
from game.overlays.stack import Overlays, layer_names
from game.registry import Registry
from game.report.chart import Axis, Panel, panel_is, value
from game.report.charts import solvers
from game.report.plots import draw, shown
from game.run.headless import start_dummy_display
from game.run.ignored_effects import ignored_effects
from game.run.picture import Picture
from game.screens.parts.panel_rows import play_rows
from game.screens.play import Play
from physics import Effects
from tests.game.reading import Reader, assert_text_is_apart
from tests.game.test_solver_switch import Pile

SIZES = [(1440, 810), (960, 540), (480, 270), (1100, 900), (320, 180)]
IGNORED = {
    "blocking": ["rotation", "friction", "restitution", "stacking", "conveyor"],
    "projection": ["stacking"],
    "sequential_impulse": [],
    "soft_step": [],
}


class Heap(Pile):
    """A pile with all effects that the blocking solver ignores, except sleeping."""

    effects = Effects(
        response=True, gravity=True, rotation=True, friction=True, restitution=True, stacking=True, conveyor=True
    )


class Both(Heap):
    """Scene with two worlds under two solvers."""

    solvers = ("blocking", "soft_step")

    def build(self):
        super().build()
        self.worlds[0].solver = "projection"
        self.add_world(solver="blocking")


class Wordy(Heap):
    """Scene whose picture is full of text, without free space."""

    def draw(self, canvas, alpha):
        super().draw(canvas, alpha)
        for row in range(24, 264, 8):
            canvas.text("word " * 19, 2, row)


@pytest.fixture(autouse=True)
def display():
    start_dummy_display()


def play_of(scene):
    return Play(scene, DeviceSource(), Sounds(silent=True))


def hud_of(play, size=(1440, 810)):
    """Return all text on the picture of a Play, joined by spaces."""
    return " ".join(text for _, text in play.draw(Picture(pygame.Surface(size))).boxes)


@pytest.mark.parametrize("size", SIZES)
def test_the_hud_follows_the_solver(size):
    play = play_of(Heap(seed=1))
    assert "ignores" not in hud_of(play, size)
    for _ in range(5):
        play.feed(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_v, mod=0, unicode=""))
        play.step()
        solver = play.scene.world.solver
        assert ignored_effects(play.scene) == IGNORED[solver]
        reported = hud_of(play, size)
        assert ("ignores" in reported) == bool(IGNORED[solver])
        assert all(name in reported for name in IGNORED[solver])


@pytest.mark.parametrize("layers", [(), layer_names()])
@pytest.mark.parametrize("panel", [False, True])
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("kind", [Heap, Both, Wordy])
def test_the_hud_stays_apart_from_other_text_and_within_the_frame(kind, size, panel, layers):
    scene = kind(seed=1) if kind is Both else kind(seed=1, solver="blocking")
    play = play_of(scene)
    play.overlays, play.panel_open = Overlays(layers), panel
    for _ in range(3):
        play.step()
    with Reader() as reader:
        frame = play.draw(picture := Picture(pygame.Surface(size)))
        if not layers:
            reader.assert_readable()
    if size >= (480, 270):  # smaller than the canvas: the picture is cut
        assert_text_is_apart([box for box in frame.boxes if "word" not in box[1]], frame.rect)
    reported = [(rect, text) for rect, text in frame.boxes if "ignores" in text]
    assert bool(reported) != (panel and picture.presenter.crowded)
    assert all(frame.rect.contains(rect) for rect, _ in reported)


def test_worlds_of_two_solvers_are_distinguished():
    reported = hud_of(play_of(Both(seed=1)))
    assert "projection ignores stacking" in reported
    assert "blocking ignores rotation, friction, restitution, stacking, conveyor" in reported
    assert ignored_effects(Both(seed=1)) == IGNORED["blocking"]


def test_the_panel_says_so_at_the_solver():
    for solver, names in IGNORED.items():
        row = next(row for row in play_rows(play_of(Heap(seed=1, solver=solver))) if row.label == "Solver")
        assert row.hint == (f"ignores {', '.join(names)}" if names else "how overlaps are resolved")


@pytest.mark.parametrize("solver", IGNORED)
def test_json_lists_what_is_ignored(solver, capsys):
    listing = {"heap": "tests.game.test_ignored_effects:Heap"}
    assert run(["--headless", "--scene", "heap", "--frames", "3", "--solver", solver, "--json"], Registry(listing)) == 0
    reported = json.loads(capsys.readouterr().out)
    assert (reported["solver"], reported["ignored_effects"]) == (solver, IGNORED[solver])


def test_the_report_names_it_at_every_dot():
    panel = Panel("", Axis("x", value("x")), Axis("y", value("y")), panel_is("all"))
    row = {"series": "blocking", "label": "blocking", "panel": "all", "x": 1.0, "y": 2.0, "job": "job"}
    for names, wanted in ((["rotation", "one_way"], "rotation, one way"), ([], None)):
        _, (dot,) = draw(panel, [row | {"ignored_effects": names}], "plot")
        assert shown(dot, panel).get("effects that the solver ignores") == wanted


def test_the_report_knows_it_of_every_solver():
    rows = {row["series"]: row for row in solvers.measure("stack of 10", quick=True)}
    assert {name: row["ignored_effects"] for name, row in rows.items()} == {
        "projection": ["stacking"],
        "sequential_impulse": [],
        "soft_step": [],
    }
