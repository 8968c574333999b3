"""A heavy body that falls on bodies joined by a slider or wheel joint does not throw them away.

Tension raises the effective inertia of light bodies in joint trees. The moment arms of such a joint include its
translation, so they can be long. A force that presses the bodies together needs no added inertia.
"""

import math

import pytest

from physics import Capsule, Circle, Effects, Polygon, Prismatic, Wheel, World
from physics.jit import JIT

SPEED = 228.0  # [px/s] of the heavy body
MOST_SPEED = 8.0 * SPEED  # 4.3 is the greatest measured; without the levers of stretch_of up to 33, and jumps of 1.8e8
ARMS = (150, 280, 400) if JIT else (280,)  # [px]
AXES = (0.0, 0.5, 1.57, 2.2)  # [rad] angle of the axis to the line between the bodies
OFFSETS = (-6, 4)  # [px] of the heavy body from the centre of the light one


def pressed(kind, anchor, arm, ratio, turned, offset, substeps):
    """Return (world, a, b): two joined bodies of mass 1, the lower one on a floor; a heavy body falls on the upper one.

    kind: joint, Wheel or Prismatic. anchor: its position between the bodies, from 0 (a) to 1 (b). arm: distance of the
    bodies [px]. ratio: mass of the heavy body. turned: angle of the axis to the line between the bodies [rad]. offset:
    distance of the heavy body from the middle of b along x [px].
    """
    world = World(Effects.rigid_bodies().with_(joints=True))
    world.substeps = substeps
    world.add_body(Polygon.box(4000, 40), position=(0, 20), kind="static")
    a = world.add_body(Circle(9), position=(0, -9), mass=1)
    place = (arm * math.cos(1.28), -9 - arm * math.sin(1.28))
    b = world.add_body(Capsule((-14, 0), (14, 1), 3), position=place, angle=0.6, mass=1)
    at = a.position + (b.position - a.position) * anchor
    axis = (math.cos(turned - 1.28), math.sin(turned - 1.28))
    if kind is Wheel:
        world.add_joint(Wheel(a, b, at, axis=axis, spring=None))
    else:
        world.add_joint(Prismatic(a, b, at, axis=axis))
    world.add_body(Circle(20), position=(place[0] - offset, place[1] - 33.8), mass=ratio, velocity=(0, SPEED))
    return world, a, b


@pytest.mark.parametrize("substeps", ["auto", 4])
@pytest.mark.parametrize("ratio", [30, 100, 1000])
@pytest.mark.parametrize("kind, anchor", [(Prismatic, 0.0), (Prismatic, 0.5), (Prismatic, 1.0), (Wheel, 1.0)])
def test_a_heavy_body_on_a_slider_with_long_arms_throws_nothing(kind, anchor, ratio, substeps):
    for arm in ARMS:
        for turned in AXES:
            for offset in OFFSETS:
                world, a, b = pressed(kind, anchor, arm, ratio, turned, offset, substeps)
                for step in range(20):
                    before = [body.position for body in (a, b)]
                    world.step()
                    moved = max((body.position - old).length for body, old in zip((a, b), before, strict=True))
                    case = (arm, turned, offset, step)
                    assert max(a.velocity.length, b.velocity.length) < MOST_SPEED, case
                    assert moved < MOST_SPEED / 60.0, case
