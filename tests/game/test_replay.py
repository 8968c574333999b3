"""Recordings come back bit for bit, name the frame that differs, and name their damage."""

import json

import pytest

from game.digest import scene_digest
from game.errors import FileError, ReplayDiverged
from game.inputs import BotSource, InputFrame, ScriptSource
from game.replay import Recorder, load_replay
from game.session import Session
from tests.game.arena import Arena


def record(path, frames=40, source=None, **chosen):
    scene = Arena(seed=3, **chosen)
    recorder = Recorder(scene, bot=source is None)
    session = Session(scene, source or BotSource(), recorder)
    for _ in range(frames):
        session.step()
    recorder.save(path)
    return scene


def replay(path, **chosen):
    replay = load_replay(path)
    scene = Arena(seed=replay.seed, **chosen)
    session = Session(scene, replay, replay=replay)
    for _ in range(replay.frames):
        session.step()
    return scene


def test_a_replay_ends_in_the_same_state(tmp_path):
    path = tmp_path / "run.json"
    first = record(path)
    assert scene_digest(replay(path)) == scene_digest(first)


@pytest.mark.parametrize("name", ["brute", "sweep", "hash", "tree"])
def test_a_replay_does_not_depend_on_the_broad_phase(tmp_path, name):
    path = tmp_path / "run.json"
    first = record(path, broadphase="hash")
    assert scene_digest(replay(path, broadphase=name)) == scene_digest(first)


def test_changes_and_pointer_are_recorded(tmp_path):
    path = tmp_path / "run.json"
    script = [InputFrame(frozenset({"right"}), (7, 9), True, -1, (("slider:speed", 120), ("broadphase", "tree"))),
              *[InputFrame(frozenset({"right"}))] * 30, InputFrame(changes=(("restart", True),))]
    first = record(path, 40, ScriptSource(script))
    again = replay(path)
    assert again.values == {"speed": 120} and again.broadphase == "tree"
    assert scene_digest(again) == scene_digest(first)
    assert load_replay(path).inputs[0] == script[0]


def test_a_divergence_names_its_frame(tmp_path):
    path = tmp_path / "run.json"
    record(path)
    data = json.loads(path.read_text())
    data["inputs"] = [[20, data["inputs"][0][1]], [1, {}], [19, data["inputs"][0][1]]]
    path.write_text(json.dumps(data))
    with pytest.raises(ReplayDiverged, match="diverged at frame 21:"):
        replay(path)


DAMAGE = [
    (lambda d: d.pop("seed"), "seed"),
    (lambda d: d.update(seed="one"), "seed"),
    (lambda d: d.update(version=2), "version"),
    (lambda d: d.update(format="mp3"), "format"),
    (lambda d: d.update(every=0), "every"),
    (lambda d: d.update(frames=7), "inputs"),
    (lambda d: d["inputs"].append([0, {}]), r"inputs\[1\]"),
    (lambda d: d["inputs"][0].__setitem__(1, {"actions": ["fly"]}), r"inputs\[0\]"),
    (lambda d: d["inputs"][0].__setitem__(1, {"pointer": [1]}), r"inputs\[0\]"),
    (lambda d: d["inputs"][0].__setitem__(1, {"speed": 1}), r"inputs\[0\]"),
    (lambda d: d["digests"].pop(), "digests"),
    (lambda d: d["digests"].__setitem__(3, 5), r"digests\[3\]"),
]


@pytest.mark.parametrize("spoil, place", DAMAGE)
def test_damage_is_named(tmp_path, spoil, place):
    path = tmp_path / "run.json"
    record(path, 10)
    data = json.loads(path.read_text())
    spoil(data)
    path.write_text(json.dumps(data))
    with pytest.raises(FileError, match=place) as caught:
        load_replay(path)
    assert "run.json" in str(caught.value)


def test_cut_off_and_missing_files_are_named(tmp_path):
    path = tmp_path / "run.json"
    record(path, 10)
    path.write_text(path.read_text()[:150])
    with pytest.raises(FileError, match="line "):
        load_replay(path)
    with pytest.raises(FileError, match="No such file"):
        load_replay(tmp_path / "none.json")
