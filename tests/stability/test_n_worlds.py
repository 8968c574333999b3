"""Worlds with joints (section N): masks, islands, broad phases, snapshots, time steps, units and sleep."""

import itertools
import math
import pickle

import numpy as np
import pytest

from physics import (
    Angle,
    BruteForce,
    Circle,
    Distance,
    Drive,
    DynamicTree,
    Gear,
    Motor,
    NoContact,
    PixelMask,
    Polygon,
    Prismatic,
    Pulley,
    Ratchet,
    Revolute,
    Snapshot,
    SpatialHashGrid,
    Spring,
    SweepAndPrune,
    Target,
    Weld,
    Wheel,
    World,
)
from tests.stability.invariants import movers
from tests.stability.jointed import ALONE, GRAVITY, Gaps, Period, Worst, along, energy, jointed, named, rod, run
from tests.stability.piles import SOLVERS, needs_speed
from tests.stability.settings import generator, phase
from tests.stability.test_n_joints import agm

PLANK = PixelMask(np.ones((6, 30), bool), snap=False)


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_n23_a_sprite_swings_as_its_pixels_weigh(measured, solver):
    """A hollow sprite on a pin swings with the period of a rigid pendulum that is made of its pixel squares.

    32 px are one metre.
    """
    solid = np.ones((24, 40), bool)
    solid[5:20, 6:30] = False
    world, amplitude = jointed(solver, gravity=(0.0, 32.0 * GRAVITY), pixels_per_meter=32.0), 0.3 + phase(1.2)
    y, x = np.argwhere(solid).T + 0.5
    pin = np.array([2.0, 12.0])
    middle = np.array([x.mean(), y.mean()])
    about = ((x - pin[0]) ** 2 + (y - pin[1]) ** 2 + 1.0 / 6.0).mean()  # moment of a mass of 1, squares of 1 px
    arm = math.dist(pin, middle)
    exact = 2.0 * math.pi * math.sqrt(about / (32.0 * GRAVITY * arm)) / agm(1.0, math.cos(amplitude / 2.0))
    turn = math.pi / 2.0 - amplitude - math.atan2(middle[1] - pin[1], middle[0] - pin[0])
    body = world.add_body(PixelMask(solid, origin=tuple(pin), snap=False), angle=turn)
    world.add_joint(Revolute(None, body, at=(0.0, 0.0)))
    period = Period(world, lambda: body.center.x)
    run(world, 12.0, period)
    measured("N23", named("error of a sprite's period", solver), abs(period.mean() / exact - 1.0))


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_n23_sprites_on_joints_fall_on_a_sprite_and_sleep(measured, solver):
    """A chain of eight sprites with friction in its hinges falls on a sprite and sleeps.

    Each sprite collides with all others except its neighbours.
    """
    changes = {"sleeping": True}
    world = jointed(solver, gravity=(0.0, 32.0 * GRAVITY), pixels_per_meter=32.0, effects=changes)
    world.add_body(PixelMask(np.ones((20, 400), bool), snap=False), position=(0.0, 110.0), kind="static")
    turn, before = 0.3 + phase(3.0), None
    for k in range(8):
        at = along(28.0 * (k - 3.5), turn)
        plank = world.add_body(PLANK, position=at, angle=turn)
        if before:
            friction = Drive(0.0, max=60.0 * plank.inertia)
            world.add_joint(Revolute(before, plank, at=along(28.0 * (k - 4), turn), motor=friction))
        before = plank
    gaps, gap = Gaps(world), Worst()
    run(world, 6.0, lambda: gap(gaps.worst()))
    measured("N23", named("greatest gap of a chain of sprites", solver), gap.value)
    measured("N23", named("sprites awake after 6 s", solver), movers(world)["awake"].sum())


def machine(solver, **more):
    """Return a world with every kind of joint, bodies in contact, and a swinging chain."""
    world = jointed(solver, effects={"sleeping": True}, **more)
    world.add_body(Polygon.box(60.0, 1.0), position=(0.0, 4.5), kind="static")
    box, turn = Polygon.box(0.6, 0.6), phase(1.0)

    def pair(k):
        a, b = (world.add_body(box, position=(-12.0 + 2.0 * k + x, 3.0), angle=turn * x) for x in (0.0, 0.9))
        return a, b, (-12.0 + 2.0 * k + 0.45, 3.0)

    kinds = (
        lambda a, b, at: Revolute(a, b, at=at, limits=(-0.5, 0.5)),
        lambda a, b, at: Prismatic(a, b, at=at, axis=(1, 2), motor=Drive(-1.0, 3.0)),
        lambda a, b, at: Wheel(a, b, at=at),
        lambda a, b, at: Distance(a, b, at_a=a.position, at_b=b.position, limits=(0.0, 1.0)),
        lambda a, b, at: Weld(a, b, at=at, spring=Spring(4.0)),
        lambda a, b, at: Angle(a, b, spring=Spring(2.0)),
        lambda a, b, at: Motor(a, b, max_force=2.0, max_torque=2.0, velocity=(0.1, 0.0)),
        lambda a, b, at: Target(b, at=b.position, point=(at[0], 1.0)),
        lambda a, b, at: NoContact(a, b),
        lambda a, b, at: Pulley(a, b, at_a=a.position, at_b=b.position, ground_a=(at[0], 0), ground_b=(at[0] + 1, 0)),
    )
    for k, kind in enumerate(kinds):
        world.add_joint(kind(*pair(k)))
    wheels = [world.add_body(Circle(0.4), position=(x, -2.0), angular_velocity=3.0) for x in (-3.0, -2.0)]
    hinges = [world.add_joint(Revolute(None, wheel, at=wheel.position)) for wheel in wheels]
    world.add_joint(Gear(*hinges, ratio=1.5))
    world.add_joint(Ratchet(None, wheels[0], ratchet=0.3))
    before = None
    for k in range(8):
        link = rod(world, along(0.5 * k, turn), along(0.5 * k + 0.5, turn))
        world.add_joint(Revolute(before, link, at=along(0.5 * k, turn)))
        before = link
    return world


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("seed", range(3))
def test_n24_joints_of_one_island_do_not_change_another(measured, seed, solver):
    def left_alone(extra):
        world, random = jointed(solver), generator(seed)
        bodies = [rod(world, (k, random.random()), (k + 1.0, 0.0)) for k in range(5)]
        for a, b in itertools.pairwise(bodies):
            world.add_joint(Revolute(a, b, at=(b.position.x - 0.5, 0.0)))
        if extra:
            far = [world.add_body(Polygon.box(1, 1), position=(200.0 + k, 0.0)) for k in range(3)]
            for a, b in itertools.pairwise(far):
                world.add_joint(Weld(a, b, at=(a.position.x + 0.5, 0.0)))
            world.add_joint(Revolute(None, far[0], at=(200.0, 0.0)))
        run(world, 1.5)
        return np.array([(*body.position, body.angle) for body in bodies])

    measured("N24", "change by another island", np.abs(left_alone(False) - left_alone(True)).max())


@pytest.mark.parametrize("solver", SOLVERS)
def test_n25_four_broad_phases_give_one_digest(measured, solver):
    digests = set()
    for strategy in (BruteForce(), SweepAndPrune(), SpatialHashGrid(), DynamicTree()):
        world = machine(solver, broadphase=strategy)
        run(world, 2.0)
        digests.add(world.digest())
    measured("N25", "digests", len(digests))


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("tier", ["iterative", "direct", "auto"])
def test_n26_a_snapshot_in_mid_swing_goes_on_alike(measured, tier, solver, tmp_path):
    """A snapshot taken in mid-swing gives equal digests in the same world, in new worlds, from a file and after
    pickling.
    """
    world = machine(solver, tier=tier)
    run(world, 0.7)
    taken, copied = world.snapshot(), pickle.loads(pickle.dumps(world))
    taken.save(tmp_path / "swing.npz")
    run(world, 0.7)
    digests = [world.digest()]
    for again in (world, machine(solver), World(world.effects, pixels_per_meter=1.0)):
        again.restore(taken if again is world else Snapshot.load(tmp_path / "swing.npz"))
        run(again, 0.7)
        digests.append(again.digest())
    run(copied, 0.7)
    measured("N26", "digests", len({*digests, copied.digest()}))


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_n27_steps_of_all_lengths(measured, solver):
    """Rods of 1 m with a ball of ten times their mass swing for 10 s with random steps of 1/240 to 1/30 s.

    Their joints hold, and no energy is gained.
    """
    world, random, before = jointed(solver), generator(27), None
    for k in range(8):
        link = rod(world, along(k, 0.0), along(k + 1.0, 0.0))
        world.add_joint(Revolute(before, link, at=along(k, 0.0)))
        before = link
    ball = world.add_body(Circle(0.5), position=(8.5, 0.0), mass=10.0 * before.mass, filter=ALONE)
    world.add_joint(Revolute(before, ball, at=(8.0, 0.0)))
    start, fall = energy(world), 8.0 * GRAVITY * float(world.bodies["mass"].sum())
    gaps, gap, won = Gaps(world), Worst(), Worst()
    while world.time < 10.0:
        world.step(random.uniform(1.0 / 240.0, 1.0 / 30.0))
        gap(gaps.worst())
        won((energy(world) - start) / fall)
    measured("N27", named("greatest gap", solver), gap.value)
    measured("N27", named("energy won, of the fall", solver), won.value)


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("scale", [1.0, 128.0])
def test_n28_a_world_in_other_units_moves_alike(measured, scale, solver):
    """A chain of rods moves identically in other units of length; the scale factors are powers of two."""

    def places(scale):
        world = jointed(solver, gravity=(0.0, GRAVITY * scale), pixels_per_meter=scale)
        before, turn = None, phase(1.5)
        for k in range(6):
            ends = [tuple(scale * x for x in along(0.5 * n, turn)) for n in (k, k + 1)]
            link = rod(world, *ends, breadth=0.125 * scale)
            spring = Spring(4.0, 0.3, target=0.1) if k == 3 else None
            world.add_joint(Revolute(before, link, at=ends[0], spring=spring))
            before = link
        run(world, 1.7)
        return world.bodies["x"] / scale

    measured("N28", "difference from 32 px to the metre", np.abs(places(scale) - places(32.0)).max())


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_n29_a_net_swings_and_sleeps_and_costs_nothing(measured, solver):
    """A net of 12 by 12 balls on 266 joints swings, sleeps, and then causes no work.

    It hangs on two corners, in a world with air drag. A ball thrown into it wakes it.
    """
    world = jointed(solver, effects={"sleeping": True, "drag": True}, drag=1.5)
    wide, step = 12, 0.5
    net = [
        [world.add_body(Circle(0.2), position=(step * i, step * j), filter=ALONE) for i in range(wide)]
        for j in range(wide)
    ]
    for j, i in itertools.product(range(wide), repeat=2):
        x, y = net[j][i].position
        if i:
            world.add_joint(Revolute(net[j][i - 1], net[j][i], at=(x - step / 2.0, y)))
        if j:
            world.add_joint(Revolute(net[j - 1][i], net[j][i], at=(x, y - step / 2.0)))
    for corner in (net[0][0], net[0][-1]):
        world.add_joint(Revolute(None, corner, at=corner.position))
    net[-1][0].velocity = 4.0 + phase(4.0), 0.0
    gaps, gap = Gaps(world), Worst()
    run(world, 4.0, lambda: gap(gaps.worst()))
    while world.time < 40.0 and world.bodies["awake"].any():
        world.step()
    measured("N29", named("greatest gap", solver), gap.value)
    measured("N29", named("balls awake after 40 s", solver), world.bodies["awake"].sum())
    if not world.bodies["awake"].any():
        world.step()
        measured("N29", named("joints solved while asleep", solver), world.profile.counters["joints_solved"])
