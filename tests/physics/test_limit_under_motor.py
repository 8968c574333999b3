"""A limit of a joint holds against a motor of any strength, in both tiers and solvers."""

import pytest

from physics import Circle, Distance, Drive, Effects, Polygon, Prismatic, Revolute, World

EFFECTS = Effects(response=True, rotation=True, friction=True, stacking=True, joints=True)
SPEED = 40.0  # [px/s] of the motors


def excess(kind, strength, tier, solver, substeps):
    """Return by how much a joint passes its limit in 2 s, as a share of the limit."""
    world = World(EFFECTS, solver=solver, substeps=substeps, gravity=(0, 0))
    world.joint_solver = tier
    if kind == "prismatic":
        body = world.add_body(Circle(10))
        world.add_joint(Prismatic(None, body, at=(0, 0), axis=(1, 0), limits=(-30, 30), motor=Drive(SPEED, strength)))
        limit, coordinate = 30.0, lambda: body.position.x
    elif kind == "revolute":
        body = world.add_body(Polygon.box(40, 8, (20, 0)))
        world.add_joint(Revolute(None, body, at=(0, 0), limits=(-0.8, 0.8), motor=Drive(SPEED / 20, 400.0 * strength)))
        limit, coordinate = 0.8, lambda: body.angle
    else:
        body = world.add_body(Circle(10), position=(60, 0))
        world.add_joint(Distance(None, body, at_a=(0, 0), at_b=(60, 0), limits=(20, 90), motor=Drive(SPEED, strength)))
        limit, coordinate = 90.0, lambda: abs(body.position.x)
    greatest = 0.0
    for _ in range(120):
        world.step()
        greatest = max(greatest, coordinate())
    assert greatest > 0.9 * limit, "the motor reaches the limit"
    return greatest / limit - 1.0


@pytest.mark.parametrize("tier", ["iterative", "direct", "auto"])
@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
@pytest.mark.parametrize("substeps", ["auto", 4])
@pytest.mark.parametrize("strength", [1e5, 1e6, 1e7, 1e9, 1e12])
@pytest.mark.parametrize("kind", ["prismatic", "revolute", "distance"])
def test_no_motor_passes_a_limit(kind, strength, tier, solver, substeps):
    assert excess(kind, strength, tier, solver, substeps) < 0.01
