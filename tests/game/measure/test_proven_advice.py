"""Advice is checked by playing the whole run again under the scene's rules; wrong advice is withdrawn."""

import csv
import json
from itertools import pairwise

import numpy as np
import pytest

import physics
from game.command_line import run
from game.measure.moment import Moment
from game.measure.setting import Setting
from game.registry import Registry
from game.run import advise, proven_advice
from game.run.digest import scene_digest
from game.run.proven_advice import Applied, advise_on_run, apply_to_run
from game.run.recorded_run import SECOND, RecordedRun, busiest, changes_to, look_over, seconds_of_steps
from game.run.replay import Recorder
from game.run.run_worker import Follower
from game.run.session import Session
from game.run.sources import BotSource
from scenes import SCENES
from tests.lockstep import make_scene

needs_speed = pytest.mark.skipif(not physics.JIT, reason="hundreds of steps of a whole game")
SETTING, HERE = Setting("tree", True), Setting("brute", False)


def recorded(name, steps):
    """Return (scene, recorder) after `steps` steps of the scene's bot."""
    scene = make_scene(name)
    recorder = Recorder(scene, bot=True)
    session = Session(scene, BotSource(), recorder)
    for _ in range(steps):
        session.step()
    return scene, recorder


@needs_speed
@pytest.mark.parametrize("name", ("shooter", "platformer", "lander", "lab/pyramid", "lab/disagreement"))
def test_a_run_that_is_played_again_is_the_run(name):
    scene, recorder = recorded(name, 150)
    again = [scene_digest(each) for each in RecordedRun.of(scene, recorder).play()]
    assert len(again) == 150 and again[-1] == scene_digest(scene)


@pytest.mark.parametrize("length", (1, 30, 60, 61, 200, 1000))
@pytest.mark.parametrize("seed", range(4))
def test_the_busiest_second_is_where_a_slow_search_finds_it(length, seed):
    work = np.random.default_rng(seed).integers(0, 100, length)
    sums = [work[k : k + SECOND].sum() for k in range(max(1, length - SECOND + 1))]
    assert busiest(work) == max(1, int(np.argmax(sums)))


@needs_speed
def test_moments_lie_in_every_part_of_the_run_and_in_its_busiest_second():
    scene, recorder = recorded("shooter", 400)
    overview = look_over(RecordedRun.of(scene, recorder))
    assert overview.busiest in overview.at and len(overview.moments) == len(overview.at)
    assert all(any(part * 100 < at <= part * 100 + 100 for at in overview.at) for part in range(4))
    again = look_over(RecordedRun.of(scene, recorder))
    assert again.at == overview.at and again.encounters == overview.encounters, "the same run gives the same answer"
    assert set(overview.encounters) == set(physics.TIERS)
    assert overview.encounters["pixels"].wrong.count == 0 and overview.encounters["pixels"].own


def test_a_run_without_steps_is_refused():
    scene, recorder = recorded("lab/filters", 0)
    with pytest.raises(ValueError, match="a run must have a step at least"):
        look_over(RecordedRun.of(scene, recorder))


@needs_speed
@pytest.mark.parametrize("change", ({"broadphase": "brute"}, {"tier": "aabb"}, {"narrowphase": False}))
def test_a_setting_is_applied_from_the_first_step_to_the_last(change):
    scene, recorder = recorded("shooter", 60)
    recorded_run = RecordedRun.of(scene, recorder)
    setting = Setting(scene.broadphase, True, None, None, scene.tier)._replace(**change)
    changes = changes_to(setting, recorded_run.make())
    assert not isinstance(changes, str) and changes
    for each in recorded_run.play(changes):
        assert {name: getattr(each, name) for name in change} == change
    assert len(seconds_of_steps(recorded_run, changes)) == 60


@pytest.mark.parametrize(
    "mean, interval, p99, holds",
    (
        (0.62, (0.60, 0.64), 0.8, True),
        (0.62, (0.60, 0.95), 0.8, False),
        (1.50, (1.40, 1.60), 2.75, False),
        (0.62, (0.60, 0.64), 1.2, False),
        (0.95, (0.94, 0.96), 0.9, False),
    ),
)
def test_an_advice_holds_only_if_every_repetition_and_the_slowest_steps_agree(mean, interval, p99, holds):
    assert Applied(SETTING, 0.62, mean, interval, p99).holds == holds
    assert not Applied(SETTING, 0.62, mean, interval, p99, "refused").holds
    found = Applied.from_json(json.loads(json.dumps(Applied(SETTING, 0.62, mean, interval, p99))))
    assert found == Applied(SETTING, 0.62, mean, interval, p99)


@needs_speed
@pytest.mark.parametrize("factor, holds", ((0.5, True), (0.97, False), (1.5, False)))
def test_an_advice_that_the_whole_run_refutes_is_withdrawn(monkeypatch, factor, holds):
    """Advice that the whole run refutes is withdrawn.

    The times are made up. At the measured moments, the tree halves the time of a step. Over the whole run it takes
    `factor` times as long as the scene's own broad phase. holds: whether the advice is kept.
    """
    monkeypatch.setattr(Moment, "time_run", lambda self, setting, *more: 5e-4 if setting.broadphase == "tree" else 1e-3)
    monkeypatch.setattr(
        proven_advice,
        "seconds_of_steps",
        lambda played, changes: np.full(played.steps, factor * 1e-3 if changes else 1e-3),
    )
    scene, recorder = recorded("lab/pyramid", 60)
    proven = advise_on_run(RecordedRun.of(scene, recorder), 1.0)
    assert proven.applied and all(each.setting.broadphase == "tree" for each in proven.applied)
    assert all(each.predicted == pytest.approx(0.5) for each in proven.applied)
    assert all(each.mean == pytest.approx(factor) and each.holds == holds for each in proven.applied)
    assert (proven.advice.best == proven.advice.here) == (not holds)
    assert len(proven.applied) == 1 if holds else len(proven.applied) <= proven_advice.MOST_TRIED


@pytest.mark.parametrize(
    "mean, best, end",
    ((0.5, SETTING, "holds"), (2.7, SETTING, "exact enough"), (2.7, None, "withdrawn"), (2.7, HERE, "withdrawn")),
)
def test_what_is_advised_is_not_called_withdrawn(mean, best, end):
    applied = Applied(SETTING, 0.6, mean, (mean, mean), mean)
    assert advise._tried(applied, HERE, best).endswith(end)


@needs_speed
def test_a_setting_that_the_scene_cannot_play_is_never_advised():
    scene, recorder = recorded("shooter", 60)
    recorded_run = RecordedRun.of(scene, recorder)
    setting = Setting(scene.broadphase, True, None, None, "outline")
    applied = apply_to_run(recorded_run, setting, 0.5)
    assert "does not play with the tier outline" in applied.refused and not applied.holds


@needs_speed
def test_the_worker_follows_a_run_and_begins_again_after_a_rewind():
    scene, recorder = recorded("shooter", 240)
    recorded_run, follower = RecordedRun.of(scene, recorder), Follower()
    halves = [recorded_run._replace(inputs=_first(recorded_run, n)) for n in (60, 120, 240)]
    found = [follower.follow(each, lambda: True) for each in halves]
    assert follower.steps == 240 and found[-1] == Follower().follow(recorded_run, lambda: True)
    assert all(a["aabb"].reported <= b["aabb"].reported for a, b in pairwise(found))
    assert follower.follow(halves[0], lambda: True) == found[0] and follower.steps == 60


def _first(recorded_run, steps):
    found = []
    for count, frame in recorded_run.inputs:
        taken = min(count, steps)
        if taken:
            found.append((taken, frame))
        steps -= taken
    return tuple(found)


@pytest.mark.parametrize("scene", ["lab/sensors", "shooter"])
@pytest.mark.parametrize("frames", [1, 30, 60, 299])
def test_a_run_too_short_to_advise_on_says_so(capsys, scene, frames):
    assert run(["--advise", scene, "--frames", f"{frames}"], Registry(SCENES)) == 2
    said = capsys.readouterr()
    assert f"--frames {frames}: too short a run to advise on; valid: 300 or more" in said.err and not said.out


@needs_speed
@pytest.mark.parametrize("steps", [300, 420])
def test_a_recorded_run_is_advised_on_by_the_command_of_its_csv_file(steps, tmp_path, capsys):
    _, recorder = recorded("lab/sensors", steps)
    recording, table = tmp_path / "run.json", tmp_path / "survey.csv"
    recorder.save(recording)
    given = ["--advise", "lab/sensors", "--replay", str(recording)]
    assert run([*given, "--csv", str(table)], Registry(SCENES)) == 0
    assert f"the recorded run of {steps} steps" in capsys.readouterr().out
    rows = list(csv.DictReader(table.open()))
    assert rows and all(f"--replay {recording} --frames {steps}" in row["command"] for row in rows)
    assert run([*given, "--frames", "200"], Registry(SCENES)) == 2
    assert "--frames 200: too short a run" in capsys.readouterr().err
