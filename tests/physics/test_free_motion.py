"""A body without friction sleeps only if it would stay in place for a minute; `allow_sleep`."""

import math

import pytest

from physics import Circle, Effects, Material, Polygon, World

BOX, DISC = Polygon.box(16, 16), Circle(8)
ICE, FLOOR = Material(friction=0.0), Polygon.box(4000, 40, center=(0, 20))
AIR = Effects.rigid_bodies().with_(drag=True, wind=True)
SOLVERS = ("soft_step", "sequential_impulse")
SLOP = 0.16  # [px] of 32 pixels per metre


def run(world, seconds=2.0):
    for _ in range(round(seconds / world.dt)):
        world.step()


def slope(world, angle, material=ICE):
    """Add a floor that slopes down to the right by an angle, and return its normal."""
    world.add_body(FLOOR, kind="static", angle=angle, material=material)
    return math.sin(angle), -math.cos(angle)


# ---- in flight -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("velocity, spin, awake", [
    ((1.0, 0.0), 0.0, True),
    ((0.0, -1.2 * SLOP / 60), 0.0, True),
    ((0.0, -0.8 * SLOP / 60), 0.0, False),
    ((0.0, 0.0), 1.2 * SLOP / 60 / 8, True),
    ((0.0, 0.0), 0.8 * SLOP / 60 / 8, False),
    ((0.0, 0.0), 0.0, False),
])  # fmt: skip
def test_a_body_in_space_sleeps_if_it_stays_within_the_slop_for_a_minute(solver, velocity, spin, awake):
    world = World(gravity=(0, 0), solver=solver)
    body = world.add_body(DISC, velocity=velocity, angular_velocity=spin)
    run(world)
    assert body.awake is awake
    if awake:
        assert tuple(body.position) == pytest.approx((2 * velocity[0], 2 * velocity[1]))
        assert body.angle == pytest.approx(2 * spin)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("arguments, scale, drop", [
    ({"gravity": (0, 1)}, 1.0, (0.0, 2.0)),
    ({"gravity": (0.5, 0)}, 1.0, (1.0, 0.0)),
    ({"gravity": (0, 10)}, 0.1, (0.0, 2.0)),
    ({"gravity": (0, 100)}, 0.0, None),
    ({"gravity": (0, 1e-5)}, 1.0, None),
])  # fmt: skip
def test_a_fall_under_a_low_gravity_goes_on(solver, arguments, scale, drop):
    world = World(solver=solver, **arguments)
    body = world.add_body(DISC, gravity_scale=scale)
    run(world)
    assert body.awake is (drop is not None)
    if drop:
        assert tuple(body.position) == pytest.approx(drop, rel=0.02, abs=1e-9)


@pytest.mark.parametrize("wind, drag, velocity, awake", [
    ((10.0, 0.0), 0.1, 0.0, True),  # 1 px/s2
    ((0.0, 0.0), 0.1, 1.0, True),  # stops after 10 px
    ((0.0, 0.0), 1.0, 0.1, False),  # stops after 0.1 px
    ((0.0, 0.0), 0.01, 0.1, True),  # 4.5 px in a minute
    ((1e-4, 0.0), 1.0, 0.0, False),  # 0.006 px in a minute
])  # fmt: skip
def test_drag_and_wind_count(wind, drag, velocity, awake):
    world = World(AIR, gravity=(0, 0), wind=wind, drag=drag)
    body = world.add_body(DISC, velocity=(velocity, 0))
    run(world)
    assert body.awake is awake


def test_bodies_that_only_bear_each_other_drift_on():
    world = World(gravity=(0, 0))
    pair = [world.add_body(BOX, position=(16 * k, 0), velocity=(1, 0)) for k in range(2)]
    run(world)
    assert [body.awake for body in pair] == [True, True]
    assert [body.position.x for body in pair] == pytest.approx([2.0, 18.0], abs=0.01)


def test_the_rule_is_the_same_in_metres():
    for scale in (1.0, 32.0, 1000.0):
        world = World(gravity=(0, 0), pixels_per_meter=scale)
        fast = world.add_body(Circle(0.25 * scale), velocity=(1e-4 * scale, 0))
        slow = world.add_body(Circle(0.25 * scale), position=(scale, 0), velocity=(0.5e-4 * scale, 0))
        run(world, 1.0)
        assert (fast.awake, slow.awake) == (True, False)


# ---- borne without friction ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("shape", [BOX, DISC])
@pytest.mark.parametrize("angle", [0.001, -0.003])
def test_a_slope_of_ice_is_slid_down(solver, shape, angle):
    world = World(solver=solver)
    nx, ny = slope(world, angle)
    body = world.add_body(shape, position=(8 * nx, 8 * ny), angle=angle, material=ICE)
    run(world, 4.0)
    assert body.awake
    assert body.position.x == pytest.approx(8 * nx + 0.5 * 313.6 * angle * 16, rel=0.05)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("shape", [BOX, DISC])
@pytest.mark.parametrize("velocity", [0.0, 1.0, -0.01])
def test_on_level_ice_a_body_at_rest_sleeps_and_a_slow_one_slides(solver, shape, velocity):
    world = World(solver=solver)
    slope(world, 0.0)
    body = world.add_body(shape, position=(0, -8), velocity=(velocity, 0), material=ICE)
    run(world)
    assert body.awake is (velocity != 0.0)
    assert body.position.x == pytest.approx(2 * velocity, abs=1e-6)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("left, right", [(0.7, 0.7), (0.3, 1.1), (0.01, 0.01)])
def test_a_groove_of_ice_holds_a_disc(solver, left, right):
    world = World(solver=solver)
    world.add_body(FLOOR, kind="static", angle=left, position=(0, 0), material=ICE)
    world.add_body(FLOOR, kind="static", angle=-right, position=(0, 0), material=ICE)
    # The centre of a disc that touches both: distance 8 from both lines through the origin.

    bisector = (left - right) / 2
    far = 8 / math.cos((left + right) / 2)
    disc = world.add_body(DISC, position=(far * math.sin(bisector), -far * math.cos(bisector)), material=ICE)
    start = disc.position
    run(world, 4.0)
    assert not disc.awake and (disc.position - start).length < 1.0


@pytest.mark.parametrize("walls", [1, 2])
def test_a_body_slides_down_between_walls_of_ice(walls):
    world = World(gravity=(0, 1))
    for side in (-1, 1)[:walls]:
        world.add_body(Polygon.box(40, 4000), position=(28 * side, 0), kind="static", material=ICE)
    body = world.add_body(BOX, material=ICE)
    run(world)
    assert body.awake and body.position.y == pytest.approx(2.0, rel=0.05)


def test_a_stack_of_ice_sleeps():
    world = World()
    slope(world, 0.0)
    boxes = [world.add_body(BOX, position=(0, -8 - 16 * k), material=ICE) for k in range(5)]
    run(world, 4.0)
    assert not any(box.awake for box in boxes)


@pytest.mark.parametrize("velocity", [0.0, 1.0])
def test_what_lies_on_a_raft_goes_where_the_raft_goes(velocity):
    """Crates with friction on a raft without friction move and sleep together with the raft."""
    world = World()
    slope(world, 0.0)
    raft = world.add_body(Polygon.box(200, 10), position=(0, -5), velocity=(velocity, 0), material=ICE)
    grip = Material(friction=1.0)
    raft.set_shapes(Polygon.box(200, 8, center=(0, 1)).with_(ICE), Polygon.box(200, 2, center=(0, -4)).with_(grip))
    crates = [world.add_body(BOX, position=(40 * k, -18), velocity=(velocity, 0)) for k in range(2)]
    run(world, 4.0)
    assert {body.awake for body in (raft, *crates)} == {velocity != 0.0}
    assert raft.position.x == pytest.approx(4 * velocity, abs=0.02)


# ---- borne with friction ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("angle", [0.0, 0.3])
def test_with_friction_the_threshold_decides(solver, angle):
    world = World(solver=solver)
    nx, ny = slope(world, angle, Material())
    box = world.add_body(BOX, position=(8 * nx, 8 * ny), angle=angle)
    run(world)
    assert not box.awake


@pytest.mark.parametrize("speed, awake", [(0.7, False), (1.2, True)])
def test_a_disc_that_rolls_slowly_on_ground_with_friction_sleeps(speed, awake):
    """A slowly rolling disc on ground with friction sleeps below the sleeping speed.

    The fastest point of the disc moves at twice the speed of its centre; 1.6 px/s is slow enough to sleep.
    """
    world = World()
    slope(world, 0.0, Material())
    disc = world.add_body(DISC, position=(0, -8), velocity=(speed, 0), angular_velocity=speed / 8)
    run(world)
    assert disc.awake is awake


def test_without_the_effect_friction_all_is_ice():
    world = World(Effects.rigid_bodies().with_(friction=False))
    slope(world, 0.0, Material())
    body = world.add_body(BOX, position=(0, -8), velocity=(1, 0))
    run(world)
    assert body.awake and body.position.x == pytest.approx(2.0)


# ---- islands that stay awake -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("restless", range(3))
def test_a_body_that_may_not_sleep_keeps_its_island_awake(restless):
    world = World()
    slope(world, 0.0, Material())
    boxes = [world.add_body(BOX, position=(0, -8 - 16 * k), allow_sleep=k != restless) for k in range(3)]
    other = world.add_body(BOX, position=(100, -8))
    run(world)
    assert [box.awake for box in boxes] == [True] * 3 and not other.awake
    assert [box.allow_sleep for box in boxes] == [k != restless for k in range(3)]
    boxes[restless].allow_sleep = True
    run(world)
    assert not any(box.awake for box in boxes)
    boxes[restless].allow_sleep = False
    assert all(box.awake for box in boxes), "at once, as one"
    run(world)
    assert all(box.awake for box in boxes)


def test_many_bodies_that_may_not_sleep():
    world = World(gravity=(0, 0))
    ids = world.add_bodies(DISC, [(0, 0), (100, 0)], allow_sleep=False)
    run(world)
    assert world.bodies["awake"].all() and not any(world.body(each).allow_sleep for each in ids)


@pytest.mark.parametrize("value", [0, 1, None, "no"])
def test_allow_sleep_is_a_bool(value):
    world = World()
    body = world.add_body(DISC)
    for wrong in (
        lambda: world.add_body(DISC, allow_sleep=value),
        lambda: world.add_bodies(DISC, [(0, 0)], allow_sleep=value),
        lambda: setattr(body, "allow_sleep", value),
    ):
        with pytest.raises(TypeError, match=f"allow_sleep must be True or False \\(got {value!r}\\)"):
            wrong()
    assert len(world) == 1 and body.allow_sleep is True


def test_allow_sleep_is_part_of_snapshot_and_digest():
    world = World(gravity=(0, 0))
    body = world.add_body(DISC)
    taken, before = world.snapshot(), world.digest()
    body.allow_sleep = False
    assert world.digest() != before
    restless = world.snapshot()
    world.restore(taken)
    assert body.allow_sleep is True and world.digest() == before
    run(world)
    assert not body.awake
    world.restore(restless)
    run(world)
    assert body.awake


@pytest.mark.parametrize("speed", [(0.0, -1.0), (1.0, 0.0)])
def test_a_slow_lift_keeps_awake_all_that_it_carries(speed):
    world = World()
    world.add_body(Polygon.box(200, 10), position=(0, 5), kind="kinematic", velocity=speed)
    boxes = [world.add_body(BOX, position=(0, -8 - 16 * k)) for k in range(4)]
    run(world, 6.0)
    assert all(box.awake for box in boxes)
    for k, box in enumerate(boxes):
        assert tuple(box.position) == pytest.approx((6 * speed[0], 6 * speed[1] - 8 - 16 * k), abs=0.2)
