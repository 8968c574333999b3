"""A file name that the system does not accept gives a message in every part of the program, not a traceback."""

from pathlib import Path

import pytest

from game.command_line import run
from game.errors import FileError, UsageError
from game.files.best_run import load_ghost
from game.files.data_folder import is_there, write_atomically
from game.files.json_file import read_json
from game.files.own_levels import level_digest, own_levels
from game.files.records import load_records
from game.files.settings import load_settings
from game.registry import Registry
from game.report.store import Store
from game.run.replay import load_replay
from game.run.replay_check import load_replay_for
from game.run.replay_shelf import shelf
from scenes import SCENES
from scenes.lab.ladder import own_picture
from scenes.platformer.level import level_of
from scenes.shooter.stage import load_stage
from tests.game.arena import GAMES
from tests.game.test_replay import record
from tests.scenes.test_platformer_maps import save, small

LONG = "n" * 5000
NAMES = {
    "a long name": LONG,
    "a long folder": f"{LONG}/mine",
    "a long path": "folder/" * 3000 + "mine",
    "many bytes": "\N{GRINNING FACE}" * 100,
    "a zero in it": "mi\0ne",
}
READERS = {
    "any": read_json,
    "recording": load_replay,
    "level": level_of,
    "stage": load_stage,
    "picture": own_picture,
    "digest": level_digest,
}


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("HITBOX_DATA", str(tmp_path / "data"))


@pytest.mark.parametrize("name", NAMES.values(), ids=NAMES)
@pytest.mark.parametrize("reader", READERS)
def test_a_file_to_read(reader, name):
    with pytest.raises(FileError) as caught:
        READERS[reader](name)
    assert len(str(caught.value)) <= 300


@pytest.mark.parametrize("name", NAMES.values(), ids=NAMES)
def test_a_folder_of_a_report(name):
    with pytest.raises(UsageError, match="^--report: ") as caught:
        Store(Path(name), True)
    assert len(str(caught.value)) <= 300


@pytest.mark.parametrize("name", NAMES.values(), ids=NAMES)
@pytest.mark.parametrize(
    "arguments",
    [
        ["--scene", "race", "--headless", "--frames", "2", "--record"],
        ["--scene", "race", "--headless", "--frames", "2", "--screenshot"],
        ["--headless", "--frames", "2", "--replay"],
        ["--scene", "race", "--headless", "--frames", "2", "--level"],
    ],
    ids=lambda arguments: arguments[-1],
)
def test_on_the_command_line(capsys, arguments, name):
    assert run([*arguments, name], Registry(GAMES)) == 2
    out, err = capsys.readouterr()
    lines = [line for line in err.splitlines() if "numba is not in use" not in line and "both pygame" not in line]
    assert out == "" and len(lines) == 1 and len(lines[0]) <= 308


@pytest.mark.parametrize("name", NAMES.values(), ids=NAMES)
def test_a_level_that_a_recording_names(tmp_path, name):
    import json

    path = tmp_path / "run.json"
    record(path, 3)
    entries = {"scene": "platformer", "tier": None, "level": {"path": name, "digest": "0" * 12}}
    path.write_text(json.dumps({**json.loads(path.read_text()), **entries}))
    with pytest.raises(FileError):
        load_replay_for(path, Registry(SCENES))[0].level_path()


@pytest.mark.parametrize("name", NAMES.values(), ids=NAMES)
def test_a_picture_that_a_level_names(tmp_path, name):
    level = small()
    level["tilesets"][0]["image"] = name
    with pytest.raises(FileError, match=r"tilesets\[0\].image"):
        level_of(save(tmp_path, level))


@pytest.mark.parametrize("name", [name for key, name in NAMES.items() if key != "a zero in it"])
def test_a_data_folder(monkeypatch, name):
    monkeypatch.setenv("HITBOX_DATA", name)
    for load in (load_settings, load_records, lambda: load_ghost("lander")):
        message = load()[-1]
        assert message and len(message) <= 300
    assert own_levels((".tmj",)) == () and shelf() == []
    assert is_there(Path(name) / "settings.json")  # that it cannot be read is told, not taken for "none yet"


@pytest.mark.parametrize("letters", [1, 200, 230, 244, 250, 255])
@pytest.mark.parametrize("letter", ["n", "\N{GRINNING FACE}"])
def test_a_name_that_the_system_takes_can_be_written(tmp_path, letter, letters):
    name = letter * (letters // len(letter.encode())) or letter
    write_atomically(tmp_path / name, "text")
    write_atomically(tmp_path / name, "more")
    assert (tmp_path / name).read_text() == "more" and [each.name for each in tmp_path.iterdir()] == [name]
