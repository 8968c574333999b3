"""Joints without friction keep the energy of a swing, and joints of fast rotating arms stay closed."""

import math

import numpy as np
import pytest

from physics import Distance, Effects, Filter, Polygon, Prismatic, Revolute, Spring, World
from physics.annotations import SolverName

EFFECTS = Effects.rigid_bodies().with_(joints=True, sleeping=False)
GRAVITY = 9.8


def rod(world, start, end, mass=1.0):
    (ax, ay), (bx, by) = start, end
    shape = Polygon.box(math.dist(start, end), 0.1)
    place, angle = ((ax + bx) / 2, (ay + by) / 2), math.atan2(by - ay, bx - ax)
    return world.add_body(shape, position=place, angle=angle, mass=mass, filter=Filter(1, 0))


def chain(links, angle, ratio, substeps):
    """Return a world with a straight chain of 1 m rods at rest at an angle; its last rod is `ratio` times as heavy."""
    world = World(EFFECTS, gravity=(0.0, GRAVITY), pixels_per_meter=1, substeps=substeps)
    before = None
    for k in range(links):
        at, to = ((n * math.cos(angle), n * math.sin(angle)) for n in (k, k + 1))
        link = rod(world, at, to, ratio if k == links - 1 else 1.0)
        world.add_joint(Revolute(before, link, at=at))
        before = link
    return world


def energy(world):
    b = world.bodies
    moving = 0.5 * (b["mass"] * (b["vx"] ** 2 + b["vy"] ** 2) + b["inertia"] * b["angular_velocity"] ** 2)
    return float((moving - b["mass"] * GRAVITY * b["center_y"]).sum())


@pytest.mark.parametrize("substeps", [4, 8])
@pytest.mark.parametrize("ratio", [0.2, 1.0, 5.0])
@pytest.mark.parametrize("angle", np.linspace(0.0, 1.0, 4))
def test_a_double_pendulum_keeps_its_energy_and_its_pins(angle, ratio, substeps):
    world = chain(2, angle, ratio, substeps)
    start = energy(world)
    fall = 2.0 * GRAVITY * float((world.bodies["mass"] * world.bodies["center_x"]).sum()) / math.cos(angle)
    off, gap = 0.0, 0.0
    for _ in range(15 * 60):
        world.step()
        off = max(off, abs(energy(world) - start) / fall)
        gap = max(gap, float(world.joints["separation"].max()))
    assert off < 0.06 / substeps and gap < 2e-3 / substeps


# ---- springs ---------------------------------------------------------------------------------------------------------


def hung(kind, hertz, damping, substeps, solver: SolverName = "soft_step", drop=0.3):
    """Return (world, displacement) of a body on a spring without gravity, released `drop` from its rest position.

    displacement(): function that returns the present distance from the rest position [m], or the angle [rad] for a
    hinge.
    """
    world = World(EFFECTS, gravity=(0.0, 0.0), pixels_per_meter=1, substeps=substeps, solver=solver)
    spring = Spring(hertz, damping)
    body = world.add_body(Polygon.box(0.4, 0.4), position=(0.0, 2.0), filter=Filter(1, 0))
    if kind == "distance":
        joint = world.add_joint(Distance(None, body, at_a=(0, 0), at_b=(0, 2), length=2.0 + drop, spring=spring))
        return world, lambda: joint.translation - 2.0 - drop
    if kind == "slider":
        spring = Spring(hertz, damping, target=drop)
        joint = world.add_joint(Prismatic(None, body, at=(0, 2), axis=(0, 1), spring=spring))
        return world, lambda: joint.translation - drop
    spring = Spring(hertz, damping, target=drop)
    joint = world.add_joint(Revolute(None, body, at=(0, 0), spring=spring))
    return world, lambda: joint.angle - drop


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
@pytest.mark.parametrize("substeps", [1, 4])
@pytest.mark.parametrize("hertz", [0.3, 1.0, 2.0])
@pytest.mark.parametrize("kind", ["distance", "slider", "door"])
def test_an_undamped_spring_keeps_its_swing(kind, hertz, substeps, solver):
    world, away = hung(kind, hertz, 0.0, substeps, solver)
    first, last = [], []
    periods = 20
    for n in range(round(periods / hertz / world.dt)):
        world.step()
        time = n * world.dt * hertz
        if time < 2.0 or time > periods - 2.0:
            (first if time < 2.0 else last).append(away())
    assert max(first) == pytest.approx(0.3, rel=0.03) and min(first) == pytest.approx(-0.3, rel=0.03)
    assert max(last) == pytest.approx(max(first), rel=0.04) and min(last) == pytest.approx(min(first), rel=0.04)


@pytest.mark.parametrize("substeps", [1, 4])
@pytest.mark.parametrize("hertz", [5.0, 30.0, 200.0, 1e4])
@pytest.mark.parametrize("kind", ["distance", "slider", "door"])
def test_a_stiff_undamped_spring_stays_bounded(kind, hertz, substeps):
    world, away = hung(kind, hertz, 0.0, substeps)
    for _ in range(600):
        world.step()
        assert abs(away()) < 0.3 * 1.15


@pytest.mark.parametrize("damping", [0.05, 0.2, 0.5])
@pytest.mark.parametrize("hertz", [0.5, 2.0])
@pytest.mark.parametrize("kind", ["distance", "slider", "door"])
def test_a_damped_swing_fades_by_its_damping_ratio(kind, hertz, damping):
    """The amplitude of a damped swing falls by exp(-2 pi z / sqrt(1 - z²)) in each period, for a damping ratio z."""
    world, away = hung(kind, hertz, damping, 4)
    values = []
    for _ in range(round(2.2 / hertz / world.dt)):
        world.step()
        values.append(away())
    peaks = [-values[n] for n in range(1, len(values) - 1) if values[n - 1] > values[n] < values[n + 1]]
    left = math.exp(-2.0 * math.pi * damping / math.sqrt(1.0 - damping**2))
    assert peaks and peaks[0] / 0.3 == pytest.approx(left, rel=0.08)


@pytest.mark.parametrize("hertz", [1.0, 8.0, 60.0])
@pytest.mark.parametrize("ratio", [1.0, 1e3])
def test_a_chain_of_undamped_springs_gains_no_energy(ratio, hertz):
    """A bent chain of undamped springs swings without gravity and gains no energy; several springs act on each body."""
    world, before = World(EFFECTS, gravity=(0.0, 0.0), pixels_per_meter=1, substeps=4), None
    for k in range(6):
        at, to = (k, 0.2 * (k % 2)), (k + 1.0, 0.2 * ((k + 1) % 2))
        link = rod(world, at, to, ratio if k == 5 else 1.0)
        spring = Spring(hertz, 0.0, target=0.5)
        world.add_joint(Revolute(before, link, at=at, spring=spring))
        before = link
    fastest = []
    for _ in range(1200):
        world.step()
        b = world.bodies
        fastest.append(0.5 * float((b["mass"] * (b["vx"] ** 2 + b["vy"] ** 2)).sum()))
    assert np.isfinite(fastest).all() and max(fastest[600:]) < 1.5 * max(fastest[:600])
