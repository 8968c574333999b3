"""ray_casts and query_points, compared with single queries and with closed forms.

They take the same arguments as the other queries.
"""

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
)

DISC = np.hypot(*np.mgrid[-9.5:10, -9.5:10]) < 9.0
RING = DISC & ~(np.hypot(*np.mgrid[-9.5:10, -9.5:10]) < 5.0)
SHAPES = (
    Circle(6.0, (1.0, 2.0)),
    Capsule((-5.0, 0.0), (6.0, 1.0), 3.0),
    Polygon.box(12.0, 7.0),
    Polygon([(-8, -3), (7, -5), (5, 8)], radius=2.0),
    Bounds(Polygon.box(9.0, 4.0, angle=0.5)),
    PixelMask(DISC),
    PixelMask(RING, snap=False),
)
GROUND = (
    Segment((-9.0, 1.0), (8.0, -2.0)),
    Chain([(-60.0, 3.0), (0.0, 0.0), (60.0, 9.0)]),
    TileGrid(np.array([[1, 0, 1], [1, 1, 1]], bool), 8.0),
)
DETECTS, PUSHES = Effects(sensors=True, rotation=True), Effects.rigid_bodies()
RAYS = 200 if JIT else 25


def crowd(effects, broadphase, seed, count=60):
    """Return a world of all kinds of shapes, some of them sensors, with random filters, after one step."""
    rng = np.random.default_rng(seed)
    world = World(effects, broadphase=broadphase, gravity=(0, 0)) if effects.gravity else World(effects, broadphase)
    for number in range(count):
        shape = (*SHAPES, *GROUND)[number % (len(SHAPES) + len(GROUND))]
        turns = number % 2 == 0 and not isinstance(shape, TileGrid)
        world.add_body(
            shape,
            position=tuple(rng.uniform(-200, 200, 2)),
            angle=float(rng.uniform(-3, 3)) if turns else 0.0,
            kind="static" if shape in GROUND else ("dynamic", "kinematic", "static")[number % 3],
            filter=Filter(int(rng.integers(1, 8)), int(rng.integers(1, 8))),
            sensor=number % 5 == 1,
        )
    world.step()
    return world


def rays(seed, count=RAYS):
    """Return (origins, translations) of random rays: short, long, parallel to an axis, and of length 0."""
    rng = np.random.default_rng(seed)
    origins, ways = rng.uniform(-250, 250, (count, 2)), rng.uniform(-400, 400, (count, 2))
    ways[::7] *= 20.0
    ways[::5, 0] = 0.0
    ways[::10] = 0.0
    return origins, ways


def row_of(hit, origin, way):
    """Return the row that ray_casts should return for a ray with this result of ray_cast.

    hit: a RayHit, or None for a miss. way: translation of the ray.
    """
    if hit is None:
        return (-1, -1, origin[0] + way[0], origin[1] + way[1], 0.0, 0.0, 1.0)
    return (hit.body.id, hit.shape, *hit.point, *hit.normal, hit.fraction)


@pytest.mark.parametrize("sensors", [False, True])
@pytest.mark.parametrize("effects", [DETECTS, PUSHES], ids=["detects", "pushes"])
@pytest.mark.parametrize("broadphase", BROADPHASES)
def test_many_rays_are_each_of_them(broadphase, effects, sensors):
    world = crowd(effects, broadphase, 1)
    filter = Filter(3, 6)
    origins, ways = rays(2)
    found = world.ray_casts(origins, ways, filter, sensors)
    singly = [world.ray_cast(a, b, filter, sensors) for a, b in zip(origins.tolist(), ways.tolist(), strict=True)]
    assert found.tolist() == [row_of(*each) for each in zip(singly, origins.tolist(), ways.tolist(), strict=True)]
    assert 0 < (found["body"] >= 0).sum() < len(found)
    every = [world.ray_cast_all(a, b, filter, sensors) for a, b in zip(origins.tolist(), ways.tolist(), strict=True)]
    assert [some[0].shape if some else -1 for some in every] == found["shape"].tolist()
    assert all(len({hit.shape for hit in some}) == len(some) for some in every)


@pytest.mark.parametrize("effects", [DETECTS, PUSHES], ids=["detects", "pushes"])
@pytest.mark.parametrize("broadphase", BROADPHASES)
def test_the_work_of_a_call_is_that_of_its_rays_and_points(broadphase, effects):
    """A call with many rays does the same work as single calls, by the counters and the visited boxes.

    The call mixes rays and points (rays of length 0).
    """
    world = crowd(effects, broadphase, 11)
    origins, ways = rays(12)
    assert ways.any(axis=1).any() and not ways.any(axis=1).all()
    world.ray_casts(origins, ways)
    together, boxes = world.queries.counters, np.array(world.queries.asked).tolist()
    singly, asked = dict.fromkeys(together, 0), []
    for origin, way in zip(origins, ways, strict=True):
        world.ray_casts([origin], [way])
        singly = {name: count + singly[name] for name, count in world.queries.counters.items()}
        asked += np.array(world.queries.asked).tolist()
    assert together == singly and boxes == asked and together["narrow_tests"] > 0


@pytest.mark.parametrize("effects", [DETECTS, PUSHES], ids=["detects", "pushes"])
def test_four_broad_phases_find_the_same(effects):
    found = []
    for name in BROADPHASES:
        world = crowd(effects, name, 3)
        found.append((world.ray_casts(*rays(4)).tolist(), world.query_points(rays(5)[0]).tolist()))
    assert all(each == found[0] for each in found) and found[0][1]


@pytest.mark.parametrize("broadphase", BROADPHASES)
def test_they_see_what_was_moved_added_and_removed_since_the_step(broadphase):
    world = crowd(DETECTS, broadphase, 6)
    origins, ways = rays(7)
    world.bodies["x"][::3] += 90.0
    world.touch(world.bodies["id"][::3])
    world.add_body(PixelMask(RING), position=(0, 0), angle=0.3)
    world.remove_bodies(world.bodies["id"][1:6])
    fresh = World(DETECTS, "brute")
    for body in world:
        fresh.add_body(
            *body.shapes,
            position=body.position,
            angle=body.angle,
            kind=body.kind,
            filter=body.filter,
            sensor=body.sensor,
        )
    mine, its = world.ray_casts(origins, ways), fresh.ray_casts(origins, ways)
    assert mine["fraction"].tolist() == its["fraction"].tolist()
    assert mine["normal_x"].tolist() == its["normal_x"].tolist()
    ids = dict(zip(fresh.bodies["id"].tolist(), world.bodies["id"].tolist(), strict=True))
    assert mine["body"].tolist() == [ids.get(each, -1) for each in its["body"].tolist()]


@pytest.mark.parametrize("effects", [DETECTS, PUSHES], ids=["detects", "pushes"])
@pytest.mark.parametrize("sensors", [False, True])
def test_many_points_are_each_of_them(effects, sensors):
    world = crowd(effects, "hash", 8, 90)
    points = np.random.default_rng(9).uniform(-210, 210, (RAYS, 2))
    points[:9] = [body.position for body in list(world)[:9]]
    found = world.query_points(points, Filter(5, 7), sensors)
    wanted = [
        (k, body.id)
        for k, point in enumerate(points.tolist())
        for body in world.query_point(point, Filter(5, 7), sensors)
    ]
    assert found.tolist() == wanted and wanted
    assert found.dtype.names == ("point", "body")


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("broadphase", BROADPHASES)
def test_discs_in_closed_form(broadphase, seed):
    """The fraction f of a ray's hit on discs is the least root of |o + f d - c|² = r² over all discs.

    It is 0 if the ray starts inside a disc.
    """
    rng = np.random.default_rng(seed)
    centers, radii = rng.uniform(-500, 500, (400, 2)), 4.0
    world = World(Effects.detection(), broadphase)
    ids = world.add_bodies(Circle(radii), centers)
    world.step()
    origins, ways = rng.uniform(-500, 500, (RAYS, 2)), rng.uniform(-300, 300, (RAYS, 2))
    found = world.ray_casts(origins, ways)
    for k, (origin, way) in enumerate(zip(origins, ways, strict=True)):
        to = origin - centers
        a, b, c = way @ way, to @ way, (to * to).sum(axis=1) - radii**2
        root = b * b - a * c
        fractions = np.where(root >= 0.0, (-b - np.sqrt(np.maximum(root, 0.0))) / a, np.inf)
        fractions = np.where(c <= 0.0, 0.0, np.where((fractions >= 0.0) & (fractions <= 1.0), fractions, np.inf))
        best = int(np.argmin(fractions))
        if not math.isfinite(fractions[best]):
            assert found["body"][k] == -1
            continue
        assert found["body"][k] == ids[best] and found["fraction"][k] == pytest.approx(fractions[best], abs=1e-12)
        assert (found["point_x"][k], found["point_y"][k]) == pytest.approx(origin + found["fraction"][k] * way)
        if fractions[best] > 0.0:
            normal = (origin + fractions[best] * way - centers[best]) / radii
            assert (found["normal_x"][k], found["normal_y"][k]) == pytest.approx(normal, abs=1e-9)


def test_a_ray_through_hundreds_of_shapes_finds_all_in_order():
    world = World(Effects.detection())
    world.add_bodies(Circle(1.0), [(4.0 * k, 0.0) for k in range(500)])
    hits = world.ray_cast_all((-5.0, 0.0), (2005.0, 0.0))
    assert [hit.body.id for hit in hits] == list(range(500))
    crossing = world.ray_casts([(-5.0, 0.0)] * 9, [(2005.0, 0.0)] * 9)
    assert crossing["body"].tolist() == [0] * 9 and crossing["fraction"].tolist() == [4.0 / 2005.0] * 9


def test_carved_and_exchanged_masks_are_met_as_they_are_now():
    world = World(Effects(carving=True, rotation=True))
    body = world.add_body(PixelMask(np.ones((20, 40), bool)), kind="static")
    across = ([(-30.0, 0.0)], [(60.0, 0.0)])
    before = world.ray_casts(*across)["point_x"][0]
    body.carve(Polygon.box(20, 30), (-20.0, 0.0))
    after = world.ray_casts(*across)["point_x"][0]
    assert before == pytest.approx(-20.0, abs=0.6) and after == pytest.approx(-10.0, abs=0.6)
    body.set_shapes(PixelMask(np.ones((20, 8), bool)))
    assert world.ray_casts(*across)["point_x"][0] == pytest.approx(-4.0, abs=0.6)


QUERIES = {
    "ray_cast": lambda world, *more: world.ray_cast((-50, 0), (100, 0), *more),
    "ray_cast_all": lambda world, *more: world.ray_cast_all((-50, 0), (100, 0), *more),
    "ray_casts": lambda world, *more: (world.ray_casts([(-50, 0)], [(100, 0)], *more)["body"] >= 0).any(),
    "shape_cast": lambda world, *more: world.shape_cast(Circle(2), (-50, 0), (100, 0), *more),
    "overlap": lambda world, *more: world.overlap(Circle(2), (1, 1), *more),
    "closest": lambda world, *more: world.closest((30, 30), *more),
    "query_aabb": lambda world, *more: world.query_aabb((-1, -1), (1, 1), *more),
    "query_rect": lambda world, *more: world.query_rect((-1, -1, 2, 2), *more),
    "query_point": lambda world, *more: world.query_point((1, 1), *more),
    "query_points": lambda world, *more: len(world.query_points([(1, 1)], *more)),
}


@pytest.mark.parametrize("shape", [Circle(6.0), Polygon.box(9, 9), PixelMask(DISC), PixelMask(DISC, snap=False)])
@pytest.mark.parametrize("effects", [DETECTS, PUSHES], ids=["detects", "pushes"])
@pytest.mark.parametrize("query", QUERIES)
def test_filter_and_sensors_mean_the_same_in_every_query(query, effects, shape):
    ask = QUERIES[query]
    for sensor in (False, True):
        world = World(effects)
        world.add_body(shape, kind="static", filter=Filter(2, 4), sensor=sensor)
        assert bool(ask(world)) == (not sensor), "by default sensors are not found"
        assert ask(world, Filter.ALL, True)
        for membership, mask, meets in ((4, 2, True), (4, 1, False), (1, 2, False), (12, 3, True)):
            assert bool(ask(world, Filter(membership, mask), True)) == meets
            assert bool(ask(world, Filter(membership, mask), False)) == (meets and not sensor)
        with pytest.raises(TypeError, match="filter"):
            ask(world, 3)
        with pytest.raises(TypeError, match="sensors must be True or False"):
            ask(world, Filter.ALL, "yes")


@pytest.mark.parametrize(
    "origins, ways, error, why",
    [
        ([(0, 0)], [(1, 0), (2, 0)], ValueError, "translations must have 1 rows, as origins has"),
        ([(0, 0, 0)], [(1, 0)], ValueError, r"origins must have shape \(n, 2\)"),
        ([(math.nan, 0)], [(1, 0)], ValueError, r"origins\[0\] must be finite"),
        ([(0, 0), (1, 1)], [(1, 0), (math.inf, 0)], ValueError, r"translations\[1\] must be finite"),
        ([(0, 0), (1e300, 0)], [(1, 0), (1, 0)], ValueError, r"origins\[1\] must lie within"),
        ("abc", [(1, 0)], TypeError, "origins must be an array of numbers"),
    ],
)
def test_wrong_rays_are_refused(origins, ways, error, why):
    with pytest.raises(error, match=why):
        crowd(DETECTS, "hash", 1, 3).ray_casts(origins, ways)


def test_wrong_points_are_refused_and_none_are_none():
    world = crowd(DETECTS, "hash", 1, 12)
    with pytest.raises(ValueError, match=r"points\[0\] must be finite"):
        world.query_points([(math.nan, 0)])
    with pytest.raises(ValueError, match=r"points must have shape \(n, 2\)"):
        world.query_points([1.0, 2.0, 3.0])
    assert len(world.query_points([])) == len(world.ray_casts([], [])) == 0
    assert len(World().query_points([(0, 0)])) == 0
    assert World().ray_casts([(0, 0)], [(3, 4)]).tolist() == [(-1, -1, 3.0, 4.0, 0.0, 0.0, 1.0)]
