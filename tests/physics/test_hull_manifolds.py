"""Manifolds of every pair of rounded hulls (invariants U2, U7, U8, U10).

The reference is the origin's distance from the Minkowski difference of the hulls, computed by shapely.
"""

import itertools
import math

import numpy as np
import pytest

from physics import JIT, Bounds, Capsule, Circle, Polygon, Segment, collide

shapely = pytest.importorskip("shapely")

COUNT = 150 if JIT else 20
KINDS = ("circle", "capsule", "segment", "polygon", "rounded", "bounds")


def random_shape(kind, rng):
    if kind == "circle":
        return Circle(float(rng.uniform(0.5, 6)), tuple(rng.uniform(-3, 3, 2)))
    if kind in ("capsule", "segment"):
        a, b = rng.uniform(-8, 8, (2, 2))
        return Segment(a, b) if kind == "segment" else Capsule(a, b, float(rng.uniform(0.3, 4)))
    angles = np.sort(rng.uniform(0, math.tau, int(rng.integers(3, 9))))
    while np.diff(np.append(angles, angles[0] + math.tau)).min() < 0.15:
        angles = np.sort(rng.uniform(0, math.tau, len(angles)))
    a, b = rng.uniform(1, 8, 2)
    points = [(a * math.cos(t), b * math.sin(t)) for t in angles]
    if kind == "bounds":
        return Bounds(Polygon(points, float(rng.choice([0.0, 1.5]))))
    return Polygon(points, float(rng.uniform(0.2, 3)) if kind == "rounded" else 0.0)


def hull_of(shape, pose):
    """Return (corners (n, 2) in world space, rounding radius) of a shape.

    A circle has one corner, its centre; a capsule has two.
    """
    x, y, angle = pose
    if isinstance(shape, Bounds):
        core, radius = hull_of(shape.shape, pose)
        (x0, y0), (x1, y1) = core.min(axis=0) - radius, core.max(axis=0) + radius
        return np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)]), 0.0
    points = np.array([shape.center] if isinstance(shape, Circle) else shape.points)
    cosine, sine = math.cos(angle), math.sin(angle)
    return points @ np.array([[cosine, sine], [-sine, cosine]]) + (x, y), getattr(shape, "radius", 0.0)


def gap_of(a, b):
    """Return the signed distance of two rounded hulls.

    It is the distance of the origin from the Minkowski difference of the two sets of corners, minus both radii.
    """
    difference = shapely.MultiPoint([tuple(q - p) for p in a[0] for q in b[0]]).convex_hull
    origin = shapely.Point(0, 0)
    inside = difference.geom_type == "Polygon" and difference.contains(origin)
    return (-difference.exterior.distance(origin) if inside else difference.distance(origin)) - a[1] - b[1]


def surface_gap(hull, x, y):
    """Return the signed distance of the point (x, y) from the surface of a rounded hull, negative inside."""
    core = shapely.MultiPoint([tuple(p) for p in hull[0]]).convex_hull
    point = shapely.Point(x, y)
    inside = core.geom_type == "Polygon" and core.contains(point)
    return (-core.exterior.distance(point) if inside else core.distance(point)) - hull[1]


def mirrored(a, pose_a, b, pose_b, margin=0.0):
    """Return the manifold of A and B, after a check that the manifold of B and A equals it with the opposite normal."""
    one, two = collide(a, pose_a, b, pose_b, margin), collide(b, pose_b, a, pose_a, margin)
    assert len(one) == len(two) <= 2
    assert one.points.tolist() == two.points.tolist() and one.separations.tolist() == two.separations.tolist()
    if len(one):
        assert math.hypot(*one.normal) == pytest.approx(1.0, abs=1e-12)
        assert one.normal == (-two.normal[0], -two.normal[1]) and np.isfinite(one.points).all()
        assert len(set(one.features.tolist())) == len(one)
    return one


PAIRS = list(itertools.combinations_with_replacement(KINDS, 2))


@pytest.mark.parametrize("kinds", PAIRS, ids="-".join)
def test_depth_and_gap_are_exact_and_the_points_lie_between_the_surfaces(kinds):
    rng, hits = np.random.default_rng(sum(map(ord, "".join(kinds)))), 0
    for _ in range(COUNT):
        a, b = (random_shape(kind, rng) for kind in kinds)
        pose_a = (*rng.uniform(-7, 7, 2).tolist(), float(rng.choice([0.0, math.pi / 2, rng.uniform(-7, 7)])))
        pose_b = (*rng.uniform(-7, 7, 2).tolist(), float(rng.choice([0.0, rng.uniform(-7, 7)])))
        margin = float(rng.choice([0.0, 2.0]))
        p, q = hull_of(a, pose_a), hull_of(b, pose_b)
        gap = gap_of(p, q)
        found = mirrored(a, pose_a, b, pose_b, margin)
        assert (len(found) > 0) == (gap <= margin) or abs(gap - margin) < 1e-9
        if not len(found):
            continue
        hits += 1
        assert found.separations.min() == pytest.approx(gap, abs=1e-9)
        deepest = int(np.argmin(found.separations))
        (x, y), half = found.points[deepest], found.separations[deepest] / 2
        nx, ny = found.normal
        assert abs(surface_gap(p, x - half * nx, y - half * ny)) < 1e-8, "half the separation back lies A's surface"
        assert abs(surface_gap(q, x + half * nx, y + half * ny)) < 1e-8, "half the separation on lies B's surface"
        moved = (q[0] - np.array([nx, ny]) * gap, q[1])
        assert abs(gap_of(p, moved)) < 1e-8, "the push along the normal ends the overlap, or the gap"
    assert 0.1 * COUNT < hits


@pytest.mark.parametrize(
    "kinds", [("capsule", "segment"), ("rounded", "capsule"), ("polygon", "segment")], ids="-".join
)
@pytest.mark.parametrize("turns", [1, 3])
def test_quarter_turns_turn_the_manifold(kinds, turns):
    rng = np.random.default_rng(turns)
    for _ in range(COUNT // 3):
        a, b = (random_shape(kind, rng) for kind in kinds)
        poses = [(*rng.uniform(-5, 5, 2), rng.uniform(-7, 7)) for _ in range(2)]
        turned = []
        for x, y, angle in poses:
            for _ in range(turns):
                x, y = -y, x
            turned.append((x, y, angle + turns * math.pi / 2))
        one, two = collide(a, poses[0], b, poses[1]), collide(a, turned[0], b, turned[1])
        assert len(one) == len(two)
        if len(one):
            assert sorted(two.separations) == pytest.approx(sorted(one.separations), abs=1e-11)


def test_boxes_far_away_have_the_same_manifold():
    """Two overlapping boxes have two points of separation -0.1, also at 1e7 from the origin (docs/stability.md, B1)."""
    box = Polygon.box(1, 1)
    for at in (0.0, 1e7):
        found = collide(box, (at, at, 0), box, (at + 0.9, at, 0))
        assert len(found) == 2 and found.normal == (1.0, 0.0)
        assert found.separations == pytest.approx([-0.1, -0.1], abs=1e-12 if at == 0 else 1e-8)
    pill = Capsule((-5, 0), (5, 0), 2)
    found = collide(pill, (1e7, 0, 0), pill, (1e7, 3.9, 0))
    assert len(found) == 2 and found.separations == pytest.approx([-0.1, -0.1], abs=1e-8)


@pytest.mark.parametrize(
    "shape",
    [Polygon.box(10, 4), Polygon.box(10, 4).__class__(Polygon.box(10, 4).points, 1.0), Capsule((-5, 0), (5, 0), 2)],
    ids=["box", "rounded", "capsule"],
)
@pytest.mark.parametrize("sign", [-1, 1])
def test_nearly_parallel_sides_keep_two_points_and_their_features(shape, sign):
    """Nearly parallel sides keep two points and constant features (docs/stability.md, B2).

    The tilts are 1e-12 to 1e-3; either side may overhang the other.
    """
    thick = 2 * shape.min_half_extent
    for shift in (0.0, 3.0, -3.0):
        features = set()
        for exponent in range(-12, -2):
            found = collide(shape, (0, 0, 0), shape, (shift, thick - 0.1, sign * 10.0**exponent))
            assert len(found) == 2, exponent
            assert math.hypot(found.normal[0], found.normal[1] - 1) <= 10.0**exponent + 1e-12
            features.add(tuple(sorted(found.features.tolist())))
        assert len(features) <= 2


def test_features_persist_while_a_body_slides():
    ground, found = Polygon.box(200, 10), set()
    for shape in (Polygon.box(8, 8), Capsule((-4, 0), (4, 0), 4), Polygon(Polygon.box(6, 6).points, 1.0)):
        seen = {
            tuple(collide(ground, (0, 0, 0), shape, (x, -8.9, 0)).features.tolist()) for x in np.linspace(-80, 80, 50)
        }
        assert len(seen) == 1
        found |= seen
    assert found


def test_centres_on_cores_have_their_documented_way_out():
    """A shape whose centre lies on the core of another gets the documented depth (docs/stability.md, B5, B6).

    The core of a rounded shape is the point, line or polygon to which its radius is added. The normal is a unit vector.
    """
    pill = Capsule((-5, 0), (5, 0), 2)
    for at, depth in (((0, 0), -3), ((5, 0), -3), ((-5, 0), -3), ((7, 0), -1)):
        found = collide(pill, (0, 0, 0), Circle(1), (*at, 0))
        assert found.separations.tolist() == [depth] and math.hypot(*found.normal) == pytest.approx(1.0)
    assert collide(Segment((0, 0), (9, 0)), (0, 0, 0), Circle(1), (4, 0, 0)).separations.tolist() == [-1.0]
    same = collide(pill, (1, 1, 0.3), pill, (1, 1, 0.3))
    assert same.separations.min() == pytest.approx(-4) and math.hypot(*same.normal) == pytest.approx(1)
    rounded = Polygon(Polygon.box(8, 4).points, 1.0)
    assert collide(rounded, (0, 0, 0), rounded, (0, 0, 0)).separations.min() == pytest.approx(-6)
    line = Segment((0, 0), (9, 0))
    assert collide(line, (0, 0, 0), line, (0, 0, 0)).separations.tolist() == [0.0, 0.0]
    across = collide(line, (0, 0, 0), Segment((4, -3), (4, 5)), (0, 0, 0))
    assert across.separations.min() == pytest.approx(-3), "crossing lines touch as deep as the least push"


def test_lines_end_to_end_touch_only_where_they_meet():
    """Collinear segments collide only where they touch (docs/stability.md, B9, B11).

    A separating-axis test across the segments alone would not see a gap along their common line.
    """
    line = Segment((0, 0), (10, 0))
    for angle in (0.0, 0.3, 1.0, math.pi / 2):
        along = np.array([math.cos(angle), math.sin(angle)])
        for gap in (1e-9, 1e-3, 1.0, 100.0):
            at = along * (10 + gap)
            assert len(collide(line, (0, 0, angle), line, (*at, angle))) == 0
            near = collide(line, (0, 0, angle), line, (*at, angle), margin=gap + 1e-6)
            assert near.separations == pytest.approx([gap], abs=1e-9) and near.normal == pytest.approx(
                tuple(along), abs=1e-5
            )
    assert len(collide(line, (0, 0, 0), line, (10, 0, 0))) >= 1
    assert collide(Segment((-1, 1), (-1, -1)), (0, 0, 0), Segment((2, 0), (1, 0)), (0, 0, 0), 9).separations.min() == 2


def test_needles_never_miss_each_other():
    """Thin needles that cross at small angles always collide (docs/stability.md, B10).

    Whether they cross is decided by the sides of their corners in rational numbers.
    """
    from fractions import Fraction

    rng = np.random.default_rng(4)
    needle = Polygon.box(100, 0.001)
    for _ in range(COUNT):
        pose = (
            float(rng.uniform(-0.01, 0.01)),
            float(rng.uniform(-0.002, 0.002)),
            math.radians(float(rng.choice([0.001, 1e-4, 0.01]))),
        )
        p, q = hull_of(needle, (0, 0, 0))[0], hull_of(needle, pose)[0]
        apart = False
        for one, two in ((p, q), (q, p)):
            for k in range(4):
                (ax, ay), (bx, by) = ([Fraction(v) for v in one[i % 4]] for i in (k, k + 1))
                apart |= all((by - ay) * (Fraction(x) - ax) - (bx - ax) * (Fraction(y) - ay) > 0 for x, y in two)
        assert (len(mirrored(needle, (0, 0, 0), needle, pose)) > 0) or apart


def test_corner_to_corner_is_classified_by_the_sign_alone():
    """Whether corners and edges touch depends on the sign of the gap alone (docs/stability.md, B9).

    Shapes collide if they just touch or overlap by 1e-12, and do not collide with a gap of 1e-9.
    """
    for shape in (Polygon.box(2, 2), Polygon(Polygon.box(1, 1).points, 0.5), Capsule((-0.5, 0), (0.5, 0), 0.5)):
        for nudge in (0.0, -1e-12, -1e-9):
            assert len(collide(shape, (0, 0, 0), shape, (2 + nudge, 0, 0))) > 0, (shape, nudge)
        assert len(collide(shape, (0, 0, 0), shape, (2 + 1e-9, 0, 0))) == 0
    box = Polygon.box(2, 2)
    assert set(collide(box, (0, 0, 0), box, (2, 2, 0)).separations.tolist()) == {0.0}
    assert len(collide(box, (0, 0, 0), box, (2 + 1e-9, 2 + 1e-9, 0))) == 0


def test_rounded_corners_meet_at_the_distance_of_their_cores():
    a, b = Polygon(Polygon.box(4, 4).points, 1.0), Polygon(Polygon.box(4, 4).points, 2.0)
    found = collide(a, (0, 0, 0), b, (6, 6, 0), margin=1.0)
    wanted = math.hypot(2, 2) - 3
    assert found.separations == pytest.approx([wanted]) and found.normal == pytest.approx((math.sqrt(0.5),) * 2)


@pytest.mark.parametrize("power", [-40, -20, 20])
def test_scaling_by_a_power_of_two_scales_the_manifold_to_the_bit(power):
    rng, scale = np.random.default_rng(9), 2.0**power
    for kinds in PAIRS:
        a, b = (random_shape(kind, rng) for kind in kinds)
        pose_a, pose_b = ((*rng.uniform(-4, 4, 2), float(rng.uniform(-7, 7))) for _ in range(2))
        one = collide(a, pose_a, b, pose_b, 1.0)
        two = collide(scaled(a, scale), at_scale(pose_a, scale), scaled(b, scale), at_scale(pose_b, scale), scale)
        assert len(one) == len(two)
        if len(one):
            assert one.normal == two.normal and (one.separations * scale).tolist() == two.separations.tolist()


def at_scale(pose, scale):
    return (pose[0] * scale, pose[1] * scale, pose[2])


def scaled(shape, scale):
    if isinstance(shape, Bounds):
        return Bounds(scaled(shape.shape, scale))
    if isinstance(shape, Circle):
        return Circle(shape.radius * scale, (shape.center[0] * scale, shape.center[1] * scale))
    points = [(x * scale, y * scale) for x, y in shape.points]
    if isinstance(shape, Polygon):
        return Polygon(points, shape.radius * scale)
    return Segment(*points) if isinstance(shape, Segment) else Capsule(*points, shape.radius * scale)
