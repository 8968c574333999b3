"""A TileGrid cannot rotate: a call that would rotate it raises an error, and a rotation in the
table disables the body.
"""

import math

import numpy as np
import pytest

from physics import Circle, Effects, Polygon, TileGrid, World

GRID = TileGrid(np.ones((2, 4), bool), 16)
BOX = Polygon.box(8, 8, (100, 0))  # its centre of mass is far from the origin: about it the whole body would swing


def worlds():
    return [World(), World(solver="projection"), World(Effects(response=True, rotation=True))]


def test_nobody_can_ask_for_a_turning_grid():
    for world in worlds():
        grid = world.add_body(GRID, BOX, kind="kinematic")
        spinner = world.add_body(BOX, kind="kinematic", angular_velocity=1.0)
        before = world.digest(), world.bodies.tobytes()
        for call in (
            lambda w=world: w.add_body(GRID, kind="kinematic", angular_velocity=1.0),
            lambda w=world: w.add_bodies(GRID, [(0, 0)], kind="kinematic", angular_velocity=1.0),
            lambda b=grid: setattr(b, "angular_velocity", -0.5),
            lambda b=grid: setattr(b, "angle", 0.5),
            lambda b=grid: b.move_to((0, 0), 0.5),
            lambda b=grid: b.set_target((5, 0), 0.5),
            lambda b=spinner: b.add_shape(GRID),
            lambda b=spinner: b.set_shapes(GRID),
        ):
            with pytest.raises(ValueError, match="TileGrid"):
                call()
        assert (world.digest(), world.bodies.tobytes()) == before
        grid.angular_velocity, grid.angle = 0.0, 0.0
        grid.velocity = (60, 0)
        world.step()
        assert grid.position == pytest.approx((1, 0)) and grid.angle == 0.0


@pytest.mark.parametrize("column, value", [("angular_velocity", 2.0), ("angle", 0.3), ("angle", -math.tau)])
@pytest.mark.parametrize("kind", ["static", "kinematic"])
def test_a_grid_turned_by_the_table_is_told_and_stands_still(kind, column, value):
    for world in worlds():
        grid = world.add_body(GRID, BOX, position=(5, 7), kind=kind)
        ball = world.add_body(Circle(4), position=(300, 0), velocity=(1, 0))
        world.step()
        world.bodies[column][grid.id] = value
        world.touch([grid])
        world.step()
        told = world.events.quarantined
        assert told["body"].tolist() == [grid.id] and "TileGrid" in told["reason"][0]
        assert grid.position == (5, 7) and grid.angle == 0.0 and grid.angular_velocity == 0.0
        x = ball.position.x
        world.step()
        assert len(world.events.quarantined) == 0 and ball.position.x > x
        grid.restore()
        world.step()
        assert len(world.events.quarantined) == 0 and world.overlap(Circle(2), (10, 10)) == [grid]


def test_who_has_no_grid_turns_as_before():
    world = World(gravity=(0, 0))
    world.add_body(GRID, kind="static")
    wheel = world.add_body(BOX, position=(200, 200), angular_velocity=3.0)
    world.step()
    assert wheel.angle == pytest.approx(0.05) and len(world.events.quarantined) == 0
