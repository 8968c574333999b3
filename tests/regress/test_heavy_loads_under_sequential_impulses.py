"""A light box under a heavy load stays in place under sequential impulses; before the fix it was knocked out in nine
seconds.

The box trembles between the floor and a load of a hundred times its mass. A body that had closed a gap was stopped
after the passes, however slow it was.
"""

from physics import Material, Polygon
from tests.stability.piles import floor, metres, needs_speed


@needs_speed
def test_a_box_under_a_hundred_of_its_masses_stays_under_it():
    world = metres("sequential_impulse")
    floor(world)
    light = world.add_body(Polygon.box(1, 1), position=(0.0, -0.5))
    heavy = world.add_body(Polygon.box(1, 1), position=(0.0, -1.5), material=Material(density=100.0))
    for _ in range(1200):
        world.step()
    assert abs(light.angle) < 0.01 and abs(heavy.angle) < 0.01 and abs(heavy.position.x) < 0.05
