"""Settings survive damage: defaults, one line, and the old file kept beside."""

import json

import pytest

from game.data_folder import data_folder, keep_beside, write_atomically
from game.settings import Settings, load_settings, save_settings


@pytest.fixture
def path(tmp_path):
    return tmp_path / "settings.json"


def test_a_missing_file_is_no_problem(path):
    assert load_settings(path) == (Settings(), "")


def test_saved_settings_come_back(path):
    save_settings(Settings(window_scale=2, volume=0.3), path)
    settings, message = load_settings(path)
    assert (settings.window_scale, settings.volume, message) == (2, 0.3, "")


def test_broken_json_is_kept_and_named(path):
    path.write_text('{"version": 1,\n "volume": }')
    settings, message = load_settings(path)
    assert settings == Settings()
    assert str(path) in message and "line 2" in message and "damaged-1" in message
    assert (path.parent / "settings.json.damaged-1").read_text() == path.read_text()


@pytest.mark.parametrize("entry, value", [
    ("volume", 7), ("volume", "loud"), ("window_scale", 2.5), ("fullscreen", 1), ("keys", {}),
    ("keys", {"left": ["nokey"]}),
])
def test_one_bad_value_falls_back_alone(path, entry, value):
    path.write_text(json.dumps({"version": 1, "show_fps": True, entry: value}))
    settings, message = load_settings(path)
    assert settings.show_fps and getattr(settings, entry) == getattr(Settings(), entry)
    assert entry in message


def test_another_version_is_not_guessed_at(path):
    path.write_text('{"version": 99}')
    assert "version: must be 1" in load_settings(path)[1]


def test_not_text_at_all(path):
    path.write_bytes(b"\xff\xfe\x00\x80")
    assert "defaults are used" in load_settings(path)[1]


def test_kept_files_are_never_overwritten(path):
    path.write_text("one")
    first = keep_beside(path)
    path.write_text("two")
    second = keep_beside(path)
    assert first != second and first.read_text() == "one" and second.read_text() == "two"


def test_a_failed_write_leaves_the_old_file(path, monkeypatch):
    write_atomically(path, "old")
    monkeypatch.setattr("os.replace", lambda *a: (_ for _ in ()).throw(OSError("full")))
    with pytest.raises(OSError):
        write_atomically(path, "new")
    assert path.read_text() == "old" and list(path.parent.iterdir()) == [path]


def test_folder_follows_the_platform(tmp_path):
    assert data_folder({"XDG_DATA_HOME": "/x"}, "linux").as_posix() == "/x/hitbox"
    assert data_folder({"APPDATA": "C:/u"}, "win32").as_posix() == "C:/u/Hitbox"
    assert "Application Support" in data_folder({}, "darwin").as_posix()
    assert data_folder({"HITBOX_DATA": str(tmp_path)}, "linux") == tmp_path
