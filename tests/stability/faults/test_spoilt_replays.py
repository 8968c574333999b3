"""A recording that is cut off or has a wrong byte is refused with file, position and reason, or plays until it differs.

tests/game/test_replay.py covers invalid entries; tests/regress/test_recordings_beyond_reason.py covers lengths.
"""

import random

import pytest

from game.errors import FileError, ReplayDiverged
from game.registry import Registry
from game.run.replay import load_replay
from game.run.replay_check import load_replay_for
from tests.game.arena import LISTING
from tests.game.test_replay import record, replay

FRAMES = 40


@pytest.fixture
def recording(tmp_path):
    """Return (path, its bytes) of a recording of forty frames."""
    path = tmp_path / "run.json"
    record(path, FRAMES)
    return path, path.read_bytes()


def places(content):
    """Return {name of the position: length in bytes} of the points at which the tests cut off a recording."""
    inputs, digests = content.index(b'"inputs"'), content.index(b'"digests"')
    return {
        "nothing": 0,
        "the first byte": 1,
        "in the head": inputs // 2,
        "after the head": inputs,
        "in a frame": inputs + (digests - inputs) // 2,
        "before the digests": digests,
        "in a digest": digests + 20,
        "between two digests": content.index(b",", digests) + 1,
        "before the last brackets": content.rindex(b"]"),
        "without the last bracket": content.rindex(b"}"),
    }


@pytest.mark.parametrize("place", places(b'{"x": 1,\n"inputs": [\n],\n"digests": [\n"1234567890abcdef",\n"0"]}'))
def test_a_recording_that_ends_too_soon_is_named(recording, place):
    path, content = recording
    path.write_bytes(content[: places(content)[place]])
    with pytest.raises(FileError) as caught:
        load_replay(path)
    assert caught.value.path == path and caught.value.place.startswith("line ") and caught.value.reason
    assert "\n" not in str(caught.value)


def test_without_the_end_of_its_last_line_it_is_whole(recording):
    path, content = recording
    path.write_bytes(content.rstrip())
    assert load_replay(path).frames == FRAMES


def test_every_length_is_refused_but_the_whole(recording):
    path, content = recording
    for length in range(0, len(content.rstrip()), 7):
        path.write_bytes(content[:length])
        with pytest.raises(FileError, match="run.json: "):
            load_replay(path)


def spoilt(content, seed):
    """Return the content with one random bit inverted."""
    rng, wrong = random.Random(seed), bytearray(content)
    wrong[rng.randrange(len(wrong))] ^= 1 << rng.randrange(8)
    return bytes(wrong)


@pytest.mark.parametrize("first", range(0, 400, 100))
def test_a_turned_bit_is_refused_diverges_or_says_nothing_of_the_run(recording, first):
    """A recording with one inverted bit is refused, diverges, or plays as before if the bit does not affect the run.

    No other kind of error occurs, and no different run is accepted.
    """
    path, content = recording
    told = {"refused": 0, "diverged": 0, "the same": 0}
    for seed in range(first, first + 100):
        path.write_bytes(spoilt(content, seed))
        try:
            loaded, _ = load_replay_for(path, Registry(LISTING))
            replay(path)
        except FileError as error:
            assert error.path == path and error.reason and "\n" not in str(error)
            told["refused"] += 1
        except ReplayDiverged as error:
            assert "diverged at frame" in str(error)
            told["diverged"] += 1
        else:
            assert loaded.frames == FRAMES
            told["the same"] += 1
    assert told["refused"] > 0 and told["diverged"] > 0 and told["the same"] < 60, told
