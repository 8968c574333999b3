"""Gears, pulleys and ratchets against closed forms: ratios, Atwood machines, racks, teeth, forces, energy."""

import math

import pytest

from physics import (
    JIT,
    Angle,
    Circle,
    Drive,
    Effects,
    Gear,
    Polygon,
    Prismatic,
    Pulley,
    Ratchet,
    Revolute,
    Wheel,
    World,
)

EFFECTS = Effects.rigid_bodies().with_(joints=True)
FLOATING = EFFECTS.with_(gravity=False)
G = 9.8 * 32.0
SETTINGS = [("soft_step", 4), ("soft_step", "auto"), ("sequential_impulse", 4), ("sequential_impulse", "auto")]
SHARE = 1.0 if JIT else 0.2  # of the time that is simulated, where only its end is compared


def world_of(setting, effects=EFFECTS, **more):
    return World(effects, solver=setting[0], substeps=setting[1], **more)


def run(world, seconds):
    for _ in range(round(seconds / world.dt)):
        world.step()


def wheel(world, x, y=0.0, radius=20.0, **more):
    """Add a wheel on a hinge fixed to the world, and return (body, hinge)."""
    body = world.add_body(Circle(radius), position=(x, y), **more)
    return body, world.add_joint(Revolute(None, body, at=(x, y)))


def energy(world):
    b = world.bodies
    moving = 0.5 * (b["mass"] * (b["vx"] ** 2 + b["vy"] ** 2) + b["inertia"] * b["angular_velocity"] ** 2)
    return float((moving - b["mass"] * (G if world.effects.gravity else 0.0) * b["center_y"]).sum())


# --- gears ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("ratio", [-4.0, -1.0, 0.25, 1.0, 3.0])
def test_a_pair_of_gears_keeps_its_ratio(ratio, setting):
    """A pair of gears keeps its ratio for a thousand turns of the faster wheel, at ten turns a second."""
    world = world_of(setting)
    (_, hinge_a), (b, hinge_b) = wheel(world, 0.0), wheel(world, 100.0, radius=30.0, angle=0.7)
    gear = world.add_joint(Gear(hinge_a, hinge_b, ratio=ratio))
    speed = 20.0 * math.pi * min(1.0, abs(ratio))
    hinge_a.motor = Drive(speed, max=100.0 * speed * b.inertia)
    run(world, SHARE * 100.0)
    turned = hinge_a.angle
    assert turned > 0.95 * SHARE * 100.0 * speed
    assert hinge_b.angle == pytest.approx(-turned / ratio, rel=1e-3 / max(SHARE * 1000.0, 1.0) * 1000.0)
    assert gear.separation < 1e-3 and gear.translation == pytest.approx(gear.phase, abs=1e-3)
    assert hinge_b.speed == pytest.approx(-speed / ratio, rel=1e-9)


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0, 10.0])
@pytest.mark.parametrize("side", ["a", "b"])
def test_a_torque_on_one_gear_speeds_up_both(side, ratio, setting):
    """A torque on one gear accelerates both: the inertia at A is I_a + I_b / ratio², and the gear's torque accelerates
    B.
    """
    world = world_of(setting, FLOATING)
    (a, hinge_a), (b, hinge_b) = wheel(world, 0.0), wheel(world, 100.0, radius=25.0)
    gear = world.add_joint(Gear(hinge_a, hinge_b, ratio=ratio))
    torque = 10.0 * a.inertia
    felt = a.inertia + b.inertia / ratio**2 if side == "a" else a.inertia * ratio**2 + b.inertia
    for _ in range(30):
        (a if side == "a" else b).apply_torque(torque)
        world.step()
    acceleration = torque / felt
    speed = acceleration * 30.0 * world.dt
    spins = (speed, -speed / ratio) if side == "a" else (-ratio * speed, speed)
    assert (a.angular_velocity, b.angular_velocity) == pytest.approx(spins, rel=1e-9)
    passed = -b.inertia * acceleration / ratio if side == "a" else b.inertia * acceleration - torque
    assert gear.torque == pytest.approx(passed, rel=1e-6) and gear.force == 0.0


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("angle", [0.0, 0.6, math.pi / 2, 2.0])
@pytest.mark.parametrize("radius", [10.0, 40.0])
def test_a_rack_falls_against_its_pinion(radius, angle, setting):
    """A rack falls against its pinion with an acceleration of g sin / (1 + I / (m r²)), where sin is that of the slope.

    The gear's force is the mass of the rack times the difference between g sin and this acceleration.
    """
    world = world_of(setting)
    pinion, hinge = wheel(world, 0.0, radius=20.0)
    axis = math.cos(angle), math.sin(angle)
    rack = world.add_body(Polygon.box(10, 80), position=(200.0, 0.0))
    slide = world.add_joint(Prismatic(None, rack, at=(200.0, 0.0), axis=axis))
    gear = world.add_joint(Gear(hinge, slide, ratio=1.0 / radius))
    run(world, 0.5)
    pull = G * math.sin(angle)
    acceleration = pull / (1.0 + pinion.inertia / (rack.mass * radius**2))
    assert slide.speed == pytest.approx(0.5 * acceleration, rel=1e-6, abs=1e-9)
    assert hinge.speed == pytest.approx(-slide.speed / radius, rel=1e-6, abs=1e-9)
    assert gear.force == pytest.approx(rack.mass * abs(pull - acceleration), rel=1e-6, abs=1e-6)
    assert gear.torque == 0.0 and gear.separation < 2e-3


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("tier", ["iterative", "direct", "auto"])
def test_a_planetary_gear_turns_by_willis(tier, setting):
    """The planet of a planetary gear with a fixed sun turns as Willis's equation says.

    Its angle relative to the carrier is r_sun / r_planet times the angle of the carrier. The driven carrier is part of
    both joints that the gear couples.
    """
    world = world_of(setting, FLOATING)
    world.joint_solver = tier
    sun, _ = wheel(world, 0.0)
    carrier = world.add_body(Polygon.box(80, 6), position=(0.0, 0.0))
    drive = world.add_joint(Revolute(None, carrier, at=(0.0, 0.0)))
    planet = world.add_body(Circle(15.0), position=(35.0, 0.0))
    pin, turned = world.add_joint(Revolute(carrier, planet, at=(35.0, 0.0))), world.add_joint(Angle(carrier, sun))
    gear = world.add_joint(Gear(turned, pin, ratio=15.0 / 20.0))
    sun.set_kind("static")
    drive.motor = Drive(2.0, max=1e9)
    run(world, 5.0)
    assert pin.angle == pytest.approx(drive.angle * 20.0 / 15.0, rel=1e-3)
    assert pin.speed == pytest.approx(2.0 * 20.0 / 15.0, rel=0.01) and gear.separation < 0.01


@pytest.mark.parametrize("setting", SETTINGS)
def test_a_train_of_gears_carries_the_turn_to_its_end(setting):
    world = world_of(setting, FLOATING)
    hinges = [wheel(world, 50.0 * k)[1] for k in range(8)]
    world.add_joints(Gear, hinges[:-1], hinges[1:], ratio=1.0)
    hinges[0].motor = Drive(5.0, max=1e7)
    run(world, 8.0)
    for k, hinge in enumerate(hinges):
        assert hinge.speed == pytest.approx(5.0 * (-1.0) ** k, rel=1e-6)
        assert hinge.angle == pytest.approx(hinges[0].angle * (-1.0) ** k, abs=0.02)


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("driver", ["kinematic", "hinge of a kinematic body"])
def test_a_kinematic_body_drives_a_gear(driver, setting):
    world = world_of(setting, FLOATING)
    crank, hinge_a = wheel(world, 0.0)
    (_, hinge_b), (_, hinge_c) = wheel(world, 100.0), wheel(world, 200.0)
    crank.set_kind("kinematic")
    first = world.add_joint(Gear(crank if driver == "kinematic" else hinge_a, hinge_b, ratio=2.0))
    world.add_joint(Gear(hinge_b, hinge_c, ratio=-1.0))
    crank.angular_velocity = 3.0
    run(world, 5.0)
    assert hinge_b.angle == pytest.approx(-crank.angle / 2.0, abs=1e-3) and crank.angle == pytest.approx(15.0)
    assert hinge_c.angle == pytest.approx(hinge_b.angle, abs=1e-3) and first.separation < 1e-3


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("ratio", [-2.0, 0.5, 1.0])
def test_a_gear_of_bodies_couples_their_angles(ratio, setting):
    """A gear between two free bodies couples their angles and keeps the linear momentum of the pair."""
    world = world_of(setting, FLOATING)
    a = world.add_body(Polygon.box(30, 10), angular_velocity=4.0, velocity=(10.0, 0.0))
    b = world.add_body(Circle(12.0), position=(80.0, 0.0), velocity=(0.0, -5.0))
    gear = world.add_joint(Gear(a, b, ratio=ratio))
    assert gear.joint_a is None and gear.body_a == a and gear.phase == 0.0
    run(world, 3.0)
    spin = a.inertia * 4.0 / (a.inertia + b.inertia / ratio**2)
    assert (a.angular_velocity, b.angular_velocity) == pytest.approx((spin, -spin / ratio), rel=1e-6)
    assert a.angle + ratio * b.angle == pytest.approx(0.0, abs=0.01)
    assert a.velocity == pytest.approx((10.0, 0.0)) and b.velocity == pytest.approx((0.0, -5.0))


def test_a_gear_takes_the_angle_of_a_wheel_and_a_groove_may_roll():
    """A gear can couple an Angle joint and a slider of the same body; the body then rolls in its groove without slip.

    A gear can also couple the angle of a Wheel joint.
    """
    world = World(EFFECTS)
    ball = world.add_body(Circle(10.0))
    slope = math.cos(0.5), math.sin(0.5)
    groove = world.add_joint(Prismatic(None, ball, at=(0.0, 0.0), axis=slope, turns=True))
    turning = world.add_joint(Angle(None, ball))
    gear = world.add_joint(Gear(turning, groove, ratio=-1.0 / 10.0))
    run(world, 0.5)
    assert groove.speed == pytest.approx(0.5 * G * slope[1] / 1.5, rel=1e-6), "a disc that rolls"
    assert ball.angular_velocity == pytest.approx(groove.speed / 10.0, rel=1e-9) and gear.body_a == gear.body_b == ball
    chassis = world.add_body(Polygon.box(40, 10), position=(300.0, 0.0))
    axle = world.add_joint(Wheel(chassis, world.add_body(Circle(5.0), position=(300.0, 20.0)), at=(300.0, 20.0)))
    assert world.add_joint(Gear(axle, turning)).phase == pytest.approx(ball.angle)


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("mass", [1.0, 10.0])
@pytest.mark.parametrize("tier", ["iterative", "auto"])
def test_a_geared_arm_that_swings_gains_no_energy(tier, mass, setting):
    world = world_of(setting, EFFECTS.with_(sleeping=False))
    world.joint_solver = tier
    upper = world.add_body(Polygon.box(64, 6), position=(32.0, 0.0))
    lower = world.add_body(Polygon.box(64, 6), position=(96.0, 0.0), mass=mass * upper.mass)
    shoulder = world.add_joint(Revolute(None, upper, at=(0.0, 0.0)))
    elbow = world.add_joint(Revolute(upper, lower, at=(64.0, 0.0)))
    gear = world.add_joint(Gear(shoulder, elbow, ratio=1.5))
    start, fall, most, worst = energy(world), (upper.mass + lower.mass) * G * 96.0, 0.0, 0.0
    for _ in range(round(SHARE * 600)):
        world.step()
        most, worst = max(most, energy(world) - start), max(worst, gear.separation)
    assert most <= 0.002 * fall and worst < (0.02 if setting[0] == "soft_step" else 0.35)


# --- pulleys ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("masses", [0.1, 0.5, 1.0, 2.0, 30.0])
@pytest.mark.parametrize("ratio", [0.5, 1.0, 3.0])
@pytest.mark.parametrize("rigid", [False, True])
def test_an_atwood_machine_has_its_acceleration_and_its_tension(rigid, ratio, masses, setting):
    """Body B of an Atwood machine falls by g (m - ratio) / (m + ratio²), where m is the mass of B over that of A.

    The rope holds back B with the force m_b (g - that acceleration).
    """
    world = world_of(setting)
    a = world.add_body(Circle(6.0), position=(0.0, 500.0), mass=10.0)
    b = world.add_body(Circle(6.0), position=(80.0, 400.0), mass=10.0 * masses)
    rope = world.add_joint(
        Pulley(a, b, at_a=(0, 500), at_b=(80, 400), ground_a=(0, 0), ground_b=(80, 0), ratio=ratio, rigid=rigid)
    )
    assert rope.length == 500.0 + 400.0 * ratio == rope.translation
    run(world, 0.4)
    falls = G * (masses - ratio) / (masses + ratio**2)
    assert b.velocity.y == pytest.approx(0.4 * falls, rel=1e-6, abs=1e-9)
    assert a.velocity.y == pytest.approx(-0.4 * ratio * falls, rel=1e-6, abs=1e-9)
    assert rope.force == pytest.approx(b.mass * (G - falls), rel=1e-6) and rope.separation < 0.3


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("rigid", [False, True])
def test_a_rope_over_pulleys_is_slack_until_it_is_taut_unless_it_is_rigid(rigid, setting):
    world = world_of(setting)
    a = world.add_body(Circle(6.0), position=(0.0, 100.0))
    world.add_body(Polygon.box(60, 20), position=(0.0, 116.0), kind="static")
    b = world.add_body(Circle(6.0), position=(80.0, 60.0), mass=0.5 * a.mass)
    rope = world.add_joint(
        Pulley(a, b, at_a=(0, 100), at_b=(80, 60), ground_a=(0, 0), ground_b=(80, 0), length=200, rigid=rigid)
    )
    run(world, 0.25)
    fallen = b.position.y - 60.0
    assert (fallen == pytest.approx(0.5 * G * 0.25**2, rel=0.1)) is not rigid
    run(world, 4.0)
    assert b.position.y == pytest.approx(100.0, abs=0.3) and a.position.y == pytest.approx(100.0, abs=0.3)
    assert rope.force == pytest.approx(b.mass * G, rel=1e-3), "A rests, B hangs"
    assert not a.awake and not b.awake
    rope.length = 160.0
    run(world, 3.0)
    assert rope.translation == pytest.approx(160.0, abs=0.3) and b.position.y == pytest.approx(60.0, abs=0.5)


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("angle", [0.2, 0.5, 1.0])
def test_a_body_on_a_rope_over_pulleys_swings_as_a_pendulum(angle, setting):
    """A body on a rope over pulleys swings as a pendulum if the body at the other end is very heavy and rests."""
    world = world_of(setting)
    world.add_body(Polygon.box(60, 20), position=(-100.0, 220.0), kind="static")
    a = world.add_body(Circle(10.0), position=(-100.0, 200.0), mass=1e5)
    at = 100.0 * math.sin(angle), 100.0 * math.cos(angle)
    bob = world.add_body(Circle(6.0), position=at)
    world.add_joint(Pulley(a, bob, at_a=(-100, 200), at_b=at, ground_a=(-100, 0), ground_b=(0, 0)))
    crossings, before = [], bob.position.x
    while len(crossings) < 3:
        world.step()
        now = bob.position.x
        if before > 0.0 >= now:
            crossings.append(world.time + now / (before - now) * world.dt)
        before = now
        assert world.time < 20.0
    period = 2.0 * math.pi * math.sqrt(100.0 / G) * (1.0 + angle**2 / 16.0 + 11.0 * angle**4 / 3072.0)
    assert (crossings[2] - crossings[0]) / 2.0 == pytest.approx(period, rel=0.02)


@pytest.mark.parametrize("setting", SETTINGS)
def test_a_swinging_atwood_machine_gains_no_energy(setting):
    world = world_of(setting, EFFECTS.with_(sleeping=False))
    a = world.add_body(Circle(6.0), position=(0.0, 300.0), mass=30.0)
    b = world.add_body(Circle(6.0), position=(250.0, 150.0), mass=10.0)
    rope = world.add_joint(Pulley(a, b, at_a=(0, 300), at_b=(250, 150), ground_a=(0, 0), ground_b=(100, 0)))
    start, most, apart = energy(world), 0.0, 0.0
    for _ in range(round(SHARE * 600)):
        world.step()
        most, apart = max(most, energy(world) - start), max(apart, abs(rope.separation))
    assert most <= 0.002 * 40.0 * G * 200.0
    assert apart < (0.2 if setting[0] == "soft_step" else 2.0), "0.10 and 1.56 px in the whole run"


def test_a_pulley_to_the_world_is_a_rope_of_that_length():
    world = World(EFFECTS)
    ball = world.add_body(Circle(6.0), position=(0.0, 50.0))
    rope = world.add_joint(Pulley(None, ball, at_a=(-40, 30), at_b=(0, 50), ground_a=(-40, 0), ground_b=(0, 0)))
    run(world, 1.0)
    assert ball.position.y == pytest.approx(50.0, abs=0.1) and rope.force == pytest.approx(ball.mass * G, rel=1e-3)


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("mass", [2.0, 50.0, 1000.0])
@pytest.mark.parametrize("ratio", [0.5, 1.0, 2.0])
def test_a_light_body_stops_at_its_pulley_and_holds_the_heavy_one(ratio, mass, setting):
    world = world_of(setting)
    a = world.add_body(Circle(6.0), position=(0.0, 100.0), mass=ratio)
    b = world.add_body(Circle(6.0), position=(80.0, 100.0), mass=mass * ratio**2)
    rope = world.add_joint(Pulley(a, b, at_a=(0, 100), at_b=(80, 100), ground_a=(0, 0), ground_b=(80, 0), ratio=ratio))
    run(world, 4.0)
    end, sag = 100.0 + 100.0 / ratio, 0.01 if setting[0] == "soft_step" else 0.1
    assert b.position.y == pytest.approx(end, abs=sag) and a.position.y == pytest.approx(0.0, abs=0.01)
    assert rope.force == pytest.approx(b.mass * G, rel=1e-3) and not b.awake and not a.awake
    b.velocity = 0.0, -100.0
    highest, most = end, 100.0**2 / (2.0 * G) * mass / (mass - 1.0)  # by energy, while A falls
    for _ in range(240):
        world.step()
        highest = min(highest, b.position.y)
    assert highest > end - most - 1.0 and b.position.y == pytest.approx(end, abs=sag)


# --- ratchets ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("ratchet", [-0.7, -0.1, 0.05, 0.3, 1.0])
@pytest.mark.parametrize("phase", [0.0, 0.23, -1.0])
def test_a_ratchet_turns_one_way_and_holds_at_its_teeth(phase, ratchet, setting):
    world = world_of(setting, FLOATING)
    disc, _ = wheel(world, 0.0)
    joint = world.add_joint(Ratchet(None, disc, phase=phase, ratchet=ratchet))
    way, torque = math.copysign(1.0, ratchet), 20.0 * disc.inertia
    disc.angular_velocity = 2.0 * way
    run(world, 1.0)
    assert disc.angle == pytest.approx(2.0 * way, rel=1e-6), "free in its direction"
    disc.angular_velocity = 0.0
    tooth = phase + math.floor((disc.angle - phase) / ratchet) * ratchet
    for _ in range(90):
        disc.apply_torque(-way * torque)
        world.step()
    assert disc.angle == pytest.approx(tooth, abs=0.02) and joint.limits[0 if way > 0 else 1] == pytest.approx(tooth)
    assert abs(disc.angular_velocity) < 1e-3 and joint.torque == pytest.approx(way * torque, rel=1e-3)
    for _ in range(30):
        disc.apply_torque(way * torque)
        world.step()
    assert way * disc.angle > way * tooth + 1.0, "and on again"


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("teeth", [7, 24, 200])
def test_a_ratchet_holds_the_lift_of_a_crank(teeth, setting):
    """A ratchet holds an arm, pushed up at intervals, on the last tooth that it has passed."""
    world = world_of(setting)
    arm = world.add_body(Polygon.box(60, 6), position=(30.0, 0.0))
    hinge = world.add_joint(Revolute(None, arm, at=(0.0, 0.0)))
    joint, tooth = world.add_joint(Ratchet(None, arm, ratchet=-2.0 * math.pi / teeth)), 2.0 * math.pi / teeth
    lifted, speed = 0, 3.9 if teeth == 7 else 2.4
    while hinge.angle > -0.6:
        arm.angular_velocity = -speed
        x, y = arm.position
        arm.velocity = speed * y, -speed * x
        least = 0.0
        for _ in range(240):
            world.step()
            least = min(least, hinge.angle)
        lifted += 1
        assert hinge.angle == pytest.approx(joint.limits[1], abs=0.02) and hinge.angle < least + tooth + 0.02
    assert lifted <= 3


@pytest.mark.parametrize("setting", SETTINGS)
def test_a_fast_ratchet_passes_many_teeth_in_a_step(setting):
    world = world_of(setting, FLOATING)
    disc, _ = wheel(world, 0.0, angular_velocity=40.0)
    joint = world.add_joint(Ratchet(None, disc, ratchet=0.01))
    run(world, 1.0)
    assert disc.angle == pytest.approx(40.0, rel=1e-6)
    disc.angular_velocity = -40.0
    run(world, 0.5)
    assert disc.angle == pytest.approx(40.0, abs=0.02) and joint.limits[0] == pytest.approx(40.0, abs=0.011)
