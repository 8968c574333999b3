"""Constraints solved side by side in SIMD lanes: the motion of a pile does not depend on the lanes of its contacts."""

import numpy as np
import pytest

from physics import Effects, Material, Polygon, World

COLUMNS, HIGH, APART = 24, 3, 128.0  # three blocks of eight lanes; [px] a power of two, so that places are as exact
EFFECTS = Effects(response=True, gravity=True, rotation=True, friction=True, restitution=True, stacking=True)


@pytest.mark.parametrize("solver", ("soft_step", "sequential_impulse"))
@pytest.mark.parametrize("lean", (0.0, 0.3, 0.7))
def test_every_lane_does_what_the_first_does(solver, lean):
    """Equal columns of boxes on tilted ground move equally in every lane, whether they rest, slide or tip."""
    world = World(EFFECTS, solver=solver, gravity=(320.0 * np.sin(lean), 320.0 * np.cos(lean)), substeps=4)
    rough = Material(friction=0.5, restitution=0.3)
    for column in range(COLUMNS):
        x = APART * column
        world.add_body(Polygon.box(APART / 2, 16.0), position=(x, 8.0), kind="static", material=rough)
        for row in range(HIGH):
            place = x + 1.5 * row, -8.5 - 17.0 * row  # askew, and a little apart: they land
            world.add_body(Polygon.box(16.0, 16.0), position=place, material=rough, angular_velocity=0.2 * row)
    pushed = 0.0
    for step in range(40):
        world.step()
        rows = world.bodies.reshape(COLUMNS, HIGH + 1)
        for name in ("y", "vx", "vy", "angle", "angular_velocity"):
            assert np.allclose(rows[name], rows[name][0], rtol=1e-6, atol=1e-6), f"{name} in step {step}"
        places = rows["x"] - rows["x"][:, :1]
        assert np.allclose(places, places[0], rtol=1e-6, atol=1e-6), f"x in step {step}"
        if len(world.contacts):
            pushed = max(pushed, float(np.abs(world.contacts["tangent_impulse"]).max()))
    assert pushed > 0.0, "friction had something to do"
