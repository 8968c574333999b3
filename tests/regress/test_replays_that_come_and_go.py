"""A replay file that disappears, or a broken link, does not stop the program when the list of replays is opened.

A link or folder in recent/ does not count as a stored run. If the clock was set back, the latest run is not removed as
the oldest.
"""

import os

from game.run.replay_shelf import RECENT, SHORTEST, files_of, put_recent, recent_folder, replays_folder, shelf
from tests.game.test_replay import record


class Recorded:
    """Stand-in for a Recorder with the attributes that the replay shelf reads."""

    frames = SHORTEST
    head = {"scene": "arena"}

    def save(self, path, result=None):
        record(path, 3)


def test_what_is_not_there_is_not_listed(drive):
    recent_folder().mkdir(parents=True)
    (replays_folder() / "lost.json").symlink_to("nowhere.json")
    (replays_folder() / "folder.json").mkdir()
    record(replays_folder() / "run.json", 3)
    assert [path.name for path, _ in shelf()] == ["run.json"]
    d = drive()
    d.turns(2)
    d.mark("Replays")
    assert d.name == "ReplaysScreen"


def test_the_oldest_go_whatever_else_lies_there():
    recent_folder().mkdir(parents=True)
    (recent_folder() / "lost.json").symlink_to("nowhere.json")
    (recent_folder() / "folder.json").mkdir()
    paths = [put_recent(Recorded()) for _ in range(RECENT + 2)]
    assert all(paths) and sum(path.is_file() for path in recent_folder().iterdir()) == RECENT


def test_the_run_just_played_stays_even_if_the_clock_went_back():
    for number in range(RECENT):
        path = recent_folder() / f"older-{number}.json"
        record(path, 3)
        os.utime(path, (4e9, 4e9))
    assert put_recent(Recorded()).is_file() and len(files_of(recent_folder())) == RECENT
