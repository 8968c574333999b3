"""Conveyor surfaces carry characters as they carry bodies: at the surface speed, to the right if it is positive."""

import pytest

from physics import Chain, Character, Effects, Material, Polygon, TileGrid, World

CARRIES = Effects(response=True, gravity=True, friction=True, conveyor=True)
STACKS = CARRIES.with_(stacking=True, rotation=True)


def stand(world, floor, x=100.0, top=200.0, material=None, **settings):
    """Return a character that stands on a floor shape whose surface is at y = `top`."""
    world.add_body(floor, kind="static", position=settings.pop("position", (0.0, 0.0)), material=material or Material())
    one = Character(world, Polygon.box(10, 20), (x, top - 10.0), **settings)
    assert one.move(0.0, 0.0).grounded
    return one


def walk_for(world, one, frames, dx=0.0):
    for _ in range(frames):
        one.move(dx, 0.0)
        world.step()


def belt(speed):
    return Material(friction=0.6, surface_speed=speed)


@pytest.mark.parametrize("effects", [CARRIES, STACKS], ids=["plain", "stacking"])
@pytest.mark.parametrize("speed", [45.0, -45.0, 100.0, 7.0])
def test_it_is_carried_at_the_speed_of_the_belt(effects, speed):
    world = World(effects)
    one = stand(world, Polygon.box(4000, 20), top=200.0, position=(0.0, 210.0), material=belt(speed))
    walk_for(world, one, 120)
    assert one.position[0] == pytest.approx(100.0 + 2.0 * speed, abs=1.0)
    assert one.position[1] == 190.0 and one.surface_speed == speed


def test_a_crate_and_a_character_on_one_belt_go_the_same_way():
    world = World(STACKS)
    one = stand(world, Polygon.box(4000, 20), position=(0.0, 210.0), material=belt(60.0))
    crate = world.add_body(Polygon.box(16, 16), position=(300.0, 192.0))
    walk_for(world, one, 60)
    before = one.position[0], crate.position[0]
    walk_for(world, one, 120)
    carried, slid = one.position[0] - before[0], crate.position[0] - before[1]
    assert carried == pytest.approx(120.0, abs=1.0) and slid == pytest.approx(carried, abs=2.0)


def test_undeclared_the_belt_stands():
    world = World(STACKS.with_(conveyor=False))
    one = stand(world, Polygon.box(4000, 20), position=(0.0, 210.0), material=belt(60.0))
    walk_for(world, one, 60)
    assert one.position[0] == 100.0


def test_each_link_of_a_chain_has_its_own_speed():
    world = World(STACKS)
    links = [Material(), belt(90.0), Material()]
    one = stand(world, Chain([(0.0, 200.0), (100.0, 200.0), (200.0, 200.0), (400.0, 200.0)], materials=links), x=120.0)
    walk_for(world, one, 240)
    assert 199.0 <= one.position[0] <= 203.0  # off the running link, and no further
    other = stand(World(STACKS), Chain([(0.0, 200.0), (100.0, 200.0), (200.0, 200.0)], materials=links[:2]), x=50.0)
    assert other.surface_speed == 0.0


def test_he_walks_against_it_and_loses_its_speed_beside_it():
    world = World(CARRIES)
    one = stand(world, Polygon.box(400, 20), x=0.0, position=(0.0, 210.0), material=belt(60.0))
    walk_for(world, one, 60, dx=-1.0)  # 60 px/s against 60 px/s
    assert one.position[0] == pytest.approx(0.0, abs=1.0)
    one.move(0.0, -5.0)  # in the air
    place = one.position[0]
    for _ in range(20):
        one.move(0.0, 0.0)
        world.step()
    assert one.position[0] == place and one.surface_speed == 0.0


def test_a_wall_stops_him_and_does_not_squeeze():
    world = World(STACKS)
    one = stand(world, Polygon.box(400, 20), x=0.0, position=(0.0, 210.0), material=belt(60.0))
    world.add_body(Polygon.box(20, 100), kind="static", position=(60.0, 150.0))
    for _ in range(120):
        moved = one.move(0.0, 0.0)
        assert not moved.squeezed
        world.step()
    assert one.position[0] == 45.0 and one.move(0.0, 0.0).wall == 1


def test_he_takes_along_who_stands_on_him():
    world = World(CARRIES)
    one = stand(world, Polygon.box(4000, 20), position=(0.0, 210.0), material=belt(60.0), pushable=True)
    above = Character(world, Polygon.box(10, 10), (100.0, 175.0))
    for _ in range(60):
        one.move(0.0, 0.0)
        above.move(0.0, 0.0)
        world.step()
    assert above.position[0] == one.position[0] == pytest.approx(160.0, abs=1.0)


def test_a_belt_that_moves_carries_by_both():
    world = World(CARRIES)
    lift = world.add_body(
        Polygon.box(400, 20), kind="kinematic", position=(0.0, 210.0), velocity=(60.0, 0.0), material=belt(30.0)
    )
    one = Character(world, Polygon.box(10, 20), (0.0, 190.0))
    walk_for(world, one, 60)
    assert lift.position[0] == pytest.approx(60.0) and one.position[0] == pytest.approx(90.0, abs=1.0)


def test_tiles_of_one_grid_run_together():
    world = World(CARRIES)
    one = stand(world, TileGrid([[True] * 40], 16), top=200.0, position=(0.0, 200.0), material=belt(-30.0))
    walk_for(world, one, 60)
    assert one.position[0] == pytest.approx(70.0, abs=1.0)


def test_a_snapshot_keeps_the_part_of_a_pixel():
    world = World(CARRIES)
    one = stand(world, Polygon.box(4000, 20), position=(0.0, 210.0), material=belt(7.0))
    walk_for(world, one, 10)
    kept = world.snapshot()
    walk_for(world, one, 50)
    first = world.digest(), one.position
    world.restore(kept)
    walk_for(world, one, 50)
    assert (world.digest(), one.position) == first
