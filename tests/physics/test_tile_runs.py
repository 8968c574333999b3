"""Tiles are merged into runs, so bodies that slide along them feel no seam, horizontally or
vertically (invariant U10).
"""

import numpy as np
import pytest

from physics import Bounds, Capsule, Circle, Effects, PixelMask, Polygon, TileGrid, World, collide
from physics.shapes.library import Library

shapely = pytest.importorskip("shapely")
from tests.physics.test_hull_manifolds import hull_of  # noqa: E402

MOVERS = {
    "box": Polygon.box(9, 6),
    "circle": Circle(4),
    "capsule": Capsule((-4, 0), (4, 0), 3),
    "upright capsule": Capsule((0, -4), (0, 4), 3),
    "rounded": Polygon(Polygon.box(6, 4).points, 1.5),
    "triangle": Polygon([(-6, 3), (6, 3), (0, -5)]),
    "bounds": Bounds(Circle(4)),
}
FLOOR = TileGrid(np.ones((3, 30), bool), 8)
WALL = TileGrid(np.ones((30, 3), bool), 8)


def reach(shape, angle, axis):
    core, radius = hull_of(shape, (0, 0, angle))
    return core[:, axis].max() + radius


def test_runs_are_the_like_cells_next_to_each_other():
    solid = np.array([[1, 1, 0, 1], [0, 1, 1, 1]], bool)
    library = Library()
    library.add(TileGrid(solid, 8, one_way=np.array([[0, 0, 1, 0], [0, 0, 0, 0]], bool)))
    cells = library.tables.cells[:8]
    assert cells["first"].tolist() == [0, 0, 2, 3, 0, 1, 1, 1] and cells["last"].tolist() == [1, 1, 2, 3, 0, 3, 3, 3]


@pytest.mark.parametrize("name", MOVERS)
@pytest.mark.parametrize("depth", [-0.3, 0.0, 0.01, 1.0])
def test_a_floor_has_one_normal_and_one_depth(name, depth):
    shape = MOVERS[name]
    for angle in (0.0, 0.3, -1.0):
        if isinstance(shape, Bounds) and angle:
            continue
        for x in np.concatenate([np.linspace(40, 80, 81), [47.9999999, 48.0, 48.0000001]]):
            found = collide(FLOOR, (0, 0, 0), shape, (float(x), depth - reach(shape, angle, 1), angle), 0.5)
            assert len(found) in (1, 2) and found.normal == (0.0, -1.0)
            assert found.separations.min() == pytest.approx(-depth, abs=1e-9)


@pytest.mark.parametrize("name", MOVERS)
@pytest.mark.parametrize("depth", [-0.3, 0.0, 0.01, 1.0])
def test_a_wall_has_one_normal_whatever_row_it_is_met_in(name, depth):
    """A wall of tiles has one normal in every row: row borders inside the wall have no effect.

    The sides of rows are not merged.
    """
    shape = MOVERS[name]
    for y in np.concatenate([np.linspace(60, 100, 161), [63.9999999, 64.0, 64.0000001]]):
        found = collide(WALL, (0, 0, 0), shape, (24 - depth + reach(shape, 0.0, 0), float(y), 0), 0.5)
        assert len(found) >= 1 and found.normal == (1.0, 0.0)
        assert found.separations.min() == pytest.approx(-depth, abs=1e-9) and len(set(found.features.tolist())) == len(
            found
        )


@pytest.mark.parametrize("name", ["box", "circle", "capsule", "rounded"])
def test_a_corner_of_floor_and_wall_has_their_two_normals(name):
    solid = np.zeros((10, 10), bool)
    solid[9], solid[:, 9] = True, True
    grid, shape = TileGrid(solid, 8), MOVERS[name]
    at = (72 + 0.2 - reach(shape, 0.0, 0), 72 + 0.1 - reach(shape, 0.0, 1), 0)
    world = World(Effects())
    world.add_body(grid, kind="static")
    world.add_body(shape, position=at[:2])
    world.step(0)
    normals = {(c["normal_x"], c["normal_y"]): c["separation"] for c in world.contacts}
    assert set(normals) == {(0.0, -1.0), (-1.0, 0.0)}
    assert normals[0.0, -1.0] == pytest.approx(-0.1) and normals[-1.0, 0.0] == pytest.approx(-0.2)


def test_overlap_with_any_ground_is_a_contact():
    rng = np.random.default_rng(11)
    for _ in range(150):
        solid = rng.random((6, 8)) < 0.5
        grid = TileGrid(solid, 8)
        ground = shapely.union_all([shapely.box(8 * c, 8 * r, 8 * c + 8, 8 * r + 8) for r, c in np.argwhere(solid)])
        for shape in MOVERS.values():
            pose = (
                *rng.uniform((4, 4), (60, 44)).tolist(),
                0.0 if isinstance(shape, Bounds) else float(rng.uniform(-3, 3)),
            )
            core, radius = hull_of(shape, pose)
            gap = shapely.MultiPoint([tuple(p) for p in core]).convex_hull.distance(ground) - radius
            assert (len(collide(grid, (0, 0, 0), shape, pose)) > 0) == (gap <= 0.0) or abs(gap) < 1e-9


def test_one_way_platforms_are_one_surface_from_above_only():
    grid = TileGrid(np.zeros((1, 12), bool), 8, one_way=np.ones((1, 12), bool))
    world = World(Effects(one_way=True, response=True, gravity=True))
    world.add_body(grid, kind="static", position=(0, 100))
    lands = world.add_body(Polygon.box(9, 6), position=(40, 80), velocity=(30.0, 0.0))
    rises = world.add_body(Circle(4), position=(70, 130), velocity=(0.0, -60.0), gravity_scale=0.0)
    for _ in range(60):
        world.step()
    assert lands.position[1] == pytest.approx(97.0, abs=0.5) and lands.velocity[0] == pytest.approx(30.0)
    assert rises.position[1] < 90.0


def test_a_mask_rests_on_the_run_below_it():
    mask = PixelMask(np.ones((6, 8), bool))
    for x in range(40, 60):
        found = collide(FLOOR, (0, 0, 0), mask, (x, -2, 0))
        assert len(found) == 1 and found.normal == (0.0, -1.0) and found.separations[0] == -1.0
