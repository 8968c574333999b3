"""Bosses of the shooter: a warning, phases with health and timers, a cleared sky between them, 1,500 bullets, one
digest.
"""

import numpy as np
import pytest

import physics
from game.drawing.canvas import Canvas
from game.run.digest import scene_digest
from game.run.session import Session
from game.run.sources import BotSource
from scenes.shooter.boss import CHANGE, FALL
from scenes.shooter.director import WARNING
from scenes.shooter.scene import FREEZE, Shooter
from tests.all_broadphases import scene_asking_all
from tests.scenes.shooter_stages import Sky, boss_stage, midboss_stage

needs_speed = pytest.mark.skipif(not physics.JIT, reason="takes too long without compiled kernels")


def boss_sky(path):
    """Return a `Sky` with a boss stage, at the start of the fight; the plane is invincible."""
    sky = Sky(quiet=False, level=path)
    sky.step(1, changes=[("assist:invincible", True)])
    sky.until(lambda: sky.scene.fleet.leader is not None and sky.scene.fleet.leader.mode == "fight", 900)
    return sky


def test_a_leader_is_announced_and_brings_its_own_tune(tmp_path):
    sky = Sky(quiet=False, level=boss_stage(tmp_path / "s.json"))
    sky.until(lambda: sky.scene.director.mode == "warning", 400)
    assert sky.scene.music == "boss" and ("warning", None, 0.9) in sky.scene.cues
    assert sky.until(lambda: sky.scene.fleet.leader is not None, 400) == pytest.approx(WARNING, abs=2)
    clock = sky.scene.director.clock
    sky.step(60)
    assert sky.scene.director.clock == clock, "the stage waits"


def test_a_leader_cannot_be_hurt_before_it_is_in_its_place(tmp_path):
    sky = Sky(quiet=False, level=boss_stage(tmp_path / "s.json"))
    sky.until(lambda: sky.scene.fleet.leader is not None, 900)
    leader = sky.scene.fleet.leader
    sky.until(lambda: leader.mode == "fight" or sky.step(1, ["fire"]), 400)
    assert leader.health == leader.full


def test_three_phases_with_looks_and_patterns_of_their_own(tmp_path):
    sky = boss_sky(boss_stage(tmp_path / "s.json"))
    boss, seen = sky.scene.fleet.leader, []
    for number in range(3):
        assert boss.number == number and boss.frame == f"boss_{'abc'[number]}_0" and boss.health == boss.full
        seen.append([gun.pattern for gun in boss.guns])
        sky.until(lambda: len(sky.scene.incoming) > 20, 900)
        boss.health = 0.1
        points = sky.scene.score.points
        sky.until(lambda: boss.mode != "fight", 200, ["fire"])
        assert sky.scene.freeze == FREEZE and sky.scene.flash.light > 0.0
        assert sky.scene.score.points > points + boss.phase.bonus // 2
        sky.step(FREEZE + 2)
        assert len(sky.scene.incoming) == 0, "the sky is cleared"
        assert sky.scene.plane.ghost
        if number < 2:
            assert sky.until(lambda: boss.mode == "fight", 300) == pytest.approx(CHANGE, abs=6)
    assert seen[0] != seen[1] != seen[2]
    assert boss.mode == "fall" and sky.scene.beaten["boss"]
    assert sky.until(lambda: sky.scene.fleet.leader is None, 400) == pytest.approx(FALL, abs=8)
    assert sky.scene.ending.mode == "cleared"


def test_its_time_runs_out_and_then_there_is_no_bonus(tmp_path):
    sky = boss_sky(boss_stage(tmp_path / "s.json", phases=(0,), seconds=5))
    boss = sky.scene.fleet.leader
    sky.scene.plane.shelter(9999)
    points = sky.scene.score.points
    assert sky.until(lambda: boss.mode != "fight", 400) == pytest.approx(300, abs=4)
    assert boss.mode == "leave" and not sky.scene.beaten["boss"]
    assert sky.scene.score.points - points < 1000, "points for the bullets that burnt, no more"
    sky.until(lambda: sky.scene.ending.mode == "cleared", 900)


def test_the_mid_boss_leaves_a_life_and_the_stage_goes_on(tmp_path):
    sky = Sky(quiet=False, level=midboss_stage(tmp_path / "s.json", health=1))
    sky.step(1, changes=[("assist:invincible", True)])
    sky.until(lambda: sky.scene.beaten["midboss"], 1500, ["fire"])
    sky.until(lambda: sky.scene.loot.items, 400)
    assert [item.what for item in sky.scene.loot.items.values()] == ["life"]
    sky.until(lambda: sky.scene.director.mode == "run", 900)
    assert sky.scene.music == "shooter"
    sky.until(lambda: sky.scene.director.mode == "leader", 2000)
    assert sky.scene.fleet.leader.kind == "boss"


def test_a_bomb_hurts_a_leader_once(tmp_path):
    sky = boss_sky(boss_stage(tmp_path / "s.json"))
    boss = sky.scene.fleet.leader
    sky.until(lambda: sky.scene.plane.y < 150, 400, ["up"])
    before = boss.health
    sky.step(1, ["bomb"])
    sky.step(80)
    assert 0 < before - boss.health <= 45.0


@needs_speed
def test_the_last_phase_holds_1500_bullets_and_all_of_them_go(tmp_path):
    scene = Shooter(seed=1, level=boss_stage(tmp_path / "s.json", phases=(2,), health=5000, seconds=25))
    scene.assist["invincible"] = True
    session = Session(scene, BotSource())
    while scene.ending.mode == "playing" and scene.frame < 3000:
        scene.score.bombs, scene.plane.bombs = 1, 0  # no bomb thins them out
        session.step()
    assert scene.most_bullets >= 1500
    assert scene.unknown == 0 and session.report.quarantined == 0
    for _ in range(10):
        session.step()
    assert len(scene.incoming) == 0 and len(scene.world.bodies) < 60


@needs_speed
def test_the_fight_is_the_same_twice_drawn_and_under_every_broad_phase(tmp_path):
    path = boss_stage(tmp_path / "s.json", phases=(1, 2), health=40)
    first, other = Shooter(seed=3, level=path), scene_asking_all(Shooter)(seed=3, level=path)
    sessions, canvas = [Session(scene, BotSource()) for scene in (first, other)], Canvas()
    for frame in range(900):
        for session in sessions:
            session.step()
        assert scene_digest(first) == scene_digest(other), f"since frame {frame + 1}"
        if frame % 5 == 0:
            canvas.begin()
            other.draw(canvas, 0.4)
    assert first.most_bullets > 100


@needs_speed
def test_bullets_of_the_last_phase_leave_lanes_that_a_plane_fits_through(tmp_path):
    sky = boss_sky(boss_stage(tmp_path / "s.json", phases=(2,), health=5000))
    boss = sky.scene.fleet.leader
    sky.step(420)
    rows = sky.scene.world.bodies[sky.scene.incoming.places()]
    small = rows[np.isclose(np.hypot(rows["vx"], rows["vy"]), boss.guns[0].pattern.speed)]
    far = np.hypot(small["x"] - boss.x, small["y"] - boss.y)
    around = small[(far > 135) & (far < 141)]
    headings = np.sort(np.arctan2(around["y"] - boss.y, around["x"] - boss.x))
    lanes = np.diff(headings)[np.diff(headings) > 0.12] * 138
    assert len(lanes) > 8 and lanes.min() > 6 + 2 * 2.5 + 6
