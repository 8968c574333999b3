"""The camera looks ahead, does not follow every hop, looks up or down on request, and stays in its zone."""

import pytest

from game.drawing.canvas import CANVAS_SIZE
from game.run.session import Session
from game.run.sources import BotSource, ScriptSource
from scenes.platformer.feel import HEIGHT
from scenes.platformer.gaze import AHEAD, PEEK, rows_of
from scenes.platformer.scene import Platformer


def start(keys=""):
    scene = Platformer(seed=1)
    return scene, Session(scene, ScriptSource([keys.split()] * 900))


def run(session, frames):
    for _ in range(frames):
        session.step()


def middle(scene):
    return scene.camera.x + CANVAS_SIZE[0] / 2, scene.camera.y + CANVAS_SIZE[1] / 2


def flat(scene, x=44 * 16, bottom=320):
    """Place the hero on level ground in the meadow, and remove the enemies."""
    for enemy in list(scene.things.enemies.values()):
        scene.things.remove(enemy)
    scene.hero.place((x, bottom - HEIGHT / 2))
    scene.spawn = (x, bottom - HEIGHT / 2)
    scene.look.arrive()


def test_it_looks_ahead_of_a_run_to_either_side():
    for keys, way in (("right", 1), ("left", -1)):
        scene, session = start(keys)
        flat(scene, x=(38 if way > 0 else 50) * 16)
        run(session, 45)
        ahead = (middle(scene)[0] - scene.hero.character.position[0]) * way
        assert 0 < ahead < AHEAD


def test_a_hop_does_not_move_it_up_and_a_landing_higher_does():
    scene, session = start("jump")
    flat(scene, x=37 * 16)
    y = middle(scene)[1]
    for _ in range(40):
        session.step()
        assert abs(middle(scene)[1] - y) < 8
    scene.hero.place((scene.hero.character.position[0], 224 - HEIGHT / 2))  # a ledge of six tiles: not a hop
    scene.hero.grounded = True
    scene.look.gaze.level_y = 214
    run(session, 1)
    assert middle(scene)[1] < y


@pytest.mark.parametrize("key, way", [("up", -1), ("down", 1)])
def test_it_peeks_up_and_down_when_asked_for_a_while(key, way):
    scene, session = start(key)
    flat(scene, x=23 * 16 + 8 + 16, bottom=256)
    y = middle(scene)[1]
    run(session, 20)
    assert abs(middle(scene)[1] - y) < 2
    run(session, 60)
    assert 0 < (middle(scene)[1] - y) * way <= PEEK


def test_it_never_shows_what_is_beside_the_map_or_its_zone():
    scene = Platformer(seed=1)
    session = Session(scene, BotSource())
    width, height = scene.level.size
    for _ in range(1500):
        session.step()
        left, top = scene.camera.x, scene.camera.y
        assert 0 <= left <= width - CANVAS_SIZE[0] and 0 <= top <= height - CANVAS_SIZE[1]


def test_every_place_of_the_way_is_in_a_zone_and_every_zone_is_as_large_as_a_picture():
    scene, _ = start()
    for hint in scene.level.hints:
        assert scene.level.zones_at(hint.x + 8, hint.y + 6), (hint.x // 16, hint.y // 16)
    for zone in scene.level.zones:
        top, bottom = rows_of(zone)
        assert bottom - top >= CANVAS_SIZE[1]
    assert {zone.properties["act"] for zone in scene.level.zones} == {"meadow", "cave", "keep"}
