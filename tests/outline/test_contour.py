"""Boundary loops of pixel regions, compared with flood fill and unions of squares."""

import numpy as np
import pytest
import shapely

from physics.outline.contour import contours
from tests.outline.rasters import connected, hard, noise, pixels, polygons, raster

EMPTY = [np.zeros((0, 3), bool), np.zeros((4, 0), bool), np.zeros((3, 3), bool)]


def plain(pieces):
    return [(piece.outer.corners, [hole.corners for hole in piece.holes]) for piece in pieces]


@pytest.mark.parametrize("solid", EMPTY, ids=str)
def test_nothing_has_no_loops(solid):
    assert contours(solid) == [] == contours(solid, 3)


def test_a_rectangle_is_its_four_corners_and_a_hole_goes_the_other_way():
    (piece,) = contours(raster(["###", "#.#", "###"]))
    assert piece.outer.corners.tolist() == [[0, 0], [3, 0], [3, 3], [0, 3]]
    assert piece.holes[0].corners.tolist() == [[2, 1], [1, 1], [1, 2], [2, 2]]


def test_a_pinch_is_apart_or_joined():
    solid = raster(["#.", ".#"])
    assert [len(each.outer.corners) for each in contours(solid)] == [4, 4]
    (joined,) = contours(solid, 3)
    assert joined.outer.joined.tolist() == [False, False, True, False, False, False, True, False]
    long = np.kron(solid, np.ones((3, 3), bool)).astype(bool)
    assert len(contours(long, 3)) == 2 and len(contours(long, 4)) == 1


@pytest.mark.parametrize("solid", [*hard().values(), *noise(1, 60)])
def test_loops_bound_exactly_the_pixels(solid):
    pieces = plain(contours(solid))
    figures = polygons(pieces)
    assert all(each.is_valid for each in figures), "no loop meets itself"
    assert shapely.union_all(figures).symmetric_difference(pixels(solid)).area == 0.0
    assert sum(each.area for each in figures) == solid.sum()
    assert len(pieces) == connected(solid, diagonal=False)
    assert all(each.exterior.is_ccw and not any(hole.is_ccw for hole in each.interiors) for each in figures)
    for outer, holes in pieces:
        for loop in (outer, *holes):
            runs = np.roll(loop, -1, axis=0) - loop
            assert ((runs == 0).sum(axis=1) == 1).all() and ((runs == 0) != np.roll(runs == 0, 1, axis=0)).all()


@pytest.mark.parametrize("solid", [*hard().values(), *noise(2, 60)])
def test_joined_pieces_are_connected_over_corners(solid):
    pieces = plain(contours(solid, 99))
    assert len(pieces) == connected(solid, diagonal=True)
    holes = sum(shapely.Polygon(hole).area for _, holes in pieces for hole in holes)
    assert sum(shapely.Polygon(outer).area for outer, _ in pieces) - holes == solid.sum()
