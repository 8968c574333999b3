"""Masks at exact poses (snap=False) against every other shape: the open union of pixel squares,
compared with shapely.
"""

import math

import numpy as np
import pytest

from physics import JIT, Bounds, Capsule, Chain, Circle, PixelMask, Polygon, Segment, TileGrid, World, collide, distance

pytest.importorskip("shapely")
from shapely.geometry import LineString, Point  # noqa: E402
from shapely.geometry import Polygon as Area  # noqa: E402

from tests.oracles import outlines  # noqa: E402
from tests.oracles.squares import at, union_of  # noqa: E402

COUNT = 120 if JIT else 60
SMOOTH = 400  # pieces of a quarter circle: the polygon's area is 2e-6 of the disc's too small
PENTAGON = [(5.0 * math.cos(k * math.tau / 5), 5.0 * math.sin(k * math.tau / 5)) for k in range(5)]
WEDGE = [(-6.0, 2.0), (0.0, -3.0), (5.0, 2.5)]
LINE = [(-4.0, 1.0), (5.0, -0.5)]


def blob(rng):
    solid = rng.random((int(rng.integers(1, 11)), int(rng.integers(1, 13)))) < rng.choice([0.4, 0.8, 1.0])
    solid[0, 0] = True
    return PixelMask(solid, tuple(rng.uniform(0.0, 8.0, 2)), snap=False)


def some_pose(rng):
    angle = rng.choice([0.0, math.pi / 2, rng.uniform(-7.0, 7.0), rng.uniform(-7.0, 7.0)])
    return (*rng.uniform(-9.0, 9.0, 2).tolist(), float(angle))


def both_ways(mask, mask_pose, shape, pose):
    """Return the manifold of a mask and a shape, after a check that the opposite order and the distance agree."""
    one, two = collide(mask, mask_pose, shape, pose), collide(shape, pose, mask, mask_pose)
    assert len(one) == len(two) and one.area == two.area
    assert one.points.tolist() == two.points.tolist() and one.separations.tolist() == two.separations.tolist()
    assert one.normal == (-two.normal[0] + 0.0, -two.normal[1] + 0.0)
    assert (one.area > 0.0) == (len(one) > 0)
    apart = distance(mask, mask_pose, shape, pose).distance
    assert (apart < 0.0) == (len(one) > 0)
    return one


SHAPES = {
    "disc": (Circle(5.0, (1.0, 0.5)), Point(1.0, 0.5).buffer(5.0, SMOOTH)),
    "small disc": (Circle(0.4), Point(0.0, 0.0).buffer(0.4, SMOOTH)),
    "pentagon": (Polygon(PENTAGON), Area(PENTAGON)),
    "sliver": (Polygon.box(30.0, 0.01), outlines.rectangle(30.0, 0.01, (0.0, 0.0, 0.0))),
    "rounded": (Polygon(WEDGE, 1.75), Area(WEDGE).buffer(1.75, SMOOTH)),
    "capsule": (Capsule(*LINE, 2.5), LineString(LINE).buffer(2.5, SMOOTH)),
}


@pytest.mark.parametrize("name", SHAPES)
def test_a_mask_and_a_hull_share_the_area_that_shapely_tells(name):
    rng, hits = np.random.default_rng(7), 0
    shape, outline = SHAPES[name]
    rounded = name not in ("pentagon", "sliver")
    for _ in range(COUNT):
        mask, mask_pose, pose = blob(rng), some_pose(rng), some_pose(rng)
        union, other = at(union_of(mask.solid.tolist(), mask.origin), mask_pose), at(outline, pose)
        found, shared = both_ways(mask, mask_pose, shape, pose), union.intersection(other)
        assert found.area == pytest.approx(shared.area, abs=1e-4 if rounded else 1e-9)
        if not len(found):
            continue
        hits += 1
        if shared.area > 1e-2:
            centroid = (shared.centroid.x, shared.centroid.y)
            assert found.points[0].tolist() == pytest.approx(centroid, abs=1e-3 if rounded else 1e-7)
        depth, (nx, ny) = -float(found.separations[0]), found.normal
        assert depth > 0.0 and abs(math.hypot(nx, ny) - 1.0) <= 1e-12
    assert hits > (0.03 if name == "small disc" else 0.15) * COUNT


def test_the_area_in_a_disc_is_its_own_in_closed_form():
    mask = PixelMask(np.ones((40, 40), bool), snap=False)
    for pose in ((0.0, 0.0, 0.0), (0.3, -0.2, 1.0)):
        assert collide(mask, pose, Circle(9.5), pose).area == pytest.approx(math.pi * 9.5**2, rel=1e-13)
    half = collide(mask, (0.0, 0.0, 0.0), Circle(8.0), (20.0, 0.0, 0.0))
    assert half.area == pytest.approx(math.pi * 32.0, rel=1e-13)
    assert half.points[0].tolist() == pytest.approx((20.0 - 32.0 / (3.0 * math.pi), 0.0), abs=1e-12)


def test_a_mask_and_the_box_of_a_turned_shape_share_its_area():
    rng = np.random.default_rng(9)
    for _ in range(COUNT):
        mask, mask_pose, pose = blob(rng), some_pose(rng), some_pose(rng)
        union = at(union_of(mask.solid.tolist(), mask.origin), mask_pose)
        framed = outlines.bounds_of(outlines.rectangle(7.0, 3.0, pose))
        found = both_ways(mask, mask_pose, Bounds(Polygon.box(7.0, 3.0)), pose)
        assert found.area == pytest.approx(union.intersection(framed).area, abs=1e-9)
        box = collide(Bounds(mask), mask_pose, Bounds(Polygon.box(7.0, 3.0)), pose)
        assert len(box) > 0 or not len(found), "the box of a mask holds the mask"


def test_the_box_of_a_mask_is_tight_at_its_exact_pose():
    rng = np.random.default_rng(10)
    world = World()
    for _ in range(COUNT // 3):
        mask, pose = blob(rng), some_pose(rng)
        union = at(union_of(mask.solid.tolist(), mask.origin), pose)
        for shape in (mask, Bounds(mask)):
            body = world.add_body(shape, position=pose[:2], angle=pose[2], kind="static")
            (left, top), (right, bottom) = (corner for corner in zip(*[iter(body.bounds)] * 2, strict=True))
            assert (left, top, right, bottom) == pytest.approx(union.bounds, abs=1e-12)


def test_a_mask_and_a_line_meet_where_the_line_crosses_its_inside():
    rng, hits = np.random.default_rng(12), 0
    for _ in range(COUNT):
        mask, mask_pose, pose = blob(rng), some_pose(rng), some_pose(rng)
        union = at(union_of(mask.solid.tolist(), mask.origin), mask_pose)
        crossed = union.buffer(-1e-9, join_style="mitre").intersection(LineString(outlines.placed(LINE, pose))).length
        found = both_ways(mask, mask_pose, Segment(*LINE), pose)
        assert (len(found) > 0) == (crossed > 0.0)
        hits += len(found) > 0
    assert 0.1 * COUNT < hits < COUNT


def test_a_mask_and_tiles_with_slopes_share_area():
    rng, hits = np.random.default_rng(13), 0
    for _ in range(COUNT):
        mask, mask_pose = blob(rng), some_pose(rng)
        kinds = rng.integers(0, 5, (3, 4))
        slopes = np.zeros((3, 4, 2))
        slopes[kinds == 2], slopes[kinds == 3], slopes[kinds == 4] = (0, 1), (1, 0.5), (0.5, 0)
        x, y = (float(v) for v in rng.choice([0.0, 0.5, -7.25, 3.0], 2))
        ground = outlines.tiles((kinds == 1).tolist(), slopes.tolist(), 5.0, x, y)
        union = at(union_of(mask.solid.tolist(), mask.origin), mask_pose)
        found = both_ways(mask, mask_pose, TileGrid(kinds == 1, 5.0, slopes=slopes), (x, y, 0.0))
        assert found.area == pytest.approx(union.intersection(ground).area, abs=1e-9)
        hits += len(found) > 0
    assert 0.15 * COUNT < hits < COUNT


@pytest.mark.parametrize("turns", range(4))
def test_shapes_that_touch_share_nothing_at_any_quarter_turn(turns):
    mask, angle = PixelMask(np.ones((4, 6), bool), snap=False), turns * math.pi / 2
    wide = 3.0 if turns % 2 == 0 else 2.0
    box, ball = Polygon.box(3.0, 3.0), Circle(1.5)
    pill, line = Capsule((0, -1), (0, 1), 1.5), Segment((0, -1), (0, 1))
    grid, ramp = TileGrid([[True]], 3.0), TileGrid([[False]], 3.0, slopes=[[(1.0, 1.0)]])
    for x, y in ((0.0, 0.0), (10.5, -3.25)):
        for shape, reach, off in (
            *((each, 1.5, 0.0) for each in (box, ball, pill, Bounds(ball))),
            (line, 0.0, 0.0),
            (grid, 0.0, -1.5),
            (ramp, 0.0, -1.5),
        ):
            for turn in range(1 if isinstance(shape, (TileGrid, Capsule, Segment)) else 4):
                pose = (x + wide + reach, y + off, turn * math.pi / 2)
                assert len(both_ways(mask, (x, y, angle), shape, pose)) == 0, shape
                apart = distance(mask, (x, y, angle), shape, pose).distance
                assert 0.0 <= apart <= (1e-14 if turn else 0.0), (shape, "is turned to the nearest float")
                near = (pose[0] - 2.0**-30, pose[1], pose[2])
                assert len(both_ways(mask, (x, y, angle), shape, near)) == 1, shape


def test_a_mask_meets_the_front_of_a_chain():
    mask = PixelMask(np.ones((4, 4), bool), snap=False)
    floor = Chain([(-20.0, 0.0), (20.0, 0.0)])
    reach = 4.0 * math.sqrt(0.5)
    assert len(collide(mask, (0.0, -reach - 1e-6, math.pi / 4), floor, (0, 0, 0))) == 0
    found = collide(mask, (0.0, -reach + 0.5, math.pi / 4), floor, (0, 0, 0))
    assert len(found) == 1 and found.area == pytest.approx(0.25) and found.normal[1] == pytest.approx(1.0)
