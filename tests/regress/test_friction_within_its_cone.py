"""The friction impulse is at most the friction coefficient times the normal impulse, at every contact in every step."""

import numpy as np
import pytest

from physics import JIT, Capsule, Circle, Effects, Material, Polygon, World


@pytest.mark.parametrize("solver", ["projection", "sequential_impulse", "soft_step"])
@pytest.mark.parametrize("seed", range(4))
def test_random_piles(solver, seed):
    effects = Effects.rigid_bodies().with_(stacking=solver != "projection", sleeping=False, conveyor=True)
    world, rng = World(effects, solver=solver), np.random.default_rng(seed)
    world.add_body(Polygon.box(900, 20), position=(0, 10), kind="static", material=Material(friction=0.9))
    frictions = {}
    for k in range(30 if JIT else 10):
        shape = (Polygon.box(16, 12), Circle(7.0), Capsule((-5, 0), (5, 0), 4.0))[k % 3]
        own = float(rng.uniform(0.0, 1.2))
        body = world.add_body(
            shape,
            position=(rng.uniform(-50, 50), -20 - 12 * k),
            velocity=tuple(rng.uniform(-300, 300, 2)),
            angular_velocity=float(rng.uniform(-9, 9)),
            material=Material(friction=own, restitution=float(rng.uniform(0, 0.8)), surface_speed=30.0 * (k % 2)),
        )
        frictions[body.id] = own
    frictions[0] = 0.9
    slid = 0
    for _ in range(150 if JIT else 110):
        world.step()
        for contact in world.contacts:
            mu = (frictions[int(contact["body_a"])] * frictions[int(contact["body_b"])]) ** 0.5
            limit = mu * contact["normal_impulse"]
            assert abs(contact["tangent_impulse"]) <= limit * (1.0 + 1e-12) + 1e-12
            slid += abs(contact["tangent_impulse"]) > 0.999 * limit > 0.0
    assert slid > (20 if JIT else 3)
