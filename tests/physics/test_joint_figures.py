"""Joints beside other engines: pendulums, chains with heavy balls, cantilevers and bridges.

Figures of Box2D v3 (4 substeps) at 60 Hz, measured 2026-11-26: pendulum .38 mm of anchor error, double pendulum 9.2 %
of the fall lost in 30 s, chain of 30 links with a ball of 1, 100 and 1,000 links 95, 76 and 906 mm, cantilever of eight
welds 461 mm. A metre is 32 px.
"""

import math

import numpy as np
import pytest

from physics import JIT, Circle, Effects, Filter, Polygon, Revolute, Weld, World

EFFECTS = Effects.rigid_bodies().with_(joints=True)
METRE, G = 32.0, 9.8 * 32.0
MM = METRE / 1000.0
ALONE = Filter(1, 0)  # links that pass through each other, as in the measured scenes
SETTINGS = ("auto", 4)
SECONDS = 1.0 if JIT else 0.1  # share of the time that is simulated


def energy(world):
    b = world.bodies
    moving = 0.5 * (b["mass"] * (b["vx"] ** 2 + b["vy"] ** 2) + b["inertia"] * b["angular_velocity"] ** 2)
    return float((moving - b["mass"] * G * b["center_y"]).sum())


def run(world, seconds):
    """The greatest error of any joint [px]."""
    worst = 0.0
    for _ in range(round(SECONDS * seconds / world.dt)):
        world.step()
        worst = max(worst, float(world.joints["separation"].max()))
    return worst


@pytest.mark.parametrize("substeps", SETTINGS)
@pytest.mark.parametrize("amplitude", [0.2 + 0.25 * k for k in range(10)])
def test_a_pendulum_keeps_its_energy_and_its_anchor(amplitude, substeps):
    world, length = World(EFFECTS, substeps=substeps), 2.0 * METRE
    bob = world.add_body(Circle(8.0), position=(length * math.sin(amplitude), length * math.cos(amplitude)))
    world.add_joint(Revolute(None, bob, at=(0, 0)))
    before, fall = energy(world), bob.mass * G * length * (1.0 - math.cos(amplitude))
    assert run(world, 60.0) <= (0.1 if amplitude < 1.5 else 0.3) * MM
    assert abs(energy(world) - before) <= 1e-3 * fall


@pytest.mark.parametrize("substeps", [4, 16, "auto"])
@pytest.mark.parametrize("phase", range(10))
def test_a_double_pendulum_keeps_its_energy(phase, substeps):
    world = World(EFFECTS, substeps=substeps)
    angles, at, before = (math.pi / 2.0, math.pi / 2.0 + 0.1 * phase), (0.0, 0.0), None
    fall = 0.0
    for angle in angles:
        end = at[0] + METRE * math.sin(angle), at[1] + METRE * math.cos(angle)
        rod = world.add_body(
            Polygon.box(METRE, 4.0), position=((at[0] + end[0]) / 2, (at[1] + end[1]) / 2), angle=math.pi / 2 - angle
        )
        world.add_joint(Revolute(before, rod, at=at))
        before, at = rod, end
    start = energy(world)
    fall = sum(body.mass * G * METRE * (0.5 + k) for k, body in enumerate(world)) + start
    assert run(world, 30.0) <= (0.5 if substeps == 16 else 1.5) * MM
    assert abs(energy(world) - start) <= (0.06 if substeps == 4 else 0.035) * fall


def chain(world, links, ratio, angle):
    """A chain that is let go straight at an angle to the right, with a ball of `ratio` links at its end."""
    x, y, before = math.cos(angle), math.sin(angle), None
    for k in range(links):
        middle = METRE * (k + 0.5)
        shape = Polygon.box(METRE, METRE / 8.0)
        link = world.add_body(shape, position=(middle * x, middle * y), angle=angle, filter=ALONE)
        world.add_joint(Revolute(before, link, at=(METRE * k * x, METRE * k * y)))
        before = link
    far = METRE * (links + 0.5)
    ball = world.add_body(Circle(METRE / 2.0), position=(far * x, far * y), mass=ratio * before.mass, filter=ALONE)
    world.add_joint(Revolute(before, ball, at=(METRE * links * x, METRE * links * y)))


@pytest.mark.parametrize(
    ("ratio", "substeps", "swing", "rest"),
    [
        (1, "auto", 5.0, 1.0),
        (100, "auto", 5.0, 1.0),
        (100, 4, 5.0, 1.0),
        (1000, "auto", 20.0, 2.0),
        (1000, 4, 20.0, 2.0),
        (1e6, "auto", 20.0, 2.0),
        (1e6, 4, 20.0, 2.0),
    ],
)
@pytest.mark.parametrize("angle", [0.0, 0.3, 0.5, 0.8])
def test_a_chain_holds_a_heavy_ball(angle, ratio, substeps, swing, rest):
    world = World(EFFECTS, substeps=substeps)
    chain(world, 30, ratio, angle)
    start, fall = energy(world), 30.0 * METRE * G * float(world.bodies["mass"].sum())
    assert run(world, 12.0) <= swing * MM
    assert energy(world) <= start + 0.005 * fall
    run(world, 8.0)
    assert world.joints["separation"].max() <= rest * MM


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
@pytest.mark.parametrize("substeps", SETTINGS)
@pytest.mark.parametrize("ratio", [1, 10, 100, 1000, 1e6])
@pytest.mark.parametrize("angle", [-1.4, -0.7, -0.4, -0.2])
def test_a_chain_that_is_thrown_over_and_jerks_gains_nothing(angle, ratio, substeps, solver):
    """Let go upwards it falls slack and snatches: its joints part for a moment, and no energy comes."""
    world = World(EFFECTS, substeps=substeps, solver=solver)
    chain(world, 12, ratio, angle)
    start, fall = energy(world), 12.0 * METRE * G * float(world.bodies["mass"].sum())
    worst = -math.inf
    for _ in range(4):
        run(world, 2.0)
        worst = max(worst, energy(world) - start)
    assert worst <= 0.005 * fall and np.isfinite(world.bodies["x"]).all()


@pytest.mark.parametrize("substeps", SETTINGS)
@pytest.mark.parametrize("angle", [0.0, 0.3, -0.5, 1.0, 2.5])
def test_a_cantilever_of_welds_does_not_sag(angle, substeps):
    world, before = World(EFFECTS, substeps=substeps), None
    x, y = math.cos(angle), math.sin(angle)
    for k in range(8):
        middle = METRE * (k + 0.5)
        beam = world.add_body(Polygon.box(METRE, METRE / 4.0), position=(middle * x, middle * y), angle=angle)
        world.add_joint(Weld(before, beam, at=(METRE * k * x, METRE * k * y)))
        before = beam
    tip = before.to_world((METRE / 2.0, 0.0))
    run(world, 5.0)
    assert math.dist(before.to_world((METRE / 2.0, 0.0)), tip) <= 20.0 * MM


@pytest.mark.parametrize("substeps", SETTINGS)
@pytest.mark.parametrize("slack", [1.02, 1.1, 1.3])
def test_a_bridge_of_160_planks_hangs_as_a_catenary(slack, substeps):
    """Its sag and the pull at its ends, against the curve of an equal chain."""
    count, plank = 160, 0.5 * METRE
    length = count * plank
    width = length / slack
    low, high = 1e-6, 50.0  # half of width / a, by sinh(u) / u = slack
    for _ in range(200):
        u = 0.5 * (low + high)
        low, high = (u, high) if math.sinh(u) / u < slack else (low, u)
    a = width / (2.0 * u)
    sag = a * (math.cosh(u) - 1.0)
    world = World(EFFECTS.with_(drag=True), drag=0.5, substeps=substeps)
    places = [-length / 2.0 + plank * k for k in range(count + 1)]  # by length, from the middle

    def at(s):
        return a * math.asinh(s / a), sag - (math.sqrt(a * a + s * s) - a)

    ids = []
    for s, e in zip(places, places[1:], strict=False):
        (x0, y0), (x1, y1) = at(s), at(e)
        body = world.add_body(
            Polygon.box(plank, 4.0),
            position=((x0 + x1) / 2, (y0 + y1) / 2),
            angle=math.atan2(y1 - y0, x1 - x0),
            filter=ALONE,
        )
        ids.append(body.id)
    mass = float(world.bodies["mass"].sum())
    world.add_joints(Revolute, [None, *ids], [*ids, None], at=[at(s) for s in places])
    worst = run(world, 20.0)
    assert worst <= 1.0 * MM
    middle = world.body(ids[count // 2]).position.y
    ends = world.joints[[0, -1]]
    assert middle == pytest.approx(sag, rel=0.01)
    assert np.abs(ends["force_y"]) == pytest.approx(0.5 * mass * G, rel=0.02)
    assert np.abs(ends["force_x"]) == pytest.approx(0.5 * mass * G / math.sinh(u), rel=0.03)
