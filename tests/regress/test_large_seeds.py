"""A seed beyond 63 bits, on the command line or in a recording, gives a message and no traceback."""

import json

import pytest

from game.command_line import run
from game.errors import FileError
from game.registry import Registry
from game.run.replay import LARGEST_SEED, load_replay
from tests.game.arena import LISTING
from tests.game.test_replay import record


@pytest.mark.parametrize("seed", [LARGEST_SEED + 1, 2**63 - 1, 10**30])
def test_on_the_command_line(capsys, seed):
    assert run(["--scene", "arena", "--headless", "--frames", "2", "--seed", str(seed)], Registry(LISTING)) == 2
    assert capsys.readouterr().err == f"hitbox: --seed must be 0 to {LARGEST_SEED} (got {seed})\n"


def test_in_a_recording(tmp_path):
    path = tmp_path / "run.json"
    record(path, 3)
    path.write_text(json.dumps({**json.loads(path.read_text()), "seed": 10**30}))
    with pytest.raises(FileError, match="seed"):
        load_replay(path)


def test_the_largest_runs(capsys):
    assert run(["--scene", "arena", "--headless", "--frames", "2", "--seed", str(LARGEST_SEED)], Registry(LISTING)) == 0
