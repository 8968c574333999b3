"""A settings file that can be neither read nor copied is not overwritten by the next save."""

from pathlib import Path

import pytest

from game.files.data_folder import data_folder
from game.files.settings import Settings, load_settings, save_settings


@pytest.fixture
def closed(monkeypatch):
    """Make the settings file unreadable; it can still be renamed. Returns its path."""
    path = data_folder() / "settings.json"
    path.write_text('{"version": 2, "initials": "ABC"}')
    read = Path.read_bytes

    def refuse(which, *more):
        if which == path:
            raise PermissionError(13, "Permission denied", str(which))
        return read(which)

    monkeypatch.setattr(Path, "read_bytes", refuse)
    monkeypatch.setattr("game.files.json_file.open", lambda which, *more, **named: refuse(Path(which)), raising=False)
    return path


def test_it_is_put_aside(closed):
    kept = closed.with_name("settings.json.damaged-1")
    settings, message = load_settings()
    assert settings == Settings() and "Permission denied" in message and kept.name in message
    save_settings(settings)
    assert "ABC" in kept.read_text()


def test_what_was_kept_before_stays(closed):
    first = closed.with_name("settings.json.damaged-1")
    first.write_text("earlier")
    load_settings()
    assert first.read_text() == "earlier" and "ABC" in closed.with_name("settings.json.damaged-2").read_text()


def test_a_folder_of_that_name_is_put_aside():
    (data_folder() / "settings.json").mkdir()
    load_settings()
    save_settings(Settings(initials="XYZ"))
    assert load_settings()[0].initials == "XYZ" and (data_folder() / "settings.json.damaged-1").is_dir()
