"""A sprite of several parts on a flat face touches it at the same points as the polygon of its outline."""

import math

import numpy as np
import pytest

from physics import PixelMask, Polygon, World

# Sprites with a flat base of 14 px that is a side of one part, and its corners corners of others.
FRAME = np.ones((12, 14), bool)
FRAME[3:9, 4:10] = False
ARCH = np.ones((12, 14), bool)
ARCH[:8, 5:9] = False
HOLES = np.ones((15, 14), bool)
HOLES[:6, 3:6] = HOLES[9:12, 3:9] = False
SPRITES = {"frame": FRAME, "arch": ARCH, "holes": HOLES}
EASE = 0.15  # [px]


def touched(shape, width, height, tilt, depth, turn):
    """Return the positions along the face at which a shape touches it, sorted and without duplicates.

    tilt: angle of the shape's base against the face [rad]. depth: depth of its lowest corner in the face [px]. turn:
    angle of the face [rad].
    """
    world = World(gravity=(0, 0))
    face, lift = world.add_body(Polygon.box(400, 40), kind="static", angle=turn), abs(math.sin(tilt)) * width / 2
    up = 20 + 0.5 * height * math.cos(tilt) + lift - depth
    body = world.add_body(shape, position=(up * math.sin(turn), -up * math.cos(turn)), angle=turn + tilt)
    world.step()
    assert body.contacts["body_a"].tolist() == [face.id] * len(body.contacts)
    rows = body.contacts[body.contacts["separation"] <= 0.4]
    return sorted({round(float(x * math.cos(turn) + y * math.sin(turn)), 1) for x, y in rows[["point_x", "point_y"]]})


@pytest.mark.parametrize("name", SPRITES)
@pytest.mark.parametrize("turn", [0.0, 0.7, -2.1])
@pytest.mark.parametrize("depth", [0.0, 0.2, 0.5])
def test_both_corners_of_a_tilted_base_are_touched(name, depth, turn):
    solid = SPRITES[name]
    height, width = solid.shape
    for tilt in np.linspace(-0.06, 0.06, 13).tolist():
        expected = touched(Polygon.box(width, height), width, height, tilt, depth, turn)
        found = touched(PixelMask.from_array(solid, snap=False), width, height, tilt, depth, turn)
        for place in expected:
            assert min((abs(place - x) for x in found), default=math.inf) <= EASE, (tilt, expected, found)
