"""A mask without pixels and a grid without cells have no box: no box query finds them, whatever finds their body."""

import numpy as np
import pytest

from physics import Bounds, Circle, Effects, PixelMask, TileGrid, World

EMPTY = [
    PixelMask(np.zeros((8, 8), bool)),
    PixelMask(np.zeros((0, 0), bool)),
    Bounds(PixelMask(np.zeros((8, 8), bool))),
    TileGrid(np.zeros((4, 4), bool), 8),
]


@pytest.mark.parametrize("shape", EMPTY, ids=["mask", "no size", "bounds", "grid"])
def test_no_query_by_box_finds_it(shape):
    world = World(gravity=(0, 0))
    empty = world.add_body(shape, kind="static")
    both = world.add_body(shape, Circle(3), kind="static", position=(100, 0))
    for _ in range(2):
        assert world.query_aabb((-50, -50), (50, 50)) == [] and world.query_rect((-50, -50, 100, 100)) == []
        assert world.query_aabb((-200, -200), (200, 200)) == [both]
        assert empty.bounds is None and both.bounds == (97, -3, 103, 3)
        if not isinstance(shape, Bounds):
            assert world.overlap(Circle(50), (0, 0)) == [] and world.closest((0, 0))[0] == both
        world.step()


def test_a_turned_mask_of_one_pixel_is_found():
    world = World(gravity=(0, 0))
    solid = np.zeros((9, 9), bool)
    solid[1, 7] = True
    for k in range(32):
        body = world.add_body(PixelMask(solid), angle=0.2 * k, kind="static")
        assert world.query_aabb((-20, -20), (20, 20)) == [body] and body.bounds is not None
        body.remove()


def test_a_grid_of_one_slope_or_one_plank_is_found():
    world = World(Effects.rigid_bodies().with_(one_way=True), gravity=(0, 0))
    none, one = np.zeros((2, 2), bool), np.zeros((2, 2), bool)
    one[1, 1] = True
    slopes = np.zeros((2, 2, 2))
    slopes[0, 1] = 0, 1
    for grid in (TileGrid(none, 8, one_way=one), TileGrid(none, 8, slopes=slopes)):
        body = world.add_body(grid, kind="static")
        assert world.query_aabb((-20, -20), (20, 20)) == [body]
        body.remove()
