"""Rays and other queries at boundaries, inside shapes, with length 0 and with ties, compared with exact outlines."""

import math

import numpy as np
import pytest

from physics import JIT, Bounds, Circle, Effects, Filter, PixelMask, Polygon, TileGrid, World
from physics.shapes.outline import outline_of

EDGE = 1.0 + 1e-12


def outline_of_mask(mask):
    """Return (corners, radius) of the parts of a mask's outline."""
    shapes = [part.shape for part in outline_of(mask)]
    return [((s.center,) if isinstance(s, Circle) else s.points, s.radius) for s in shapes]


def world_of(*shapes, **options):
    world = World(Effects(sensors=True))
    for shape in shapes:
        world.add_body(shape, kind="static", **options)
    return world


RAYS = [  # box from (-1, -1) to (1, 1): origin, translation, fraction or None, normal
    ("straight on", (-3, 0), (4, 0), 0.5, (-1, 0)),
    ("ends exactly on the face", (-3, 0), (2, 0), 1.0, (-1, 0)),
    ("ends one ulp short", (-3, 0), (np.nextafter(2, 0), 0), None, None),
    ("points away", (-3, 0), (-4, 0), None, None),
    ("above it", (-3, -EDGE), (6, 0), None, None),
    ("along the upper face", (-3, -1), (6, 0), 1 / 3, (-1, 0)),
    ("along the lower face", (-3, 1), (6, 0), 1 / 3, (-1, 0)),
    ("along the right face", (1, -3), (0, 6), 1 / 3, (0, -1)),
    ("through a corner", (-2, 0), (2, 2), 0.5, None),
    ("diagonal through two corners", (-2, -2), (4, 4), 0.25, None),
    ("from inside", (0.5, 0.5), (5, 0), 0.0, (-1, 0)),
    ("from inside, ending inside", (0, 0), (0.5, 0), 0.0, (-1, 0)),
    ("starts on the face, going in", (-1, 0), (1, 0), 0.0, (-1, 0)),
    ("zero length inside", (0.2, 0.1), (0, 0), 0.0, (0, -1)),
    ("zero length on the face", (1, 0), (0, 0), 0.0, (0, -1)),
    ("zero length outside", (EDGE, 0), (0, 0), None, None),
    ("parallel inside the slab of y, left of it", (-3, 0), (0, 6), None, None),
]


@pytest.mark.parametrize("name, origin, translation, fraction, normal", RAYS, ids=[r[0] for r in RAYS])
@pytest.mark.parametrize("shape", ["box", "bounds", "tile", "tiles", "corner box"])
def test_ray_against_a_box(shape, name, origin, translation, fraction, normal):
    made = {
        "box": Polygon.box(2, 2),
        "bounds": Bounds(Polygon.box(2, 2)),
        "tile": TileGrid(np.ones((1, 1), bool), 2.0),
        "tiles": TileGrid(np.pad(np.ones((1, 1), bool), 1), 2.0),
        "corner box": Polygon([(0, 0), (2, 0), (2, 2), (0, 2)]),
    }
    world = World(Effects())
    at = {"tile": (-1, -1), "tiles": (-3, -3), "corner box": (-1, -1)}.get(shape, (0, 0))
    world.add_body(made[shape], position=at, kind="static")
    hit = world.ray_cast(origin, translation)
    assert (hit is not None) == (fraction is not None)
    if hit:
        assert hit.fraction == pytest.approx(fraction, rel=4e-16, abs=0)
        assert hit.point == pytest.approx(
            (origin[0] + hit.fraction * translation[0], origin[1] + hit.fraction * translation[1])
        )
        assert math.hypot(*hit.normal) == pytest.approx(1.0, abs=1e-12)
        if normal:
            assert hit.normal == normal


def test_ray_against_a_circle_in_closed_form():
    world = world_of(Circle(3.0))
    hit = world.ray_cast((-10, 1.5), (20, 0))
    assert hit.fraction == pytest.approx((10 - math.sqrt(9 - 2.25)) / 20, abs=1e-15)
    assert hit.normal == pytest.approx((-math.sqrt(6.75) / 3, 0.5))
    assert world.ray_cast((-10, 3.0), (20, 0)).fraction == pytest.approx(0.5), "a tangent touches"
    assert world.ray_cast((-10, 3.0000001), (20, 0)) is None
    assert world.ray_cast((1, 1), (0, 9)).fraction == 0.0 and world.ray_cast((1, 1), (0, 9)).normal == (0, -1)
    assert world.ray_cast((3, 0), (0, 0)).fraction == 0.0 and world.ray_cast((3.0001, 0), (0, 0)) is None


def test_rays_at_corners_never_leak_in():
    rng = np.random.default_rng(1)
    for _ in range(150 if JIT else 40):
        angle, (w, h), (x, y) = rng.uniform(0, 7), rng.uniform(1, 30, 2), rng.uniform(-100, 100, 2)
        world = World(Effects())
        world.add_body(Polygon.box(w, h), position=(x, y), angle=angle, kind="static")
        c, s = math.cos(angle), math.sin(angle)
        for u, v in ((w / 2, h / 2), (w / 2, -h / 2), (-w / 2, h / 2), (-w / 2, -h / 2)):
            dx, dy = c * u - s * v, s * u + c * v
            assert world.ray_cast((x + 3 * dx, y + 3 * dy), (-3 * dx, -3 * dy)) is not None


@pytest.mark.parametrize("seed", range(2))
def test_rays_hit_where_the_outline_is_crossed_first(seed):
    pytest.importorskip("shapely")
    from shapely.geometry import LineString

    from tests.oracles import outlines

    rng, hits = np.random.default_rng(seed), 0
    slopes = np.zeros((3, 4, 2))
    solid = rng.random((3, 4)) < 0.4
    slopes[~solid & (rng.random((3, 4)) < 0.5)] = (0.5, 1.0)
    bits = rng.random((9, 11)) < 0.4
    mask = PixelMask(bits)
    cases = [
        (
            TileGrid(solid, 8.0, slopes=slopes),
            (0.0, 0.0, 0.0),
            outlines.tiles(solid.tolist(), slopes.tolist(), 8.0, 0, 0),
        ),
        (mask, (8.5, 2.5, 0.0), outlines.rounded_union(outline_of_mask(mask), (8.5, 2.5, 0.0))),
        (mask, (8.5, 2.5, 0.7), outlines.rounded_union(outline_of_mask(mask), (8.5, 2.5, 0.7))),
        (Polygon.box(12, 5), (7.0, 3.0, 0.8), outlines.rectangle(12, 5, (7.0, 3.0, 0.8))),
    ]
    for shape, pose, outline in cases:
        world = World(Effects())
        world.add_body(shape, position=pose[:2], angle=pose[2], kind="static")
        for _ in range(150 if JIT else 30):
            (x, y), (dx, dy) = rng.uniform(-25, 40, 2), rng.uniform(-50, 50, 2)
            crossing = LineString([(x, y), (x + dx, y + dy)]).intersection(outline)
            hit = world.ray_cast((x, y), (dx, dy))
            if crossing.is_empty or crossing.length < 1e-6:
                assert hit is None or not crossing.is_empty or outline.distance(outlines.Point(hit.point)) < 1e-6
                continue
            first = outlines.Point(x, y).distance(crossing) / math.hypot(dx, dy)
            assert hit is not None and hit.fraction == pytest.approx(first, abs=1e-6 if shape is mask else 1e-9)
            hits += 1
            if first > 0.0:
                probe = (hit.point[0] - 1e-6 * hit.normal[0], hit.point[1] - 1e-6 * hit.normal[1])
                assert outline.distance(outlines.Point(probe)) < 1e-9, "the normal points out of the shape"
    assert hits > (60 if JIT else 8)


def test_all_hits_come_nearest_first_and_ties_by_shape_id():
    world = World(Effects())
    for x in (50.0, 20.0, 80.0, 20.0):
        world.add_body(Polygon.box(4, 4), position=(x, 0.0), kind="static")
    hits = world.ray_cast_all((0, 0), (100, 0))
    assert [h.shape for h in hits] == [1, 3, 0, 2] and [h.body.id for h in hits] == [1, 3, 0, 2]
    assert world.ray_cast((0, 0), (100, 0)).shape == 1
    assert len(world_of(*[Circle(3.0)] * 128).ray_cast_all((-9, 0), (20, 0))) == 128


def test_ray_filters_both_ways_and_sensors_on_demand():
    world = World(Effects(sensors=True))
    world.add_body(Circle(3.0), filter=Filter(0b01, 0b10))
    world.add_body(Circle(3.0), position=(10, 0), sensor=True)
    assert world.ray_cast((-9, 0), (30, 0), filter=Filter(0b01, 0b01)) is None
    assert world.ray_cast((-9, 0), (30, 0), filter=Filter(0b10, 0b01)).body.id == 0
    assert world.ray_cast((-9, 0), (30, 0), filter=Filter(0b10, 0b10)) is None
    assert [h.body.id for h in world.ray_cast_all((-9, 0), (30, 0), sensors=True)] == [0, 1]


def test_ray_through_a_slope_and_a_one_way_tile():
    slopes = np.zeros((1, 3, 2))
    slopes[0, 0] = (0, 1)
    one_way = np.zeros((1, 3), bool)
    one_way[0, 2] = True
    world = World(Effects(response=True, one_way=True))
    world.add_body(TileGrid(np.zeros((1, 3), bool), 16.0, one_way=one_way, slopes=slopes), kind="static")
    down = world.ray_cast((4, -10), (0, 40))
    assert down.point == pytest.approx((4, 12)) and down.normal == pytest.approx((-math.sqrt(0.5), -math.sqrt(0.5)))
    assert world.ray_cast((40, -5), (0, 40)).point == (40, 0)
    assert world.ray_cast((40, 30), (0, -40)) is None, "open from below"
    assert world.ray_cast((40, 8), (0, 40)) is None and world.ray_cast((24, -5), (0, 40)) is None


def test_mask_is_hit_at_its_first_solid_pixel_and_through_its_holes():
    solid = np.zeros((5, 5), bool)
    solid[2, 3] = True
    world = world_of(PixelMask(solid, origin=(0, 0)))
    hit = world.ray_cast((-4, 2.5), (20, 0))
    assert hit.point == pytest.approx((3, 2.5)) and hit.normal == (-1, 0)
    assert (
        world.ray_cast((3.5, 9), (0, -20)).point == pytest.approx((3.5, 3))
        and world.ray_cast((-4, 1.5), (20, 0)) is None
    )
    assert world.ray_cast((3.5, 2.5), (1, 0)).fraction == 0.0
    assert [b.id for b in world.query_point((3.5, 2.5))] == [0] and world.query_point((2.5, 2.5)) == []


@pytest.mark.parametrize(
    "point, inside",
    [
        ((8, 8), True),
        ((0, 0), True),
        ((16, 8), True),
        ((8, 16), True),
        ((16, 16), True),
        ((16.001, 8), False),
        ((-0.001, 8), False),
    ],
)
@pytest.mark.parametrize("kind", ["tile", "box"])
def test_point_on_the_border_of_a_closed_shape_is_in_it(kind, point, inside):
    shape = TileGrid(np.array([[1, 0], [0, 0]], bool), 16.0) if kind == "tile" else Polygon.box(16, 16, (8, 8))
    world = world_of(shape)
    assert bool(world.query_point(point)) == inside
    assert bool(world.overlap(Circle(1e-12), (*point, 0))) == inside


def test_overlap_and_query_aabb_answer_in_the_order_of_ids_with_the_present_poses():
    world = World(Effects())
    ids = world.add_bodies(Circle(3.0), [(20.0 * k, 0.0) for k in range(6)])
    world.body(4).move_to((20.0, 1.0))
    assert [b.id for b in world.query_aabb((17, -3), (23, 3))] == [1, 4]
    assert [b.id for b in world.query_aabb((3, 0), (17, 0))] == [0, 1, 4], "closed: touching counts"
    assert [b.id for b in world.overlap(Polygon.box(44, 1), (20, 0, 0))] == [0, 1, 2, 4]
    assert [b.id for b in world.overlap(Circle(1), (20, 0, 0), filter=Filter(1, 0))] == []
    world.remove_body(1)
    assert [b.id for b in world.query_point((20, 0))] == [4] and len(ids) == 6
    assert world.overlap(PixelMask(np.ones((3, 3), bool)), (40, 0, 0.3))[0].id == 2
    assert world.overlap(TileGrid(np.ones((1, 1), bool), 8.0), (36, -4, 0))[0].id == 2


def test_queries_change_nothing():
    world = World(Effects())
    world.add_bodies(PixelMask(np.ones((5, 5), bool)), [(0.0, 0.0), (3.0, 1.0)], angles=[0.2, 1.1])
    before = world.digest()
    (
        world.ray_cast((-9, 0), (20, 0)),
        world.overlap(Circle(4), (0, 0, 0)),
        world.query_aabb((0, 0), (1, 1)),
        world.query_point((0, 0)),
    )
    assert world.digest() == before and world.ray_cast((0, 0), (0, 0)) is not None


def test_queries_of_an_empty_world_find_nothing():
    world = World(Effects())
    assert world.ray_cast((0, 0), (1, 1)) is None and world.ray_cast_all((0, 0), (0, 0)) == []
    assert world.overlap(Circle(1), (0, 0, 0)) == world.query_point((0, 0)) == world.query_aabb((0, 0), (1, 1)) == []


def enters(left, top, right, bottom, x, y, dx, dy):
    """Return the fraction at which a ray enters a closed box, or infinity for a miss. Source: Kay and Kajiya's slabs,
    1986.
    """
    first, last = 0.0, 1.0
    for low, high, at, way in ((left, right, x, dx), (top, bottom, y, dy)):
        if way == 0.0:
            if not low <= at <= high:
                return math.inf
            continue
        ends = sorted(((low - at) / way, (high - at) / way))
        first, last = max(first, ends[0]), min(last, ends[1])
    return first if first <= last else math.inf


@pytest.mark.parametrize("rows, columns", [(9, 2), (2, 9), (6, 7)])
def test_rays_on_tiles_are_rays_on_the_boxes_of_the_tiles(rows, columns):
    rng = np.random.default_rng(rows)
    for _ in range(12 if JIT else 4):
        solid, x, y = rng.random((rows, columns)) < 0.2, *rng.uniform(-90.0, 90.0, 2)
        world = World(Effects())
        world.add_body(TileGrid(solid, 8.0), position=(x, y), kind="static")
        boxes = [(x + 8.0 * j, y + 8.0 * i, x + 8.0 * j + 8.0, y + 8.0 * i + 8.0) for i, j in np.argwhere(solid)]
        for _ in range(40):
            start = (x + rng.uniform(-30.0, 8.0 * columns + 30.0), y + rng.uniform(-30.0, 8.0 * rows + 30.0))
            way = rng.uniform(-120.0, 120.0, 2)
            way[rng.integers(0, 2)] *= rng.integers(0, 4) > 0  # some along an axis
            wanted = min((enters(*box, *start, *way) for box in boxes), default=math.inf)
            hit = world.ray_cast(start, tuple(way))
            assert (hit.fraction if hit else math.inf) == pytest.approx(wanted, abs=1e-9)
