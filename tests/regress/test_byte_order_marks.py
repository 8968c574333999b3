"""Every JSON file is read with or without a byte order mark, which editors on Windows write."""

import json

import pytest

from game.errors import FileError
from game.files.best_run import ghost_path, keep_ghost, load_ghost
from game.files.json_file import read_json
from game.files.records import Entry, Records, load_records
from game.files.settings import Settings, load_settings, save_settings
from game.places import ASSETS, LEVELS
from game.report.store import MANIFEST, Store
from game.run.replay import load_replay
from scenes.platformer.level import level_of
from scenes.shooter.stage import load_stage
from tests.game.test_replay import record
from tests.scenes.test_platformer_maps import save, small

MARK = b"\xef\xbb\xbf"


def settings(folder):
    path = folder / "settings.json"
    save_settings(Settings(master=0.25), path)
    return path, lambda: load_settings(path)


def records(folder):
    path = folder / "records.json"
    table = Records(path)
    table.add("shooter", "points", Entry("ABC", 7, 1.5, "2026-01-31"))
    table.save()
    return path, lambda: (load_records(path)[0].tables, load_records(path)[1])


def ghost(folder):
    keep_ghost("lander", [(1.0, 2.0, "ship", 1)], 3.0)
    return ghost_path("lander"), lambda: load_ghost("lander")


def replay(folder):
    path = folder / "run.json"
    record(path, 5)
    return path, lambda: (load_replay(path).inputs, load_replay(path).digests)


def level(folder):
    path = save(folder, small())
    return path, lambda: level_of(path).kinds


def stage(folder):
    path = folder / "stage.json"
    path.write_bytes((ASSETS / "stages" / "shooter.json").read_bytes())
    return path, lambda: load_stage(path)


def manifest(folder):
    Store(folder / "report", True)
    return folder / "report" / MANIFEST, lambda: Store(folder / "report", True).manifest


def result(folder):
    store = Store(folder / "report", True)
    store.keep({"name": "fall/1", "rows": [{"n": 1}]})
    path = folder / "report" / "results" / "fall--1.json"
    return path, lambda: store.result("fall/1")


DOORS = (settings, records, ghost, replay, level, stage, manifest, result)


@pytest.mark.parametrize("door", DOORS)
def test_a_file_with_a_mark_says_the_same(tmp_path, monkeypatch, door):
    monkeypatch.setenv("HITBOX_DATA", str(tmp_path))
    path, read = door(tmp_path)
    before = read()
    assert before
    path.write_bytes(MARK + path.read_bytes())
    assert read() == before


def test_only_the_first_mark_is_read_over(tmp_path):
    path = tmp_path / "twice.json"
    path.write_bytes(MARK + MARK + b"[]")
    with pytest.raises(FileError, match="line 1 column 1"):
        read_json(path)


@pytest.mark.parametrize("content, place", [(b'["\xff', "byte 5"), (b'["a\0', "byte 6"), (b"[1,]", "line 1 column 4")])
def test_places_count_the_mark_as_bytes_and_not_as_a_letter(tmp_path, content, place):
    path = tmp_path / "odd.json"
    path.write_bytes(MARK + content)
    with pytest.raises(FileError, match=f": {place}: "):
        read_json(path)


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be", "utf-32"])
def test_another_encoding_is_told(tmp_path, encoding):
    path = tmp_path / "odd.json"
    path.write_text('["a"]', encoding=encoding)
    with pytest.raises(FileError, match="no.* text"):
        read_json(path)


def test_the_largest_own_level_is_not_marked():
    assert not (LEVELS / "platformer.tmj").read_bytes().startswith(MARK)
    assert json.loads((LEVELS / "platformer.tmj").read_text(encoding="utf-8"))
