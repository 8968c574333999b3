"""Single joints (section N): doors, sliders, targets, tracks, pulleys and ratchets, checked against closed forms."""

import math

import pytest

from physics import Circle, Motor, Polygon, Prismatic, Pulley, Ratchet, Revolute, Spring, Target, Weld
from tests.stability.jointed import ALONE, GRAVITY, Period, Worst, jointed, named, rod, run
from tests.stability.piles import SOLVERS, floor, needs_speed
from tests.stability.settings import phase


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_n17_a_dragged_body_does_not_overshoot_and_sleeps(measured, solver):
    """A body dragged by a target joint does not overshoot its goal, and sleeps.

    It is dragged over a table by its centre, then hung up by the middle of its top.
    """
    angle = phase(2.0 * math.pi)
    world = jointed(solver, gravity=(0.0, 0.0), effects={"sleeping": True})
    box = world.add_body(Polygon.box(0.5, 0.5), angle=angle)
    goal, way = (3.0 * math.cos(angle), 3.0 * math.sin(angle)), Worst()
    world.add_joint(Target(box, at=(0.0, 0.0), point=goal))
    run(world, 2.0, lambda: way((box.position.x * goal[0] + box.position.y * goal[1]) / 9.0))
    measured("N17", "overshoot, of the way", max(way.value - 1.0, 0.0))
    measured("N17", "distance to the goal after 2 s", math.dist(box.position, goal))
    run(world, 3.0)
    measured("N17", "dragged bodies awake after 5 s", box.awake)
    world = jointed(solver, effects={"sleeping": True})
    floor(world)
    box = world.add_body(Polygon.box(0.5, 0.5), position=(0.0, -0.25))
    world.add_joint(Target(box, at=(0.0, -0.5), point=(0.0, -2.0 - phase(2.0)), max_force=50.0 * box.mass * GRAVITY))
    run(world, 8.0)
    sag = box.to_world((0.0, -0.25))[1] + 2.0 + phase(2.0)
    measured("N17", "error of the sag", abs(sag / (GRAVITY / (2.0 * math.pi * 5.0) ** 2) - 1.0))
    measured("N17", "hung bodies awake after 8 s", box.awake)


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_n18_a_tank_keeps_its_circle_and_stops_in_its_way(measured, solver):
    """A tank seen from above keeps its circle, and stops within its braking distance.

    A motor joint to the world with a bounded force drives it; the target velocity turns with the hull.
    """
    world = jointed(solver, gravity=(0.0, 0.0))
    tank = world.add_body(Polygon.box(3.0, 2.0), angle=phase(2.0 * math.pi))
    speed, spin, brake, points = 4.0, 0.8, 6.0, []
    limits = {"max_force": brake * tank.mass, "max_torque": 20.0 * tank.inertia}
    world.add_joint(Motor(None, tank, angular_velocity=spin, **limits))

    def steer():
        points.append(tank.position)
        world.joints["target_vx"] = speed * math.cos(tank.angle)
        world.joints["target_vy"] = speed * math.sin(tank.angle)

    run(world, 12.0, steer)
    late = points[-round(2.0 * math.pi / spin / world.dt) :]
    wide = max(x for x, _ in late) - min(x for x, _ in late)
    measured("N18", "error of its circle", abs(wide / 2.0 / (speed / spin) - 1.0))
    measured("N18", "error of its speed", abs(math.hypot(*tank.velocity) / speed - 1.0))
    for name in ("target_vx", "target_vy", "target_spin"):
        world.joints[name] = 0.0
    at = tank.position
    run(world, 2.0)
    measured(
        "N18", named("error of its way to stop", solver), abs(math.dist(at, tank.position) * 2 * brake / speed**2 - 1)
    )
    measured("N18", "speed at the end", math.hypot(*tank.velocity))


def door(solver, hertz, damping, opened):
    """Return (world, hinge) of a 1 m door with a spring hinge, opened by an angle [rad]; the world has no gravity."""
    world = jointed(solver, gravity=(0.0, 0.0))
    leaf = rod(world, (0.0, 0.0), (math.cos(opened), math.sin(opened)), 0.1)
    return world, world.add_joint(Revolute(None, leaf, at=(0.0, 0.0), spring=Spring(hertz, damping, target=-opened)))


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("hertz", [0.5, 1.0, 2.0])
def test_n19_a_door_swings_with_its_spring(measured, hertz, solver):
    opened = 0.5 + phase(1.0)
    world, hinge = door(solver, hertz, 0.0, opened)
    period, late = Period(world, lambda: opened + hinge.angle), Worst()
    run(world, 4.0 / hertz, period)
    run(world, 1.1 / hertz, lambda: (period(), late(abs(opened + hinge.angle))))
    measured("N19", named("error of the period", solver), abs(period.mean() * hertz - 1.0))
    measured("N19", named("amplitude lost in four swings", solver), 1.0 - late.value / opened)


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("hertz", [0.5, 1.0, 2.0])
@pytest.mark.parametrize("damping", [1.0, 2.0])
def test_n19_a_damped_door_does_not_overshoot(measured, damping, hertz, solver):
    opened = 0.5 + phase(1.0)
    world, hinge = door(solver, hertz, damping, opened)
    beyond = Worst()
    run(world, damping * 4.0 / hertz, lambda: beyond(-(opened + hinge.angle)))
    measured("N19", named("overshoot, damping 1 and 2", solver), beyond.value / opened)
    measured("N19", "angle left", abs(opened + hinge.angle) / opened)


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("load", [0.0, 10.0])
def test_n20_a_slider_stops_at_its_limit(measured, load, solver):
    """A slider that falls 1.5 m along its axis stops at its limit, alone or with a load welded 1 m to one side."""
    world, angle = jointed(solver), 0.3 + phase(1.2)
    box = world.add_body(Polygon.box(0.4, 0.2), filter=ALONE)
    along = math.cos(angle), math.sin(angle)
    slide = world.add_joint(Prismatic(None, box, at=(0.0, 0.0), axis=along, limits=(-1.0, 1.5)))
    if load:
        weight = world.add_body(Circle(0.2), position=(1.0, 0.0), mass=load * box.mass, filter=ALONE)
        world.add_joint(Weld(box, weight, at=(0.0, 0.0)))
    beyond, rebound, turned, reached = Worst(), Worst(), Worst(), []

    def watch():
        beyond(slide.translation - 1.5)
        turned(abs(box.angle))
        if slide.translation > 1.5 - 1e-3:
            reached.append(world.time)
        if reached:
            rebound(1.5 - slide.translation)

    run(world, 3.0, watch)
    name = ", loaded" if load else ""
    measured("N20", named(f"beyond the limit{name}", solver), beyond.value)
    measured("N20", named(f"rebound{name}", solver), rebound.value if reached else math.nan)
    measured("N20", named(f"turn{name}", solver), turned.value)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("ratio", [0.5, 1.0, 3.0])
def test_n21_a_pulley_falls_and_pulls_as_atwoods(measured, ratio, solver):
    """A pulley accelerates as Atwood's machine: B falls by g (m - ratio) / (m + ratio²).

    m is the mass of B divided by that of A. In the other phases the ropes are up to 5 m longer.
    """
    for masses in (0.1, 0.5, 2.0, 30.0):
        world = jointed(solver)
        a = world.add_body(Circle(0.2), position=(0.0, 15.0), mass=0.1)
        b = world.add_body(Circle(0.2), position=(3.0, 12.0), mass=0.1 * masses)
        wheels = {"ground_a": (0.0, phase(5.0)), "ground_b": (3.0, -phase(5.0))}
        rope = world.add_joint(Pulley(a, b, at_a=(0, 15), at_b=(3, 12), ratio=ratio, **wheels))
        run(world, 0.4)
        falls = GRAVITY * (masses - ratio) / (masses + ratio**2)
        measured("N21", "error of the acceleration, of g", abs(b.velocity.y / 0.4 - falls) / GRAVITY)
        measured("N21", "error of the pull", abs(rope.force / (b.mass * (GRAVITY - falls)) - 1.0))
        measured("N21", named("error of the length", solver), abs(rope.translation - rope.length))


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("teeth", [-7, 24, 200])
def test_n22_a_ratchet_turns_one_way(measured, teeth, solver):
    """A ratchet turns freely in one direction, by 2 rad here.

    In the other direction its last tooth holds the disc against a torque of 20 times the disc's inertia.
    """
    world, tooth, way = jointed(solver, gravity=(0.0, 0.0)), 2.0 * math.pi / teeth, math.copysign(1.0, teeth)
    disc, start = world.add_body(Circle(0.5)), phase(tooth)
    world.add_joint(Revolute(None, disc, at=(0.0, 0.0)))
    pawl = world.add_joint(Ratchet(None, disc, phase=start, ratchet=tooth))
    disc.angular_velocity = 2.0 * way
    run(world, 1.0)
    measured("N22", "error of its free turn", abs(disc.angle * way / 2.0 - 1.0))
    disc.angular_velocity = 0.0
    last, back, torque = start + math.floor((disc.angle - start) / tooth) * tooth, Worst(), -way * 20.0 * disc.inertia
    for _ in range(90):
        disc.apply_torque(torque)
        world.step()
        back(way * (last - disc.angle))
    measured("N22", named("back over its tooth", solver), back.value)
    measured("N22", "error of its torque", abs(pawl.torque / torque + 1.0))
