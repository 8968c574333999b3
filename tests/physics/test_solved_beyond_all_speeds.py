"""A body that a solver makes faster than any limit is disabled and reported before anything reads its speed."""

import pytest

from physics import Effects, Material, Polygon, World
from physics.settings import SPEED_LIMIT

EFFECTS = Effects(response=True, rotation=True, friction=True, restitution=True, stacking=True)
ELASTIC = Material(density=1.0, restitution=1.0)


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
def test_who_is_hit_to_twice_the_highest_speed_is_taken_out_alone(solver):
    world = World(EFFECTS, solver=solver, pixels_per_meter=1.0)
    heavy = world.add_body(
        Polygon.box(1, 1), position=(0, 0), velocity=(0.9 * SPEED_LIMIT, 0.0), mass=1e6, material=ELASTIC
    )
    light = world.add_body(Polygon.box(1, 1), position=(1.001, 0), material=ELASTIC)
    apart = world.add_body(Polygon.box(1, 1), position=(0, 50))
    world.step()
    assert world.events.quarantined["body"].tolist() == [light.id]
    assert "not finite, beyond what a double resolves" in world.events.quarantined["reason"][0]
    assert not len(world.contacts) and not len(world.events.begin), "nothing is told of what it touched"
    assert heavy.velocity.x == pytest.approx(0.9 * SPEED_LIMIT, rel=1e-5)
    world.step()
    assert not len(world.events.quarantined)
    assert world.bodies["quarantined"].tolist() == [False, True, False] and apart.position.y == 50.0


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
def test_who_stays_below_it_goes_on(solver):
    world = World(EFFECTS, solver=solver, pixels_per_meter=1.0)
    world.add_body(Polygon.box(1, 1), position=(0, 0), velocity=(0.4 * SPEED_LIMIT, 0.0), mass=1e6, material=ELASTIC)
    light = world.add_body(Polygon.box(1, 1), position=(1.001, 0), material=ELASTIC)
    world.step()
    assert not len(world.events.quarantined)
    assert light.velocity.x == pytest.approx(0.8 * SPEED_LIMIT, rel=1e-4)
