"""The output of `main.py --headless` in a separate process equals the results of a scene stepped in the test."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

import physics
from game.run.digest import scene_digest
from tests.lockstep import Run, make_scene

ROOT = Path(__file__).resolve().parents[2]
FRAMES = 240 if physics.JIT else 30


def main(*arguments):
    return subprocess.run(
        [sys.executable, "main.py", "--headless", *map(str, arguments)], cwd=ROOT, text=True, capture_output=True
    )


def report(*arguments):
    done = main(*arguments, "--json")
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.mark.parametrize("name", ["platformer", "lab/filters"])
def test_a_run_is_recorded_drawn_and_replayed(name, tmp_path):
    recording = tmp_path / "run.json"
    chosen = ("--scene", name, "--seed", 1, "--bot", "--frames", FRAMES)
    played = report(*chosen, "--strict", "--overlay", "all", "--broadphase", "tree", "--record", recording)
    assert played["check"]["ok"] and played["frames"] == FRAMES and played["broadphase"] == "tree"
    run = Run("", make_scene(name))
    for _ in range(FRAMES):
        run.step()
    assert scene_digest(run.scene) == played["digest"]
    replayed = report("--replay", recording)
    assert replayed["digest"] == played["digest"] and replayed["check"] == played["check"]


def test_a_replay_that_diverges_exits_1_and_names_the_frame(tmp_path):
    recording = tmp_path / "run.json"
    report("--scene", "platformer", "--bot", "--frames", 20, "--record", recording)
    data = json.loads(recording.read_text())
    data["digests"][11] = "0" * 16
    recording.write_text(json.dumps(data))
    done = main("--replay", recording)
    assert done.returncode == 1 and "diverged at frame 12:" in done.stderr and "Traceback" not in done.stderr
