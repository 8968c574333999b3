"""A step too short for any clock counts as a step of length 0; before the fix world.step(5e-324) raised
ZeroDivisionError.

A fraction of this length is 0.
"""

import pytest

from physics import SOLVERS, Circle, Polygon, World


@pytest.mark.parametrize("dt", [5e-324, 1e-300, 1e-31])
@pytest.mark.parametrize("solver", SOLVERS)
def test_nothing_moves_and_forces_wait(solver, dt):
    world = World(solver=solver)
    world.add_body(Polygon.box(400, 20), position=(0, 10), kind="static")
    ball = world.add_body(Circle(5), position=(0, -5), velocity=(30, 0))
    world.step()
    ball.apply_force((ball.mass * 600, 0))
    before, time = (ball.position, ball.velocity), world.time
    world.step(dt)
    assert world.time == time and (ball.position, ball.velocity) == before
    speed = ball.velocity.x
    world.step()
    assert ball.velocity.x > speed + 5
