"""Overlays are visible over the cells of lab/ladder, which were once drawn on top of them."""

import pygame
import pytest

from game.overlays.stack import Overlays
from game.run.picture import Picture
from tests.lockstep import make_scene


@pytest.mark.parametrize("layer", ["bounds", "outlines"])
def test_what_is_drawn_over_a_cell_is_seen(layer):
    scene = make_scene("lab/ladder")
    shown = []
    for names in ((), (layer,)):
        picture = Picture(pygame.Surface((960, 540)))
        picture.draw_scene(scene, Overlays(names))
        frame = picture.presenter.frame
        cells = [frame.from_canvas(view) for _, _, view in scene.cells.values()]
        shown.append([pygame.image.tobytes(frame.surface.subsurface(each), "RGB") for each in cells])
    assert any(one != other for one, other in zip(*shown, strict=True))
