"""On a full disk existing files stay intact, one line names the file and the reason, and the game continues."""

import builtins
import errno
import os
from pathlib import Path

import numpy as np
import pygame as K
import pytest

import physics
from game.command_line import run
from game.files.best_run import ghost_path, keep_ghost, load_ghost
from game.files.data_folder import data_folder, write_atomically
from game.files.records import Entry, load_records
from game.files.settings import Settings, load_settings, save_settings
from game.registry import Registry
from game.run.replay_shelf import shelf
from physics import Circle, Snapshot, World
from physics.jit import kernel
from physics.jit.store import store
from tests.game.arena import LISTING

FULL = os.strerror(errno.ENOSPC)


class FullFile:
    """File object that writes only half of the data it is given."""

    def __init__(self, file):
        self.file = file

    def write(self, content):
        self.file.write(content[: len(content) // 2])
        raise OSError(errno.ENOSPC, FULL, self.file.name)

    def __getattr__(self, name):
        return getattr(self.file, name)

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.file.close()


@pytest.fixture
def full_disk(monkeypatch):
    """Return a function full_disk(). After its call, files that are opened take only half of the data written."""
    opened = builtins.open

    def limited(path, mode="r", *more, **named):
        file = opened(path, mode, *more, **named)
        return FullFile(file) if any(letter in mode for letter in "wax+") and path != os.devnull else file

    return lambda: monkeypatch.setattr("builtins.open", limited)


def files():
    """Return {path: content} of all files in the player's data folder."""
    return {path: path.read_bytes() for path in sorted(data_folder().rglob("*")) if path.is_file()}


def entry(points):
    return Entry("AAA", points, 60.0, "2026-11-21")


def save_a_record():
    records, _ = load_records()
    records.add("race", "points", entry(900))
    records.save()


SAVES = {
    "settings": (lambda: save_settings(Settings(master=0.9)), lambda: load_settings()[0].master == 0.1),
    "records": (save_a_record, lambda: load_records()[0].best("race").points == 5),
    "ghost": (lambda: keep_ghost("race", [(1.0, 2.0, "run", 1)], 3.0), lambda: load_ghost("race")[1] == 9.0),
    "a level": (lambda: write_atomically(data_folder() / "levels" / "own.tmj", "{" * 100), lambda: True),
}


@pytest.mark.parametrize("what", SAVES)
def test_what_was_kept_before_stays_whole(full_disk, what):
    save_settings(Settings(master=0.1))
    records, _ = load_records()
    records.add("race", "points", entry(5))
    records.save()
    keep_ghost("race", [(0.0, 0.0, "run", 1)], 9.0)
    write_atomically(data_folder() / "levels" / "own.tmj", "{}")
    before = files()
    assert len(before) == 4 and ghost_path("race") in before
    full_disk()
    save, holds = SAVES[what]
    with pytest.raises(OSError, match=FULL):
        save()
    assert files() == before and holds()


def test_a_snapshot_that_does_not_fit_leaves_the_old_one(full_disk, tmp_path):
    path, world = tmp_path / "kept.npz", World()
    body = world.add_body(Circle(5), position=(3, 4))
    world.snapshot().save(path)
    before = path.read_bytes()
    body.move_to((70, 80))
    full_disk()
    with pytest.raises(OSError, match=FULL):
        world.snapshot().save(path)
    assert path.read_bytes() == before and [each.name for each in tmp_path.iterdir()] == ["kept.npz"]
    world.restore(Snapshot.load(path))
    assert body.position == (3, 4)


def test_a_game_goes_on_and_says_what_could_not_be_kept(drive, full_disk, capsys):
    d = drive("--scene", "race", settings=Settings(hint_seen=True))
    d.turns(150)
    full_disk()
    d.key(K.K_F12)
    d.key(K.K_F11)
    d.key(K.K_r)
    d.turns(30)
    assert d.name == "Play"
    said = capsys.readouterr().err
    for line in ("screenshot could not be saved: ", "settings could not be saved: ", "replay of this run could not be"):
        assert line in said
    assert said.count(FULL) >= 3 and not files() and shelf() == []


@pytest.mark.parametrize("flag, name", [("--record", "run.json"), ("--screenshot", "picture.png")])
def test_an_output_that_does_not_fit_is_one_line_and_exit_2(full_disk, tmp_path, capsys, flag, name):
    path = tmp_path / name
    path.write_text("the one of yesterday")
    full_disk()
    assert run(["--scene", "arena", "--headless", "--frames", "20", flag, str(path)], Registry(LISTING)) == 2
    expected = ("numba is not in use", "compiling the physics", "physics compiled")
    lines = capsys.readouterr().err.splitlines()
    (said,) = (line for line in lines if not any(each in line for each in expected))
    assert str(path) in said and FULL in said
    assert path.read_text() == "the one of yesterday" and list(tmp_path.glob("*.part")) == []


@pytest.mark.skipif(not physics.JIT, reason="nothing is compiled")
def test_kernels_that_cannot_be_kept_run_all_the_same(monkeypatch):
    """Kernels whose files cannot be stored still compile and run, and one warning says so."""

    def doubled(values):
        return values[0] + values[0]

    compiled = kernel(doubled)

    def refuse(*arguments, **more):
        raise OSError(errno.ENOSPC, FULL)

    monkeypatch.setattr(Path, "replace", refuse)
    monkeypatch.setattr(store(), "_said", set())
    with pytest.warns(UserWarning, match=f"compiled kernels cannot be kept in .*{FULL}"):
        assert compiled(np.arange(5) + 2) == 4
