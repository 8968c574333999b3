"""A `*.part` file of a program that was killed while writing is removed by a later program.

No other file is removed.
"""

import os
import subprocess
import sys
import time

import pytest

from game.files import leftovers
from game.files.data_folder import part_of, write_atomically
from game.files.leftovers import ABANDONED, remove_leftovers
from game.report.store import Store
from physics import Snapshot, World

OLD, NEW = ABANDONED + 60.0, ABANDONED / 2


def put(path, age):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("half of it")
    changed = time.time() - age
    os.utime(path, (changed, changed))
    return path


OURS = [
    "settings.json.123.part",
    "records.json.4194304.part",
    "arena-20260131-101010.png.7.part",
    "0123456789abcdef.9.part",
]
OTHERS = [
    "settings.json",
    "film.part",
    "film.mp4.part",
    "settings.json.part",
    "settings.json.12x.part",
    "settings.json.123.part.txt",
    "123.part",
    ".123.part",
    "settings.json.123.PART",
    "settings.json.damaged-1",
]
FOLDERS = ["", "ghosts", "replays", "replays/recent", "screenshots"]


@pytest.mark.parametrize("folder", FOLDERS)
@pytest.mark.parametrize("name", OURS)
def test_an_old_one_of_ours_is_removed(tmp_path, folder, name):
    path = put(tmp_path / folder / name, OLD)
    remove_leftovers(tmp_path)
    assert not path.exists()


@pytest.mark.parametrize("folder", FOLDERS)
@pytest.mark.parametrize("name, age", [*((name, OLD) for name in OTHERS), *((name, NEW) for name in OURS)])
def test_what_is_another_s_or_young_stays(tmp_path, folder, name, age):
    path = put(tmp_path / folder / name, age)
    remove_leftovers(tmp_path)
    assert path.read_text() == "half of it"


@pytest.mark.parametrize("folder", ["levels", "more", "replays/more"])
def test_other_folders_are_not_looked_into(tmp_path, folder):
    path = put(tmp_path / folder / OURS[0], OLD)
    remove_leftovers(tmp_path)
    assert path.exists()


def test_a_clock_that_was_set_back_removes_nothing(tmp_path):
    path = put(tmp_path / OURS[0], -10 * ABANDONED)
    remove_leftovers(tmp_path)
    assert path.exists()


@pytest.mark.skipif(not hasattr(os, "symlink"), reason="no links here")
def test_links_and_folders_of_such_a_name_stay(tmp_path):
    put(tmp_path / "else" / "film", OLD)
    (tmp_path / OURS[0]).symlink_to(tmp_path / "else" / "film")
    (tmp_path / OURS[1]).mkdir()
    os.utime(tmp_path / OURS[1], (0, 0))
    (tmp_path / "away").mkdir()
    elsewhere = put(tmp_path / "away" / OURS[2], OLD)
    (tmp_path / "ghosts").symlink_to(tmp_path / "away")
    remove_leftovers(tmp_path)
    assert (tmp_path / OURS[0]).is_symlink() and (tmp_path / OURS[1]).is_dir() and elsewhere.exists()


@pytest.mark.parametrize("folder", ["none", "file", "n" * 5000])
def test_a_folder_that_is_none_is_nothing_to_tell(tmp_path, folder):
    put(tmp_path / "file", OLD)
    remove_leftovers(tmp_path / folder)


def test_one_that_cannot_be_removed_is_left(tmp_path, monkeypatch):
    path = put(tmp_path / OURS[0], OLD)
    monkeypatch.setattr(os, "unlink", lambda *arguments, **more: (_ for _ in ()).throw(PermissionError(13, "no")))
    remove_leftovers(tmp_path)
    assert path.exists()


def test_the_arcade_s_start_cleans_the_data_folder(tmp_path, monkeypatch):
    from game import app

    monkeypatch.setenv("HITBOX_DATA", str(tmp_path))
    path = put(tmp_path / OURS[0], OLD)

    class Stopped(Exception):
        pass

    def stop(registry):
        raise Stopped

    monkeypatch.setattr(app, "Beside", stop)
    with pytest.raises(Stopped):
        app.run_app(None, None)
    assert not path.exists()


@pytest.mark.parametrize("folder", ["", "results", "data"])
def test_a_report_that_goes_on_cleans_its_folder(tmp_path, folder):
    Store(tmp_path / "report", True)
    path = put(tmp_path / "report" / folder / "fall--1.json.123.part", OLD)
    young = put(tmp_path / "report" / folder / "fall--2.json.123.part", NEW)
    Store(tmp_path / "report", True)
    assert not path.exists() and young.exists()


@pytest.mark.parametrize("name", ["run.json", "n" * 250, "\N{GRINNING FACE}" * 60])
def test_a_file_that_is_written_again_takes_its_own_along(tmp_path, name):
    mine = put(part_of(tmp_path / name, 123), OLD)
    young = put(part_of(tmp_path / name, 124), NEW)
    another = put(part_of(tmp_path / "other.json", 123), OLD)
    write_atomically(tmp_path / name, "text")
    assert not mine.exists() and young.exists() and another.exists()


def test_a_snapshot_that_is_written_again_takes_its_own_along(tmp_path):
    mine = put(tmp_path / "world.npz.123.part", OLD)
    young = put(tmp_path / "world.npz.124.part", NEW)
    others = [put(tmp_path / name, OLD) for name in ("other.npz.123.part", "world.npz.part", "world.npz.1x.part")]
    World().snapshot().save(tmp_path / "world.npz")
    assert not mine.exists() and young.exists() and all(each.exists() for each in others)
    assert isinstance(Snapshot.load(tmp_path / "world.npz"), Snapshot)


def test_what_a_killed_program_leaves_is_known(tmp_path):
    """The file that a killed program leaves has a name that the clean-up removes."""
    code = (
        "import os, signal, sys\n"
        "from game.files import data_folder\n"
        "data_folder.os.fsync = lambda file: os.kill(os.getpid(), signal.SIGKILL)\n"
        "data_folder.write_atomically(sys.argv[1], 'text')\n"
    )
    subprocess.run([sys.executable, "-c", code, str(tmp_path / "settings.json")], check=False)
    (left,) = tmp_path.iterdir()
    os.utime(left, (1, 1))
    remove_leftovers(tmp_path)
    assert [*tmp_path.iterdir()] == []


def test_the_bound_is_longer_than_any_write():
    assert leftovers.ABANDONED >= 600.0
