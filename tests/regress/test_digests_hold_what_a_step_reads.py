"""Two worlds that will behave differently have different digests, also if only a setting, a
mass or a filter differs.
"""

import pytest

from physics import Circle, Effects, Filter, Material, World

EFFECTS = Effects(response=True, gravity=True, friction=True, drag=True, wind=True, rotation=True, continuous=True)
MADE = {
    "dt": lambda world, body: setattr(world, "dt", 1 / 50),
    "substeps": lambda world, body: setattr(world, "substeps", 7),
    "mask": lambda world, body: setattr(body, "filter", Filter(mask=2)),
    "gravity_scale": lambda world, body: setattr(body, "gravity_scale", 2.0),
    "continuous": lambda world, body: setattr(body, "continuous", "toi"),
    "force": lambda world, body: body.apply_force((1.0, 0.0)),
}


def made(**options):
    world = World(EFFECTS)
    return world, world.add_body(Circle(4), **options)


@pytest.mark.parametrize("name", MADE)
def test_what_is_set(name):
    world, body = made()
    before = world.digest()
    MADE[name](world, body)
    assert world.digest() != before == made()[0].digest()


@pytest.mark.parametrize(
    "options", [{"kind": "kinematic"}, {"material": Material(density=2.0)}, {"fixed_rotation": True}]
)
def test_what_a_body_is_made_with(options):
    assert made(**options)[0].digest() != made()[0].digest()
