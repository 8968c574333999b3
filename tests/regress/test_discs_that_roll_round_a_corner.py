"""A disc that rolls around a corner stays on the next face; before the fix it sank into it by up to its own size.

A manifold was recycled as long as it had not rotated since the last step. It kept the old normal, so the disc was
pushed along the line to the corner instead of off the face.
"""

import pytest

from physics import Circle, Material, Polygon, collide
from tests.stability.piles import metres

SMOOTH = Material(friction=0.0)


@pytest.mark.parametrize("radius", [0.1, 0.25, 0.6])
@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
def test_a_roof_that_passes_below_a_disc_lets_it_down_along_its_other_side(solver, radius):
    world = metres(solver)
    roof = world.add_body(
        Polygon([(-3, 0), (3, 0), (0, -1.0)]), kind="kinematic", velocity=(-0.5, 0.0), material=SMOOTH
    )
    for side in (-1, 1):
        wall = Polygon.box(1, 8)
        world.add_body(wall, position=(side * (0.501 + radius), -3.0), kind="static", material=SMOOTH)
    roof.move_to((0.3, 0.0))
    disc = world.add_body(Circle(radius), position=(0.0, -0.9 - 1.06 * radius), material=SMOOTH)
    lowest = 0.0
    for _ in range(150):
        world.step()
        shapes = roof.shapes[0], (*roof.position, 0.0), disc.shapes[0], (*disc.position, disc.angle)
        lowest = min(lowest, collide(*shapes, margin=1.0).separations[0])
    assert lowest > -0.005 and roof.position.x < -0.9
