"""Loops, limits and motors of joint trees are solved exactly, for many sizes, masses and substeps.

The tests check gaps, angles and forces.
"""

import math
from typing import Any

import numpy as np
import pytest

from physics import Circle, Drive, Effects, Filter, Polygon, Prismatic, Revolute, Weld, World
from physics.solver.joint_schur import MOST_MOTORS, MOST_SCHUR

EFFECTS = Effects.rigid_bodies().with_(joints=True, sleeping=False)
ALONE = Filter(1, 0)
SOLVERS = ("soft_step", "sequential_impulse")


def space(substeps: Any = 4, gravity=(0.0, 9.8), solver: Any = "soft_step"):
    return World(EFFECTS, gravity=gravity, pixels_per_meter=1, substeps=substeps, solver=solver)


def rod(world, start, end, mass=1.0):
    (ax, ay), (bx, by) = start, end
    shape = Polygon.box(math.dist(start, end), 0.1)
    place, angle = ((ax + bx) / 2, (ay + by) / 2), math.atan2(by - ay, bx - ax)
    return world.add_body(shape, position=place, angle=angle, mass=mass, filter=ALONE)


def run(world, seconds, each=None):
    for _ in range(round(seconds / world.dt)):
        world.step()
        if each is not None:
            each()


def gap(world):
    return float(world.joints["separation"].max())


def ring(world, links, ratio, radius=1.0):
    """Add a closed ring of links that hangs on the world by its top corner; its lowest link is
    `ratio` times as heavy.
    """
    at = [
        (radius * math.sin(2 * math.pi * k / links), radius * (1 - math.cos(2 * math.pi * k / links)))
        for k in range(links)
    ]
    parts = [rod(world, at[k], at[(k + 1) % links], ratio if k == links // 2 else 1.0) for k in range(links)]
    for k in range(links):
        world.add_joint(Revolute(parts[k - 1], parts[k], at=at[k]))
    world.add_joint(Revolute(None, parts[0], at=at[0]))
    return parts


# ---- loops -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("substeps", [2, 4, 16])
@pytest.mark.parametrize("ratio", [1.0, 1e2, 1e4])
@pytest.mark.parametrize("links", [3, 6, 24])
def test_a_ring_of_links_is_held_as_a_chain_is(links, ratio, substeps):
    world = space(substeps)
    ring(world, links, ratio)
    worst = [0.0]
    run(world, 2.0, lambda: worst.append(gap(world)))
    assert world.joints["direct"].all()
    assert max(worst) < {3: 1e-9, 6: 0.3, 24: 1.2}[links] / substeps**1.5, "what arms rotate in a substep"


def lattice(world, cells, direction):
    """Add a truss of square cells with both diagonals, welded to the world at one end; it has redundant bars."""

    def place(i, j):
        return i * direction[0] - j * direction[1], i * direction[1] + j * direction[0]

    balls = {(i, j): world.add_body(Circle(0.05), position=place(i, j), filter=ALONE, mass=1.0)
             for i in range(cells + 1) for j in range(2)}  # fmt: skip
    for j in range(2):
        world.add_joint(Weld(None, balls[0, j], at=place(0, j)))
    for i in range(cells):
        ends = [((i, 0), (i + 1, 0)), ((i, 1), (i + 1, 1)), ((i + 1, 0), (i + 1, 1)), ((i, 0), (i + 1, 1)),
                ((i, 1), (i + 1, 0))]  # fmt: skip
        for one, two in ends:
            bar = rod(world, place(*one), place(*two))
            world.add_joint(Revolute(balls[one], bar, at=place(*one)))
            world.add_joint(Revolute(bar, balls[two], at=place(*two)))
    return balls


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("angle", [0.0, 0.4, math.pi / 2, 3.0])
@pytest.mark.parametrize("cells", [1, 2, 5])
def test_a_truss_with_redundant_bars_stands_still(cells, angle, solver):
    world = space(solver=solver)
    balls = lattice(world, cells, (math.cos(angle), math.sin(angle)))
    start = {at: ball.position for at, ball in balls.items()}
    run(world, 3.0)
    assert world.joints["direct"].all()
    assert max(math.dist(ball.position, start[at]) for at, ball in balls.items()) < 1e-6
    assert np.abs(world.bodies["vx"]).max() < 1e-6


@pytest.mark.parametrize("substeps", [1, 4, 8])
@pytest.mark.parametrize("phase", np.linspace(0.0, 0.9, 4))
def test_a_parallelogram_passes_through_its_singular_pose(phase, substeps):
    """A parallelogram passes through its singular poses with bounded forces and closed pins.

    Twice a turn its four bars lie on one line, where it could fold either way.
    """
    world = space(substeps, gravity=(0.0, 0.0))
    c, s = math.cos(2 + phase), math.sin(2 + phase)
    left, right = rod(world, (0, 0), (c, s)), rod(world, (2, 0), (2 + c, s))
    top = rod(world, (c, s), (2 + c, s))
    drive = world.add_joint(Revolute(None, left, at=(0, 0), motor=Drive(3.0, max=1e4)))
    world.add_joint(Revolute(None, right, at=(2, 0)))
    world.add_joint(Revolute(left, top, at=(c, s)))
    world.add_joint(Revolute(top, right, at=(2 + c, s)))
    worst = [0.0]
    run(world, 6.0, lambda: worst.append(gap(world)))
    assert max(worst) < 0.01 / substeps + 1e-9
    assert drive.angle == pytest.approx(18.0, rel=0.05)


def test_a_net_stays_iterative():
    world = space()
    balls = {(i, j): world.add_body(Circle(0.1), position=(i, j), filter=ALONE) for i in range(12) for j in range(12)}
    for (i, j), ball in balls.items():
        for other, at in (((i + 1, j), (i + 0.5, j)), ((i, j + 1), (i, j + 0.5))):
            if other in balls:
                world.add_joint(Revolute(ball, balls[other], at=at))
    world.step()
    assert not world.joints["direct"].any()


# ---- limits ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("substeps", [2, 4])
@pytest.mark.parametrize("ratio", [1.0, 30.0, 1e3])
@pytest.mark.parametrize("links", [2, 5, 12])
def test_a_chain_with_limits_stops_at_them(links, ratio, substeps, solver):
    """A chain with a heavy end falls from level until each hinge is at its limit, then swings as a stiff arc."""
    world, before = space(substeps, solver=solver), None
    joints = []
    for k in range(links):
        link = rod(world, (k, 0), (k + 1, 0), ratio if k == links - 1 else 1.0)
        joints.append(world.add_joint(Revolute(before, link, at=(k, 0), limits=(-0.2, 0.1))))
        before = link
    over = [0.0]

    def watch():
        angles = np.array([joint.angle for joint in joints])
        over.append(float(np.maximum(angles - 0.1, -0.2 - angles).max()))

    run(world, 3.0, watch)
    assert max(over) < 1e-9
    assert np.abs(world.bodies["angular_velocity"]).max() < 1e-6, "it hangs on its limits"


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("offset", [0.0, 0.3, 2.0])
@pytest.mark.parametrize("ratio", [0.1, 1.0, 10.0, 1e4])
def test_a_loaded_slider_stops_on_its_limit(ratio, offset, solver):
    world = space(solver=solver)
    slider = world.add_body(Polygon.box(0.4, 0.4), position=(0, 0), mass=1.0, filter=ALONE)
    slide = world.add_joint(Prismatic(None, slider, at=(0, 0), axis=(0, 1), limits=(-0.5, 1.5)))
    load = world.add_body(Circle(0.2), position=(offset, 0), mass=ratio, filter=ALONE)
    world.add_joint(Weld(slider, load, at=(offset, 0)))
    farthest, landed = [0.0], []

    def watch():
        farthest.append(slide.translation)
        if landed or slide.translation > 1.5 - 1e-6:
            landed.append(slide.translation)

    run(world, 3.0, watch)
    assert max(farthest) < 1.5 + 1e-9
    assert landed and min(landed) > 1.5 - 1e-9, "no rebound"


# ---- motors ----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("substeps", [2, 4])
@pytest.mark.parametrize("ratio", [1.0, 1e2, 1e4])
@pytest.mark.parametrize("share", [0.5, 0.99, 1.01, 5.0])
def test_a_motor_lifts_the_load_that_its_force_can_lift(share, ratio, substeps):
    """A motor stronger than the weight of a light carriage and its heavy load keeps its speed; a weaker one slips."""
    world = space(substeps)
    carriage = world.add_body(Circle(0.1), position=(0, 0), mass=1.0, filter=ALONE)
    load = world.add_body(Circle(0.1), position=(1, 0), mass=ratio, filter=ALONE)
    world.add_joint(Weld(carriage, load, at=(1, 0)))
    weight = 9.8 * (1.0 + ratio)
    lift = Drive(-0.5, max=share * weight)
    slide = world.add_joint(Prismatic(None, carriage, at=(0, 0), axis=(0, 1), motor=lift))
    run(world, 1.0)
    if share > 1.0:
        run(world, 8.0 if share < 1.1 else 2.0)
        assert slide.speed == pytest.approx(-0.5, rel=1e-9)
        assert float(world.joints["motor_force"][1]) == pytest.approx(-weight, rel=1e-6)
    else:
        speed = slide.speed
        run(world, 1.0)
        assert slide.speed - speed == pytest.approx(9.8 * (1.0 - share), rel=1e-6)
        assert float(world.joints["motor_force"][1]) == pytest.approx(-share * weight, rel=1e-9)


@pytest.mark.parametrize("most", [10.0, 1e3, 1e5])
@pytest.mark.parametrize("speed", [-3.0, 3.0])
def test_a_motor_drives_against_a_limit_with_its_greatest_torque(speed, most):
    world = space(gravity=(0.0, 0.0))
    arm, end = rod(world, (0, 0), (1, 0)), rod(world, (1, 0), (2, 0), 50.0)
    hinge = world.add_joint(Revolute(None, arm, at=(0, 0), limits=(-1.0, 0.5), motor=Drive(speed, max=most)))
    world.add_joint(Weld(arm, end, at=(1, 0)))
    run(world, 8.0 if most > 10.0 else 30.0)
    assert hinge.angle == pytest.approx(0.5 if speed > 0.0 else -1.0, abs=1e-9)
    row = world.joints[0]
    assert row["motor_force"] == pytest.approx(math.copysign(most, speed), rel=1e-9)
    assert row["upper_force"] - row["lower_force"] == pytest.approx(row["motor_force"], rel=1e-6)


# ---- complementarity -------------------------------------------------------------------------------------------------


def tangle(seed):
    """Return a world with a random tree of rods with limits and motors, and some joints that close loops."""
    rng = np.random.default_rng(seed)
    world = space(int(rng.integers(1, 5)), gravity=tuple(rng.normal(size=2) * 5.0))
    rods, ends = [], [(0.0, 0.0)]
    for _ in range(int(rng.integers(2, 16))):
        k = int(rng.integers(len(ends)))
        start, angle = ends[k], rng.uniform(0.0, 2.0 * math.pi)
        end = start[0] + math.cos(angle), start[1] + math.sin(angle)
        part = rod(world, start, end, 10.0 ** rng.uniform(-1.5, 1.5))
        part.angular_velocity = rng.normal()
        more: dict[str, Any] = {}
        if rng.random() < 0.7:
            more["limits"] = (-rng.uniform(0.0, 0.5), rng.uniform(0.0, 0.5))
        if rng.random() < 0.6:
            more["motor"] = Drive(rng.normal() * 3.0, max=10.0 ** rng.uniform(-1.0, 4.0))
        world.add_joint(Revolute(rods[k - 1] if k else None, part, at=start, **more))
        rods.append(part)
        ends.append(end)
        if len(rods) > 3 and rng.random() < 0.2:
            world.add_joint(Revolute(rods[int(rng.integers(len(rods) - 1))], part, at=end))
    return world


@pytest.mark.parametrize("seed", range(24))
def test_impulses_of_limits_and_motors_are_complementary(seed):
    """After each step a limit only pushes, no motor exceeds its maximum, and limits and pins hold."""
    world = tangle(seed)
    driven = world.joints["motor_max"] > 0.0
    for _ in range(90):
        world.step()
        j = world.joints
        assert j["separation"].max() < 0.05
        assert (j["lower_force"] >= 0.0).all() and (j["upper_force"] >= 0.0).all()
        assert ((j["lower_force"] == 0.0) | (j["upper_force"] == 0.0)).all()
        assert np.maximum(j["lower"] - j["angle"], j["angle"] - j["upper"]).max() < 1e-3
        assert (np.abs(j["motor_force"]) <= j["motor_max"] * (1.0 + 1e-12))[driven].all()


# ---- caps ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["motor", "limits"])
@pytest.mark.parametrize("beyond", [False, True])
def test_a_tree_with_too_many_rows_is_solved_in_passes_and_counted(kind, beyond):
    most = MOST_MOTORS if kind == "motor" else MOST_SCHUR // 2
    world, before = space(), None
    more: dict[str, Any] = {"motor": Drive(0.0, max=1.0)} if kind == "motor" else {"limits": (-1.0, 1.0)}
    for k in range(most + beyond):
        link = rod(world, (k, 0), (k + 1, 0))
        world.add_joint(Revolute(before, link, at=(k, 0), **more))
        before = link
    world.step()
    is_exact = world.joints["exact_motor"] if kind == "motor" else world.joints["exact_limits"]
    assert is_exact.all() != beyond
    assert world.profile.counters["cap_hits"] == int(beyond)
