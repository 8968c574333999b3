"""The end of a game of the shooter: lives, the countdown, continues and their cost, bonuses,
the result, and a restart.
"""

import pytest

from game.run.digest import scene_digest
from game.scene import Result
from scenes.shooter.ending import COUNTDOWN, GRACE, MOST_CONTINUES
from scenes.shooter.plane import LIVES
from scenes.shooter.scene import Shooter
from scenes.shooter.score import CHAIN_STEP, FIRST_LIFE, HOLD, TOP_CHAIN, Score
from tests.scenes.shooter_stages import Sky, boss_stage


def lose_all(sky):
    """Let the player lose all lives, until the countdown is shown. sky: the `Sky` to play."""

    def step():
        scene = sky.scene
        if scene.plane.here:
            scene.plane.safe = 0
            if not scene.stricken and not scene.plane.entering:
                sky.bullet("red", *scene.plane.body.position)
        return scene.ending.mode != "playing"

    sky.until(step, 2000)


def test_when_lives_are_gone_a_countdown_asks_and_then_it_is_over():
    sky = Sky()
    lose_all(sky)
    scene = sky.scene
    assert scene.ending.mode == "asking" and scene.result is None
    digits = []
    for _ in range(COUNTDOWN * 60 + 5):
        digits.append(scene.ending.digit)
        sky.step()
    assert digits[0] == 9 and 0 in digits and sorted(digits, reverse=True)[: len(digits)] == digits[: len(digits)]
    assert isinstance(scene.result, Result) and not scene.result.won
    assert scene.result.points == scene.score.points and scene.result.seconds == pytest.approx(
        scene.frame / 60, abs=0.2
    )
    result, frame = scene.result, scene.frame
    sky.step(20, ["fire"])
    sky.step(20, ["confirm"])
    assert scene.result is result and scene.frame == frame + 40, "it stands, and keys do nothing"


def test_fire_goes_on_with_points_begun_anew_that_count_the_continues():
    sky = Sky()
    for number in range(1, MOST_CONTINUES + 1):
        lose_all(sky)
        assert sky.scene.ending.mode == "asking"
        sky.scene.score.points = 54320
        sky.step(1, ["fire"])
        assert sky.scene.ending.mode == "asking", "a finger still on the trigger is no answer"
        sky.step(GRACE + 1)
        sky.step(1, ["fire"])
        assert sky.scene.ending.mode == "playing" and sky.scene.score.points == number
        assert sky.scene.plane.lives == LIVES
        sky.step(3)
        assert sky.scene.plane.here
    lose_all(sky)
    assert sky.scene.ending.mode == "lost" and sky.scene.result is not None, "three continues at most"


def test_the_world_stands_still_while_it_asks_and_bomb_hurries():
    sky = Sky()
    lose_all(sky)
    sky.enemy("dart", 100, 50, thinks=True)
    before = sky.scene.world.bodies["y"].tolist()
    sky.step(GRACE + 1)
    assert sky.scene.world.bodies["y"].tolist() == before
    digit = sky.scene.ending.digit
    sky.step(1, ["bomb"])
    assert sky.scene.ending.digit == digit - 1


def test_after_the_boss_bonuses_are_counted_one_by_one(tmp_path):
    sky = Sky(quiet=False, level=boss_stage(tmp_path / "s.json", phases=(0,), health=1))
    sky.until(lambda: sky.scene.ending.mode == "cleared", 3000, ["fire"])
    before = sky.scene.score.points
    wanted = sky.scene.score.final(sky.scene.plane.lives, sky.scene.plane.bombs)
    sky.until(lambda: sky.scene.result is not None, 600)
    assert sky.scene.ending.counted == wanted and [name for name, _ in wanted][-1] == "NO CONTINUE"
    result = sky.scene.result
    assert result.won and result.points == before + sum(points for _, points in wanted) and result.lines
    sky.step(60, ["fire"])
    assert sky.scene.result is result


def test_a_restart_forgets_everything():
    sky = Sky(quiet=False)
    sky.step(300, ["fire", "left"])
    sky.step(1, ["bomb"])
    sky.step(30)
    sky.scene.restart()
    assert scene_digest(sky.scene) == scene_digest(Shooter(seed=1))
    assert sky.scene.result is None and sky.scene.score.points == 0 and sky.scene.director.grounds[0][1] == "sea"


# --- points ----------------------------------------------------------------------------------------------------------


class Target:
    kind, points = "dart", 100


def test_the_chain_multiplies_and_breaks_when_nothing_happens():
    score = Score(["dart"])
    for _ in range(CHAIN_STEP - 1):
        assert score.kill(Target) == 100
    assert score.kill(Target) == 200 and score.times == 2
    for _ in range(HOLD - 1):
        assert not score.step(quiet=False)
    assert not score.step(quiet=True) and score.chain, "with nobody to shoot at it waits"
    assert score.step(quiet=False) and score.times == 1
    for _ in range(400):
        score.kill(Target)
    assert score.times == TOP_CHAIN


def test_grazes_hold_the_chain_a_hit_breaks_it():
    score = Score(["dart"])
    for _ in range(20):
        score.kill(Target)
    for _ in range(HOLD - 5):
        score.step(quiet=False)
    score.graze(2)
    for _ in range(60):
        assert not score.step(quiet=False)
    score.hit()
    assert score.chain == 0 and score.times == 1 and score.best_chain == 22


def test_lives_are_earned_at_steps_of_points():
    score = Score(["dart"])
    score.points = FIRST_LIFE - 10
    assert not score.earned_life()
    score.points = FIRST_LIFE
    assert score.earned_life() and not score.earned_life()


def test_haste_is_worth_up_to_twice_the_bonus():
    assert Score([]).phase(10000, 0.0) == 5000 and Score([]).phase(10000, 1.0) == 10000
