"""A data folder that cannot be read or has an invalid name gives a message, no traceback.

The message is shown at the start and in the menus.
"""

from pathlib import Path

import pygame as K
import pytest

from game.files.best_run import load_ghost
from game.files.data_folder import data_folder
from game.files.own_levels import own_levels
from game.files.records import load_records
from game.files.settings import Settings, load_settings
from game.run.replay_shelf import shelf
from tests.game.arena import Race


@pytest.fixture(params=["name", "rights"])
def out_of_reach(request, monkeypatch, tmp_path):
    if request.param == "name":
        monkeypatch.setenv("HITBOX_DATA", str(tmp_path / ("x" * 300)))
        return
    monkeypatch.setenv("HITBOX_DATA", str(tmp_path / "closed"))

    def refuse(path, *more, **named):
        raise PermissionError(13, "Permission denied", str(path))

    for name in ("exists", "is_dir", "is_file", "iterdir", "stat", "open", "mkdir"):
        allowed = getattr(Path, name)
        monkeypatch.setattr(
            Path,
            name,
            lambda path, *more, allowed=allowed, **named: (
                refuse(path) if "closed" in path.parts else allowed(path, *more, **named)
            ),
        )


def test_everything_starts_empty(out_of_reach):
    named = str(data_folder())[:40]  # a message of 300 letters has no room for all of it
    settings, message = load_settings()
    assert settings == Settings() and named in message and "settings.json" in message
    records, message = load_records()
    assert records.tables == {} and named in message and "records.json" in message
    assert load_ghost("race")[0] is None and own_levels(Race.level_suffixes()) == () and shelf() == []


def test_the_menus_work(drive, out_of_reach):
    d = drive()
    d.turns(2)
    for row in ("Replays", "High scores", "Play"):
        d.mark(row)
        assert d.name != "Title"
        d.key(K.K_ESCAPE)
    assert d.name == "Title"
