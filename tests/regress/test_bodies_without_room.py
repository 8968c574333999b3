"""Bodies that a closing door leaves no room stay overlapped on their own side of the ground.

The ground bears as much as all contacts of a body together, whether the door still moves or has stopped.
A face that a body only touches or meets within the step counts too: a box between a wall and a block is not thrown out.
"""

import math

import pytest

from physics import Effects, Material, Polygon, World
from physics.jit import JIT

DEPTH = 40.0  # [px] of the ground, whose surface is at y = 0
SPEEDS = (20, 60, 120, 240) if JIT else (240,)  # [px/s]
# [px] of the centre of a crate. A door that has stopped bears as much as the ground: crates come to rest half in both,
# at up to 19.99. With the same bound for all contacts they fell through the ground.
MOST_DEPTH = 0.5 * DEPTH + 2.0
REST = 120  # steps after the door has stopped


def crates(world, count, width, height, friction, x=0.0):
    """Add a stack of crates, each shifted a little to the side."""
    material = Material(friction=friction)
    return [
        world.add_body(
            Polygon.box(width, height),
            position=(x + 2.7 * math.sin(3.0 * k), -height / 2 - 0.1 - k * (height + 0.1)),
            material=material,
        )
        for k in range(count)
    ]


@pytest.mark.parametrize("substeps", ["auto", 4])
@pytest.mark.parametrize("friction", [0.0, 0.6])
@pytest.mark.parametrize("count", [1, 2, 3, 5])
@pytest.mark.parametrize("width, height", [(20, 20), (47, 23), (60, 30)])
def test_a_door_that_closes_pushes_no_crate_through_the_ground(width, height, count, friction, substeps):
    for speed in SPEEDS:
        world = World(Effects.rigid_bodies(), substeps=substeps)
        world.add_body(Polygon.box(40_000, DEPTH), position=(0, DEPTH / 2), kind="static")
        stack = crates(world, count, width, height, friction)
        start = count * (height + 0.1) + 10.0  # height of the lower edge above the ground
        door = world.add_body(Polygon.box(16, 100), position=(1.3, -start - 50), kind="kinematic", velocity=(0, speed))
        closing = math.ceil(start / speed * 60.0)
        for step in range(closing + REST):
            if step == closing:
                door.velocity = (0.0, 0.0)
            world.step()
            case = (speed, step)
            assert max(crate.position.y for crate in stack) < MOST_DEPTH, case
            assert max(crate.velocity.length for crate in stack) < 3.0 * speed + 400.0, case


@pytest.mark.parametrize("substeps", ["auto", 4])
@pytest.mark.parametrize("tilt", [0.0, 0.05, -0.1, 0.15])
@pytest.mark.parametrize("gap", [0.2, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0])
def test_a_box_that_is_crushed_against_a_wall_is_not_thrown_out(gap, tilt, substeps):
    """A block pushes two overlapped frictionless boxes to a wall, which the tilted second one touches or is about to.

    The limit is the sum of the speed of the block, the push-out (96 px/s) and a fall from the height of two boxes, in
    768 cases exceeded by at most a third (before, by a factor of 10).
    """
    size, smooth = 25.0, Material(friction=0.0)
    for speed in SPEEDS:
        for overlap in (6.0, 12.0, 17.0, 20.0):
            world = World(Effects.rigid_bodies(), substeps=substeps)
            world.add_body(Polygon.box(4000, DEPTH), position=(0, DEPTH / 2), kind="static")
            world.add_body(Polygon.box(32, 200), position=(16, -50), kind="static")
            moving = {"material": smooth, "velocity": (speed, 0)}
            x = -size / 2 - gap
            far = world.add_body(Polygon.box(size, size), position=(x, -size / 2 - 1.3), angle=tilt, **moving)
            x += overlap - size
            near = world.add_body(Polygon.box(size, size), position=(x, -size / 2 - 0.2), **moving)
            x += 4.0 - size / 2 - 16.0
            block = world.add_body(Polygon.box(32, 60), position=(x, -31), kind="kinematic", velocity=(speed, 0))
            most = speed + 96.0 + math.sqrt(2.0 * world.gravity.y * 2.0 * size)
            for _ in range(60):
                if block.position.x >= -16.0 - size:
                    block.velocity = (0.0, 0.0)
                world.step()
                fastest = max(near.velocity.length, far.velocity.length)
                assert fastest < 1.5 * most, (speed, overlap, world.time, fastest, most)
