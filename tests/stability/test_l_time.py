"""Hard cases of time, repetition and long runs (section L): repeated runs, snapshots, other processes, an hour of
steps.
"""

import math
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
    Effects,
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
from tests.stability.settings import alone, generator
from tests.stability.test_compiled_and_plain import run
from tests.stability.worlds import heap

ROOT = Path(__file__).resolve().parents[2]
STEPS = 300 if JIT else 30


def zoo(solver="soft_step", broadphase=None, seed=3):
    """Return a world with a heap of every kind of shape, with bullets, sensors, a kinematic
    plate and sleeping bodies.
    """
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
def test_l2_snapshot_then_300_steps_restore_then_300_steps(measured, solver, tmp_path):
    """A world that is restored from a snapshot repeats 300 steps with the same digests.

    This holds in the same world, and in another world that loads the snapshot from a file.
    """
    world = zoo(solver)
    record(world, 60 if JIT else 10)
    taken, digest = world.snapshot(), world.digest()
    taken.save(tmp_path / "taken.npz")
    first = record(world, STEPS)
    other = zoo(solver, DynamicTree(), seed=3)
    for again, kept in ((world, taken), (other, Snapshot.load(tmp_path / "taken.npz"))):
        again.restore(kept)
        differ = again.digest() != digest
        differ += sum(one != two for one, two in zip(record(again, STEPS), first, strict=True))
        measured("L2", "digests that differ", differ)


def test_l2_snapshot_every_step_changes_nothing(measured):
    plain, watched = zoo(), zoo()
    first = record(plain, 60 if JIT else 10)
    found = []
    for _ in range(60 if JIT else 10):
        found += record(watched, 1)
        watched.restore(watched.snapshot())
    measured("L2", "digests that differ", sum(one != two for one, two in zip(found, first, strict=True)))


@needs_speed
@pytest.mark.parametrize("broadphase", [BruteForce, SweepAndPrune, DynamicTree])
def test_l1_every_broad_phase_gives_the_same_digests(measured, broadphase):
    runs = [record(zoo(broadphase=each()), 150) for each in (broadphase, SpatialHashGrid)]
    measured("L1", "digests that differ", sum(one != two for one, two in zip(*runs, strict=True)))


SCRIPT = """
import sys
from tests.stability.test_l_time import zoo, record, cairn
from tests.stability.settings import alone, generator
print(record(zoo(sys.argv[1]), 60)[-1][0])
print(cairn(sys.argv[1], 200))
"""


def cairn(solver, steps):
    """Drop eight balls and eighty boxes on a floor. Return (digest, step at which the last body
    fell asleep or None).
    """
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


@alone
@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_l1_fresh_processes_with_other_hash_seeds_agree(measured, solver):
    here = [record(zoo(solver), 60)[-1][0], str(cairn(solver, 200))]
    measured("L1", "digests that differ", here[1] != str(cairn(solver, 200)))
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
        measured(
            "L1",
            "digests that differ",
            sum(one != two for one, two in zip(found.stdout.splitlines(), here, strict=True)),
        )
        assert found.stdout.splitlines() == here


@needs_speed
def test_l3_jitter_of_a_ten_billionth_changes_no_statistics(measured):
    """An initial shift of 1e-10 changes the trajectories, but not the overlap, the energy or
    the mean height of a heap.
    """
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
    measured("L3", "difference of the mean height", abs(runs[0][0] - runs[1][0]))
    measured("L3", "deepest overlap of either", max(runs[0][1], runs[1][1]))
    measured("L3", "kinetic energy of either", max(runs[0][2], runs[1][2]))


def sag(h, count):
    """Return by how much a stack of `count` boxes may sag [m].

    It is one slop for each box, and more if the substep h [s] is too long for contacts of 30 Hz.
    """
    return count * 0.005 * max(1.0, (30.0 * 8.0 * h) ** 2)


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("change", ["a little every frame", "half as long at once", "half as long again at once"])
def test_l5_stack_stands_while_the_step_changes(measured, solver, change):
    world = metres(solver)
    floor(world)
    boxes = column(world, 10)
    watch = Watch(world).step(120)
    rng = generator(2)
    for _ in range(240):
        dt = {
            "a little every frame": (1 + 0.01 * rng.uniform(-1, 1)) / 60,
            "half as long at once": 1 / 120,
            "half as long again at once": 1 / 40,
        }[change]
        watch.step(dt=dt)
        measured("L5", "hop", -movers(world)["y"].min() - 9.5)
    measured("L5", "way of the top aside", abs(boxes[-1].position[0]))
    measured("L5", "rms speed", rms_speed(world))
    assert abs(-boxes[-1].position[1] - 9.5) < sag(dt / 4, 10)


@needs_speed
def test_l5_stack_stands_while_substeps_and_solvers_change(measured):
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
        measured("L5", "way of the top aside", abs(boxes[-1].position[0]))
        measured("L5", "rms speed", rms_speed(world))
        assert abs(-boxes[-1].position[1] - 9.5) < sag(world.dt / substeps, 10)


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
    """A mirrored heap of discs moves as the mirror image, within 1e-9.

    Boxes are excluded: their two contact points are solved in order, and mirroring exchanges the order.
    """
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


def hour(measured, steps, solver="soft_step"):
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
    measured("L6", "drift of the top", max(abs(boxes[-1].position[0] - x), abs(boxes[-1].position[1] - y)))
    measured("L6", "rms speed", max(speeds))
    measured("L6", "growth of the rms speed", np.mean(speeds[half:]) - np.mean(speeds[:half]))


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_l6_awake_stack_does_not_creep_for_a_minute(measured, solver):
    hour(measured, 3600, solver)


@pytest.mark.nightly
@needs_speed
def test_l6_awake_stack_does_not_creep_for_an_hour(measured):
    hour(measured, 216_000)


@needs_speed
@pytest.mark.parametrize("rate", [240, 1920, 15_360])
def test_l7_stack_at_any_rate_stays(measured, rate):
    """A stack of ten boxes is in the same position after 5 s and after 10 s at any step rate."""
    seconds = 5
    world = metres(dt=4 / rate)
    floor(world)
    boxes = column(world, 10)
    for _ in range(seconds * rate // 4):
        world.step()
    before = [box.position for box in boxes]
    for _ in range(seconds * rate // 4):
        world.step()
    drift = max(math.dist(box.position, at) for box, at in zip(boxes, before, strict=True))
    measured("L7", "drift in the second half", drift)


class Frames:
    """Clock of a game whose frame times [s] follow one of PATTERNS; the run ends after a number of frames."""

    PATTERNS = {
        "even": lambda rng, k: 1 / 60,
        "jitter": lambda rng, k: rng.uniform(0.005, 0.05),
        "stall": lambda rng, k: 1.0 if k == 20 else 1 / 60,
        "slow motion": lambda rng, k: 0.1 / 60,
        "paused": lambda rng, k: 0.0 if 10 < k < 40 else 1 / 75,
    }


@pytest.mark.parametrize("pattern", Frames.PATTERNS)
def test_l4_frames_of_any_length_give_the_same_steps(measured, pattern):
    """FixedStep, the game's accumulator, gives the same world steps for frames of any length.

    It makes a limited number of fixed steps per frame and drops the rest of a stall.
    """
    from game.run.loop import FixedStep

    rng, clock, digests, most, k, now = np.random.default_rng(4), FixedStep(1 / 60), [], 0, 0, 0.0
    world, plain = zoo(), zoo()
    clock.advance(now)
    while len(digests) < 40:
        now += Frames.PATTERNS[pattern](rng, k)
        steps = clock.advance(now)
        k, most = k + 1, max(most, steps)
        for _ in range(steps):
            world.step()
            digests.append(world.digest())
    right = []
    for _ in digests:
        plain.step()
        right.append(plain.digest())
    measured("L4", "digests that differ after the same steps", sum(a != b for a, b in zip(digests, right, strict=True)))
    measured("L4", "steps of one frame: a quarter of a second", most)


@pytest.mark.parametrize("solver", SOLVERS)
def test_l9_support_dragged_from_under_a_sleeper_takes_it_along_or_lets_it_fall(measured, solver):
    """A support that moves away at 0.15 m/s wakes the sleeping box on it, which is carried along or falls."""
    world = metres(solver, effects=pile_effects(sleeping=True))
    shelf = world.add_body(Polygon.box(4, 0.5), position=(0.0, 0.25), kind="kinematic")
    box = world.add_body(Polygon.box(1, 1), position=(0.0, -0.5), material=Material(friction=0.5))
    Watch(world).step(90)
    assert not box.awake
    shelf.velocity = (0.15, 0.0)
    watch, steps = Watch(world), 0
    while not box.awake and steps < 10:
        watch.step()
        steps += 1
    measured("L9", "steps until it wakes", steps)
    watch.step(120)
    measured("L9", "behind what carries it", abs(box.position[0] - shelf.position[0]))
    shelf.velocity = (0.0, 0.15)
    watch.step(120)
    measured("L9", "gap to what it lies on", abs(box.position[1] - shelf.position[1] + 0.75))
    shelf.velocity = (0.0, 0.0)
    watch.step(120)
    assert not box.awake
    shelf.remove()
    watch.step(2)
    measured("L9", "steps until it wakes", 2 if box.awake and box.velocity[1] > 0.0 else 99)


@pytest.mark.parametrize("solver", SOLVERS)
def test_l10_woken_bodies_stay_where_they_lay(measured, solver):
    """Woken boxes of a column sink by no more than a slop, because their cached contacts hold them, and sleep again."""
    world = metres(solver, effects=pile_effects(sleeping=True))
    floor(world)
    boxes = column(world, 3)
    Watch(world).step(120)
    assert not any(box.awake for box in boxes)
    before = [box.position for box in boxes]
    for k in range(3):
        boxes[k].wake()
        watch = Watch(world, passive=True)
        for _ in range(60):
            watch.step()
            measured("L10", "way of a woken box", max(map(math.dist, (box.position for box in boxes), before)))
        assert not any(box.awake for box in boxes)


@pytest.mark.parametrize("share", [0.05, 0.5, 1.0, 1.5, 1.95, 2.1])
def test_l11_spring_by_forces_swings_as_symplectic_euler_says(measured, share):
    """A spring made of forces oscillates as symplectic Euler predicts: v -= w² x h, then x += v h.

    For w h < 2 it oscillates forever with an amplitude of at most 1 / sqrt(1 - (w h / 2)²).
    """
    world = World(Effects(response=True), gravity=(0, 0), dt=1 / 60)
    ball = world.add_body(Circle(1.0), position=(1.0, 0.0))
    stiffness, widest = ball.mass * (share / world.dt) ** 2, 0.0
    for _ in range(2000 if JIT else 400):
        ball.apply_force((-stiffness * ball.position[0], 0.0))
        world.step()
        if abs(ball.position[0]) > 1e9:
            break
        widest = max(widest, abs(ball.position[0]))
    if share < 2.0:
        measured("L11", "swing over that of the closed form", widest * math.sqrt(1.0 - share**2 / 4.0))
    else:
        measured("L11", "swing beyond the limit", widest)


@pytest.mark.skipif(not JIT, reason="nothing to compare with")
def test_l12_compiled_and_plain_kernels_give_the_same_bits(measured):
    """Compiled and plain kernels give identical digests. Other scenes: test_compiled_and_plain.py."""
    compiled, plain = (run("response", "hash", each) for each in (False, True))
    assert len(compiled) == 40
    measured("L12", "lines that differ", sum(one != two for one, two in zip(compiled, plain, strict=True)))
