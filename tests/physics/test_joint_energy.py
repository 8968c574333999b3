"""Joints without friction keep the energy of a swing, and close behind arms that rotate fast."""

import math

import numpy as np
import pytest

from physics import Effects, Filter, Polygon, Revolute, World

EFFECTS = Effects.rigid_bodies().with_(joints=True, sleeping=False)
GRAVITY = 9.8


def rod(world, start, end, mass=1.0):
    (ax, ay), (bx, by) = start, end
    shape = Polygon.box(math.dist(start, end), 0.1)
    place, angle = ((ax + bx) / 2, (ay + by) / 2), math.atan2(by - ay, bx - ax)
    return world.add_body(shape, position=place, angle=angle, mass=mass, filter=Filter(1, 0))


def chain(links, angle, ratio, substeps):
    """A chain of rods of 1 m that is let go straight; its last rod is `ratio` times as heavy."""
    world = World(EFFECTS, gravity=(0.0, GRAVITY), pixels_per_meter=1, substeps=substeps)
    before = None
    for k in range(links):
        at, to = ((n * math.cos(angle), n * math.sin(angle)) for n in (k, k + 1))
        link = rod(world, at, to, ratio if k == links - 1 else 1.0)
        world.add_joint(Revolute(before, link, at=at))
        before = link
    return world


def energy(world):
    b = world.bodies
    moving = 0.5 * (b["mass"] * (b["vx"] ** 2 + b["vy"] ** 2) + b["inertia"] * b["angular_velocity"] ** 2)
    return float((moving - b["mass"] * GRAVITY * b["center_y"]).sum())


@pytest.mark.parametrize("substeps", [4, 8])
@pytest.mark.parametrize("ratio", [0.2, 1.0, 5.0])
@pytest.mark.parametrize("angle", np.linspace(0.0, 1.0, 4))
def test_a_double_pendulum_keeps_its_energy_and_its_pins(angle, ratio, substeps):
    world = chain(2, angle, ratio, substeps)
    start = energy(world)
    fall = 2.0 * GRAVITY * float((world.bodies["mass"] * world.bodies["center_x"]).sum()) / math.cos(angle)
    off, gap = 0.0, 0.0
    for _ in range(15 * 60):
        world.step()
        off = max(off, abs(energy(world) - start) / fall)
        gap = max(gap, float(world.joints["separation"].max()))
    assert off < 0.06 / substeps and gap < 2e-3 / substeps
