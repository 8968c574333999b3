"""The same run twice, from a snapshot, in another process, far away, mirrored, weighed anew (hard_cases L, J, I6, U8,
U9)."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from physics import (
    JIT,
    BruteForce,
    Capsule,
    Chain,
    Circle,
    DynamicTree,
    Material,
    PixelMask,
    Polygon,
    Segment,
    Snapshot,
    SpatialHashGrid,
    SweepAndPrune,
    TileGrid,
    World,
)
from tests.stability.invariants import Watch, deepest, kinetic, movers, rms_speed
from tests.stability.piles import SOLVERS, column, floor, metres, needs_speed, pile_effects
from tests.stability.worlds import heap

ROOT = Path(__file__).resolve().parents[2]
STEPS = 300 if JIT else 30


def zoo(solver="soft_step", broadphase=None, seed=3):
    """Every kind of shape in one heap, with bullets, sensors, a kinematic plate, sleepers."""
    rng = np.random.default_rng(seed)
    world = World(
        pile_effects(
            continuous=True, sleeping=True, sensors=True, persist=True, one_way=True, conveyor=True, drag=True
        ),
        broadphase,
        solver=solver,
        drag=0.05,
    )
    solid, slopes = np.zeros((3, 24), bool), np.zeros((3, 24, 2))
    solid[2], slopes[1, 6], slopes[1, 7] = True, (0, 1), (1, 0)
    one_way = np.zeros((3, 24), bool)
    one_way[0, 12:15] = True
    world.add_body(TileGrid(solid, 16, one_way=one_way, slopes=slopes), position=(0, 150), kind="static")
    world.add_body(
        Chain([(0, 0), (60, 20), (130, 25)]), position=(-100, 160), kind="static", material=Material(surface_speed=30.0)
    )
    world.add_body(Segment((0, -90), (0, 90)), position=(390, 100), kind="static")
    world.add_body(Polygon.box(60, 10), position=(300, 120), kind="kinematic", velocity=(-20, 0))
    world.add_body(Circle(30.0), position=(200, 100), kind="static", sensor=True)
    mask = PixelMask(rng.random((14, 18)) < 0.8)
    shapes = [
        lambda: (Circle(6.0, (1, 0)),),
        lambda: (Polygon.box(14, 9),),
        lambda: (Capsule((-6, 0), (6, 0), 4.0),),
        lambda: (Polygon([(-7, 5), (8, 5), (0, -8)], radius=1.5),),
        lambda: (mask,),
        lambda: (Polygon.box(6, 18, (-6, 0)), Polygon.box(12, 6, (3, 6))),
    ]
    for k in range(30):
        world.add_body(
            *shapes[k % 6](),
            position=tuple(rng.uniform((10, -160), (370, 130))),
            angle=0.0 if k % 6 == 4 else rng.uniform(0, 6),
            velocity=tuple(rng.normal(0, 150, 2)),
            bullet=k % 11 == 0 and k % 6 != 4,
            material=Material(
                restitution=0.3 * (k % 3), friction=0.2 + 0.1 * (k % 5), rolling_resistance=0.02 * (k % 2)
            ),
        )
    return world


def record(world, steps):
    found = []
    for _ in range(steps):
        world.step()
        found.append((world.digest(), len(world.events.begin), len(world.events.end), len(world.events.hits)))
    return found


@pytest.mark.parametrize("solver", SOLVERS)
def test_snapshot_then_300_steps_restore_then_300_steps(solver, tmp_path):
    """In the same world, and in another one from a file: the same digests all the way, nothing hidden elsewhere."""
    world = zoo(solver)
    record(world, 60 if JIT else 10)
    taken, digest = world.snapshot(), world.digest()
    taken.save(tmp_path / "taken.npz")
    first = record(world, STEPS)
    world.restore(taken)
    assert world.digest() == digest
    assert record(world, STEPS) == first
    other = zoo(solver, DynamicTree(), seed=3)
    other.restore(Snapshot.load(tmp_path / "taken.npz"))
    assert other.digest() == digest
    assert record(other, STEPS) == first


def test_snapshot_every_step_changes_nothing():
    plain, watched = zoo(), zoo()
    first = record(plain, 60 if JIT else 10)
    found = []
    for _ in range(60 if JIT else 10):
        found += record(watched, 1)
        watched.restore(watched.snapshot())
    assert found == first


@needs_speed
@pytest.mark.parametrize("broadphase", [BruteForce, SweepAndPrune, DynamicTree])
def test_every_broad_phase_gives_the_same_digests(broadphase):
    assert record(zoo(broadphase=broadphase()), 150) == record(zoo(broadphase=SpatialHashGrid()), 150)


SCRIPT = """
import sys
from tests.stability.test_runs_alike import zoo, record, cairn
print(record(zoo(sys.argv[1]), 60)[-1][0])
print(cairn(sys.argv[1], 200))
"""


def cairn(solver, steps):
    """Digest of eight balls and eighty boxes that fall on a floor and sleep,
    and the step at which the last one does."""
    world = metres(solver, effects=pile_effects(sleeping=True))
    floor(world)
    world.add_bodies(Circle(0.4), [(1.0 * k - 3.5, -4.0 - 0.3 * k) for k in range(8)])
    for row in range(4):
        world.add_bodies(Polygon.box(0.5, 0.5), [(0.7 * k - 7.0, -0.5 - 0.7 * row) for k in range(20)])
    asleep = None
    for n in range(steps):
        world.step()
        if asleep is None and not movers(world)["awake"].any():
            asleep = n
    return world.digest(), asleep


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_fresh_processes_with_other_hash_seeds_agree(solver):
    here = [record(zoo(solver), 60)[-1][0], str(cairn(solver, 200))]
    assert here[1] == str(cairn(solver, 200))
    for seed in ("0", "12345"):
        found = subprocess.run(
            [sys.executable, "-c", SCRIPT, solver],
            cwd=ROOT,
            capture_output=True,
            text=True,
            timeout=300,
            env={**os.environ, "PYTHONHASHSEED": seed, "PYTHONPATH": str(ROOT)},
        )
        assert found.returncode == 0, found.stderr
        assert found.stdout.splitlines() == here


@needs_speed
def test_jitter_of_a_ten_billionth_changes_no_statistics():
    """The trajectories part in the end; depth, energy and where the heap lies do not."""
    runs = []
    for jitter in (0.0, 1e-10):
        world = metres()
        floor(world)
        for row in range(5):
            world.add_bodies(
                Polygon.box(0.5, 0.5), [(0.7 * k - 3.0 + jitter * (k + row), -0.5 - 0.7 * row) for k in range(9)]
            )
        Watch(world, passive=True).step(400)
        runs.append((movers(world)["y"].mean(), deepest(world), kinetic(world)))
    assert runs[0][0] == pytest.approx(runs[1][0], abs=0.05)
    assert max(runs[0][1], runs[1][1]) <= 0.01 and max(runs[0][2], runs[1][2]) < 1e-3


def sag(h, count):
    """What a stack may sink: a slop per box, and more where substeps h are too long for contacts of 30 Hz."""
    return count * 0.005 * max(1.0, (30.0 * 8.0 * h) ** 2)


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("change", ["a little every frame", "half as long at once", "half as long again at once"])
def test_stack_stands_while_the_step_changes(solver, change):
    world = metres(solver)
    floor(world)
    boxes = column(world, 10)
    watch = Watch(world).step(120)
    rng = np.random.default_rng(2)
    for _ in range(240):
        dt = {
            "a little every frame": (1 + 0.01 * rng.uniform(-1, 1)) / 60,
            "half as long at once": 1 / 120,
            "half as long again at once": 1 / 40,
        }[change]
        watch.step(dt=dt)
        assert -movers(world)["y"].min() <= 9.5 + 0.05, "nothing hops"
    assert (
        abs(boxes[-1].position[0]) < 0.05
        and abs(-boxes[-1].position[1] - 9.5) < sag(dt / 4, 10)
        and rms_speed(world) < 0.05
    )


@needs_speed
def test_stack_stands_while_substeps_and_solvers_change():
    world = metres()
    floor(world)
    boxes = column(world, 10)
    watch = Watch(world).step(60)
    for substeps, solver in (
        (3, "soft_step"),
        (8, "soft_step"),
        (2, "soft_step"),
        (4, "sequential_impulse"),
        (4, "soft_step"),
    ):
        world.substeps, world.solver = substeps, solver
        watch.step(60)
        assert (
            abs(-boxes[-1].position[1] - 9.5) < sag(world.dt / substeps, 10)
            and abs(boxes[-1].position[0]) < 0.05
            and rms_speed(world) < 0.05
        )


def test_zero_dt_moves_nothing_and_keeps_the_contacts():
    world = metres()
    floor(world)
    column(world, 4)
    Watch(world).step(30)
    before, poses = len(world.contacts), world.bodies[["x", "y", "angle", "vx", "vy"]].copy()
    Watch(world).step(dt=0.0)
    assert len(world.contacts) == before and (world.bodies[["x", "y", "angle", "vx", "vy"]] == poses).all()
    Watch(world).step(30)
    assert rms_speed(world) < 0.05


# --- far away, mirrored, in another order, of another mass ------------------------------------------------------------


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("density", [1e-6, 1e6])
def test_mass_cancels(solver, density):
    steps = 60 if JIT else 20
    # Rounding differs, and a heap multiplies it: compared while it falls together.
    assert heap(solver=solver, density=density, steps=20) == pytest.approx(
        heap(solver=solver, steps=20), rel=1e-9, abs=1e-9
    )
    power = 2.0 ** (20 if density > 1 else -20)
    assert (heap(solver=solver, density=power, steps=steps) == heap(solver=solver, steps=steps)).all(), (
        "to the bit for powers of two"
    )


@pytest.mark.parametrize("solver", SOLVERS)
def test_mirrored_heap_of_discs_is_mirrored(solver):
    """Within 1e-9. (The two points of a box are solved one after the other: mirrored, the other one is first.)"""
    steps = 60 if JIT else 20
    one, two = (heap(solver=solver, mirror=sign, steps=steps, round_only=True) for sign in (1.0, -1.0))
    assert two == pytest.approx(one, abs=1e-9)


@pytest.mark.parametrize("solver", SOLVERS)
def test_order_of_making_changes_only_rounding_before_the_heap_forms(solver):
    steps = 25 if JIT else 15
    order = np.random.default_rng(1).permutation(16)
    one, two = heap(solver=solver, steps=steps), heap(solver=solver, order=order, steps=steps)
    assert np.median(np.abs(one - two)) <= 1e-9


# --- an hour ----------------------------------------------------------------------------------------------------------


def hour(steps, solver="soft_step"):
    world = metres(solver)
    floor(world)
    boxes = column(world, 10)
    Watch(world, passive=True).step(600)
    x, y = boxes[-1].position
    speeds = []
    for n in range(steps):
        world.step()
        if n % 60 == 0:
            speeds.append(rms_speed(world))
    half = len(speeds) // 2
    assert abs(boxes[-1].position[0] - x) <= 0.01 and abs(boxes[-1].position[1] - y) <= 0.01
    assert max(speeds) <= 1e-3 and np.mean(speeds[half:]) <= np.mean(speeds[:half]) + 1e-6


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_awake_stack_does_not_creep_for_a_minute(solver):
    hour(3600, solver)


@pytest.mark.nightly
@needs_speed
def test_awake_stack_does_not_creep_for_an_hour():
    hour(216_000)
