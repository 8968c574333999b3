"""Masks at exact poses (snap=False) in worlds: contacts, sensors, queries, one-way tiles and snapshots, compiled and
plain.
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
    Bounds,
    BruteForce,
    Chain,
    Circle,
    DynamicTree,
    Effects,
    Filter,
    Material,
    PixelMask,
    Polygon,
    Snapshot,
    SpatialHashGrid,
    TileGrid,
    World,
    collide,
    debug,
)

ROOT = Path(__file__).resolve().parents[2]
BAR = PixelMask(np.ones((2, 20), bool), snap=False)
BLOCK = PixelMask(np.ones((4, 4), bool), snap=False)
SNAPPED = PixelMask(np.ones((4, 4), bool))
QUARTER = math.pi / 4


def met(world):
    return set(zip(world.contacts["body_a"].tolist(), world.contacts["body_b"].tolist(), strict=True))


@pytest.mark.parametrize("broadphase", [BruteForce, DynamicTree])
def test_a_world_without_response_tells_who_shares_area_at_exact_poses(broadphase):
    world = World(Effects(), broadphase())
    a = world.add_body(BLOCK)
    near = world.add_body(BLOCK, position=(3.75, 0.0))  # 4 px wide: in by a quarter of a pixel
    touching = world.add_body(BLOCK, position=(-4.0, 0.0))
    tip = world.add_body(BLOCK, position=(0.0, 2.0 + 4.0 * math.sqrt(0.5) - 0.9), angle=QUARTER)
    snapped = world.add_body(SNAPPED, position=(0.2, -3.4))  # drawn at -3: in by one pixel
    ball = world.add_body(Circle(1.0), position=(-2.5, -2.5))  # its middle outside of a corner, 0.71 px from it
    world.step()
    pairs = met(world)
    assert {(a.id, near.id), (a.id, tip.id), (a.id, snapped.id), (a.id, ball.id)} <= pairs
    assert (a.id, touching.id) not in pairs
    assert all(len(world.overlap(BLOCK, (x, 0.0, 0.0))) == n for x, n in ((40.0, 0), (7.75, 0), (7.5, 1)))


def test_a_turning_mask_comes_and_goes_between_the_angles_of_the_buckets():
    """A rotating bar begins and ends to touch a dot at the exact angles.

    Its drawn picture has only the angles of the buckets; the contact does not depend on them.
    """
    world = World(Effects(rotation=True))
    bar = world.add_body(BAR, angular_velocity=0.3, kind="kinematic")
    angle = 0.35
    dot = world.add_body(Circle(0.125), position=(9.0 * math.cos(angle), 9.0 * math.sin(angle)), kind="static")
    seen = []
    for _ in range(120):
        world.step()
        if (bar.id, dot.id) in met(world):
            seen.append(bar.angle)
    half = math.asin((1.0 + 0.125) / 9.0)
    assert seen[0] == pytest.approx(angle - half, abs=0.3 / 60.0) and seen[-1] == pytest.approx(angle + half, abs=0.006)


def test_a_mask_that_moves_by_parts_of_a_pixel_is_a_candidate_in_time():
    world = World(Effects(), SpatialHashGrid())
    a = world.add_body(BLOCK, kind="static")
    b = world.add_body(BLOCK, position=(20.0, 0.3), angle=0.4, velocity=(-7.0, 0.0))
    reach = 2.0 + 2.0 * (math.cos(0.4) + math.sin(0.4))  # until the leftmost corner is at the side
    for _ in range(200):
        world.step()
        if b.position.x > reach + 1e-9:
            assert not len(world.contacts)
        elif b.position.x < reach - 0.2:
            assert met(world) == {(a.id, b.id)}
            break
    else:
        pytest.fail("they never met")


def test_sensors_see_masks_at_exact_poses():
    world = World(Effects(sensors=True))
    world.add_body(BLOCK, sensor=True)
    world.add_body(BLOCK, position=(4.0, 0.0), velocity=(-6.0, 0.0))
    began = []
    for _ in range(3):
        world.step()
        began.append(len(world.events.sensor_begin))
    assert began == [1, 0, 0]
    world = World(Effects(sensors=True))
    world.add_body(BLOCK, sensor=True)
    world.add_body(BLOCK, position=(4.0, 0.0))
    world.step()
    assert not len(world.events.sensor_begin)


def test_questions_meet_the_squares_where_they_are():
    world = World(Effects())
    body = world.add_body(BAR, position=(100.25, 50.0), angle=QUARTER)
    c = math.cos(QUARTER)
    for along, across, inside in ((9.9, 0.9, True), (9.9, 1.1, False), (-9.9, -0.9, True), (10.1, 0.0, False)):
        point = (100.25 + c * (along - across), 50.0 + c * (along + across))
        assert (world.query_point(point) == [body]) is inside, (along, across)
        assert (world.overlap(Circle(1e-3), (*point, 0.0)) == [body]) is inside
    hit = world.ray_cast((100.25 - 20.0, 50.0), (40.0, 0.0))
    assert hit.point == pytest.approx((100.25 - math.sqrt(2.0), 50.0)) and hit.normal == pytest.approx((-c, c))
    hit = world.shape_cast(Circle(1.0), (100.25 - 20.0, 50.0, 0.0), (40.0, 0.0))
    assert hit.fraction * 40.0 == pytest.approx(20.0 - 2.0 * math.sqrt(2.0)) and hit.normal == pytest.approx((-c, c))
    _, point, gap = world.closest((100.25 - 5.0 * c, 50.0 + 5.0 * c))
    assert gap == pytest.approx(4.0) and point == pytest.approx((100.25 - c, 50.0 + c))


@pytest.mark.parametrize("response", [False, True])
def test_a_one_way_tile_holds_what_comes_from_above(response):
    grid = TileGrid([[False] * 4], 16.0, one_way=[[response] * 4])  # detection alone has no one-way tiles
    for speed, met_it in ((60.0, True), (-60.0, False)):
        effects = Effects(response=True, one_way=True) if response else Effects()
        world = World(effects, solver="projection" if response else None)
        world.add_body(grid, kind="static")
        body = world.add_body(BAR, position=(32.0, -8.4 if speed > 0 else 24.3), velocity=(0.0, speed), angle=0.1)
        seen = 0
        for _ in range(30):
            world.step()
            seen += len(world.contacts)
        assert (seen > 0) is (met_it and response)
        assert response or body.position.y == pytest.approx(-8.4 + 30.0 if speed > 0 else 24.3 - 30.0)


def test_what_is_pushed_out_shares_nothing_to_rounding():
    world = World(Effects(response=True), solver="projection")
    world.add_body(PixelMask(np.ones((6, 40), bool), snap=False), kind="static", angle=0.3)
    body = world.add_body(BLOCK, position=(1.0, -5.0), angle=0.7)
    bar = next(iter(world))
    poses = [(*each.position, each.angle) for each in (bar, body)]
    before = collide(bar.shapes[0], poses[0], BLOCK, poses[1])
    world.step()
    assert len(before) == 1 and len(world.events.begin) == 1
    moved = body.position - poses[1][:2]
    assert moved.dot(before.normal) == pytest.approx(-before.separations[0], abs=0.17), "out, but for the slop"
    left = collide(bar.shapes[0], poses[0], BLOCK, (*body.position, body.angle)).area
    assert left < 0.2 * before.area
    assert world.contacts["area"].tolist() == pytest.approx([left]), "the verdict where they ended"


def test_flipped_scaled_and_values_of_its_own_keep_it_unsnapped():
    mask = PixelMask(np.eye(3, dtype=bool), (1, 2), snap=False)
    own = mask.with_(Material(2.0), Filter(2), sensor=False)
    for made in (mask.flipped(x=True), mask.flipped(y=True), mask.scaled(2.0), own, own.flipped(x=True).scaled(0.5)):
        assert made.snap is False and "snap=False" in repr(made)
    assert own.flipped(x=True).filter == Filter(2) and own.bare is mask
    assert PixelMask(np.eye(3, dtype=bool)).flipped(x=True).scaled(2.0).snap is True
    pygame = pytest.importorskip("pygame")
    surface = pygame.Surface((3, 2), pygame.SRCALPHA)
    surface.fill((1, 2, 3, 255))
    made = [PixelMask.from_surface(surface, snap=False), PixelMask.from_array([[True]], snap=False)]
    assert not any(each.snap for each in (*made, PixelMask.from_mask(pygame.mask.Mask((3, 2), True), snap=False)))


@pytest.mark.parametrize("response", [False, True])
def test_a_mask_that_turns_is_drawn_for_pictures_only(response):
    """A rotating exact mask is rasterised for drawing only; collision tests read its original pixels."""
    world = World(Effects(rotation=True, sensors=True, response=response))
    world.add_body(Chain([(-40.0, 0.0), (40.0, 0.0)]), kind="static", position=(0.0, 6.0))
    bar = world.add_body(BAR, angular_velocity=1.5, kind="kinematic")
    world.add_body(Bounds(BAR), position=(60.0, 0.0), angular_velocity=1.5)
    ring = world.add_body(BLOCK, position=(0.0, 5.0), angular_velocity=1.0, sensor=True)
    seen = set()
    for _ in range(120):
        world.step()
        for begun in (world.events.begin, world.events.sensor_begin):
            seen |= set(zip(begun["body_a"].tolist(), begun["body_b"].tolist(), strict=True))
        world.query_point((0.0, 0.0))
        world.overlap(BAR, (0.0, 0.0, 0.5))
    assert (bar.id, ring.id) in seen and (0, ring.id) in seen and ((0, bar.id) in seen or response)
    assert world.library.rasters.count == len(world.library.masks), "each as it was added"
    pictures = {shape: solid for shape, _, _, solid in debug.masks(world)}
    assert np.array_equal(pictures[bar.shape_ids[0]], BAR.turned(bar.angle).solid)
    world.add_body(SNAPPED, position=(90.0, 0.0), angle=0.7)
    known = world.library.rasters.count
    world.step()
    assert world.library.rasters.count == known + (not response), "what is snapped is tested as it is drawn"


def pair_of(snap):
    world = World(Effects())
    world.add_body(PixelMask(np.ones((4, 4), bool), snap=snap))
    world.add_body(PixelMask(np.ones((4, 4), bool), snap=snap), position=(3.75, 0.0))
    return world


def test_snapshots_and_digests_tell_whether_masks_are_snapped(tmp_path):
    world = pair_of(False)
    assert world.digest() != pair_of(True).digest() and world.digest() == pair_of(False).digest()
    world.snapshot().save(tmp_path / "exact.npz")
    other = World(Effects())
    other.restore(Snapshot.load(tmp_path / "exact.npz"))
    assert other.digest() == world.digest() and [shape.snap for body in other for shape in body.shapes] == [False] * 2
    for each in (world, other):
        each.step()
    assert len(other.contacts) == 1 and other.digest() == world.digest()


def test_a_library_that_is_tidied_up_keeps_exact_masks():
    world = World(Effects())
    a = world.add_body(BAR, angle=0.3)
    b = world.add_body(BLOCK, position=(6.0, 3.5))
    world.step()
    before = world.contacts.copy()
    for k in range(200):
        world.remove_body(world.add_body(PixelMask(np.ones((3, 3 + k % 5), bool), snap=k % 2 == 0), position=(500, 0)))
    assert len(world.library.masks) < 100, "it was tidied"
    world.step()
    assert met(world) == {(a.id, b.id)} and world.contacts["feature"].tolist() == before["feature"].tolist()


SCRIPT = """
import sys, math, numpy as np
from physics import *
rng = np.random.default_rng(6)
solid = [rng.random((int(h), int(w))) < .7 for h, w in ((9, 7), (12, 70), (5, 5), (1, 20))]
masks = [PixelMask(each, tuple(rng.uniform(0, 6, 2)), snap=k == 2) for k, each in enumerate(solid)]
others = [Circle(4, (1, 0)), Polygon.box(9, 5), Capsule((-3, 0), (3, 1), 2), Polygon([(0, 0), (6, 1), (2, 5)], 1.5),
          Segment((-6, 0), (5, 2)), Bounds(masks[0]),
          TileGrid([[True, False, True]], 6, slopes=[[(0, 0), (0, 1), (0, 0)]])]
for k in range(60):
    a, b = masks[k % 2], (*masks, *others)[k % 11]
    turned = 0.0 if isinstance(b, TileGrid) else float(rng.choice([0, math.pi / 2, rng.uniform(-7, 7)]))
    pose_a = (*rng.uniform(-4, 4, 2), float(rng.choice([0, -math.pi, rng.uniform(-7, 7)])))
    pose_b = (*rng.uniform(-6, 6, 2), turned)
    m, d = collide(a, pose_a, b, pose_b), distance(a, pose_a, b, pose_b)
    print(m.normal, m.points.tolist(), m.separations.tolist(), m.features.tolist(), m.area, d.distance)
world = World(Effects(rotation=True, sensors=True), DynamicTree())
for k in range(40):
    world.add_body((*masks, *others[:4], others[5])[k % 9], position=tuple(rng.uniform(0, 60, 2)), sensor=k % 7 == 0,
                   angle=float(rng.uniform(0, 6)), velocity=tuple(rng.normal(0, 60, 2)),
                   angular_velocity=float(rng.normal(0, 2)))
for _ in range(20):
    world.step()
    hit = world.ray_cast((-10, 30), (90, 7))
    print(world.digest(), len(world.contacts), world.contacts["area"].sum(), hit and hit.fraction)
print("JIT" if JIT else "plain", file=sys.stderr)
"""


def run(plain):
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "NUMBA_DISABLE_JIT": "1" if plain else "0"}
    found = subprocess.run(
        [sys.executable, "-c", SCRIPT], cwd=ROOT, env=environment, capture_output=True, text=True, timeout=300
    )
    assert found.returncode == 0, found.stderr
    assert found.stderr.strip().splitlines()[-1] == ("plain" if plain else "JIT")
    return found.stdout.splitlines()


@pytest.mark.skipif(not JIT, reason="nothing to compare with")
def test_exact_masks_give_the_same_bits_compiled_and_plain():
    compiled, plain = run(False), run(True)
    assert len(compiled) == 80 and compiled == plain
    assert sum("[]" not in line for line in compiled[:60]) > 20, "most of them meet"


def test_a_box_of_a_mask_that_turns_is_tight_in_the_broad_phase():
    world = World(Effects(rotation=True))
    world.add_body(BAR, angle=QUARTER)
    world.add_body(Bounds(BAR), position=(100.0, 0.0), angle=QUARTER)
    world.step()
    half = 11.0 * math.sqrt(0.5)
    for row, x in ((0, 0.0), (1, 100.0)):
        box = [world.shapes[name][row] for name in ("min_x", "min_y", "max_x", "max_y")]
        assert box == pytest.approx([x - half, -half, x + half, half])
    assert len(world.overlap(Polygon.box(1.0, 1.0), (100.0 - half, -half, 0.0))) == 1
    assert not len(world.overlap(Polygon.box(1.0, 1.0), (-half, -half, 0.0))), "open: beside the bar, in its box"
