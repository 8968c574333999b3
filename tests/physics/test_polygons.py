"""hull() and decompose(): convex polygons from points, compared with shapely."""

import math

import numpy as np
import pytest
import shapely
from shapely import MultiPoint
from shapely import Polygon as Figure

from physics import Polygon, decompose, hull, mass_of
from tests.oracles.convex_pieces import tangle


@pytest.mark.parametrize("seed", range(12))
def test_a_hull_of_few_corners_is_the_hull(seed):
    rng = np.random.default_rng(seed)
    points = rng.integers(-6, 7, (14, 2)) * rng.choice([1.0, 1e-7, 3e8])
    true = MultiPoint(points).convex_hull
    found = Figure(hull(points).points)
    assert found.symmetric_difference(true).area <= 1e-12 * true.area


@pytest.mark.parametrize("count", [17, 40, 200])
def test_a_hull_of_many_corners_keeps_sixteen_and_all_points(count):
    rng = np.random.default_rng(count)
    angles = rng.uniform(0, math.tau, count)
    points = np.stack([np.cos(angles) * 50, np.sin(angles) * 30], axis=1) + 7
    found = hull(points)
    figure, true = Figure(found.points), MultiPoint(points).convex_hull
    assert len(found.points) == 16
    assert figure.buffer(1e-9).covers(true) and figure.area <= 1.05 * true.area


def test_the_corner_that_adds_least_goes():
    angles = np.arange(17) * math.tau / 17
    points = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    points[0] = (points[1] + points[16]) / 2 * 1.004  # hardly a corner: its sides are the cheapest to go
    corners = np.array(hull(points).points)
    kept = [np.hypot(*(corners - each).T).min() < 1e-9 for each in points]
    assert sum(kept) == 15 and not kept[0] and kept[1] + kept[16] == 1


@pytest.mark.parametrize("points", [[], [(0, 0), (1, 1)], [(0, 0), (1, 1), (3, 3)], [(2, 2)] * 5])
def test_points_on_a_line_have_no_hull(points):
    with pytest.raises(ValueError, match="points must be at least 3 that are not on one line"):
        hull(points)


@pytest.mark.parametrize("points", [[(0, 0), (1, math.nan), (2, 2)], [(0, 0, 0)] * 3, np.zeros((2, 3, 2))])
def test_what_are_no_points_is_told(points):
    for function in (hull, decompose):
        with pytest.raises(ValueError, match="points"):
            function(points)


@pytest.mark.parametrize("points", ["abc", None, 3, [(0, 0), (1,)], [("a", "b")]])
def test_what_is_of_another_kind_is_told(points):
    for function in (hull, decompose):
        with pytest.raises((TypeError, ValueError), match="points"):
            function(points)


@pytest.mark.parametrize("seed", range(10))
def test_decomposed_polygons_weigh_what_the_whole_does(seed):
    rng = np.random.default_rng(seed)
    corners = tangle(rng, 20) * 100
    parts = decompose(corners)
    assert all(isinstance(each, Polygon) for each in parts)
    whole = Figure(corners)
    mass = mass_of(parts, 2.0)
    assert mass.mass == pytest.approx(2 * whole.area, rel=1e-9)
    assert mass.center == pytest.approx((whole.centroid.x, whole.centroid.y), abs=1e-6)
    inside = np.array(whole.representative_point().coords[0])
    radius = whole.boundary.distance(shapely.Point(inside)) / 2
    hole = inside + radius * np.array([(1, 0), (0, 1), (-1, 0), (0, -1)])
    assert mass_of(decompose(corners, [hole]), 1.0).mass == pytest.approx(whole.area - 2 * radius**2, rel=1e-9)


def test_a_tolerance_takes_shallow_waves_out():
    angles = np.arange(60) * math.tau / 60
    waves = np.stack([np.cos(angles), np.sin(angles)], axis=1) * (50 + np.arange(60) % 2)[:, None]
    assert len(decompose(waves)) >= 16 and len(decompose(waves, tolerance=1.5)) <= 3


def test_a_cross_is_three_boxes_though_its_bar_has_corners_in_a_line():
    cross = [(1, 0), (2, 0), (2, 1), (3, 1), (3, 2), (2, 2), (2, 3), (1, 3), (1, 2), (0, 2), (0, 1), (1, 1)]
    assert sorted(len(each.points) for each in decompose(cross)) == [4, 4, 4]


@pytest.mark.parametrize("tolerance", [-1.0, math.nan, math.inf])
def test_a_wrong_tolerance_is_told(tolerance):
    with pytest.raises(ValueError, match="tolerance must be finite and >= 0.0"):
        decompose([(0, 0), (1, 0), (0, 1)], tolerance=tolerance)


def test_wrong_holes_are_told():
    square = [(0, 0), (9, 0), (9, 9), (0, 9)]
    with pytest.raises(TypeError, match="holes must be a list of polygons"):
        decompose(square, holes=3)
    with pytest.raises(ValueError, match=r"holes\[0\] must have at least 3 corners"):
        decompose(square, holes=[[(1, 1), (2, 2)]])
    with pytest.raises(ValueError, match=r"edge 0 of points.*edge 2 of points"):
        decompose([(0, 0), (9, 9), (9, 0), (0, 9)])


def test_a_concave_polygon_says_what_to_do():
    arrow = [(0, 0), (4, 0), (1, 1), (0, 4)]
    with pytest.raises(ValueError, match="physics.decompose"):
        Polygon(arrow)
    assert len(decompose(arrow)) == 2
