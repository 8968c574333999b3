"""Masks at exact poses (snap=False), compared with shapely.

Compared are the test for overlap of the pixel squares, the shared area and the depth.
"""

import math

import numpy as np
import pytest

from physics import JIT, PixelMask, collide, distance
from physics.collision.narrow_phase import NarrowPhase, no_work
from physics.shapes.library import Library, place
from physics.shapes.placement import refresh_aabbs
from physics.tables.body import BODY
from physics.tables.shape import SHAPE

pytest.importorskip("shapely")
from tests.oracles.squares import at, random_pose, union_of  # noqa: E402

SLIVER = 2.0**-30  # [px] 9e-10: along a side of a few pixels it is more than …
LEAST = 1e-9  # [px2] an area that a verdict must see
QUARTERS = [k * math.pi / 2 for k in range(-4, 8)]


def plane(width, height):
    """Return the pixels of an airplane: a body, wings and a tail."""
    solid = np.zeros((height, width), bool)
    solid[:, width * 3 // 8 : width * 5 // 8] = True
    solid[height // 2 : height * 5 // 8] = True
    solid[-height // 8 :, width // 4 : width * 3 // 4] = True
    return solid


def disc(size):
    y, x = np.mgrid[0:size, 0:size] + 0.5 - size / 2
    return x * x + y * y <= size * size / 4


def ragged(seed, width, height, density):
    solid = np.random.default_rng(seed).random((height, width)) < density
    solid[0, 0] = True
    return solid


RING = np.pad(np.zeros((9, 9), bool), 2, constant_values=True)
SPRITES = {
    "planes": (plane(32, 32), plane(24, 28)),
    "discs": (disc(32), disc(20)),
    "ragged": (ragged(1, 23, 17, 0.6), ragged(2, 12, 31, 0.3)),
    "wide": (ragged(3, 130, 6, 0.7), ragged(4, 66, 5, 0.4)),
    "lines": (np.ones((1, 40), bool), np.eye(18, dtype=bool)),
    "a pixel in a ring": (RING, np.ones((1, 1), bool)),
    "a ring in a ring": (np.pad(np.zeros((18, 18), bool), 1, constant_values=True), RING),
}
ORIGIN = (3.25, -1.5)


def masks_of(name, snap=False):
    one, two = SPRITES[name]
    return PixelMask(one, snap=False), PixelMask(two, ORIGIN, snap=snap)


def drawn(mask, pose):
    """Return the union of a mask's pixel squares at a pose, as a shapely figure.

    A snapped mask is rotated and rounded to whole pixels; another one is at its exact pose.
    """
    if not mask.snap:
        return at(union_of(mask.solid.tolist(), mask.origin), pose)
    turned = mask.turned(pose[2])
    left, top = (math.floor(place - origin + 0.5) for place, origin in zip(pose[:2], turned.origin, strict=True))
    return union_of(turned.solid.tolist(), (-left, -top))


def verdicts(a, pose_a, b, poses, full=False):
    """Return (hits (n,) bool, areas (n,) [px²]) of mask a against mask b at each of the n `poses`.

    The narrow phase of a world computes them. full: True to compute areas too, False for tests of overlap only.
    """
    library, bodies, shapes = Library(), np.zeros(1 + len(poses), BODY), np.zeros(1 + len(poses), SHAPE)
    for row, (mask, pose) in enumerate([(a, pose_a), *((b, pose) for pose in poses)]):
        place(library, mask, bodies, shapes, row, pose)
    refresh_aabbs(np.arange(len(shapes)), library.tables, bodies, shapes)
    rows = np.arange(1, len(shapes))
    pairs = np.stack([0 * rows, rows], axis=1)
    found = NarrowPhase(full, False, False).collide(library, bodies, shapes, pairs, 0.0, no_work())
    hits, areas = np.zeros(len(poses), bool), np.zeros(len(poses))
    hits[found["candidate"]], areas[found["candidate"]] = True, found["area_1"]
    return hits, areas


def check_verdicts(name, snap, seed, count):
    """Check random poses, half of them near touching. Return (number of hits, number of misses within 2 px)."""
    rng = np.random.default_rng(seed)
    a, b = masks_of(name, snap)
    pose_a = (*rng.uniform(-50.0, 50.0, 2), float(rng.choice([0.0, 1.0, QUARTERS[int(rng.integers(12))]])))
    fixed = drawn(a, pose_a)
    loose = union_of(b.solid.tolist(), b.origin)
    centred = at(fixed, (-pose_a[0], -pose_a[1], 0.0))
    poses = [random_pose(rng, centred, loose, near=number % 2 == 0) for number in range(count)]
    poses = [(x + pose_a[0], y + pose_a[1], angle) for x, y, angle in poses]
    others = [drawn(b, pose) for pose in poses]
    truth = np.array([fixed.intersection(other).area for other in others])
    hits, _ = verdicts(a, pose_a, b, poses)
    told, areas = verdicts(a, pose_a, b, poses, full=True)
    wrong = np.flatnonzero((hits != (truth > LEAST)) & ((truth > LEAST) | (truth == 0.0)))
    assert not len(wrong), [(poses[k], truth[k]) for k in wrong[:5].tolist()]
    assert (told == hits).all() and (areas[told] > 0.0).all()
    assert np.abs(areas - truth).max() < 1e-9
    near = sum(fixed.distance(others[k]) < 2.0 for k in np.flatnonzero(~hits).tolist())
    return int(hits.sum()), near


@pytest.mark.parametrize("snap", [False, True])
@pytest.mark.parametrize("name", SPRITES)
def test_masks_meet_where_the_union_of_their_squares_shares_area(name, snap):
    count = 160 if JIT else 50
    hits, near = check_verdicts(name, snap, 5, count)
    assert 0.1 * count < hits < 0.9 * count and near > 0.1 * count


@pytest.mark.nightly
@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("name", ["planes", "discs", "ragged", "lines"])
def test_a_hundred_thousand_poses_meet_as_shapely_has_it(name, seed):
    check_verdicts(name, False, 100 + seed, 2500)


def both_ways(a, pose_a, b, pose_b):
    """Return the manifold of a and b, after a check that the opposite order gives the same."""
    one, two = collide(a, pose_a, b, pose_b), collide(b, pose_b, a, pose_a)
    assert len(one) == len(two) and one.area == two.area
    assert one.points.tolist() == two.points.tolist() and one.separations.tolist() == two.separations.tolist()
    assert one.normal == (-two.normal[0] + 0.0, -two.normal[1] + 0.0)
    apart, back = distance(a, pose_a, b, pose_b).distance, distance(b, pose_b, a, pose_a).distance
    assert apart == back and (apart < 0.0) == (len(one) > 0)
    return one


@pytest.mark.parametrize("turn_a", range(4))
@pytest.mark.parametrize("turn_b", range(4))
def test_squares_that_touch_share_nothing_at_any_quarter_turn(turn_a, turn_b):
    """Squares of 4 x 4 pixels that touch side by side share no area at any quarter turn.

    Their origin is the centre, so they fill the same box at every quarter turn.
    """
    a, b = PixelMask(np.ones((4, 4), bool), snap=False), PixelMask(np.ones((4, 4), bool), snap=False)
    for angle in (turn_b * math.pi / 2, (turn_b + 400) * math.pi / 2, math.radians(90.0 * (turn_b - 4))):
        for dx, dy in ((4.0, 0.0), (0.0, -4.0), (4.0, 2.5), (-4.0, 4.0), (4.0, 0.25), (-1.125, 4.0)):
            for x, y in ((0.0, 0.0), (0.5, -7.25), (100.0, 3.0)):
                pose_a, pose_b = (x, y, turn_a * math.pi / 2), (x + dx, y + dy, angle)
                assert len(both_ways(a, pose_a, b, pose_b)) == 0, (dx, dy)
                assert distance(a, pose_a, b, pose_b).distance == 0.0
                near = (pose_b[0] - math.copysign(SLIVER, dx), pose_b[1] - math.copysign(SLIVER, dy), angle)
                found = both_ways(a, pose_a, b, near)
                wide, high = (4.0 - abs(d) + SLIVER for d in (dx, dy))
                assert len(found) == 1 and found.area == pytest.approx(wide * high, rel=1e-4)


@pytest.mark.parametrize("quarter", [0, 1])
def test_squares_side_by_side_share_nothing_at_any_angle_that_both_have(quarter):
    """Two squares side by side at a common angle share no area; moved together by 1e-11 px they share some."""
    a, b = PixelMask(np.ones((5, 5), bool), snap=False), PixelMask(np.ones((5, 5), bool), snap=False)
    for angle in np.linspace(0.05, 3.1, 40).tolist():
        c, s = math.cos(angle), math.sin(angle)
        other = angle + quarter * math.pi / 2
        for away, meet in ((5.0, False), (5.0 - 1e-11, True)):
            pose = (7.0 + away * c, 0.3 + away * s, other)
            assert len(collide(a, (7.0, 0.3, angle), b, pose)) == len(collide(b, pose, a, (7.0, 0.3, angle))) == meet


@pytest.mark.parametrize("column", [1, 62, 63, 64, 65, 66, 127, 128, 129])
def test_every_pixel_of_a_long_row_is_looked_at(column):
    """Every pixel of a long row is tested: the first is in a gap of the other mask, and only
    the second one overlaps.
    """
    row = np.zeros((1, 130), bool)
    row[0, [0, column]] = True
    wall = np.ones((12, 133), bool)
    wall[:10] = False
    wall[1, column] = True
    a, b = PixelMask(wall, (0, 0), snap=False), PixelMask(row, (0, 0), snap=False)
    found = both_ways(a, (0, 0, 0), b, (0.0, 1.0, 1e-3))
    assert len(found) == 1 and found.area == pytest.approx(1.0, abs=0.2)
    wall[1, column] = False
    assert not len(both_ways(PixelMask(wall, (0, 0), snap=False), (0, 0, 0), b, (0.0, 1.0, 1e-3)))


@pytest.mark.parametrize("name", ["ragged", "planes"])
def test_quarter_turns_on_halves_of_pixels_count_quarters_of_pixels(name):
    """At quarter turns and half-pixel positions the area is an exact count of quarter pixels.

    At twice the size all pixels are whole, so a double loop gives the exact result, including touching corners.
    """
    rng, (one, two) = np.random.default_rng(8), SPRITES[name]
    a, b = PixelMask(one, (0, 0), snap=False), PixelMask(two, (0, 0), snap=False)
    fixed = np.kron(one, np.ones((2, 2), bool))
    hits = 0
    for _ in range(200 if JIT else 20):
        turns, (dx, dy) = int(rng.integers(4)), rng.integers(-70, 90, 2).tolist()
        large = np.rot90(np.kron(two, np.ones((2, 2), bool)), -turns)
        height, width = large.shape
        left, top = dx - (0, width, width, 0)[turns], dy - (0, 0, height, height)[turns]
        canvas = np.zeros((400, 400), bool)
        canvas[150 + top : 150 + top + height, 150 + left : 150 + left + width] = large
        shared = int((canvas[150 : 150 + fixed.shape[0], 150 : 150 + fixed.shape[1]] & fixed).sum())
        found = collide(a, (0, 0, 0), b, (dx / 2, dy / 2, turns * math.pi / 2))
        assert found.area == shared / 4.0 and (len(found) > 0) == (shared > 0)
        hits += shared > 0
    assert hits > 4


@pytest.mark.parametrize("snap", [False, True])
@pytest.mark.parametrize("name", SPRITES)
def test_area_point_normal_and_depth_are_those_of_what_is_shared(name, snap):
    rng, seen = np.random.default_rng(11), 0
    a, b = masks_of(name, snap)
    fixed = union_of(a.solid.tolist(), a.origin)
    loose = union_of(b.solid.tolist(), b.origin)
    for _ in range(60 if JIT else 6):
        pose = random_pose(rng, fixed, loose, near=True)
        other = drawn(b, pose)
        shared = fixed.intersection(other)
        found = both_ways(a, (0.0, 0.0, 0.0), b, pose)
        if not len(found):
            continue
        seen += 1
        assert found.area == pytest.approx(shared.area, abs=1e-9)
        if shared.area > 1e-3:
            assert found.points[0].tolist() == pytest.approx((shared.centroid.x, shared.centroid.y), abs=1e-6)
        (nx, ny), depth = found.normal, -float(found.separations[0])
        assert abs(math.hypot(nx, ny) - 1.0) <= 1e-12
        left, top, right, bottom = other.bounds
        boxes = (fixed.bounds[2] - left, right - fixed.bounds[0], fixed.bounds[3] - top, bottom - fixed.bounds[1])
        assert 0.0 < depth <= min(boxes) + 1e-9
        for share, ends in ((1.0, True), (0.25, False), (0.75, False), (1.0 - 1e-3 / max(depth, 1.0), False)):
            moved = at(other, (share * depth * nx, share * depth * ny, 0.0))
            area = fixed.intersection(moved).area
            assert area < 1e-9 if ends else area > 0.0, (share, pose)
    assert seen > (5 if JIT else 0)


def test_what_is_moved_and_turned_together_meets_alike():
    a, b = masks_of("ragged")
    rng = np.random.default_rng(3)
    for _ in range(20):
        x, y, angle, turn = *rng.uniform(-12, 12, 2), *rng.uniform(-3, 3, 2)
        one = collide(a, (0, 0, 0), b, (x, y, angle))
        c, s = math.cos(turn), math.sin(turn)
        two = collide(a, (9.0, -4.0, turn), b, (9.0 + c * x - s * y, -4.0 + s * x + c * y, angle + turn))
        assert two.area == pytest.approx(one.area, abs=1e-9)


def test_an_empty_mask_meets_nothing():
    empty, full = PixelMask(np.zeros((3, 3), bool), snap=False), PixelMask(np.ones((9, 9), bool), snap=False)
    for pose in ((0.0, 0.0, 0.0), (0.3, 0.2, 0.7)):
        assert len(collide(full, (0, 0, 0), empty, pose)) == len(collide(empty, pose, empty, (0, 0, 0))) == 0
        assert distance(full, (0, 0, 0), empty, pose).distance == math.inf


def test_two_snapped_masks_are_still_tested_as_drawn():
    a = PixelMask(np.ones((4, 4), bool), (0, 0))
    b = PixelMask(np.ones((4, 4), bool), (0, 0), snap=False)
    assert collide(a, (0, 0, 0), a, (3.6, 0, 0)).area == 0.0 and collide(a, (0, 0, 0), a, (3.4, 0, 0)).area == 4.0
    assert collide(a, (0, 0, 0), b, (3.6, 0, 0)).area == pytest.approx(1.6)
    assert collide(a, (0.4, 0, 0), b, (3.6, 0, 0)).area == pytest.approx(1.6), "the snapped one is where it is drawn"
