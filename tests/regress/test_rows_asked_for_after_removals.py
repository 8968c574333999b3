"""A query after a removal uses current rows; before the fix it read old rows, and the next one
read beyond the table.
"""

import numpy as np

from physics import Character, Circle, Polygon, World


def test_questions_around_a_removal_after_a_quarantine():
    world = World()
    bodies = [world.add_body(Circle(4.0), position=(20.0 * k, 0.0)) for k in range(3)]
    hero = Character(world, Polygon.box(10.0, 14.0), (0.0, -40.0))
    world.bodies["x"][1] = np.nan
    world.step()
    assert world.events.quarantined["body"].tolist() == [bodies[1].id]
    world.remove_bodies([bodies[1]])
    assert not hero.blocked(3.0, 0.0)
    world.step()
    assert hero.move(3.0, 0.0).x == 3
    assert [body.id for body in world.overlap(Polygon.box(30.0, 30.0), (3.0, -40.0))] == [hero.body.id]
