"""Recordings replay to the bit, name the first frame that differs, and report damage."""

import json

import pytest

from game.errors import FileError, ReplayDiverged
from game.input.inputs import InputFrame
from game.registry import Registry
from game.run.digest import scene_digest
from game.run.replay import Recorder, load_replay
from game.run.replay_check import load_replay_for
from game.run.session import Session
from game.run.sources import BotSource, ScriptSource
from game.run.tape import Tape
from game.scene import Result
from physics import PHYSICS_VERSION
from tests.game.arena import LISTING, Arena, Race


def record(path, frames=40, source=None, **chosen):
    scene = Arena(seed=3, **chosen)
    recorder = Recorder(scene, bot=source is None)
    session = Session(scene, source or BotSource(), recorder)
    for _ in range(frames):
        session.step()
    recorder.save(path)
    return scene


def played(replay, **chosen):
    scene = Arena(seed=replay.seed, **chosen)
    session = Session(scene, replay, replay=replay)
    for _ in range(replay.frames):
        session.step()
    return scene


def replay(path, **chosen):
    return played(load_replay(path), **chosen)


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
    script = [
        InputFrame(frozenset({"right"}), (7, 9), True, -1, (("slider:speed", 120), ("broadphase", "tree"))),
        *[InputFrame(frozenset({"right"}))] * 30,
        InputFrame(changes=(("restart", True),)),
    ]
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


@pytest.mark.parametrize("then", [1, PHYSICS_VERSION + 1])
def test_what_was_recorded_under_another_physics_plays_and_says_where_it_parts(tmp_path, then):
    path = tmp_path / "run.json"
    first = record(path)
    data = json.loads(path.read_text())
    assert data["physics"] == PHYSICS_VERSION
    if then == 1:
        del data["physics"]  # before it was said
    else:
        data["physics"] = then
    path.write_text(json.dumps(data))
    same = load_replay(path)
    assert scene_digest(played(same)) == scene_digest(first)
    assert same.parted == "" and same.outdated == f"recorded under physics {then}, played under {PHYSICS_VERSION}"
    data["digests"][20:] = ["0" * 16] * (len(data["digests"]) - 20)
    path.write_text(json.dumps(data))
    other = load_replay(path)
    assert scene_digest(played(other)) == scene_digest(first)
    assert "diverged at frame 21:" in other.parted and other.parted.endswith(other.outdated)
    tape = Tape(lambda: Arena(seed=other.seed), load_replay(path))
    while not tape.ended:
        tape.step()
    assert tape.diverged_at == 21 and tape.diverged == other.parted


DAMAGE = [
    (lambda d: d.update(physics="new"), "physics"),
    (lambda d: d.update(physics=0), "physics"),
    (lambda d: d.pop("seed"), "seed"),
    (lambda d: d.update(seed="one"), "seed"),
    (lambda d: d.update(version=3), "version"),
    (lambda d: d.update(version=True), "version"),
    (lambda d: d.update(level="x"), "level"),
    (lambda d: d.update(level={"path": 1, "digest": ""}), "level"),
    (lambda d: d.update(result={"won": 1}), "result"),
    (lambda d: d.update(result={"won": True, "points": 1, "seconds": float("nan")}), "result"),
    (lambda d: d.update(date=7), "date"),
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


def test_the_first_version_is_still_read(tmp_path):
    path = tmp_path / "run.json"
    first = record(path)
    data = json.loads(path.read_text())
    for name in ("level", "date", "result"):
        del data[name]
    path.write_text(json.dumps({**data, "version": 1}))
    old = load_replay(path)
    assert (old.level, old.date, old.result, old.level_path()) == (None, "", None, None)
    assert scene_digest(replay(path)) == scene_digest(first)


def test_a_level_is_known_by_its_content(tmp_path):
    level, path = tmp_path / "mine.json", tmp_path / "run.json"
    level.write_text("{}")
    recorder = Recorder(Race(level=level))
    recorder.save(path, Result(True, 12, 3.5))
    replay = load_replay(path)
    assert replay.level_path() == level
    assert replay.result == {"won": True, "points": 12, "seconds": 3.5}
    level.write_text("{ }")
    with pytest.raises(FileError, match="mine.json has changed since"):
        replay.level_path()
    level.unlink()
    with pytest.raises(FileError, match="No such file"):
        replay.level_path()


def test_digests_may_be_spaced_out(tmp_path):
    path = tmp_path / "run.json"
    scene = Arena(seed=3)
    recorder = Recorder(scene, True, every=30)
    session = Session(scene, BotSource(), recorder)
    for _ in range(95):
        session.step()
    recorder.save(path)
    again = load_replay(path)
    assert len(again.digests) == 3 and again.every == 30
    again.digests[1] = "0" * 16
    other = Session(Arena(seed=3), again, replay=again)
    with pytest.raises(ReplayDiverged, match=r"diverged at frame 60 \(since frame 30\)"):
        for _ in range(95):
            other.step()


MISFITS = [
    ({"scene": "elsewhere"}, "scene"),
    ({"broadphase": "octree"}, "broadphase"),
    ({"solver": "soft_step"}, "solver"),
    ({"tier": "pixels"}, "tier"),
    ({"level": {"path": "x", "digest": "y"}}, "level"),
    *(
        ({"changes": [change]}, "frame 3")
        for change in (
            ["slider:gravity", 1],
            ["slider:speed", "fast"],
            ["slider:speed", True],
            ["slider:speed", float("inf")],
            ["slider:speed", [1]],
            ["assist:invincible", True],
            ["broadphase", "octree"],
            ["broadphase", {}],
            ["solver", "blocking"],
            ["tier", None],
            ["narrowphase", 1],
            ["fly", 1],
            [3, 1],
        )
    ),
]


@pytest.mark.parametrize("misfit, place", MISFITS)
def test_a_recording_that_its_scene_cannot_play_is_named(tmp_path, misfit, place):
    path = tmp_path / "run.json"
    record(path, 10)
    data = json.loads(path.read_text())
    changes = misfit.pop("changes", None)
    if changes:
        data["inputs"] = [[2, {}], [1, {"changes": changes}], [7, {}]]
    path.write_text(json.dumps({**data, **misfit}))
    with pytest.raises(FileError) as caught:
        load_replay_for(path, Registry(LISTING))
    assert caught.value.place == place
    if changes:
        misfit["changes"] = changes
