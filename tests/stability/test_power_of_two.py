"""A scene without masks gives bit-identical results when scaled by a power of two, so no tolerance is an absolute
number.
"""

import numpy as np
import pytest

from physics import (
    JIT,
    BruteForce,
    Circle,
    DynamicTree,
    Effects,
    Material,
    Polygon,
    SpatialHashGrid,
    SweepAndPrune,
    TileGrid,
    World,
)

ALL = Effects(
    response=True,
    gravity=True,
    drag=True,
    rotation=True,
    friction=True,
    restitution=True,
    continuous=True,
    sensors=True,
    one_way=True,
)
LENGTHS = ("x", "y", "vx", "vy", "center_x", "center_y")


def run(scale, solver, broadphase, narrowphase=True):
    """Return poses, velocities, contacts and events of a scaled scene of many bodies, divided by the scale."""
    rng = np.random.default_rng(11)
    world = World(ALL.with_(narrowphase=narrowphase), broadphase(), solver, pixels_per_meter=32.0 * scale, drag=0.1)
    heights = np.zeros((3, 20, 2))
    solid = np.zeros((3, 20), bool)
    solid[2], solid[1, :2], solid[1, -2:] = True, True, True
    heights[1, 5], heights[1, 6], heights[1, 7] = (0, 1), (1, 0.5), (0.5, 0)
    world.add_body(TileGrid(solid, 16.0 * scale, slopes=heights), position=(0.0, 160.0 * scale), kind="static")
    world.add_body(
        Polygon.box(40.0 * scale, 8.0 * scale),
        position=(150.0 * scale, 120.0 * scale),
        kind="kinematic",
        velocity=(-30.0 * scale, 5.0 * scale),
        angular_velocity=0.5,
    )
    for k in range(24 if JIT else 10):
        x, y, vx, vy = rng.uniform((40, 0, -900, -200), (280, 150, 900, 200)) * scale
        shape = (
            Circle(float(rng.uniform(3, 9)) * scale, (0.5 * scale, 0.0))
            if k % 2
            else Polygon.box(*(rng.uniform(5, 16, 2) * scale))
        )
        world.add_body(
            shape,
            position=(x, y),
            velocity=(vx, vy),
            angle=float(rng.uniform(0, 6)),
            sensor=k % 9 == 0,
            angular_velocity=float(rng.normal()),
            material=Material(restitution=0.6, friction=0.3),
        )
    found = []
    for _ in range(90 if JIT else 15):
        world.step()
        found += [(world.bodies[name] / scale).tolist() for name in LENGTHS]
        found += [world.bodies["angle"].tolist(), world.bodies["angular_velocity"].tolist()]
        found += [
            world.candidates.tolist(),
            (world.contacts["separation"] / scale).tolist(),
            world.contacts["normal_x"].tolist(),
            (world.events.hits["speed"] / scale).tolist(),
            world.events.begin["shape_b"].tolist(),
            world.events.sensor_end["shape_a"].tolist(),
        ]
    return found


@pytest.mark.parametrize("solver", ["projection", "blocking"])
@pytest.mark.parametrize("exponent", [-20, -7, 1, 20])
def test_scaled_scene_is_bit_equal(solver, exponent):
    assert run(2.0**exponent, solver, SpatialHashGrid) == run(1.0, solver, SpatialHashGrid)


@pytest.mark.parametrize("broadphase", [BruteForce, SweepAndPrune, DynamicTree])
def test_scaled_scene_is_bit_equal_under_every_broad_phase(broadphase):
    assert run(2.0**-11, "projection", broadphase) == run(1.0, "projection", SpatialHashGrid)


def test_scaled_scene_of_bounds_alone_is_bit_equal():
    assert run(2.0**9, "projection", SpatialHashGrid, narrowphase=False) == run(
        1.0, "projection", SpatialHashGrid, narrowphase=False
    )


@pytest.mark.parametrize("exponent", range(-20, 21))
def test_every_scale_is_bit_equal(exponent):
    assert run(2.0**exponent, "projection", DynamicTree) == run(1.0, "projection", DynamicTree)
