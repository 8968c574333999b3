"""A small recording cannot exhaust the memory or cause a traceback.

Its repeats, pointers, level names and dates are limited. Dates and numbers of points of any length once made a line of
text that took gigabytes to draw.
"""

import json

import pytest

from game.errors import FileError
from game.run.replay import LONGEST, load_replay
from tests.game.test_replay import record


@pytest.fixture
def spoilt(tmp_path):
    path = tmp_path / "run.json"
    record(path, 3)

    def write(**entries):
        path.write_text(json.dumps({**json.loads(path.read_text()), **entries}))
        return path

    return write


@pytest.mark.parametrize("repeats", [LONGEST + 1, 10**30])
def test_more_frames_than_a_day_has(spoilt, repeats):
    path = spoilt(inputs=[[repeats, {}]], frames=repeats, every=repeats + 1, digests=[])
    with pytest.raises(FileError, match="frames: must be 0 to"):
        load_replay(path)


def test_more_inputs_than_the_head_says(spoilt):
    path = spoilt(inputs=[[1, {}], [10**30, {}]])
    with pytest.raises(FileError, match="inputs: hold more than the 3 frames that the head says"):
        load_replay(path)


@pytest.mark.parametrize("entry", [{"pointer": [10**400, 0]}, {"pointer": [0, -(2**31)]}, {"wheel": 10**400}])
def test_a_pointer_far_from_any_window(spoilt, entry):
    with pytest.raises(FileError, match=r"inputs\[0\]"):
        load_replay(spoilt(inputs=[[3, entry]]))


@pytest.mark.parametrize("name", ["a\0b", "a\ud800b"])
def test_a_level_that_no_file_can_be_called(spoilt, name):
    replay = load_replay(spoilt(level={"path": name, "digest": "0" * 12}))
    with pytest.raises(FileError, match="file: "):
        replay.level_path()


@pytest.mark.parametrize(
    "entries", [{"date": "x" * 10_000_000}, {"result": {"won": True, "points": 10**4000, "seconds": 1.0}}]
)
def test_lines_too_long_to_show(spoilt, entries):
    with pytest.raises(FileError, match=next(iter(entries))):
        load_replay(spoilt(**entries))
