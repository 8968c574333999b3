"""A body that had closed a gap under sequential impulses was stopped after the passes, however slow it was: a light box
between the floor and a load of a hundred times its mass, which trembles there, was knocked from under it within nine
seconds.
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
