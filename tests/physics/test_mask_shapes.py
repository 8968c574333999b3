"""Contacts of masks with circles, polygons and tiles, compared with shapely.

A mask is the union of its pixel squares without their border: shapes that only touch it have no contact.
"""

import math

import numpy as np
import pytest

from physics import JIT, Bounds, Circle, PixelMask, Polygon, TileGrid, collide

pytest.importorskip("shapely")
from tests.oracles import outlines  # noqa: E402

COUNT = 150 if JIT else 25


def blob(rng):
    """Return (random mask that may have holes, unrotated pose at whole pixels, shapely union of its squares there)."""
    solid = rng.random((int(rng.integers(1, 9)), int(rng.integers(1, 12)))) < rng.choice([0.3, 0.7, 1.0])
    solid[0, 0] = True
    left, top = (int(v) for v in rng.integers(-6, 7, 2))
    mask = PixelMask(solid)
    return mask, (left + mask.origin[0], top + mask.origin[1], 0.0), outlines.pixels(solid.tolist(), left, top)


def solid_squares(mask, pose):
    """Return the top left corners of the solid pixels of a mask at an unrotated pose."""
    rows, columns = np.nonzero(mask.solid)
    return list(zip(columns + pose[0] - mask.origin[0], rows + pose[1] - mask.origin[1], strict=True))


def same_both_ways(mask, mask_pose, shape, pose):
    """Return the manifold of a mask and a shape, after a check that the opposite order gives the same."""
    one, two = collide(mask, mask_pose, shape, pose), collide(shape, pose, mask, mask_pose)
    assert len(one) == len(two) and one.area == two.area
    if len(one):
        assert one.normal == pytest.approx((-two.normal[0], -two.normal[1]), abs=1e-12)
        assert abs(math.hypot(*one.normal) - 1.0) <= 1e-12
        assert one.separations == pytest.approx(two.separations) and (one.separations < 0.0).all()
    return one


@pytest.mark.parametrize("seed", range(3))
def test_mask_and_circle_hit_when_they_share_area(seed):
    rng, hits = np.random.default_rng(seed), 0
    for _ in range(COUNT):
        mask, pose, union = blob(rng)
        x, y, radius = *rng.uniform(-8, 13, 2), float(rng.uniform(0.1, 9.0))
        gap = outlines.Point(x, y).distance(union) - radius
        found = same_both_ways(mask, pose, Circle(radius), (x, y, 0.0))
        assert (len(found) > 0) == (gap < 0.0) or abs(gap) < 1e-9
        hits += len(found) > 0
        if len(found):
            depth, (nx, ny) = -float(found.separations.min()), found.normal
            moved = outlines.Point(x + depth * nx, y + depth * ny)
            for i, j in solid_squares(mask, pose):
                square = outlines.box(i, j, i + 1, j + 1)
                if outlines.Point(x, y).distance(square) < radius:
                    assert moved.distance(square) >= radius - 1e-9, "the pixels it overlapped are left behind"
    assert 0.15 * COUNT < hits < 0.95 * COUNT


@pytest.mark.parametrize("seed", range(3))
def test_mask_and_turned_box_hit_when_they_share_area(seed):
    rng, hits = np.random.default_rng(seed + 50), 0
    for _ in range(COUNT):
        mask, pose, union = blob(rng)
        w, h = rng.uniform(0.3, 14.0, 2)
        box_pose = (*rng.uniform(-7, 12, 2), float(rng.choice([0.0, math.pi / 4, rng.uniform(0, 7)])))
        box = outlines.rectangle(w, h, box_pose)
        area = union.intersection(box).area
        found = same_both_ways(mask, pose, Polygon.box(w, h), box_pose)
        assert (len(found) > 0) == (area > 0.0) or area < 1e-9
        hits += len(found) > 0
        framed = same_both_ways(mask, pose, Bounds(Polygon.box(w, h)), box_pose)
        area = union.intersection(outlines.bounds_of(box)).area
        assert (len(framed) > 0) == (area > 0.0) or area < 1e-9
    assert 0.15 * COUNT < hits < 0.95 * COUNT


@pytest.mark.parametrize("seed", range(3))
def test_mask_and_polygon_area_counts_the_pixels_that_share_area(seed):
    rng = np.random.default_rng(seed + 90)
    for _ in range(COUNT // 3):
        mask, pose, _ = blob(rng)
        turn = rng.uniform(0, 7)
        corners = [(6 * math.cos(turn + k * math.tau / 5), 6 * math.sin(turn + k * math.tau / 5)) for k in range(5)]
        at = (*rng.uniform(-6, 12, 2), 0.0)
        pentagon = outlines.polygon(corners, at)
        left, top = pose[0] - mask.origin[0], pose[1] - mask.origin[1]
        shared = [
            outlines.box(left + i, top + j, left + i + 1, top + j + 1).intersection(pentagon).area
            for j, i in zip(*np.nonzero(mask.solid), strict=True)
        ]
        if all(a == 0.0 or a > 1e-9 for a in shared):
            assert collide(mask, pose, Polygon(corners), at).area == sum(a > 0.0 for a in shared)


@pytest.mark.parametrize("seed", range(3))
def test_mask_and_tiles_hit_when_they_share_area(seed):
    rng, hits = np.random.default_rng(seed + 7), 0
    for _ in range(COUNT // 2):
        mask, pose, union = blob(rng)
        kinds = rng.integers(0, 5, (3, 4))
        slopes = np.zeros((3, 4, 2))
        slopes[kinds == 2], slopes[kinds == 3], slopes[kinds == 4] = (0, 1), (1, 0.5), (0.5, 0)
        x, y = (float(v) for v in rng.choice([0.0, 0.5, -7.25, 3.0], 2))
        ground = outlines.tiles((kinds == 1).tolist(), slopes.tolist(), 6.0, x, y)
        area = union.intersection(ground).area
        found = same_both_ways(mask, pose, TileGrid(kinds == 1, 6.0, slopes=slopes), (x, y, 0.0))
        assert (len(found) > 0) == (area > 0.0) or area < 1e-9
        hits += len(found) > 0
    assert hits > COUNT // 10


def test_touching_masks_and_shapes_do_not_hit():
    mask = PixelMask(np.ones((4, 4), bool), origin=(0, 0))
    assert len(collide(mask, (0, 0, 0), Circle(2.0), (6.0, 2.0, 0.0))) == 0
    assert len(collide(mask, (0, 0, 0), Circle(2.0), (5.999, 2.0, 0.0))) == 1
    assert len(collide(mask, (0, 0, 0), Polygon.box(4, 4), (6.0, 2.0, 0.0))) == 0
    assert len(collide(mask, (0, 0, 0), Polygon.box(4, 4), (6.0, 6.0, 0.0))) == 0
    assert len(collide(mask, (0, 0, 0), Polygon.box(4, 4), (5.999, 2.0, 0.0))) == 1
    grid = TileGrid(np.ones((1, 1), bool), 8.0)
    assert len(collide(mask, (8.0, 0, 0), grid, (0, 0, 0))) == len(collide(mask, (0, 8.0, 0), grid, (0, 0, 0))) == 0
    assert len(collide(mask, (7.0, 0, 0), grid, (0, 0, 0))) == 1


def test_shape_in_the_hole_of_a_mask_does_not_hit():
    solid = np.ones((9, 9), bool)
    solid[2:7, 2:7] = False
    ring = PixelMask(solid)
    assert len(collide(ring, (4.5, 4.5, 0), Circle(2.4), (4.5, 4.5, 0))) == 0
    assert len(collide(ring, (4.5, 4.5, 0), Polygon.box(4.9, 4.9), (4.5, 4.5, 0))) == 0
    assert len(collide(ring, (4.5, 4.5, 0), Circle(2.6), (4.5, 4.5, 0))) == 1


def test_centroid_of_a_mask_stands_for_symmetric_hits():
    mask = PixelMask(np.ones((6, 6), bool))
    found = collide(mask, (3.0, 3.0, 0), Circle(3.0), (3.0, 3.0, 0))
    assert math.hypot(*found.normal) == 1.0 and float(found.separations[0]) <= -6.0
