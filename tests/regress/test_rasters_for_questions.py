"""Freeing unused rasters works after queries about rotated masks; before the fix it failed on ids of freed rasters."""

from math import pi

import numpy as np

from physics import Circle, Effects, PixelMask, Polygon, World


def test_a_library_is_tidied_up_after_questions_about_turned_masks():
    world = World(Effects.rigid_bodies(), gravity=(0.0, 0.0))
    masks = [PixelMask.from_array(np.ones((20, 30 + k), bool)) for k in range(4)]
    turned = [world.add_body(masks[k], position=(40 * k, 50), angle=(k + 1) * pi / 7) for k in range(4)]
    assert world.overlap(Circle(90.0), (60.0, 50.0)) == turned
    library = world.library
    for k in range(200):  # shapes that are no longer in use
        world.add_body(Polygon.box(3.0 + k, 4.0), position=(900, 0)).remove()
    world.add_body(Circle(3.0), position=(900, 0))
    assert world.library is not library
    assert world.overlap(Circle(90.0), (60.0, 50.0)) == turned
    assert [world.query_point((40.0 * k, 50.0)) for k in range(4)] == [[body] for body in turned]
