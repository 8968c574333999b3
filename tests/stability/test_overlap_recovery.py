"""Bodies that start inside one another, and that cannot fit (hard_cases F9 to F12, F27): gently apart, never out."""

import numpy as np
import pytest

from physics import Circle, Polygon
from tests.stability.invariants import Watch, deepest, kinetic, movers, rms_speed
from tests.stability.piles import SLOP, SOLVERS, floor, metres, needs_speed, pile_effects

PUSH = 3.0  # [m/s] the fastest that overlapping bodies are pushed apart


@pytest.mark.parametrize("solver", SOLVERS)
def test_pyramid_that_starts_a_quarter_inside_itself(solver):
    world = metres(solver)
    floor(world)
    for row in range(4):
        world.add_bodies(Polygon.box(1, 1), [(0.75 * (k - (3 - row) / 2), -0.5 - 0.75 * row) for k in range(4 - row)])
    top = -movers(world)["y"].min()
    watch, highest = Watch(world), 0.0
    for _ in range(300):
        watch.step()
        highest = max(highest, -movers(world)["y"].min())
    # Each row may leave the one below it at the speed of a push-out; apart, the top one lies at 3.5.
    assert watch.fastest <= 2 * PUSH and highest <= 3.5 + 0.5 > top, "pushed out, not shot out"
    assert kinetic(world) < 1e-3 and deepest(world) <= 2 * SLOP


@needs_speed
@pytest.mark.parametrize("solver", SOLVERS)
def test_a_hundred_boxes_at_one_point(solver):
    """Finite, the same every time, no faster than ten push-outs, and apart within 10 s.

    Sequential impulses keep the speed that their bias gives, here 41 push-outs: they are allowed sixty.
    """
    limit = {"soft_step": 10, "sequential_impulse": 60}[solver] * PUSH
    runs = []
    for _ in range(2):
        world = metres(solver, gravity=(0, 0), effects=pile_effects(gravity=False, friction=False))
        world.add_bodies(Polygon.box(1, 1), np.zeros((100, 2)))
        watch = Watch(world, without=("U6",))  # under sequential impulses the last of it goes as slowly as what settles
        watch.step(60)
        assert watch.fastest <= limit
        runs.append(world.digest())
    assert runs[0] == runs[1]
    watch.step(540)
    assert watch.fastest <= limit and deepest(world) <= SLOP
    rows = movers(world)
    spread = sorted((np.ptp(rows["x"]), np.ptp(rows["y"])))
    assert spread[1] > 5.0 and (spread[0] > 5.0 or solver == "sequential_impulse"), "not all along one line"
    drift = np.hypot(rows["vx"].mean(), rows["vy"].mean())
    assert drift < 1e-9 * max(1.0, watch.fastest)


def crowd(side, steps, walls="box"):
    """More discs than there is room for in a closed box, as side x side; the share of the area is that of F11."""
    world = metres(effects=pile_effects())
    width, height = side * 0.8, side * 0.78
    for x, y, w, h in (
        (0, height / 2 + 1, width + 4, 2),
        (0, -height / 2 - 1, width + 4, 2),
        (-width / 2 - 1, 0, 2, height),
        (width / 2 + 1, 0, 2, height),
    ):
        world.add_body(Polygon.box(w, h), position=(x, y), kind="static")
    at = [
        ((i - (side - 1) / 2) * width / (side + 0.3), (j - (side - 1) / 2) * height / (side + 0.3))
        for j in range(side)
        for i in range(side)
    ]
    world.add_bodies(Circle(0.5), at)
    watch, speeds = Watch(world), []
    for _ in range(steps):
        watch.step()
        speeds.append(rms_speed(world))
    rows = movers(world)
    assert (np.abs(rows["x"]) < width / 2 + 0.5).all() and (np.abs(rows["y"]) < height / 2 + 0.5).all(), "none escapes"
    half = len(speeds) // 2
    assert speeds[-1] <= 1.0 and np.mean(speeds[half:]) <= np.mean(speeds[:half]) + 0.05, "no heat builds up"


@needs_speed
def test_more_discs_than_fit_stay_in_and_calm():
    crowd(10, 300)


@pytest.mark.deep
@needs_speed
def test_625_discs_in_room_for_496_stay_in_and_calm():
    crowd(25, 600)


@needs_speed
def test_discs_crushed_by_plates_stay_between_them():
    """Overlap grows with the crushing; nothing gets out through the walls."""
    world = metres(gravity=(0, 0), effects=pile_effects(gravity=False))
    for y in (-5.0, 5.0):
        world.add_body(Polygon.box(40, 2), position=(0.0, y), kind="static")
    plates = [
        world.add_body(Polygon.box(2, 8.0), position=(side * 8.0, 0.0), kind="kinematic", velocity=(-side * 1.0, 0.0))
        for side in (-1, 1)
    ]
    world.add_bodies(Circle(0.5), [(1.0 * (i - 3.5), 1.0 * (j - 3.5)) for i in range(8) for j in range(8)])
    watch, depths = Watch(world), []
    for _ in range(5):
        watch.step(60)
        rows = movers(world)
        assert (np.abs(rows["x"]) <= plates[1].position[0]).all() and (np.abs(rows["y"]) <= 4.5).all()
        depths.append(deepest(world))
        if plates[1].position[0] < 3.6:
            break
    assert depths[-1] > depths[0]


@pytest.mark.parametrize("solver", SOLVERS)
@pytest.mark.parametrize("depth", [0.5 * SLOP, SLOP, 4 * SLOP, 20 * SLOP])
def test_overlap_at_the_start_goes_without_a_pop(solver, depth):
    """It resolves to within a slop; the box never jumps up by more than a slop, nor faster than a push-out."""
    world = metres(solver)
    floor(world)
    box = world.add_body(Polygon.box(1, 1), position=(0.0, -0.5 + depth))
    watch, rise = Watch(world), 0.0
    for _ in range(120):
        watch.step()
        rise = max(rise, -box.position[1] - 0.5)
    assert watch.fastest <= PUSH * (1 + 1e-9) + 10 * world.dt and rise <= SLOP
    assert -1e-9 <= deepest(world) <= 1.001 * SLOP and abs(box.position[1] + 0.5) <= 1.001 * SLOP
    assert (
        abs(box.position[0]) <= (1e-5 if depth <= SLOP else 0.01 * depth)
        and abs(box.angle) < 1e-3 * depth
        and kinetic(world) < 1e-9
    )
