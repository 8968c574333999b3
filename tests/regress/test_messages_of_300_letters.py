"""Messages show at most 300 letters of a name from a file or the command line."""

import json
import sys
import warnings
from itertools import product

import pytest

from game import startup
from game.command_line import run
from game.errors import LONGEST, FileError, ReplayDiverged, UsageError, brief, unknown_name
from game.files.data_folder import refusal
from game.files.records import load_records
from game.files.settings import load_settings
from game.registry import Registry
from game.run.replay import Replay
from game.screens.message_screen import error_message
from scenes import SCENES
from tests.game.arena import GAMES, LISTING
from tests.game.test_replay import record

HEAD = "hitbox: "
LENGTHS = (0, 1, 50, 100, 150, 299, 300, 301, 5000)
LETTERS = {"n": "n", "wide": "\N{GRINNING FACE}", "line": "\n", "escape": "\x1b", "no text": "\udce9"}


def test_the_bound():
    assert LONGEST == 300


@pytest.mark.parametrize("letter", LETTERS.values(), ids=LETTERS)
@pytest.mark.parametrize("length", LENGTHS)
def test_a_line_keeps_its_beginning_and_its_end(length, letter):
    line = brief(f"first {letter * length} last")
    assert len(line) <= LONGEST and line.startswith("first ") and line.endswith(" last") and line.isprintable()
    assert length > 280 or len(line) == length + 11, "nothing is cut that fits"


@pytest.mark.parametrize("path", LENGTHS)
def test_a_file_its_place_and_the_reason_share_it(path):
    for place, reason in product(LENGTHS, LENGTHS):
        error = FileError(f"/f/{'p' * path}/mine.tmj", f"layers{'q' * place}.data", f"must be{'r' * reason} 1..9")
        line = str(error)
        assert len(line) <= LONGEST
        assert line.startswith("/f/") and "mine.tmj: " in line and ".data: must be" in line and line.endswith("1..9")
        whole = f"{error.path}: {error.place}: {error.reason}"
        assert line == whole or len(whole) > LONGEST
        assert [text for _, text in error.parts] == line.split(": ")


@pytest.mark.parametrize("path", LENGTHS)
def test_a_file_that_is_put_aside(tmp_path, path):
    folder = tmp_path / ("p" * min(path, 200))
    folder.mkdir(exist_ok=True)
    (folder / "settings.json").write_text("{")
    for reason in LENGTHS:
        line = refusal(folder / "settings.json", "line 1", "r" * reason, "defaults are used")
        assert len(line) <= LONGEST and line.isprintable() and "settings.json: line 1: " in line
        assert line.endswith("defaults are used, the old file is kept as settings.json.damaged-1")


@pytest.mark.parametrize("content", [
    {"version": 2, "palette": "n" * 5000},
    {"version": "n" * 5000},
    {"version": 2, "keys": {"n" * 5000: []}},
    {"version": 2, "initials": ["n" * 5000]},
    {"version": 1, "tables": {"n" * 5000: 3}},
    {"version": 1, "tables": {"lander": [{"n" * 5000: 3}]}},
])  # fmt: skip
@pytest.mark.parametrize("load", [load_settings, load_records])
def test_names_in_the_files_of_the_player(tmp_path, load, content):
    path = tmp_path / "mine.json"
    path.write_text(json.dumps(content))
    assert len(load(path)[1]) <= LONGEST


WRONG = [
    ["--scene", "n" * 5000],
    ["--" + "n" * 5000],
    ["--frames", "n" * 5000],
    ["--overlay", "n" * 5000],
    ["--scene", "arena", "--solver", "n" * 5000],
    ["--scene", "arena", "--tier", "n" * 5000],
    ["--replay", "n" * 200],
    ["--replay", "n" * 5000],
    ["--scene", "race", "--headless", "--level", "n" * 200],
    ["--report", "n" * 5000],
    ["--report", "{folder}", "--quick", "--only", "n" * 5000],
    ["--scene", "arena", "--headless", "--record", "folder/" * 40],
]


@pytest.mark.parametrize("arguments", WRONG, ids=lambda arguments: " ".join(each[:12] for each in arguments))
def test_on_the_command_line(capsys, tmp_path, monkeypatch, arguments):
    monkeypatch.chdir(tmp_path)
    (tmp_path / ("folder/" * 40)).mkdir(parents=True)
    listing = SCENES if "--only" in arguments else GAMES  # the report asks for the game's scenes
    assert run([each.format(folder=tmp_path / "made") for each in arguments], Registry(listing)) == 2
    reported = capsys.readouterr().err.splitlines()
    lines = [line for line in reported if "both pygame" not in line and "numba is not in use" not in line]
    assert len(lines) == 1 and len(lines[0].split("; valid: ")[0]) <= len(HEAD) + LONGEST, lines


def test_the_program_s_own_names_are_all_there():
    names = [f"lab/scene_{number}" for number in range(100)]
    error = unknown_name("scene", "lab/scene_7x", names)
    assert str(error).endswith("; did you mean lab/scene_7?") and f"; valid: {', '.join(names)}" in str(error)
    error = unknown_name("scene", "n" * 5000, names)
    assert f"; valid: {', '.join(names)}" in str(error) and "n" * 61 not in str(error)


def test_a_line_on_standard_error(capsys):
    startup.say("n" * 5000 + "\nend")
    (line,) = capsys.readouterr().err.splitlines()
    assert len(line) == len(HEAD) + LONGEST and line.endswith("end")


def test_a_warning(capsys, monkeypatch):
    from tests.game.arena import Arena

    monkeypatch.setattr(Arena, "observe", lambda self: warnings.warn("n" * 5000, DeprecationWarning, stacklevel=1))
    with warnings.catch_warnings():
        assert run(["--scene", "arena", "--headless", "--frames", "2", "--strict"], Registry(LISTING)) == 1
    assert all(len(line) <= len(HEAD) + LONGEST for line in capsys.readouterr().err.splitlines())


def test_a_replay_that_diverges(tmp_path):
    from game.run.replay import load_replay
    from tests.game.test_replay import played

    path = tmp_path / "run.json"
    record(path, 3)
    found = load_replay(path)
    found.path, found.digests = "n" * 5000, ["0" * 16] * 3
    with pytest.raises(ReplayDiverged, match="diverged at frame 1") as caught:
        played(found)
    assert isinstance(found, Replay) and len(str(caught.value)) <= LONGEST


@pytest.mark.parametrize("error", [UsageError("n" * 5000), FileError("n" * 5000, "p" * 5000, "r" * 5000)])
def test_on_a_screen(error):
    screen = error_message(error)
    assert sum(len(text) for _, text in screen.parts) <= LONGEST


def test_without_a_terminal(monkeypatch):
    monkeypatch.setattr(sys, "stderr", None)
    startup.say("n" * 5000)
