"""Bodies that land askew with continuous collision: no sweep holds a body in place while it keeps its speed.

A body that turns about the point at which it touches moves into the ground if its path is taken without rotation, or
as a straight line between two poses. Such a body must turn over and fall flat, and no centre of mass passes the ground.
"""

import itertools
import math

import numpy as np
import pytest

from physics import JIT, Capsule, Chain, Circle, Effects, PixelMask, Polygon, Segment, TileGrid, World

PUSHED = Effects(response=True, gravity=True, rotation=True, friction=True, continuous=True)
WORLDS = {
    "default": (Effects.rigid_bodies(), {}),
    "four substeps": (Effects.rigid_bodies(), {"substeps": 4}),
    "sequential impulse": (Effects.rigid_bodies(), {"solver": "sequential_impulse"}),
    "projection": (PUSHED, {"solver": "projection"}),
}
GROUNDS = {
    "box": (Polygon.box(2000, 40, (0, 20)), (0, 0)),
    "chain": (Chain([(-1000, 0), (0, 0), (1000, 0)]), (0, 0)),
    "tiles": (TileGrid(np.ones((3, 100), bool), 20), (-1000, 0)),
    "segment": (Segment((-1000, 0), (1000, 0)), (0, 0)),
}
SHAPES = {
    "square": [Polygon.box(20, 20)],
    "brick": [Polygon.box(40, 10)],
    "bar": [Polygon.box(60, 6)],
    "ruler": [Polygon.box(40, 4)],
    "capsule": [Capsule((-15, 0), (15, 0), 5)],
    "mask": [PixelMask(np.ones((6, 40), bool))],
    "two discs": [Circle(5, (-15, 0)), Circle(5, (15, 0))],
}
TILTS = np.linspace(0.05, 1.5, 8)
DROPS = (20, 60, 300, 2000)  # [px]
HELD = 5  # most steps in a row in which a body that keeps its speed may stand still
STILL = 0.02  # share of the motion at its velocity below which a body stands still
SLOW = 5.0  # [px/s] of the fastest point: slower bodies are at rest


def land(setting, mode, shape, ground, drop, tilt, steps=120):
    """Drop a body askew. Return (most steps in a row in which it stood still with speed, lowest y of its centre, body).

    drop [px]: height of the fall, of which only the last 35 px are simulated.
    """
    effects, options = WORLDS[setting]
    world = World(effects, **options)
    world.add_body(GROUNDS[ground][0], position=GROUNDS[ground][1], kind="static")
    speed = math.sqrt(2.0 * world.gravity[1] * drop)
    body = world.add_body(*SHAPES[shape], position=(0, -35), angle=tilt, velocity=(0, speed), continuous=mode)
    held = longest = 0
    lowest = -math.inf
    for _ in range(steps):
        before, angle = body.center, body.angle
        world.step()
        speed = body.velocity.length + 15.0 * abs(body.angular_velocity)
        moved = (body.center - before).length + 15.0 * abs(body.angle - angle)
        held = held + 1 if speed > SLOW and moved < STILL * speed * world.dt else 0
        longest = max(longest, held)
        lowest = max(lowest, body.center[1])
    return longest, lowest, body


@pytest.mark.parametrize("ground", GROUNDS)
@pytest.mark.parametrize("mode", ["swept", "toi", "auto"])
@pytest.mark.parametrize("setting", WORLDS)
def test_a_body_that_lands_askew_is_not_held_and_does_not_pass(setting, mode, ground):
    """Each shape, dropped from 20 to 2,000 px at 8 tilts, moves as its velocity says, above the ground."""
    cases = [*itertools.product(SHAPES, DROPS, TILTS.tolist())]
    for shape, drop, tilt in cases[:: 3 if JIT else 75]:
        held, lowest, _ = land(setting, mode, shape, ground, drop, tilt)
        assert held <= HELD, (shape, drop, tilt)
        assert lowest <= 1e-9, (shape, drop, tilt)


@pytest.mark.parametrize("ground", ["box", "tiles"])
@pytest.mark.parametrize("setting", WORLDS)
def test_a_body_whose_centre_is_at_the_surface_is_pushed_out(setting, ground):
    """In mode "ray" the centre stops at the surface: the body must not stay there with its speed."""
    cases = [*itertools.product(SHAPES, DROPS, TILTS.tolist())]
    for shape, drop, tilt in cases[:: 3 if JIT else 75]:
        held, lowest, _ = land(setting, "ray", shape, ground, drop, tilt)
        assert held <= HELD, (shape, drop, tilt)
        assert lowest <= 1e-9, (shape, drop, tilt)


@pytest.mark.parametrize("mode", ["swept", "toi", "auto"])
@pytest.mark.parametrize("tilt", [0.05, 0.3, 0.6])
@pytest.mark.parametrize("setting", WORLDS)
def test_a_bar_that_lands_askew_lies_flat_at_the_end(setting, tilt, mode):
    _, _, body = land(setting, mode, "ruler", "box", 60, tilt, 300)
    assert math.remainder(body.angle, math.pi) == pytest.approx(0.0, abs=0.01)
    assert body.position[1] == pytest.approx(-2.0, abs=0.2)
    assert body.velocity.length < SLOW
