"""A short step between long ones leaves piles in place; before the fix the top box of five flew 25,000 px away.

It did so within five seconds. The impulse that stopped a tremble in 1e-5 s was cached as a force, and a step of 1/60 s
applied 1,667 times as much.
"""

import pytest

from physics import Effects, Polygon, World


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
@pytest.mark.parametrize("short", [1e-3, 1e-4, 1e-5, 1e-6, 1e-9])
def test_a_pile_stands_though_every_third_step_is_short(solver, short):
    world = World(Effects.rigid_bodies().with_(sleeping=False), solver=solver)
    world.add_body(Polygon.box(2000, 40), position=(0, 20), kind="static")
    boxes = [world.add_body(Polygon.box(32, 32), position=(0, -16 - 32 * k)) for k in range(5)]
    for k in range(300):
        world.step(short if k % 3 == 0 else 1 / 60)
    assert all(abs(box.position.x) + abs(box.position.y + 16 + 32 * k) < 3.2 for k, box in enumerate(boxes))


def test_what_a_short_step_says_of_forces_counts_by_its_length():
    """A step of a millionth of a second does not change the impulses of the next ordinary step,
    for five boxes at rest.
    """
    world = World(Effects.rigid_bodies().with_(sleeping=False))
    world.add_body(Polygon.box(2000, 40), position=(0, 20), kind="static")
    for k in range(5):
        world.add_body(Polygon.box(32, 32), position=(0, -16 - 32 * k))
    for _ in range(120):
        world.step()
    before = world.contacts["normal_impulse"].copy()
    world.step(1e-6)
    world.step()
    assert world.contacts["normal_impulse"] == pytest.approx(before, rel=0.02)
