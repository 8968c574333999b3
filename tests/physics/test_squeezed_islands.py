"""Squeezed islands are detected wherever overlapping faces of bodies with infinite mass leave no room."""

import math

import numpy as np
import pytest

from physics import Circle, Effects, Polygon, World
from physics.solver.energy import FACING, OPPOSITE
from physics.step import staged_step

EFFECTS = Effects.rigid_bodies()


def is_squeezed(world, moving):
    """Return whether the disc is squeezed, found by a test of all pairs of its contact normals.

    Two opposite contacts that are both deeper than the slop squeeze it. A contact with a fast body squeezes it if any
    other contact is opposite. moving: ids of the moving walls.
    """
    rows, limits, disc = world.contact_rows, world.tolerances.limits, world.bodies["id"][-1]
    rows = rows[(rows["body_a"] == disc) | (rows["body_b"] == disc)]
    overlaps = -rows["separation_1"]
    sign = np.where(rows["body_a"] == disc, -1.0, 1.0)
    normals = np.stack([sign * rows["normal_x"], sign * rows["normal_y"]], axis=1)
    pairs = normals @ normals.T
    deep = overlaps > limits.slop
    caught = (pairs < FACING)[np.ix_(deep, deep)].any() and overlaps.max() > limits.deep
    fast = np.isin(np.where(sign < 0.0, rows["body_b"], rows["body_a"]), moving)
    pressed = (pairs < OPPOSITE)[fast & (overlaps > 0.0)][:, overlaps > 0.0].any() and overlaps.max() > limits.deep
    return bool(caught or pressed)


@pytest.mark.parametrize("degrees", [0.0, 15.0, 30.0, 45.0, 59.0, 59.9, 60.1, 61.0, 75.0, 90.0, 119.0, 121.0, 150.0])
@pytest.mark.parametrize("share", [0.02, 0.3])
@pytest.mark.parametrize("speed", [0.0, 120.0])
@pytest.mark.parametrize("order", [1, -1])
@pytest.mark.parametrize("substeps", [4, "auto"])
def test_faces_leave_room_or_not_as_all_their_pairs_say(degrees, share, speed, order, substeps):
    """A disc between two walls is reported as squeezed exactly if a test of all pairs of its contacts says so.

    share: overlap of each wall with the disc, divided by the disc's radius. speed: speed of the second wall [px/s].
    """
    world, radius, moving = World(EFFECTS, substeps=substeps), 16.0, []
    for side in (-0.5, 0.5):
        turn = order * math.radians(degrees) * side
        far = 100.0 + (1.0 - share) * radius
        wall = world.add_body(
            Polygon.box(200, 200),
            position=(-far * math.sin(turn), far * math.cos(turn)),
            angle=turn,
            kind="kinematic" if speed and side > 0.0 else "static",
            velocity=(speed * math.sin(turn), -speed * math.cos(turn)) if side > 0.0 else (0.0, 0.0),
        )
        moving += [wall.id] if speed and side > 0.0 else []
    world.add_body(Circle(radius))
    expected = found = None
    for stage in staged_step(world):
        if stage is not None and stage.stage == "narrow_phase":
            expected = is_squeezed(world, moving)
        if stage is not None and stage.stage == "soft_step":
            found = bool(world.workspace.contacts.selection.plan.squeezed[0])
    assert found == expected
