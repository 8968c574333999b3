"""A force, mass or radius that is not finite disables only its body; before the fix it spread to the whole heap.

Only positions and velocities were checked, so the value spread in one step. A sweep of such a body crashed Python.
Version 0.1.0 also hung for a character's `climb` of 1e308 and read past its arrays for a radius of NaN. It raised "math
domain error" in a query about a body with an infinite angle.
"""

import math

import numpy as np
import pytest

from physics import Character, Circle, Effects, Polygon, World


def heap(solver="soft_step"):
    world = World(Effects.rigid_bodies(), solver=solver)
    world.add_body(Polygon.box(200, 20), position=(0, 10), kind="static")
    bodies = [world.add_body(Polygon.box(10, 10), position=(0, -5 - 10 * k)) for k in range(3)]
    for _ in range(3):
        world.step()
    return world, bodies


@pytest.mark.parametrize("column", ["force_x", "torque", "inverse_mass", "gravity_scale", "center_x", "local_center_y"])
def test_one_of_a_column_alone_is_put_aside(column):
    world, (below, sick, above) = heap()
    world.bodies[column][world.rows([sick.id])] = math.nan
    for step in range(5):
        world.step()
        assert world.events.quarantined["body"].tolist() == ([sick.id] if step == 0 else [])
        assert math.isfinite(below.position.x) and math.isfinite(above.position.y)


def test_a_spin_whose_end_flies_faster_than_any_speed_is_put_aside():
    world, (below, sick, above) = heap()
    sick.angular_velocity = 1e300
    world.step()
    assert world.events.quarantined["body"].tolist() == [sick.id] and below.awake and above.awake


@pytest.mark.parametrize("column", ["radius", "friction"])
def test_a_shape_whose_numbers_are_none_takes_its_body_alone(column):
    world, (below, sick, above) = heap("projection")
    world.shapes[column][world.shapes["body"] == sick.id] = math.nan
    world.step()
    assert world.events.quarantined["body"].tolist() == [sick.id]
    assert "shapes" in world.events.quarantined["reason"][0] and np.isfinite(world.bodies["x"]).all()


def test_what_a_contact_bore_is_forgotten_where_it_is_no_number():
    world, bodies = heap()
    world.contact_rows["normal_force_1"] = math.nan
    world.contact_rows["rolling_force"] = math.inf
    for _ in range(5):
        world.step()
        assert len(world.events.quarantined) == 0
    assert all(body.position.y == pytest.approx(-5 - 10 * k, abs=0.5) for k, body in enumerate(bodies))


def test_a_character_that_climbs_anything_stands():
    world = World(Effects(response=True))
    world.add_body(Polygon.box(200, 20), position=(0, 10), kind="static")
    hero = Character(world, Polygon.box(8, 16), (0, -8))
    world.characters.rows["climb"] = 1e308
    assert hero.move(1, 1)[:2] == (0, 0)
    world.step()
    assert world.events.quarantined["body"].tolist() == [hero.body.id]


@pytest.mark.parametrize("angle", [math.inf, -math.inf, math.nan])
def test_questions_pass_over_what_has_no_pose(angle):
    world, (below, sick, above) = heap("projection")
    world.bodies["angle"][world.rows([sick.id])] = angle
    assert sick not in world.query_aabb((-50, -50), (50, 50)) and above in world.query_aabb((-50, -50), (50, 50))
    assert [hit.body for hit in world.ray_cast_all((1, -60), (0, 55))] == [above, below]
    assert world.overlap(Circle(30), (0, -15, 0)) == [world.body(0), below, above]
