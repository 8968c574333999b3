"""Regression tests of drawing, each with the smallest picture that showed the defect."""

from game.drawing.canvas import Canvas
from scenes.platformer.scene import Platformer
from scenes.platformer.view import flipped


def test_a_hanging_bat_is_turned_over_once_not_in_every_picture():
    scene = Platformer(seed=1)
    bat = next(enemy for enemy in scene.things.enemies.values() if enemy.kind == "bat")
    bat.way = 1
    scene.camera.center_on(*bat.character.position)
    made = []
    for _ in range(3):
        scene.draw(Canvas(), 1.0)
        made.append(flipped.cache_info().misses)
    assert made[0] == made[1] == made[2]
