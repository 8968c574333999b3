"""Bodies thrown at walls of 1 to 3 pixels: with continuous collision none passes, without it most do (sections D and
G).
"""

import itertools
import math

import numpy as np
import pytest

from physics import JIT, Circle, Effects, PixelMask, Polygon, World
from tests.stability.throws import PILES, PUSHES, TOLD, Throw, fly, thin_wall, throws

SQUARE_27 = PixelMask(np.ones((27, 27), bool))
COUNT, TEETH = (250, 60) if JIT else (8, 8)
WAYS = {
    "soft_step": (PILES, "soft_step", "auto"),
    "sequential_impulse": (PILES, "sequential_impulse", "auto"),
    "projection": (PUSHES, "projection", "auto"),
    "blocking": (PUSHES, "blocking", "auto"),
    "ray": (PILES, "soft_step", "ray"),
    "swept": (PILES, "soft_step", "swept"),
    "toi": (PILES, "soft_step", "toi"),
}


@pytest.mark.parametrize("way", WAYS)
def test_none_passes(way):
    effects, solver, mode = WAYS[way]
    seed = sorted(WAYS).index(way)
    passed = [number for number, throw in enumerate(throws(COUNT, seed)) if fly(throw, effects, solver, mode)[0]]
    assert not passed, f"of seed {seed}"


@pytest.mark.parametrize("seed, number", [(1, 138), (4, 28), (102, 1848), (103, 1777)])
def test_those_that_once_passed(seed, number):
    """Throws that once passed a thin wall now collide with it and do not pass, under both solvers.

    Some of the bodies overlapped thin parts of an outline deeply. Others had thin arms that passed the wall before half
    of the body did.
    """
    throw = next(itertools.islice(throws(number + 1, seed), number, None))
    for solver in ("soft_step", "sequential_impulse"):
        assert fly(throw, PILES, solver) == (False, True)


@pytest.mark.parametrize("solver", ["soft_step", "sequential_impulse"])
@pytest.mark.parametrize("thickness, through", [(1, 3.0), (2, 3.0), (2, 5.0), (3, 2.0)])
def test_who_stands_deep_in_a_rim_is_led_back_out_of_all_of_its_parts(thickness, through, solver):
    """A slow square with a corner beyond the rim of a ring is pushed back inside by all of the rim's parts."""
    wall, half = thin_wall("ring", thickness), 13.5
    for place in range(48) if JIT else (6, 14):
        way = math.tau * place / 48 + 0.013
        u, v = math.cos(way), math.sin(way)
        reach = half * (abs(math.cos(1.7 * way)) + abs(math.sin(1.7 * way)))
        away = 149.0 + through - reach
        throw = Throw(wall, "ring", 0.0, SQUARE_27, (away * u, away * v), 2.7 * way, (600.0 * u, 600.0 * v), 0.0)
        assert not fly(throw, PILES, solver)[0], place


def fast(count, seed):
    """Yield `count` throws whose motion in one step is greater than the thickness of the body plus that of the wall."""
    quick = (each for each in throws(50 * count, seed) if np.hypot(*each.velocity) > 60.0 * 44.0)
    return itertools.islice(quick, count)


def test_most_pass_without():
    passed = sum(fly(throw, PILES.with_(continuous=False), "soft_step")[0] for throw in fast(TEETH, 5))
    assert passed > 0.3 * TEETH, "the test has teeth"


@pytest.mark.parametrize("mode", ["auto", "toi", "swept", "ray"])
def test_where_nothing_is_pushed_the_wall_is_told_of_whoever_flew_through_it(mode):
    unmet, flown = [], 0
    for number, throw in enumerate(throws(COUNT, 7)):
        passed, met = fly(throw, TOLD, None, mode)
        flown += passed
        if passed and not met:
            unmet.append(number)
    assert not unmet and flown > 0.9 * COUNT
    silent = [fly(throw, TOLD.with_(continuous=False)) for throw in fast(TEETH, 5)]
    assert sum(passed and not met for passed, met in silent) > 0.3 * len(silent), "the test has teeth"


@pytest.mark.nightly
@pytest.mark.parametrize("part", range(20))
def test_ten_thousand_throws(part):
    for throw in throws(500, 1000 + part):
        assert not fly(throw, PILES, "soft_step" if part % 2 else "sequential_impulse")[0], throw
        passed, met = fly(throw, TOLD)
        assert met or not passed, throw


SQUARE = PixelMask(np.ones((8, 8), bool), snap=False)


@pytest.mark.parametrize("snap", [True, False])
@pytest.mark.parametrize("shape", ["mask", "circle", "box"])
def test_the_point_of_an_event_is_that_of_the_first_shared_area(shape, snap):
    """At 3,000 px/s, the begin event on a wall 1 px thick has the point and time of the first overlap.

    The point is on the wall's face to a fraction of a pixel, at the height that the body has at this time.
    """
    for start in (60.3, 71.9, 83.04):
        world = World(Effects(continuous=True))
        wall = world.add_body(PixelMask(np.ones((200, 1), bool), snap=snap), position=(100.5, 0.0), kind="static")
        thrown = {"mask": PixelMask(np.ones((8, 8), bool), snap=snap), "circle": Circle(4), "box": Polygon.box(8, 8)}
        body = world.add_body(thrown[shape], position=(start, 0.0), velocity=(3000.0, 1200.0))
        begins, ends = [], 0
        for _ in range(4):
            world.step()
            begins += world.events.begin.tolist()
            ends += len(world.events.end)
        assert len(begins) == 1 and ends == 1
        assert begins[0][:4] == (wall.id, body.id, *wall.shape_ids, *body.shape_ids)
        x, y, nx, ny = begins[0][4:]
        assert x == pytest.approx(100.0, abs=1e-6) and (nx, ny) == pytest.approx((-1.0, 0.0), abs=1e-6)
        assert y == pytest.approx((100.0 - 4.0 - start) * 0.4, abs=4.0 + 1e-6)


@pytest.mark.parametrize("depth, told", [(-0.5, False), (0.0, False), (1e-4, True), (0.3, True)])
def test_a_graze_that_shares_no_area_is_no_event(depth, told):
    for other in (SQUARE, Polygon.box(8, 8)):
        world = World(Effects(continuous=True))
        world.add_body(SQUARE, kind="static")
        world.add_body(other, position=(-50.0, -8.0 + depth), velocity=(6000.0, 0.0))
        world.step()
        assert len(world.events.begin) == told


def test_corners_that_touch_share_no_area():
    """Two squares that pass diagonally collide only if they share area, not if their corners touch exactly."""
    for by, told in ((0.0, False), (0.01, True)):
        world = World(Effects(continuous=True))
        world.add_body(SQUARE, kind="static")
        world.add_body(SQUARE, position=(-58.0, 42.0 + by), velocity=(6000.0, -6000.0))
        world.step()
        assert len(world.events.begin) == told, by


def test_a_spinning_stick_meets_what_its_end_sweeps_over():
    """A stick that makes half a turn in a step collides with a pixel that neither end pose touches (docs/stability.md,
    D17, G14).
    """
    effects = Effects(continuous=True, rotation=True)
    stick, dot = PixelMask(np.ones((1, 40), bool), snap=False), PixelMask(np.ones((1, 1), bool), snap=False)
    for place, told in (((0.0, 15.0), True), ((0.0, 19.0), True), ((0.0, 22.0), False), ((13.0, 13.0), True)):
        world = World(effects)
        world.add_body(dot, position=place, kind="static")
        world.add_body(stick, angular_velocity=60.0 * np.pi)
        world.step()
        assert len(world.events.begin) == told, place


def test_hollow_things_are_met_by_their_pixels():
    """A ball inside a ring collides only with the rim's pixels, not with the ring's convex hull (docs/stability.md,
    D10).
    """
    at = np.hypot(*np.indices((40, 40)) - 19.5)
    ring = PixelMask((at <= 20.0) & (at > 16.0), snap=False)
    for speed, told in ((300.0, 0), (2000.0, 1)):
        world = World(Effects(continuous=True))
        world.add_body(ring, kind="static")
        world.add_body(Circle(2.0), position=(-5.0, 0.0), velocity=(speed, 0.0), continuous="toi")
        world.step()
        assert len(world.events.begin) == told


@pytest.mark.parametrize("ball, wall", [(True, False), (False, True)])
def test_fast_masks_through_thin_sensors_and_fast_sensors_through_masks(ball, wall):
    """A fast mask and a thin sensor that cross get one begin and one end event (docs/stability.md, G16), and a sensor
    stops no solid body.
    """
    effects = Effects(response=True, stacking=True, rotation=True, continuous=True, sensors=True)
    for thin in (PixelMask(np.ones((60, 1), bool)), Polygon.box(1, 60)):
        for shape in (PixelMask(np.ones((6, 6), bool)), Circle(3)):
            if isinstance(thin, Polygon) and isinstance(shape, Circle):
                continue
            world = World(effects, gravity=(0, 0))
            world.add_body(thin, kind="static", sensor=wall)
            body = world.add_body(shape, position=(-31.7, 0.0), velocity=(3000.0, 0.0), sensor=ball)
            begins = ends = 0
            for _ in range(6):
                world.step()
                begins, ends = begins + len(world.events.sensor_begin), ends + len(world.events.sensor_end)
                assert not len(world.events.begin)
            assert (begins, ends) == (1, 1), (thin, shape)
            assert body.position.x == pytest.approx(-31.7 + 300.0) and body.velocity == (3000.0, 0.0)
