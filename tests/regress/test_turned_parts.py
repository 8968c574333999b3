"""A rotating body of several shapes, stopped at its time of impact, has its mask rasterised at the angle reached."""

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
    half = 9.5 * abs(math.cos(body.angle)) + 1.5 * abs(math.sin(body.angle))
    assert 0.04 < abs(body.angle) < abs(spin) / 60, "stopped on its way"
    assert (row["min_x"], row["max_x"]) == pytest.approx((body.position[0] - half, body.position[0] + half), abs=1e-9)
    turned = mask.turned(body.angle)  # what is asked of its pixels is drawn at that angle
    left, top = (math.floor(body.position[k] - turned.origin[k] + 0.5) for k in (0, 1))
    for y, x in np.argwhere(turned.solid)[::5].tolist():
        assert body in world.query_point((left + x + 0.5, top + y + 0.5))
