"""Distance and depth, checked by certificates instead of golden values, and for agreement with
collide (invariant U10).
"""

import math
from itertools import pairwise

import numpy as np
import pytest

from game.measure.shape_traces import gjk_steps
from physics import JIT, Bounds, Capsule, Chain, Circle, PixelMask, Polygon, Segment, TileGrid, collide, distance
from physics.distance.gjk import (
    AX,
    AY,
    BX,
    BY,
    CAPPED,
    NX,
    NY,
    ROUNDS,
    TOUCHING,
    new_gap_workspace,
    shape_separation,
    walk_to_nearest,
)
from tests.oracles import hulls

ORIGIN = (0.0, 0.0, 0.0)


def room_for(points):
    padded = np.zeros((16, 2))
    padded[: len(points)] = points
    return padded


def gap_of(a, b, room=None, start=(0, 0)):
    """Return (separation, normal, point on A, point on B) of two outlines, computed by the kernel.

    room: workspace of the kernel, None for a new one. start: first corners of the search.
    """
    room = new_gap_workspace() if room is None else room
    found = shape_separation(room_for(a), len(a), 0.0, room_for(b), len(b), 0.0, start, room)
    gap = room.gap
    assert room.state[CAPPED] == 0
    return float(found), gap[NX : NY + 1].copy(), gap[AX : AY + 1].copy(), gap[BX : BY + 1].copy()


def check_certificates(a, b, room):
    """Assert bounds on the distance and depth of two outlines. Return whether they overlap.

    The distance lies between the gap along the normal and the distance of the two reported points. The depth is at most
    the overlap of the AABBs.
    """
    size = max(np.ptp(a, axis=0).max(), np.ptp(b, axis=0).max(), 1e-300)
    found, normal, on_a, on_b = gap_of(a, b, room)
    assert abs(math.hypot(*normal) - 1.0) <= 1e-12
    assert abs(hulls.projected_gap(a, b, normal) - found) <= 1e-12 * size, "the normal parts them by the distance"
    for point, outline in ((on_a, a), (on_b, b)):
        assert (point >= outline.min(axis=0) - 1e-12 * size).all() and (
            point <= outline.max(axis=0) + 1e-12 * size
        ).all()
    if found > 0.0:
        assert found <= math.hypot(*(on_b - on_a)) + 1e-12 * size
        assert abs(found - hulls.corner_to_edge(a, b)) <= 1e-12 * size
    else:
        assert -found <= hulls.shadow_overlap(a, b) + 1e-12 * size
        assert abs(found - hulls.best_face_gap(a, b)) <= 1e-12 * size
    return found <= 0.0


def fuzz(seed, pairs, slimmest):
    """Check random pairs (docs/stability.md, C13).

    Return (share of pairs that overlap, number of search rounds of each other pair).
    """
    rng, room, hits, rounds = np.random.default_rng(seed), new_gap_workspace(), 0, []
    for _ in range(pairs):
        a, b = (
            hulls.random_outline(
                rng, rng.integers(3, 17), 10.0 ** -rng.uniform(0, slimmest), 10.0 ** rng.uniform(-0.5, 0.5)
            )
            for _ in range(2)
        )
        hit = check_certificates(a, b + rng.uniform(-1.1, 1.1, 2), room)
        hits += hit
        if not hit:
            rounds.append(room.state[ROUNDS])
    return hits / pairs, rounds


def test_random_hulls_keep_their_certificates_and_few_rounds():
    share, rounds = fuzz(1, 3000 if JIT else 300, 4)
    assert 0.3 < share < 0.7
    assert np.percentile(rounds, 99) <= 10 and max(rounds) <= 20


def test_a_hundred_thousand_random_hulls_keep_their_certificates():
    share, rounds = fuzz(2, 100_000 if JIT else 5000, 4)
    assert 0.3 < share < 0.7
    assert np.percentile(rounds, 99) <= 10


@pytest.mark.parametrize("half", [1.6e-3, 2e-4, 1e-5])
def test_point_beyond_the_short_edge_of_a_plank(half):
    """A point beyond the short edge of a plank is not an overlap: no squared length has an absolute tolerance
    (docs/stability.md, C1).
    """
    plank = np.array([(-0.5, -half), (0.5, -half), (0.5, half), (-0.5, half)])
    found, normal, _, _ = gap_of(plank, np.array([(0.505, 0.0)]))
    assert found == pytest.approx(0.005, abs=1e-15) and normal.tolist() == [1.0, 0.0]


@pytest.mark.parametrize("exponent", range(-15, 0))
@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_small_gaps_and_overlaps_keep_sign_and_normal(exponent, sign):
    """Gaps and overlaps down to 1e-15 have the face's unit normal and are exact to 1e-12 of the size
    (docs/stability.md, C3, C9).
    """
    gap = sign * 10.0**exponent
    box, disc = Polygon.box(2, 2), Circle(1.0)
    for a, pose_a, b, pose_b, normal in (
        (box, ORIGIN, box, (2.0 + gap, 0.25, 0.0), (1, 0)),
        (box, ORIGIN, disc, (0.25, 2.0 + gap, 0.0), (0, 1)),
        (disc, ORIGIN, disc, (2.0 + gap, 0.0, 0.0), (1, 0)),
        (box, (0, 0, math.pi / 2), box, (0.3, -2.0 - gap, 0.0), (0, -1)),
        (Polygon([(-1, -1), (1, -1), (1, 1), (0, 1.5), (-1, 1)]), ORIGIN, box, (2.0 + gap, -0.5, 0.0), (1, 0)),
        (Capsule((0, -1), (0, 1), 1.0), ORIGIN, box, (2.0 + gap, 0.0, 0.0), (1, 0)),
    ):
        found = distance(a, pose_a, b, pose_b)
        assert found.distance == pytest.approx(gap, abs=2e-12)
        assert found.normal == pytest.approx(normal, abs=1e-9) and abs(math.hypot(*found.normal) - 1.0) < 1e-12
        assert (found.distance <= 0.0) == (len(collide(a, pose_a, b, pose_b)) > 0)


def test_signed_distance_is_monotone_through_touching():
    box, hexagon = Polygon.box(2, 2), Polygon([(math.cos(k), math.sin(k)) for k in np.arange(6) * math.pi / 3])
    gaps = sorted([0.0] + [s * 10.0**-k for k in range(1, 16) for s in (-1, 1)])
    for a, b, reach in ((box, box, 2.0), (box, Circle(1.0), 2.0), (hexagon, box, 2.0), (hexagon, hexagon, 2.0)):
        found = [distance(a, ORIGIN, b, (reach + gap, 0.0, 0.0)).distance for gap in gaps]
        assert all(p <= q for p, q in pairwise(found))
        assert sum(each == 0.0 for each in found) <= 3, "one band of touching"


def test_squares_overlap_alike_from_every_start():
    """Two overlapping squares have depth 0.1 and normal (0, 1) from every start corner and every order of corners
    (docs/stability.md, C4).
    """
    square = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    for roll in range(4):
        for i in range(4):
            for j in range(4):
                found, normal, _, _ = gap_of(np.roll(square, roll, axis=0), square + (0.0, 1.9), start=(i, j))
                assert found == pytest.approx(-0.1, abs=1e-15) and normal.tolist() == [0.0, 1.0]


@pytest.mark.parametrize(
    "shape, depth",
    [
        (Polygon.box(2, 6), 2.0),
        (Circle(3.0), 6.0),
        (Capsule((-5, 0), (5, 0), 2.0), 4.0),
        (Polygon([(0, 0), (4, 0), (0, 3)]), 2.4),
        (Segment((-5, 0), (5, 1)), 0.0),
        (Polygon([(-1, -3), (1, -3), (1, 3), (-1, 3)], 0.5), 3.0),
    ],
)
def test_identical_shapes_at_one_place(shape, depth):
    """Two identical shapes at one pose have their least width as depth, and a unit normal
    (docs/stability.md, C7, B6).
    """
    for pose in (ORIGIN, (3.0, -7.0, 0.7)):
        found = distance(shape, pose, shape, pose)
        assert found.distance == pytest.approx(-depth, abs=1e-12) and abs(math.hypot(*found.normal) - 1.0) < 1e-12
        assert found.iterations <= 60


def test_hulls_on_one_line_and_points():
    """distance() handles collinear hulls and points, whose Minkowski difference has no area."""
    line, point = np.array([(-1.0, 0.0), (1.0, 0.0)]), np.zeros((1, 2))
    for a, b, gap in (
        (line, line + (3.0, 0.0), 1.0),
        (line, line + (2.0, 0.0), 0.0),
        (line, line + (0.5, 0.0), 0.0),
        (line, point, 0.0),
        (point, point, 0.0),
        (point, line + (0.0, 1e-300), 1e-300),
        (line, line, 0.0),
        (line * 1e-12, line * 1e-12 + (1.0, 0.0), 1.0 - 2e-12),
    ):
        found, normal, _, _ = gap_of(a, b)
        assert found == pytest.approx(gap, abs=1e-15) and abs(math.hypot(*normal) - 1.0) < 1e-12


def test_boxes_that_share_an_edge():
    """Boxes that share an edge have distance 0, the edge's normal, and both points on the edge
    (docs/stability.md, C8).
    """
    box = Polygon.box(1, 1)
    found = distance(box, (0.5, 0.5, 0.0), box, (1.5, 0.5, 0.0))
    assert abs(found.distance) <= 1e-12 and found.normal == (1.0, 0.0)
    assert found.point_a[0] == pytest.approx(1.0, abs=1e-12) and found.point_b[0] == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("edge", [84.0, 500.0])
def test_witnesses_of_long_edges_stay_on_the_shapes(edge):
    """The two reported points lie on the surfaces of long shapes (docs/stability.md, C10).

    A box overlaps a slab with edges of 84 or 500 by 0.05, at several positions along it.
    """
    slab, box = Polygon.box(edge, 1.0), Polygon.box(2.0, 2.0)
    for x in np.linspace(-0.45 * edge, 0.45 * edge, 13):
        found = distance(slab, ORIGIN, box, (float(x), -1.45, 0.0))
        assert found.distance == pytest.approx(-0.05, abs=1e-12) and found.normal == (0.0, -1.0)
        assert abs(found.point_a[0] - x) <= 1.0 + 1e-9 and abs(found.point_b[0] - x) <= 1.0 + 1e-9
        assert -0.55 <= found.point_a[1] <= -0.45


def test_near_parallel_planes_end_soon():
    """The search on nearly parallel edges ends without reaching its cap (docs/stability.md, C12)."""
    room, rounds = new_gap_workspace(), []
    for k in range(400):
        tilt = 10.0 ** -(k % 17) * (1 if k % 2 else -1)
        a = np.array([(-10.0, -1.0), (10.0, -1.0), (10.0, 1.0), (-10.0, 1.0)])
        c, s = math.cos(tilt), math.sin(tilt)
        b = a @ np.array([[c, s], [-s, c]]) + (0.37 * k, 2.0 + abs(10.0 * s) + 10.0 ** -(k % 14))
        status = walk_to_nearest(room_for(a), 4, room_for(b), 4, 0, 0, room)
        assert room.state[CAPPED] == 0
        rounds.append(room.state[ROUNDS])
        assert status != TOUCHING or hulls.best_face_gap(a, b) <= 1e-14
    assert max(rounds) <= 10


@pytest.mark.parametrize("angle", [0.0, 0.3, 2.0])
def test_disc_and_box_in_closed_form(angle):
    """A disc and a rotated box match the closed form to 1e-9: deep, at an edge, at a corner, or just touching
    (docs/stability.md, C14).
    """
    box, disc, radius = Polygon.box(6.0, 4.0), Circle(1.5), 1.5
    c, s = math.cos(angle), math.sin(angle)
    for u, v, gap, normal in (
        (5.0, 0.5, 0.5, (1, 0)),
        (4.51, 0.0, 0.01, (1, 0)),
        (4.49, 0.0, -0.01, (1, 0)),
        (2.0, 0.1, -2.5, (1, 0)),
        (0.0, -1.0, -2.5, (0, -1)),
        (4.0, 3.0, math.sqrt(2) - 1.5, (0.5**0.5, 0.5**0.5)),
        (-3.0, -5.0, 1.5, (0, -1)),
        (-6.0, -6.0, 5.0 - radius, (-0.6, -0.8)),
    ):
        x, y = 3.0 + c * u - s * v, -4.0 + s * u + c * v
        found = distance(box, (3.0, -4.0, angle), disc, (x, y, 1.0))
        assert found.distance == pytest.approx(gap, abs=1e-9)
        assert found.normal == pytest.approx((c * normal[0] - s * normal[1], s * normal[0] + c * normal[1]), abs=1e-9)


def test_unit_box_in_a_big_one_leaves_by_the_least_translation():
    """The depth of a unit box inside a big one is the least translation that separates them
    (docs/stability.md, C15).
    """
    rng = np.random.default_rng(4)
    big, small = Polygon.box(100, 100), Polygon.box(1, 1)
    assert distance(big, ORIGIN, small, ORIGIN).distance == pytest.approx(-50.5, abs=1e-9)
    for x, y in rng.uniform(-49, 49, (40, 2)):
        assert distance(big, ORIGIN, small, (x, y, 0.0)).distance == pytest.approx(
            -(50.5 - max(abs(x), abs(y))), abs=1e-9
        )


def shape_of(kind, rng):
    """Return a random shape of a kind, about 10 px large."""
    if kind == "circle":
        return Circle(rng.uniform(1, 8), tuple(rng.uniform(-3, 3, 2)))
    if kind == "capsule":
        return Capsule((-rng.uniform(1, 8), 0.0), (1.0, rng.uniform(-4, 4)), rng.uniform(1, 4))
    if kind == "polygon":
        return Polygon(hulls.random_outline(rng, rng.integers(3, 9), rng.uniform(0.2, 1.0), rng.uniform(4, 12)))
    if kind == "rounded":
        return Polygon(hulls.random_outline(rng, rng.integers(3, 9), rng.uniform(0.2, 1.0), rng.uniform(4, 12)), 2.0)
    if kind == "box":
        return Polygon.box(*rng.integers(2, 20, 2))
    if kind == "segment":
        return Segment((-8.0, 1.0), tuple(rng.uniform(-3, 8, 2)))
    if kind == "chain":
        return Chain([(-12.0, 0.0), (-4.0, rng.uniform(-4, 4)), (4.0, rng.uniform(-4, 4)), (12.0, 0.0)])
    if kind == "tiles":
        return TileGrid(rng.random((3, 4)) < 0.5, 8.0)
    if kind == "mask":
        return PixelMask.from_array(rng.random((7, 9)) < 0.6)
    return Bounds(shape_of(rng.choice(["circle", "capsule", "polygon", "mask"]), rng))


KINDS = ("circle", "capsule", "polygon", "rounded", "box", "segment", "chain", "tiles", "mask", "bounds")


def pose_of(kind, rng, reach, whole):
    x, y = rng.uniform(-reach, reach, 2)
    angle = 0.0 if kind == "tiles" else float(rng.choice([0.0, math.pi / 2, rng.uniform(-3, 3)]))
    return (float(round(x)), float(round(y)), angle) if whole else (float(x), float(y), angle)


@pytest.mark.parametrize("kind_a", KINDS)
@pytest.mark.parametrize("kind_b", KINDS)
def test_distance_is_not_positive_exactly_where_collide_finds_a_contact(kind_a, kind_b):
    """The distance is at most 0 exactly where collide() finds a contact, for all kinds of shapes (U10, U7).

    It is then minus the depth of the contact. The coordinates are integers, so that many pairs just touch.
    """
    rng = np.random.default_rng([KINDS.index(kind_a), KINDS.index(kind_b)])
    for k in range(20 if JIT else 4):
        a, b = shape_of(kind_a, rng), shape_of(kind_b, rng)
        pose_a, pose_b = pose_of(kind_a, rng, 3, k % 2), pose_of(kind_b, rng, (5, 9, 22)[k % 3], k % 2)
        found, contact = distance(a, pose_a, b, pose_b), collide(a, pose_a, b, pose_b)
        case = (a, pose_a, b, pose_b, found, contact)
        open_ = "mask" in (kind_a, kind_b) and "chain" not in (kind_a, kind_b)  # touching is 0 and no contact
        assert (found.distance < 0.0 if open_ else found.distance <= 0.0) == (len(contact) > 0), case
        if len(contact):
            assert found.distance == pytest.approx(contact.separations.min(), abs=1e-9), case
        turned = distance(b, pose_b, a, pose_a)
        assert (turned.distance, turned.point_a, turned.point_b) == (found.distance, found.point_b, found.point_a), case
        assert turned.normal == (0.0 - found.normal[0], 0.0 - found.normal[1]), case
        assert abs(math.hypot(*found.normal) - 1.0) <= 1e-12
        if math.isfinite(found.distance):
            assert found.point_b == pytest.approx(
                np.add(found.point_a, np.multiply(found.distance, found.normal)), abs=1e-12
            )


def outline_of(shape, pose):
    from shapely.geometry import LineString, MultiLineString, Point

    from tests.oracles import outlines

    if isinstance(shape, Circle):
        return Point(*outlines.placed([shape.center], pose)[0]), shape.radius
    if isinstance(shape, Polygon):
        return outlines.polygon(shape.points, pose), shape.radius
    if isinstance(shape, (Capsule, Segment)):
        return LineString(outlines.placed(shape.points, pose)), getattr(shape, "radius", 0.0)
    if isinstance(shape, Chain):
        points = outlines.placed(shape.points, pose)
        return MultiLineString(list(pairwise(points))), 0.0
    if isinstance(shape, TileGrid):
        return outlines.tiles(shape.solid.tolist(), shape.slopes.tolist(), shape.tile_size, *pose[:2]), 0.0
    turned = shape.turned(pose[2])
    return outlines.pixels(
        turned.solid.tolist(),
        math.floor(pose[0] - turned.origin[0] + 0.5),
        math.floor(pose[1] - turned.origin[1] + 0.5),
    ), 0.0


@pytest.mark.parametrize("kind_a", KINDS[:-1])
@pytest.mark.parametrize("kind_b", KINDS[:-1])
def test_distance_of_shapes_apart_is_shapelys(kind_a, kind_b):
    pytest.importorskip("shapely")
    rng = np.random.default_rng([7, KINDS.index(kind_a), KINDS.index(kind_b)])
    for _ in range(12 if JIT else 3):
        a, b = shape_of(kind_a, rng), shape_of(kind_b, rng)
        pose_a, pose_b = pose_of(kind_a, rng, 3, False), pose_of(kind_b, rng, 40, False)
        (outline_a, radius_a), (outline_b, radius_b) = outline_of(a, pose_a), outline_of(b, pose_b)
        gap = outline_a.distance(outline_b) - radius_a - radius_b
        if gap > 1e-9:
            assert distance(a, pose_a, b, pose_b).distance == pytest.approx(gap, abs=1e-9), (a, pose_a, b, pose_b)


def test_masks_that_touch_share_no_pixel_and_are_0_apart():
    mask = PixelMask.from_array(np.ones((4, 4), bool))
    assert distance(mask, ORIGIN, mask, (4, 0, 0)).distance == 0.0 == distance(mask, ORIGIN, Circle(1), (3, 0)).distance
    assert distance(mask, ORIGIN, mask, (3, 0, 0)).distance == -1.0
    assert distance(mask, ORIGIN, mask, (7.4, 0, 0)).distance == 3.0, "measured as it is drawn, on the pixel grid"


def test_chain_has_only_a_front_and_an_empty_mask_is_nowhere():
    floor, ball = Chain([(0, 0), (100, 0)]), Circle(5.0)
    assert distance(floor, ORIGIN, ball, (50, -3, 0)).distance == pytest.approx(-2.0)
    assert 0.0 < distance(floor, ORIGIN, ball, (50, 3, 0)).distance < 1e-300
    assert distance(floor, ORIGIN, ball, (50, 9, 0)).distance == pytest.approx(4.0)
    empty = PixelMask.from_array(np.zeros((3, 3), bool))
    found = distance(empty, ORIGIN, ball, (50, 3, 0))
    assert found.distance == math.inf and abs(found.normal[0]) == 1.0


@pytest.mark.parametrize("exponent", [-20, -3, 20])
def test_scaled_by_a_power_of_two_distances_scale_to_the_bit(exponent):
    rng, scale = np.random.default_rng(9), 2.0**exponent
    room = new_gap_workspace()
    for _ in range(300 if JIT else 40):
        a, b = (hulls.random_outline(rng, rng.integers(1, 17), 10.0 ** -rng.uniform(0, 3)) for _ in range(2))
        b += rng.uniform(-1.2, 1.2, 2)
        here = [np.copy(each) for each in gap_of(a, b, room)]
        there = gap_of(a * scale, b * scale, room)
        assert there[0] == here[0] * scale and (there[1] == here[1]).all()
        assert (there[2] == here[2] * scale).all() and (there[3] == here[3] * scale).all()


def test_far_from_the_origin_nothing_is_lost():
    box, far = Polygon.box(1, 1), 1e7
    for gap in (1e-6, 0.25):
        assert distance(box, (far, far, 0.0), box, (far + 1.0 + gap, far, 0.0)).distance == pytest.approx(gap, abs=4e-9)


def test_gjk_steps_end_at_the_distance():
    hexagon, box = Polygon([(5 * math.cos(k), 5 * math.sin(k)) for k in np.arange(6) * math.pi / 3]), Polygon.box(4, 4)
    apart, deep = gjk_steps(hexagon, ORIGIN, box, (9, 2, 0.4)), gjk_steps(hexagon, ORIGIN, box, (3, 2, 0.4))
    assert {each["phase"] for each in apart} == {"gjk"} and apart[-1]["distance"] == pytest.approx(
        distance(hexagon, ORIGIN, box, (9, 2, 0.4)).distance
    )
    assert [each["phase"] for each in deep] == sorted((each["phase"] for each in deep), reverse=True)
    assert deep[-1]["distance"] == pytest.approx(distance(hexagon, ORIGIN, box, (3, 2, 0.4)).distance)
    assert len(deep[-1]["polytope"]) >= 3
    falling = [each["distance"] for each in apart]
    assert all(p >= q for p, q in pairwise(falling))
    for each in apart + deep:
        assert each["simplex"].shape[1] == 2 and math.hypot(*each["direction"]) == pytest.approx(1.0)
        assert len(each["witness"]) == 2
    with pytest.raises(TypeError, match="convex"):
        gjk_steps(Chain([(0, 0), (1, 0)]), ORIGIN, box, ORIGIN)


@pytest.mark.parametrize(
    "a, pose, error, words",
    [
        ("ball", ORIGIN, TypeError, "shape_a"),
        (Circle(1), (0, 0, 0, 0), TypeError, "pose_a"),
        (Circle(1), (0, math.nan, 0), ValueError, "pose_a"),
        (TileGrid(np.ones((1, 1), bool), 4.0), (0, 0, 0.1), ValueError, "pose_a"),
    ],
)
def test_wrong_arguments_are_named(a, pose, error, words):
    with pytest.raises(error, match=words):
        distance(a, pose, Circle(1), ORIGIN)
