"""A tower that stands slightly above its start is not shown as sinking by "-0.00 px" in
lab/mask_stack or lab/stacks.
"""

import pytest

from game.drawing.canvas import Canvas
from game.run.session import Session
from game.run.sources import IdleSource
from scenes.lab.mask_stack import WARM, MaskStack
from scenes.lab.stacks import Stacks

HAIR = -0.004  # px


@pytest.mark.parametrize("scene_class", [MaskStack, Stacks])
def test_the_page_tells_no_negative_nothing(scene_class):
    scene = scene_class(0)
    session = Session(scene, IdleSource())
    for _ in range(WARM + 2):
        session.step()
    sunk = scene.sinks if scene_class is MaskStack else scene.sag
    for way in sunk:
        sunk[way] = HAIR
    canvas = Canvas()
    canvas.begin((0, 0, 0))
    scene.draw(canvas, 1.0)
    told = [*(text for _, text in canvas.boxes), scene.finding()]
    assert any("0.00 px" in each or each == "0.0 %" for each in told)
    assert not any("-0.0" in each for each in told), told
