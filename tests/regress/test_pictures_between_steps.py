"""A window draws states interpolated between steps, and all lanes of a scene are visible in them.

A lane was empty if its camera was not notified of the step. A run without a window draws the poses of the last step, so
no screenshot showed this.
"""

import numpy as np
import pygame
import pytest

from game.drawing.canvas import Canvas
from game.registry import Registry
from game.run.session import Session
from game.run.sources import BotSource
from scenes import SCENES

REGISTRY = Registry(SCENES)
FRAMES = (7, 23, 41)  # after which is looked
SPARE = 2.0  # of 255: what animations may add, on average over a view


def played(name, frames):
    """Yield (scene, frame) after each frame that a scene is played by its bot."""
    scene = REGISTRY.scene_class(name)(0)
    session = Session(scene, BotSource())
    for frame in range(1, frames + 1):
        session.step()
        yield scene, frame


def picture(scene, alpha):
    canvas = Canvas()
    canvas.begin((0, 0, 0))
    scene.draw(canvas, alpha)
    return pygame.surfarray.array3d(canvas.surface).astype(np.int64)


def apart(one, other, view):
    """Return the mean difference of two pictures within a view, on a scale of 255."""
    left, top, width, height = view
    box = slice(left, left + width), slice(top, top + height)
    return float(np.abs(one[box] - other[box]).mean())


@pytest.mark.parametrize("name", REGISTRY.names)
def test_cameras_are_where_they_were_at_alpha_zero(name):
    """A camera shows the end of the previous step at alpha 0 and the end of the last step at alpha 1."""
    before = {}
    for scene, frame in played(name, 60):
        for number, (_, camera) in enumerate(scene.views()):
            camera.shake_share = 0.0  # shaking goes by time
            was, (x, y) = before.get(number), camera.view(0.0)
            jumped = (camera.previous_x, camera.previous_y) == (camera.x, camera.y)
            assert was is None or jumped or (x, y) == was, f"view {number} after step {frame}"
            before[number] = camera.view(1.0)


@pytest.mark.parametrize("name", REGISTRY.names)
def test_halfway_is_between_the_ends(name):
    """The picture at alpha 0.5 differs from those at 0 and 1 by no more than these differ from each other."""
    last = None
    for scene, frame in played(name, max(FRAMES)):
        if frame in FRAMES:
            now, half, start = (picture(scene, alpha) for alpha in (1.0, 0.5, 0.0))
            for number, (_, camera) in enumerate(scene.views()):
                view = camera.viewport
                moved = apart(now, last, view)
                assert apart(half, now, view) <= moved + SPARE, f"view {number} at 0.5 after step {frame}"
                assert apart(start, last, view) <= moved + SPARE, f"view {number} at 0 after step {frame}"
        if frame + 1 in FRAMES:
            last = picture(scene, 1.0)
