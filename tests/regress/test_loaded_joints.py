"""Joints of the iterative tier under great loads: they stay springs, nets do not tear, and pins have one result."""

import numpy as np
import pytest

from physics import (
    JIT,
    Circle,
    Distance,
    Drive,
    Effects,
    Filter,
    Gear,
    Polygon,
    Prismatic,
    Revolute,
    Weld,
    Wheel,
    World,
)
from physics.settings import LOAD_SUBSTEPS
from tests.bench.joints import net

EFFECTS = Effects.rigid_bodies().with_(joints=True, sleeping=False)
AIR = EFFECTS.with_(gravity=False)
KINDS = {
    "pin": lambda body: Revolute(None, body, at=(0.0, 0.0)),
    "pin with limits": lambda body: Revolute(None, body, at=(0.0, 0.0), limits=(-1.0, 1.0)),
    "weld": lambda body: Weld(None, body, at=(0.0, 0.0)),
    "slider": lambda body: Prismatic(None, body, at=(0.0, 0.0), axis=(1.0, 0.0)),
    "wheel": lambda body: Wheel(None, body, at=(0.0, 0.0), axis=(1.0, 0.0)),
    "slider at its limit": lambda body: Prismatic(None, body, at=(0.0, 0.0), axis=(0.0, 1.0), limits=(-50.0, 0.0)),
    "rod": lambda body: Distance(None, body, at_a=(0.0, -40.0), at_b=(0.0, 0.0), length=40.0),
    "rope": lambda body: Distance(None, body, at_a=(0.0, -40.0), at_b=(0.0, 0.0), limits=(0.0, 40.0)),
}


def gap_under(kind, acceleration, substeps, solver, seconds):
    """Return the gap [px] of a joint after each second, while a force pulls its body down.

    acceleration [px/s2]: force over the mass of the body.
    """
    world = World(AIR, substeps=substeps, solver=solver)
    world.joint_solver = "iterative"
    body = world.add_body(Circle(6.0))
    joint = world.add_joint(KINDS[kind](body))
    gaps = []
    for step in range(60 * seconds):
        body.apply_force((0.0, acceleration * body.mass))
        world.step()
        if step % 60 == 59:
            gaps.append(joint.separation)
    return gaps


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
@pytest.mark.parametrize("substeps", [4, 16])
@pytest.mark.parametrize("acceleration", [1e5, 3e5, 1e6, 3e6])
@pytest.mark.parametrize("kind", KINDS)
def test_a_joint_under_load_stays_a_spring(kind, acceleration, substeps, solver):
    gaps = gap_under(kind, acceleration, substeps, solver, 4)
    weak = gap_under(kind, 1e4, substeps, solver, 4)[-1]
    assert gaps[3] - gaps[2] <= 0.75 * (gaps[2] - gaps[1]) + 1e-3, gaps  # it stops
    assert gaps[-1] <= 1.05 * weak * acceleration / 1e4 + 1e-3, (gaps, weak)  # and its stiffness is the same


@pytest.mark.slow
@pytest.mark.skipif(not JIT, reason="takes minutes without numba")
@pytest.mark.parametrize("substeps", [4, 16, "auto"])
@pytest.mark.parametrize("wide", [20, 30, 40, 50])
def test_a_net_does_not_tear(wide, substeps):
    world = net(wide, substeps=substeps)
    gaps = []
    for _ in range(480):
        world.step()
        gaps.append(float(world.joints["separation"].max()))
    limit = {4: 40.0, 16: 3.0, "auto": 0.25}[substeps]
    assert max(gaps) < limit and max(gaps[240:]) <= max(gaps[:240])
    assert world.bodies["substeps"].max() <= (LOAD_SUBSTEPS if substeps == "auto" else 0)


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
@pytest.mark.parametrize("substeps", [1, 4, 16, "auto"])
@pytest.mark.parametrize("seed", range(10))
def test_plain_pins_move_like_pins_with_limits_that_are_never_reached(seed, substeps, solver):
    def poses(limits):
        random = np.random.default_rng(seed)
        world = World(EFFECTS, substeps=substeps, solver=solver)
        world.joint_solver = "iterative"
        bodies = [
            world.add_body(
                Polygon.box(*random.uniform(4.0, 20.0, 2)),
                position=random.uniform(0.0, 120.0, 2),
                velocity=random.uniform(-200.0, 200.0, 2),
                angular_velocity=random.uniform(-5.0, 5.0),
                filter=Filter(1, 0),
            )
            for _ in range(8)
        ]
        for _ in range(12):
            a, b = random.choice(8, 2, replace=False)
            at = random.uniform(0.0, 120.0, 2)
            world.add_joint(Revolute(bodies[a], bodies[b], at=at, **limits))
        world.add_joint(Revolute(None, bodies[0], at=bodies[0].position, **limits))
        for _ in range(40):
            world.step()
        return world.bodies[["x", "y", "angle", "vx", "vy", "angular_velocity"]].tolist()

    assert poses({}) == poses({"limits": (-1e9, 1e9)})


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
@pytest.mark.parametrize("substeps", [4, 16, "auto"])
@pytest.mark.parametrize("ratio", [-2.0, -1.0, 0.5, 1.0, 3.0])
def test_gears_of_plain_pins_keep_their_ratio(ratio, substeps, solver):
    world = World(EFFECTS, substeps=substeps, solver=solver)
    world.joint_solver = "iterative"
    wheels = [world.add_body(Circle(radius), position=at) for radius, at in ((12.0, (0, 0)), (20.0, (40, 0)))]
    driven = world.add_joint(Revolute(None, wheels[0], at=(0, 0), motor=Drive(4.0, max=1e9)))
    follower = world.add_joint(Revolute(None, wheels[1], at=(40, 0)))
    gear = world.add_joint(Gear(driven, follower, ratio=ratio))
    for _ in range(300):
        world.step()
    assert abs(driven.angle) > 10.0
    assert driven.angle + ratio * follower.angle == pytest.approx(0.0, abs=1e-2) and gear.separation < 1e-2


@pytest.mark.parametrize("tier", ["iterative", "direct", "auto"])
@pytest.mark.parametrize("links", [1, 2, 3, 6, 12])
def test_a_joint_is_solved_once_exactly_or_as_a_pin(links, tier):
    """Links between two rings of bodies close loops, whose joints are exact beside the tree."""
    world = World(EFFECTS)
    world.joint_solver = tier
    rows = [[world.add_body(Circle(4.0), position=(20.0 * k, 20.0 * j)) for k in range(links + 1)] for j in (0, 1)]
    world.add_joint(Revolute(None, rows[0][0], at=(0.0, 0.0)))
    for row in rows:
        for a, b in zip(row, row[1:], strict=False):
            world.add_joint(Revolute(a, b, at=a.position))
    for a, b in zip(*rows, strict=True):
        world.add_joint(Revolute(a, b, at=a.position))
    for _ in range(5):
        world.step()
    assert (world.joints["direct"] != world.joints["is_pin"]).all()
    assert world.joints["is_pin"].any() == (tier == "iterative")
