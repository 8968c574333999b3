"""The numbers of a scene as CSV, by F9 in a game and by --csv, each with a command that reproduces it."""

import csv
import io
import shlex

import pygame
import pytest

import main
import physics
from game.command_line import read_options
from game.errors import UsageError
from game.files.data_folder import short_path
from game.input.devices import DeviceSource
from game.input.inputs import InputState
from game.measure.effect_totals import EffectTotal
from game.measure.timing import RUNS, Cost
from game.registry import Registry
from game.run.figures_csv import COLUMNS, command_of, figures_csv
from game.screens.play import Play
from scenes import SCENES
from tests.game.test_findings import figures_of
from tests.game.test_lab_card import Silent
from tests.lockstep import make_scene

LABS = [name for name in SCENES if name.startswith("lab/")]
needs_speed = pytest.mark.skipif(not physics.JIT, reason="a hundred frames and measured runs")


def rows_of(text):
    return list(csv.DictReader(io.StringIO(text)))


def played(name, steps=30):
    scene, inputs = make_scene(name, few=True), InputState()
    for _ in range(steps):
        scene.step(inputs)
    return scene


@pytest.mark.parametrize("name", LABS)
def test_every_lab_has_its_numbers_with_a_command(name):
    scene = played(name)
    scene.figures = figures_of(scene) if scene.measured() is not None else {}
    rows = rows_of(figures_csv(scene, command_of(scene)))
    assert rows and list(rows[0]) == list(COLUMNS)
    shown = {row["of"] for row in rows}
    assert {"goal", "finding"} <= shown and ("headline" in shown) == scene.headline().known
    assert (shown & {"run", "tier"} != set()) == bool(scene.figures)
    for row in rows:
        words = shlex.split(row["command"])
        assert f"--scene {name} " in row["command"] and row["step"] == "30" and words[-1] == "figures.csv"
        options = read_options(words[words.index("--scene") :], Registry(SCENES))
        assert options.scene == name and options.frames == 30 and options.csv


def test_a_row_of_time_has_its_interval():
    scene = played("lab/filters", 3)
    scene.totals = {"declared": EffectTotal(3, Cost(1e-6, 2e-6, 4e-6, RUNS, 60), 7, None, 5000)}
    rows = {row["name"]: row for row in rows_of(figures_csv(scene, "x")) if row["of"] == "effects"}
    assert [rows["declared, time"][name] for name in ("value", "low", "high", "unit")] == ["2.0", "1.0", "4.0", "us"]
    assert rows["declared, bytes"]["value"] == "5.0" and "declared, start" not in rows, "what is unknown has no row"


@pytest.mark.usefixtures("nothing_is_measured")
def test_f9_saves_the_numbers_and_the_run(tmp_path, monkeypatch):
    monkeypatch.setenv("HITBOX_DATA", str(tmp_path))
    play = Play(make_scene("lab/filters"), DeviceSource(), Silent())
    for _ in range(20):
        play.step()
    play.feed(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_F9, mod=0, unicode=""))
    (saved,) = (tmp_path / "measurements").glob("*.csv")
    assert play.news == f"saved as {short_path(saved)}"
    (row, *_) = rows_of(saved.read_text())
    replay = saved.with_suffix(".json")
    assert replay.is_file() and str(replay) in shlex.split(row["command"])
    again = tmp_path / "again.csv"
    assert main.main(["--replay", str(replay), "--headless", "--csv", str(again)]) == 0
    first, second = ({(r["of"], r["name"]): r["value"] for r in rows_of(each.read_text())} for each in (saved, again))
    assert first.items() <= second.items(), "the command finds the same numbers, and measures the times"


@needs_speed
def test_the_flag_measures_what_the_lab_asks_for(tmp_path, capsys):
    path = tmp_path / "figures.csv"
    assert main.main(["--scene", "lab/stacks", "--headless", "--bot", "--frames", "130", "--csv", str(path)]) == 0
    rows = rows_of(path.read_text())
    timed = [row for row in rows if row["of"] == "run"]
    assert len(timed) == 3 and all(float(row["low"]) <= float(row["value"]) <= float(row["high"]) for row in timed)
    assert "--bot" in rows[0]["command"] and any(row["of"] == "headline" for row in rows)


def test_a_file_needs_a_run():
    with pytest.raises(UsageError, match="--csv needs --headless or --advise"):
        read_options(["--scene", "lab/stacks", "--csv", "x.csv"], Registry(SCENES))
