"""Machines on joints (section N): cranks, gears, lifts, walkers, cars and ragdolls, checked against closed forms."""

import math

import numpy as np
import pytest

from physics import Circle, Distance, Drive, Filter, Gear, Material, Polygon, Prismatic, Revolute, Spring, Wheel
from tests.stability.jointed import ALONE, GRAVITY, Gaps, Worst, jointed, named, rod, run, stairs
from tests.stability.piles import SOLVERS, floor, needs_speed, on_slope
from tests.stability.settings import phase

GRIP = Material(friction=0.9)
APART = Filter(2, 1)  # parts of a machine, which touch the ground alone


class Crank:
    """A crank of 0.3 m, driven at 2.03 turns/s from a start angle, that moves a piston through a rod of 1 m."""

    RADIUS, LENGTH = 0.3, 1.0

    def __init__(self, world, turn):
        self.turn = turn
        wheel = world.add_body(Circle(0.4), filter=ALONE, mass=5.0)
        self.hinge = world.add_joint(Revolute(None, wheel, at=(0.0, 0.0)))
        pin = self.RADIUS * math.cos(turn), self.RADIUS * math.sin(turn)
        head = self.place(), 0.0
        link = rod(world, pin, head, 0.06)
        self.piston = world.add_body(Polygon.box(0.3, 0.3), position=head, filter=ALONE)
        world.add_joint(Revolute(wheel, link, at=pin))
        world.add_joint(Revolute(link, self.piston, at=head))
        world.add_joint(Prismatic(None, self.piston, at=head, axis=(1.0, 0.0)))
        self.hinge.motor = Drive(2.0 * math.pi * 2.03, max=1e5)

    def place(self):
        """Return the exact piston position for the present crank angle: r cos a + sqrt(l² - r² sin² a)."""
        angle = self.turn + (self.hinge.angle if hasattr(self, "piston") else 0.0)
        return self.RADIUS * math.cos(angle) + math.sqrt(self.LENGTH**2 - (self.RADIUS * math.sin(angle)) ** 2)


def turn_crank(measured, solver, seconds, name=""):
    world = jointed(solver)
    turn = 0.0 if name else phase(2.0 * math.pi)
    crank, off, least, most = Crank(world, turn), Worst(), math.inf, -math.inf
    for _ in range(round(seconds / world.dt)):
        world.step()
        x = crank.piston.position.x
        off(abs(x - crank.place()))
        least, most = min(least, x), max(most, x)
    stroke = 2.0 * crank.RADIUS
    measured("N9", named("error of the piston's place, of the stroke", solver), off.value / stroke)
    measured("N9", named("error of the stroke", solver), abs((most - least) / stroke - 1.0))
    measured("N9", f"turns{name}", crank.hinge.angle / (2.0 * math.pi))


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_n9_a_slider_crank_keeps_its_stroke(measured, solver):
    turn_crank(measured, solver, 10.0)


@needs_speed
def test_n9_a_slider_crank_keeps_its_stroke_for_a_thousand_turns(measured):
    turn_crank(measured, "soft_step", 494.0, ", the long run")


def geared(solver):
    """Return (world, hinges) of three geared wheels: B turns half as fast as A, C at two thirds of B.

    The motor brings A to ten turns a second within one second.
    """
    world = jointed(solver)
    wheels = [world.add_body(Circle(0.2 * (k + 1)), position=(k, 0), angle=phase(6), filter=ALONE) for k in range(3)]
    hinges = [world.add_joint(Revolute(None, wheel, at=wheel.position)) for wheel in wheels]
    world.add_joints(Gear, hinges[:1], hinges[1:2], ratio=2.0)
    world.add_joints(Gear, hinges[1:2], hinges[2:], ratio=-1.5)
    felt, speed = wheels[0].inertia + wheels[1].inertia / 4.0 + wheels[2].inertia / 9.0, 20.0 * math.pi
    hinges[0].motor = Drive(speed, max=speed * felt)
    return world, hinges


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_n10_gears_keep_their_ratio_over_a_thousand_turns(measured, solver):
    world, (a, b, c) = geared(solver)
    off, step = Worst(), 0
    for step in range(1, 6061):
        world.step()
        if step % 20 == 0 or step < 100:
            off(max(abs(a.angle + 2.0 * b.angle), abs(b.angle - 1.5 * c.angle)))
    measured("N10", "turns", a.angle / (2.0 * math.pi))
    measured("N10", "error of the ratios", max(abs(2.0 * b.angle / a.angle + 1.0), abs(3.0 * c.angle / a.angle + 1.0)))
    measured("N10", named("greatest error of an angle", solver), off.value)


def lift(world, stages, turn):
    """Add a scissor lift of 1 m arms at an angle `turn` [rad]. Return (slide, platform, arms); the foot slides on the
    ground.
    """
    c, s = math.cos(turn), math.sin(turn)
    arms, before, slide = [], None, None
    for k in range(stages):
        low, high = -k * s, -(k + 1) * s
        up, down = rod(world, (0.0, low), (c, high), 0.05), rod(world, (0.0, high), (c, low), 0.05)
        world.add_joint(Revolute(up, down, at=(c / 2, (low + high) / 2)))
        if before:
            world.add_joint(Revolute(before[1], up, at=(0.0, low)))
            world.add_joint(Revolute(before[0], down, at=(c, low)))
        else:
            world.add_joint(Revolute(None, up, at=(0.0, 0.0)))
            foot = world.add_body(Circle(0.05), position=(c, 0.0), filter=ALONE)
            slide = world.add_joint(Prismatic(None, foot, at=(c, 0.0), axis=(1.0, 0.0)))
            world.add_joint(Revolute(foot, down, at=(c, 0.0)))
        before = up, down
        arms += before
    end = -stages * s
    top = world.add_body(Polygon.box(c, 0.1), position=(c / 2, end), mass=arms[0].mass, filter=ALONE)
    world.add_joint(Revolute(before[1], top, at=(0.0, end)))
    world.add_joint(Prismatic(top, before[0], at=(c, end), axis=(1.0, 0.0), turns=True))
    return slide, top, arms


@needs_speed
@pytest.mark.parametrize(
    ("stages", "tier", "solver"),
    [(stages, tier, "soft_step") for stages in (3, 8) for tier in ("auto", "direct")]
    + [(3, "direct", "sequential_impulse")],
)
def test_n11_a_scissor_lift_rises_as_its_foot_moves_in(measured, stages, tier, solver):
    """The platform of an n-stage lift with arms of length l is n sqrt(l² - x²) high for a foot at x.

    The motor force follows from virtual work: it is the weight of all bodies times dh/dx of their heights.
    """
    world, turn = jointed(solver, tier=tier), 0.5 + phase(0.5)
    slide, top, arms = lift(world, stages, turn)
    start, off, gaps, gap = math.cos(turn), Worst(), Gaps(world), Worst()

    def watch():
        off(abs(-top.position.y / stages - math.sqrt(max(1.0 - (start + slide.translation) ** 2, 0.0))))
        gap(gaps.worst())

    slide.motor = Drive(-0.1, max=1e6)
    run(world, 2.0, watch)
    slide.motor = Drive(0.0, max=1e6)
    run(world, 2.0, watch)
    name = f", {stages} stages" + (f", {tier}" if tier != "auto" else "")
    measured("N11", named(f"error of the height, of a stage{name}", solver), off.value)
    measured("N11", named(f"greatest gap{name}", solver), gap.value)
    if stages == 3 and solver == "soft_step" and tier == "auto":
        x = start + slide.translation
        lifted = sum(arm.mass for arm in arms) * stages / 2.0 + top.mass * stages
        force = GRAVITY * lifted * x / math.sqrt(1.0 - x * x)
        measured("N11", "error of the motor's force, 3 stages", abs(abs(slide_force(world, slide)) / force - 1.0))


def slide_force(world, slide):
    """Return the x component of a slider's joint force."""
    return float(world.joints["force_x"][world.joints["id"] == slide.id][0])


POINTS = {  # of Theo Jansen's leg in Box2D's sample, a quarter of the size, y downwards; the crank's pin is the hub
    name: (x / 4.0, -y / 4.0)
    for name, (x, y) in {
        "heel": (5.4, -6.1),
        "shin": (7.2, -1.2),
        "ankle": (4.3, -1.9),
        "pivot": (3.1, 0.8),
        "crest": (6.0, 1.5),
        "tip": (2.5, 3.7),
        "hub": (0.0, -0.8),
    }.items()
}


def length_of(one, two):
    """Return the distance between two named points of a leg."""
    return math.dist(POINTS[one], POINTS[two])


def meet(center, radius, other, far, like):
    """Return the point at the distance `radius` from `center` and at the distance `far` from `other`.

    There are two such points; `like` selects one. like: names in POINTS of three points that lie as `center`, `other`
    and the wanted point.
    """
    (ax, ay), (bx, by), apart = center, other, math.dist(center, other)
    u = (radius**2 - far**2 + apart**2) / (2.0 * apart)
    v = math.sqrt(radius**2 - u**2)
    one, two, three = (POINTS[name] for name in like)
    if (two[0] - one[0]) * (three[1] - one[1]) < (two[1] - one[1]) * (three[0] - one[0]):
        v = -v
    ex, ey = (bx - ax) / apart, (by - ay) / apart
    return ax + u * ex - v * ey, ay + u * ey + v * ex


def linkage(turn):
    """Return {name: (x, y)} of the right leg's points relative to the axle, for a crank angle [rad]."""
    (x, y), pivot = POINTS["hub"], POINTS["pivot"]
    hub = math.cos(turn) * x - math.sin(turn) * y, math.sin(turn) * x + math.cos(turn) * y
    tip = meet(pivot, length_of("pivot", "tip"), hub, length_of("tip", "hub"), ("pivot", "hub", "tip"))
    crest = meet(pivot, length_of("pivot", "crest"), tip, length_of("crest", "tip"), ("pivot", "tip", "crest"))
    ankle = meet(pivot, length_of("pivot", "ankle"), hub, length_of("ankle", "hub"), ("pivot", "hub", "ankle"))
    shin = meet(crest, length_of("crest", "shin"), ankle, length_of("shin", "ankle"), ("crest", "ankle", "shin"))
    heel = meet(ankle, length_of("ankle", "heel"), shin, length_of("heel", "shin"), ("ankle", "shin", "heel"))
    return {"hub": hub, "pivot": pivot, "tip": tip, "crest": crest, "ankle": ankle, "shin": shin, "heel": heel}


def leg(world, side, turn, chassis, wheel, at):
    """Add a leg whose crank is at the angle `turn`, and return its foot, a body with its origin at the heel.

    side: 1 for a right leg, -1 for a left one.
    """
    points = {name: (at[0] + side * x, at[1] + y) for name, (x, y) in linkage(turn).items()}

    def body(names, **more):
        x, y = points[names[0]]
        shape = Polygon([(points[name][0] - x, points[name][1] - y) for name in names])
        return world.add_body(shape, position=(x, y), filter=APART, **more)

    foot, knee = body(("heel", "shin", "ankle"), material=GRIP), body(("pivot", "crest", "tip"))
    rods = (foot, knee, "shin", "crest"), (foot, knee, "ankle", "pivot"), (foot, wheel, "ankle", "hub")
    for a, b, one, two in (*rods, (knee, wheel, "tip", "hub")):
        world.add_joint(Distance(a, b, at_a=points[one], at_b=points[two]))
    world.add_joint(Revolute(knee, chassis, at=points["pivot"]))
    return foot


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_n12_theo_jansens_walker_keeps_its_gait(measured, solver):
    """Theo Jansen's walker of six legs runs at 2 rad/s for 10 s.

    Each heel stays where the circles of its rods intersect.
    """
    world = jointed(solver)
    ground, open_to_all = Polygon.box(100.0, 1.0), Filter(1, 2)
    world.add_body(ground, position=(0.0, 0.5), kind="static", filter=open_to_all, material=GRIP)
    turns = [phase(2.0 * math.pi / 3.0) + k * 2.0 * math.pi / 3.0 for k in range(3)]
    at = 0.0, -max(linkage(side * turn)["heel"][1] for turn in turns for side in (-1.0, 1.0))
    chassis = world.add_body(Polygon.box(1.25, 0.5), position=at, filter=APART)
    wheel = world.add_body(Circle(0.4), position=at, filter=APART)
    axle = world.add_joint(Revolute(chassis, wheel, at=at, motor=Drive(2.0, max=1e4)))
    sides = (-1.0, 1.0)
    legs = [(s, s * turn, leg(world, s, s * turn, chassis, wheel, at)) for turn in turns for s in sides]
    gaps, gap, off = Gaps(world), Worst(), Worst()

    def watch():
        gap(gaps.worst())
        for side, turn, foot in legs:
            x, y = linkage(turn + side * axle.angle)["heel"]
            off(math.dist(foot.position, chassis.to_world((side * x, y))))

    run(world, 10.0, watch)
    measured("N12", named("greatest gap", solver), gap.value)
    measured("N12", named("a heel off the linkage", solver), off.value)
    measured("N12", "way", abs(chassis.position.x))
    measured("N12", "tilt at the end", abs(chassis.angle))


def car(world, place, angle=0.0, hertz=3.0, motor=None):
    """Add a car at a distance `place` along a slope through the origin. Return (chassis, wheels, axles)."""
    chassis = world.add_body(Polygon.box(2.4, 0.5), position=on_slope(angle, place, 0.9), angle=angle, filter=APART)
    places = [on_slope(angle, place + x, 0.4) for x in (-0.8, 0.8)]
    wheels = [world.add_body(Circle(0.4), position=at, filter=APART, material=GRIP) for at in places]
    axis = -math.sin(angle), math.cos(angle)
    axles = [
        world.add_joint(Wheel(chassis, w, at=at, axis=axis, spring=Spring(hertz, 0.7), motor=motor))
        for w, at in zip(wheels, places, strict=True)
    ]
    return chassis, wheels, axles


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("hertz", [1.5, 3.0, 5.0])
def test_n13_a_car_sags_by_its_load(measured, hertz, solver):
    """Each wheel of a car sags by m g / 2k, where k = m' (2 pi f)² is the stiffness of its spring.

    m' is the effective mass of the spring's two bodies, the chassis (at the axle) and the wheel.
    """
    world = jointed(solver)
    floor(world)
    chassis, wheels, axles = car(world, phase(3.0), hertz=hertz)
    run(world, 5.0)
    inverse = 1.0 / chassis.mass + 0.8**2 / chassis.inertia + 1.0 / wheels[0].mass
    sag = chassis.mass * GRAVITY / 2.0 * inverse / (2.0 * math.pi * hertz) ** 2
    measured("N13", "error of the sag", max(abs(-axle.translation / sag - 1.0) for axle in axles))
    measured("N13", "tilt", abs(chassis.angle))


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_n14_a_car_climbs_a_hill_of_30_degrees_and_stands_on_it(measured, solver):
    """A car climbs a slope of 30 degrees with its wheels at 10 rad/s for 3 s without slip, then brakes and stands
    still.
    """
    world, angle = jointed(solver), -math.pi / 6.0
    floor(world, friction=0.9, angle=angle)
    chassis, _, axles = car(world, -20.0 + phase(3.0), angle, motor=Drive(10.0, max=1e4))
    run(world, 2.0)
    start, turned = chassis.position, axles[0].angle
    run(world, 3.0)
    rolled = 0.4 * (axles[0].angle - turned)
    measured("N14", "slip, of the way", abs(math.dist(start, chassis.position) / rolled - 1.0))
    measured("N14", "error of the wheels' speed", abs(rolled / (3.0 * 4.0) - 1.0))
    for axle in axles:
        axle.motor = Drive(0.0, max=1e4)
    run(world, 2.0)
    start = chassis.position
    run(world, 3.0)
    measured("N14", "creep while it brakes", math.dist(start, chassis.position) / 3.0)


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_n16_ragdolls_fall_down_stairs_and_sleep(measured, solver):
    """26 ragdolls thrown at eight stairs all fall asleep soon after the last one has stopped."""
    world = jointed(solver, effects={"sleeping": True})
    torsos = stairs(world, 26, phase(6.0))
    over, gaps, gap, moving = Worst(), Gaps(world), Worst(), 0.0
    while world.time < 12.0 and (world.time < 1.0 or any(torso.awake for torso in torsos)):
        world.step()
        joints, rows = world.joints, world.bodies
        over(np.maximum(joints["lower"] - joints["angle"], joints["angle"] - joints["upper"]).max())
        gap(gaps.worst())
        if np.hypot(rows["vx"], rows["vy"]).max() > 1.0:
            moving = world.time
    measured("N16", named("limits exceeded", solver), math.degrees(over.value))
    measured("N16", named("greatest gap", solver), gap.value)
    if solver == "soft_step":
        measured("N16", "asleep after the last was at 1 m/s", world.time - moving)
    measured("N16", named("ragdolls awake after 12 s", solver), sum(torso.awake for torso in torsos))
