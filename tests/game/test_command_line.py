"""Every command-line flag: its effect, and its one-line message for a wrong value."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from game.command_line import run
from game.registry import Registry
from tests.game.arena import GAMES, LISTING

ROOT = Path(__file__).resolve().parents[2]
HEADLESS = ["--headless", "--scene", "arena", "--frames", "90"]


def call(capsys, *arguments):
    code = run(list(arguments), Registry(LISTING))
    out, err = capsys.readouterr()
    return code, out, err


def test_json_is_one_object_with_the_documented_names(capsys):
    code, out, _ = call(capsys, *HEADLESS, "--seed", "4", "--bot", "--json")
    report = json.loads(out)
    assert code == 0
    assert set(report) == {
        "scene",
        "frames",
        "seed",
        "effects",
        "broadphase",
        "solver",
        "ignored_effects",
        "tier",
        "digest",
        "check",
        "counters",
        "stages_ms",
        "frame_ms",
        "events",
    }
    assert (report["scene"], report["frames"], report["seed"]) == ("arena", 90, 4)
    assert report["effects"] == ["narrowphase"]
    assert set(report["check"]) == {"ok", "failures", "pending"} and report["check"]["ok"]
    assert len(report["check"]["pending"]) == 1
    assert set(report["frame_ms"]) == {"mean", "p50", "p99"}
    assert all(set(stage) == {"mean", "p99"} for stage in report["stages_ms"].values())
    assert set(report["events"]) == {"begin", "persist", "end", "hits"}


def test_a_goal_missed_in_time_exits_1(capsys):
    code, out, _ = call(capsys, "--headless", "--scene", "arena", "--frames", "130", "--json")
    assert code == 0 and json.loads(out)["check"]["pending"], "nobody played, so nothing is checked"
    code, out, _ = call(capsys, "--headless", "--scene", "arena", "--frames", "20", "--bot")
    assert code == 0 and "2 goals pending" in out


def test_drawing_changes_nothing(capsys, tmp_path):
    plain = json.loads(call(capsys, *HEADLESS, "--bot", "--json")[1])
    picture = tmp_path / "shot.png"
    drawn = json.loads(call(capsys, *HEADLESS, "--bot", "--json", "--overlay", "all", "--screenshot", str(picture))[1])
    assert plain["digest"] == drawn["digest"]
    import pygame

    assert pygame.image.load(str(picture)).get_size() == (1440, 810)


def test_record_and_replay(capsys, tmp_path):
    path = str(tmp_path / "run.json")
    first = json.loads(call(capsys, *HEADLESS, "--bot", "--json", "--record", path)[1])
    code, out, _ = call(capsys, "--headless", "--replay", path, "--json")
    assert code == 0 and json.loads(out)["digest"] == first["digest"]
    assert json.loads(out)["check"] == first["check"]
    text = Path(path).read_text().replace('"right"', '"left"')
    Path(path).write_text(text)
    code, _, err = call(capsys, "--headless", "--replay", path, "--json")
    assert code == 1 and "diverged at frame 1:" in err


def test_list(capsys):
    code, out, _ = call(capsys, "--list", "--json")
    assert code == 0 and json.loads(out) == [
        {"name": "arena", "title": "Arena", "effects": ["narrowphase"], "features": []}
    ]
    assert "Arena" in call(capsys, "--list")[1]


def test_version_names_what_it_runs_on(capsys):
    code, out, _ = call(capsys, "--version")
    assert code == 0 and out.startswith("Hitbox ") and "numpy" in out and len(out.splitlines()) == 1


def test_profile_prints_a_table(capsys):
    code, out, _ = call(capsys, *HEADLESS, "--profile")
    assert code == 0 and "p99" in out and "update" in out


WRONG = [
    (["--scene", "shoter"], "no scene 'shoter'; valid: arena"),
    (["--scene", "arena", "--broadphase", "octree"], "valid: brute, sweep, hash, tree"),
    (
        ["--scene", "arena", "--solver", "soft_step"],
        "--solver: arena cannot use soft_step, which needs the effect stacking; ",
    ),
    (["--scene", "arena", "--solver", "magic"], "no solver 'magic'; valid: "),
    (["--scene", "arena", "--overlay", "bounds,boxes"], "no overlay 'boxes'; valid: bounds, motion"),
    (["--scene", "arena", "--tier", "pixels"], "arena has no sprite bodies"),
    (["--scene", "arena", "--tier", "voxels"], "no tier 'voxels'; valid: "),
    (["--frames", "0", "--scene", "arena"], "--frames must be at least 1"),
    (["--frames", "ten", "--scene", "arena"], "invalid int value: 'ten'"),
    (["--seed", "-1", "--scene", "arena"], "--seed must be 0 to"),
    (["--headless"], "--headless needs --scene; valid: arena"),
    (["--json"], "--json needs --list or --scene"),
    (["--replay", "/nowhere/run.json"], "/nowhere/run.json: file: No such file"),
    (["--level", "mine.json"], "--level needs --scene; scenes that take one: none here"),
    (["--scene", "arena", "--level", "mine.json"], "--level: arena takes none; scenes that take one: none here"),
    (["--fullscreen"], "no flag '--fullscreen'; valid: "),
    (["--scene"], "expected one argument"),
    ([*HEADLESS, "--screenshot", "/nowhere/shot.png"], "/nowhere/shot.png: cannot be written"),
]


@pytest.mark.parametrize("arguments, line", WRONG)
def test_wrong_use_is_one_line_and_exit_2(capsys, arguments, line):
    code, out, err = call(capsys, *arguments)
    assert code == 2 and out == ""
    lines = [each for each in err.splitlines() if "numba is not in use" not in each and "both pygame" not in each]
    assert len(lines) == 1 and line in lines[0] and lines[0].startswith("hitbox: ")


@pytest.mark.parametrize(
    "text, line",
    [("a mistake", "mine.json: line 1: has a mistake in it"), (None, "mine.json: file: No such file or directory")],
)
def test_a_level_with_a_mistake_is_one_line_and_exit_2(capsys, tmp_path, text, line):
    level = tmp_path / "mine.json"
    if text is not None:
        level.write_text(text)
    code = run(["--headless", "--scene", "race", "--frames", "5", "--level", str(level)], Registry(GAMES))
    out, err = capsys.readouterr()
    assert code == 2 and out == "" and line in err and "Traceback" not in err


def test_a_level_of_one_s_own_is_played_and_recorded(capsys, tmp_path):
    level, path = tmp_path / "mine.json", tmp_path / "run.json"
    level.write_text("{}")
    play = ["--headless", "--scene", "race", "--frames", "50", "--bot", "--json"]
    assert run([*play, "--level", str(level), "--record", str(path)], Registry(GAMES)) == 0
    first = json.loads(capsys.readouterr().out)
    assert run(["--headless", "--replay", str(path), "--json"], Registry(GAMES)) == 0
    assert json.loads(capsys.readouterr().out)["digest"] == first["digest"]
    level.write_text("{ }")
    assert run(["--headless", "--replay", str(path), "--json"], Registry(GAMES)) == 2
    assert "has changed since" in capsys.readouterr().err


def test_headless_runs_leave_nothing_behind(capsys, tmp_path, monkeypatch):
    monkeypatch.setenv("HITBOX_DATA", str(tmp_path / "data"))
    assert run(["--headless", "--scene", "dash", "--frames", "90", "--bot"], Registry(GAMES)) == 0
    assert not (tmp_path / "data").exists()


def test_strict_fails_on_warnings(capsys, monkeypatch):
    import warnings

    from tests.game.arena import Arena

    before = warnings.filters[:]
    monkeypatch.setattr(Arena, "observe", lambda self: warnings.warn("old", DeprecationWarning, stacklevel=1))
    try:
        code, _, err = call(capsys, *HEADLESS, "--strict")
    finally:
        warnings.filters[:] = before
    assert code == 1 and "DeprecationWarning: old" in err


def test_no_display_names_headless():
    environment = {k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")}
    done = subprocess.run(
        [sys.executable, "main.py"], cwd=ROOT, env=environment, capture_output=True, text=True, timeout=120
    )
    if done.returncode == 0:
        pytest.skip("this machine has a display")
    assert done.returncode == 2
    assert "--headless" in done.stderr and "Traceback" not in done.stderr
