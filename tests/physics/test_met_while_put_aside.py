"""Changes of a body while it sleeps or is disabled, and two circles with the same centre."""

import numpy as np

from game.measure.shape_traces import sat_axes
from physics import Circle, Effects, PixelMask, Polygon, World

PILES = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True, sleeping=True)


def test_a_lift_that_stands_is_sent_off_and_carries_who_sleeps_on_it():
    world = World(PILES)
    lift = world.add_body(Polygon.box(60, 10), position=(0, 5), kind="kinematic")
    crate = world.add_body(Polygon.box(20, 20), position=(0, -10))
    while crate.awake:
        world.step()
        assert world.steps < 600
    lift.set_target((0.0, -25.0))
    world.step()
    assert tuple(lift.position) == (0.0, -25.0) and crate.awake
    for _ in range(60):
        world.step()
    assert crate.position.y < -38.0


def test_a_quarantined_sprite_that_gets_other_pixels_stays_out_of_the_broad_phase():
    world = World(PILES)
    body = world.add_body(PixelMask(np.ones((8, 8), bool)), position=(0, 0))
    near = world.add_body(Circle(4), position=(2, 0))
    world.step()
    world.bodies["x"][world.rows(body)] = np.nan
    world.step()
    assert world.events.quarantined["body"].tolist() == [body.id]
    body.set_shapes(PixelMask(np.ones((12, 12), bool)))
    world.step()
    assert not len(world.candidates) and (world.shapes["proxy"][world.shapes["body"] == body.id] == -1).all()
    assert near in world


def test_two_circles_about_one_point_part_along_x():
    (axis,) = sat_axes(Circle(3), (5, 5), Circle(2), (5, 5))
    assert (axis["normal_x"], axis["normal_y"], axis["separation"], axis["edge"]) == (1.0, 0.0, -5.0, -1)
