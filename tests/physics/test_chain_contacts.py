"""Contacts of chains: they are one-sided, use ghost vertices and feel no seams.

They are compared with the distance from the chain's line.
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
    Material,
    PixelMask,
    Polygon,
    Segment,
    TileGrid,
    World,
    collide,
)

shapely = pytest.importorskip("shapely")
from tests.physics.test_hull_manifolds import hull_of, surface_gap  # noqa: E402

COUNT = 200 if JIT else 30
FLAT = Chain([(10.0 * k, 0.0) for k in range(21)])
MOVERS = {
    "box": Polygon.box(9, 6),
    "circle": Circle(4),
    "capsule": Capsule((-4, 0), (4, 0), 3),
    "upright capsule": Capsule((0, -4), (0, 4), 3),
    "rounded": Polygon(Polygon.box(6, 4).points, 1.5),
    "triangle": Polygon([(-6, 3), (6, 3), (0, -5)]),
    "segment": Segment((-6, 0), (5, 0)),
    "bounds": Bounds(Circle(4)),
}


def half_height(shape, angle=0.0):
    core, radius = hull_of(shape, (0, 0, angle))
    return core[:, 1].max() + radius


@pytest.mark.parametrize("name", MOVERS)
@pytest.mark.parametrize("depth", [-0.3, 0.0, 0.01, 1.0])
def test_nothing_is_felt_at_the_seams_of_a_flat_chain(name, depth):
    shape = MOVERS[name]
    if name == "segment" and depth > 0.0:
        pytest.skip("the centre of a line is behind as soon as it is through")
    for x in np.concatenate([np.linspace(20, 60, 161), [29.999999, 30.0, 30.000001]]):
        found = mirrored_many(FLAT, (0, 0, 0), shape, (float(x), depth - half_height(shape), 0), 0.5)
        assert len(found) >= 1 and found.normal == (0.0, -1.0)
        assert found.separations.min() == pytest.approx(-depth, abs=1e-12)
        assert len(set(found.features.tolist())) == len(found)
    for angle in (0.2, -0.7):
        for x in np.linspace(20, 60, 81):
            pose = (float(x), depth - half_height(shape, angle), angle)
            found = collide(FLAT, (0, 0, 0), shape, pose, 0.5)
            assert found.normal == (0.0, -1.0) and found.separations.min() == pytest.approx(-depth, abs=1e-9)


def mirrored_many(chain, at, shape, pose, margin=0.0):
    """Return the manifold of a chain and a shape; it may have more than two points.

    First check that the opposite order of the shapes gives the same manifold with the opposite normal.
    """
    one, two = collide(chain, at, shape, pose, margin), collide(shape, pose, chain, at, margin)
    assert one.points.tolist() == two.points.tolist() and one.separations.tolist() == two.separations.tolist()
    assert one.normal == (-two.normal[0] + 0.0, -two.normal[1] + 0.0)
    return one


def test_a_turned_chain_is_as_flat_as_a_straight_one():
    for angle in (0.3, 2.0, -1.1):
        normal = (math.sin(angle), -math.cos(angle))
        along = (math.cos(angle), math.sin(angle))
        for name in ("box", "circle", "capsule"):
            for t in np.linspace(15, 45, 61):
                up = half_height(MOVERS[name]) - 0.01
                pose = (5 + t * along[0] + up * normal[0], 7 + t * along[1] + up * normal[1], angle)
                found = collide(FLAT, (5, 7, angle), MOVERS[name], pose)
                assert found.normal == pytest.approx(normal, abs=1e-9) and found.separations.min() == pytest.approx(
                    -0.01, abs=1e-9
                )


def test_only_the_front_is_met():
    for name, shape in MOVERS.items():
        assert len(collide(FLAT, (0, 0, 0), shape, (95, -1.0, 0))) > 0 or name == "segment"
        assert len(collide(FLAT, (0, 0, 0), shape, (95, 1.0, 0))) == 0
    room = Chain([(0, 0), (0, 100), (100, 100), (100, 0)], loop=True)  # counter-clockwise on the screen
    island = Chain([(0, 0), (100, 0), (100, 100), (0, 100)], loop=True)
    for at, inward in (((50, 3), (0, 1)), ((97, 50), (-1, 0)), ((50, 97), (0, -1)), ((3, 50), (1, 0))):
        assert collide(room, (0, 0, 0), Circle(4), (*at, 0)).normal == pytest.approx(inward)
    for at, outward in (((50, -3), (0, -1)), ((103, 50), (1, 0)), ((50, 103), (0, 1)), ((-3, 50), (-1, 0))):
        assert len(collide(room, (0, 0, 0), Circle(4), (*at, 0))) == 0
        assert collide(island, (0, 0, 0), Circle(4), (*at, 0)).normal == pytest.approx(outward)


def test_a_convex_corner_is_met_between_the_two_normals_and_once():
    roof = Chain([(-50, 50), (0, 0), (50, 50)])
    found = collide(roof, (0, 0, 0), Circle(5), (0.5, -4, 0))
    assert len(found) == 1 and found.normal == pytest.approx((0.5 / math.hypot(0.5, 4), -4 / math.hypot(0.5, 4)))
    for shape in (Polygon.box(8, 8), Capsule((-4, 0), (4, 0), 4), Polygon(Polygon.box(6, 6).points, 1)):
        for angle in (0.0, 0.1, -0.3):
            found = collide(roof, (0, 0, 0), shape, (1.0, -half_height(shape) + 0.5, angle))
            assert found.normal == pytest.approx((math.sin(angle), -math.cos(angle)), abs=1e-9)
            assert len(set((found.features // 4096).tolist())) == 1, "one of the two links reports the corner"
    spike = Chain([(-2, 60), (0, 0), (2, 60)])
    for x in np.linspace(-3, 3, 13):
        found = collide(spike, (0, 0, 0), Circle(5), (float(x), -3, 0))
        assert len(found) == 1 and found.separations[0] == pytest.approx(math.hypot(x, 3) - 5)


@pytest.mark.parametrize("name", ["circle", "box", "capsule", "rounded", "triangle"])
def test_depth_over_rough_ground_is_the_distance_from_the_line(name):
    """The least separation of a shape from a chain is its exact distance from the chain's line.

    This holds for a shape in front of every link. An overlap always gives a contact.
    """
    rng, shape, near = np.random.default_rng(len(name)), MOVERS[name], 0
    for _ in range(COUNT):
        points = np.stack([np.arange(12) * 15.0, rng.uniform(-4, 4, 12)], axis=1)
        chain, line = Chain(points), shapely.LineString(points)
        x, angle = float(rng.uniform(40, 120)), float(rng.uniform(-3, 3))
        ground = np.interp(x, *points.T)
        pose = (x, float(ground - rng.uniform(2, 14)), angle)
        core, radius = hull_of(shape, pose)
        hull = shapely.MultiPoint([tuple(p) for p in core]).convex_hull
        middle = core.mean(axis=0)
        steps = np.diff(points, axis=0)
        fronts = steps[:, 1] * (middle[0] - points[:-1, 0]) - steps[:, 0] * (middle[1] - points[:-1, 1])
        gap = hull.distance(line) - radius
        found = collide(chain, (0, 0, 0), shape, pose, margin=1.0)
        if (fronts > 0)[np.abs(points[:-1, 0] - x) < 30].all():
            if gap < -1e-9:
                assert len(found) and found.separations.min() < 0, "overlap is a contact"
            elif gap > 1e-9 and radius == 0.0:
                assert not len(found) or found.separations.min() > 0
            if hull.distance(line) > 1e-6 and gap < 1.0 - 1e-9:
                near += 1
                assert len(found)
                # Where the line bends inwards the normals are the links' own: along them it is no less.
                assert found.separations.min() >= gap - 1e-9
        for (px, py), separation in zip(found.points, found.separations, strict=True):
            assert abs(shapely.Point(px, py).distance(line)) <= abs(separation) + 1e-6 + 2 * abs(min(separation, 0.0))
    assert near > 0.03 * COUNT or not JIT


def test_a_circle_over_rough_ground_is_exact():
    rng = np.random.default_rng(3)
    for _ in range(COUNT):
        points = np.stack([np.arange(12) * 15.0, rng.uniform(-10, 10, 12)], axis=1)
        line = shapely.LineString(points)
        x, y = float(rng.uniform(40, 120)), float(rng.uniform(-25, -2))
        if np.interp(x, *points.T) <= y:
            continue
        gap = line.distance(shapely.Point(x, y)) - 4.0
        found = collide(Chain(points), (0, 0, 0), Circle(4), (x, y, 0), margin=0.5)
        assert (len(found) > 0) == (gap <= 0.5) or abs(gap - 0.5) < 1e-9
        if len(found):
            assert found.separations.min() == pytest.approx(gap, abs=1e-9)
            assert (
                surface_gap(
                    (np.array([[x, y]]), 4.0), *(found.points[0] + np.array(found.normal) * found.separations[0] / 2)
                )
                == pytest.approx(0, abs=1e-9)
                or len(found) > 1
            )


def test_open_ends_turn_a_quarter_and_ghosts_smooth():
    line = Chain([(0, 0), (100, 0)])
    assert collide(line, (0, 0, 0), Circle(5), (-3, -3, 0)).normal == pytest.approx((-math.sqrt(0.5),) * 2)
    assert collide(line, (0, 0, 0), Circle(5), (104, 0, 0)).normal == pytest.approx((1, 0))
    assert len(collide(line, (0, 0, 0), Circle(5), (-3, 0.5, 0))) == 0, "behind the line"
    smooth = Chain([(0, 0), (100, 0)], ghosts=((-50, 0), (150, 50)))
    assert len(collide(smooth, (0, 0, 0), Circle(5), (-3, -3, 0))) == 0, "a flat ghost: the corner is not felt"
    assert collide(smooth, (0, 0, 0), Circle(5), (101, -4, 0)).normal == pytest.approx(
        (1 / math.sqrt(17), -4 / math.sqrt(17))
    )
    assert len(collide(smooth, (0, 0, 0), Circle(5), (104, -2, 0))) == 0, (
        "beyond the bend the ghost has nothing that is met"
    )
    box = Polygon.box(10, 10)
    assert collide(line, (0, 0, 0), box, (104, -2, 0)).normal == (1.0, 0.0), "a box is pushed off an open end sideways"
    assert collide(smooth, (0, 0, 0), box, (-4.99, -4, 0)).normal == (0.0, -1.0)
    tilted = collide(line, (0, 0, 0), box, (104.5, -1, 0.2))
    assert len(tilted) and tilted.normal[1] <= 1e-9


@pytest.mark.parametrize("count", [1, 15, 16, 17, 200])
def test_every_link_of_a_long_chain_is_found_in_its_block(count):
    angles = np.linspace(math.pi, 2 * math.pi, count + 1)
    chain = Chain(np.stack([300 * np.cos(angles), 300 * np.sin(angles)], axis=1).tolist())
    for k in range(count):
        middle = (np.array(chain.points[k]) + chain.points[k + 1]) / 2
        away = middle / np.hypot(*middle)
        for turn in (0.0, 1.3):
            x, y = middle + 0.5 * away
            at = (x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn))
            found = collide(chain, (0, 0, turn), Circle(1.0), (*at, 0))
            assert k in (found.features // 4096).tolist()


def test_links_report_themselves_in_worlds():
    world = World()
    ice = Material(friction=0.0, surface_speed=50.0)
    world.add_body(Chain([(0, 0), (100, 0), (200, 0)], materials=(Material(), ice)), kind="static")
    for x in (50, 150):
        world.add_body(Polygon.box(10, 10), position=(x, -5), kind="dynamic", gravity_scale=0.0)
    world.step()
    assert [
        sorted(set((world.contacts["feature"][world.contacts["body_b"] == body] // 4096).tolist())) for body in (1, 2)
    ] == [[0], [1]]
    links = world.library.tables.links
    assert links["friction"][:2].tolist() == [0.6, 0.0] and links["surface_speed"][:2].tolist() == [0.0, 50.0]


def test_masks_meet_chains_from_the_front():
    mask = PixelMask(np.ones((6, 8), bool))
    found = collide(mask, (50, -2, 0), FLAT, (0, 0, 0))
    assert len(found) and found.normal == (0.0, 1.0) and found.area > 0
    assert len(collide(mask, (50, -3, 0), FLAT, (0, 0, 0))) == 0, "masks are open: touching is no hit"
    assert len(collide(mask, (50, 3, 0), FLAT, (0, 0, 0))) == 0


def test_grids_and_chains_do_not_meet_each_other():
    grid = TileGrid(np.ones((2, 2), bool), 8)
    for other in (FLAT, grid):
        assert len(collide(FLAT, (0, 0, 0), other, (0, 0, 0))) == 0
    assert len(collide(grid, (0, 0, 0), FLAT, (0, 0, 0))) == 0


@pytest.mark.parametrize("tilt", [-0.01, -1e-3, 0.0, 1e-3, 0.01])
@pytest.mark.parametrize("name", ["capsule", "long capsule", "rounded"])
def test_a_chain_without_ghosts_is_level_where_a_round_body_leaves_its_first_link(name, tilt):
    """A round body over the corner between two level links has a vertical normal, also without ghost vertices.

    Near the open ends of such a chain the normal may tilt outwards.
    """
    shape, radius = {
        "capsule": (Capsule((-6, 0), (6, 0), 6), 6.0),
        "long capsule": (Capsule((-2, 0), (9, 0), 4), 4.0),
        "rounded": (Polygon(Polygon.box(12, 12).points, 2), 8.0),
    }[name]
    world = World(Effects.detection())
    world.add_body(Chain([(-160, 0), (0, 0), (160, 0)]), kind="static")
    body = world.add_body(shape)
    for x in np.linspace(-20, 20, 401 if JIT else 41):
        for depth in (0.01, 0.1, 0.5):
            body.move_to((float(x), depth - radius), tilt)
            world.step()
            found = world.contacts
            assert (found["normal_y"] < -0.999).all(), (x, depth)
