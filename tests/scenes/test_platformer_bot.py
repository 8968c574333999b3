"""The platformer's bot completes the level, its digest is the same however it is run, and each
declared effect matters.
"""

import copy

import pytest

import physics
from game.drawing.canvas import Canvas
from game.run.digest import scene_digest
from game.run.outcome import judge
from game.run.session import Session
from game.run.sources import BotSource
from scenes.platformer.feats import GOAL_DUE
from scenes.platformer.scene import Platformer

pytestmark = pytest.mark.skipif(not physics.JIT, reason="minutes of play take long without compiled kernels")
SHORT = 1900  # steps: past the first belt, whose crate is thrown through a plank


def run(frames, draws=False, effects=None, **settings):
    """Return a scene after its bot has played it for some frames. draws: True draws every seventh frame."""
    kind = Platformer if effects is None else type("Other", (Platformer,), {"effects": effects})
    scene = kind(**({"seed": 1} | settings))
    session, canvas = Session(scene, BotSource()), Canvas()
    for number in range(frames):
        session.step()
        if draws and number % 7 == 0:
            scene.draw(canvas, 0.5)
        if scene.result is not None:
            break
    return scene


def assert_all_done(scene):
    check = judge(scene, GOAL_DUE)
    assert check["ok"] and not check["pending"], check
    assert scene.result.won and scene.secrets == 4 and scene.feats.inside_solid == 0


def test_the_bot_finds_the_secrets_and_the_goal():
    assert_all_done(run(GOAL_DUE))


@pytest.mark.nightly
@pytest.mark.parametrize("seed", [0, 2, 3, 4, 5])
def test_the_bot_finds_them_on_other_seeds_too(seed):
    assert_all_done(run(GOAL_DUE, seed=seed))


@pytest.mark.nightly
def test_with_the_assist_nothing_is_ever_lost():
    scene = Platformer(seed=0)
    scene.assist["invincible"] = True
    session = Session(scene, BotSource())
    while scene.result is None and scene.frame < 2 * GOAL_DUE:
        session.step()
    assert scene.result is not None and scene.deaths == 0


def test_a_copy_goes_on_as_the_scene_does():
    scene = run(700)
    twin = copy.deepcopy(scene)
    assert twin.level is scene.level
    for one in (scene, twin):
        session = Session(one, BotSource())
        for _ in range(200):
            session.step()
    assert scene_digest(twin) == scene_digest(scene) and twin.frame == 900


def test_pieces_of_stones_could_not_turn_without_rotation():
    with pytest.raises(ValueError, match="needs the effect rotation"):
        run(SHORT, effects=Platformer.effects.with_(rotation=False))


@pytest.mark.parametrize("name", ["response", "continuous", "sensors", "stacking"])
def test_what_the_scene_asks_for_needs_the_other_effects(name):
    gone = {name: False} | ({"sleeping": False} if name == "stacking" else {})
    gone |= (
        dict.fromkeys(("friction", "stacking", "one_way", "conveyor", "sleeping"), False) if name == "response" else {}
    )
    with pytest.raises(ValueError, match=name):
        run(1, effects=Platformer.effects.with_(**gone))


def test_seeds_differ_by_their_walkers():
    assert len({scene_digest(run(30, seed=seed)) for seed in (1, 2, 3)}) > 1
