"""Every setting of a world, a body and a joint takes the value that was read from it, and stays the same."""

import numpy as np
import pytest

from physics import (
    Angle,
    Body,
    Circle,
    Distance,
    Drive,
    Effects,
    Joint,
    Motor,
    PixelMask,
    Polygon,
    Prismatic,
    Revolute,
    Spring,
    Target,
    Weld,
    Wheel,
    World,
)

EFFECTS = Effects(**{name: True for name in Effects.__dataclass_fields__})
KINDS = {
    "revolute": lambda a, b: Revolute(a, b, (20, 0)),
    "limited": lambda a, b: Revolute(a, b, (20, 0), limits=(None, 1.0), motor=Drive(1.0, 5.0), breaks=(None, 7.0)),
    "prismatic": lambda a, b: Prismatic(a, b, (0, 0), limits=(-3.0, None)),
    "distance": lambda a, b: Distance(a, b, (0, 0), (40, 0), spring=Spring(2.0, 0.5), breaks=(9.0, None)),
    "target": lambda a, b: Target(a, (0, 0)),
    "weld": lambda a, b: Weld(a, b, (0, 0)),
    "angle": lambda a, b: Angle(a, b, limits=(-1.0, 1.0)),
    "wheel": lambda a, b: Wheel(a, b, (0, 0)),
    "motor": lambda a, b: Motor(a, b, max_force=1.0, max_torque=1.0),
}


def made():
    """Return a world with all effects, and a dynamic, a masked and a kinematic body."""
    world = World(EFFECTS)
    disc = world.add_body(Circle(5), angular_velocity=2.0, user="disc")
    mask = world.add_body(PixelMask(np.ones((9, 9), bool)), position=(40, 0), tier="hull")
    lift = world.add_body(Polygon.box(80, 8), position=(0, 90), kind="kinematic", velocity=(3, 0))
    return world, (disc, mask, lift)


def settable(kind):
    """Return the names of the properties of a class that can be set."""
    found = [(name, getattr(kind, name, None)) for name in dir(kind) if not name.startswith("_")]
    return [name for name, each in found if isinstance(each, property) and each.fset is not None]


@pytest.mark.parametrize("name", settable(Body))
@pytest.mark.parametrize("k", range(3), ids=["dynamic", "masked", "kinematic"])
def test_a_body_takes_what_was_read(k, name):
    world, bodies = made()
    value = getattr(bodies[k], name)
    setattr(bodies[k], name, value)
    assert getattr(bodies[k], name) == value


@pytest.mark.parametrize("name", settable(World))
def test_a_world_takes_what_was_read(name):
    world, _ = made()
    value = getattr(world, name)
    setattr(world, name, value)
    found = getattr(world, name)
    assert np.array_equal(found, value) if isinstance(value, np.ndarray) else type(found) is type(value)
    assert name == "broadphase" or isinstance(value, np.ndarray) or found == value


@pytest.mark.parametrize("name", settable(Joint))
@pytest.mark.parametrize("kind", KINDS)
def test_a_joint_takes_what_was_read(kind, name):
    world, (disc, mask, _) = made()
    joint = world.add_joint(KINDS[kind](disc, mask))
    try:
        value = getattr(joint, name)
    except AttributeError:
        return  # only joints of another kind have it
    setattr(joint, name, value)
    assert getattr(joint, name) == value
