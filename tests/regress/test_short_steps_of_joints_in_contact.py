"""A very short step between others does not throw joined bodies in contact in the next step.

The tension in a joint is its impulse over the length of a substep. After a step of a microsecond, the impulse of a
touch counted as a huge tension, and raised the inertia of welded boxes: a turning box that met them was moved 32 px in
the next step, without a velocity. Found by tests/fuzz.
"""

import math

import numpy as np
import pytest

from physics import Bounds, Effects, Polygon, Weld, World, hull

EFFECTS = Effects(narrowphase=False, response=True, rotation=True, friction=True, stacking=True, joints=True)


def paths(short, substeps, solver):
    """Return the greatest path of a body [px] in each of five steps, in which a turning body meets welded boxes.

    short [s]: length of a step before these five; None: no such step.
    """
    world = World(EFFECTS, substeps=substeps, solver=solver)
    boxes = world.add_bodies(Polygon.box(10, 10), [(40, -10), (60, 0), (70, 0), (90, 0)])
    world.add_joints(Weld, boxes[:-1], boxes[1:], at=[(50, 0), (64.4, 0), (80, 0)])
    corner = Bounds(hull([(0, 0), (4, 22), (-21.4, 0)])), Bounds(Polygon([(20, 14.3), (25, -8), (3, 5)], 7.0))
    world.add_body(*corner, position=(54, -57), angle=math.pi / 2, angular_velocity=-17.0, fixed_rotation=True)
    found = []
    for dt in (*(None,) * 10, *([short] if short else []), *(None,) * 5):
        before = np.stack([world.bodies["x"], world.bodies["y"]])
        world.step(dt)
        after = np.stack([world.bodies["x"], world.bodies["y"]])
        found.append(float(np.hypot(*(after - before)).max()))
    return found[-5:]


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
@pytest.mark.parametrize("substeps", ["auto", 4])
@pytest.mark.parametrize("short", [1e-7, 1e-6, 1e-5, 1e-4, 1e-3])
def test_a_short_step_throws_nothing(short, substeps, solver):
    assert max(paths(short, substeps, solver)) < 1.2 * max(paths(None, substeps, solver)) + 0.1
