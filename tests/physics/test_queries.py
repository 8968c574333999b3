"""Queries by each broad phase, compared with a test of every shape; casts, closest points, and state after a query."""

import math

import numpy as np
import pytest

from physics import (
    BROADPHASES,
    JIT,
    Bounds,
    Capsule,
    Chain,
    Circle,
    Effects,
    Filter,
    PixelMask,
    Polygon,
    Segment,
    TileGrid,
    World,
    time_of_impact,
)

ORIGIN = (0.0, 0.0, 0.0)
SHAPES = (
    Circle(4.0),
    Polygon.box(9, 5),
    Capsule((-5, 0), (5, 1), 2.0),
    Polygon([(-6, -4), (6, -3), (0, 6)], 1.0),
    PixelMask.from_array(np.array([[1, 1, 0], [0, 1, 1]], bool).repeat(4, 0).repeat(4, 1)),
    Bounds(Circle(3.0)),
)
GROUND = (
    TileGrid(np.array([[1, 0, 1, 1], [1, 1, 0, 1]], bool), 10.0),
    Chain([(0, 0), (20, 5), (45, -5)]),
    Segment((-10, 0), (12, 6)),
)


class EveryShape:
    """Replacement of world.queries that tests every shape in order; the reference for the broad phases."""

    def __init__(self, world):
        self.work, self.index = np.zeros_like(world.queries.work), world.queries

    def begin(self, world):
        self.index.begin(world)  # AABBs and rasters up to date
        self.loose = np.flatnonzero(~world.bodies["quarantined"][world.shapes["body_row"]])
        self.loose_count = len(self.loose)

    def asks_broadphase(self, world):
        return False

    def __getattr__(self, name):
        return getattr(self.index, name)

    def rows_in(self, world, lower, upper):
        s = world.shapes
        near = (
            (s["min_x"] <= upper[0] + 1e-6)
            & (s["max_x"] >= lower[0] - 1e-6)
            & (s["min_y"] <= upper[1] + 1e-6)
            & (s["max_y"] >= lower[1] - 1e-6)
        )
        return np.flatnonzero(near & ~world.bodies["quarantined"][s["body_row"]])


def answers(world, rng):
    """Return the world's answers to a fixed list of queries drawn from rng."""
    found = []
    for _ in range(6 if JIT else 2):
        x, y, dx, dy, angle = *rng.uniform(-150, 150, 2), *rng.uniform(-400, 400, 2), rng.uniform(-3, 3)
        filter = Filter(*(int(each) for each in rng.integers(1, 8, 2)))
        hits = world.ray_cast_all((x, y), (dx, dy), filter, True)
        found.append([(h.shape, h.fraction, h.normal) for h in hits])
        first = world.ray_cast((x, y), (dx, dy), filter, True)
        assert (first.shape if first else None) == (hits[0].shape if hits else None)
        shape = SHAPES[int(rng.integers(len(SHAPES)))]
        cast = world.shape_cast(shape, (x, y, angle), (dx, dy), filter)
        found.append(cast and (cast.shape, cast.fraction, cast.normal, cast.point))
        near = world.closest((x, y), filter)
        found.append(near and (near[0].id, near[1], near[2]))
        found.append([each.id for each in world.overlap(shape, (x, y, angle), filter)])
        found.append([each.id for each in world.query_aabb((x, y), (x + abs(dx) / 8, y + abs(dy) / 8))])
        found.append([each.id for each in world.query_point((x, y))])
    return found


@pytest.mark.parametrize("name", sorted(BROADPHASES))
@pytest.mark.parametrize("solver", ["projection", "soft_step"])
def test_queries_are_a_look_at_every_shape_whatever_happened_since_the_step(name, solver):
    rng = np.random.default_rng(sorted(BROADPHASES).index(name))
    effects = Effects(response=True, gravity=True, rotation=True, sensors=True, stacking=solver == "soft_step")
    world = World(effects, BROADPHASES[name](), solver, gravity=(0, 90))
    for shape in GROUND:
        world.add_body(shape, kind="static", position=rng.uniform(-80, 80, 2).round())
    ids = []
    for turn in range(14 if JIT else 5):
        for _ in range(int(rng.integers(0, 8))):
            ids.append(
                world.add_body(
                    SHAPES[int(rng.integers(len(SHAPES)))],
                    position=rng.uniform(-140, 140, 2),
                    angle=rng.uniform(-3, 3),
                    velocity=rng.uniform(-300, 300, 2),
                    kind=("dynamic", "static", "kinematic")[turn % 3] if turn % 3 != 1 else "dynamic",
                    sensor=turn % 5 == 4,
                    filter=Filter(*(int(each) for each in rng.integers(1, 8, 2))),
                ).id
            )
        if turn % 2:
            world.step()
        if ids and turn % 3 == 0:
            world.body(ids[int(rng.integers(len(ids)))]).move_to(
                tuple(rng.uniform(-140, 140, 2)), float(rng.uniform(-3, 3))
            )
        if ids and turn % 4 == 1:
            world.remove_body(ids.pop(int(rng.integers(len(ids)))))
        if len(ids) and turn % 4 == 2:
            world.bodies["x"][-1] += 37.0  # straight into the table
        if turn == 9:
            world.broadphase = BROADPHASES[name]()
        if turn == 10 and ids:
            world.body(ids[-1]).set_shapes(SHAPES[turn % len(SHAPES)])
        index, seed = world.queries, int(rng.integers(1 << 30))
        found = answers(world, np.random.default_rng(seed))
        world.queries = EveryShape(world)
        assert found == answers(world, np.random.default_rng(seed)), f"turn {turn}"
        world.queries = index


@pytest.mark.parametrize("name", sorted(BROADPHASES))
def test_a_small_question_to_a_large_world_looks_at_few(name):
    world = World(Effects(), BROADPHASES[name]())
    places = [(20.0 * (k % 50), 20.0 * (k // 50)) for k in range(2500)]
    world.add_bodies(Circle(3.0), places, kind="static")
    before = world.queries.counters
    assert before["nodes_visited"] == before["pairs_tested"] == 0
    world.query_point((200.0, 200.0))
    assert world.queries.counters["pairs_tested"] >= 2500, "no step yet: nothing is known"
    world.step()
    counters = world.profile.counters
    for ask in (
        lambda: world.query_point((200.0, 200.0)),
        lambda: world.ray_cast((190, 205), (30, -10)),
        lambda: world.shape_cast(Circle(2.0), (190, 190, 0), (20, 20)),
        lambda: world.overlap(Circle(2.0), (200, 200, 0)),
        lambda: world.query_aabb((190, 190), (210, 210)),
        lambda: world.closest((203.0, 204.0)),
    ):
        ask()
        work = world.queries.counters["nodes_visited"] + world.queries.counters["pairs_tested"]
        limit = {"brute": 3 * 2500, "sweep": 1200, "hash": 400, "tree": 300}[name]
        assert 0 < work <= limit
    assert world.profile.counters == counters, "the counters of the step are left alone"


def test_a_probe_does_not_stay_in_the_library():
    world = World(Effects())
    world.add_body(PixelMask.from_array(np.ones((3, 3), bool)), angle=0.3)
    world.add_body(SHAPES[1])
    world.step()
    sizes = [
        len(world.library.shapes),
        world.library.corners.count,
        world.library.words.count,
        len(world.library.masks),
    ]
    for k in range(5):
        for shape in SHAPES + GROUND:
            angle = 0.0 if isinstance(shape, TileGrid) else 0.1 * k
            world.overlap(shape, (k, 1, angle))
            world.shape_cast(shape, (30 + k, 1, angle), (-60, 0))
        world.overlap(Polygon.box(3.0 + k, 2), ORIGIN)
    assert sizes == [
        len(world.library.shapes),
        world.library.corners.count,
        world.library.words.count,
        len(world.library.masks),
    ]
    mask = PixelMask.from_array(np.ones((5, 5), bool))
    world.overlap(mask, (0, 0, 1.0))
    world.add_body(mask, position=(50, 0), angle=1.0)
    world.step()
    assert [each.id for each in world.query_point((50, 0))] == [2]


@pytest.mark.parametrize(
    "other",
    [
        Circle(5.0),
        Polygon.box(10, 10),
        Capsule((0, -5), (0, 5), 5.0),
        PixelMask.from_array(np.ones((10, 10), bool)),
        Bounds(Polygon.box(10, 10)),
        TileGrid(np.ones((1, 1), bool), 10.0),
        Segment((-5, -5), (-5, 5)),
        Chain([(-5, 5), (-5, -5)]),
    ],
    ids=lambda each: type(each).__name__,
)
@pytest.mark.parametrize(
    "probe",
    [Circle(2.0), Polygon.box(4, 4), Capsule((0, 0), (1, 0), 1.0), PixelMask.from_array(np.ones((4, 4), bool))],
    ids=lambda each: type(each).__name__,
)
def test_shape_cast_is_the_time_of_impact_of_a_translation(probe, other):
    world = World(Effects())
    at = (-5.0, -5.0) if isinstance(other, TileGrid) else (0.0, 0.0)
    body = world.add_body(other, kind="static", position=at)
    hit = world.shape_cast(probe, (-30, 1, 0), (40, 0))
    wanted = time_of_impact(probe, (-30, 1, 0), (10, 1, 0), other, (*at, 0), (*at, 0))
    assert hit.body.id == body.id and hit.fraction == pytest.approx(wanted.fraction, abs=1e-9)
    assert hit.normal == pytest.approx((-wanted.normal[0], -wanted.normal[1]), abs=1e-9) and hit.normal[0] < 0.0
    assert hit.point[0] == pytest.approx(wanted.point[0], abs=1e-6)
    assert (
        world.shape_cast(probe, (-30, 1, 0), (10, 0)) is None and world.shape_cast(probe, (-30, 30, 0), (60, 0)) is None
    )
    assert world.shape_cast(probe, (-30, 1, 0), (-40, 0)) is None


def test_shape_cast_in_contact_at_the_start():
    """A shape cast that starts in contact hits at 0 if it approaches (docs/stability.md, C16).

    It ignores contacts that separate or slide. A cast without translation tests for overlap.
    """
    world = World(Effects())
    world.add_body(Polygon.box(10, 10), kind="static")
    world.add_body(Polygon.box(10, 10), position=(-40, 0), kind="static")
    assert world.shape_cast(Circle(2.0), (-7, 0, 0), (9, 0)).fraction == 0.0
    assert world.shape_cast(Circle(2.0), (-6, 0, 0), (9, 0)).fraction == 0.0
    away = world.shape_cast(Circle(2.0), (-6, 0, 0), (-40, 0))
    assert away.body.id == 1 and away.fraction == pytest.approx((-6 + 33) / 40)
    assert world.shape_cast(Circle(2.0), (-7, 0, 0), (0, 30)) is None
    rest = world.shape_cast(Circle(2.0), (-7, 0, 0), (0, 0))
    assert rest.body.id == 0 and rest.fraction == 0.0 and math.hypot(*rest.normal) == pytest.approx(1.0)
    assert world.shape_cast(Circle(2.0), (-8, 0, 0), (0, 0)) is None


def test_ties_go_to_the_smaller_shape_id_and_filters_and_sensors_count():
    """Equal hits go to the smaller shape id, and casts respect filters and sensors (docs/stability.md, H8, A9)."""
    world = World(Effects(sensors=True))
    world.add_body(Circle(3.0), position=(20, 0), sensor=True)
    world.add_body(Circle(3.0), position=(20, 0), filter=Filter(2, 2))
    for _ in range(3):
        world.add_body(Circle(3.0), position=(20, 0))
    world.step()
    assert world.shape_cast(Circle(1.0), ORIGIN, (40, 0)).shape == 1 and world.closest((20.0, 9.0))[0].id == 1
    assert world.shape_cast(Circle(1.0), ORIGIN, (40, 0), filter=Filter(1, 1)).shape == 2
    assert world.closest((20.0, 9.0), filter=Filter(1, 1))[0].id == 2
    assert (
        world.shape_cast(Circle(1.0), ORIGIN, (40, 0), filter=Filter(4, 0)) is None
        and world.closest((0, 0), filter=Filter(4, 0)) is None
    )
    world.remove_bodies([1, 2])
    assert world.shape_cast(Circle(1.0), ORIGIN, (40, 0)).shape == 3, "H7: what was removed is not found"


CLOSEST = [
    (Circle(5.0), (20.0, 0.0), (5.0, 0.0), 15.0),
    (Circle(5.0), (1.0, 2.0), (1.0, 2.0), 0.0),
    (Polygon.box(10, 6), (20.0, 1.0), (5.0, 1.0), 15.0),
    (Polygon.box(10, 6), (8.0, 7.0), (5.0, 3.0), 5.0),
    (Polygon.box(10, 6), (5.0, 0.0), (5.0, 0.0), 0.0),
    (Capsule((-5, 0), (5, 0), 2.0), (0.0, -9.0), (0.0, -2.0), 7.0),
    (Polygon([(-5, -3), (5, -3), (5, 3), (-5, 3)], 2.0), (8.0, 7.0), (6.2, 4.6), 3.0),
    (Segment((0, 0), (10, 0)), (4.0, 3.0), (4.0, 0.0), 3.0),
    (Chain([(0, 0), (10, 0), (10, 10)]), (14.0, 6.0), (10.0, 6.0), 4.0),
    (Bounds(Circle(5.0)), (9.0, 8.0), (5.0, 5.0), 5.0),
    (TileGrid(np.array([[1, 0, 1]], bool), 10.0), (17.0, 5.0), (20.0, 5.0), 3.0),
    (TileGrid(np.array([[1, 0, 1]], bool), 10.0), (5.0, 5.0), (5.0, 5.0), 0.0),
    (PixelMask.from_array(np.ones((5, 4), bool), origin=(0, 0)), (6.0, 5.5), (4.0, 5.0), math.hypot(2, 0.5)),
]


@pytest.mark.parametrize("shape, point, nearest, gap", CLOSEST, ids=[type(each[0]).__name__ for each in CLOSEST])
def test_closest_point_of_every_kind(shape, point, nearest, gap):
    for offset in (0.0, 3000.0):
        world = World(Effects())
        body = world.add_body(shape, position=(offset, 0.0), kind="static")
        world.add_body(Circle(1.0), position=(offset + 900.0, 500.0))
        found, at, distance = world.closest((point[0] + offset, point[1]))
        assert found.id == body.id and at == pytest.approx((nearest[0] + offset, nearest[1]), abs=1e-9)
        assert distance == pytest.approx(gap, abs=1e-9)
    assert World(Effects()).closest((0, 0)) is None


def test_ray_along_a_segment_and_beside_it():
    """A ray that runs along a segment may hit the end of the segment (docs/stability.md, H2).

    It misses if it is too short, parallel at a distance of 1e-9, or of length 0 elsewhere.
    """
    world = World(Effects())
    world.add_body(Segment((0, 0), (10, 0)), kind="static")
    along = world.ray_cast((-5, 0), (10, 0))
    assert along is None or along.fraction == pytest.approx(0.5)
    inside = world.ray_cast((3, 0), (10, 0))
    assert inside is None or inside.fraction == 0.0
    assert world.ray_cast((-5, 0), (2, 0)) is None and world.ray_cast((-5, 1e-9), (20, 0)) is None
    assert world.ray_cast((5, -3), (0, 6)).fraction == pytest.approx(0.5)
    assert world.ray_cast((50, 50), (0, 0)) is None


def test_a_point_on_a_shared_border_is_of_one_tile_grid_once():
    """A point on the border of two tiles belongs to their grid once (docs/stability.md, H3)."""
    world = World(Effects())
    world.add_body(TileGrid(np.ones((2, 2), bool), 16.0), kind="static")
    assert [each.id for each in world.query_point((16, 16))] == [0]
    assert len(world.ray_cast_all((16, -5), (0, 30))) == 1


def test_far_from_the_origin_queries_answer_alike():
    """Queries give the same results far from the origin (docs/stability.md, H4)."""
    near, far = World(Effects()), World(Effects())
    for world, base in ((near, 0.0), (far, 1e7)):
        for k in range(30):
            world.add_body(SHAPES[k % 4], position=(base + 12.0 * (k % 6), base + 11.0 * (k // 6)), angle=0.3 * k)
        world.step()
    a, b = near.ray_cast_all((-20, 3), (100, 40)), far.ray_cast_all((1e7 - 20, 1e7 + 3), (100, 40))
    assert [h.shape for h in a] == [h.shape for h in b] and len(a) > 2
    assert np.allclose([h.fraction for h in a], [h.fraction for h in b], atol=1e-8)
    p, q = (
        near.shape_cast(SHAPES[1], (-20, 3, 1), (100, 40)),
        far.shape_cast(SHAPES[1], (1e7 - 20, 1e7 + 3, 1), (100, 40)),
    )
    assert p.shape == q.shape and p.fraction == pytest.approx(q.fraction, abs=1e-8)
    assert near.closest((-20, 3))[2] == pytest.approx(far.closest((1e7 - 20, 1e7 + 3))[2], abs=1e-7)


def test_a_quarantined_body_is_not_found_and_queries_change_nothing():
    world = World(Effects(response=True))
    world.add_body(Circle(5.0), velocity=(1.0, 0.0))
    world.add_body(Circle(5.0), position=(100, 0))
    world.bodies["vx"][0] = math.nan
    world.step()
    before = world.digest()
    assert world.query_point((0, 0)) == [] and world.ray_cast((-20, 0), (40, 0)) is None
    assert world.shape_cast(Circle(1), (-20, 0, 0), (40, 0)) is None and world.closest((0, 0))[0].id == 1
    assert world.overlap(Circle(3.0), ORIGIN) == [] and world.digest() == before
    world.body(0).restore()
    assert [each.id for each in world.query_point((0, 0))] == [0]


@pytest.mark.parametrize(
    "call, error, words",
    [
        (lambda w: w.shape_cast("ball", ORIGIN, (1, 0)), TypeError, "shape"),
        (lambda w: w.shape_cast(Circle(1), (0,), (1, 0)), TypeError, "pose"),
        (lambda w: w.shape_cast(Circle(1), ORIGIN, (math.nan, 0)), ValueError, "translation"),
        (lambda w: w.closest((0, math.inf)), ValueError, "point"),
        (lambda w: w.shape_cast(Circle(1), ORIGIN, (1, 0), filter=3), TypeError, "filter"),
        (lambda w: w.closest((0, 0), filter=None), TypeError, "filter"),
        (lambda w: w.ray_cast((math.nan, 0), (1, 0)), ValueError, "origin"),
        (lambda w: w.shape_cast(TileGrid(np.ones((1, 1), bool), 4.0), (0, 0, 1), (1, 0)), ValueError, "pose"),
    ],
)
def test_wrong_arguments_are_named(call, error, words):
    """The error for a wrong argument names it (docs/stability.md, H7)."""
    world = World(Effects())
    world.add_body(Circle(1.0))
    with pytest.raises(error, match=words):
        call(world)
