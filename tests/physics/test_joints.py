"""Joints against closed forms: pendulums, slides, springs, motors, ropes, welds and suspensions."""

import math

import pytest

from physics import (
    Angle,
    Circle,
    Distance,
    Drive,
    Effects,
    Motor,
    NoContact,
    Polygon,
    Prismatic,
    Revolute,
    Spring,
    Target,
    Weld,
    Wheel,
    World,
)

EFFECTS = Effects.rigid_bodies().with_(joints=True)
FLOATING = EFFECTS.with_(gravity=False)
G = 9.8 * 32.0
SETTINGS = [("soft_step", 4), ("soft_step", "auto"), ("sequential_impulse", "auto")]
SUBSTEPS = [4, 16, "auto"]


def world_of(setting=("soft_step", "auto"), effects=EFFECTS, **more):
    solver, substeps = setting
    return World(effects, solver=solver, substeps=substeps, **more)


def run(world, seconds):
    for _ in range(round(seconds / world.dt)):
        world.step()


def arithmetic_geometric_mean(a, b):
    while abs(a - b) > 1e-15 * a:
        a, b = (a + b) / 2.0, math.sqrt(a * b)
    return a


def pendulum_period(length, amplitude):
    """Return the period [s] of a point mass on a rod under gravity, for any amplitude [rad]."""
    return 2.0 * math.pi * math.sqrt(length / G) / arithmetic_geometric_mean(1.0, math.cos(amplitude / 2.0))


@pytest.mark.parametrize("substeps", SUBSTEPS)
@pytest.mark.parametrize("amplitude", [0.1 * k for k in range(1, 21, 3)])
@pytest.mark.parametrize("kind", ["rod", "pin"])
def test_a_pendulum_keeps_its_period_and_its_energy(kind, amplitude, substeps):
    world, length = world_of(("soft_step", substeps)), 100.0
    x, y = length * math.sin(amplitude), length * math.cos(amplitude)
    bob = world.add_body(Circle(6.0), position=(x, y))
    if kind == "rod":
        joint, period = (
            world.add_joint(Distance(None, bob, at_a=(0, 0), at_b=(x, y))),
            pendulum_period(length, amplitude),
        )
    else:
        joint = world.add_joint(Revolute(None, bob, at=(0, 0)))
        period = pendulum_period(length + bob.inertia / (bob.mass * length), amplitude)
    fall = G * length * (1.0 - math.cos(amplitude))
    crossings, before, worst, energies = [], x, 0.0, []
    while len(crossings) < 5:
        world.step()
        (at, low), (vx, vy) = bob.center, bob.velocity
        if before > 0.0 >= at:
            crossings.append(world.time + at / (before - at) * world.dt)
        before, worst = at, max(worst, joint.separation)
        own = 0.5 * bob.inertia / bob.mass * bob.angular_velocity**2 if kind == "pin" else 0.0
        energies.append((0.5 * (vx * vx + vy * vy) + own + G * (length - low)) / fall)
        assert world.time < 60.0
    assert (crossings[-1] - crossings[0]) / 4.0 == pytest.approx(period, rel=2e-3)
    assert 0.97 < min(energies) <= max(energies) < 1.03
    assert worst < 0.0005 * length


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("angle", [math.radians(a) for a in (10, 35, 60, 80)])
def test_a_slide_falls_along_its_axis_and_stops_at_its_limit(angle, setting):
    world = world_of(setting)
    axis = math.cos(angle), math.sin(angle)
    box = world.add_body(Polygon.box(20, 10), angle=0.3)
    slide = world.add_joint(Prismatic(None, box, at=(0, 0), axis=axis, limits=(-50.0, 60.0)))
    run(world, 0.25)
    step = world.dt if setting[0] == "sequential_impulse" else world.dt / 4.0
    low = 0.5 * G * math.sin(angle) * 0.25**2
    assert 0.999 * low < slide.translation < 1.001 * (low + 0.5 * G * math.sin(angle) * 0.25 * step)
    assert slide.speed == pytest.approx(G * math.sin(angle) * 0.25, rel=0.01)
    most = 0.0
    for _ in range(120):
        world.step()
        most = max(most, slide.translation)
        assert slide.separation < 0.02 and abs(box.angle - 0.3) < 1e-3
    assert most < 60.0 + 0.16 and slide.translation == pytest.approx(60.0, abs=0.1), "no bounce, no sag"
    assert abs(slide.speed) < 0.1


@pytest.mark.parametrize("hertz", [0.5, 1.0, 2.0, 4.0])
@pytest.mark.parametrize("substeps", SUBSTEPS)
def test_a_spring_has_its_period_and_a_critical_one_does_not_overshoot(hertz, substeps):
    for damping in (0.0, 1.0):
        world = world_of(("soft_step", substeps), FLOATING)
        box = world.add_body(Polygon.box(20, 20), position=(100.0, 0.0))
        world.add_joint(Distance(None, box, at_a=(0, 0), at_b=(100, 0), spring=Spring(hertz, damping, target=80.0)))
        crossings, before, least = [], 20.0, 20.0
        while world.time < 3.2 / hertz:
            world.step()
            now = box.position.x - 80.0
            if before > 0.0 >= now:
                crossings.append(world.time + now / (before - now) * world.dt)
            before, least = now, min(least, now)
        if damping == 0.0:
            assert crossings[1] - crossings[0] == pytest.approx(1.0 / hertz, rel=0.02)
        else:
            assert least > -0.05, "critically damped"
            assert box.position.x == pytest.approx(80.0, abs=0.16), "it may sleep within the slop"


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("hertz", [0.5, 1.0, 2.0])
@pytest.mark.parametrize(
    ("place", "tier"),
    # Iterations do not converge within a substep where the hinge is far outside the leaf.
    [(0.0, "iterative"), (10.0, "iterative"), (30.0, "iterative"), *((x, "direct") for x in (0.0, 10.0, 30.0, 90.0))],
)
@pytest.mark.parametrize("held", ["world", "free body"])
def test_a_sprung_door_has_its_period_and_a_critical_one_does_not_overshoot(held, place, hertz, tier, setting):
    """A spring door has its natural period, and does not overshoot if it is critically damped.

    This holds for a hinge on the leaf or beyond it, and for a frame that can move.
    """
    for damping in (0.0, 1.0):
        world = world_of(setting, FLOATING)
        world.joint_solver = tier
        leaf = world.add_body(Polygon.box(60, 6), position=(place, 0.0))
        frame = None if held == "world" else world.add_body(Polygon.box(40, 10), position=(-20.0, 5.0))
        hinge = world.add_joint(Revolute(frame, leaf, at=(0, 0), spring=Spring(hertz, damping, target=-0.8)))
        crossings, before, least = [], 0.8, 0.8
        while world.time < 3.2 / hertz:
            world.step()
            now = hinge.angle + 0.8
            if before > 0.0 >= now:
                crossings.append(world.time + now / (before - now) * world.dt)
            before, least = now, min(least, now)
        if damping == 0.0:
            period = crossings[1] - crossings[0]
            # The inertia of two free bodies changes with the angle; a whole step integrates 2 Hz to 2 %.
            room = 0.05 if frame or setting[0] == "sequential_impulse" else 0.02
            assert period * hertz == pytest.approx(1.0, rel=room)
        else:
            assert least > -0.8 * 0.005, "critically damped"
            assert hinge.angle == pytest.approx(-0.8, abs=0.01)


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize(("at", "tier"), [(0.0, "iterative"), (8.0, "iterative"), (8.0, "direct"), (40.0, "direct")])
def test_a_sprung_slider_has_its_period_wherever_its_anchor_is(at, tier, setting):
    world = world_of(setting, FLOATING)
    world.joint_solver = tier
    box = world.add_body(Polygon.box(20, 20))
    slide = world.add_joint(Prismatic(None, box, at=(0.0, at), axis=(1, 0), spring=Spring(1.0, 0.0, target=15.0)))
    crossings, before = [], -15.0
    while world.time < 3.2:
        world.step()
        now = slide.translation - 15.0
        if before < 0.0 <= now:
            crossings.append(world.time - now / (now - before) * world.dt)
        before = now
    assert crossings[1] - crossings[0] == pytest.approx(1.0, rel=0.02)
    assert abs(box.angle) < (1e-2 if tier == "iterative" else 1e-3)


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("speed", [-8.0, -1.0, 0.5, 3.0, 20.0])
def test_a_motor_reaches_its_speed_with_no_more_than_its_torque(speed, setting):
    world = world_of(setting, FLOATING)
    disc = world.add_body(Circle(20.0))
    most = 4.0 * disc.inertia  # [1/s2] of acceleration: 4 rad/s2
    hinge = world.add_joint(Revolute(None, disc, at=(0, 0), motor=Drive(speed, max=most)))
    run(world, 0.1)
    assert disc.angular_velocity == pytest.approx(math.copysign(min(0.4, abs(speed)), speed), rel=0.02)
    assert abs(hinge.torque) <= most * (1.0 + 1e-9)
    run(world, abs(speed) / 4.0 + 0.2)
    assert hinge.speed == pytest.approx(speed, rel=1e-3)
    hinge.motor = Drive(-speed, max=1e3 * most)
    world.step()
    assert disc.angular_velocity == pytest.approx(-speed, rel=1e-3)


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("pull", [0.3, 1.0, 3.0])
def test_a_rope_is_slack_until_it_is_taut(pull, setting):
    world = world_of(setting)
    ball = world.add_body(Circle(5.0), position=(0.0, 10.0))
    rope = world.add_joint(Distance(None, ball, at_a=(0, 0), at_b=(0, 10), limits=(0.0, 10.0 + 30.0 * pull)))
    fall = math.sqrt(2.0 * 30.0 * pull / G)
    run(world, 0.5 * fall)
    assert ball.velocity.y == pytest.approx(G * world.time, rel=1e-6), "slack"
    run(world, 1.0)
    assert ball.position.y == pytest.approx(10.0 + 30.0 * pull, abs=0.1)
    assert rope.force == pytest.approx(ball.mass * G, rel=1e-3)


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("angle", [0.0, 0.4, 1.1, 2.5])
def test_welded_bodies_move_as_one(angle, setting):
    world = world_of(setting, FLOATING)
    a = world.add_body(Polygon.box(20, 10), position=(0, 0), angle=angle)
    b = world.add_body(Circle(8.0), position=(14.0, 3.0))
    weld = world.add_joint(Weld(a, b, at=(8.0, 1.0)))
    b.apply_impulse((300.0 * b.mass, 120.0 * b.mass), (14.0, 9.0))
    momentum = [a.mass * a.velocity[k] + b.mass * b.velocity[k] for k in (0, 1)]

    def spin():
        total = 0.0
        for body in (a, b):
            (x, y), (vx, vy) = body.center, body.velocity
            total += body.inertia * body.angular_velocity + body.mass * (x * vy - y * vx)
        return total

    about = spin()
    run(world, 1.0)
    assert [a.mass * a.velocity[k] + b.mass * b.velocity[k] for k in (0, 1)] == pytest.approx(momentum, rel=1e-9)
    assert spin() == pytest.approx(about, rel=6e-3 if setting[0] == "sequential_impulse" else 1e-3)
    assert a.angular_velocity == pytest.approx(b.angular_velocity, rel=1e-6)
    assert weld.separation < (0.15 if setting[0] == "sequential_impulse" else 0.05) and abs(weld.angle) < 0.01


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("hertz", [1.0, 2.0, 3.0, 5.0])
def test_a_suspension_sags_by_its_load(hertz, setting):
    """A wheel on the ground carries a chassis on a spring, which sags by m g / k."""
    world = world_of(setting)
    world.add_body(Polygon.box(400, 20), position=(0, 40), kind="static")
    wheel = world.add_body(Circle(10.0), position=(0, 20), mass=1e6)
    chassis = world.add_body(Polygon.box(20, 10), mass=100.0, fixed_rotation=True)
    joint = world.add_joint(Wheel(chassis, wheel, at=(0, 20), spring=Spring(hertz, 1.0), limits=(-200, 200)))
    world.add_joint(Prismatic(None, chassis, at=(0, 0), axis=(0, 1), turns=True))
    run(world, 6.0 / hertz + 1.0)
    assert -joint.translation == pytest.approx(G / (2.0 * math.pi * hertz) ** 2, rel=0.01)


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("force", [0.25, 0.5, 0.9])
def test_a_friction_joint_brakes_with_its_force(force, setting):
    world = world_of(setting, FLOATING)
    box = world.add_body(Polygon.box(10, 10), velocity=(120.0, 0.0))
    world.add_joint(Motor(None, box, max_force=force * box.mass * G, max_torque=0.0))
    run(world, 0.2)
    assert box.velocity.x == pytest.approx(120.0 - 0.2 * force * G, rel=0.01)
    run(world, 2.0)
    assert abs(box.velocity.x) < 1e-6


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("seed", range(4))
def test_a_body_is_drawn_to_its_target_and_does_not_overshoot(seed, setting):
    world = world_of(setting)
    start, goal = (10.0 * seed, -7.0 * seed), (60.0, 30.0 - 20.0 * seed)
    box = world.add_body(Polygon.box(16, 16), position=start)
    drag = world.add_joint(Target(box, at=start, point=goal, spring=Spring(5.0, 1.0)))
    way = math.dist(start, goal)
    beyond = 0.0
    sag = G / (2.0 * math.pi * 5.0) ** 2
    for _ in range(120):
        world.step()
        along = sum((box.position[k] - start[k]) * (goal[k] - start[k]) for k in (0, 1)) / way
        beyond = max(beyond, along - way)
    assert beyond < 0.05 * way + sag
    assert math.dist(box.position, goal) == pytest.approx(sag, rel=0.05)
    drag.point = (0.0, 0.0)
    run(world, 2.0)
    assert math.dist(box.position, (0.0, 0.0)) == pytest.approx(sag, rel=0.05)


@pytest.mark.parametrize("setting", SETTINGS)
def test_bodies_of_a_joint_pass_through_each_other_unless_contacts_are_asked_for(setting):
    for contacts in (False, True):
        world = world_of(setting, FLOATING)
        a = world.add_body(Polygon.box(20, 20), kind="static")
        b = world.add_body(Polygon.box(20, 20), position=(30.0, 0.0), velocity=(-60.0, 0.0))
        joint = world.add_joint(NoContact(a, b, contacts=contacts))
        run(world, 0.5)
        assert (b.position.x < 10.0) is not contacts
        if not contacts:
            joint.remove()
            b.move_to((30.0, 0.0))
            b.velocity = -60.0, 0.0
            run(world, 0.5)
            assert b.position.x > 19.0, "removed: they touch again"


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("kind", ["hinge", "angle"])
@pytest.mark.parametrize("limits", [(-0.5, 0.5), (0.0, 1.2), (-2.0, -0.3), (0.4, 0.4)])
def test_an_angle_stays_within_its_limits(limits, kind, setting):
    world = world_of(setting)
    bar = world.add_body(Polygon.box(60, 6), position=(30.0, 0.0))
    if kind == "hinge":
        joint = world.add_joint(Revolute(None, bar, at=(0, 0), limits=limits))
    else:
        world.add_joint(Revolute(None, bar, at=(0, 0)))
        joint = world.add_joint(Angle(None, bar, limits=limits))
    run(world, 1.0)
    for _ in range(120):
        world.step()
        assert limits[0] - 0.01 < joint.angle < limits[1] + 0.01
    assert joint.angle == pytest.approx(min(max(math.pi / 2, limits[0]), limits[1]), abs=0.01)


# --- both tiers -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("tier", ["iterative", "direct"])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_a_slider_is_free_up_to_its_limit(side, tier, setting):
    world = world_of(setting, FLOATING)
    world.joint_solver = tier
    box = world.add_body(Polygon.box(10, 10), velocity=(60.0 * side, 0.0))
    slider = world.add_joint(Prismatic(None, box, at=(0, 0), limits=(-50, 50)))
    run(world, 0.5)
    assert slider.translation == pytest.approx(30.0 * side, rel=1e-6) and slider.force < 1e-6
    run(world, 0.5)
    assert slider.translation == pytest.approx(50.0 * side, abs=0.05)


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("tier", ["iterative", "direct"])
@pytest.mark.parametrize("ratio", [0.5, 1.0, 3.0])
def test_the_motor_of_a_wheel_turns_both_bodies(ratio, tier, setting):
    """Without other torques the angular velocities differ by the motor's speed, in inverse ratio of the inertias."""
    world = world_of(setting, FLOATING)
    world.joint_solver = tier
    wheel, chassis = world.add_body(Circle(10.0), mass=1.0), world.add_body(Circle(10.0), mass=ratio)
    world.add_joint(Wheel(chassis, wheel, at=(0, 0), motor=Drive(4.0, max=1e6)))
    run(world, 0.2)
    assert wheel.angular_velocity == pytest.approx(4.0 * ratio / (1.0 + ratio), rel=1e-6)
    assert chassis.angular_velocity == pytest.approx(-4.0 / (1.0 + ratio), rel=1e-6)


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("tier", ["iterative", "direct"])
@pytest.mark.parametrize("angle", [0.0, 0.7, 2.0, 3.6, 5.0])
def test_the_reported_force_holds_the_weight_in_every_direction(angle, tier, setting):
    pull = (G * math.cos(angle), G * math.sin(angle))
    world = world_of(setting, EFFECTS.with_(sleeping=False), gravity=pull)
    world.joint_solver = tier
    box = world.add_body(Polygon.box(10, 10))
    world.add_joint(Weld(None, box, at=(0, 0)))
    run(world, 0.5)
    row = world.joints[0]
    assert (row["force_x"], row["force_y"]) == pytest.approx(
        (-box.mass * pull[0], -box.mass * pull[1]), rel=1e-3, abs=1
    )
