"""lab/sleeping: heaps fall asleep, an impact wakes island after island, and the counts are those of the world."""

import numpy as np
import pytest

import physics
from game.input.inputs import InputFrame, InputState
from game.run.session import Session
from game.run.sources import BotSource
from scenes.lab.sleeping import BALLS, KNOCK, LIT, METER, SETTLE, Sleeping

needs_speed = pytest.mark.skipif(not physics.JIT, reason="hundreds of steps of a hundred bodies")


def played(frames, **values):
    scene = Sleeping(1)
    for name, value in values.items():
        scene.change(f"slider:{name}", value)
    session = Session(scene, BotSource())
    for _ in range(frames):
        session.step()
        scene.observe()
    return scene, session


def press(scene, *actions, pointer=(0, 0), down=False):
    inputs = InputState()
    inputs.set(InputFrame(frozenset(actions), pointer, down))
    scene.step(inputs)


def test_a_hundred_bodies_in_several_islands():
    scene, _ = played(2)
    assert scene.awake >= 100 and scene.asleep == 0 and scene.heaped == scene.awake + 5
    assert scene.islands >= 10


@needs_speed
def test_a_knock_wakes_island_after_island_and_all_sleep_again():
    scene, session = played(SETTLE)
    bodies = scene.world.bodies
    assert scene.awake == 0 == np.count_nonzero(bodies["awake"] & (bodies["inverse_mass"] > 0.0))
    assert scene.idle == 0 and 0 < scene.slept_at < SETTLE and not scene.waves
    while not scene.waves:
        session.step()
    assert scene.frame > KNOCK and scene.first_woken == 1
    ball = scene.balls[0]
    lit = set(scene.lit) - {ball}
    awake = {i for i, a in zip(bodies_of(scene)["id"].tolist(), bodies_of(scene)["awake"].tolist(), strict=True) if a}
    assert lit and lit <= awake and len(lit) < scene.heaped / 2, "the island that was met, and no other"
    for _ in range(LIT + 1):
        session.step()
    assert not lit & set(scene.lit) and set(scene.lit) <= set(scene.shapes)
    for _ in range(1500 - scene.frame):
        session.step()
        scene.observe()
    assert all(goal.met for goal in scene.check()), [goal for goal in scene.check() if not goal.met]
    steps = [step for step, _ in scene.waves]
    assert steps == sorted(steps) and steps[-1] - steps[0] > 60, "a wave, not one blow"


def bodies_of(scene):
    return scene.world.bodies[scene.world.bodies["inverse_mass"] > 0.0]


@needs_speed
def test_without_sleep_nobody_sleeps_and_nothing_wakes():
    scene, session = played(1)
    scene.change("slider:sleep", 0)
    for _ in range(SETTLE):
        session.step()
    assert scene.awake == scene.heaped - 5 and scene.asleep == 0 and scene.slept_at < 0
    assert not next(goal for goal in scene.check() if goal.due == SETTLE).met
    assert scene.measured() is None, "there is nothing to compare"


def test_balls_come_where_is_clicked_and_the_oldest_goes():
    scene, _ = played(1)
    press(scene, pointer=(240, 100), down=True)
    vx, vy = scene.world.body(scene.balls[0]).velocity
    (x, y), (to_x, to_y) = scene.world.body(scene.balls[0]).position, scene.camera.to_world(240, 100)
    assert vx > 0.0 and abs((to_y - y) / (to_x - x) - vy / vx) < 0.1
    press(scene, pointer=(240, 260), down=True)  # below the yard, without a body
    assert len(scene.balls) == 1
    first = scene.balls[0]
    for _ in range(BALLS):
        press(scene)
        press(scene, "fire")
    assert len(scene.balls) == BALLS and first not in scene.world and first not in scene.shapes
    aim = scene.aim
    press(scene, "right")
    assert scene.aim > aim and scene.aim < 30 * METER
