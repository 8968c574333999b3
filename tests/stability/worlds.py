"""Worlds used by the tests of several sections: a falling heap, also far away, mirrored and with another density."""

import numpy as np

from physics import Capsule, Circle, Material, Polygon
from tests.stability.invariants import Watch
from tests.stability.piles import floor, metres


def heap(x=0.0, y=0.0, mirror=1.0, density=1.0, order=None, solver="soft_step", steps=60, round_only=False):
    """Drop a heap of boxes, balls and capsules. Return an array (bodies, 5) with x, y, angle, vx and vy at the end.

    The positions are relative to (x, y). A mirrored result is mirrored back. The rows have the same order for every
    `order`. mirror: -1 mirrors the scene in x. order: order of creation, a permutation of the rows (None: the order of
    the rows). round_only: True for discs only.
    """
    world = metres(solver, gravity=(0, 10))
    floor(world, x=x, y=y)
    rng = np.random.default_rng(8)
    plans = []
    for k in range(16):
        at, angle, velocity = rng.uniform((-2, -7), (2, -1)), rng.uniform(-1, 1), rng.uniform(-1, 1, 2)
        plans.append((k, at, angle, velocity))
    ids = {}
    for k, at, angle, velocity in plans if order is None else [plans[j] for j in order]:
        shape = (
            Circle(0.2 + 0.01 * k)
            if round_only
            else (Polygon.box(0.6, 0.4), Circle(0.3), Capsule((-0.2, 0), (0.2, 0), 0.2))[k % 3]
        )
        ids[k] = world.add_body(
            shape,
            position=(x + mirror * at[0], y + at[1]),
            angle=mirror * angle,
            velocity=(mirror * velocity[0], velocity[1]),
            material=Material(density=density),
        ).id
    Watch(world).step(steps)
    rows = world.bodies[world.rows([ids[k] for k in range(16)])]
    return np.column_stack(
        [mirror * (rows["x"] - x), rows["y"] - y, mirror * rows["angle"], mirror * rows["vx"], rows["vy"]]
    )
