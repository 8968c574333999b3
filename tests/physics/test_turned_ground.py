"""A slope equals level ground under tilted gravity, although the friction force has two
components only on the slope.
"""

from math import cos, sin

import pytest

from physics import Circle, Effects, Material, Polygon, World

EFFECTS = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True)
STEPS = 40


def slid(solver, shape, lean, turned):
    """Return (distance along the ground [px], rotation [rad]) of a shape after STEPS steps.

    lean: slope angle [rad]. turned: True tilts the ground, False tilts gravity.
    """
    gravity = (0.0, 320.0) if turned else (320.0 * sin(lean), 320.0 * cos(lean))
    world = World(EFFECTS, solver=solver, gravity=gravity, substeps=4)
    angle = lean if turned else 0.0
    along, up = (cos(angle), sin(angle)), (sin(angle), -cos(angle))
    rough = Material(friction=0.3)
    ground = (-20.0 * up[0], -20.0 * up[1])
    world.add_body(Polygon.box(2000.0, 40.0), position=ground, angle=angle, kind="static", material=rough)
    place = (8.0 * up[0], 8.0 * up[1])
    body = world.add_body(shape, position=place, angle=angle, material=rough)
    for _ in range(STEPS):
        world.step()
    moved = body.position.x - place[0], body.position.y - place[1]
    return moved[0] * along[0] + moved[1] * along[1], body.angle - angle


@pytest.mark.parametrize("solver", ("soft_step", "sequential_impulse"))
@pytest.mark.parametrize("shape", (Polygon.box(16.0, 16.0), Circle(8.0)), ids=("box", "disc"))
@pytest.mark.parametrize("lean", (0.5, 0.7, -0.6))
def test_a_slope_is_level_ground_under_a_gravity_that_leans(solver, shape, lean):
    expected, turned = slid(solver, shape, lean, False)
    found = slid(solver, shape, lean, True)
    assert abs(expected) > 10.0 and found[0] == pytest.approx(expected, rel=1e-6)
    assert found[1] == pytest.approx(turned, rel=1e-6, abs=1e-6)
