"""A body of several shapes, stopped on its way, stands at an angle nobody foresaw: its mask is drawn there too."""

import math

import numpy as np
import pytest

from physics import Circle, Effects, PixelMask, Polygon, World


@pytest.mark.parametrize("spin", [7.0, 23.0, -31.0])
def test_a_mask_that_is_stopped_half_way_has_a_raster_at_its_angle(spin):
    world = World(Effects(response=True, rotation=True, continuous=True))
    world.add_body(Polygon.box(4, 200), position=(60, 0), kind="static")
    mask = PixelMask.from_array(np.ones((3, 19), bool))
    plate = world.add_body(PixelMask.from_array(np.ones((9, 9), bool)), position=(46, 0), kind="static")
    body = world.add_body(Circle(5), mask, velocity=(4800.0, 0.0), angular_velocity=spin)
    world.step()
    assert plate.id in world.contacts["body_a"], "the rod lies across the plate in the very step that turns it there"
    row = world.shapes[world.shapes["body"] == body.id][1]
    turned = mask.turned(body.angle)
    columns = np.flatnonzero(turned.solid.any(axis=0))
    left = math.floor(body.position[0] - turned.origin[0] + 0.5)
    assert 0.05 < abs(body.angle) < abs(spin) / 60, "stopped on its way"
    assert (row["min_x"], row["max_x"]) == (left + columns[0], left + columns[-1] + 1)
