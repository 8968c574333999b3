"""The shooter's bot survives a minute with any seed and the whole stage with most; copied games continue equally."""

import copy

import pytest

import physics
from game.run.digest import scene_digest
from game.run.outcome import judge
from game.run.session import Session
from game.run.sources import BotSource
from scenes.shooter.goals import CLEARED
from scenes.shooter.scene import Shooter
from tests.scenes.shooter_stages import boss_stage

pytestmark = pytest.mark.skipif(not physics.JIT, reason="minutes of play take too long without compiled kernels")


def play(scene, frames):
    session = Session(scene, BotSource())
    for _ in range(frames):
        session.step()
    return session


@pytest.mark.parametrize("seed", [2, *(pytest.param(seed, marks=pytest.mark.nightly) for seed in (3, 4, 5))])
def test_the_bot_fights_through_a_minute(seed):
    scene = Shooter(seed=seed)
    session = play(scene, 3600)
    check = judge(scene, 3600)
    assert check["ok"], check
    assert session.report.quarantined == 0 and not session.report.counters["cap_hits"]


@pytest.mark.parametrize("part", ["core", "hull"])
def test_the_bot_knows_what_hurts(part):
    scene = Shooter(seed=1)
    scene.change("slider:hurts", 0 if part == "core" else 1)
    play(scene, 2400)
    assert scene.hurts == part and scene.score.hits <= 2
    if part == "hull":
        assert scene.hits.count["hull"] <= 4, "it keeps its wings out of the fire"
    assert scene.hits.count["core"] <= scene.hits.count["hull"] <= scene.hits.count["box"]


@pytest.mark.nightly
def test_the_bot_clears_the_stage_on_one_seed_in_three_at_least():
    won = []
    for seed in (1, 2, 3):
        scene = Shooter(seed=seed)
        session = Session(scene, BotSource())
        while scene.result is None and scene.frame < CLEARED:
            session.step()
        won.append(scene.result is not None and scene.result.won and not scene.score.continues)
        if won[-1]:
            assert judge(scene, CLEARED)["failures"] == []
        assert scene.unknown == 0 and session.report.quarantined == 0
    assert sum(won) >= 1


def test_a_copy_goes_on_as_the_scene_does(tmp_path):
    scene = Shooter(seed=2, level=boss_stage(tmp_path / "s.json", health=60))
    play(scene, 700)
    other = copy.deepcopy(scene)
    for each in (scene, other):
        play(each, 200)
    assert scene_digest(scene) == scene_digest(other)
