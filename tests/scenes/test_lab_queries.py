"""lab/queries: four worlds give equal answers, checked by a test of every shape, and the visited boxes are drawn."""

import math

import numpy as np
import pygame
import pytest

import physics
from game.input.inputs import InputFrame, InputState
from game.overlays.stack import Overlays
from game.run.picture import Picture
from game.run.session import Session
from game.run.sources import BotSource
from physics import debug
from scenes.lab.queries import EACH, HEIGHT, QUERIES, STRATEGIES, VIEW, WIDTH, Queries
from scenes.lab.query_calls import rows_of


class Player:
    """Input of a test for one scene, step by step."""

    def __init__(self, query="ray", bodies=100):
        self.scene, self.inputs = Queries(3), InputState()
        self.scene.change("slider:bodies", bodies)
        self.scene.change("slider:query", QUERIES.index(query))

    def step(self, *actions, pointer=(0, 0), down=False, wheel=0):
        self.inputs.set(InputFrame(frozenset(actions), pointer, down, wheel))
        self.scene.step(self.inputs)
        self.scene.observe()


@pytest.mark.parametrize("query", QUERIES)
def test_all_four_answer_alike_and_visit_what_they_count(query):
    player = Player(query)
    scene = player.scene
    for number in range(14):
        player.step(pointer=(VIEW[0] + 40 + 21 * number, VIEW[1] + 200 - 13 * number))
    assert scene.asked == 14 and scene.disagreements == 0
    for name, world in zip(STRATEGIES, scene.worlds, strict=True):
        nodes, boxes = scene.work[name]
        assert nodes + boxes > 0
        if name == "tree":
            assert len(debug.visited(world).rects) == nodes
    assert scene.work["brute"] == (0, 100 * len(scene.worlds[-1].queries.asked))


def test_the_nearest_point_is_the_nearest_of_all_and_a_ray_is_stopped_by_the_first():
    player = Player("closest")
    player.step(pointer=(200, 120))
    scene = player.scene
    world, (x, y) = scene.worlds[0], scene.target
    ((body, px, py, _, _, far),) = scene.answer
    assert far == pytest.approx(math.hypot(px - x, py - y)) and body in world
    boxes = debug.bounds(world)
    gaps = np.hypot(np.maximum(0, np.maximum(boxes[:, 0] - x, x - boxes[:, 2])),
                    np.maximum(0, np.maximum(boxes[:, 1] - y, y - boxes[:, 3])))  # fmt: skip
    assert gaps.min() <= far + 1e-9
    player = Player("all")
    player.step(pointer=(330, 200))
    every = player.scene.answer
    player = Player("ray")
    player.step(pointer=(330, 200))
    assert len(every) > 1 and player.scene.answer == every[:1]
    assert [row[5] for row in every] == sorted(row[5] for row in every)
    for _, _, _, nx, ny, _ in every:
        assert math.hypot(nx, ny) == pytest.approx(1.0)


def test_keys_choose_the_question_the_strategy_the_size_and_the_origin():
    player = Player()
    scene = player.scene
    player.step("right")
    assert scene.query == QUERIES[1]
    player.step()
    player.step("left")
    player.step()
    player.step("left")
    assert scene.query == QUERIES[-1]
    assert scene.views()[0][0].broadphase.name == "brute", "it starts with the one that looks at most"
    player.step("down")
    player.step()
    player.step("down")
    assert scene.shown == 1 and scene.views()[0][0].broadphase.name == "hash"
    player.step()
    player.step("up")
    player.step()
    player.step("up")
    assert STRATEGIES[scene.shown] == "brute"
    size = scene.values["size"]
    player.step(wheel=2)
    assert scene.values["size"] == size + 8
    player.step(pointer=(100, 100), down=True)
    player.step(pointer=(300, 200), down=True)
    assert scene.origin == scene.camera.to_world(100, 100) and scene.target == scene.camera.to_world(300, 200)
    player.step(pointer=(470, 100))  # beside the picture: nothing is meant by it
    assert scene.target == scene.camera.to_world(300, 200)
    assert 0.0 <= scene.target[0] <= WIDTH and 0.0 <= scene.target[1] <= HEIGHT


def test_another_strategy_paints_other_boxes():
    player, pictures = Player("all"), []
    for _ in STRATEGIES:
        player.step("down", pointer=(330, 200))
        frame = Picture(pygame.Surface((960, 540))).draw_scene(player.scene, Overlays())
        pictures.append(pygame.surfarray.array3d(frame.surface)[: 2 * (VIEW[0] + VIEW[2])])
        player.step(pointer=(330, 200))
    assert all((one != other).any() for one, other in zip(pictures, pictures[1:], strict=False))


@pytest.mark.skipif(not physics.JIT, reason="hundreds of steps of four worlds")
def test_the_bot_asks_everything():
    scene = Queries(0)
    scene.change("slider:bodies", 100)
    session = Session(scene, BotSource())
    for _ in range(EACH * len(QUERIES)):
        session.step()
    assert scene.kinds == set(QUERIES) and scene.disagreements == 0
    assert all(goal.met for goal in scene.check())


def test_no_answer_is_no_row():
    assert rows_of([None]) == [] and rows_of([]) == []
