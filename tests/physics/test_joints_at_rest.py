"""Sleep of jointed bodies: at rest they sleep, swinging, sliding or driven ones do not, and disturbed ones wake."""

import math

import pytest

from physics import Circle, Distance, Drive, Effects, Polygon, Prismatic, Revolute, Spring, Weld, Wheel, World

EFFECTS = Effects.rigid_bodies().with_(joints=True)


def run(world, seconds):
    for _ in range(round(seconds / world.dt)):
        world.step()


def hung(world, kind, x, y, at):
    ball = world.add_body(Circle(6.0), position=(x, y))
    if kind == "rod":
        return ball, world.add_joint(Distance(None, ball, at_a=at, at_b=(x, y)))
    if kind == "rope":
        length = math.dist(at, (x, y))
        return ball, world.add_joint(Distance(None, ball, at_a=at, at_b=(x, y), limits=(0.0, length)))
    return ball, world.add_joint(Revolute(None, ball, at=at))


@pytest.mark.parametrize("kind", ["rod", "rope", "pin"])
@pytest.mark.parametrize("length", [30.0, 300.0, 2000.0])
def test_a_pendulum_sleeps_below_its_pivot_and_nowhere_else(kind, length):
    world = World(EFFECTS)
    ball, _ = hung(world, kind, 0.0, length, (0.0, 0.0))
    run(world, 3.0)
    assert not ball.awake, "hanging at rest"
    for amplitude in (0.02, 0.1, 0.5, 1.2):
        world = World(EFFECTS)
        ball, _ = hung(world, kind, length * math.sin(amplitude), length * math.cos(amplitude), (0.0, 0.0))
        for _ in range(600):
            world.step()
            if not ball.awake:
                assert abs(ball.position.x) < 1.0
                break


@pytest.mark.parametrize("speed", [0.02, 0.2, 1.0])
def test_what_turns_or_slides_slowly_in_space_goes_on(speed):
    world = World(EFFECTS.with_(gravity=False))
    turning = world.add_body(Polygon.box(40, 4), position=(10.0, 0.0), angular_velocity=speed / 20.0)
    turning.velocity = (0.0, speed / 2.0)
    world.add_joint(Revolute(None, turning, at=(0, 0)))
    sliding = world.add_body(Polygon.box(10, 10), position=(200.0, 0.0), velocity=(speed, 0.0))
    world.add_joint(Prismatic(None, sliding, at=(200, 0), axis=(1, 0)))
    run(world, 5.0)
    assert turning.awake and turning.angular_velocity == pytest.approx(speed / 20.0, rel=0.01)
    assert sliding.awake and sliding.position.x == pytest.approx(200.0 + 5.0 * speed, rel=1e-6)


def bridge(world):
    planks, before = [], None
    for k in range(10):
        plank = world.add_body(Polygon.box(30, 6), position=(15.0 + 30.0 * k, 0.0))
        world.add_joint(Revolute(before, plank, at=(30.0 * k, 0.0)))
        planks.append(plank)
        before = plank
    world.add_joint(Revolute(before, None, at=(300.0, 0.0)))
    return planks


def test_a_bridge_comes_to_rest_and_a_ball_wakes_all_of_it():
    world = World(EFFECTS.with_(drag=True), drag=1.0)
    planks = bridge(world)
    run(world, 20.0)
    assert not any(plank.awake for plank in planks)
    assert world.profile.counters["joints_solved"] == 0, "asleep it costs nothing"
    ball = world.add_body(Circle(8.0), position=(150.0, -20.0))
    run(world, 0.4)
    assert all(plank.awake for plank in planks) and ball.awake


@pytest.mark.parametrize(
    "way", ["motor", "limits", "spring", "enabled", "remove", "kinematic", "removed body", "moved"]
)
def test_what_hangs_on_a_changed_joint_wakes(way):
    world = World(EFFECTS)
    holder = world.add_body(Polygon.box(10, 10), kind="kinematic")
    box = world.add_body(Polygon.box(20, 20), position=(0.0, 60.0))
    joint = world.add_joint(Prismatic(holder, box, at=(0, 60), axis=(0, 1), limits=(0.0, 0.0)))
    run(world, 2.0)
    assert not box.awake and not joint.awake
    match way:
        case "motor":
            joint.motor = Drive(-5.0, 1e7)
        case "limits":
            joint.limits = (0.0, 20.0)
        case "spring":
            joint.spring = Spring(2.0)
        case "enabled":
            joint.enabled = False
        case "remove":
            joint.remove()
        case "kinematic":
            holder.velocity = (20.0, 0.0)
        case "removed body":
            holder.remove()
        case "moved":
            holder.position = (0.0, 10.0)
    run(world, 0.2)
    assert box.awake
    if way in ("limits", "enabled", "remove", "removed body"):
        assert box.position.y > 61.0
    if way == "kinematic":
        assert box.position.x == pytest.approx(4.0, abs=0.1)


def test_a_running_motor_keeps_awake_and_one_at_rest_does_not():
    for speed, awake in ((3.0, True), (0.0, False)):
        world = World(EFFECTS.with_(gravity=False))
        disc = world.add_body(Circle(10.0))
        world.add_joint(Revolute(None, disc, at=(0, 0), motor=Drive(speed, 1e8)))
        run(world, 3.0)
        assert disc.awake is awake


def test_a_car_and_a_welded_heap_sleep():
    world = World(EFFECTS)
    world.add_body(Polygon.box(600, 20), position=(0, 60), kind="static")
    chassis = world.add_body(Polygon.box(60, 12), position=(0, 20))
    for x in (-20.0, 20.0):
        wheel = world.add_body(Circle(10.0), position=(x, 38.0))
        world.add_joint(Wheel(chassis, wheel, at=(x, 38.0), motor=Drive(0.0, 1e6)))
    a = world.add_body(Polygon.box(20, 20), position=(150, 20))
    b = world.add_body(Polygon.box(20, 20), position=(170, 10), angle=0.5)
    world.add_joint(Weld(a, b, at=(160, 15)))
    run(world, 10.0)
    assert not any(body.awake for body in (chassis, a, b))


@pytest.mark.parametrize("broken", [False, True])
@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
def test_the_column_awake_is_what_the_joints_say(solver, broken):
    """The column `awake` of world.joints equals the property of each joint in every step.

    A welded pair falls asleep, is pushed and sleeps again, beside a swinging pendulum.
    """
    world = World(EFFECTS, solver=solver)
    world.add_body(Polygon.box(400, 20), position=(0, 10), kind="static")
    pair = [world.add_body(Polygon.box(20, 20), position=(20.0 * k, -10)) for k in range(2)]
    world.add_joint(Weld(*pair, at=(10, -10)))
    bob = world.add_body(Circle(5), position=(100, -100), allow_sleep=False)
    world.add_joint(Revolute(None, bob, at=(100, -150)))
    seen = set()
    for number in range(400):
        if number == 200:
            pair[0].apply_impulse((0.0, -20000.0))
        if broken and number == 100:
            world.joint(1).enabled = False
        world.step()
        column = world.joints["awake"].tolist()
        assert column == [world.joint(0).awake, world.joint(1).awake], number
        seen.add(column[0])
    assert seen == {True, False} and not pair[0].awake
