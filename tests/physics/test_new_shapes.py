"""Capsules, rounded polygons, segments and chains: bad input, masses, boxes, snapshots, rays, characters, axes and
masks.
"""

import math

import numpy as np
import pytest

from game.measure.shape_traces import sat_axes
from physics import (
    JIT,
    Bounds,
    Capsule,
    Chain,
    Character,
    Circle,
    Effects,
    Material,
    PixelMask,
    Polygon,
    Segment,
    Snapshot,
    TileGrid,
    World,
    collide,
    debug,
    mass_of,
)

shapely = pytest.importorskip("shapely")
from tests.physics.test_hull_manifolds import PAIRS, gap_of, hull_of, random_shape  # noqa: E402

NAN = float("nan")
TRIANGLE = ((0, 0), (10, 0), (0, 10))
ROUNDED = Polygon(TRIANGLE, 2.0)


@pytest.mark.parametrize(
    "make, error, words",
    [
        (lambda: Capsule((1, 2), (1, 2), 3), ValueError, ("a and b", "Circle")),
        (lambda: Capsule((0, 0), (1e-9, 0), 3), ValueError, ("a and b",)),
        (lambda: Capsule((0, 0), (9, 0), 0), ValueError, ("radius", "> 0")),
        (lambda: Capsule((0, NAN), (9, 0), 1), ValueError, ("a[1]", "nan", "finite")),
        (lambda: Capsule((0, 0), "b", 1), TypeError, ("b",)),
        (lambda: Segment((1, 1), (1, 1)), ValueError, ("a and b", "length")),
        (lambda: Segment((0, 0), (math.inf, 1)), ValueError, ("b[0]", "inf")),
        (lambda: Polygon(TRIANGLE, -1), ValueError, ("radius", ">= 0", "-1")),
        (lambda: Polygon(TRIANGLE, NAN), ValueError, ("radius", "nan")),
        (lambda: Polygon(((0, 0), (1e-12, 0), (5, 5), (0, 5))), ValueError, ("equal",)),
        (lambda: Polygon(((0, 0), (10, 0), (20, 1e-13))), ValueError, ("line",)),
        (lambda: Polygon([(math.cos(k), math.sin(k)) for k in np.linspace(0, 6, 17)], 1), ValueError, ("3..16", "17")),
        (lambda: Chain([(0, 0)]), ValueError, ("points", "2", "1")),
        (lambda: Chain([]), ValueError, ("points", "2")),
        (lambda: Chain([(0, 0), (1, 0)], loop=True), ValueError, ("points", "3")),
        (lambda: Chain([(0, 0), (1, 0), (1, 0)]), ValueError, ("points[1] and points[2]",)),
        (lambda: Chain([(0, 0), (1, 0), (1, 1), (0, 0)], loop=True), ValueError, ("points[3] and points[0]", "closes")),
        (lambda: Chain([(0, 0), (1, NAN)]), ValueError, ("points[1]", "finite")),
        (lambda: Chain([(0, 0), (1, 1)], ghosts=((0, 1),)), TypeError, ("ghosts", "pair")),
        (lambda: Chain([(0, 0), (1, 1)], ghosts=((0, 0), None)), ValueError, ("ghosts[0]",)),
        (lambda: Chain([(0, 0), (1, 1), (2, 0)], loop=True, ghosts=((0, 1), (3, 1))), ValueError, ("ghosts", "loop")),
        (lambda: Chain([(0, 0), (1, 1)], materials=(Material(), Material())), ValueError, ("materials", "1", "2")),
        (lambda: Chain([(0, 0), (1, 1)], materials=("ice",)), TypeError, ("materials[0]", "ice")),
        (lambda: Chain([(0, 0), (1, 1)], loop=1), TypeError, ("loop",)),
        (lambda: Bounds(Segment((0, 0), (1, 1))), TypeError, ("shape", "Capsule")),
        (lambda: Material(rolling_resistance=-0.1), ValueError, ("rolling_resistance", ">= 0")),
        (lambda: Material(surface_speed=math.inf), ValueError, ("surface_speed", "inf")),
        (lambda: World().add_body(Chain([(0, 0), (1, 1)])), ValueError, ("Chain", "static or kinematic")),
        (lambda: World().add_body(Segment((0, 0), (1, 1))), ValueError, ("Segment", "area")),
        (lambda: World().add_body(Chain([(0, 0), (1, 1)]), kind="static").set_kind("dynamic"), ValueError, ("Chain",)),
    ],
)
def test_what_is_no_shape_is_refused_by_name(make, error, words):
    with pytest.raises(error) as refused:
        make()
    assert all(word in str(refused.value) for word in words), str(refused.value)


def test_shapes_compare_by_value_and_stand_once_in_the_library():
    world = World()
    for _ in range(3):
        world.add_body(Capsule([0, 0], np.array([4.0, 0.0]), 1), Polygon(TRIANGLE, 2), Circle(1))
        world.add_body(Chain(np.array([(0, 50), (9, 50)])), Segment((0, 0), (1, 1)), kind="static")
    assert len(world.library.outlines) == 3 and len(world.library.chain_shapes) == 1
    assert Capsule((0, 0), (4, 0), 1) == Capsule([0, 0], [4, 0], 1.0) != Capsule((0, 0), (4, 0), 2)
    assert Polygon(TRIANGLE) != Polygon(TRIANGLE, 1.0) and Polygon(TRIANGLE)
    world.add_body(Circle(2), Segment((0, 0), (9, 0)))  # a segment beside what has mass


def by_slices(distance_inside, box, count=20000):
    """Return (area, centre, second moment about the centre) of a convex region, integrated in slices along x.

    distance_inside(x) returns the (low, high) y of the slices at an array x. box: least and greatest x.
    """
    left, right = box
    nodes, weights = np.polynomial.legendre.leggauss(40)
    edges = np.linspace(left, right, count // 40 + 1)
    x = ((edges[1:] + edges[:-1])[:, None] / 2 + np.outer(np.diff(edges) / 2, nodes)).ravel()
    w = np.outer(np.diff(edges) / 2, weights).ravel()
    low, high = distance_inside(x)
    area = (w * (high - low)).sum()
    center = np.array([(w * x * (high - low)).sum(), (w * (high**2 - low**2) / 2).sum()]) / area
    second = (w * ((x - center[0]) ** 2 * (high - low) + ((high - center[1]) ** 3 - (low - center[1]) ** 3) / 3)).sum()
    return area, center, second


def test_the_mass_of_a_capsule_in_closed_form_and_by_slices():
    r, half = 2.5, 6.0
    found = mass_of(Capsule((-half, 0), (half, 0), r), 2.0)

    def slices(x):
        height = np.sqrt(np.maximum(r * r - np.maximum(np.abs(x) - half, 0.0) ** 2, 0.0))
        return -height, height

    area, center, second = by_slices(slices, (-half - r, half + r))
    assert found.mass == pytest.approx(2.0 * (math.pi * r * r + 4 * half * r), rel=1e-14)
    assert found.mass == pytest.approx(2.0 * area, rel=1e-6) and found.inertia == pytest.approx(2.0 * second, rel=1e-6)
    assert found.center == (0.0, 0.0) and np.abs(center).max() < 1e-12
    turned = mass_of(Capsule((1e6 + 3, -4), (1e6 - 3, 4), 2.5), 2.0)
    assert turned.inertia == pytest.approx(mass_of(Capsule((-5, 0), (5, 0), 2.5), 2.0).inertia, rel=1e-9)
    assert turned.center == pytest.approx((1e6, 0))


def test_the_mass_of_a_rounded_polygon_is_that_of_its_parts():
    """The mass of a rounded polygon equals the sum of its parts.

    A rounded box is compared with the closed form, a polygon of 16 corners with a disc, and an irregular one with
    shapely.
    """
    w, h, r = 8.0, 4.0, 1.5
    found = mass_of(Polygon(Polygon.box(w, h).points, r), 3.0)
    area = w * h + 2 * r * (w + h) + math.pi * r * r
    # The frame without corners is two boxes less one; each corner is a quarter disc.
    quarter = math.pi * r * r / 4
    off = 4 * r / (3 * math.pi)
    own = quarter * r * r / 2 - 2 * quarter * off * off
    second = (
        (w + 2 * r) * h * ((w + 2 * r) ** 2 + h * h) / 12
        + w * (h + 2 * r) * (w * w + (h + 2 * r) ** 2) / 12
        - w * h * (w * w + h * h) / 12
        + 4 * (own + quarter * ((w / 2 + off) ** 2 + (h / 2 + off) ** 2))
    )
    assert found.mass == pytest.approx(3 * area, rel=1e-12) and found.inertia == pytest.approx(3 * second, rel=1e-12)
    assert found.center == pytest.approx((0, 0), abs=1e-12)
    ring = [(math.cos(t) * 4, math.sin(t) * 4) for t in np.arange(16) * math.tau / 16]
    disc = mass_of(Polygon(ring, 6.0), 1.0)
    assert disc.mass < math.pi * 100 and disc.mass == pytest.approx(math.pi * 100, rel=0.02)
    points = ((0, 0), (9, 1), (7, 6), (1, 5))
    outline = shapely.Polygon(points).buffer(2.0, quad_segs=2000)
    lopsided = mass_of(Polygon(points, 2.0), 1.0)
    assert lopsided.mass == pytest.approx(outline.area, rel=1e-6) and lopsided.center == pytest.approx(
        outline.centroid.coords[0], rel=1e-6
    )
    assert mass_of(Polygon([(x + 1e6, y) for x, y in points], 2.0), 1.0).inertia == pytest.approx(
        lopsided.inertia, rel=1e-8
    )


def test_lines_have_no_mass_and_sizes_count_the_radius():
    assert mass_of((Segment((0, 0), (5, 5)), Chain([(0, 0), (1, 1)])), 1.0).mass == 0.0
    both = mass_of((Circle(2, (3, 3)), Segment((0, 0), (5, 5))), 1.0)
    assert both == mass_of(Circle(2, (3, 3)), 1.0)
    assert [
        each.min_half_extent
        for each in (
            Capsule((0, 0), (9, 0), 2),
            Polygon(Polygon.box(8, 4).points, 1),
            Segment((0, 0), (9, 9)),
            Chain([(0, 0), (1, 1)]),
        )
    ] == [2.0, 3.0, 0.0, 0.0]
    assert Capsule((0, 0), (9, 0), 2).reach(0, 0) == 11.0 and Polygon(TRIANGLE, 2).reach(0, 0) == 12.0


@pytest.mark.parametrize("angle", [0.0, 0.7, math.pi / 2])
def test_boxes_around_are_tight(angle):
    world, shapes = (
        World(),
        (
            Capsule((-3, 1), (5, 2), 2),
            ROUNDED,
            Segment((0, 0), (3, 9)),
            Bounds(ROUNDED),
            Chain([(0, 0), (7, 3), (20, -4)]),
        ),
    )
    for shape in shapes:
        world.add_body(shape, kind="static", position=(10, 20), angle=angle)
    for shape, box in zip(shapes, debug.bounds(world), strict=True):
        core, radius = hull_of(shape, (10, 20, angle))
        assert box.tolist() == pytest.approx([*(core.min(axis=0) - radius), *(core.max(axis=0) + radius)], abs=1e-12)


def test_snapshots_keep_every_kind(tmp_path):
    world = World()
    world.add_body(Capsule((-5, 0), (5, 0), 3), Segment((0, 0), (9, 9)), angle=0.5)
    world.add_body(
        ROUNDED, Polygon(TRIANGLE), position=(50, 0), material=Material(rolling_resistance=0.2, surface_speed=-4.0)
    )
    world.add_body(
        Chain([(0, 40), (30, 45), (60, 40)], ghosts=(None, (90, 40)), materials=(Material(), Material(friction=0.1))),
        Chain([(0, 0), (9, 0), (9, 9)], loop=True),
        Bounds(Capsule((0, 0), (4, 4), 1)),
        kind="static",
    )
    for _ in range(20):
        world.step()
    world.snapshot().save(tmp_path / "s.npz")
    other = World()
    other.restore(Snapshot.load(tmp_path / "s.npz"))
    assert [body.shapes for body in map(other.body, range(3))] == [body.shapes for body in map(world.body, range(3))]
    for _ in range(30):
        world.step()
        other.step()
    assert world.digest() == other.digest()
    assert (
        other.shapes["rolling_resistance"].tolist()[2:4] == [0.2, 0.2]
        and other.shapes["surface_speed"].tolist()[2] == -4.0
    )


def test_outlines_name_every_kind():
    world = World()
    world.add_body(Capsule((-5, 0), (5, 0), 3), Segment((0, 0), (9, 9)), ROUNDED, Polygon(TRIANGLE), position=(10, 0))
    world.add_body(Chain([(0, 40), (30, 45), (60, 40)], loop=True), kind="static")
    kinds = debug.outlines(world)
    assert [each[0] for each in kinds] == ["capsule", "segment", "rounded", "polygon", "chain"]
    assert kinds[0][1:] == (5.0, 0.0, 15.0, 0.0, 3.0) and kinds[2][2] == 2.0
    assert kinds[4][1].tolist() == [[0, 40], [30, 45], [60, 40], [0, 40]]


@pytest.mark.parametrize("kind", ["capsule", "rounded", "segment", "polygon"])
def test_rays_enter_where_the_outline_is(kind):
    rng, hits = np.random.default_rng(8), 0
    for _ in range(150 if JIT else 30):
        shape, pose = random_shape(kind, rng), (*rng.uniform(-9, 9, 2).tolist(), float(rng.uniform(-7, 7)))
        start, end = rng.uniform(-25, 25, (2, 2))
        core, radius = hull_of(shape, pose)
        hull = shapely.MultiPoint([tuple(p) for p in core]).convex_hull
        world = World(Effects())
        world.add_body(shape, position=pose[:2], angle=pose[2], kind="static")
        hit = world.ray_cast(start, end - start)
        gap = hull.distance(shapely.LineString([start, end])) - radius
        assert (hit is not None) == (gap <= 0.0) or abs(gap) < 1e-9
        if hit and hit.fraction > 0.0:
            hits += 1
            at = shapely.Point(hit.point)
            assert abs(hull.distance(at) - radius) < 1e-9, "the point lies on the surface"
            before = shapely.LineString([start, np.array(hit.point) - (end - start) * 1e-6])
            assert hull.distance(before) - radius > 0.0 or kind == "segment", "and nothing of the shape before it"
            assert np.dot(hit.normal, end - start) <= 1e-9 and math.hypot(*hit.normal) == pytest.approx(1.0)
            out = shapely.Point(np.array(hit.point) + 1e-5 * np.array(hit.normal))
            assert hull.distance(out) - radius > 0.9e-5
    assert hits > (10 if JIT else 2)


def test_rays_meet_lines_from_their_sides():
    world = World(Effects())
    world.add_body(Segment((0, 0), (10, 0)), kind="static")
    world.add_body(Chain([(0, 20), (10, 20), (20, 10)]), kind="static")
    for y in (-4, 4):
        assert world.ray_cast((5, y), (0, -2 * y)).normal == (0.0, math.copysign(1, y))
    assert world.ray_cast((-5, 0), (10, 0)).point == (0.0, 0.0), "along a segment its end is met"
    assert world.ray_cast((5, 0), (3, 4)).fraction == 0.0 and len(world.query_point((5, 0))) == 1
    assert world.ray_cast((5, 10), (0, 20)).point == (5.0, 20.0)
    assert world.ray_cast((5, 30), (0, -20)) is None, "a chain is met from its front only"
    assert world.ray_cast((10, 10), (0, 20)).point == (10.0, 20.0), "through a corner of two links"
    for x in np.linspace(0, 20, 333):
        assert world.ray_cast((float(x), 5), (0, 20)) is not None
    turned = World(Effects())
    turned.add_body(Chain([(k, 0) for k in range(100)]), kind="static", angle=1.1, position=(5, 5))
    for k in np.linspace(0.01, 98.9, 100):
        at = (5 + k * math.cos(1.1), 5 + k * math.sin(1.1))
        n = (math.sin(1.1), -math.cos(1.1))
        hit = turned.ray_cast((at[0] + n[0], at[1] + n[1]), (-2 * n[0], -2 * n[1]))
        assert hit.fraction == pytest.approx(0.5) and hit.normal == pytest.approx(n)


@pytest.mark.parametrize("kinds", PAIRS, ids="-".join)
def test_the_best_axis_separates_by_the_distance(kinds):
    rng = np.random.default_rng(3)
    for _ in range(10):
        a, b = (random_shape(kind, rng) for kind in kinds)
        pose_a, pose_b = ((*rng.uniform(-8, 8, 2), float(rng.uniform(-7, 7))) for _ in range(2))
        rows, gap = sat_axes(a, pose_a, b, pose_b), gap_of(hull_of(a, pose_a), hull_of(b, pose_b))
        assert rows["separation"][0] == pytest.approx(gap, abs=1e-9) or kinds == ("segment", "segment")
        assert (np.diff(rows["separation"]) <= 0).all() and np.hypot(
            rows["normal_x"], rows["normal_y"]
        ) == pytest.approx(1.0)


def squares(solid, x, y):
    return shapely.union_all([shapely.box(c + x, r + y, c + x + 1, r + y + 1) for r, c in np.argwhere(solid)])


@pytest.mark.parametrize("kind", ["capsule", "rounded", "segment"])
def test_masks_meet_what_runs_through_their_pixels(kind):
    rng, hits = np.random.default_rng(5), 0
    for _ in range(60 if JIT else 12):
        solid = rng.random((10, 12)) < 0.6
        mask = PixelMask(solid, origin=(0, 0))
        shape, pose = random_shape(kind, rng), (*rng.uniform(0, 12, 2).tolist(), float(rng.uniform(-7, 7)))
        core, radius = hull_of(shape, pose)
        hull, pixels = shapely.MultiPoint([tuple(p) for p in core]).convex_hull, squares(solid, 0, 0)
        found = collide(mask, (0, 0, 0), shape, pose)
        inside = pixels.distance(hull) < radius if radius else hull.intersection(pixels.buffer(-1e-9)).length > 1e-6
        assert (len(found) > 0) == inside
        if not len(found):
            continue
        hits += 1
        assert math.hypot(*found.normal) == pytest.approx(1.0) and found.area > 0
        if radius:
            n, far = np.array(found.normal), -found.separations[0]
            met = squares(
                np.array(
                    [
                        [solid[r, c] and shapely.box(c, r, c + 1, r + 1).distance(hull) < radius for c in range(12)]
                        for r in range(10)
                    ]
                ),
                0,
                0,
            )
            moved = shapely.MultiPoint([tuple(p) for p in core + n * (far + 1e-9)]).convex_hull
            assert met.distance(moved) >= radius - 1e-9, "the move along the normal clears the pixels that were met"
            assert found.area == pytest.approx(met.area)
    assert hits > (8 if JIT else 1)


def test_a_segment_along_pixel_borders_is_met_inside_the_solid_only():
    mask = PixelMask(np.ones((4, 4), bool), origin=(0, 0))
    for y, hit in ((0, False), (1, True), (2, True), (4, False), (1.5, True)):
        found = collide(mask, (0, 0, 0), Segment((-5, y), (9, y)), (0, 0, 0))
        assert (len(found) > 0) == hit
        if hit:
            assert abs(found.normal[1]) == 1.0 and 0.5 <= -found.separations[0] <= 2.0


def test_characters_stand_on_and_stop_at_the_new_kinds():
    world = World(Effects(response=True))
    world.add_body(Chain([(0, 100), (100, 100), (160, 70), (200, 70)]), kind="static")
    world.add_body(Capsule((300, 60), (300, 100), 10), Polygon(Polygon.box(20, 20, (400, 90)).points, 5), kind="static")
    world.add_body(Chain([(260, 105), (500, 105)]), kind="static")
    hero = Character(world, Polygon.box(10, 20), (50, 60))
    assert hero.move(0, 60).grounded and hero.position[1] == 90.0
    for _ in range(140):
        moved = hero.move(1, 0)
        hero.move(0, 1)
    assert hero.position[0] > 170.0 and hero.position[1] == 60.0, (
        "it walks up a link that is no steeper than 45 degrees"
    )
    world = World(Effects(response=True))
    world.add_body(Capsule((300, 60), (300, 100), 10), kind="static")
    world.add_body(Chain([(200, 105), (500, 105)]), kind="static")
    hero = Character(world, Polygon.box(10, 20), (260, 95))
    moved = hero.move(80, 0)
    assert hero.position[0] == 285.0 and moved.wall == 1, "a capsule is a wall"
    rises = Character(world, Polygon.box(10, 20), (450, 140))
    rises.move(0, -80)
    assert rises.position[1] == 60.0, "a level chain is passed from below"
    assert rises.move(0, 80).grounded and rises.position[1] == 95.0


def test_tile_grids_are_still_refused_when_turned():
    with pytest.raises(ValueError, match="TileGrid"):
        collide(TileGrid(np.ones((1, 1), bool), 8), (0, 0, 1.0), Capsule((0, 0), (1, 0), 1), (0, 0, 0))
