"""Contacts of masks have their area in worlds without response; before the fix it was 0.

There a step tests only whether two masks overlap.
"""

import numpy as np
import pytest

from physics import Effects, PixelMask, World, collide

L = np.ones((9, 9), bool)
L[:5, 4:] = False


@pytest.mark.parametrize("snap", [True, False])
@pytest.mark.parametrize("offset", [(5, 1), (-3, 4), (6, -6), (0, 7)])
def test_area_point_normal_and_depth_are_those_that_collide_tells(snap, offset):
    mask = PixelMask(L, snap=snap)
    world = World(Effects())
    for place in ((0.0, 0.0), offset):
        world.add_body(mask, position=place)
    world.step()
    wanted = collide(mask, (0, 0, 0), mask, (*offset, 0))
    contacts = world.contacts
    assert (len(contacts) > 0) == (wanted.area > 0.0)
    if len(contacts):
        (contact,) = contacts
        assert contact["area"] == wanted.area
        assert (contact["normal_x"], contact["normal_y"]) == pytest.approx(tuple(wanted.normal))
        assert contact["separation"] == pytest.approx(wanted.separations[0])
        assert (contact["point_x"], contact["point_y"]) == pytest.approx(tuple(wanted.points[0]))


def test_shapes_that_went_since_the_step_change_nothing_of_the_others():
    world = World(Effects())
    masks = [world.add_body(PixelMask(np.ones((8, 8), bool)), position=(5.0 * k, 0.0)) for k in range(3)]
    world.step()
    masks[0].remove()
    contacts = world.contacts
    assert contacts["body_b"].tolist() == [1, 2]
    assert contacts["area"][1] == 24.0
