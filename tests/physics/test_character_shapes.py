"""Characters of every convex shape: never inside a solid, reported obstacles, cost, and equal compiled and plain
results.
"""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from physics import JIT, Capsule, Character, Circle, Effects, PixelMask, Polygon, Segment, TileGrid, World, collide
from physics.shapes.outline import outline_of
from tests.physics.slopes import SHAPES

EFFECTS = Effects(response=True, one_way=True)
SLOP = 0.16  # [px] of a world with 32 px per metre
REACH = 40.0  # [px] no shape of SHAPES goes so far from its origin
ROOT = Path(__file__).resolve().parents[2]


def random_solids(rng, count=14):
    """Return a list of (shape, pose) of rotated, round and thin shapes about the origin, none
    at a character's start.
    """
    found = []
    while len(found) < count:
        pick = rng.integers(6)
        size = rng.uniform(8, 40, 2)
        shape = (
            Circle(float(size[0])),
            Polygon.box(*size, angle=float(rng.uniform(0, 3))),
            Polygon(Polygon.box(*size, angle=float(rng.uniform(0, 3))).points, float(rng.uniform(1, 8))),
            Capsule((-size[0], 0), (size[0], float(rng.uniform(-20, 20))), float(rng.uniform(2, 9))),
            Segment((-size[0], float(rng.uniform(-30, 30))), (size[0], 0)),
            Polygon([(-size[0], 0), (size[0], float(rng.uniform(-20, 5))), (0, size[1])]),
        )[pick]
        pose = (*rng.uniform(-130, 130, 2).tolist(), float(rng.uniform(-3, 3)))
        if np.hypot(*pose[:2]) > 75:
            found.append((shape, pose))
    return found


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("seed", range(6 if JIT else 1))
def test_never_deeper_in_what_stands_than_the_slop(shape, seed):
    rng = np.random.default_rng(seed)
    form = SHAPES[shape][0]
    world, solids = World(EFFECTS), random_solids(rng)
    for solid, pose in solids:
        world.add_body(solid, position=pose[:2], angle=pose[2], kind="static")
    hero = Character(world, form, (0, 0), max_slope=float(rng.uniform(0, 1.5)))
    goal, moves = rng.normal(0, 3, 2), 0
    for n in range(400 if JIT else 60):
        if n % 25 == 0:
            goal = rng.normal(0, 3, 2)
        before = hero.position
        moved = hero.move(*(goal + rng.normal(0, 1, 2)).tolist())
        x, y = hero.position
        assert (x, y) == pytest.approx((before[0] + moved.x, before[1] + moved.y), abs=1e-9)
        moves += before != (x, y)
        for solid, pose in solids:
            manifold = collide(form, (x, y, 0.0), solid, pose)
            assert all(each >= -SLOP - 1e-9 for each in manifold.separations), (n, solid)
    assert moves > 20


@pytest.mark.parametrize("shape", [each for each in SHAPES if each != "box"])
def test_never_in_tiles_nor_in_pixels(shape):
    for seed in range(4 if JIT else 1):
        rng = np.random.default_rng(seed)
        form = SHAPES[shape][0]
        solid = rng.random((14, 14)) < 0.3
        solid[5:9, 4:10] = False
        slopes = np.zeros((14, 14, 2))
        slopes[(rng.random((14, 14)) < 0.15) & ~solid] = (0.0, 1.0)
        slopes[5:9, 4:10] = 0.0
        grid = TileGrid(solid, 16, slopes=slopes)
        noise = rng.random((40, 40)) < 0.5
        mask = PixelMask(np.kron(noise, np.ones((5, 5), bool)), origin=(0, 0))
        apart = World(EFFECTS)
        parts = [(part.shape, apart.add_body(part.shape).bounds) for part in outline_of(mask)]
        world = World(EFFECTS)
        world.add_body(grid, kind="static")
        world.add_body(mask, position=(300, 0), kind="static")
        tall = SHAPES[shape][0]
        clear = [p for p in ((110, 112),) if not len(collide(tall, (*p, 0), grid, (0, 0, 0)))]
        assert clear
        hero = Character(world, form, clear[0], max_slope=1.0)
        beside = Character(world, form, (285, 100), max_slope=1.0)
        for _ in range(300 if JIT else 40):
            hero.move(*rng.normal(0, 3, 2).tolist())
            beside.move(float(rng.normal(1.0, 2)), float(rng.normal(0, 3)))
            depths = collide(form, (*hero.position, 0.0), grid, (0, 0, 0)).separations
            assert all(each >= -SLOP - 1e-9 for each in depths), (seed, depths)
            x, y = beside.position
            for part, (left, top, right, bottom) in parts:
                if left - REACH < x - 300 < right + REACH and top - REACH < y < bottom + REACH:
                    depths = collide(form, (x, y, 0.0), part, (300, 0, 0)).separations
                    assert all(each >= -SLOP - 1e-9 for each in depths), (seed, depths)


@pytest.mark.parametrize("shape", SHAPES)
def test_blocked_says_what_a_move_of_a_pixel_would_do_and_changes_nothing(shape):
    rng = np.random.default_rng(3)
    world = World(EFFECTS)
    for solid, pose in random_solids(rng):
        world.add_body(solid, position=pose[:2], angle=pose[2], kind="static")
    Character(world, Polygon.box(12, 12), (14, 0), pushable=True)
    hero = Character(world, SHAPES[shape][0], (-10, 0))
    seen = set()
    for _ in range(60):
        hero.move(*rng.normal(0, 40, 2).tolist())
        kept = world.snapshot()
        for dx, dy in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            before = world.digest()
            told = hero.blocked(dx, dy)
            assert world.digest() == before
            rows = world.characters.rows
            rows["remainder_x"] = rows["remainder_y"] = 0.0
            start = hero.position
            hero.move(dx, dy)
            slid = rows["slope"][-1] != 0.0 and not rows["grounded"][-1] and dy > 0
            assert told == (hero.position == start) or slid, (dx, dy)
            seen.add(told)
            world.restore(kept)
    assert seen == {True, False} and not hero.blocked(0, 0)


@pytest.mark.parametrize("shape", SHAPES)
def test_one_way_planks_open_from_below_for_every_shape(shape):
    world = World(EFFECTS)
    plank = np.ones((1, 10), bool)
    world.add_body(TileGrid(np.zeros((1, 10), bool), 16, one_way=plank), position=(0, 0), kind="static")
    hero = Character(world, SHAPES[shape][0], (80, 40))
    assert hero.move(0, -80).y == -80
    assert hero.move(0, 60).grounded and hero.position[1] < 0 and hero.move(0, 5).y == 0
    assert hero.move(20, 0).x == 20 and hero.move(0, 0).grounded
    assert hero.move(0, 3, drop=True).y == 3 and hero.move(0, 30).y == 30


@pytest.mark.parametrize("shape", SHAPES)
def test_every_shape_pushes_and_is_carried(shape):
    world = World(EFFECTS)
    world.add_body(Polygon.box(600, 20), position=(0, 10), kind="static")
    crate = Character(world, Polygon.box(16, 16), (40, -8), pushable=True)
    hero = Character(world, SHAPES[shape][0], (0, -30))
    while not hero.move(0, 1).grounded:
        pass
    for _ in range(60):
        hero.move(1.0, 0.0)
    assert crate.position[0] > 60 and crate.position[1] == -8
    lift = world.add_body(Polygon.box(40, 10), position=(-100, -40), kind="kinematic", velocity=(50.0, -30.0))
    rider = Character(world, SHAPES[shape][0], (-100, -75))
    while not (moved := rider.move(0, 1)).grounded:
        pass
    assert moved.riding == lift
    start, base = rider.position, lift.position
    for _ in range(60):
        world.step()
        moved = rider.move(0, 0.5)
        assert moved.grounded and moved.riding == lift and not moved.squeezed
    assert rider.position[0] - start[0] == pytest.approx(lift.position[0] - base[0], abs=1.0)
    assert rider.position[1] - start[1] == pytest.approx(lift.position[1] - base[1], abs=1.0)


def test_a_turned_plank_carries_in_a_world_that_does_not_stack():
    world = World(EFFECTS)
    plank = world.add_body(Polygon.box(200, 10), position=(0, 0), angle=0.3, kind="kinematic", velocity=(30.0, -12.0))
    hero = Character(world, SHAPES["capsule"][0], (0, -40))
    while not hero.move(0, 1).grounded:
        pass
    start = hero.position
    for _ in range(60):
        world.step()
        assert hero.move(0, 0).riding == plank
    assert hero.position[0] - start[0] == pytest.approx(30.0, abs=1.0)
    assert hero.position[1] - start[1] == pytest.approx(-12.0, abs=1.0)


def test_what_is_far_away_is_not_looked_at():
    looked = []
    for count in (10, 2000):
        world = World(EFFECTS)
        world.add_body(Polygon.box(400, 20), position=(0, 30), kind="static")
        places = [(5000.0 + 40 * (k % 100), 5000.0 + 40 * (k // 100)) for k in range(count)]
        world.add_bodies(Polygon.box(16, 16), np.array(places), kind="static")
        hero = Character(world, SHAPES["box"][0], (0, 10))
        world.step()
        for _ in range(5):
            hero.move(1.0, 1.0)
        looked.append(world.queries.counters["pairs_tested"])
    assert looked[1] <= looked[0] + 4, looked


def test_its_place_is_the_origin_of_its_shape():
    world = World(EFFECTS)
    world.add_body(Polygon.box(400, 20), position=(0, 110), kind="static")
    off = Capsule((10, -20), (10, -5), 5)
    hero = Character(world, off, (50.0, 50.0))
    assert hero.position == hero.previous == (50.0, 50.0)
    while not hero.move(0, 1).grounded:
        pass
    assert hero.position == (50.0, 100.0), "its feet are where its origin is"
    hero.move_to((20.3, 40.4))
    assert hero.position == (20.0, 40.0)
    assert Character(world, Circle(5.5), (0.2, 0.0)).position == (0.5, 0.5), "left side and feet on whole pixels"


SCRIPT = """
import math, sys
import numpy as np
from physics import *
from physics import JIT
from tests.physics.slopes import SHAPES, add_ground
effects = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True, one_way=True, conveyor=True)
for form in ("polygon", "chain", "mask", "tiles", "capsule"):
    world = World(effects)
    add_ground(world, form, 0.5, kind="kinematic", velocity=(20.0, -9.0))
    world.add_body(Polygon([(60, -30), (160, -230), (160, 0), (60, 0)]), kind="static")
    heroes = [Character(world, shape, (-90 + 22 * k, -60.0 - 10 * k), max_slope=0.7) for k, (shape, _, _) in
              enumerate(SHAPES.values())]
    world.add_body(Polygon.box(12, 12), position=(-60, -120), angle=0.3)
    for step in range(30):
        for hero in heroes:
            moved = hero.move(1.7, 2.3)
            print(hero.position, moved.slope.hex(), moved.grounded, moved.wall, hero.blocked(1, 1))
        world.step()
        print(world.digest())
print("JIT" if JIT else "plain", file=sys.stderr)
"""


@pytest.mark.skipif(not JIT, reason="nothing to compare with")
def test_the_same_bits_compiled_and_plain():
    told = []
    for plain in (False, True):
        environment = {**os.environ, "PYTHONPATH": str(ROOT), "NUMBA_DISABLE_JIT": "1" if plain else "0"}
        found = subprocess.run(
            [sys.executable, "-c", SCRIPT], cwd=ROOT, env=environment, capture_output=True, text=True, timeout=600
        )
        assert found.returncode == 0, found.stderr
        assert found.stderr.strip().splitlines()[-1] == ("plain" if plain else "JIT")
        told.append(found.stdout.splitlines())
    assert len(told[0]) == 5 * 30 * (len(SHAPES) + 1) and told[0] == told[1]
