"""The lander's picture: texts never overlap from the title to the result, and drawing does not change the game."""

from itertools import combinations

import pytest

import physics
from game.drawing.canvas import Canvas
from game.run.digest import scene_digest
from scenes.lander.course import CHEER, FLYING, LOST, WON
from scenes.lander.feel import AWAY, LIVES
from tests.scenes.lander_stage import Flight

pytestmark = pytest.mark.skipif(not physics.JIT, reason="seconds of play take too long without compiled kernels")


def texts(scene):
    """Return the texts of a picture, after a check that none is cut off or overlaps another."""
    canvas = Canvas()
    canvas.begin((0, 0, 0))
    scene.draw(canvas, 1.0)
    for rect, text in canvas.boxes:
        assert canvas.rect.contains(rect), (text, rect)
    for (rect, text), (other, more) in combinations(canvas.boxes, 2):
        assert not rect.colliderect(other), (text, more, rect, other)
    return {text for _, text in canvas.boxes}


def test_texts_keep_clear_of_each_other_from_the_title_to_the_medal():
    flight = Flight()
    scene = flight.scene
    scene.best, scene.score.points = 99_999_990, 12_345_670
    seen = set()
    for number in (1, 2, 3):
        flight.put_over(scene.moon.pads[number], 4.0, (0.0, 12.0))
        for _ in range(CHEER + 400):
            flight.step()
            if scene.frame % 5 == 0:
                seen |= texts(scene)
            if scene.course.act == number and scene.course.mode == FLYING and scene.spectacle.act_since > 300:
                break
    flight.until(lambda: scene.course.mode == WON, 1500)
    seen |= texts(scene)
    assert {"ACT I", "FROST CANYON", "ACT III", "FROST CANYON REACHED", "ALL SITES REACHED", "NO SHIP LOST"} <= seen
    assert any("MEDAL" in text for text in seen)


def test_game_over_is_reported():
    flight = Flight()
    for _ in range(LIVES):
        flight.until(lambda: flight.ship.here, AWAY + 5)
        flight.scene.give_up()
        texts(flight.scene)
    flight.until(lambda: flight.scene.course.mode == LOST, AWAY + 5)
    assert "GAME OVER" in texts(flight.scene)


def test_drawing_changes_nothing():
    one, other = Flight(), Flight()
    for flight in (one, other):
        flight.put(900.0, 560.0)
    for _ in range(60):
        one.step(1, ["up", "fire"])
        other.step(1, ["up", "fire"])
        texts(one.scene)
    assert scene_digest(one.scene) == scene_digest(other.scene)


def test_every_sound_it_asks_for_is_there():
    from game.places import SOUNDS

    flight = Flight()
    asked = set()
    flight.put(700.0, 300.0)
    for _ in range(900):
        flight.step(1, ["up", "fire"] if flight.scene.frame % 90 < 30 else ["right"])
        asked |= {name for name, _, _ in flight.scene.cues}
    assert {"thrust", "heavy_laser", "blast"} <= asked
    assert all((SOUNDS / f"{name}.wav").is_file() for name in asked)
