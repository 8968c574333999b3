"""A mask without pixels cannot be the only shape of a dynamic body; before the fix such a body fell with an inertia of
0.
"""

import numpy as np
import pytest

from physics import Circle, Effects, PixelMask, World

EMPTY, FULL = PixelMask(np.zeros((4, 4), bool)), PixelMask(np.ones((4, 4), bool))


def test_no_body_that_is_pushed_is_of_empty_masks_alone():
    world = World(Effects.rigid_bodies())
    with pytest.raises(ValueError, match="solid pixel"):
        world.add_body(EMPTY)
    with pytest.raises(ValueError, match="solid pixel"):
        world.add_bodies(EMPTY, [(0, 0), (9, 0)])
    body, still = world.add_body(FULL), world.add_body(EMPTY, kind="static")
    with pytest.raises(ValueError, match="solid pixel"):
        body.set_shapes(EMPTY)
    with pytest.raises(ValueError, match="solid pixel"):
        still.set_kind("dynamic")
    assert body.mass == 16.0 and still.kind == "static" and len(world.bodies) == 2
    world.step()


def test_what_else_weighs_something_may_have_them():
    world = World(Effects.rigid_bodies())
    assert world.add_body(EMPTY, Circle(3)).mass > 0.0
    assert world.add_body(EMPTY, mass=2.0).mass == 2.0
    assert World().add_body(EMPTY, kind="kinematic").mass == 0.0
    world = World(Effects())
    body = world.add_body(EMPTY)
    body.set_shapes(FULL)
    body.set_shapes(EMPTY)
    world.step()
    assert len(world.contacts) == 0
