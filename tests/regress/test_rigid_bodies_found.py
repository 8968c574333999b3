"""Regression tests of the rigid-body core, each with the smallest scene that showed the defect."""

import numpy as np

from physics import Effects, Material, Polygon, World


def test_snapshot_of_another_kind_of_solver_is_stepped_with_unit_normals():
    """A snapshot of projection steps under soft_step with normals of length 1.

    Contacts of projection have no cache entries; taken for recycled manifolds they had normals of length 0.
    """
    world = World(Effects.rigid_bodies(), solver="projection")
    world.add_body(Polygon.box(200, 20), position=(0, 10), kind="static")
    world.add_body(Polygon.box(20, 20), position=(0, -9.9))
    world.step()
    taken = world.snapshot()
    world.solver = "soft_step"
    world.restore(taken)
    for _ in range(5):
        world.step()
        assert len(world.contacts)
        assert np.allclose(np.hypot(world.contacts["normal_x"], world.contacts["normal_y"]), 1.0)


def test_a_snapshot_of_sleepers_brings_its_solver_and_wakes_under_another():
    world = World(Effects.rigid_bodies())
    ground = world.add_body(Polygon.box(200, 20), position=(0, 10), kind="static")
    box = world.add_body(Polygon.box(20, 20), position=(0, -10))
    for _ in range(60):
        world.step()
    assert not box.awake
    taken = world.snapshot()
    world.solver = "projection"
    world.restore(taken)
    assert world.solver == "soft_step" and not box.awake
    world.solver = "projection"
    assert box.awake
    world.remove_body(ground)
    for _ in range(30):
        world.step()
    assert box.position[1] > 0.0


def test_belt_carries_without_a_stacking_solver_too():
    """A conveyor surface carries a box under a solver without stacking, too."""
    for conveyor in (True, False):
        world = World(Effects(response=True, gravity=True, friction=True, conveyor=conveyor))
        world.add_body(Polygon.box(2000, 20), position=(0, 10), kind="static", material=Material(surface_speed=60.0))
        box = world.add_body(Polygon.box(20, 20), position=(-300, -10))
        for _ in range(120):
            world.step()
        assert abs(box.velocity[0] - 60.0 * conveyor) < 0.6
