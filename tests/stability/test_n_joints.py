"""Pendulums, chains, beams and bridges on joints (section N), checked against closed forms, energy and the catenary."""

import math

import numpy as np
import pytest

from physics import JIT, Circle, Revolute, Weld
from tests.stability.jointed import (
    ALONE,
    GRAVITY,
    NAIVE,
    Gaps,
    Period,
    Worst,
    along,
    energy,
    jointed,
    named,
    rod,
    run,
    worst_in,
)
from tests.stability.piles import SOLVERS, needs_speed
from tests.stability.settings import phase

SHARE = 1.0 if JIT else 0.02  # of the time that is simulated, where only greatest values are measured


def agm(a, b):
    """Return the arithmetic-geometric mean of two numbers."""
    while abs(a - b) > 1e-15 * a:
        a, b = (a + b) / 2.0, math.sqrt(a * b)
    return a


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_n1_a_pendulum_keeps_its_period_its_energy_and_its_pin(measured, solver):
    """A pendulum of a disc 2 m from its pin keeps its period, energy and pin for a minute.

    It is released at 1 rad; other phases release it at 0.25 to 2.5 rad.
    """
    amplitude = 0.25 + (0.75 + phase(2.5)) % 2.5
    world = jointed(solver)
    bob = world.add_body(Circle(0.25), position=along(2.0, math.pi / 2.0 - amplitude))
    world.add_joint(Revolute(None, bob, at=(0.0, 0.0)))
    length = 2.0 + bob.inertia / (bob.mass * 2.0)
    exact = 2.0 * math.pi * math.sqrt(length / GRAVITY) / agm(1.0, math.cos(amplitude / 2.0))
    start, fall = energy(world), bob.mass * GRAVITY * 2.0 * (1.0 - math.cos(amplitude))
    period, gaps, worst = Period(world, lambda: bob.position.x), Gaps(world), Worst()
    run(world, 60.0, lambda: (period(), worst(gaps.worst())))
    wide = "" if amplitude < 1.5 else ", beyond 1.5 rad"
    measured("N1", named(f"error of the period{wide}", solver), abs(period.mean() / exact - 1.0))
    measured("N1", named(f"change of the energy, of the fall{wide}", solver), abs(energy(world) - start) / fall)
    measured("N1", named(f"error of the pin{wide}", solver), worst.value)


def double_pendulum(world):
    """Add two rods of 1 m and return the potential energy of their fall [J].

    The first rod is released level, the second bent by up to 1 rad.
    """
    at, before = (0.0, 0.0), None
    for turn in (0.0, -phase(1.0)):
        end = at[0] + math.cos(turn), at[1] + math.sin(turn)
        link = rod(world, at, end)
        world.add_joint(Revolute(before, link, at=at))
        before, at = link, end
    return energy(world) + sum(body.mass * GRAVITY * (0.5 + k) for k, body in enumerate(world))


def fall_of_two(measured, world, name):
    """Let a double pendulum swing for 30 s and check its energy and pins. name: suffix of the figures."""
    fall, start = double_pendulum(world), energy(world)
    worst = worst_in(world, SHARE * 30.0)
    measured("N2", f"change of the energy, of the fall{name}", abs(energy(world) - start) / fall)
    measured("N2", f"error of a pin{name}", worst)


@pytest.mark.parametrize("solver", SOLVERS)
def test_n2_a_double_pendulum_keeps_its_energy(measured, solver):
    fall_of_two(measured, jointed(solver), named("", solver))


def test_n2_more_substeps_are_not_worse(measured):
    fall_of_two(measured, jointed(substeps=16), ", 16 substeps")


def chain(world, links, ratio, angle):
    """Add a straight chain of 1 m links from the origin at an angle, with a ball of `ratio`
    times the mass of a link.
    """
    before = None
    for k in range(links):
        link = rod(world, along(k, angle), along(k + 1.0, angle))
        world.add_joint(Revolute(before, link, at=along(k, angle)))
        before = link
    ball = world.add_body(Circle(0.5), position=along(links + 0.5, angle), mass=ratio * before.mass, filter=ALONE)
    world.add_joint(Revolute(before, ball, at=along(links, angle)))


def swing(measured, row, ratio, solver):
    """Let a chain of 30 links swing for 20 s and check its pins and its energy.

    It is level in the first phase and slopes by up to 0.8 rad in the others.
    """
    world = jointed(solver)
    chain(world, 30, ratio, phase(0.8))
    start, fall, won = energy(world), 30.0 * GRAVITY * float(world.bodies["mass"].sum()), Worst()
    gaps, gap = Gaps(world), Worst()
    run(world, SHARE * 12.0, lambda: (gap(gaps.worst()), won((energy(world) - start) / fall)))
    measured(row, named("greatest gap of the swing", solver), gap.value)
    run(world, SHARE * 8.0)
    measured(row, named("gap after 20 s", solver), gaps.worst())
    measured(row, named("energy won, of the fall", solver), won.value)


def naive_swing(measured, row, ratio):
    """Let a chain of 30 links swing for 12 s with the iterative joint solver, and record the greatest gap.

    With four substeps the joints separate.
    """
    world = jointed(tier=NAIVE, substeps=4)
    chain(world, 30, ratio, phase(0.8))
    measured(row, "greatest gap, iterative tier", worst_in(world, SHARE * 12.0))


@pytest.mark.parametrize("solver", SOLVERS)
def test_n3_a_chain_swings(measured, solver):
    swing(measured, "N3", 1.0, solver)


@needs_speed
def test_n3_without_trees_it_parts(measured):
    naive_swing(measured, "N3", 1.0)


@pytest.mark.parametrize("solver", SOLVERS)
def test_n4_a_chain_holds_a_ball_of_a_hundred_links(measured, solver):
    swing(measured, "N4", 100.0, solver)


@needs_speed
def test_n4_without_trees_it_parts(measured):
    naive_swing(measured, "N4", 100.0)


@pytest.mark.parametrize("solver", SOLVERS)
def test_n5_a_chain_holds_a_ball_of_a_thousand_links(measured, solver):
    swing(measured, "N5", 1000.0, solver)


@needs_speed
def test_n5_without_trees_it_parts(measured):
    naive_swing(measured, "N5", 1000.0)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("ratio", [1.0, 100.0, 1e6])
def test_n6_a_chain_that_is_thrown_over_gains_no_energy(measured, ratio, solver):
    """A chain of 12 links released upwards falls slack and snaps tight without a gain of energy; its pins part for a
    moment.
    """
    world = jointed(solver)
    chain(world, 12, ratio, -0.2 - phase(1.3))
    start, fall, won = energy(world), 12.0 * GRAVITY * float(world.bodies["mass"].sum()), Worst()
    gaps, gap = Gaps(world), Worst()
    run(world, SHARE * 8.0, lambda: (won((energy(world) - start) / fall), gap(gaps.worst())))
    assert np.isfinite(world.bodies["x"]).all()
    measured("N6", "energy won, of the fall", won.value)
    measured("N6", named("greatest gap", solver), gap.value)


def cantilever(world, angle):
    """Weld eight beams of 1 m to the world at an angle [rad]. Return the greatest deviation of the tip in 5 s [m]."""
    before = None
    for k in range(8):
        beam = rod(world, along(k, angle), along(k + 1.0, angle), 0.25)
        world.add_joint(Weld(before, beam, at=along(k, angle)))
        before = beam
    worst = Worst()
    run(world, SHARE * 5.0, lambda: worst(math.dist(before.to_world((0.5, 0.0)), along(8.0, angle))))
    return worst.value


@pytest.mark.parametrize("solver", SOLVERS)
def test_n7_a_cantilever_does_not_sag(measured, solver):
    measured("N7", named("tip off", solver), cantilever(jointed(solver), phase(-1.2)))


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_n7_without_trees_it_sags(measured, solver):
    world = jointed(solver, tier=NAIVE, substeps=4)
    measured("N7", named("tip off, iterative tier", solver), cantilever(world, phase(-1.2)))


def catenary(length, slack):
    """Return (a, half width / a, sag) of a catenary y = a cosh(x / a).

    length: length of the curve. slack: length divided by the distance of its ends.
    """
    low, high = 1e-6, 50.0  # sinh(u) / u = slack
    for _ in range(200):
        u = 0.5 * (low + high)
        low, high = (u, high) if math.sinh(u) / u < slack else (low, u)
    a = length / slack / (2.0 * u)
    return a, u, a * (math.cosh(u) - 1.0)


def hung_bridge(world, count, plank, width):
    """Add `count` planks from (-width / 2, 0) to (width / 2, 0) in the shape of a V. Return (ids, weight [N])."""
    down = math.sqrt((count * plank) ** 2 - width**2) / 2.0
    at = [(width * (k / count - 0.5), down * (1.0 - abs(2.0 * k / count - 1.0))) for k in range(count + 1)]
    ids = [rod(world, one, two).id for one, two in zip(at, at[1:], strict=False)]
    world.add_joints(Revolute, [None, *ids], [*ids, None], at=at)
    return ids, float(world.bodies["mass"].sum()) * GRAVITY


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_n8_a_bridge_of_160_planks_hangs_as_a_catenary(measured, solver):
    """A bridge of 160 planks (80 m) hangs as a catenary.

    It settles with drag for 12 s, then hangs without drag for half a second. Drag reduces the speed that gravity adds
    in a substep before the joints act, so the resting forces would read too low.
    """
    count, plank = 160, 0.5
    slack = 1.02 + phase(0.3)
    _, u, sag = catenary(count * plank, slack)
    world = jointed(solver, effects={"drag": True}, drag=2.0)
    ids, weight = hung_bridge(world, count, plank, count * plank / slack)
    gaps, worst = Gaps(world), Worst()
    run(world, 12.0, lambda: worst(gaps.worst()))
    world.drag = 0.0
    run(world, 0.5)
    ends, middle = world.joints[[0, -1]], world.body(ids[count // 2]).to_world((-plank / 2.0, 0.0))[1]
    load, pull = weight / 2.0, weight / 2.0 / math.sinh(u)
    measured("N8", named("greatest gap", solver), worst.value)
    measured("N8", named("gap at rest", solver), gaps.worst())
    measured("N8", named("error of the sag", solver), abs(middle / sag - 1.0))
    measured("N8", named("error of the load on its ends", solver), np.abs(np.abs(ends["force_y"]) / load - 1.0).max())
    measured("N8", named("error of its pull", solver), np.abs(np.abs(ends["force_x"]) / pull - 1.0).max())


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_n15_a_bridge_breaks_at_its_force(measured, solver):
    """A bridge of 20 planks breaks at its breaking force under a growing load in the middle.

    The pull of the end joints is computed from the plank poses by statics.
    """
    count, plank, width = 20, 0.5, 9.5
    world = jointed(solver, effects={"drag": True}, drag=4.0)
    ids, weight = hung_bridge(world, count, plank, width)
    run(world, 3.0)
    world.drag = 1.0
    force = weight * (3.0 + phase(6.0))
    for joint in map(world.joint, world.joints["id"].tolist()):
        joint.breaks = (force, None)
    load, pull, half = 0.0, [], ids[: count // 2]
    while not len(world.events.broken) and world.time < 60.0:
        load += 0.0005 * force
        middle = world.body(half[-1]).to_world((plank / 2.0, 0.0))
        world.body(half[-1]).apply_force((0.0, load / 2.0), middle)
        world.body(ids[count // 2]).apply_force((0.0, load / 2.0), middle)
        world.step()
        rows = world.bodies[world.rows(half)]
        upright = (weight + load) / 2.0
        moment = upright * width / 2.0 - weight / 2.0 * (middle[0] - float(rows["center_x"].mean()))
        pull.append(math.hypot(upright, moment / middle[1]))
    broken = world.events.broken
    assert len(broken) and set(broken["reason"]) == {"force"} and broken["joint"][0] in (0, count), "at an end"
    measured("N15", named("error of the pull at which it breaks", solver), abs(pull[-1] / force - 1.0))
    measured("N15", named("force told, of its limit", solver), float(broken["force"].min()) / force)
