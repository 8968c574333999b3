"""Very long names in a file are shortened in messages, and files without an end do not fill the memory."""

import json
import os
import tracemalloc

import pytest

from game.errors import LONGEST, FileError, UsageError, unknown_name
from game.files import json_file, own_levels
from game.files.data_folder import keep_beside
from game.files.json_file import read_json
from game.files.own_levels import level_digest
from game.registry import Registry
from game.run.replay import load_replay
from game.run.replay_check import load_replay_for
from scenes import SCENES
from scenes.platformer.level import level_of
from scenes.shooter.stage import load_stage
from tests.game.test_replay import record
from tests.scenes.test_platformer_maps import objects, save, small

LONG = "n" * 5000
MOST = LONGEST


@pytest.fixture
def spoilt(tmp_path):
    path = tmp_path / "run.json"
    record(path, 3)

    def write(**entries):
        path.write_text(json.dumps({**json.loads(path.read_text()), **entries}))
        return path

    return write


@pytest.mark.parametrize(
    "entries",
    [
        {"scene": LONG},
        {"format": LONG},
        {"version": LONG},
        {"scene": "shooter", "broadphase": LONG},
        {"scene": "shooter", "solver": LONG},
        {"scene": "shooter", "tier": LONG},
        {"scene": "platformer", "tier": None, "level": {"path": LONG, "digest": LONG}},
        {"scene": "shooter", "tier": None, "level": {LONG: "", "digest": ""}},
        {"inputs": [[3, {LONG: 1}]]},
        {"inputs": [[3, {"actions": [LONG]}]]},
        {"scene": "shooter", "inputs": [[3, {"changes": [[LONG, LONG]]}]]},
        {"seed": LONG},
        {"date": LONG},
        {"result": {LONG: 1}},
    ],
    ids=lambda entries: " ".join(entries),
)
def test_a_long_name_in_a_recording(spoilt, entries):
    path = spoilt(**entries)
    with pytest.raises(FileError) as caught:
        load_replay_for(path, Registry(SCENES))[0].level_path()
    line = str(caught.value)
    assert "n" * 500 not in line and len(line) <= MOST and "\n" not in line


def test_long_names_and_odd_letters_in_a_level(tmp_path):
    for entry, place in (("type", 2), ("name", 2)):
        level = small()
        objects(level)[place] |= {entry: LONG, "properties": [{"name": LONG, "value": LONG}]}
        try:
            level_of(save(tmp_path, level))
        except FileError as error:
            assert len(str(error)) <= MOST
    level = small()
    level["layers"][0]["name"] = LONG + "\x1b[2J\n"
    with pytest.raises(FileError) as caught:
        level_of(save(tmp_path, level))
    assert len(str(caught.value)) <= MOST and str(caught.value).isprintable()


def test_a_long_name_on_the_command_line():
    assert len(str(unknown_name("scene", LONG, ("shooter",)))) <= MOST
    assert "did you mean shooter" in str(unknown_name("scene", "shoter", ("shooter",)))


READERS = {"recording": load_replay, "level": level_of, "stage": load_stage, "any": read_json}


@pytest.mark.skipif(not os.path.exists("/dev/zero"), reason="there are no such devices")
@pytest.mark.parametrize("device", ["/dev/zero", "/dev/urandom"])
@pytest.mark.parametrize("reader", READERS)
def test_a_device_without_end(reader, device):
    tracemalloc.start()
    try:
        with pytest.raises(FileError, match=device):
            READERS[reader](device)
        assert tracemalloc.get_traced_memory()[1] < 50e6
    finally:
        tracemalloc.stop()


def test_text_without_end(tmp_path, monkeypatch):
    for module, reader in ((json_file, read_json), (own_levels, level_digest)):
        monkeypatch.setattr(module, "LARGEST", 3 << 20)
        path = tmp_path / "long.json"
        path.write_text("[" + " " * (4 << 20))
        with pytest.raises(FileError, match="file: is larger than 3 MB"):
            reader(path)


def test_what_is_no_text_is_placed(tmp_path):
    path = tmp_path / "odd.json"
    for content, place in (
        (b'["' + b"a" * (json_file.CHUNK + 5) + b"\xff", f"byte {json_file.CHUNK + 7}"),
        (b'["a\0', "byte 3"),
        (b'["' + "ä".encode()[:1], "cut off"),
    ):
        path.write_bytes(content)
        with pytest.raises(FileError, match=place):
            read_json(path)
    letters = "ä€😀" * (json_file.CHUNK // 4)  # letters that lie across the pieces it is read in
    path.write_text(json.dumps(letters, ensure_ascii=False), encoding="utf-8")
    assert read_json(path) == letters


@pytest.mark.skipif(not os.path.exists("/dev/zero"), reason="there are no such devices")
def test_a_settings_file_that_is_a_device_is_put_aside(tmp_path):
    path = tmp_path / "settings.json"
    path.symlink_to("/dev/zero")
    kept = keep_beside(path)
    assert kept.is_symlink() and not path.exists()


def test_errors_stay_usage_errors():
    assert issubclass(FileError, UsageError)
