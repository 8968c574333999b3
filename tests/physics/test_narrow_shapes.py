"""Contacts of circles, boxes, polygons, bounds and tiles, compared with an exact outline
(invariants U2, U7, U8, U10).
"""

import math

import numpy as np
import pytest

from physics import JIT, Bounds, Circle, Polygon, TileGrid, collide

pytest.importorskip("shapely")
from tests.oracles import outlines  # noqa: E402

COUNT = 300 if JIT else 60


def random_convex(rng, most=9):
    """Return the corners of a random convex polygon on an ellipse."""
    angles = np.sort(rng.uniform(0, math.tau, int(rng.integers(3, most))))
    while np.diff(np.append(angles, angles[0] + math.tau)).min() < 0.1:
        angles = np.sort(rng.uniform(0, math.tau, len(angles)))
    a, b = rng.uniform(1, 12, 2)
    return [(a * math.cos(t), b * math.sin(t)) for t in angles]


def random_pose(rng, reach=14.0):
    return (*rng.uniform(-reach, reach, 2).tolist(), float(rng.choice([0.0, math.pi / 2, rng.uniform(-7, 7)])))


def both_ways(a, pose_a, b, pose_b, tied=False):
    """Return the manifold of A and B, after a check against that of B and A.

    tied: True if several normals are equally good, so that the normals may differ.
    """
    one, two = collide(a, pose_a, b, pose_b), collide(b, pose_b, a, pose_a)
    assert (len(one) > 0) == (len(two) > 0)
    if len(one):
        assert abs(math.hypot(*one.normal) - 1.0) <= 1e-12 and len(one) <= 2
        assert one.separations.min() == pytest.approx(two.separations.min(), abs=1e-9)
        assert np.isfinite(one.points).all()
        if not tied:
            assert one.normal == pytest.approx((-two.normal[0], -two.normal[1]), abs=1e-9)
            deepest = [m.points[np.argmin(m.separations)] for m in (one, two)]
            if len(one) == 1:
                assert deepest[0] == pytest.approx(deepest[1], abs=1e-9)
    return one


@pytest.mark.parametrize("seed", range(3))
def test_circle_and_polygon_hit_with_the_exact_depth(seed):
    rng, hits = np.random.default_rng(seed), 0
    for _ in range(COUNT):
        corners, pose = random_convex(rng), random_pose(rng)
        x, y, radius = *rng.uniform(-14, 14, 2), float(rng.uniform(0.1, 10.0))
        outline = outlines.polygon(corners, pose)
        gap = outlines.disc_gap(outline, x, y, radius)
        found = both_ways(Polygon(corners), pose, Circle(radius), (x, y, 0.0))
        assert (len(found) > 0) == (gap <= 0.0) or abs(gap) < 1e-9
        if len(found):
            hits += 1
            assert found.separations[0] == pytest.approx(gap, abs=1e-9)
            (px, py), (nx, ny) = found.points[0], found.normal
            assert outline.exterior.distance(outlines.Point(px - nx * gap / 2, py - ny * gap / 2)) < 1e-9
            assert math.hypot(px + nx * gap / 2 - x, py + ny * gap / 2 - y) == pytest.approx(radius, abs=1e-9)
    assert 0.2 * COUNT < hits < 0.9 * COUNT


@pytest.mark.parametrize("seed", range(3))
def test_polygons_hit_with_the_least_push_as_depth(seed):
    rng, hits = np.random.default_rng(seed + 20), 0
    for _ in range(COUNT):
        a, pose_a, b, pose_b = random_convex(rng), random_pose(rng, 9), random_convex(rng), random_pose(rng, 9)
        p, q = outlines.polygon(a, pose_a), outlines.polygon(b, pose_b)
        gap = p.distance(q) if not p.intersects(q) else -outlines.convex_depth(p, q)
        found = both_ways(Polygon(a), pose_a, Polygon(b), pose_b)
        assert (len(found) > 0) == (gap <= 0.0) or abs(gap) < 1e-9
        if len(found):
            hits += 1
            assert found.separations.min() == pytest.approx(gap, abs=1e-9)
            nx, ny = found.normal
            moved = outlines.placed(b, (pose_b[0] - gap * nx, pose_b[1] - gap * ny, pose_b[2]))
            assert p.intersection(outlines.Polygon(moved)).area < 1e-7, "the push along the normal parts them"
    assert 0.3 * COUNT < hits < 0.95 * COUNT


@pytest.mark.parametrize("seed", range(2))
def test_manifold_points_lie_midway_between_the_surfaces(seed):
    rng = np.random.default_rng(seed + 40)
    for _ in range(COUNT):
        w, h, u, v = rng.uniform(2, 12, 4)
        pose_a, pose_b = random_pose(rng, 6), random_pose(rng, 6)
        found = collide(Polygon.box(w, h), pose_a, Polygon.box(u, v), pose_b)
        p, q = outlines.rectangle(w, h, pose_a), outlines.rectangle(u, v, pose_b)
        nx, ny = found.normal
        for (x, y), separation in zip(found.points, found.separations, strict=True):
            # One surface is half the separation away along the normal, the other half against it.
            ends = [outlines.Point(x + s * separation / 2 * nx, y + s * separation / 2 * ny) for s in (-1, 1)]
            to_a, to_b = p.exterior.distance(ends[0]), q.exterior.distance(ends[1])
            assert to_a < 1e-9 and to_b < 1e-9 or min(separation, 0) == 0 or found.separations.max() > 0


@pytest.mark.parametrize("seed", range(2))
def test_bounds_collide_as_the_aabb_of_what_they_wrap(seed):
    rng = np.random.default_rng(seed + 60)
    for _ in range(COUNT):
        corners, pose, other, at = random_convex(rng), random_pose(rng), random_convex(rng), random_pose(rng)
        frame, outline = outlines.bounds_of(outlines.polygon(corners, pose)), outlines.polygon(other, at)
        gap = frame.distance(outline)
        found = both_ways(Bounds(Polygon(corners)), pose, Polygon(other), at)
        assert (len(found) > 0) == (gap == 0.0) or gap < 1e-9
        framed = both_ways(Bounds(Polygon(corners)), pose, Bounds(Polygon(other)), at)
        assert (len(framed) > 0) == frame.intersects(outlines.bounds_of(outline))


@pytest.mark.parametrize("seed", range(3))
def test_tiles_hit_what_overlaps_their_union(seed):
    rng, hits = np.random.default_rng(seed + 80), 0
    for _ in range(COUNT // 2):
        kinds = rng.integers(0, 6, (4, 5))
        slopes = np.zeros((4, 5, 2))
        for kind, heights in ((2, (0, 1)), (3, (1, 0.5)), (4, (0.5, 0)), (5, (0, 0))):
            slopes[kinds == kind] = heights
        x, y = (float(v) for v in rng.choice([0.0, 0.25, -17.0], 2))
        grid, at = TileGrid(kinds == 1, 8.0, slopes=slopes), (x, y, 0.0)
        ground = outlines.tiles((kinds == 1).tolist(), slopes.tolist(), 8.0, x, y)
        cx, cy = rng.uniform(x - 4, x + 44), rng.uniform(y - 4, y + 36)
        radius = float(rng.uniform(0.5, 6))
        gap = ground.distance(outlines.Point(cx, cy)) - radius
        found = collide(grid, at, Circle(radius), (cx, cy, 0.0))
        assert (len(found) > 0) == (gap <= 0.0) or abs(gap) < 1e-9, "circle"
        w, h = rng.uniform(1, 12, 2)
        pose = (cx, cy, float(rng.choice([0.0, rng.uniform(0, 7)])))
        box = outlines.rectangle(w, h, pose)
        found = collide(Polygon.box(w, h), pose, grid, at)
        overlap = ground.intersection(box).area
        assert (len(found) > 0) == ground.intersects(box) or overlap < 1e-9, "box"
        hits += len(found) > 0
    assert hits > COUNT // 8


def turned_quarter(pose, turns):
    """Return the pose rotated about the world's origin by a number of quarter turns."""
    x, y, angle = pose
    for _ in range(turns):
        x, y = -y, x
    return (x, y, angle + turns * math.pi / 2)


@pytest.mark.parametrize("turns", [1, 2, 3])
@pytest.mark.parametrize("pair", ["boxes", "box circle", "circles"])
def test_quarter_turn_of_both_turns_the_manifold(pair, turns):
    rng = np.random.default_rng(turns)
    for _ in range(COUNT // 3):
        a = Circle(4.0, (1, 2)) if pair == "circles" else Polygon.box(7, 3)
        b = Polygon.box(4, 4, (1, 0)) if pair == "boxes" else Circle(3.0)
        pose_a, pose_b = random_pose(rng, 4), random_pose(rng, 4)
        one, two = (
            collide(a, pose_a, b, pose_b),
            collide(a, turned_quarter(pose_a, turns), b, turned_quarter(pose_b, turns)),
        )
        assert len(one) == len(two)
        if len(one):
            assert two.separations == pytest.approx(one.separations, abs=1e-12)
            assert two.normal == pytest.approx(turned_quarter((*one.normal, 0), turns)[:2], abs=1e-12)
            wanted = [[round(v, 9) for v in turned_quarter((*p, 0), turns)[:2]] for p in one.points.tolist()]
            for got, want in zip(sorted(two.points.round(9).tolist()), sorted(wanted), strict=True):
                assert got == pytest.approx(want, abs=1e-8)


def test_moving_both_far_away_changes_the_manifold_by_rounding_only():
    rng = np.random.default_rng(5)
    for _ in range(COUNT // 3):
        a, b, pose_a, pose_b = Polygon.box(9, 5), Polygon.box(6, 6), random_pose(rng, 4), random_pose(rng, 4)
        one = collide(a, pose_a, b, pose_b)
        far = [(p[0] + 2.0**23, p[1] - 2.0**23, p[2]) for p in (pose_a, pose_b)]
        two = collide(a, far[0], b, far[1])
        if len(one) and one.separations.min() < -1e-6:
            assert two.normal == pytest.approx(one.normal, abs=1e-6) or len(two) > 0
            assert two.separations.min() == pytest.approx(one.separations.min(), abs=1e-7)


def test_margin_finds_what_is_no_further_apart():
    rng = np.random.default_rng(6)
    for _ in range(COUNT):
        w, h, u, v = rng.uniform(2, 10, 4)
        pose_a, pose_b, margin = random_pose(rng, 8), random_pose(rng, 8), float(rng.uniform(0, 4))
        gap = outlines.rectangle(w, h, pose_a).distance(outlines.rectangle(u, v, pose_b))
        found = collide(Polygon.box(w, h), pose_a, Polygon.box(u, v), pose_b, margin=margin)
        assert (len(found) > 0) == (gap <= margin) or abs(gap - margin) < 1e-9, (gap, margin, found)
