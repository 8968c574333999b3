"""Queries of masks without a step: time of impact, casts, rays and nearest points use the outline at the exact pose.

References: shapely's union of the outline's parts, dense sampling, and the polygon of the same outline. The result is
the same with and without response, and for snapped and exact masks.
"""

import math

import numpy as np
import pytest

from physics import (
    JIT,
    Bounds,
    Capsule,
    Chain,
    Circle,
    Effects,
    PixelMask,
    Polygon,
    Segment,
    TileGrid,
    World,
    time_of_impact,
)
from physics.shapes.outline import outline_of

ORIGIN = (0.0, 0.0, 0.0)
PLUS = np.zeros((15, 15), bool)
PLUS[5:10] = PLUS[:, 5:10] = True
STAIRS = np.tril(np.ones((24, 24), bool))
AT = np.hypot(*np.indices((30, 30)) - 14.5)
RING = (AT < 15.0) & (AT > 9.0)
BITS = {"plus": PLUS, "stairs": STAIRS, "ring": RING, "box": np.ones((6, 11), bool)}
HULLS = {
    "circle": Circle(4.0, (3.0, 1.0)),
    "capsule": Capsule((-6, 0), (5, 2), 2.0),
    "polygon": Polygon([(-7, -2), (6, -4), (3, 5)]),
    "rounded": Polygon([(-7, -2), (6, -4), (3, 5)], 1.5),
    "segment": Segment((-8, 0), (7, 3)),
}


def parts_of(shape):
    """Return a list of (corners, rounding radius), one for each convex part of a shape."""
    shapes = [part.shape for part in outline_of(shape)] if isinstance(shape, PixelMask) else [shape]
    return [((s.center,) if isinstance(s, Circle) else s.points, getattr(s, "radius", 0.0)) for s in shapes]


def at(move, fraction):
    return tuple(p + fraction * (q - p) for p, q in zip(*move, strict=True))


def random_move(rng, turns):
    side = rng.uniform(0, math.tau)
    start = (40 * math.cos(side), 40 * math.sin(side), rng.uniform(-3, 3))
    aim = rng.uniform(-8, 8, 2)
    return start, (2 * aim[0] - start[0], 2 * aim[1] - start[1], start[2] + turns * rng.uniform(-6, 6))


@pytest.mark.parametrize("bits", BITS)
@pytest.mark.parametrize("other", [*HULLS, *(f"mask {each}" for each in BITS)])
def test_masks_meet_where_dense_sampling_of_their_outlines_sees_it(bits, other):
    pytest.importorskip("shapely")
    from tests.oracles import outlines

    rng = np.random.default_rng([*map(ord, bits + other)])
    mask = PixelMask(BITS[bits], snap=bool(rng.integers(2)))
    shape = PixelMask(BITS[other[5:]]) if other.startswith("mask") else HULLS[other]
    unions = [outlines.rounded_union(parts_of(each), ORIGIN) for each in (mask, shape)]

    def placed(k, move, fraction):
        return outlines.moved(unions[k], at(move, fraction))

    hits = 0
    for turns in (0, 0, 1, 1):
        moves = random_move(rng, turns), ((0.0, 0.0, 0.5), (rng.uniform(-9, 9), 0.0, 0.5 + turns))
        found = time_of_impact(mask, *moves[0], shape, *moves[1])
        mirrored = time_of_impact(shape, *moves[1], mask, *moves[0])
        assert (found.hit, found.fraction, found.point) == (mirrored.hit, mirrored.fraction, mirrored.point)
        gaps = [placed(0, moves[0], t).distance(placed(1, moves[1], t)) for t in np.linspace(0, 1, 101)]
        first = next((k for k, gap in enumerate(gaps) if gap == 0.0), None)
        if not found.hit:
            assert first is None
            continue
        hits += 1
        assert first is None or found.fraction <= first / 100 + 1e-6
        assert placed(0, moves[0], found.fraction).distance(placed(1, moves[1], found.fraction)) < 1e-4
        assert all(gap > 0.0 for gap in gaps[: math.ceil(found.fraction * 100 - 1e-3)])
        assert math.hypot(*found.normal) == pytest.approx(1.0) and mirrored.normal == -found.normal
        for k in (0, 1):
            assert placed(k, moves[k], found.fraction).distance(outlines.Point(found.point)) < 1e-4
    assert hits > 0


def test_a_full_rectangle_meets_as_the_box_does():
    rng = np.random.default_rng(2)
    mask, box = PixelMask(np.ones((10, 24), bool)), Polygon.box(24, 10)
    for _ in range(40):
        move, shape = random_move(rng, 1), list(HULLS.values())[rng.integers(4)]
        one, two = (time_of_impact(each, *move, shape, ORIGIN, ORIGIN) for each in (mask, box))
        assert one.hit == two.hit and one.fraction == pytest.approx(two.fraction, abs=1e-9)
        if one.hit:
            assert one.normal == pytest.approx(two.normal, abs=1e-6) and one.point == pytest.approx(two.point, abs=1e-6)


def test_no_seam_is_felt_and_a_graze_is_nothing():
    floor = np.zeros((40, 160), bool)
    floor[20:] = True
    floor[30:, 40:60] = floor[35:, 90:100] = False  # what gives it seams up to its top
    mask, box = PixelMask(floor, origin=(0, 20)), Polygon.box(10, 10)
    assert len(outline_of(mask)) > 2
    for kind in (box, Circle(5.0), PixelMask(np.ones((10, 10), bool)), Capsule((-2, 0), (2, 0), 5.0)):
        assert not time_of_impact(kind, (8, -5, 0), (150, -5, 0), mask, ORIGIN, ORIGIN).hit
        assert not time_of_impact(kind, (-80, -5, 0), (250, -5, 0), mask, ORIGIN, ORIGIN).hit
        found = time_of_impact(kind, (8, -5, 0), (150, 5, 0), mask, ORIGIN, ORIGIN)
        assert found.fraction == pytest.approx(0.0, abs=1e-9) and found.normal == pytest.approx((0.0, 1.0), abs=1e-6)
        found = time_of_impact(kind, (8, -15, 0), (150, 5, 0), mask, ORIGIN, ORIGIN)
        assert found.fraction == pytest.approx(0.5) and found.normal == pytest.approx((0.0, 1.0), abs=1e-6)
        assert not time_of_impact(kind, (8, -5, 0), (150, -15, 0), mask, ORIGIN, ORIGIN).hit


def test_masks_against_tiles_chains_and_bounds():
    mask = PixelMask(PLUS)
    tiles = TileGrid(np.ones((2, 20), bool), 16.0)
    assert time_of_impact(mask, (40, -47.5, 0), (40, 52.5, 0), tiles, ORIGIN, ORIGIN).fraction == pytest.approx(0.4)
    assert not time_of_impact(mask, (40, -7.5, 0), (250, -7.5, 0), tiles, ORIGIN, ORIGIN).hit, "no seam of the tiles"
    floor = Chain([(0, 0), (50, 0), (100, 0)])
    assert time_of_impact(mask, (40, -47.5, 0), (40, 52.5, 0), floor, ORIGIN, ORIGIN).fraction == pytest.approx(0.4)
    assert not time_of_impact(mask, (40, 47.5, 0), (40, -52.5, 0), floor, ORIGIN, ORIGIN).hit, "from its back"
    found = time_of_impact(mask, (-47.5, 9, 0), (52.5, 9, 0), Bounds(Circle(5)), ORIGIN, ORIGIN)
    assert found.fraction == pytest.approx(0.4) or not found.hit
    found = time_of_impact(Bounds(mask), (-47.5, 0, 0), (52.5, 0, 0), Circle(5), ORIGIN, ORIGIN)
    assert found.fraction == pytest.approx(0.35), "a Bounds is the box around the pixels"
    empty = PixelMask(np.zeros((4, 4), bool))
    assert not time_of_impact(empty, ORIGIN, (9, 9, 9), mask, ORIGIN, ORIGIN).hit


EFFECTS = {"response": Effects(response=True, stacking=True, rotation=True, sensors=True), "without": Effects()}
POSES = [(3.3, -2.6, 0.0), (3.3, -2.6, 0.7), (-120.45, 900.5, 2.0)]


@pytest.mark.parametrize("bits", BITS)
@pytest.mark.parametrize("effects", EFFECTS)
def test_rays_casts_and_the_nearest_point_go_by_the_outline(bits, effects):
    pytest.importorskip("shapely")
    from shapely.geometry import LineString

    from tests.oracles import outlines

    rng, hits, casts = np.random.default_rng([*map(ord, bits + effects)]), 0, 0
    for pose in POSES:
        for snap in (True, False):
            mask, world = PixelMask(BITS[bits], snap=snap), World(EFFECTS[effects])
            body = world.add_body(mask, position=pose[:2], angle=pose[2], kind="static")
            union = outlines.rounded_union(parts_of(mask), pose)
            for _ in range(20 if JIT else 6):
                x, y = rng.uniform(-35, 35, 2) + pose[:2]
                dx, dy = 2.0 * (rng.uniform(-9, 9, 2) + pose[:2] - (x, y))
                crossing = LineString([(x, y), (x + dx, y + dy)]).intersection(union)
                ray = world.ray_cast((x, y), (dx, dy))
                if crossing.length > 1e-3:
                    first = outlines.Point(x, y).distance(crossing) / math.hypot(dx, dy)
                    assert ray is not None and ray.fraction == pytest.approx(first, abs=1e-5)
                    assert (
                        ray.body == body
                        and ray.shape == body.shape_ids[0]
                        and len(world.ray_cast_all((x, y), (dx, dy))) == 1
                    )
                    hits += 1
                else:
                    assert ray is None or crossing.length > 0.0
                gap = union.distance(outlines.Point(x, y))
                near = world.closest((x, y))
                assert near[0] == body and near[2] == pytest.approx(gap, abs=1e-5)
                assert math.dist(near[1], (x, y)) == pytest.approx(gap, abs=1e-5)
                for shape in (Circle(4), Polygon.box(5, 3), PixelMask(PLUS)):
                    wanted = time_of_impact(shape, (x, y, 0.3), (x + dx, y + dy, 0.3), mask, pose, pose)
                    cast = world.shape_cast(shape, (x, y, 0.3), (dx, dy))
                    assert (cast is not None) == wanted.hit
                    if cast is not None:
                        casts += 1
                        assert cast.fraction == pytest.approx(wanted.fraction, abs=1e-9)
                        assert cast.normal == pytest.approx(-wanted.normal, abs=1e-6)
                        assert cast.point == pytest.approx(wanted.point, abs=1e-6) and cast.shape == body.shape_ids[0]
    assert hits > 5 and casts > 5


@pytest.mark.parametrize("effects", EFFECTS)
def test_points_and_casts_of_no_length_ask_the_pixels(effects):
    world = World(EFFECTS[effects])
    body = world.add_body(PixelMask(STAIRS), kind="static")
    for row, column in ((0, 0), (12, 11), (12, 12), (12, 13), (23, 23)):
        x, y = column + 0.5 - 12, row + 0.5 - 12
        holds = bool(STAIRS[row, column])
        assert (world.query_point((x, y)) == [body]) == holds == (world.ray_cast((x, y), (0, 0)) is not None)
        assert (world.overlap(Polygon.box(0.5, 0.5), (x, y)) == [body]) == holds


def test_casts_slide_over_the_seams_of_a_mask():
    floor = np.ones((40, 160), bool)
    floor[20:, 40:60] = floor[25:, 90:100] = False
    for effects in EFFECTS.values():
        world = World(effects)
        world.add_body(PixelMask(floor, origin=(0, 0)), kind="static")
        for shape in (Polygon.box(10, 10), Circle(5), PixelMask(np.ones((10, 10), bool))):
            assert world.shape_cast(shape, (8, -5), (140, 0)) is None
            hit = world.shape_cast(shape, (8, -6), (140, 14))
            assert hit.fraction == pytest.approx(1 / 14) and hit.normal == pytest.approx((0, -1), abs=1e-6)
