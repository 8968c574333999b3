"""Joints whose anchors are far apart: the gaps close at the push-out speed, and closing them adds no energy."""

import math

import numpy as np
import pytest

from physics import Circle, Drive, Effects, Filter, Polygon, Revolute, World

EFFECTS = Effects.rigid_bodies().with_(joints=True, sleeping=False)
GRAVITY, PUSH_SPEED = 9.8, 3.0  # [m/s²], [m/s] of settings.PUSH_SPEED
LINKS = 12
ALONE = Filter(1, 0)
SOLVERS = ["soft_step", "sequential_impulse"]


def rod(world, start, end):
    (ax, ay), (bx, by) = start, end
    place, angle = ((ax + bx) / 2, (ay + by) / 2), math.atan2(by - ay, bx - ax)
    return world.add_body(Polygon.box(math.dist(start, end), 0.125), position=place, angle=angle, filter=ALONE)


def chain(ratio, angle, motor=0.0, **options):
    """Return a world with a chain of 12 rods of 1 m and a ball of `ratio` times their mass. motor: torque [N m]."""
    world = World(EFFECTS, gravity=(0.0, GRAVITY), pixels_per_meter=1, **options)
    along = np.array([math.cos(angle), math.sin(angle)])
    drive = Drive(0.0, motor) if motor else None
    links = [rod(world, k * along, (k + 1) * along) for k in range(LINKS)]
    ball = world.add_body(Circle(0.5), position=(LINKS + 0.5) * along, mass=ratio * links[0].mass, filter=ALONE)
    for k, (a, b) in enumerate(zip([None, *links], [*links, ball], strict=True)):
        world.add_joint(Revolute(a, b, at=k * along, motor=drive))
    return world


def energies(world):
    """Return the kinetic and the potential energy of all bodies [J]."""
    b = world.bodies
    moving = 0.5 * (b["mass"] * (b["vx"] ** 2 + b["vy"] ** 2) + b["inertia"] * b["angular_velocity"] ** 2)
    return float(moving.sum()), float((-b["mass"] * GRAVITY * b["center_y"]).sum())


def close(world, seconds=2.0):
    """Step until all gaps are below 1 cm, for at most `seconds`. Return (greatest energy gain, final gap [m]).

    The gain of a step is the rise of the kinetic energy beyond the work of gravity. It is divided by the energy of a
    fall by the length of the chain.
    """
    fall = LINKS * GRAVITY * float(world.bodies["mass"].sum())
    gain = 0.0
    for _ in range(round(seconds / world.dt)):
        kinetic, potential = energies(world)
        world.step()
        after, lower = energies(world)
        gain = max(gain, (after - kinetic - max(potential - lower, 0.0)) / fall)
        if world.joints["separation"].max() < 0.01:
            break
    return gain, float(world.joints["separation"].max())


def scatter(world, distance, seed, ids=None):
    """Move bodies by a distance [m] in random directions."""
    rng = np.random.default_rng(seed)
    for body in map(world.body, world.bodies["id"].tolist() if ids is None else ids):
        angle = rng.uniform(0.0, 2.0 * math.pi)
        body.position = body.position.x + distance * math.cos(angle), body.position.y + distance * math.sin(angle)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("substeps", [4, "auto", 32])
@pytest.mark.parametrize("ratio", [1.0, 1e3, 1e6])
def test_gaps_of_the_iterative_tier_close_without_a_gain_of_energy(ratio, substeps, solver):
    """The gaps that the iterative joint solver leaves close without a gain of energy under the direct one.

    The gaps are up to 3 m wide. Ten phases vary the angle of the chain and the time at which the solver is changed.
    """
    for phase in np.arange(10) / 10.0:
        world = chain(ratio, 1.4 * phase, solver=solver, substeps=substeps)
        world.joint_solver = "iterative"
        for _ in range(round((0.5 + 2.0 * phase) / world.dt)):
            world.step()
        world.joint_solver = "direct"
        gain, gap = close(world)
        assert gain < 1e-9, phase
        assert gap < 0.01 or ratio == 1e6, phase


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("substeps", [4, "auto", 32])
@pytest.mark.parametrize("ratio", [1.0, 1e3])
def test_scattered_links_are_drawn_together_without_a_gain_of_energy(ratio, substeps, solver):
    """Links that were moved apart by 0.1 to 1.6 m close their gaps without a gain of energy.

    First all links are moved, later one link of the swinging chain. Ten phases vary the angle and the distance.
    """
    for phase in range(10):
        world = chain(ratio, 0.2 + 0.12 * phase, solver=solver, substeps=substeps)
        scatter(world, 0.1 * 2 ** (phase % 5), phase)
        gain, gap = close(world)
        assert gain < 1e-9 and gap < 0.01, phase
        for _ in range(30):
            world.step()
        scatter(world, 0.1 * 2 ** (phase % 5), phase, [world.bodies["id"].tolist()[2 + phase]])
        gain, gap = close(world)
        assert gain < 1e-9 and gap < 0.01, phase


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("substeps", [4, "auto", 32])
@pytest.mark.parametrize(("ratio", "most"), [(1.0, 0.03), (1e3, 0.1)])
def test_links_with_motors_are_drawn_together_gently(ratio, most, substeps, solver):
    """Scattered links whose hinges have weak motors close their gaps with a small gain of energy.

    Motors may add energy, so the energy limit does not apply to them.
    """
    for phase in range(10):
        world = chain(ratio, 0.2 + 0.12 * phase, 0.01, solver=solver, substeps=substeps)
        scatter(world, 0.1 * 2 ** (phase % 5), phase)
        gain, gap = close(world)
        assert gain < most and gap < 0.01, phase


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("substeps", [1, 4, "auto"])
@pytest.mark.parametrize("distance", [0.05, 0.5, 5.0])
def test_a_gap_closes_at_the_push_out_speed_and_leaves_no_velocity(distance, substeps, solver):
    world = World(EFFECTS.with_(gravity=False), pixels_per_meter=1, solver=solver, substeps=substeps)
    beam = rod(world, (0.0, 0.0), (1.0, 0.0))
    world.add_joint(Revolute(None, beam, at=(0.0, 0.0)))
    turn, gaps = 0.3, [distance]
    beam.position = beam.position.x + distance * math.cos(turn), distance * math.sin(turn)
    for _ in range(round((1.2 * distance / PUSH_SPEED + 0.1) / world.dt)):
        world.step()
        gaps.append(float(world.joints["separation"][0]))
    assert max(-np.diff(gaps)) < PUSH_SPEED * world.dt * (1.0 + 1e-9)
    assert gaps[-1] < 1e-6
    assert math.hypot(*beam.velocity) < 1e-3 and abs(beam.angular_velocity) < 1e-3


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("substeps", [4, "auto"])
def test_a_bridge_closes_behind_a_plank_that_is_moved(substeps, solver):
    """A bridge closes its gaps after one of its planks was moved away.

    Both ends of the bridge are fixed, so the gaps cannot close without rotation of the planks.
    """
    for phase in range(10):
        world = World(EFFECTS, gravity=(0.0, GRAVITY), pixels_per_meter=1, solver=solver, substeps=substeps)
        planks, before = [], None
        for k in range(10):
            plank = rod(world, (k, 0.0), (k + 1.0, 0.0))
            world.add_joint(Revolute(before, plank, at=(k, 0.0)))
            planks.append(plank)
            before = plank
        world.add_joint(Revolute(before, None, at=(9.5, 0.0)))
        start = energies(world)[0]
        scatter(world, 1.0, phase, [planks[phase].id])
        for _ in range(180):
            world.step()
            assert energies(world)[0] - start < 20.0 * GRAVITY * float(world.bodies["mass"].sum())
        assert world.joints["separation"].max() < 0.02


@pytest.mark.parametrize("solver", SOLVERS)
def test_wide_gaps_do_not_change_other_islands(solver):
    """Closing the gaps of a chain does not change the motion of a jointed doll that lies on a floor beside it."""
    ends = []
    for beside in (False, True):
        world = chain(10.0, 0.5, solver=solver)
        world.add_body(Polygon.box(20.0, 1.0), position=(40.0, 1.0), kind="static")
        doll = [world.add_body(Polygon.box(1.0, 0.5), position=(40.0 + k, 0.4)) for k in range(3)]
        for k in range(2):
            world.add_joint(Revolute(doll[k], doll[k + 1], at=(40.5 + k, 0.4), limits=(-0.1, 0.1)))
        if beside:
            scatter(world, 1.0, 3, world.bodies["id"].tolist()[: LINKS + 1])
        for _ in range(120):
            world.step()
        rows = world.bodies[world.rows([body.id for body in doll])]
        ends.append([rows[name].tobytes() for name in ("x", "y", "angle", "vx", "vy", "angular_velocity")])
    assert ends[0] == ends[1]


# ---- push-out --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("substeps", [4, "auto"])
@pytest.mark.parametrize("depth", np.linspace(0.05, 0.4, 10))
def test_the_push_out_of_an_overlap_keeps_limits_and_anchors(depth, substeps, solver):
    """Jointed bodies that overlap the floor are pushed out without a joint gap and without passing the joint limits.

    A beam starts in the floor. An arm hangs on each of its ends, on a hinge with limits.
    """
    world = World(EFFECTS, gravity=(0.0, GRAVITY), pixels_per_meter=1, solver=solver, substeps=substeps)
    world.add_body(Polygon.box(20.0, 2.0), position=(0.0, 1.0), kind="static")
    beam = world.add_body(Polygon.box(2.0, 0.4), position=(0.0, -0.2 - depth))
    for side in (-1.0, 1.0):
        arm = world.add_body(Polygon.box(1.0, 0.4), position=(1.4 * side, -0.2 + depth), angle=0.1)
        world.add_joint(Revolute(beam, arm, at=(side, -depth / 2.0), limits=(-0.05, 0.05)))
    for _ in range(120):
        world.step()
        joints = world.joints
        assert np.abs(joints["angle"]).max() < 0.05 + math.radians(0.02)
        assert joints["separation"].max() < 1e-3
    assert all(body.position.y < 0.0 for body in world if body.kind == "dynamic"), "they are pushed out"
