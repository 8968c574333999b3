"""A small body pushed by a moving inner corner of a room stays inside both walls.

Before the fix, only the wall that met it first was examined. This wall hid the other one, even after it had pushed far
enough, and the body came out through the other.
"""

import math

import numpy as np
import pytest

from physics import JIT, Chain, Effects, Polygon, World

HALF_X, HALF_Y = 48.0, 40.0
CORNERS = [(-HALF_X, HALF_Y), (HALF_X, HALF_Y), (HALF_X, -HALF_Y), (-HALF_X, -HALF_Y)]
TRIALS = 1500 if JIT else 60
STEPS = 3


def gets_out(solver, velocity, turn, place, angle, beside, spin):
    """Return whether a box gets out of a room that moves and rotates.

    place: position of the box relative to the corner [px]. beside: its velocity relative to that of the room [px/s].
    """
    effects = Effects(response=True, rotation=True, friction=True, stacking=True, continuous=True)
    world = World(effects, solver=solver, substeps=1)
    room = world.add_body(Chain(CORNERS, loop=True), kind="kinematic", velocity=velocity, angular_velocity=turn)
    box = world.add_body(
        Polygon.box(6, 3),
        position=(HALF_X - place[0], -HALF_Y + place[1]),
        angle=angle,
        velocity=(velocity[0] + beside[0], velocity[1] + beside[1]),
        angular_velocity=spin,
    )
    for _ in range(STEPS):
        world.step()
        cosine, sine = math.cos(room.angle), math.sin(room.angle)
        x, y = box.center.x - room.position.x, box.center.y - room.position.y
        u, v = cosine * x + sine * y, cosine * y - sine * x
        if abs(u) > HALF_X or abs(v) > HALF_Y:
            return True
    return False


@pytest.mark.parametrize(
    "solver, case",
    [
        ("soft_step", ((-498.8, -299.0), 7.74, (1.3, 1.1), 5.14, (165.7, -65.2), -2.53)),
        ("soft_step", ((-384.5, -417.2), 7.41, (1.0, 1.8), 5.67, (159.9, 267.8), -13.45)),
        ("soft_step", ((-464.7, 20.8), 7.02, (2.8, 3.0), 3.57, (200.0, 99.5), 0.94)),
        ("sequential_impulse", ((-464.7, 20.8), 7.02, (2.8, 3.0), 3.57, (200.0, 99.5), 0.94)),
    ],
)
def test_those_that_were_found(solver, case):
    assert not gets_out(solver, *case)


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
def test_none_of_many_gets_out(solver):
    rng = np.random.default_rng(5)
    for _ in range(TRIALS):
        case = (
            tuple(rng.uniform(-500.0, 500.0, 2)),
            float(rng.uniform(-8.0, 8.0)),
            tuple(rng.uniform(0.6, 3.0, 2)),
            float(rng.uniform(0.0, math.tau)),
            tuple(rng.uniform(-300.0, 300.0, 2)),
            float(rng.uniform(-20.0, 20.0)),
        )
        assert not gets_out(solver, *case), case
