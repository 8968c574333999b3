"""Several joints of one pair of bodies that contradict one another neither throw the bodies nor part them by far.

A slider whose limit the pins of the same two bodies do not permit left its pins up to 1e7 px apart in the direct tier:
the equations are almost singular, and a small contradiction caused a huge impulse. Found by tests/fuzz.
"""

import pytest

from game.invariants.bodies import Bodies
from physics import Effects, Filter, Polygon, Revolute, Wheel, World

EFFECTS = Effects.rigid_bodies().with_(joints=True, sleeping=False)


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
@pytest.mark.parametrize("substeps", ["auto", 4, 8, 16, 32])
@pytest.mark.parametrize("limit", [1e-4, 1e-2, 0.5, 5.0])
@pytest.mark.parametrize("order", ["slider, pin", "pin, slider", "slider, pin, pin", "pin, pin, slider"])
def test_pins_and_a_limit_that_they_do_not_permit(order, limit, substeps, solver):
    world = World(EFFECTS, substeps=substeps, solver=solver, gravity=(0, 0))
    apart = Filter(1, 0)
    a = world.add_body(Polygon.box(60, 20), mass=231.0, filter=apart)
    b = world.add_body(Polygon.box(20, 50), position=(-100, -30), mass=66.0, velocity=(-136, 76), filter=apart)
    b.angular_velocity = 3.0
    pins = [(0.0, -79.0), (30.0, 60.0)]
    for kind in order.split(", "):
        if kind == "pin":
            world.add_joint(Revolute(a, b, at=pins.pop(0)))
        else:
            world.add_joint(Wheel(b, a, at=(-130, -120), axis=(2.3, -0.52), limits=(limit, None), spring=None))
    before = Bodies(world).kinetic
    for _ in range(40):
        world.step()
        assert world.joints["separation"].max() < 12.0 + 2.0 * limit
        assert Bodies(world).kinetic < 1.05 * before
