"""Random worlds of gears, pulleys, motors and limits stay finite, at speeds that their motors and gravity can cause."""

import math

import numpy as np
import pytest

from physics import Circle, Drive, Effects, Filter, Gear, Polygon, Prismatic, Pulley, Revolute, World

EFFECTS = Effects.rigid_bodies().with_(joints=True, sleeping=False)
RATIO = 10.0  # greatest ratio of a gear, either way
REACH = 60.0  # [px] greatest distance of a point of a body from its pin


def random_world(seed):
    """Return a random world: two to six bodies on hinges and sliders, one to three gears, in half of them a pulley."""
    rng = np.random.default_rng(seed)
    world = World(EFFECTS, substeps=4 if seed % 2 else "auto")
    bodies, joints = [], []
    for _ in range(int(rng.integers(2, 7))):
        x, y, angle = rng.uniform(-200, 200), rng.uniform(-200, 200), rng.uniform(0.0, 2.0 * math.pi)
        shape = Circle(rng.uniform(5, 40)) if rng.random() < 0.5 else Polygon.box(*rng.uniform(5, 60, 2))
        body = world.add_body(shape, position=(x, y), mass=10.0 ** rng.uniform(-1, 3), filter=Filter(1, 0))
        turns = rng.random() < 0.6
        unit, more = 1.0 if turns else 20.0, {}
        if rng.random() < 0.5:
            more["motor"] = Drive(rng.uniform(-20, 20) * unit, max=10.0 ** rng.uniform(2, 9))
        if rng.random() < 0.3:
            more["limits"] = (-rng.uniform(0, 2) * unit, rng.uniform(0, 2) * unit)
        base = bodies[int(rng.integers(len(bodies)))] if bodies and rng.random() < 0.4 else None
        if turns:
            joints.append(world.add_joint(Revolute(base, body, at=(x + 10 * rng.normal(), y), **more)))
        else:
            axis = math.cos(angle), math.sin(angle)
            joints.append(world.add_joint(Prismatic(base, body, at=(x, y), axis=axis, **more)))
        bodies.append(body)
    for _ in range(int(rng.integers(1, 4))):
        a, b = rng.choice(len(joints), 2, replace=False)
        ratio = rng.choice([-1, 1]) * RATIO ** rng.uniform(-1, 1)
        world.add_joint(Gear(joints[a], joints[b], ratio=float(ratio)))
    if rng.random() < 0.5:
        a, b = (bodies[k] for k in rng.choice(len(bodies), 2, replace=False))
        over = [(body.position.x, body.position.y - 100.0) for body in (a, b)]
        world.add_joint(Pulley(a, b, a.position, b.position, *over, ratio=RATIO ** rng.uniform(-0.7, 0.7)))
    return world


@pytest.mark.parametrize("seed", range(40))
def test_a_random_gearbox_runs_no_faster_than_its_motors(seed):
    world = random_world(seed)
    fall = 9.8 * 32.0 * 6.0  # [px/s] of a free fall of 6 s
    for _ in range(360):
        world.step()
        b = world.bodies
        speeds = np.hypot(b["vx"], b["vy"]), np.abs(b["angular_velocity"]) * REACH
        assert np.isfinite(speeds).all()
        assert np.max(speeds) < 10.0 * RATIO * (20.0 * REACH + fall)
