"""The lander's bot lands on all three sites with several seeds, and its run can be replayed from a recording."""

import pytest

import physics
from game.registry import Registry
from game.run.outcome import judge
from game.run.replay import Recorder
from game.run.replay_check import load_replay_for
from game.run.session import Session
from game.run.sources import BotSource
from scenes import SCENES
from scenes.lander.goals import CLEARED
from scenes.lander.scene import Lander

pytestmark = pytest.mark.skipif(not physics.JIT, reason="minutes of play take too long without compiled kernels")


@pytest.mark.parametrize("seed", [1, 2, *(pytest.param(seed, marks=pytest.mark.nightly) for seed in (3, 4, 5, 6, 7))])
def test_the_bot_flies_the_course(seed):
    scene = Lander(seed=seed)
    session = Session(scene, BotSource())
    while scene.result is None and scene.frame < CLEARED:
        session.step()
    assert scene.result is not None and scene.result.won, scene.course.state()
    check = judge(scene, CLEARED)
    assert check["failures"] == [] and check["pending"] == []
    assert scene.score.lost == 0 and scene.score.fired > 3 and scene.ground.touched
    assert session.report.quarantined == 0


def test_goals_are_pending_until_they_are_due():
    scene = Lander(seed=1)
    session = Session(scene, BotSource())
    for _ in range(300):
        session.step()
    check = judge(scene, 300)
    assert check["ok"] and check["pending"]


def test_a_run_that_does_not_land_fails_its_check():
    scene = Lander(seed=1)
    for _ in range(2):
        scene.give_up()
        scene.ship.away = 1
        scene.ship.wait()
    scene.frame = CLEARED
    assert not judge(scene, CLEARED)["ok"]


def test_a_recording_of_shots_and_craters_plays_to_the_same_digest(tmp_path):
    scene = Lander(seed=3)
    recorder = Recorder(scene, bot=True)
    session = Session(scene, BotSource(), recorder)
    while scene.score.fired < 3:
        session.step()
    path = tmp_path / "flight.json"
    recorder.save(path)
    recording, _ = load_replay_for(path, Registry(SCENES))
    again = Lander(seed=3)
    replayed = Session(again, recording, replay=recording)
    for _ in range(recording.frames):
        replayed.step()
    assert again.state() == scene.state() and again.world.digest() == scene.world.digest()
